//! The project's chores: `cargo xtask --help` lists them.
//!
//! Only the standard library is used, so that the first of them starts within seconds of a clone.

mod arguments;
mod cargo;
mod chores;
mod commands;
mod failure;
mod machine;
mod setup;
mod tally;

use std::process::ExitCode;

use arguments::Chore;

fn main() -> ExitCode {
    let chore = match arguments::parse(std::env::args_os().skip(1)) {
        Ok(chore) => chore,
        Err(problem) => {
            eprintln!("error: {problem}\n\nSee cargo xtask --help.");
            return ExitCode::from(2);
        }
    };
    let done = match chore {
        Chore::Help(page) => {
            println!("{page}");
            Ok(())
        }
        Chore::Demo(options) => chores::demo::run(&options),
        Chore::Test { setup } => chores::test::run(setup),
        Chore::Check => chores::check::run(),
        Chore::Docs { setup } => chores::docs::run(setup),
        Chore::Fuzz(options) => chores::fuzz::run(&options),
        Chore::Chart { setup, quick, scaling } => chores::chart::run(setup, quick, scaling),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("\nerror: {failure}");
            failure.exit_code()
        }
    }
}
