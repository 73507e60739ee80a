//! The page: one file that needs no other and no network.

mod csv;
mod html;
mod picture;

pub use csv::csv;
pub use html::html;
pub use picture::{data_uri, exact_data_uri};

use crate::figure::Figure;

/// What stands on the page, from top to bottom.
#[derive(Clone, Debug)]
pub struct Page {
    /// The page's title.
    pub title: String,
    /// How to read it: a paragraph.
    pub lead: String,
    /// What was measured on what: names and values.
    pub facts: Vec<(String, String)>,
    /// The chapters.
    pub sections: Vec<Section>,
    /// The points of the sections with scenes, their pictures and their scenes: what the page's script draws again, to
    /// be zoomed and filtered.
    pub points: Option<serde_json::Value>,
}

/// A chapter.
#[derive(Clone, Debug)]
pub struct Section {
    /// Its heading.
    pub title: String,
    /// The scene whose points it shows, if it does; where scripts run one of these sections is shown at a time.
    pub scene: Option<String>,
    /// What it shows, and how that was measured: paragraphs.
    pub text: Vec<String>,
    /// Captions and pictures, the latter as `data:` addresses.
    pub pictures: Vec<(String, String)>,
    /// The same chart of several quantities, of which one is shown at a time, each with the name of its button.
    pub figures: Vec<(String, Figure)>,
    /// Figures as numbers.
    pub tables: Vec<PageTable>,
    /// Files beside the page: what they hold, and their names.
    pub files: Vec<(String, String)>,
}

/// Rows under a header.
#[derive(Clone, Debug)]
pub struct PageTable {
    /// What the rows are.
    pub caption: String,
    /// How many columns at the left hold names; the others hold numbers.
    pub names: usize,
    /// The names of the columns.
    pub header: Vec<String>,
    /// As many cells in each as in the header.
    pub rows: Vec<Vec<String>>,
}
