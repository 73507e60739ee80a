//! `cargo xtask readme`.

use std::process::Stdio;

use clap::Args;

use crate::cargo::{cargo, root, step};
use crate::commands::{self, PageCommand};
use crate::failure::{Failure, Result};

/// The pages whose commands are tested.
const PAGES: [&str; 2] = ["README.md", "docs/guide.md"];

/// Run the commands that the README and the guide show, but for the chores that .ci/run runs by itself
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
    /// Not run here: it is a step of `.ci/run`.
    Elsewhere,
    /// It has to end with success.
    Run,
}

/// Tries the commands of the pages, one after the other.
pub(crate) fn run(options: &Options) -> Result {
    // A command without a known test is found before any is run.
    let mut pages = Vec::new();
    for page in PAGES {
        pages.push((page, ways(page, commands::from_page(&root(), page)?)?));
    }
    for (page, commands) in pages {
        for (shown, way) in &commands {
            if options.list {
                println!("{:9} {}", format!("{way:?}"), shown.words.join(" "));
            } else if *way == Way::Run {
                let title = format!("{page}, line {}", shown.line);
                step(&title, cargo(&shown.words[1..]).stdin(Stdio::null()))?;
            }
        }
        if !options.list {
            eprintln!("\n{} commands of {page}: done", commands.len());
        }
    }
    Ok(())
}

/// Each command with the way it is tried.
///
/// # Errors
/// The page shows no command, or one without a known test.
fn ways(page: &str, commands: Vec<PageCommand>) -> Result<Vec<(PageCommand, Way)>> {
    if commands.is_empty() {
        return Err(Failure::new(format!("{page} shows no command")));
    }
    let known = commands.into_iter().map(|shown| {
        let Some(way) = way(&shown.words) else {
            let command = shown.words.join(" ");
            return Err(Failure::new(format!("{page}, line {}: no way to try this is known: {command}", shown.line)));
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
    fn the_pages_show_commands_that_are_known() {
        let ways_of = |commands| ways("README.md", commands).map_err(|failure| failure.to_string());
        for page in PAGES {
            let commands = commands::from_page(&root(), page).unwrap();
            assert!(ways_of(commands).is_ok_and(|commands| commands.iter().any(|(_, way)| *way == Way::Run)), "{page}");
        }
        let planted = commands::shown("```sh\ncargo run\nrm -r target\n```\n").unwrap();
        let expected = "README.md, line 3: no way to try this is known: rm -r target";
        assert_eq!(ways_of(planted), Err(expected.to_owned()));
        assert_eq!(ways_of(Vec::new()), Err("README.md shows no command".to_owned()));
    }

    #[test]
    fn the_readme_is_short_and_links_the_book_at_once() {
        let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
        assert!(readme.split_whitespace().count() < 600, "{} words", readme.split_whitespace().count());
        assert!(readme.lines().take(12).any(|line| line.contains("(docs/book/src/README.md)")));
    }
}
