//! Pages as HTML.

use serde_json::json;

use super::{Page, PageTable, Section, svg_file};
use crate::figure::Figure;
use crate::figure::svg::{self, Size, escaped};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// Before everything else, so that it catches every failure.
const GUARD: &str = "window.addEventListener('error', (event) => {
  const problem = document.getElementById('problem');
  problem.textContent = 'Points cannot be pointed at: ' + event.message;
  problem.hidden = false;
});";

/// The page with charts, pictures and figures inside.
pub(super) fn html(page: &Page) -> String {
    let title = escaped(&page.title);
    let facts =
        each(&page.facts, |(name, value)| format!("<div><dt>{}</dt><dd>{}</dd></div>", escaped(name), escaped(value)));
    let sections = each(&page.sections, section);
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <p id=\"problem\" role=\"alert\" hidden></p>\n<script>\n{GUARD}\n</script>\n\
         <header>\n<h1>{title}</h1>\n<p>{lead}</p>\n<dl>{facts}</dl>\n</header>\n\
         <main>\n{sections}</main>\n\
         <aside id=\"card\" hidden></aside>\n\
         <script type=\"application/json\" id=\"cards\">{cards}</script>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        lead = escaped(&page.lead),
        cards = in_script(&json!({ "cards": page.cards, "images": page.images }).to_string()),
    )
}

/// The concatenated HTML of all items.
fn each<T>(items: impl IntoIterator<Item = T>, html: impl Fn(T) -> String) -> String {
    items.into_iter().map(html).collect()
}

/// JSON that cannot end its script element: `<` occurs in strings only, where it can be escaped.
fn in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

fn section(section: &Section) -> String {
    let text = each(&section.text, |text| format!("<p>{}</p>\n", escaped(text)));
    let figures = each(section.figures.iter().enumerate(), |(i, figure)| self::figure(figure, i == 0));
    let tables = each(&section.tables, table);
    let pictures = each(&section.pictures, |(caption, source)| {
        format!("<figure><img src=\"{source}\" alt=\"\"><figcaption>{}</figcaption></figure>\n", escaped(caption))
    });
    let link = |what: &str, file: &str| format!("<a href=\"{}\">{}</a>", escaped(file), escaped(what));
    let charts = section.figures.iter().map(|figure| link(&format!("{} (SVG)", figure.title), &svg_file(figure)));
    let links: Vec<String> = charts.chain(section.links.iter().map(|(what, file)| link(what, file))).collect();
    format!(
        "<section>\n<h2>{}</h2>\n{text}<div class=\"pictures\">{pictures}</div>{}{figures}{tables}\
         <p class=\"files\">{}</p>\n</section>\n",
        escaped(&section.title),
        buttons(&section.figures),
        links.join(" · ")
    )
}

/// The buttons that choose among figures; none for a single one.
fn buttons(figures: &[Figure]) -> String {
    if figures.len() < 2 {
        return String::new();
    }
    let buttons = each(figures.iter().enumerate(), |(i, figure)| {
        let checked = if i == 0 { " checked" } else { "" };
        format!(
            "<label><input type=\"radio\" name=\"{}\" value=\"{}\"{checked}> {}</label>",
            figures[0].id,
            figure.id,
            escaped(&figure.name)
        )
    });
    format!("<fieldset class=\"shown\"><legend>Shown</legend>{buttons}</fieldset>\n")
}

