//! The scenes that are timed, each a little different from another, and what their differences say.

use crate::device::adapter::Adapter;
use crate::device::costs::VertexPrices;
use crate::error::RenderError;
use crate::frame::report::FrameReport;
use crate::frame::sets::RenderSet;
use crate::frame::times::FrameTimes;
use crate::plugin::RenderPlugin;
use crate::target::format::Pixels;
use crate::target::frame::Headless;
use bevy_app::App;
use bevy_asset::Assets;
use bevy_color::LinearRgba;
use bevy_ecs::entity::Entity;
use bevy_math::{UVec2, Vec3};
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;
use halfway_lighting::{Attenuation, Camera, GlobalAmbient, Material, PointLight, Shading, Tolerance, ViewTolerance};
use halfway_mesh::{Mesh, Mesh3d, Plane, UvSphere};
use std::f32::consts::TAU;
use std::time::Instant;

/// How far the camera moves from frame to frame, there and back: too little for other patches to be seen.
const ASIDE: f32 = 1e-5;

/// How often all take turns. The least time of fewer may be one of those that something has disturbed.
const ROUNDS: usize = 12;

/// What each thing costs in a frame, in nanoseconds, by the least times over the rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Times {
    /// Each light after the first.
    pub(super) light_at_pixel: f64,
    pub(super) first_light_at_pixel: f64,
    pub(super) diffuse_at_pixel: f64,
    pub(super) specular_at_pixel: f64,
    pub(super) light_at_vertex: f64,
    /// Without lights.
    pub(super) vertex: f64,
    /// To bound what a light changes of a patch.
    pub(super) look: f64,
    /// To draw a patch apart.
    pub(super) draw: f64,
}

/// A scene that is timed.
struct Stage {
    app: App,
    adapter: Adapter,
    camera: Entity,
}

/// The scenes that are timed in turns.
pub(super) struct Stages {
    /// By [`Row`].
    rows: Vec<Stage>,
    adapter: Adapter,
    pixels: f64,
    vertices: f64,
}

/// A scene by its number.
#[derive(Clone, Copy)]
enum Row {
    NoLightAtPixels,
    OneAtPixels,
    FiveAtPixels,
    OneDiffuse,
    FiveDiffuse,
    OneSpecular,
    FiveSpecular,
    NoLightAtVertices,
    OneAtVertices,
    EightAtVertices,
    NotLooked,
    Looked,
    Together,
    Apart,
}

/// Lights at which a patch is looked in [`Row::Looked`].
const LOOKED_AT: u32 = 4;

/// How light is given back, where it is shaded, and by how many lights.
struct CalibrationScene {
    mesh: Mesh,
    size: UVec2,
    /// Of the camera above the surface.
    height: f32,
    material: Material,
    shading: Shading,
    tolerance: Tolerance,
    lights: Vec<(PointLight, Vec3)>,
    prices: Option<VertexPrices>,
}

fn grey(intensity: f32) -> LinearRgba {
    LinearRgba::rgb(intensity, intensity, intensity)
}

/// A shininess that is no power of two, as most are.
fn material() -> Material {
    Material { specular: LinearRgba::WHITE, shininess: 33.0, ..Material::matte(LinearRgba::rgb(0.55, 0.42, 0.3)) }
}

/// Lights on a circle above the surface, none of which is out of anything's reach.
fn circle(count: u32) -> Vec<(PointLight, Vec3)> {
    let at = |i: u32| {
        let (sin, cos) = (TAU * i as f32 / count as f32).sin_cos();
        Vec3::new(1.2 * cos, 2.5, 1.2 * sin)
    };
    let light = PointLight { attenuation: Attenuation::new(1.0, 0.1, 0.05), ..PointLight::from_color(grey(0.3)) };
    (0..count).map(|i| (light, at(i))).collect()
}

/// 24 lights near the surface, each of which reaches a part of it, or all.
fn grid(range: Option<f32>) -> Vec<(PointLight, Vec3)> {
    let light = PointLight { attenuation: Attenuation::NONE, range, ..PointLight::from_color(grey(0.3)) };
    let at = |i: u16| {
        let (column, row) = (f32::from(i % 6), f32::from(i / 6));
        Vec3::new(0.6 * (column - 2.5) + 0.1 * (row % 2.0), 0.3, 0.9 * (row - 1.5))
    };
    (0..24).map(|i| (light, at(i))).collect()
}

impl CalibrationScene {
    /// A square that fills the picture, shaded at each of its pixels.
    fn at_pixels(size: UVec2, material: Material, lights: u32) -> Self {
        Self {
            mesh: Mesh::from(Plane { size: 4.0, divisions: 1 }),
            size,
            height: 3.4,
            material,
            shading: Shading::Phong,
            tolerance: Tolerance::EXACT,
            lights: circle(lights),
            prices: None,
        }
    }

