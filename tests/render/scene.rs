//! A scene as plain data, which the stage spawns.

use halfway::lighting::Frequency;
use halfway::lighting::rotation_along;
use halfway::prelude::*;
use halfway::texture::environment::EnvironmentMap;
use halfway::texture::{Channel, FarNormals, Sampling, TexelImage, UvSet, UvTransform};

/// Everything that decides a picture, except its size.
#[derive(Clone)]
pub(crate) struct Scene {
    pub(crate) camera: Camera,
    pub(crate) eye: Transform,
    /// `Shading` and `Reflectance` on the camera.
    pub(crate) view_shading: Option<Shading>,
    pub(crate) view_reflectance: Option<Reflectance>,
    pub(crate) ambient: LinearRgba,
    pub(crate) lamps: Vec<Lamp>,
    pub(crate) things: Vec<Thing>,
    pub(crate) environment: Option<Around>,
}

/// An environment.
#[derive(Clone)]
pub(crate) struct Around {
    pub(crate) map: EnvironmentMap,
    pub(crate) strength: f32,
    pub(crate) rotation: f32,
    pub(crate) sky: bool,
}

#[derive(Clone, Debug)]
pub(crate) struct Lamp {
    pub(crate) kind: Kind,
    pub(crate) on: On,
    pub(crate) at: Transform,
}

#[derive(Clone, Debug)]
pub(crate) enum Kind {
    Directional(DirectionalLight),
    Point(PointLight),
    Spot(SpotLight),
    Hemisphere(HemisphereLight),
}

/// The frame that a lamp is attached to.
#[derive(Clone, Copy, Debug)]
pub(crate) enum On {
    World,
    Camera,
    Thing(usize),
}

/// An image on a thing.
#[derive(Clone)]
pub(crate) struct Map {
    pub(crate) image: TexelImage,
    pub(crate) sampling: Sampling,
    pub(crate) transform: UvTransform,
    pub(crate) uv_set: UvSet,
    pub(crate) channel: Channel,
    pub(crate) amount: f32,
    pub(crate) far_normals: FarNormals,
}

impl Map {
    /// The whole image.
    pub(crate) fn new(image: TexelImage) -> Self {
        let (sampling, transform) = (Sampling::default(), UvTransform::default());
        let (uv_set, channel, far_normals) = (UvSet::First, Channel::Red, FarNormals::Mean);
        Self { image, sampling, transform, uv_set, channel, amount: 1.0, far_normals }
    }
}

#[derive(Clone)]
pub(crate) struct Thing {
    pub(crate) name: Option<String>,
    pub(crate) mesh: Mesh,
    /// The transforms from the outermost parent to the object itself.
    pub(crate) frames: Vec<Transform>,
    pub(crate) material: Material,
    pub(crate) back: Option<Material>,
    pub(crate) shading: Option<Shading>,
    pub(crate) reflectance: Option<Reflectance>,
    pub(crate) faces: Option<Faces>,
    pub(crate) colors: Option<VertexColors>,
    pub(crate) maps: Vec<(MapKind, Map)>,
    pub(crate) mask: Option<f32>,
    pub(crate) solid: Option<SolidTexture>,
    pub(crate) blend: bool,
}

impl Scene {
    /// A camera at `eye` that looks at `target`, no lights and no global ambient.
    pub(crate) fn seen_from(eye: Vec3, target: Vec3) -> Self {
        Self {
            camera: Camera::default(),
            eye: Transform::from_translation(eye).looking_at(target, Vec3::Y),
            view_shading: None,
            view_reflectance: None,
            ambient: LinearRgba::BLACK,
            lamps: Vec::new(),
            things: Vec::new(),
            environment: None,
        }
    }

    /// A camera at the origin that looks along −Z, which makes world space eye space.
    pub(crate) fn in_eye_space() -> Self {
        Self::seen_from(Vec3::ZERO, Vec3::NEG_Z)
    }

    pub(crate) fn with(mut self, thing: Thing) -> Self {
        self.things.push(thing);
        self
    }

    pub(crate) fn lit(mut self, lamp: Lamp) -> Self {
        self.lamps.push(lamp);
        self
    }

    pub(crate) fn ambient(mut self, grey: f32) -> Self {
        self.ambient = LinearRgba::rgb(grey, grey, grey);
        self
    }
}

impl Lamp {
    pub(crate) fn point(light: PointLight, at: Vec3) -> Self {
        Self { kind: Kind::Point(light), on: On::World, at: Transform::from_translation(at) }
    }

    pub(crate) fn spot(light: SpotLight, at: Vec3, direction: Vec3) -> Self {
        Self { kind: Kind::Spot(light), on: On::World, at: shining(at, direction) }
    }

    pub(crate) fn directional(light: DirectionalLight, direction: Vec3) -> Self {
        Self { kind: Kind::Directional(light), on: On::World, at: shining(Vec3::ZERO, direction) }
    }

