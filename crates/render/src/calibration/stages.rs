//! Where scenes are timed in turns, and what the differences of their times say.

use super::scenery::{LOOK, StagePlace, StagedScene, grey, material};
use super::trials::Trials;
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
use halfway_lighting::{Camera, GlobalAmbient, Material, Shading, ViewTolerance};
use halfway_mesh::{Mesh, Mesh3d};
use std::time::Instant;

/// How far the camera moves from frame to frame, there and back: too little for other patches to be seen.
const ASIDE: f32 = 1e-5;

/// How often all take turns. The least time of fewer may be one of those that something has disturbed.
const ROUNDS: usize = 12;

/// How often prices take turns.
const TRIALS: usize = 5;

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

/// A place at which one scene after the other is shown. They are drawn by the same buffers, into the same target: on
/// llvmpipe the same frame of two Apps takes up to 1.4 times as long in one as in the other, as memory happens to lie.
struct Stage {
    app: App,
    adapter: Adapter,
    camera: Entity,
    object: Entity,
    lights: Vec<Entity>,
}

impl Stage {
    fn new(StagePlace { mesh, size, height }: StagePlace, adapter: &Adapter) -> Self {
        let mut app = App::new();
        adapter.clone().insert_into(app.world_mut());
        app.add_plugins((TransformPlugin, RenderPlugin::default()));
        app.insert_resource(Headless { size, pixels: Pixels::Byte }).insert_resource(GlobalAmbient(grey(0.1)));
        app.finish();
        app.cleanup();
        let world = app.world_mut();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        let above = Transform::from_xyz(0.0, height, 0.0).looking_at(Vec3::ZERO, Vec3::NEG_Z);
        let camera = world.spawn((Camera::default(), above)).id();
        let object = world.spawn((Mesh3d(mesh), Transform::default())).id();
        Self { app, adapter: adapter.clone(), camera, object, lights: Vec::new() }
    }

    /// Shows this in place of what was shown.
    fn show(&mut self, shown: &StagedScene) {
        let world = self.app.world_mut();
        world.entity_mut(self.object).insert((shown.material, shown.shading));
        world.insert_resource(ViewTolerance(shown.tolerance));
        match shown.prices {
            Some(prices) => world.insert_resource(prices),
            None => drop(world.remove_resource::<VertexPrices>()),
        }
        for light in self.lights.drain(..) {
            world.despawn(light);
        }
        let at = |&(light, at)| world.spawn((light, Transform::from_translation(at))).id();
        self.lights.extend(shown.lights.iter().map(at));
    }

    /// The nanoseconds of a frame. The camera moves by next to nothing before, so that nothing is kept of the frame
    /// before.
    fn frame(&mut self) -> Result<f64, RenderError> {
        if let Some(mut camera) = self.app.world_mut().get_mut::<Transform>(self.camera) {
            camera.translation.x = if camera.translation.x > 0.0 { 0.0 } else { ASIDE };
        }
        self.still_frame()
    }

    /// The nanoseconds of a frame before which nothing moves, until the device has finished it.
    fn still_frame(&mut self) -> Result<f64, RenderError> {
        let start = Instant::now();
        self.app.update();
        if let Some(error) = self.report().errors.first() {
            return Err(error.clone());
        }
        self.adapter.finish()?;
        Ok(start.elapsed().as_secs_f64() * 1e9)
    }

    /// That of this scene, of the second frame: the first one warms the caches that others have cooled.
    fn frame_of(&mut self, shown: &StagedScene) -> Result<f64, RenderError> {
        self.show(shown);
        self.frame()?;
        self.frame()
    }

    fn report(&self) -> &FrameReport {
        self.app.world().resource::<FrameReport>()
    }

    /// What the CPU took for the lights of the newest frame, in nanoseconds.
    fn illuminated(&self) -> f64 {
        self.app.world().resource::<FrameTimes>().newest().of(RenderSet::Illuminate).as_secs_f64() * 1e9
    }
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

/// The least times of a scene, in nanoseconds, and what was drawn.
#[derive(Clone, Copy)]
struct Found {
    frame: f64,
    /// Of the CPU, for lights, and of all else.
    illuminated: f64,
    rest: f64,
    patches: f64,
    pairs: f64,
    draws: u32,
}

impl Found {
    const NOTHING: Self = Self {
        frame: f64::INFINITY,
        illuminated: f64::INFINITY,
        rest: f64::INFINITY,
        patches: 1.0,
        pairs: 0.0,
        draws: 0,
    };

