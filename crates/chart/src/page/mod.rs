//! Pages: self-contained HTML files that need no network, with their charts beside them as SVG.

mod html;
mod picture;

use serde::Serialize;

pub use picture::{data_uri, exact_data_uri};

use crate::figure::Figure;
use crate::figure::svg::{self, Size};

/// A file's name and content.
pub type NamedFile = (String, String);

/// The content of a page, from top to bottom.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// The name of its file.
    pub file: String,
    /// The page's title.
    pub title: String,
    /// The introduction: a paragraph.
    pub lead: String,
    /// The machine and the extent of the measurements: names and values.
    pub facts: Vec<(String, String)>,
    /// The chapters.
    pub sections: Vec<Section>,
    /// The details of points, shown when the pointer is on them ([`Point::card`](crate::figure::Point::card)).
    pub cards: Vec<Card>,
    /// The pictures of the cards, as `data:` addresses.
    pub images: Vec<String>,
    /// Further files of the page.
    pub beside: Vec<NamedFile>,
}

/// The details of a point of a chart.
#[derive(Clone, Debug, Serialize)]
pub struct Card {
    /// Its description, in a line.
    pub title: String,
    /// Captions, and indices in [`Page::images`].
    pub pictures: Vec<(String, usize)>,
    /// Names and values.
    pub rows: Vec<(String, String)>,
    /// The command that measures it again.
    pub command: String,
}

/// A chapter.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Its heading.
    pub title: String,
    /// The content, and how it was measured: paragraphs.
    pub text: Vec<String>,
    /// Captions and pictures, the latter as `data:` addresses.
    pub pictures: Vec<(String, String)>,
    /// The same chart of several quantities, one shown at a time.
    pub figures: Vec<Figure>,
    /// The figures as numbers.
    pub tables: Vec<PageTable>,
    /// Pages and files beside this one, except those of its charts: their contents, and their names.
    pub links: Vec<(String, String)>,
}

/// Rows under a header.
#[derive(Clone, Debug)]
pub struct PageTable {
    /// The subject of the rows.
    pub caption: String,
    /// The number of columns at the left that hold names; the others hold numbers.
    pub names: usize,
    /// The names of the columns.
    pub header: Vec<String>,
    /// Rows with as many cells as the header.
    pub rows: Vec<Vec<String>>,
}

impl Page {
    /// The page, its further files, and its charts as SVG.
    pub fn files(&self) -> Vec<NamedFile> {
        let svg = self.sections.iter().flat_map(|section| &section.figures).map(drawing);
        std::iter::once((self.file.clone(), html::html(self))).chain(self.beside.clone()).chain(svg).collect()
    }

    /// Title, facts, and the text and tables of the sections that have tables, in Markdown.
    pub fn markdown(&self) -> String {
        let facts: Vec<String> = self.facts.iter().map(|(name, value)| format!("{name}: {value}")).collect();
        let made = "Made by `halfway chart`; [charts.md](charts.md) says what is measured.";
        let mut blocks = vec![format!("# {}", self.title), made.to_owned(), facts.join("; ") + "."];
        for section in self.sections.iter().filter(|section| !section.tables.is_empty()) {
            blocks.push(format!("## {}", section.title));
            blocks.extend(section.text.iter().cloned());
            blocks.extend(section.tables.iter().map(PageTable::markdown));
        }
        blocks.join("\n\n") + "\n"
    }
}

impl PageTable {
    fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |", cells.join(" | "));
        let rule = format!("|{}", "---|".repeat(self.header.len()));
        let lines = [line(&self.header), rule].into_iter().chain(self.rows.iter().map(|row| line(row)));
        format!("{}:\n\n{}", self.caption, lines.collect::<Vec<_>>().join("\n"))
    }
}

/// The file of a chart.
pub(crate) fn drawing(figure: &Figure) -> NamedFile {
    let size = if figure.columns() > 2 { Size { width: 1240, row: 300 } } else { Size { width: 900, row: 330 } };
    (svg_file(figure), svg::figure(figure, size))
}

/// The name of a chart's file.
fn svg_file(figure: &Figure) -> String {
    format!("{}.svg", figure.id)
}

/// The text with its first letter capitalised.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().collect::<String>() + letters.as_str()).unwrap_or_default()
}