    pub(crate) fn hemisphere(light: HemisphereLight, up: Vec3) -> Self {
        let turned = Quat::from_rotation_arc(Vec3::Y, up.normalize());
        Self { kind: Kind::Hemisphere(light), on: On::World, at: Transform::from_rotation(turned) }
    }

    pub(crate) fn on(mut self, on: On) -> Self {
        self.on = on;
        self
    }
}

/// A transform at `at` whose −Z axis is `direction`.
pub(crate) fn shining(at: Vec3, direction: Vec3) -> Transform {
    Transform::from_translation(at).with_rotation(rotation_along(direction).expect("a direction"))
}

pub(crate) fn scaled(x: f32, y: f32, z: f32) -> Transform {
    Transform::from_scale(Vec3::new(x, y, z))
}

pub(crate) fn rotated(x: f32, y: f32, z: f32) -> Transform {
    Transform::from_rotation(Quat::from_euler(EulerRot::XYZ, x, y, z))
}

impl Thing {
    pub(crate) fn new(mesh: impl Into<Mesh>) -> Self {
        Self {
            name: None,
            mesh: mesh.into(),
            frames: vec![Transform::IDENTITY],
            material: material(),
            back: None,
            shading: None,
            reflectance: None,
            faces: None,
            colors: None,
            maps: Vec::new(),
            mask: None,
            solid: None,
            blend: false,
        }
    }

    /// A square of edge `size` about `center` whose front faces along `normal`.
    pub(crate) fn square(center: Vec3, normal: Vec3, size: f32) -> Self {
        let rotation = Quat::from_rotation_arc(Vec3::Y, normal.normalize());
        Self::new(Plane { size, divisions: 1 }).at(Transform::from_translation(center).with_rotation(rotation))
    }

    pub(crate) fn named(mut self, name: &str) -> Self {
        self.name = Some(name.into());
        self
    }

    pub(crate) fn at(mut self, transform: Transform) -> Self {
        self.frames = vec![transform];
        self
    }

    pub(crate) fn frames(mut self, frames: impl Into<Vec<Transform>>) -> Self {
        self.frames = frames.into();
        self
    }

    pub(crate) fn with_material(mut self, material: Material) -> Self {
        self.material = material;
        self
    }

    pub(crate) fn back(mut self, material: Material) -> Self {
        self.back = Some(material);
        self
    }

    pub(crate) fn shaded(mut self, shading: Shading) -> Self {
        self.shading = Some(shading);
        self
    }

    pub(crate) fn terms(mut self, diffuse: Frequency, specular: Frequency) -> Self {
        self.shading = Some(Shading::Terms(Terms { diffuse, specular }));
        self
    }

    pub(crate) fn reflecting(mut self, reflectance: Reflectance) -> Self {
        self.reflectance = Some(reflectance);
        self
    }

    pub(crate) fn faces(mut self, faces: Faces) -> Self {
        self.faces = Some(faces);
        self
    }

    pub(crate) fn blended(mut self, opacity: f32) -> Self {
        self.material.opacity = opacity;
        self.blend = true;
        self
    }
}

/// A material in which no two coefficients are equal, so that none can stand in for another. Its shininess is no power
/// of two.
pub(crate) fn material() -> Material {
    Material {
        ambient: LinearRgba::rgb(0.15, 0.25, 0.35),
        diffuse: LinearRgba::rgb(0.70, 0.45, 0.30),
        specular: LinearRgba::rgb(0.40, 0.60, 0.50),
        emission: LinearRgba::rgb(0.02, 0.01, 0.03),
        shininess: 19.5,
        ..Material::DEFAULT
    }
}

/// A second one, for back faces and second objects.
pub(crate) fn other_material() -> Material {
    Material {
        ambient: LinearRgba::rgb(0.30, 0.10, 0.20),
        diffuse: LinearRgba::rgb(0.20, 0.65, 0.80),
        specular: LinearRgba::rgb(0.55, 0.35, 0.25),
        emission: LinearRgba::rgb(0.01, 0.04, 0.02),
        shininess: 8.0,
        ..Material::DEFAULT
    }
}

/// Only ke: the pixel is exactly this grey.
pub(crate) fn glowing(red: f32, green: f32, blue: f32) -> Material {
    Material::emissive(LinearRgba::rgb(red, green, blue))
}

/// A point light in which no two colours or constants are equal.
pub(crate) fn point_light() -> PointLight {
    PointLight {
        ambient: LinearRgba::rgb(0.10, 0.05, 0.15),
        diffuse: LinearRgba::rgb(0.90, 0.80, 1.00),
        specular: LinearRgba::rgb(0.60, 1.00, 0.80),
        attenuation: Attenuation::new(0.8, 0.07, 0.03),
        range: None,
        attenuate_ambient: false,
    }
}

pub(crate) fn directional_light() -> DirectionalLight {
    let PointLight { ambient, diffuse, specular, .. } = point_light();
    DirectionalLight { ambient, diffuse, specular }
}
