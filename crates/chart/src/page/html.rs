//! The page as HTML.

use super::{Page, PageTable, Section};
use crate::figure::svg::{self, Size, SvgError, escaped};
use crate::figure::{Figure, Series};

const STYLE: &str = include_str!("page.css");
/// One function, so that the parts share what they define and the page nothing.
const SCRIPT: [&str; 5] = [
    "'use strict';\n(() => {\n",
    include_str!("card.js"),
    include_str!("fronts.js"),
    include_str!("page.js"),
    "})();\n",
];
/// Before everything else, so that it hears of every failure.
const GUARD: &str = "window.addEventListener('error', (event) => {
  const problem = document.getElementById('problem');
  problem.textContent = 'Points cannot be pointed at: ' + event.message;
  problem.hidden = false;
});";

/// The page with charts, pictures and figures inside.
///
/// # Errors
/// A chart that could not be drawn.
pub fn html(page: &Page) -> Result<String, SvgError> {
    let title = escaped(&page.title);
    let facts =
        each(&page.facts, |(name, value)| format!("<div><dt>{}</dt><dd>{}</dd></div>", escaped(name), escaped(value)));
    let sections = page.sections.iter().map(section).collect::<Result<String, _>>()?;
    Ok(format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <p id=\"problem\" role=\"alert\" hidden></p>\n<script>\n{GUARD}\n</script>\n\
         <header>\n<h1>{title}</h1>\n<p>{lead}</p>\n<dl>{facts}</dl>\n</header>\n\
         <main>\n<div id=\"controls\" hidden></div>\n{sections}</main>\n\
         <aside id=\"card\" hidden></aside>\n\
         {points}<script>\n{script}</script>\n</body>\n</html>\n",
        lead = escaped(&page.lead),
        points = each(&page.points, |points| format!(
            "<script type=\"application/json\" id=\"points\">{}</script>\n",
            in_script(&points.to_string())
        )),
        script = SCRIPT.concat(),
    ))
}

/// The HTML of each, one after the other.
fn each<T>(items: impl IntoIterator<Item = T>, html: impl Fn(T) -> String) -> String {
    items.into_iter().map(html).collect()
}

/// JSON that cannot end the element it stands in: `<` occurs in strings only, where it may be written otherwise.
fn in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

fn section(section: &Section) -> Result<String, SvgError> {
    let text = each(&section.text, |text| format!("<p>{}</p>\n", escaped(text)));
    let figures = section.figures.iter().enumerate().map(|(i, (_, figure))| self::figure(figure, i == 0));
    let figures = figures.collect::<Result<String, _>>()?;
    let tables = each(&section.tables, table);
    let pictures = each(&section.pictures, |(caption, source)| {
        format!("<figure><img src=\"{source}\" alt=\"\"><figcaption>{}</figcaption></figure>\n", escaped(caption))
    });
    let files: Vec<_> = section
        .files
        .iter()
        .map(|(what, file)| format!("<a href=\"{}\">{}</a>", escaped(file), escaped(what)))
        .collect();
    Ok(format!(
        "<section{}>\n<h2>{}</h2>\n{text}<div class=\"pictures\">{pictures}</div>{}{figures}{tables}\
         <p class=\"files\">{}</p>\n</section>\n",
        each(&section.scene, |scene| format!(" data-scene=\"{}\"", escaped(scene))),
        escaped(&section.title),
        buttons(&section.figures),
        files.join(" · ")
    ))
}

/// The buttons that choose among figures; none where there is no choice.
fn buttons(figures: &[(String, Figure)]) -> String {
    if figures.len() < 2 {
        return String::new();
    }
    let buttons = each(figures.iter().enumerate(), |(i, (name, figure))| {
        let checked = if i == 0 { " checked" } else { "" };
        format!(
            "<label><input type=\"radio\" name=\"{}\" value=\"{}\"{checked}> {}</label>",
            figures[0].1.id,
            figure.id,
            escaped(name)
        )
    });
    format!("<fieldset class=\"shown\"><legend>Shown</legend>{buttons}</fieldset>\n")
}

