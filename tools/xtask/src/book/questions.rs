//! The questions of the chapters: the commands that answer them, and what these print.

use crate::commands;

/// Commands, and the lines of their output that the chapter shows after them.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Question {
    /// The line of the first command, from 1.
    pub(crate) line: usize,
    /// Each with its words.
    pub(crate) commands: Vec<Vec<String>>,
    pub(crate) expected: Vec<String>,
}

/// The questions of a chapter: blocks of code that are marked `sh`, and the blocks marked `text` after them.
///
/// # Errors
/// The line and the problem of a command that is not `halfway` with arguments.
pub(crate) fn of(chapter: &str) -> Result<Vec<Question>, String> {
    let texts = texts(chapter);
    let mut found: Vec<Question> = Vec::new();
    for command in commands::shown(chapter)? {
        if command.words.first().is_none_or(|program| program != "halfway") {
            return Err(format!("line {}: expected halfway …, found {}", command.line, command.words.join(" ")));
        }
        let expected: Vec<String> =
            texts.iter().filter(|(line, _)| *line > command.line).map(|(_, text)| text.clone()).collect();
        match found.last_mut() {
            // No text lies between the two.
            Some(last) if last.expected.len() == expected.len() => last.commands.push(command.words),
            _ => found.push(Question { line: command.line, commands: vec![command.words], expected }),
        }
    }
    // Each has the texts up to the next question.
    let counts: Vec<usize> = found.iter().skip(1).map(|next| next.expected.len()).chain([0]).collect();
    for (question, after) in found.iter_mut().zip(counts) {
        question.expected.truncate(question.expected.len() - after);
    }
    Ok(found)
}

/// The lines of the blocks marked `text`, with their numbers. Empty ones and `…`, which stands for lines that are left
/// out, do not count.
fn texts(chapter: &str) -> Vec<(usize, String)> {
    let mut block: Option<&str> = None;
    let mut found = Vec::new();
    for (index, line) in chapter.lines().enumerate() {
        if let Some(language) = line.trim().strip_prefix("```") {
            block = if block.is_none() { Some(language.trim()) } else { None };
        } else if block == Some("text") && !["", "…"].contains(&line.trim()) {
            found.push((index + 1, line.to_owned()));
        }
    }
    found
}

impl Question {
    /// The first expected line that is not among those that were printed. Spaces count as one; `…` stands for anything.
    pub(crate) fn missing(&self, printed: &str) -> Option<&str> {
        let printed: Vec<String> = printed.lines().map(even).collect();
        let is_there = |expected: &str| {
            let expected = even(expected);
            printed.iter().any(|line| {
                let mut rest = line.as_str();
                expected.split('…').all(|part| match rest.find(part.trim()) {
                    Some(at) => {
                        rest = &rest[at + part.trim().len()..];
                        true
                    }
                    None => false,
                })
            })
        };
        self.expected.iter().map(String::as_str).find(|expected| !is_there(expected))
    }
}

/// With single spaces.
fn even(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHAPTER: &str = "\
```sh
halfway render a.json -o out/a.png
halfway compare out/a.png b.png
```
<details>

```text
RMSE  1.5
…
```

</details>

```sh
halfway adapters
```

```text
cpu … AVX2
```
";

    #[test]
    fn answers_belong_to_the_commands_before_them() {
        let found = of(CHAPTER).unwrap();
        let told: Vec<_> = found.iter().map(|it| (it.line, it.commands.len(), it.expected.join("|"))).collect();
        assert_eq!(told, [(2, 2, "RMSE  1.5".to_owned()), (15, 1, "cpu … AVX2".to_owned())]);
        assert_eq!(found[0].missing("size 8\n  RMSE 1.5 steps\n"), None);
        assert_eq!(found[0].missing("RMSE 1.6"), Some("RMSE  1.5"));
        assert_eq!(found[1].missing("cpu (8 threads, AVX2)"), None);
        assert_eq!(found[1].missing("AVX2 cpu"), Some("cpu … AVX2"));
    }

    #[test]
    fn other_programs_are_refused() {
        assert_eq!(of("```sh\nrm -r out\n```\n").unwrap_err(), "line 2: expected halfway …, found rm -r out");
    }
}
