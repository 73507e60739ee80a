//! Known failure modes: a page for each, with pictures, a plot, the cause, the remedy, and the test that checks its
//! claims.
//!
//! Losses of methods are drawn by the oracle, independently of their implementation. Losses by rounding are drawn by
//! the charted adapters and by the CPU without a driver, and compared with the oracle.

mod bands;
mod blend_order;
mod creases;
mod depth;
mod diagonals;
mod distances;
mod edge_on;
mod exponents;
mod highlight;
mod interpolation;
mod layers;
mod near_light;
mod noise;
mod outlines;
mod prelude;
mod rims;
mod saturation;
mod slivers;

use image::RgbImage;

use crate::error::ChartError;
use crate::figure::Figure;
use crate::front::ChartedAdapter;
use crate::page::{NamedFile, Page, Section, drawing, exact_data_uri};

/// A known failure mode.
#[derive(Clone, Debug)]
pub struct FailurePage {
    /// Names its file: lower case, no spaces.
    pub id: &'static str,
    /// The visible effect.
    pub title: &'static str,
    /// The cause, in a line.
    pub cause: &'static str,
    /// The remedy, in a line.
    pub remedy: &'static str,
    /// The test that checks the page's claims.
    pub test: &'static str,
    /// The error, over the quantity that it depends on; of several figures one is shown at a time.
    pub figures: Vec<Figure>,
    /// Captions and pictures.
    pub pictures: Vec<(&'static str, RgbImage)>,
}

impl FailurePage {
    /// The page `failure-….html`.
    ///
    /// # Errors
    /// A picture that could not be put on the page.
    pub fn page(&self) -> Result<Page, ChartError> {
        let pictures = self.pictures.iter();
        let pictures = pictures.map(|(caption, picture)| Ok(((*caption).to_owned(), exact_data_uri(picture)?)));
        let facts = [("remedy", self.remedy), ("held by the test", self.test)];
        Ok(Page {
            file: format!("failure-{}.html", self.id),
            title: self.title.to_owned(),
            lead: self.cause.to_owned(),
            facts: facts.map(|(name, value)| (name.to_owned(), value.to_owned())).into(),
            sections: vec![Section {
                title: "Pictures and figures".to_owned(),
                pictures: pictures.collect::<Result<_, ChartError>>()?,
                figures: self.figures.clone(),
                links: vec![("all charts".to_owned(), "index.html".to_owned())],
                ..Section::default()
            }],
            ..Page::default()
        })
    }

