//! The pages of failures, and the chapter that leads to them.

use super::{NamedFile, ReportError, figure_file};
use crate::failures::FailurePage;
use crate::figure::Figure;
use crate::measure::MeasureError;
use crate::page::{Page, Section, exact_data_uri, html};

/// A page of its own for each failure, and its chart as SVG.
pub(super) fn files(pages: &[FailurePage]) -> Result<Vec<NamedFile>, ReportError> {
    let mut files = Vec::new();
    for failure in pages {
        files.push((name(failure), html(&page(failure)?)?));
        for (_, figure) in &failure.figures {
            files.push(figure_file(figure)?);
        }
    }
    Ok(files)
}

/// The chapter with a line for each.
pub(super) fn section(pages: &[FailurePage]) -> Section {
    Section {
        title: "Where methods fail".to_owned(),
        scene: None,
        text: vec![
            "A page for each way: pictures, how much, the cause, the remedy, and the test that keeps it. What methods lose is \
             drawn by the reference renderer, what rounding loses by the adapters of this report and by the CPU."
                .to_owned(),
        ],
        pictures: Vec::new(),
        figures: Vec::new(),
        tables: Vec::new(),
        files: pages.iter().map(|failure| (failure.title.to_owned(), name(failure))).collect(),
    }
}

fn page(failure: &FailurePage) -> Result<Page, ReportError> {
    let FailurePage { title, cause, remedy, test, pictures, .. } = failure;
    let uri = |picture| exact_data_uri(picture).map_err(MeasureError::Picture);
    let pictures = pictures.iter().map(|(caption, picture)| Ok(((*caption).to_owned(), uri(picture)?)));
    Ok(Page {
        title: (*title).to_owned(),
        lead: (*cause).to_owned(),
        facts: vec![("remedy".to_owned(), (*remedy).to_owned()), ("kept by the test".to_owned(), (*test).to_owned())],
        sections: vec![Section {
            title: "Seen and measured".to_owned(),
            scene: None,
            text: Vec::new(),
            pictures: pictures.collect::<Result<_, MeasureError>>()?,
            figures: failure.figures.iter().map(|(name, figure)| ((*name).to_owned(), figure.clone())).collect(),
            tables: Vec::new(),
            files: failure
                .figures
                .iter()
                .map(file)
                .chain([("all charts".to_owned(), "index.html".to_owned())])
                .collect(),
        }],
        points: None,
    })
}

/// A figure's file, by a name that no other of the page has.
fn file((name, figure): &(&str, Figure)) -> (String, String) {
    let what = if name.is_empty() { "chart (SVG)".to_owned() } else { format!("chart: {name} (SVG)") };
    (what, format!("{}.svg", figure.id))
}

fn name(failure: &FailurePage) -> String {
    format!("failure-{}.html", failure.id)
}