    /// A square of many vertices on hardly any pixels.
    fn at_vertices(divisions: u32, lights: u32) -> Self {
        let mesh = Mesh::from(Plane { size: 4.0, divisions });
        let size = UVec2::splat(16);
        Self { mesh, size, height: 6.0, shading: Shading::Gouraud, ..Self::at_pixels(size, material(), lights) }
    }

    /// A square of 512 patches on hardly any pixels, which is not drawn by what is found of its lights.
    fn in_patches(prices: VertexPrices) -> Self {
        // Highlights so wide that no light is left out of any patch.
        let material = Material { shininess: 2.0, ..material() };
        let tolerance = Tolerance::steps(1.0);
        let prices = Some(prices);
        Self { material, shading: Shading::Auto, tolerance, prices, ..Self::at_vertices(128, LOOKED_AT) }
    }

    fn apart(range: Option<f32>) -> Self {
        Self { shading: Shading::Phong, lights: grid(range), ..Self::at_vertices(128, 0) }
    }

    /// A ball of about 600 patches, such as might be looked at.
    fn ball(prices: VertexPrices) -> Self {
        Self {
            mesh: Mesh::from(UvSphere::new(1.0, 192, 96)),
            shading: Shading::Auto,
            tolerance: Tolerance::steps(1.0),
            prices: Some(prices),
            ..Self::at_pixels(UVec2::new(640, 480), material(), LOOKED_AT)
        }
    }

    fn on(self, adapter: &Adapter) -> Result<Stage, RenderError> {
        let mut app = App::new();
        adapter.clone().insert_into(app.world_mut());
        app.add_plugins((TransformPlugin, RenderPlugin::default()));
        app.insert_resource(Headless { size: self.size, pixels: Pixels::Byte })
            .insert_resource(GlobalAmbient(grey(0.1)))
            .insert_resource(ViewTolerance(self.tolerance));
        if let Some(prices) = self.prices {
            app.insert_resource(prices);
        }
        app.finish();
        app.cleanup();
        let world = app.world_mut();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(self.mesh);
        let above = Transform::from_xyz(0.0, self.height, 0.0).looking_at(Vec3::ZERO, Vec3::NEG_Z);
        let camera = world.spawn((Camera::default(), above)).id();
        world.spawn((Mesh3d(mesh), self.material, self.shading, Transform::default()));
        for (light, at) in self.lights {
            world.spawn((light, Transform::from_translation(at)));
        }
        let mut stage = Stage { app, adapter: adapter.clone(), camera };
        // Pipelines are built, and meshes are uploaded.
        for _ in 0..3 {
            stage.frame()?;
        }
        Ok(stage)
    }
}

impl Stage {
    /// The nanoseconds of a frame until the device has finished it. The camera moves by next to nothing before, so that
    /// nothing is kept of the frame before.
    fn frame(&mut self) -> Result<f64, RenderError> {
        if let Some(mut camera) = self.app.world_mut().get_mut::<Transform>(self.camera) {
            camera.translation.x = if camera.translation.x > 0.0 { 0.0 } else { ASIDE };
        }
        let start = Instant::now();
        self.app.update();
        if let Some(error) = self.report().errors.first() {
            return Err(error.clone());
        }
        self.adapter.finish()?;
        Ok(start.elapsed().as_secs_f64() * 1e9)
    }

    fn report(&self) -> &FrameReport {
        self.app.world().resource::<FrameReport>()
    }

    /// The patches that were drawn.
    fn patches(&self) -> f64 {
        let FrameReport { patches, patches_culled, .. } = *self.report();
        f64::from(patches.saturating_sub(patches_culled).max(1))
    }

    /// What the CPU took for the lights of the newest frame, in nanoseconds.
    fn illuminated(&self) -> f64 {
        self.app.world().resource::<FrameTimes>().newest().of(RenderSet::Illuminate).as_secs_f64() * 1e9
    }
}

/// Prices by which each light of each patch is looked at, and none is moved.
const LOOK: VertexPrices = VertexPrices { light: 1e9, pixel: 1e12, look: 0.0, draw: 0.0, ..VertexPrices::FREE };

