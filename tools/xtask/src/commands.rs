//! The commands in a page of documentation.

use std::path::Path;

use crate::failure::Failure;

/// A command of a page, cut into words.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct PageCommand {
    /// The line it starts on, from 1.
    pub(crate) line: usize,
    pub(crate) words: Vec<String>,
}

/// The commands of the page of that name in the folder `root`.
///
/// # Errors
/// The page cannot be read, or has a command that is more than a program and its arguments.
pub(crate) fn from_page(root: &Path, page: &str) -> crate::failure::Result<Vec<PageCommand>> {
    let text = std::fs::read_to_string(root.join(page)).map_err(|error| Failure::new(format!("{page}: {error}")))?;
    shown(&text).map_err(|problem| Failure::new(format!("{page}, {problem}")))
}

/// The commands in the code blocks of a Markdown page that are marked `sh`: a line each, or several with a `\` at the
/// end of all but the last. Comments are left out.
///
/// # Errors
/// The line and the problem of a command that is more than a program and its arguments.
pub(crate) fn shown(page: &str) -> Result<Vec<PageCommand>, String> {
    let mut commands = Vec::new();
    // The language of the block that the line is in.
    let mut block: Option<&str> = None;
    let mut open: Option<(usize, String)> = None;
    for (index, text) in page.lines().enumerate() {
        let text = text.trim();
        if let Some(language) = text.strip_prefix("```") {
            block = if block.is_none() { Some(language.trim()) } else { None };
            continue;
        }
        if block != Some("sh") {
            continue;
        }
        let (line, mut command) = open.take().unwrap_or((index + 1, String::new()));
        if let Some(part) = text.strip_suffix('\\') {
            command.push_str(part);
            open = Some((line, command));
            continue;
        }
        command.push_str(text);
        let words = words(&command).map_err(|problem| format!("line {line}: {problem}"))?;
        if !words.is_empty() {
            commands.push(PageCommand { line, words });
        }
    }
    match open {
        Some((line, _)) => Err(format!("line {line}: the command goes on after its last line")),
        None => Ok(commands),
    }
}

/// Cuts a command into words as a shell does, quotes and comments included. Further features of shells (variables,
/// pipes, several commands) are refused, quoted or not, because no shell is used here.
fn words(command: &str) -> Result<Vec<String>, String> {
    let words = shlex::split(command).ok_or("a quote has no end")?;
    match words.iter().flat_map(|word| word.chars()).find(|&c| "$`\\|&;<>*?()".contains(c)) {
        Some(c) => Err(format!("expected a program and its arguments, found the shell's {c}")),
        None => Ok(words),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "\
# Pictures

The command `cargo run` and

    cargo indented

are text.

```rust
fn main() {}
```

```sh
# Two pictures:
cargo run --example a -- --headless a.png

cargo run --example b -- \\
    --headless 'a file.png'   # the second
```
Text.
```text
cargo output
```
  ```sh
  cargo last \"\" {}.png
  ```
";

    #[test]
    fn commands_of_a_page() {
        let commands = shown(PAGE).unwrap();
        let found: Vec<_> = commands.iter().map(|shown| (shown.line, shown.words.join("|"))).collect();
        let expected = [
            (15, "cargo|run|--example|a|--|--headless|a.png"),
            (17, "cargo|run|--example|b|--|--headless|a file.png"),
            (25, "cargo|last||{}.png"),
        ];
        assert_eq!(found, expected.map(|(line, words)| (line, words.to_owned())));
    }

    #[test]
    fn shell_features_are_refused_with_their_line() {
        let rows = [
            ("cargo run | tee log", "line 3: expected a program and its arguments, found the shell's |"),
            ("cargo run > log", "the shell's >"),
            ("cargo run && ls", "the shell's &"),
            ("cargo run $HOME", "the shell's $"),
            ("cargo run \"$HOME\"", "the shell's $"),
            ("ls *.png", "the shell's *"),
            ("cargo run 'a", "line 3: a quote has no end"),
            ("cargo run \\", "line 3: the command goes on"),
        ];
        for (command, expected) in rows {
            let problem = shown(&format!("Text\n```sh\n{command}\n```\n")).unwrap_err();
            assert!(problem.contains(expected), "{command}: {problem}");
        }
    }

    #[test]
    fn quotes_keep_their_contents() {
        let rows = [
            ("a 'b c' d", vec!["a", "b c", "d"]),
            ("a'b'\"c\"d", vec!["abcd"]),
            ("'a#b' \"it's\" # and (more)", vec!["a#b", "it's"]),
            ("a#b #c", vec!["a#b"]),
            ("  ", vec![]),
        ];
        for (command, expected) in rows {
            assert_eq!(words(command).unwrap(), expected, "{command}");
        }
    }
}