fn figure(figure: &Figure, shown: bool) -> Result<String, SvgError> {
    let entry = |series: &Series| Ok(format!("<span>{}{}</span>", svg::swatch(series.style)?, escaped(&series.name)));
    let legend = figure.legend().into_iter().map(entry).collect::<Result<String, SvgError>>()?;
    // Panels are scaled to the columns of the page, so that their text comes out at about its own size.
    let size = match figure.columns {
        1 => Size { width: 860, row: 360 },
        2 => Size { width: 560, row: 350 },
        3 => Size { width: 420, row: 310 },
        _ => Size { width: 320, row: 290 },
    };
    let panels = figure.panels.iter().map(|panel| {
        let svg = svg::panel_with_hits(figure, panel, size)?;
        Ok(format!("<div class=\"panel\" role=\"img\" aria-label=\"{}\">{svg}</div>\n", escaped(&panel.title)))
    });
    Ok(format!(
        "<figure id=\"{}\"{}>\n<figcaption>{}</figcaption>\n<div class=\"legend\">{legend}</div>\n\
         <div class=\"panels\" style=\"--columns: {}; --least: {}px\">\n{}</div>\n</figure>\n",
        figure.id,
        if shown { "" } else { " hidden" },
        escaped(&figure.title),
        figure.columns,
        size.width * 4 / 5,
        panels.collect::<Result<String, SvgError>>()?
    ))
}

fn table(table: &PageTable) -> String {
    let cells = |tag: &str, cells: &[String]| {
        let class = |i| if i < table.names { " class=\"name\"" } else { "" };
        each(cells.iter().enumerate(), |(i, cell)| format!("<{tag}{}>{}</{tag}>", class(i), escaped(cell)))
    };
    let rows = each(&table.rows, |row| format!("<tr>{}</tr>\n", cells("td", row)));
    format!(
        "<div class=\"table\"><table>\n<caption>{}</caption>\n<thead><tr>{}</tr></thead>\n<tbody>\n{rows}</tbody>\n\
         </table></div>\n",
        escaped(&table.caption),
        cells("th", &table.header)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::example;

    fn page() -> Page {
        Page {
            title: "A <page>".to_owned(),
            lead: "Read & weep".to_owned(),
            facts: vec![("adapter".to_owned(), "\"llvmpipe\"".to_owned())],
            sections: vec![Section {
                title: "One".to_owned(),
                scene: None,
                pictures: vec![("Seen".to_owned(), "data:,".to_owned())],
                text: vec!["Text.".to_owned()],
                figures: vec![
                    ("a".to_owned(), example()),
                    ("b".to_owned(), Figure { id: "second".to_owned(), ..example() }),
                ],
                tables: vec![PageTable {
                    caption: "Numbers".to_owned(),
                    names: 1,
                    header: vec!["name".to_owned(), "slope".to_owned()],
                    rows: vec![vec!["flat".to_owned(), "1.00".to_owned()]],
                }],
                files: vec![("data".to_owned(), "a.csv".to_owned())],
            }],
            points: None,
        }
    }

    #[test]
    fn the_page_shows_everything_and_fetches_nothing() {
        let html = html(&page()).unwrap();
        for text in [
            "<title>A &lt;page&gt;</title>",
            "Read &amp; weep",
            "&quot;llvmpipe&quot;",
            "<h2>One</h2>",
            "id=\"second\" hidden",
            "<td>1.00</td>",
            "href=\"a.csv\"",
        ] {
            assert!(html.contains(text), "{text}");
        }
        // Two figures of two panels of four points.
        assert_eq!(html.matches("class=\"hit\"").count(), 16);
        // Names of namespaces are no addresses.
        let html = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        // This one is a part of the page itself.
        let html = html.replace("url(#inside)", "");
        for outside in ["http:", "https:", "src=\"//", "@import", "url("] {
            assert!(!html.contains(outside), "{outside}");
        }
        assert_eq!(html.matches("<script").count(), html.matches("</script>").count());
    }

    #[test]
    fn points_cannot_end_the_script_they_stand_in() {
        let points = serde_json::json!({ "points": [{ "words": "</script><b>" }] });
        let html = html(&Page { points: Some(points.clone()), ..page() }).unwrap();
        assert!(!html.contains("</script><b>"));
        assert_eq!(html.matches("<script").count(), html.matches("</script>").count());
        let (_, rest) = html.split_once("id=\"points\">").unwrap();
        let (json, _) = rest.split_once("</script>").unwrap();
        assert_eq!(serde_json::from_str::<serde_json::Value>(json).unwrap(), points);
    }

    #[test]
    fn one_figure_needs_no_buttons() {
        assert_eq!(buttons(&[("a".to_owned(), example())]), "");
        assert_eq!(buttons(&page().sections[0].figures).matches("type=\"radio\"").count(), 2);
    }
}