impl Stages {
    /// Builds the scenes. A graphics card gets more of each, so that it has something to do.
    pub(super) fn new(adapter: &Adapter) -> Result<Self, RenderError> {
        let (size, divisions) =
            if adapter.is_software() { (UVec2::new(512, 384), 160) } else { (UVec2::new(2048, 1536), 400) };
        let matte = Material { specular: LinearRgba::BLACK, ..material() };
        let shiny = Material { diffuse: LinearRgba::BLACK, ..material() };
        let at_pixels = |material, lights| CalibrationScene::at_pixels(size, material, lights);
        let at_vertices = |lights| CalibrationScene::at_vertices(divisions, lights);
        // In the order of `Row`.
        let rows = [
            at_pixels(material(), 0),
            at_pixels(material(), 1),
            at_pixels(material(), 5),
            at_pixels(matte, 1),
            at_pixels(matte, 5),
            at_pixels(shiny, 1),
            at_pixels(shiny, 5),
            at_vertices(0),
            at_vertices(1),
            at_vertices(8),
            CalibrationScene::in_patches(VertexPrices::NEVER),
            CalibrationScene::in_patches(LOOK),
            CalibrationScene::apart(None),
            CalibrationScene::apart(Some(0.5)),
        ];
        Ok(Self {
            rows: rows.into_iter().map(|shown| shown.on(adapter)).collect::<Result<_, _>>()?,
            adapter: adapter.clone(),
            pixels: f64::from(size.x) * f64::from(size.y),
            vertices: f64::from(divisions + 1).powi(2),
        })
    }

    /// Times all in turns.
    pub(super) fn time(&mut self) -> Result<Times, RenderError> {
        let mut frames = vec![f64::INFINITY; self.rows.len()];
        let mut illuminated = vec![f64::INFINITY; self.rows.len()];
        for round in 0..ROUNDS {
            for i in 0..self.rows.len() {
                // Each round begins with another.
                let row = (i + round) % self.rows.len();
                let stage = &mut self.rows[row];
                // The first frame warms the caches that the others have cooled.
                stage.frame()?;
                frames[row] = stage.frame()?.min(frames[row]);
                illuminated[row] = stage.illuminated().min(illuminated[row]);
            }
        }
        let of = |times: &[f64], more: Row, less: Row| times[more as usize] - times[less as usize];
        let more = |more, less| of(&frames, more, less);
        let (pixels, vertices) = (self.pixels, self.vertices);
        let [looked, together, apart] = [Row::Looked, Row::Together, Row::Apart].map(|row| &self.rows[row as usize]);
        let look = of(&illuminated, Row::Looked, Row::NotLooked) / (looked.patches() * f64::from(LOOKED_AT));
        // Lights out of reach are not looked at.
        let [pairs, fewer] = [together, apart].map(|stage| stage.report().light_pairs as f64);
        let draws = f64::from(apart.report().draws.saturating_sub(together.report().draws));
        let apart = if draws < 32.0 { apart.patches() } else { draws };
        Ok(Times {
            light_at_pixel: more(Row::FiveAtPixels, Row::OneAtPixels) / (4.0 * pixels),
            first_light_at_pixel: more(Row::OneAtPixels, Row::NoLightAtPixels) / pixels,
            diffuse_at_pixel: more(Row::FiveDiffuse, Row::OneDiffuse) / (4.0 * pixels),
            specular_at_pixel: more(Row::FiveSpecular, Row::OneSpecular) / (4.0 * pixels),
            light_at_vertex: more(Row::EightAtVertices, Row::OneAtVertices) / (7.0 * vertices),
            vertex: frames[Row::NoLightAtVertices as usize] / vertices,
            look,
            draw: (more(Row::Apart, Row::Together) + look * (pairs - fewer)) / apart,
        })
    }

    /// How long a frame takes by these prices, as a multiple of one by the adapter's `own`.
    pub(super) fn trial(&self, own: VertexPrices, prices: VertexPrices) -> Result<f64, RenderError> {
        let mut own = CalibrationScene::ball(own).on(&self.adapter)?;
        let mut other = CalibrationScene::ball(prices).on(&self.adapter)?;
        let mut least = [f64::INFINITY; 2];
        for _ in 0..ROUNDS {
            for (least, stage) in least.iter_mut().zip([&mut own, &mut other]) {
                stage.frame()?;
                *least = stage.frame()?.min(*least);
            }
        }
        Ok(least[1] / least[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::cpu::Cpu;

    /// What is kept takes no time, and would have no price.
    #[test]
    fn no_frame_that_is_timed_is_kept() {
        let adapter = Adapter::Cpu(Cpu::open().expect("threads"));
        for scene in [CalibrationScene::in_patches(LOOK), CalibrationScene::ball(VertexPrices::FREE)] {
            let mut stage = scene.on(&adapter).expect("a scene");
            for _ in 0..4 {
                stage.frame().expect("a frame");
                let FrameReport { kept, light_pairs, .. } = *stage.report();
                assert!(!kept && light_pairs > 0, "{light_pairs} pairs");
            }
        }
    }
}
