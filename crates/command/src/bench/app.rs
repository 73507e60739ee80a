//! A benchmark scene as an App that is ready to run.

use halfway::prelude::*;

use super::args::{BenchArgs, BenchShading};
use crate::scenery::{Benchmark, BenchmarkScene};

pub(super) fn app(args: &BenchArgs, scene: BenchmarkScene, mode: BenchShading) -> App {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(size(args, scene)));
    app.add_plugins(Benchmark { scene, look: mode.look(), octahedra: args.octahedra });
    app.insert_resource(args.levels.allowed());
    finish(&mut app);
    app
}

/// Of its picture in pixels.
pub(super) fn size(args: &BenchArgs, scene: BenchmarkScene) -> UVec2 {
    args.size.unwrap_or(scene.size())
}

/// Runs what the plugins left to the end of their building.
pub(super) fn finish(app: &mut App) {
    app.finish();
    app.cleanup();
}
