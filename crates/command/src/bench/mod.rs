//! `halfway bench`: the benchmark scenes, each shading beside a constant colour in the same run; and what features cost.

mod app;
mod args;
mod cpu;
mod facts;
mod features;
mod own_process;
mod scenes;

pub(crate) use args::BenchArgs;

use crate::failure::Failure;
use crate::scenery::BenchmarkScene;
use args::Subject;

pub(crate) fn run(args: &BenchArgs) -> Result<(), Failure> {
    let scene = match args.subject {
        Subject::S1 => BenchmarkScene::S1,
        Subject::S2 => BenchmarkScene::S2,
        Subject::S3 => BenchmarkScene::S3,
        Subject::S4 => BenchmarkScene::S4,
        Subject::Features => return features::run(args),
    };
    match args.once {
        Some(mode) => own_process::once(args, scene, mode),
        None => scenes::run(args, scene),
    }
}
