//! What the pages plot.

use halfway::prelude::Encoding;
use halfway::reference::Image;
use image::RgbImage;

use super::stage::SIZE;
use crate::figure::{Axis, AxisScale, Figure, Marker, Panel, Point, Series, Stroke, Style};
use crate::measure::{SHADINGS, shading_name};

/// The names of the three shadings and of the truth.
pub(super) fn names() -> [&'static str; 4] {
    let [flat, gouraud, phong] = SHADINGS.map(shading_name);
    [flat, gouraud, phong, "true surface"]
}

/// The first channel along a row of pixels, from column to column where something is covered.
pub(super) fn row(image: &Image, y: u32) -> Vec<(f64, f64)> {
    let covered = |x: u32| image.covered().is_none_or(|covered| covered[(y * SIZE.x + x) as usize]);
    (0..SIZE.x).filter(|x| covered(*x)).map(|x| (f64::from(x), image.pixel(x, y)[0])).collect()
}

/// Lines of five kinds that are told apart by colour and by stroke.
pub(super) fn series(name: &str, kind: usize, points: &[(f64, f64)], marked: bool) -> Series {
    let styles = [
        ([0xd5, 0x5e, 0x00], Marker::Square, Stroke::Dot),
        ([0x00, 0x72, 0xb2], Marker::Triangle, Stroke::Dash),
        ([0x00, 0x9e, 0x73], Marker::Circle, Stroke::Solid),
        ([0x22, 0x22, 0x22], Marker::Diamond, Stroke::Solid),
        ([0xcc, 0x79, 0xa7], Marker::Wedge, Stroke::Dash),
    ];
    let (color, marker, stroke) = styles[kind % styles.len()];
    let point = |&(x, y): &(f64, f64)| Point::new(x, y, format!("{name}: {} at {}", number(y), number(x)));
    Series {
        name: name.to_owned(),
        style: Style { color, marker: marked.then_some(marker), filled: true, stroke },
        points: points.iter().map(point).collect(),
    }
}

/// With four decimals where that tells it, else with a power of ten.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-2..1e5).contains(&size) { format!("{value:.4}") } else { format!("{value:.2e}") }
}

pub(super) fn linear(label: &str) -> Axis {
    Axis::new(label, AxisScale::Linear)
}

pub(super) fn log(label: &str) -> Axis {
    Axis::new(label, AxisScale::Log)
}

pub(super) fn panel(title: &str, series: Vec<Series>) -> Panel {
    Panel { title: title.to_owned(), x_label: None, notes: Vec::new(), series }
}

/// One panel.
pub(super) fn figure(id: &str, title: &str, [x, y]: [Axis; 2], of: Panel) -> Figure {
    Figure { id: format!("failure-{id}"), title: title.to_owned(), x, y, columns: 1, panels: vec![of] }
}

/// As they are looked at.
pub(super) fn shown<const N: usize>(pictures: [(&'static str, &Image); N]) -> Vec<(&'static str, RgbImage)> {
    pictures.map(|(caption, picture)| (caption, picture.to_bytes(Encoding::Srgb))).into()
}
