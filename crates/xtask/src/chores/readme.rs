//! `cargo xtask readme`.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use clap::Args;

use crate::cargo::{announce, cargo, ended, not_started, root, step};
use crate::commands::{self, PageCommand};
use crate::failure::{Failure, Result};
use crate::screen::VirtualScreen;
use crate::setup::{Setup, VIRTUAL_SCREEN, WINDOW_LIST, X11_WINDOWS};

const PAGE: &str = "README.md";
/// How long a window may take to open, after everything is built, on a busy machine.
const TO_OPEN: Duration = Duration::from_mins(2);
/// How long it must then stay.
const TO_STAY: Duration = Duration::from_secs(10);

/// Run the commands that the README shows, but for the chores that .ci/run runs by itself
///
/// A command that opens a window is built first; its window must then appear on a virtual screen and stay open.
/// A command that this chore does not know how to try is an error before any is run.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// Only print each command and how it is tried
    #[arg(long)]
    list: bool,
}

/// How a command is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// Not here: it is a step of `.ci/run`, or belongs to the machine or the project of the reader.
    Elsewhere,
    /// It has to end, and well.
    Run,
    /// It has to open a window and stay.
    Window,
}

/// Tries the page's commands, one after the other.
pub(crate) fn run(options: &Options) -> Result {
    let commands = ways(commands::of_page(&root(), PAGE)?)?;
    if options.list {
        for (shown, way) in &commands {
            println!("{:9} {}", format!("{way:?}"), shown.words.join(" "));
        }
        return Ok(());
    }
    if commands.iter().any(|(_, way)| *way == Way::Window) {
        options.setup.meet(&[VIRTUAL_SCREEN, WINDOW_LIST, X11_WINDOWS])?;
    }
    for (shown, way) in &commands {
        let title = format!("{PAGE}, line {}", shown.line);
        match way {
            Way::Elsewhere => {}
            Way::Run => step(&title, program(&shown.words).stdin(Stdio::null()))?,
            Way::Window => open_window(&title, &shown.words)?,
        }
    }
    eprintln!("\n{} commands of {PAGE}: done", commands.len());
    Ok(())
}

/// Each command with its way.
///
/// # Errors
/// No command is shown, or nobody has said how to try one.
fn ways(commands: Vec<PageCommand>) -> Result<Vec<(PageCommand, Way)>> {
    if commands.is_empty() {
        return Err(Failure::new(format!("{PAGE} shows no command")));
    }
    let known = commands.into_iter().map(|shown| {
        if let Some(way) = way(&shown.words) {
            Ok((shown, way))
        } else {
            let command = shown.words.join(" ");
            Err(Failure::new(format!("{PAGE}, line {}: no way to try this is known: {command}", shown.line)))
        }
    });
    known.collect()
}

fn way(words: &[String]) -> Option<Way> {
    /// Examples that draw without a window unless told otherwise.
    const HEADLESS: [&str; 2] = ["homework", "engine_module"];
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let example = words.iter().position(|&word| word == "--example").and_then(|place| words.get(place + 1));
    Some(match words[..] {
        ["cargo", "xtask", ref chore @ ..] => match chore {
            ["test" | "check" | "demo"] | ["test", "--all"] | ["chart", "--quick"] => Way::Elsewhere,
            _ => Way::Run,
        },
        ["git", "clone", ..] | ["cd", _] | ["cargo", "add", ..] | ["sudo", "apt-get", ..] | ["apt-get", ..] => {
            Way::Elsewhere
        }
        ["cargo", "run", ..] if words.contains(&"view") => Way::Window,
        ["halfway", "view", ..] => Way::Window,
        ["cargo", "run", ..] => match example {
            Some(name) if !HEADLESS.contains(name) && !words.contains(&"--headless") => Way::Window,
            _ => Way::Run,
        },
        ["halfway", ..] | ["cargo", "test", ..] | ["cargo", "install", "--path", ..] => Way::Run,
        _ => return None,
    })
}

/// The program of a command; `halfway` is the one that is built here.
fn program(words: &[String]) -> Command {
    if words[0] == "cargo" {
        return cargo(&words[1..]);
    }
    let built: PathBuf = root().join("target/release").join(&words[0]);
    let mut command = Command::new(if built.is_file() { built.as_path() } else { Path::new(&words[0]) });
    command.args(&words[1..]).current_dir(root());
    command
}

/// Builds first, so that only the program itself is waited for.
fn open_window(title: &str, words: &[String]) -> Result {
    if let Some(build) = build(words) {
        step(&format!("{title}: build"), &mut cargo(build))?;
    }
    let screen = VirtualScreen::start()?;
    let mut command = program(words);
    announce(title, screen.lend(command.stdin(Stdio::null())));
    let child = command.spawn().map_err(|error| not_started(&command, &error))?;
    stays_open(child, &command, || screen.has_window(), TO_OPEN, TO_STAY)
}

