//! The parts of a Markdown page in which links and formulas count, apart from code.

/// A stretch of a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stretch<'a> {
    /// Text with its links and formulas.
    Prose(&'a str),
    /// A code block or a span of code, with its marks.
    Code(&'a str),
}

/// Cuts a page at its code, in order and without a loss.
pub(crate) fn stretches(page: &str) -> Vec<Stretch<'_>> {
    let mut found = Vec::new();
    let mut rest = page;
    while let Some(start) = rest.find('`') {
        let ticks = rest[start..].len() - rest[start..].trim_start_matches('`').len();
        let mark = &rest[start..start + ticks];
        let inside = start + ticks;
        let length = closing(&rest[inside..], mark).map_or(rest.len() - inside, |at| at + ticks);
        found.push(Stretch::Prose(&rest[..start]));
        found.push(Stretch::Code(&rest[start..inside + length]));
        rest = &rest[inside + length..];
    }
    found.push(Stretch::Prose(rest));
    found
}

/// Where a run of exactly these backticks begins.
fn closing(text: &str, mark: &str) -> Option<usize> {
    let mut from = 0;
    while let Some(at) = text[from..].find(mark).map(|at| from + at) {
        let run = text[at..].len() - text[at..].trim_start_matches('`').len();
        if run == mark.len() {
            return Some(at);
        }
        from = at + run;
    }
    None
}

/// A link or a picture in prose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Link<'a> {
    pub(crate) is_picture: bool,
    pub(crate) text: &'a str,
    pub(crate) target: &'a str,
}

/// The links of prose, each with the text before it; last the rest of the text.
pub(crate) fn links(prose: &str) -> (Vec<(&str, Link<'_>)>, &str) {
    let mut found = Vec::new();
    let mut rest = prose;
    let mut from = 0;
    while let Some(open) = rest[from..].find('[').map(|at| from + at) {
        let link = rest[open + 1..].split_once("](").and_then(|(text, after)| Some((text, after.split_once(')')?.0)));
        // A bracket within the text is that of another link, or of no link at all.
        let Some((text, target)) = link.filter(|(text, _)| !text.contains('[')) else {
            from = open + 1;
            continue;
        };
        let is_picture = rest[..open].ends_with('!');
        found.push((&rest[..open - usize::from(is_picture)], Link { is_picture, text, target }));
        rest = &rest[open + 1 + text.len() + 2 + target.len() + 1..];
        from = 0;
    }
    (found, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_is_told_from_prose() {
        let page = "a `b $c$` d\n```rust\nlet x = `y`;\n```\ne ``f ` g`` h";
        let found = stretches(page);
        let code: Vec<&str> =
            found.iter().filter_map(|it| if let Stretch::Code(code) = it { Some(*code) } else { None }).collect();
        assert_eq!(code, ["`b $c$`", "```rust\nlet x = `y`;\n```", "``f ` g``"]);
        let all: String = found
            .iter()
            .map(|it| match it {
                Stretch::Prose(text) | Stretch::Code(text) => *text,
            })
            .collect();
        assert_eq!(all, page);
    }

    #[test]
    fn links_and_pictures_are_found() {
        let (found, rest) = links("see [a](b.md), [0, 1] and ![c d](e.png) or [f](g#h).");
        let told: Vec<_> = found.iter().map(|(_, link)| (link.is_picture, link.text, link.target)).collect();
        assert_eq!(told, [(false, "a", "b.md"), (true, "c d", "e.png"), (false, "f", "g#h")]);
        assert_eq!(found[1].0, ", [0, 1] and ");
        assert_eq!(rest, ".");
    }
}
