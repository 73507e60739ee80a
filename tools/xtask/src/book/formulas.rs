//! Formulas in TeX, as `MathML`, which browsers typeset by themselves: the book needs no network and no script for them.

use pulldown_latex::config::DisplayMode;
use pulldown_latex::{Parser, RenderConfig, Storage, push_mathml};

/// The prose with `$…$` and `$$…$$` as `MathML`, the latter as a line of its own.
///
/// # Errors
/// The formula that is not TeX, or has no end.
pub(crate) fn typeset(prose: &str) -> Result<String, String> {
    let mut result = String::new();
    let mut rest = prose;
    while let Some(start) = rest.find('$') {
        let mark = if rest[start..].starts_with("$$") { "$$" } else { "$" };
        let inside = &rest[start + mark.len()..];
        let end = inside.find(mark).ok_or_else(|| format!("a formula has no end: {}", rest[start..].trim()))?;
        result.push_str(&rest[..start]);
        result.push_str(&mathml(inside[..end].trim(), mark == "$$")?);
        rest = &inside[end + mark.len()..];
    }
    Ok(result + rest)
}

/// The number of formulas in prose.
pub(crate) fn count(prose: &str) -> usize {
    prose.replace("$$", "$").matches('$').count() / 2
}

fn mathml(tex: &str, is_block: bool) -> Result<String, String> {
    let display_mode = if is_block { DisplayMode::Block } else { DisplayMode::Inline };
    let (storage, mut text) = (Storage::new(), String::new());
    let config = RenderConfig { display_mode, ..RenderConfig::default() };
    push_mathml(&mut text, Parser::new(tex, &storage), config).map_err(|error| format!("{tex}: {error}"))?;
    if let Some((_, problem)) = text.split_once("<mtext>parsing error: ") {
        return Err(format!("{tex}: {}", problem.lines().next().unwrap_or_default()));
    }
    // Two attributes stand without a space between them; what Markdown reads as emphasis is written as a character.
    let text = text.replace("\"minsize", "\" minsize").replace('*', "&#42;").replace('_', "&#95;");
    Ok(text.replace('\n', " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_become_mathml() {
        let found = typeset("with $\\alpha$, and\n\n$$\\frac{1}{d^2}$$\n\nin space").unwrap();
        assert!(
            found
                .starts_with("with <math display=\"inline\"><mi>α</mi></math>, and\n\n<math display=\"block\"><mfrac>"),
            "{found}"
        );
        assert!(found.ends_with("</math>\n\nin space") && !found.contains('$'), "{found}");
        assert_eq!(count("with $\\alpha$, and\n\n$$\\frac{1}{d^2}$$\n"), 2);
    }

    #[test]
    fn wrong_formulas_are_named() {
        assert_eq!(typeset("$\\alhpa$").unwrap_err(), "\\alhpa: unknown primitive command found");
        assert!(typeset("it costs 5 $").unwrap_err().starts_with("a formula has no end: $"));
    }
}
