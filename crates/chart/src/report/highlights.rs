//! The part of the filters' page on highlights of normal maps from afar.

use halfway::texture::FarNormals;

use super::tables::capital;
use crate::figure::{Axis, AxisScale, Figure, Marker, Panel, Point, Series, Stroke, Style};
use crate::filters::{FilterPlan, HighlightFigures, MeasuredHighlights, far_normals_memory, far_normals_name};
use crate::page::{PageTable, Section, csv};

/// A quantity that is charted over the distance: the figure's name, its own, and its values.
type OverDistance = (&'static str, &'static str, fn(&HighlightFigures) -> &[f64]);

const QUANTITIES: [OverDistance; 2] = [
    ("highlights-rms", "RMS error", |figures| &figures.rms),
    ("highlights-shimmer", "shimmer", |figures| &figures.shimmer),
];

pub(super) const TITLE: &str = "Highlights of normal maps from afar";

/// The figures of both quantities, a panel a surface.
pub(super) fn figures(found: &[MeasuredHighlights]) -> Vec<Figure> {
    let figure = |(id, label, of): OverDistance| Figure {
        id: id.to_owned(),
        title: format!("{} of highlights against the distance", capital(label)),
        x: Axis::new("texels a pixel", AxisScale::Log),
        y: Axis::new(format!("{label}, of a highlight of 1"), AxisScale::Log),
        columns: 2,
        panels: found.iter().map(|surface| panel(surface, of)).collect(),
    };
    QUANTITIES.into_iter().map(figure).collect()
}

pub(super) fn section(found: &[MeasuredHighlights], figures: &[Figure]) -> Section {
    let pictures = found.iter().flat_map(|surface| {
        let name = surface.surface.name();
        let all = FarNormals::ALL.into_iter().zip(&surface.figures);
        let all =
            all.map(move |(far, figures)| (format!("{name}, {}", far_normals_name(far)), figures.picture.clone()));
        std::iter::once((format!("{name}, many samples"), surface.truth.clone())).chain(all)
    });
    let names = QUANTITIES.iter().map(|(_, label, _)| capital(label));
    Section {
        title: TITLE.to_owned(),
        scene: None,
        text: text(),
        pictures: pictures.collect(),
        figures: names.zip(figures.iter().cloned()).collect(),
        tables: tables(found),
        files: figures
            .iter()
            .map(|figure| (format!("{} (SVG)", figure.title), format!("{}.svg", figure.id)))
            .chain([("every figure (CSV)".to_owned(), "highlights.csv".to_owned())])
            .collect(),
    }
}

pub(super) fn text() -> Vec<String> {
    let texels = FilterPlan::TEXELS[FilterPlan::SHOWN];
    vec![
        format!(
            "A plane shows nothing but highlights (Blinn–Phong, exponent 60) of a normal map, seen from above at \
             distances where a pixel is 1 to {} texels wide, drawn by the CPU without a driver. Truth is the same \
             scene with as many samples along each axis of a pixel as it has texels, 4 at least. Errors are linear, of \
             highlights of 1 at most. Shimmer is the RMS of what changes from frame to frame of a moving camera, less \
             what changes in the truth.",
            FilterPlan::TEXELS[FilterPlan::TEXELS.len() - 1]
        ),
        format!(
            "Time is that of a frame of four times the width and height, at {texels} texels a pixel, over that by the \
             mean normal in the same round. Pictures are of that distance, too."
        ),
    ]
}

/// Errors by distance, and what each costs.
pub(super) fn tables(found: &[MeasuredHighlights]) -> Vec<PageTable> {
    let by_distance = QUANTITIES.into_iter().map(|(_, label, of)| {
        let header = ["surface", "highlights by"].map(str::to_owned).into_iter();
        PageTable {
            caption: format!("{} by texels a pixel, linear", capital(label)),
            names: 2,
            header: header.chain(FilterPlan::TEXELS.map(|texels| texels.to_string())).collect(),
            rows: rows(found, |_, figures| of(figures).iter().map(|value| format!("{value:.4}")).collect()),
        }
    });
    let costs = PageTable {
        caption: "Time of a frame, mean normal = 1, and the memory that is read, image = 1".to_owned(),
        names: 2,
        header: ["surface", "highlights by", "time", "quartiles", "memory"].map(str::to_owned).into(),
        rows: rows(found, |far, HighlightFigures { ratio, .. }| {
            vec![
                format!("{:.2}", ratio.median),
                format!("{:.2}–{:.2}", ratio.lower_quartile, ratio.upper_quartile),
                format!("{:.2}", far_normals_memory(far)),
            ]
        }),
    };
    by_distance.chain([costs]).collect()
}

pub(super) fn file(found: &[MeasuredHighlights]) -> String {
    let header =
        ["surface", "highlights by", "texels a pixel", "RMS error", "shimmer", "frame (mean normal = 1)", "memory"];
    let rows = found.iter().flat_map(|surface| {
        FarNormals::ALL.into_iter().zip(&surface.figures).flat_map(move |(far, figures)| {
            FilterPlan::TEXELS.into_iter().enumerate().map(move |(place, texels)| {
                let name = far_normals_name(far).to_owned();
                let numbers =
                    [figures.rms[place], figures.shimmer[place], figures.ratio.median, far_normals_memory(far)];
                let [rms, shimmer, ratio, memory] = numbers.map(super::tables::number);
                [surface.surface.name().to_owned(), name, texels.to_string(), rms, shimmer, ratio, memory]
            })
        })
    });
    csv(header, rows)
}

/// A row for each way to draw highlights of each surface, after the names of both.
fn rows(found: &[MeasuredHighlights], of: impl Fn(FarNormals, &HighlightFigures) -> Vec<String>) -> Vec<Vec<String>> {
    let all = found.iter().flat_map(|surface| {
        FarNormals::ALL.into_iter().zip(&surface.figures).map(move |(far, figures)| (surface.surface, far, figures))
    });
    all.map(|(surface, far, figures)| {
        let names = [surface.name().to_owned(), far_normals_name(far).to_owned()];
        names.into_iter().chain(of(far, figures)).collect()
    })
    .collect()
}

fn panel(found: &MeasuredHighlights, of: fn(&HighlightFigures) -> &[f64]) -> Panel {
    let series = FarNormals::ALL.into_iter().zip(&found.figures).map(|(far, figures)| {
        let name = far_normals_name(far);
        let points = FilterPlan::TEXELS.into_iter().zip(of(figures)).map(|(texels, value)| {
            Point::new(texels.into(), *value, format!("{name}: {value:.4} at {texels} texels a pixel"))
        });
        Series { name: name.to_owned(), style: style(far), points: points.collect() }
    });
    Panel { title: found.surface.name().to_owned(), x_label: None, notes: Vec::new(), series: series.collect() }
}

/// Colours that colour-blind readers tell apart (Okabe and Ito, "Color Universal Design", 2008).
fn style(far: FarNormals) -> Style {
    let (color, marker, stroke) = match far {
        FarNormals::Mean => ([0xd5, 0x5e, 0x00], Marker::Square, Stroke::Dot),
        FarNormals::Toksvig => ([0x00, 0x72, 0xb2], Marker::Triangle, Stroke::Dash),
        FarNormals::Lean => ([0x00, 0x9e, 0x73], Marker::Circle, Stroke::Solid),
    };
    Style { color, marker: Some(marker), filled: true, stroke }
}