fn figure(figure: &Figure, shown: bool) -> String {
    let legend = each(figure.legend(), |series| {
        let (swatch, name) = (svg::swatch(series.style), escaped(&series.name));
        format!("<button type=\"button\" value=\"{name}\" aria-pressed=\"true\">{swatch}{name}</button>")
    });
    // Panels are scaled to the columns of the page, so that their text comes out at about its own size.
    let size = match figure.columns() {
        1 => Size { width: 860, row: 360 },
        2 => Size { width: 560, row: 350 },
        _ => Size { width: 420, row: 310 },
    };
    let panels = each(&figure.panels, |panel| {
        let svg = svg::panel_with_hits(figure, panel, size);
        format!("<div class=\"panel\" role=\"img\" aria-label=\"{}\">{svg}</div>\n", escaped(&panel.title))
    });
    format!(
        "<figure id=\"{}\"{}>\n<figcaption>{}</figcaption>\n<div class=\"legend\">{legend}</div>\n\
         <div class=\"panels\" style=\"--columns: {}; --least: {}px\">\n{panels}</div>\n</figure>\n",
        figure.id,
        if shown { "" } else { " hidden" },
        escaped(&figure.title),
        figure.columns(),
        size.width * 4 / 5
    )
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
    use crate::page::Card;

    fn page() -> Page {
        Page {
            file: "page.html".to_owned(),
            title: "A <page>".to_owned(),
            lead: "Read & weep".to_owned(),
            facts: vec![("adapter".to_owned(), "\"llvmpipe\"".to_owned())],
            sections: vec![Section {
                title: "One".to_owned(),
                pictures: vec![("Seen".to_owned(), "data:,".to_owned())],
                text: vec!["Text.".to_owned()],
                figures: vec![
                    example().named("a"),
                    Figure { id: "second".to_owned(), title: "Another".to_owned(), ..example() }.named("b"),
                ],
                tables: vec![PageTable {
                    caption: "Numbers".to_owned(),
                    names: 1,
                    header: vec!["name".to_owned(), "slope".to_owned()],
                    rows: vec![vec!["flat".to_owned(), "1.00".to_owned()]],
                }],
                links: vec![("data".to_owned(), "a.json".to_owned())],
            }],
            ..Page::default()
        }
    }

    #[test]
    fn the_page_shows_everything_and_fetches_nothing() {
        let html = html(&page());
        for text in [
            "<title>A &lt;page&gt;</title>",
            "Read &amp; weep",
            "&quot;llvmpipe&quot;",
            "<h2>One</h2>",
            "id=\"second\" hidden",
            "<button type=\"button\" value=\"one &amp; all\" aria-pressed=\"true\">",
            "<g data-series=\"one &amp; all\">",
            "<td>1.00</td>",
            "href=\"a.json\"",
            "href=\"second.svg\">Another (SVG)<",
        ] {
            assert!(html.contains(text), "{text}");
        }
        // Two figures of two panels of four points.
        assert_eq!(html.matches("class=\"hit\"").count(), 16);
        // Names of namespaces are not addresses.
        let html = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        for outside in ["http:", "https:", "src=\"//", "@import", "url("] {
            assert!(!html.contains(outside), "{outside}");
        }
        assert_eq!(html.matches("<script").count(), html.matches("</script>").count());
    }

    #[test]
    fn cards_cannot_end_the_script_they_stand_in() {
        let card = |title: &str| Card {
            title: title.to_owned(),
            pictures: vec![("seen".to_owned(), 0)],
            rows: Vec::new(),
            command: String::new(),
        };
        let cards = vec![card("</script><b>")];
        let html = html(&Page { cards, images: vec!["data:,".to_owned()], ..page() });
        assert!(!html.contains("</script><b>"));
        assert_eq!(html.matches("<script").count(), html.matches("</script>").count());
        let (_, rest) = html.split_once("id=\"cards\">").unwrap();
        let (json, _) = rest.split_once("</script>").unwrap();
        let json: serde_json::Value = serde_json::from_str(json).unwrap();
        assert_eq!(json["cards"][0]["title"], "</script><b>");
        assert_eq!(json["images"], json!(["data:,"]));
    }

    #[test]
    fn one_figure_needs_no_buttons() {
        assert_eq!(buttons(&[example()]), "");
        assert_eq!(buttons(&page().sections[0].figures).matches("type=\"radio\"").count(), 2);
    }

    #[test]
    fn a_page_has_files_for_its_charts_and_its_tables_in_markdown() {
        let names: Vec<String> = page().files().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["page.html", "example.svg", "second.svg"]);
        let expected = "# A <page>\n\nMade by `halfway chart`; [charts.md](charts.md) says what is measured.\n\nadapter: \"llvmpipe\".\n\n## One\n\nText.\n\nNumbers:\n\n\
                        | name | slope |\n|---|---|\n| flat | 1.00 |\n";
        assert_eq!(page().markdown(), expected);
    }
}
