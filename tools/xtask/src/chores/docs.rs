//! `cargo xtask docs`.

use crate::cargo::{announce, cargo, printed, root, step};
use crate::commands::{self, PageCommand};
use crate::failure::{Failure, Result};

/// The page whose commands make the pictures.
const PAGE: &str = "docs/gallery.md";
const SCHEMA: &str = "docs/scene.schema.json";

/// Makes schema and pictures again.
pub(crate) fn run() -> Result {
    // Refuses an invalid page before anything is built.
    let commands = drawing(commands::from_page(&root(), PAGE)?)?;
    step("build", &mut cargo(["build", "--release", "--bins", "--examples"]))?;
    schema()?;
    for command in &commands {
        step(&format!("{PAGE}, line {}", command.line), &mut cargo(&command.words[1..]))?;
    }
    eprintln!("\n{} commands of {PAGE} and the schema: done", commands.len());
    Ok(())
}

/// Writes the schema as the command prints it.
fn schema() -> Result {
    let mut command = cargo(["run", "--release", "--quiet", "--bin", "halfway", "--", "schema"]);
    announce(SCHEMA, &command);
    let output = printed(&mut command)?;
    let text = String::from_utf8_lossy(&output);
    let written = std::fs::write(root().join(SCHEMA), format!("{}\n", text.trim_end()));
    written.map_err(|error| Failure::new(format!("{SCHEMA}: {error}")))
}

/// The commands that draw: those that name a file to write to. The others open windows.
fn drawing(commands: Vec<PageCommand>) -> Result<Vec<PageCommand>> {
    let writes = |word: &String| ["--headless", "-o", "--output"].contains(&word.as_str());
    let drawing: Vec<_> = commands.into_iter().filter(|command| command.words.iter().any(writes)).collect();
    if let Some(other) = drawing.iter().find(|command| !command.words.starts_with(&["cargo".into(), "run".into()])) {
        let text = other.words.join(" ");
        return Err(Failure::new(format!("{PAGE}, line {}: expected cargo run …, found {text}", other.line)));
    }
    if drawing.is_empty() {
        return Err(Failure::new(format!("{PAGE} shows no command that writes a picture")));
    }
    Ok(drawing)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn commands(lines: &[&str]) -> Vec<PageCommand> {
        commands::shown(&format!("```sh\n{}\n```\n", lines.join("\n"))).unwrap()
    }

    #[test]
    fn commands_that_draw_are_chosen() {
        let lines = [
            "cargo run --example a",
            "cargo run --example a -- --headless a.png",
            "cargo run -- render b -o b.png",
            "cargo run --example homework",
        ];
        let lines: Vec<_> = drawing(commands(&lines)).unwrap().iter().map(|command| command.line).collect();
        assert_eq!(lines, [3, 4]);
    }

    #[test]
    fn the_page_can_be_read() {
        if let Err(problem) = commands::from_page(&root(), PAGE).and_then(drawing) {
            panic!("{problem}");
        }
    }

    #[test]
    fn other_programs_are_not_run() {
        for line in ["convert a -o b.png", "cargo install x --headless y", "cargo -o x"] {
            let problem = drawing(commands(&[line])).unwrap_err().to_string();
            assert!(problem.contains("docs/gallery.md, line 2: expected cargo run"), "{problem}");
        }
        assert!(
            drawing(commands(&["cargo run"])).unwrap_err().to_string().contains("no command that writes a picture")
        );
    }
}
