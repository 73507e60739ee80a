//! A benchmark scene as an App, ready to run.

use halfway::prelude::*;
use halfway_chart::timing::TimedShading;

use super::args::{BenchArgs, BenchShading};
use crate::failure::Failure;
use crate::input::SceneInput;
use crate::scenery::{Benchmark, BenchmarkScene};
use halfway::scene::Turntable;

/// The timed scene: one of ours, or one from a file.
pub(super) enum Timed {
    Made(BenchmarkScene),
    Read(Box<SceneInput>),
}

impl Timed {
    pub(super) fn name(&self) -> String {
        match self {
            Self::Made(scene) => format!("{scene:?}"),
            Self::Read(input) => input.name(),
        }
    }

    /// The size of its picture in pixels.
    pub(super) fn size(&self, args: &BenchArgs) -> UVec2 {
        let own = match self {
            Self::Made(scene) => scene.size(),
            Self::Read(input) => UVec2::from_array(input.scene.size),
        };
        args.size.size.unwrap_or(own)
    }

    pub(super) fn app(&self, args: &BenchArgs, mode: BenchShading) -> Result<App, Failure> {
        let mut app = App::new();
        app.add_plugins(HalfwayPlugins::headless(self.size(args)));
        app.insert_resource(args.adapter.choice());
        let look = mode.look();
        match self {
            Self::Made(scene) => {
                app.add_plugins(Benchmark { scene: *scene, look, octahedra: args.octahedra });
            }
            Self::Read(input) => {
                let camera = input.spawn(&mut app)?.camera;
                // The camera turns, so that no two frames are the same.
                Turntable::turn(&mut app, camera, Vec3::Y, 1.0_f32.to_radians());
                shade(app.world_mut(), look);
            }
        }
        // Overrides the scene's.
        app.insert_resource(ViewTolerance(mode.tolerance(args.tolerance.or(Tolerance::EXACT))));
        finish(&mut app);
        Ok(app)
    }
}

/// Gives every object this shading in place of its own.
fn shade(world: &mut World, look: TimedShading) {
    let objects: Vec<Entity> = world.query_filtered::<Entity, With<Mesh3d>>().iter(world).collect();
    for object in objects {
        let mut object = world.entity_mut(object);
        object.insert(look.shading());
        if look == TimedShading::Constant {
            if let Some(mut material) = object.get_mut::<Material>() {
                *material = unlit(&material);
            }
            if let Some(mut back) = object.get_mut::<BackMaterial>() {
                back.0 = unlit(&back.0);
            }
        }
    }
}

/// In its diffuse color, without any light.
fn unlit(material: &Material) -> Material {
    Material { opacity: material.opacity, ..Material::emissive(material.diffuse) }
}

/// Runs the parts of building that the plugins left to the end.
pub(super) fn finish(app: &mut App) {
    app.finish();
    app.cleanup();
}
