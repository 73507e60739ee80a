//! Small worlds to draw.

use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{Affine3A, DVec3, Mat3, Mat4, UVec2, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_asset::{Assets, Handle};
use halfway_lighting::{Camera, DirectionalLight, GlobalAmbient, Material, Reflectance, Shading};
use halfway_mesh::{Mesh, Mesh3d};
use halfway_reference::{Image, Oracle};

/// A world under construction. The camera stands at the origin, looks along −Z and sees 90°.
pub(crate) struct Stage {
    pub(crate) world: World,
    pub(crate) camera: Entity,
}

impl Stage {
    /// No ambient light, a black background.
    pub(crate) fn new() -> Self {
        let mut world = World::new();
        world.insert_resource(Assets::<Mesh>::default());
        world.insert_resource(GlobalAmbient(LinearRgba::BLACK));
        let camera = Camera::perspective(std::f32::consts::FRAC_PI_2);
        let camera = world.spawn((camera, GlobalTransform::IDENTITY)).id();
        Self { world, camera }
    }

    pub(crate) fn camera(&mut self) -> Mut<'_, Camera> {
        self.world.get_mut(self.camera).expect("the stage has one")
    }

    pub(crate) fn mesh(&mut self, mesh: impl Into<Mesh>) -> Handle<Mesh> {
        self.world.resource_mut::<Assets<Mesh>>().add(mesh)
    }

    /// A mesh that lies as it is, with the components of `looks`.
    pub(crate) fn add(&mut self, mesh: impl Into<Mesh>, looks: impl Bundle) -> Entity {
        self.add_at(mesh, GlobalTransform::IDENTITY, looks)
    }

    pub(crate) fn add_at(
        &mut self,
        mesh: impl Into<Mesh>,
        at: impl Into<GlobalTransform>,
        looks: impl Bundle,
    ) -> Entity {
        let mesh = self.mesh(mesh);
        self.world.spawn((Mesh3d(mesh), at.into(), looks)).id()
    }

    /// A light whose rays travel along `direction`; exact where the direction is.
    pub(crate) fn sun(&mut self, light: DirectionalLight, direction: Vec3) {
        let matrix3 = Mat3::from_cols(Vec3::X, Vec3::Y, -direction);
        self.world.spawn((light, GlobalTransform::from(Affine3A::from_mat3(matrix3))));
    }

    pub(crate) fn oracle(&mut self, width: u32, height: u32) -> Oracle {
        Oracle::new(&mut self.world, UVec2::new(width, height)).expect("a scene that can be drawn")
    }

    pub(crate) fn draw(&mut self, width: u32, height: u32) -> Image {
        self.oracle(width, height).draw()
    }
}

pub(crate) fn grey(i: f32) -> LinearRgba {
    LinearRgba::rgb(i, i, i)
}

/// Shines by itself, unlit.
pub(crate) fn glow(red: f32, green: f32, blue: f32) -> Material {
    Material::emissive(LinearRgba::rgb(red, green, blue))
}

/// Gives back diffuse light only.
pub(crate) fn chalk(kd: f32) -> Material {
    Material { ambient: LinearRgba::BLACK, diffuse: grey(kd), ..Material::DEFAULT }
}

pub(crate) const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];
pub(crate) const REFLECTANCES: [Reflectance; 3] =
    [Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched];

/// One triangle.
pub(crate) fn triangle(corners: [Vec3; 3], normals: Option<[Vec3; 3]>) -> Mesh {
    Mesh::from_parts(corners.to_vec(), normals.map(|n| n.to_vec()), None, vec![0, 1, 2]).expect("a valid triangle")
}

/// A square of two triangles that faces +Z, its half edge `half`, at depth `depth`.
pub(crate) fn wall(half: f32, depth: f32) -> Mesh {
    panel(-half, half, -half, half, depth)
}

/// A rectangle of two triangles that faces +Z.
pub(crate) fn panel(left: f32, right: f32, bottom: f32, top: f32, depth: f32) -> Mesh {
    let corner = |x, y| Vec3::new(x, y, -depth);
    let corners = vec![corner(left, bottom), corner(right, bottom), corner(right, top), corner(left, top)];
    Mesh::from_parts(corners, Some(vec![Vec3::Z; 4]), None, vec![0, 1, 2, 0, 2, 3]).expect("a valid rectangle")
}

/// The ray through the centre of a pixel under the stage's camera, as far as depth 1.
pub(crate) fn ray(x: u32, y: u32, width: u32, height: u32) -> DVec3 {
    let half = (f64::from(std::f32::consts::FRAC_PI_2) * 0.5).tan();
    let [width, height] = [width, height].map(f64::from);
    let across = (f64::from(x) + 0.5) * 2.0 / width - 1.0;
    let up = 1.0 - (f64::from(y) + 0.5) * 2.0 / height;
    DVec3::new(across * half * width / height, up * half, -1.0)
}

/// f64 through a few hundred operations, on values of about 1.
pub(crate) const EXACT: f64 = 1e-12;

pub(crate) fn assert_close(what: &str, found: [f64; 3], expected: [f64; 3]) {
    for k in 0..3 {
        let error = (found[k] - expected[k]).abs();
        assert!(error <= EXACT * expected[k].abs().max(1.0), "{what}: {found:?} instead of {expected:?}");
    }
}

/// Equal to the bit.
pub(crate) fn assert_same(what: &str, found: [f64; 3], expected: [f64; 3]) {
    assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits), "{what}: {found:?} instead of {expected:?}");
}

pub(crate) fn scaled(x: f32, y: f32, z: f32) -> GlobalTransform {
    Mat4::from_scale(Vec3::new(x, y, z)).into()
}