/// What `cargo run …` builds, as arguments of cargo.
fn build(words: &[String]) -> Option<Vec<&str>> {
    let words = words.strip_prefix(&["cargo".to_owned(), "run".to_owned()])?;
    let own = words.iter().map(String::as_str).take_while(|&word| word != "--");
    Some(std::iter::once("build").chain(own).collect())
}

/// Sees that a running program opens a window within a time, and that both are still there some time later; then ends
/// the program.
fn stays_open(
    mut child: Child,
    command: &Command,
    has_window: impl Fn() -> bool,
    to_open: Duration,
    to_stay: Duration,
) -> Result {
    let start = Instant::now();
    let mut opened = None;
    let outcome = loop {
        if let Some(status) = child.try_wait().map_err(|error| not_started(command, &error))? {
            return Err(Failure::new(format!("the window did not stay open: {}", ended(command, status))));
        }
        match (has_window(), opened) {
            (true, None) => opened = Some(Instant::now()),
            (true, Some(when)) if when.elapsed() >= to_stay => break Ok(()),
            (false, Some(_)) => break Err(Failure::new("the window closed, and its program goes on")),
            (false, None) if start.elapsed() >= to_open => {
                break Err(Failure::new(format!("no window opened in {} s", to_open.as_secs())));
            }
            _ => {}
        }
        std::thread::sleep(Duration::from_millis(100));
    };
    child.kill().and_then(|()| child.wait()).map_err(|error| not_started(command, &error))?;
    outcome
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<String> {
        line.split(' ').map(str::to_owned).collect()
    }

    #[test]
    fn each_command_is_tried_in_its_way() {
        let rows = [
            ("cargo xtask demo", Some(Way::Elsewhere)),
            ("cargo xtask chart --quick", Some(Way::Elsewhere)),
            ("cargo xtask chart", Some(Way::Run)),
            ("git clone x", Some(Way::Elsewhere)),
            ("cargo run --release -- render a.obj -o out/a.png", Some(Way::Run)),
            ("cargo run --release -- view a.obj", Some(Way::Window)),
            ("halfway view a.obj", Some(Way::Window)),
            ("halfway info a.obj", Some(Way::Run)),
            ("cargo run --release --example teapots", Some(Way::Window)),
            ("cargo run --release --example teapots -- --headless a.png", Some(Way::Run)),
            ("cargo run --release --example homework", Some(Way::Run)),
            ("rm -r target", None),
            ("cargo publish", None),
        ];
        for (line, expected) in rows {
            assert_eq!(way(&words(line)), expected, "{line}");
        }
    }

    #[test]
    fn the_readme_shows_commands_that_are_known() {
        let commands = commands::of_page(&root(), "README.md").unwrap();
        let ways_of = |commands| ways(commands).map_err(|failure| failure.to_string());
        assert!(ways_of(commands).is_ok_and(|commands| commands.iter().any(|(_, way)| *way == Way::Run)));
        let planted = commands::shown("```sh\ncargo run\nrm -r target\n```\n").unwrap();
        let expected = "README.md, line 3: no way to try this is known: rm -r target";
        assert_eq!(ways_of(planted), Err(expected.to_owned()));
        assert_eq!(ways_of(Vec::new()), Err("README.md shows no command".to_owned()));
    }

    #[test]
    fn windows_are_built_before_they_are_waited_for() {
        let line = words("cargo run --release --example teapots -- --model a.obj");
        assert_eq!(build(&line), Some(vec!["build", "--release", "--example", "teapots"]));
        assert_eq!(build(&words("halfway view a.obj")), None);
    }

    #[cfg(unix)]
    #[test]
    fn a_program_is_not_a_window() {
        use std::cell::Cell;
        let moment = Duration::from_millis(300);
        let tried = |script: &str, has_window: &dyn Fn() -> bool| {
            let mut command = Command::new("sh");
            let child = command.args(["-c", script]).spawn().unwrap();
            stays_open(child, &command, has_window, moment, moment).map_err(|failure| failure.to_string())
        };
        assert_eq!(tried("exec sleep 60", &|| true), Ok(()));
        // A linker at work, say.
        assert!(tried("exec sleep 60", &|| false).unwrap_err().contains("no window opened"));
        assert!(tried("exit 3", &|| true).unwrap_err().contains("exit code 3"));
        let looks = Cell::new(0);
        let briefly = || looks.replace(looks.get() + 1) == 0;
        assert!(tried("exec sleep 60", &briefly).unwrap_err().contains("the window closed"));
    }
}
