//! `cargo xtask readme`.

use std::process::Stdio;

use clap::Args;

use crate::cargo::{cargo, root, step};
use crate::commands::{self, PageCommand};
use crate::failure::{Failure, Result};

const PAGE: &str = "README.md";

/// Run the commands that the README shows, but for the chores that .ci/run runs by itself
///
/// A command that this chore does not know how to try is an error before any is run.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    /// Only print each command and how it is tried
    #[arg(long)]
    list: bool,
}

/// How a command is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// Not here: it is a step of `.ci/run`.
    Elsewhere,
    /// It has to end, and well.
    Run,
}

/// Tries the page's commands, one after the other.
pub(crate) fn run(options: &Options) -> Result {
    let commands = ways(commands::of_page(&root(), PAGE)?)?;
    for (shown, way) in &commands {
        if options.list {
            println!("{:9} {}", format!("{way:?}"), shown.words.join(" "));
        } else if *way == Way::Run {
            let title = format!("{PAGE}, line {}", shown.line);
            step(&title, cargo(&shown.words[1..]).stdin(Stdio::null()))?;
        }
    }
    if !options.list {
        eprintln!("\n{} commands of {PAGE}: done", commands.len());
    }
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
        let Some(way) = way(&shown.words) else {
            let command = shown.words.join(" ");
            return Err(Failure::new(format!("{PAGE}, line {}: no way to try this is known: {command}", shown.line)));
        };
        Ok((shown, way))
    });
    known.collect()
}

fn way(words: &[String]) -> Option<Way> {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words[..] {
        ["cargo", "xtask", "demo"]
        | ["cargo", "xtask", "test" | "check", ..]
        | ["cargo", "xtask", "chart", "--quick"] => Some(Way::Elsewhere),
        // It would wait for somebody to close its window.
        ["cargo", "run", ..] if words.contains(&"view") => None,
        ["cargo", "run", ..] if words.contains(&"--example") && !words.contains(&"--headless") => None,
        ["cargo", "xtask" | "run" | "test", ..] => Some(Way::Run),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_command_is_tried_in_its_way() {
        let rows = [
            ("cargo xtask demo", Some(Way::Elsewhere)),
            ("cargo xtask test --all", Some(Way::Elsewhere)),
            ("cargo xtask chart --quick", Some(Way::Elsewhere)),
            ("cargo xtask chart", Some(Way::Run)),
            ("cargo run --release -- render a.obj -o out/a.png", Some(Way::Run)),
            ("cargo run --release -- view a.obj", None),
            ("cargo run --release --example teapots", None),
            ("cargo run --release --example teapots -- --headless a.png", Some(Way::Run)),
            ("rm -r target", None),
            ("cargo publish", None),
        ];
        for (line, expected) in rows {
            let words: Vec<_> = line.split(' ').map(str::to_owned).collect();
            assert_eq!(way(&words), expected, "{line}");
        }
    }

    #[test]
    fn the_readme_shows_commands_that_are_known() {
        let commands = commands::of_page(&root(), PAGE).unwrap();
        let ways_of = |commands| ways(commands).map_err(|failure| failure.to_string());
        assert!(ways_of(commands).is_ok_and(|commands| commands.iter().any(|(_, way)| *way == Way::Run)));
        let planted = commands::shown("```sh\ncargo run\nrm -r target\n```\n").unwrap();
        let expected = "README.md, line 3: no way to try this is known: rm -r target";
        assert_eq!(ways_of(planted), Err(expected.to_owned()));
        assert_eq!(ways_of(Vec::new()), Err("README.md shows no command".to_owned()));
    }
}