    /// Of one more frame, that which the stage has shown.
    fn and(self, frame: f64, stage: &Stage) -> Self {
        let FrameReport { patches, patches_culled, light_pairs, draws, .. } = *stage.report();
        let illuminated = stage.illuminated();
        Self {
            frame: self.frame.min(frame),
            illuminated: self.illuminated.min(illuminated),
            rest: self.rest.min(frame - illuminated),
            patches: f64::from(patches.saturating_sub(patches_culled).max(1)),
            pairs: light_pairs as f64,
            draws,
        }
    }
}

/// The scenes that are timed in turns.
pub(super) struct Stages {
    each: [Stage; 3],
    /// By [`Row`]: which stage, and what it shows.
    rows: Vec<(usize, StagedScene)>,
    adapter: Adapter,
    pixels: f64,
    vertices: f64,
}

impl Stages {
    /// Builds the scenes. A graphics card gets more of each, so that it has something to do.
    pub(super) fn new(adapter: &Adapter) -> Self {
        let (size, divisions) =
            if adapter.is_software() { (UVec2::new(512, 384), 256) } else { (UVec2::new(2048, 1536), 400) };
        let matte = Material { specular: LinearRgba::BLACK, ..material() };
        let shiny = Material { diffuse: LinearRgba::BLACK, ..material() };
        let at_pixels = |material, lights| (0, StagedScene::under(Shading::Phong, material, lights));
        let at_vertices = |lights| (1, StagedScene::under(Shading::Gouraud, material(), lights));
        // In the order of `Row`.
        let rows = vec![
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
            (2, StagedScene::looked_at(VertexPrices::NEVER)),
            (2, StagedScene::looked_at(LOOK)),
            (2, StagedScene::in_reach(None)),
            (2, StagedScene::in_reach(Some(0.5))),
        ];
        let places = [StagePlace::of_pixels(size), StagePlace::of_vertices(divisions), StagePlace::of_vertices(128)];
        Self {
            each: places.map(|place| Stage::new(place, adapter)),
            rows,
            adapter: adapter.clone(),
            pixels: f64::from(size.x) * f64::from(size.y),
            vertices: f64::from(divisions + 1).powi(2),
        }
    }

    /// Times all in turns.
    pub(super) fn time(&mut self) -> Result<Times, RenderError> {
        for (stage, shown) in &self.rows {
            // Pipelines are built, and meshes are uploaded.
            self.each[*stage].frame_of(shown)?;
        }
        let mut found = vec![Found::NOTHING; self.rows.len()];
        for round in 0..ROUNDS {
            for i in 0..self.rows.len() {
                // Each round begins with another.
                let row = (i + round) % self.rows.len();
                let (stage, shown) = &self.rows[row];
                let stage = &mut self.each[*stage];
                let frame = stage.frame_of(shown)?;
                found[row] = found[row].and(frame, stage);
            }
        }
        let of = |row: Row| found[row as usize];
        let more = |more: Row, less: Row| of(more).frame - of(less).frame;
        let (pixels, vertices) = (self.pixels, self.vertices);
        let [not_looked, looked, together, apart] = [Row::NotLooked, Row::Looked, Row::Together, Row::Apart].map(of);
        // Patches of few pixels are looked at together.
        let look = (looked.illuminated - not_looked.illuminated) / looked.pairs.max(1.0);
        let draws = f64::from(apart.draws.saturating_sub(together.draws));
        let drawn_apart = if draws < 32.0 { apart.patches } else { draws };
        Ok(Times {
            light_at_pixel: more(Row::FiveAtPixels, Row::OneAtPixels) / (4.0 * pixels),
            first_light_at_pixel: more(Row::OneAtPixels, Row::NoLightAtPixels) / pixels,
            diffuse_at_pixel: more(Row::FiveDiffuse, Row::OneDiffuse) / (4.0 * pixels),
            specular_at_pixel: more(Row::FiveSpecular, Row::OneSpecular) / (4.0 * pixels),
            light_at_vertex: more(Row::EightAtVertices, Row::OneAtVertices) / (7.0 * vertices),
            vertex: of(Row::NoLightAtVertices).frame / vertices,
            look,
            draw: (apart.rest - together.rest) / drawn_apart,
        })
    }

