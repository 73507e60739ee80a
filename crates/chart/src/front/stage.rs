//! A scene in an App.

use std::collections::HashMap;

use halfway::prelude::*;
use halfway::reference::{Image, Mode, Oracle};
use halfway::render::Adapter;

use super::errors::Truth;
use super::{ChartedScene, Method, SceneDetail, Still};
use crate::error::ChartError;
use crate::timing::settle;

/// The meshes of one scene, simplified: computed once for all of its Apps, which create them in the same order.
#[derive(Default)]
pub(super) struct SimplifiedMeshes {
    by_detail: HashMap<u32, Vec<Mesh>>,
}

impl SimplifiedMeshes {
    /// Replaces the meshes of the world by simplified ones, if the detail asks for it.
    fn simplify(&mut self, world: &mut World, detail: SceneDetail) {
        let SceneDetail::Simplified(to) = detail else { return };
        let mut assets = world.resource_mut::<Assets<Mesh>>();
        let simplified = self.by_detail.entry(to).or_insert_with(|| {
            let left = |mesh: &Mesh| mesh.triangle_count().div_ceil(to as usize);
            assets.iter().map(|(_, mesh)| mesh.simplified(left(mesh), f64::INFINITY).mesh).collect()
        });
        for ((_, mesh), simplified) in assets.iter_mut().zip(simplified) {
            mesh.clone_from(simplified);
        }
    }
}

/// One scene at one detail, at its first moment until [`move_on`](SceneStage::move_on).
pub(super) struct SceneStage {
    app: App,
}

impl SceneStage {
    /// The scene, drawn by `adapter` with this method.
    pub(super) fn drawn(
        scene: &ChartedScene,
        detail: SceneDetail,
        method: Method,
        size: UVec2,
        adapter: &Adapter,
        meshes: &mut SimplifiedMeshes,
    ) -> Result<Self, ChartError> {
        let mut app = App::new();
        adapter.clone().insert_into(app.world_mut());
        app.add_plugins(HalfwayPlugins::headless(size));
        let mut stage = Self::new(app, scene, detail, meshes)?;
        method.apply(stage.app.world_mut());
        settle(&mut stage.app)?;
        Ok(stage)
    }

    fn new(
        mut app: App,
        scene: &ChartedScene,
        detail: SceneDetail,
        meshes: &mut SimplifiedMeshes,
    ) -> Result<Self, ChartError> {
        app.insert_resource(Still);
        (scene.build)(&mut app, detail).map_err(ChartError::Scene)?;
        app.finish();
        app.cleanup();
        // Runs the systems that spawn entities.
        app.update();
        meshes.simplify(app.world_mut(), detail);
        if let Some(reflectance) = scene.reflectance {
            let world = app.world_mut();
            let objects: Vec<Entity> = world.query_filtered::<Entity, With<Mesh3d>>().iter(world).collect();
            for object in objects {
                world.entity_mut(object).insert(reflectance);
            }
        }
        Ok(Self { app })
    }

    /// The true value of every pixel, by `samples` × `samples` of them for its average.
    pub(super) fn truth(scene: &ChartedScene, size: UVec2, samples: u32) -> Result<(Truth, Encoding), ChartError> {
        let mut app = App::new();
        app.add_plugins(HalfwayPlugins::reference());
        let mut stage = Self::new(app, scene, scene.true_detail, &mut SimplifiedMeshes::default())?;
        let world = stage.app.world_mut();
        let encoding =
            world.query::<&Camera>().iter(world).next().map_or_else(Encoding::default, |camera| camera.encoding);
        // A frame propagates the transforms.
        stage.app.update();
        let oracle = Oracle::new(stage.app.world_mut(), size)?.with_mode(Mode::Surface);
        let center = oracle.draw();
        let average = oracle.with_supersampling(samples).with_clamping(true).draw();
        Ok((Truth { center, average }, encoding))
    }

    /// The picture of the scene at this moment.
    pub(super) fn picture(&mut self, encoding: Encoding) -> Result<Image, ChartError> {
        Ok(match render_picture(&mut self.app)? {
            Picture::Byte(image) => Image::from_bytes(&image, encoding),
            Picture::Float(image) => Image::from_float(&image),
        })
    }

    /// Which pixels show an object. Nothing else can be drawn afterwards.
    pub(super) fn coverage(mut self) -> Result<Vec<bool>, ChartError> {
        let world = self.app.world_mut();
        world.insert_resource(GlobalAmbient(LinearRgba::BLACK));
        for mut material in world.query::<&mut Material>().iter_mut(world) {
            *material = Material::emissive(LinearRgba::WHITE);
        }
        for mut material in world.query::<&mut BackMaterial>().iter_mut(world) {
            material.0 = Material::emissive(LinearRgba::WHITE);
        }
        for mut camera in world.query::<&mut Camera>().iter_mut(world) {
            camera.background = LinearRgba::BLACK;
            camera.samples = Samples::One;
        }
        let picture = self.picture(Encoding::Raw)?.with_background([0.0; 3]);
        Ok(picture.covered().unwrap_or_default().to_vec())
    }

    /// Lets the scene move, if it is animated, and prepares it for timing.
    pub(super) fn move_on(&mut self) -> Result<(), ChartError> {
        self.app.world_mut().remove_resource::<Still>();
        Ok(settle(&mut self.app)?)
    }

    /// The triangles of its last frame.
    pub(super) fn triangles(&self) -> u64 {
        self.app.world().get_resource::<FrameReport>().map_or(0, |report| report.triangles)
    }

    pub(super) fn app(&mut self) -> &mut App {
        &mut self.app
    }
}