    /// The chapter `ID.md` of a book, in Markdown with HTML for the pictures, and its charts as SVG.
    ///
    /// # Errors
    /// A picture that could not be put into the chapter.
    pub fn chapter(&self) -> Result<Vec<NamedFile>, ChartError> {
        let Self { id, title, cause, remedy, test, .. } = self;
        let figure = |(caption, picture): &(&str, RgbImage)| {
            let source = exact_data_uri(picture)?;
            Ok(format!("<figure><img alt=\"\" src=\"{source}\"><figcaption>{caption}</figcaption></figure>\n"))
        };
        let pictures = self.pictures.iter().map(figure).collect::<Result<String, ChartError>>()?;
        let files: Vec<NamedFile> = self.figures.iter().map(drawing).collect();
        let charts =
            self.figures.iter().zip(&files).map(|(chart, (file, _))| format!("![{}]({file})\n\n", chart.title));
        let text = format!(
            "# {title}\n\n{cause}\n\n**Remedy.** {remedy}\n\n<div class=\"pictures\">\n{pictures}</div>\n\n{}The test \
             `{test}` checks these claims.\n",
            charts.collect::<String>()
        );
        Ok(std::iter::once((format!("{id}.md"), text)).chain(files).collect())
    }
}

type DrawnPage = fn() -> Result<FailurePage, ChartError>;
type JudgedPage = fn(&[ChartedAdapter]) -> Result<FailurePage, ChartError>;

/// The pages drawn by the oracle.
const DRAWN: [DrawnPage; 13] = [
    highlight::page,
    bands::mach_bands,
    bands::terminator,
    outlines::page,
    diagonals::page,
    slivers::page,
    creases::page,
    noise::page,
    near_light::page,
    rims::page,
    interpolation::page,
    blend_order::page,
    saturation::page,
];
/// The pages drawn by adapters.
const JUDGED: [JudgedPage; 5] = [exponents::page, distances::page, edge_on::page, depth::page, layers::page];

/// The number of pages, for progress.
pub const PAGES: u64 = (DRAWN.len() + JUDGED.len()) as u64;

/// Every page, with the losses of these adapters and of the CPU without a driver; `done` is called after each.
///
/// # Errors
/// The first picture that could not be drawn.
pub fn all(charted: &[ChartedAdapter], mut done: impl FnMut(&FailurePage)) -> Result<Vec<FailurePage>, ChartError> {
    let renderers = prelude::renderers(charted)?;
    let drawn = DRAWN.into_iter().map(|page| page());
    let judged = JUDGED.into_iter().map(|page| page(&renderers));
    drawn.chain(judged).map(|page| page.inspect(&mut done)).collect()
}

/// A sentence about the pages, for those that link them.
const ABOUT: &str = "Each known failure has its own page: pictures, how large the error is, the cause, the remedy, and the \
                     test that checks it. The reference renderer draws the errors of methods; the adapters of this report \
                     and the CPU draw those of rounding.";

/// The pages of these failures, after an index of their own, `index.html`.
///
/// # Errors
/// A picture that could not be put on a page.
pub fn pages(failures: &[FailurePage]) -> Result<Vec<Page>, ChartError> {
    let pages = failures.iter().map(FailurePage::page).collect::<Result<Vec<_>, _>>()?;
    let index = Page {
        file: "index.html".to_owned(),
        title: "Failure modes".to_owned(),
        lead: ABOUT.to_owned(),
        sections: vec![Section { title: "Pages".to_owned(), text: Vec::new(), ..section(&pages) }],
        ..Page::default()
    };
    Ok(std::iter::once(index).chain(pages).collect())
}

/// A section that links the pages of failures.
pub(crate) fn section(pages: &[Page]) -> Section {
    Section {
        title: "Failure modes".to_owned(),
        text: vec![ABOUT.to_owned()],
        links: pages.iter().map(|page| (page.title.clone(), page.file.clone())).collect(),
        ..Section::default()
    }
}

#[cfg(test)]
mod testing {
    use std::sync::OnceLock;

    use halfway::render::AdapterChoice;

    use super::*;

    /// The adapters of these tests: the chosen one, and always the CPU without a driver.
    pub(super) fn test_renderers() -> &'static [ChartedAdapter] {
        static DRAWERS: OnceLock<Vec<ChartedAdapter>> = OnceLock::new();
        DRAWERS.get_or_init(|| {
            let adapter = AdapterChoice::default().open().expect("an adapter");
            prelude::renderers(&[ChartedAdapter { name: "the adapter".to_owned(), adapter }]).expect("the CPU draws")
        })
    }

    /// The slope of log y against log x by least squares: the exponent of a power law.
    pub(super) fn slope(points: &[(f64, f64)]) -> f64 {
        let points: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
        let (mean_x, mean_y) = (mean(|point| point.0), mean(|point| point.1));
        let xy: f64 = points.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
        xy / points.iter().map(|(x, _)| (x - mean_x).powi(2)).sum::<f64>()
    }

    #[track_caller]
    pub(super) fn is_near(what: &str, found: f64, expected: f64, part: f64) {
        assert!((found / expected - 1.0).abs() <= part, "{what}: {found} for {expected}");
    }

    #[test]
    fn slopes_are_those_of_powers() {
        let points: Vec<_> = [1.0, 2.0, 8.0].map(|x: f64| (x, 3.0 * x.powi(2))).into();
        assert!((slope(&points) - 2.0).abs() < 1e-12);
    }
}