    /// Has frames drawn by each of these prices: of a dome on many pixels and on few, under few lights and many, and of
    /// a rough one, while the camera moves and while it does not.
    pub(super) fn trials(&self, prices: &[VertexPrices]) -> Result<Trials, RenderError> {
        let (large, small) = (UVec2::new(320, 240), UVec2::new(80, 60));
        let domes = [(large, 4, false), (large, 16, false), (small, 4, false), (large, 4, true)];
        let mut trials = Trials::default();
        for (size, lights, is_rough) in domes {
            let mut stage = Stage::new(StagePlace::of_dome(size, is_rough), &self.adapter);
            let shown: Vec<StagedScene> = prices.iter().map(|&prices| StagedScene::by(prices, lights)).collect();
            for shown in &shown {
                stage.frame_of(shown)?;
            }
            let mut rounds = [Vec::new(), Vec::new()];
            for round in 0..TRIALS {
                let mut times = [vec![0.0; prices.len()], vec![0.0; prices.len()]];
                for i in 0..prices.len() {
                    let turn = (i + round) % prices.len();
                    times[0][turn] = stage.frame_of(&shown[turn])?;
                    // The second frame of those that are alike keeps what the first has chosen.
                    stage.still_frame()?;
                    times[1][turn] = stage.still_frame()?;
                }
                for (rounds, times) in rounds.iter_mut().zip(times) {
                    rounds.push(times);
                }
            }
            trials.scenes.extend(rounds);
        }
        Ok(trials)
    }
}

#[cfg(test)]
mod tests {
    use super::super::scenery::LOOKED_AT;
    use super::*;
    use crate::device::cpu::Cpu;

    /// What is kept takes no time, and would have no price; what stands still is timed when it is kept.
    #[test]
    fn no_moving_frame_that_is_timed_is_kept() {
        let adapter = Adapter::Cpu(Cpu::open().expect("threads"));
        let scenes = [
            (StagePlace::of_vertices(128), StagedScene::looked_at(LOOK)),
            (StagePlace::of_dome(UVec2::new(160, 120), false), StagedScene::by(VertexPrices::FREE, LOOKED_AT)),
        ];
        for (place, shown) in scenes {
            let mut stage = Stage::new(place, &adapter);
            stage.show(&shown);
            for _ in 0..4 {
                stage.frame().expect("a frame");
                let FrameReport { kept, light_pairs, .. } = *stage.report();
                assert!(!kept && light_pairs > 0, "{light_pairs} pairs");
            }
            // Nor is the first that stands still; those after it are.
            for is_kept in [false, true, true] {
                stage.still_frame().expect("a frame");
                assert_eq!(stage.report().kept, is_kept);
            }
        }
    }

    /// Of a dome most may be shaded at the vertices, of a rough one little.
    #[test]
    fn little_of_a_rough_dome_may_move() {
        let adapter = Adapter::Cpu(Cpu::open().expect("threads"));
        let at_vertices = [false, true].map(|is_rough| {
            let mut stage = Stage::new(StagePlace::of_dome(UVec2::new(320, 240), is_rough), &adapter);
            stage.frame_of(&StagedScene::by(VertexPrices::FREE, 4)).expect("a frame");
            let FrameReport { terms_at_vertices, terms_at_fragments, .. } = *stage.report();
            (terms_at_vertices, terms_at_fragments)
        });
        let [(moved, left), (of_rough, _)] = at_vertices;
        assert!(moved > left && 3 * of_rough < moved, "{at_vertices:?}");
    }

    /// A stage has nothing left of what it showed before.
    #[test]
    fn what_is_shown_is_shown_alone() {
        let adapter = Adapter::Cpu(Cpu::open().expect("threads"));
        let mut stage = Stage::new(StagePlace::of_vertices(128), &adapter);
        let mut report = |shown: &StagedScene| {
            stage.frame_of(shown).expect("a frame");
            let FrameReport { lights, light_pairs, terms_at_vertices, .. } = *stage.report();
            (lights, light_pairs, terms_at_vertices)
        };
        let rows = [
            StagedScene::in_reach(Some(0.5)),
            StagedScene::by(VertexPrices::FREE, 16),
            StagedScene::under(Shading::Phong, material(), 1),
            StagedScene::looked_at(VertexPrices::NEVER),
        ];
        let first = rows.each_ref().map(&mut report);
        assert_eq!(first.map(|(lights, ..)| lights), [24, 16, 1, LOOKED_AT]);
        assert!(first[1].2 > 0 && first[3].2 == 0, "{first:?}");
        for (row, first) in rows.iter().zip(first).rev() {
            assert_eq!(report(row), first);
        }
    }
}
