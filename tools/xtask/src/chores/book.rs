//! `cargo xtask book`.

use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use super::program::{Program, build};
use crate::book::{chapters, questions, site};
use crate::cargo::{announce, cargo, not_started, root, step, written};
use crate::failure::{Failure, Result};
use crate::setup::Setup;

/// The version of mdBook.
const MDBOOK: &str = "0.5.4";
/// The folder that it is installed into: its version here is not the machine's.
const TOOLS: &str = "target/tools";
/// The folder of `book.toml`.
const BOOK: &str = "docs/book";
/// The built book, as `book.toml` says.
const BUILT: &str = "out/book";

/// Build the book of docs/book into out/book, check its links, and try the commands of its questions
///
/// The built book opens offline: out/book/index.html. The lines of code in it are included from the sources; the chapters
/// of known failures are drawn anew. A command of a question has to print the lines that the chapter shows.
/// mdBook is installed into target/tools where it is missing.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// Do not try the commands of the questions
    #[arg(long)]
    no_questions: bool,
}

/// Builds and checks the book.
pub(crate) fn run(options: &Options) -> Result {
    let root = root();
    chapters::check(&root)?;
    let chapters = chapters::all(&root)?;
    let mdbook = have_mdbook(options.setup)?;
    let halfway = build(Program::Binary("halfway"))?;
    draw_failures(&halfway)?;
    step("the book", Command::new(mdbook).args(["build", BOOK]).current_dir(&root))?;
    for name in chapters.iter().flat_map(chapters::Chapter::pictures) {
        copy(&root.join("docs/pictures").join(&name), &root.join(BUILT).join("pictures").join(&name))?;
    }
    site::check(&root.join(BUILT))?;
    if !options.no_questions {
        for chapter in &chapters {
            let failed = |problem: String| Failure::new(format!("{}, {problem}", chapter.file));
            for question in questions::of(&chapter.text).map_err(failed)? {
                answer(&halfway, &question, &chapter.file)?;
            }
        }
    }
    eprintln!("\nthe book: {}", root.join(BUILT).join("index.html").display());
    Ok(())
}

/// The program of mdBook, which is installed if it is missing. A build that is not optimised takes half the time, and
/// the book is small.
fn have_mdbook(setup: Setup) -> Result<PathBuf> {
    let program = root().join(TOOLS).join("bin").join(format!("mdbook{}", std::env::consts::EXE_SUFFIX));
    let version = Command::new(&program).arg("--version").output();
    if version.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).contains(MDBOOK)) {
        return Ok(program);
    }
    let mut install = cargo(["install", "mdbook", "--version", MDBOOK, "--locked", "--debug", "--root", TOOLS]);
    install.args(["--no-default-features", "--features", "search"]);
    if setup.no_install {
        let command = written(&install);
        return Err(Failure::new(format!(
            "missing: mdBook\nNothing was installed: --no-install was given. Try:\n\n    {command}"
        )));
    }
    step("installing mdBook", &mut install)?;
    Ok(program)
}

/// Writes the chapters of known failures anew.
fn draw_failures(halfway: &Path) -> Result {
    let folder = format!("{}/{}", chapters::SOURCE, chapters::FAILURES);
    match std::fs::remove_dir_all(root().join(&folder)) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            return Err(Failure::new(format!("{folder}: {error}")));
        }
        _ => {}
    }
    step("known failures", on_the_cpu(halfway).args(["chart", "--failures=chapters", "-o", &folder]))?;
    chapters::check_failures(&root())
}

fn copy(from: &Path, to: &Path) -> Result {
    let failed = |error| Failure::new(format!("{}: {error}", from.display()));
    to.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(failed)?;
    std::fs::copy(from, to).map(drop).map_err(failed)
}

/// A program, in the root; the answers are those of the CPU, which are the same everywhere.
fn on_the_cpu(program: &Path) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root()).env("HALFWAY_ADAPTER", "cpu");
    command
}

/// Runs the commands of a question and compares what they print.
fn answer(program: &Path, question: &questions::Question, file: &str) -> Result {
    let place = format!("{file}, line {}", question.line);
    let mut printed = String::new();
    for words in &question.commands {
        let mut command = on_the_cpu(program);
        command.args(&words[1..]);
        announce(&place, &command);
        let output = command.output().map_err(|error| not_started(&command, &error))?;
        let said = String::from_utf8_lossy(&output.stderr);
        // 4 says that pictures differ, which may be the answer.
        if !matches!(output.status.code(), Some(0 | 4)) {
            return Err(Failure::new(format!("{place}: {}: {}\n{said}", written(&command), output.status)));
        }
        printed += &String::from_utf8_lossy(&output.stdout);
        printed += &said;
    }
    match question.missing(&printed) {
        None => Ok(()),
        Some(line) => Err(Failure::new(format!(
            "{place}: the chapter shows a line that was not printed:\n{line}\n\nprinted:\n{printed}"
        ))),
    }
}
