//! The scenes that are measured.

use std::collections::HashMap;

use halfway::prelude::*;
use halfway::reference::{Image, Mode, Oracle};

use super::MeasureError;

/// What is looked at: a surface that is known by formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ChartObject {
    /// [`UvSphere`] of radius 1; level n has 2n meridians and n bands.
    Sphere,
    /// [`Teapot`]; level n cuts each patch into n × n cells.
    Teapot,
}

impl ChartObject {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Sphere, Self::Teapot];

    /// In a word, lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Teapot => "teapot",
        }
    }

    /// The `i`th of its levels, each twice as fine as the one before: 8, 16, 32 … for the sphere, 2, 4, 8 … for the
    /// teapot, whose triangles are then about as many.
    pub fn level(self, i: u32) -> u32 {
        match self {
            Self::Sphere => 8 << i,
            Self::Teapot => 2 << i,
        }
    }

    /// The object's mesh at a level.
    pub fn mesh(self, level: u32) -> Mesh {
        match self {
            Self::Sphere => UvSphere::new(1.0, 2 * level, level).into(),
            Self::Teapot => Teapot::new(level).into(),
        }
    }

    /// Where a camera of 45° sees all of the object, and little else.
    pub(crate) fn camera(self) -> Transform {
        match self {
            Self::Sphere => Transform::from_xyz(0.0, 0.0, 2.9),
            // The spout is farther from the axis than the handle.
            Self::Teapot => {
                let middle = Vec3::new(0.16, -0.05, 0.0);
                Transform::from_translation(middle + Vec3::new(0.0, 3.2, 6.0)).looking_at(middle, Vec3::Y)
            }
        }
    }
}

/// The longest edge of a mesh, in its units.
pub fn longest_edge(mesh: &Mesh) -> f64 {
    let at = |i: u32| mesh.positions()[i as usize].as_dvec3();
    let edges = mesh.triangles().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]);
    edges.map(|(a, b)| at(a).distance(at(b))).fold(0.0, f64::max)
}

/// One picture to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartScene {
    /// What is looked at.
    pub object: ChartObject,
    /// How finely it is tessellated.
    pub level: u32,
    /// How often it is shaded; `None` draws it in its ambient colour alone, without a light.
    pub shading: Option<Shading>,
    /// How it reflects.
    pub reflectance: Reflectance,
    /// Where the viewer is for the highlights.
    pub viewer: Viewer,
    /// What it is made of.
    pub material: Material,
    /// The direction toward the light, which is white and infinitely far away.
    pub light: Vec3,
}

impl ChartScene {
    /// The direction toward the light of the first two charts: from over the viewer's right shoulder.
    pub const LIGHT: Vec3 = Vec3::new(0.5, 0.7, 1.0);
    /// Ambient and diffuse colour: warm grey, whose channels lie apart, so that they do not err alike.
    const COLOR: LinearRgba = LinearRgba::rgb(0.55, 0.42, 0.30);

    /// An object under Phong shading with Blinn–Phong reflectance, shininess 32, seen from where the camera is.
    pub fn new(object: ChartObject, level: u32) -> Self {
        Self {
            object,
            level,
            shading: Some(Shading::Phong),
            reflectance: Reflectance::BlinnPhong,
            viewer: Viewer::Local,
            material: Self::shiny(),
            light: Self::LIGHT,
        }
    }

    /// Diffuse, with a highlight of shininess 32. The brightest sum stays below 1.
    pub fn shiny() -> Material {
        Material { specular: LinearRgba::rgb(0.35, 0.35, 0.35), shininess: 32.0, ..Self::matte() }
    }

    /// The same without a highlight.
    pub fn matte() -> Material {
        Material::matte(Self::COLOR)
    }

    /// A highlight and nothing else: kd = ka = 0.
    pub fn highlight() -> Material {
        Material { specular: LinearRgba::WHITE, shininess: 32.0, ..Material::matte(LinearRgba::BLACK) }
    }
}

/// An App that shows one [`ChartScene`] after another.
pub struct SceneApp {
    app: App,
    object: Entity,
    camera: Entity,
    light: Entity,
    meshes: HashMap<(ChartObject, u32), Handle<Mesh>>,
    size: UVec2,
}

impl SceneApp {
    /// A stage for the oracle, which needs no adapter.
    pub fn new(size: UVec2) -> Self {
        let mut app = App::new();
        app.add_plugins(HalfwayPlugins::reference());
        app.insert_resource(GlobalAmbient(LinearRgba::rgb(0.15, 0.15, 0.15)));
        app.finish();
        app.cleanup();
        let world = app.world_mut();
        let object = world.spawn(Transform::default()).id();
        let camera = world.spawn(Camera::default()).id();
        let light = world.spawn(DirectionalLight::white()).id();
        Self { app, object, camera, light, meshes: HashMap::new(), size }
    }

    /// Sets the scene; it is seen from the next frame on.
    pub fn show(&mut self, scene: &ChartScene) {
        let world = self.app.world_mut();
        let mesh = self
            .meshes
            .entry((scene.object, scene.level))
            .or_insert_with(|| world.resource_mut::<Assets<Mesh>>().add(scene.object.mesh(scene.level)));
        let light = Transform::default().looking_to(-scene.light, Vec3::Y);
        world.entity_mut(self.light).insert(light);
        world
            .entity_mut(self.camera)
            .insert((scene.object.camera(), Camera { viewer: scene.viewer, ..Camera::default() }));
        let mut object = world.entity_mut(self.object);
        object.insert((Mesh3d(mesh.clone()), scene.material, scene.reflectance));
        match scene.shading {
            Some(shading) => object.insert(shading).remove::<Terms>(),
            None => object.insert(Terms { diffuse: Frequency::Never, specular: Frequency::Never }),
        };
    }

    /// What the oracle draws.
    ///
    /// # Errors
    /// What it cannot draw.
    pub fn oracle(&mut self, mode: Mode) -> Result<Image, MeasureError> {
        self.app.update();
        Ok(Oracle::new(self.app.world_mut(), self.size)?.with_mode(mode).draw())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_edge_halves_as_the_level_doubles() {
        // In the limit: a Bézier patch is stretched unevenly, by 1/n over a cell of n × n.
        for object in ChartObject::ALL {
            let ratio = longest_edge(&object.mesh(64)) / longest_edge(&object.mesh(128));
            assert!((ratio - 2.0).abs() < 2.0 / 64.0, "{object:?}: {ratio}");
        }
        // A box's longest edge is the diagonal of its largest face.
        let cuboid = Mesh::from(Cuboid::new(3.0, 4.0, 1.0));
        assert!((longest_edge(&cuboid) - 5.0).abs() < 1e-6);
    }
}
