//! The project's chores: `cargo xtask --help` lists them.

mod book;
mod cargo;
mod checks;
mod chores;
mod commands;
mod display;
mod failure;
mod licences;
mod screen;
mod setup;
mod tally;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// The chores of this project
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Debug, Subcommand)]
enum Chore {
    Demo(chores::demo::Options),
    Test(chores::test::Options),
    Adapters(chores::adapters::Options),
    Arm(chores::arm::Options),
    Book(chores::book::Options),
    Check(chores::check::Options),
    /// Make the pictures and the schema in docs/ again, by the commands that docs/gallery.md shows
    Docs,
    Chart(chores::chart::Options),
    Fuzz(chores::fuzz::Options),
    InstallDesktop(chores::install_desktop::Options),
    Instructions(chores::instructions::Options),
    Readme(chores::readme::Options),
    Screen(chores::screen::Options),
    /// Run a scene in which everything changes for 100,000 frames, and fail where memory grows
    ///
    /// It also fails where a frame has an error, and where the last picture is another than that of the same scene in a
    /// new App. Arguments are those of the example `soak`: --frames N, at least 2000, and --leak, which has to fail.
    /// Without a graphics card the CPU draws.
    #[command(verbatim_doc_comment)]
    Soak(chores::program::Arguments),
    Wheel(chores::wheel::Options),
    /// mdBook's preprocessor for the book: JSON in, JSON out
    #[command(hide = true)]
    Preprocess,
    /// Draw random scenes, judge each by the reference renderer, and reduce failures
    ///
    /// A failure is printed and written to out/wild/ as a scene file. The same seed means the same scenes on every
    /// machine. Options are those of the program, such as --seed N, --scenes N and --adapter NAME:
    /// `cargo xtask wild -- --help` lists them.
    #[command(verbatim_doc_comment)]
    Wild(chores::program::Arguments),
}

impl Chore {
    fn run(self) -> failure::Result {
        match self {
            Self::Demo(options) => chores::demo::run(&options),
            Self::Test(options) => chores::test::run(&options),
            Self::Adapters(options) => chores::adapters::run(&options),
            Self::Arm(options) => chores::arm::run(&options),
            Self::Book(options) => chores::book::run(&options),
            Self::Check(options) => chores::check::run(&options),
            Self::Docs => chores::docs::run(),
            Self::Chart(options) => chores::chart::run(&options),
            Self::Fuzz(options) => chores::fuzz::run(&options),
            Self::InstallDesktop(options) => chores::install_desktop::run(&options),
            Self::Instructions(options) => chores::instructions::run(&options),
            Self::Readme(options) => chores::readme::run(&options),
            Self::Screen(options) => chores::screen::run(&options),
            Self::Preprocess => book::chapters::preprocess(std::io::stdin().lock(), std::io::stdout().lock()),
            Self::Soak(arguments) => chores::program::soak(&arguments),
            Self::Wheel(options) => chores::wheel::run(&options),
            Self::Wild(arguments) => chores::program::wild(&arguments),
        }
    }
}

fn main() -> ExitCode {
    match Arguments::parse().chore.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("\nerror: {failure}");
            failure.exit_code()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_are_understood() {
        let rows = [
            "demo --no-install",
            "demo --headless --model a.obj",
            "test",
            "test --all --no-install",
            "test --all --shared",
            "test --peers",
            "adapters --no-install",
            "arm",
            "arm --no-install bits",
            "book --no-install --no-questions",
            "check",
            "check circles doors",
            "docs",
            "chart --quick",
            "chart --filters",
            "fuzz smf --seconds 60 obj --no-install",
            "instructions --keep",
            "readme --list",
            "screen cargo test --release --test window",
            "soak",
            "soak --frames 3000",
            "wheel --test",
            "wheel --target aarch64-unknown-linux-gnu",
            "wild",
            "wild --seed 7 --scenes 1000 --output out/wild",
            "wild --first 12",
        ];
        for line in rows {
            let parsed = Arguments::try_parse_from(["xtask"].into_iter().chain(line.split(' ')));
            assert!(parsed.is_ok(), "{line}: {parsed:?}");
        }
    }

    #[test]
    fn other_lines_are_refused_by_name() {
        let rows = [
            ("demmo", "'demmo'"),
            ("demo --modle a.obj", "'--modle'"),
            ("demo --model", "'--model <FILE>'"),
            ("demo a.obj", "'a.obj'"),
            ("test --model a.obj", "'--model'"),
            ("test --shared", "--all"),
            ("test --all --peers", "--peers"),
            ("check circle", "'circle'"),
            ("fuzz --second 1", "'--second'"),
            ("fuzz --seconds", "'--seconds <N>'"),
            ("fuzz --seconds 0", "'0'"),
            ("fuzz --seconds smf", "'smf'"),
            ("screen", "<COMMAND>"),
        ];
        for (line, named) in rows {
            let problem = Arguments::try_parse_from(["xtask"].into_iter().chain(line.split(' '))).unwrap_err();
            assert_eq!(problem.exit_code(), 2, "{line}");
            assert!(problem.to_string().contains(named), "{line}: {problem}");
        }
    }

    #[test]
    fn help_fits_the_screen() {
        use clap::CommandFactory;
        let mut all = Arguments::command();
        all.build();
        for chore in all.get_subcommands_mut() {
            for line in chore.render_long_help().to_string().lines() {
                assert!(line.chars().count() <= 120, "{line}");
            }
        }
    }
}
