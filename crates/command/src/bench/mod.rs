//! `halfway bench`: benchmark scenes, each shading relative to a constant colour in the same run; and the cost of
//! features and lights.

mod app;
mod args;
mod cpu;
mod facts;
mod features;
mod growth;
mod lights;
mod load;
mod own_process;
mod scenes;

pub(crate) use args::BenchArgs;

use crate::failure::Failure;
use crate::input::SceneInput;
use crate::scenery::BenchmarkScene;
use app::Timed;
use args::Subject;

pub(crate) fn run(args: &BenchArgs) -> Result<(), Failure> {
    args.expect_chart_of_growth()?;
    let timed = match args.subject() {
        Subject::Features => return features::run(args),
        Subject::Lights => return lights::run(args),
        Subject::Growth => return growth::run(args),
        Subject::Load(file) => return load::run(args, &file),
        Subject::Scene(BenchmarkScene::S2) => Timed::Made(BenchmarkScene::S2),
        _ if args.octahedra => {
            return Err("--octahedra: expected the subject s2, whose spheres it makes coarse".to_owned().into());
        }
        Subject::Scene(scene) => Timed::Made(scene),
        Subject::File(file) => {
            let mut input = SceneInput::open(&file)?;
            input.resize(args.size);
            Timed::Read(Box::new(input))
        }
    };
    match args.once {
        Some(mode) => own_process::once(args, &timed, mode),
        None => scenes::run(args, &timed),
    }
}
