//! Homework: scenes as plain data, and the same as a world for the oracle.

use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, UVec2, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_asset::Assets;
use halfway_lighting::{
    Attenuation, BackMaterial, Camera, DirectionalLight, Encoding, Faces, GlobalAmbient, Material, PointLight,
    Reflectance, Shading, SpotLight, Viewer,
};
use halfway_mesh::{Mesh, Mesh3d};
use halfway_reference::Oracle;

/// The size of all pictures.
pub(crate) const SIZE: (u32, u32) = (64, 48);

pub(crate) struct Task {
    pub(crate) name: &'static str,
    pub(crate) eye: Vec3,
    pub(crate) target: Vec3,
    /// The vertical field of view in radians.
    pub(crate) fov: f32,
    pub(crate) viewer: Viewer,
    pub(crate) encoding: Encoding,
    pub(crate) background: [f32; 3],
    pub(crate) ambient: [f32; 3],
    pub(crate) things: Vec<Thing>,
    /// In the order of the scene.
    pub(crate) lamps: Vec<Lamp>,
}

pub(crate) struct Thing {
    pub(crate) mesh: Mesh,
    pub(crate) place: Mat4,
    pub(crate) front: Look,
    pub(crate) back: Option<Look>,
    pub(crate) shading: Shading,
    pub(crate) reflectance: Reflectance,
    pub(crate) faces: Faces,
}

#[derive(Clone, Copy)]
pub(crate) struct Look {
    pub(crate) ka: [f32; 3],
    pub(crate) kd: [f32; 3],
    pub(crate) ks: [f32; 3],
    pub(crate) ke: [f32; 3],
    pub(crate) shininess: f32,
}

#[derive(Clone, Copy)]
pub(crate) struct Lamp {
    pub(crate) kind: LampKind,
    pub(crate) la: [f32; 3],
    pub(crate) ld: [f32; 3],
    pub(crate) ls: [f32; 3],
    /// Ignored by suns, as are the next two.
    pub(crate) attenuation: [f32; 3],
    pub(crate) range: Option<f32>,
    pub(crate) attenuates_ambient: bool,
}

#[derive(Clone, Copy)]
pub(crate) enum LampKind {
    /// The direction in which it shines.
    Sun(Vec3),
    Bulb(Vec3),
    Spot {
        at: Vec3,
        toward: Vec3,
        /// Half angles in radians.
        cutoff: f32,
        inner: Option<f32>,
        exponent: f32,
    },
}

fn color([r, g, b]: [f32; 3]) -> LinearRgba {
    LinearRgba::rgb(r, g, b)
}

impl Look {
    fn material(&self) -> Material {
        Material {
            ambient: color(self.ka),
            diffuse: color(self.kd),
            specular: color(self.ks),
            emission: color(self.ke),
            shininess: self.shininess,
            ..Material::DEFAULT
        }
    }
}

impl Task {
    pub(crate) fn world_from_camera(&self) -> Mat4 {
        Transform::from_translation(self.eye).looking_at(self.target, Vec3::Y).to_matrix()
    }

    pub(crate) fn world(&self) -> World {
        let mut world = World::new();
        world.insert_resource(Assets::<Mesh>::default());
        world.insert_resource(GlobalAmbient(color(self.ambient)));
        let camera = Camera {
            background: color(self.background),
            viewer: self.viewer,
            encoding: self.encoding,
            ..Camera::perspective(self.fov)
        };
        world.spawn((camera, GlobalTransform::from(self.world_from_camera())));
        for lamp in &self.lamps {
            spawn(&mut world, lamp);
        }
        for thing in &self.things {
            let mesh = world.resource_mut::<Assets<Mesh>>().add(thing.mesh.clone());
            let looks = (thing.front.material(), thing.shading, thing.reflectance, thing.faces);
            let mut entity = world.spawn((Mesh3d(mesh), GlobalTransform::from(thing.place), looks));
            if let Some(back) = &thing.back {
                entity.insert(BackMaterial(back.material()));
            }
        }
        world
    }

    /// The oracle as it judges pictures of bytes.
    pub(crate) fn oracle(&self) -> Oracle {
        let oracle = Oracle::new(&mut self.world(), UVec2::new(SIZE.0, SIZE.1));
        oracle.expect("the task can be drawn").with_clamping(true)
    }
}

fn spawn(world: &mut World, lamp: &Lamp) {
    let [a, b, c] = lamp.attenuation;
    let point = PointLight {
        ambient: color(lamp.la),
        diffuse: color(lamp.ld),
        specular: color(lamp.ls),
        attenuation: Attenuation::new(a, b, c),
        range: lamp.range,
        attenuate_ambient: lamp.attenuates_ambient,
    };
    let aimed = |at: Vec3, toward: Vec3| {
        GlobalTransform::from(Transform::from_translation(at).looking_to(toward, toward.any_orthonormal_vector()))
    };
    match lamp.kind {
        LampKind::Sun(toward) => {
            let sun = DirectionalLight { ambient: point.ambient, diffuse: point.diffuse, specular: point.specular };
            world.spawn((sun, aimed(Vec3::ZERO, toward)));
        }
        LampKind::Bulb(at) => {
            world.spawn((point, GlobalTransform::from_translation(at)));
        }
        LampKind::Spot { at, toward, cutoff, inner, exponent } => {
            let mut spot = SpotLight { light: point, ..SpotLight::white(cutoff) }.with_exponent(exponent);
            spot.cone.inner = inner;
            world.spawn((spot, aimed(at, toward)));
        }
    }
}
