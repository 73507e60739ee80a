//! Lights close to a surface.

use halfway::prelude::*;
use halfway::reference::{Image, Mode};

use super::FailurePage;
use super::plots::{figure, log, panel, series, shown};
use super::stage::{SIZE, camera_above, drawn_at, light, show, square};
use crate::measure::MeasureError;

/// What the lamp is above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LampAbove {
    /// The middle of a cell.
    Cell,
    /// A vertex.
    Vertex,
}

/// Heights of the lamp, in edge lengths.
const HEIGHTS: [f64; 9] = [0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0];

/// Cells of edge 1 in a square, drawn from above under a lamp whose light goes with 1/d².
fn spawn(world: &mut World, height: f64, above: LampAbove, shading: Shading) {
    // An odd number has a cell at the middle, an even one a vertex.
    let cells = if above == LampAbove::Cell { 9 } else { 8 };
    // 8 edges are seen.
    camera_above(world, 40.0, 4.0);
    let lamp = PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..PointLight::white() };
    world.spawn((lamp, Transform::from_xyz(0.0, 0.0, height as f32)));
    let object = show(world, square(cells, cells), Material::matte(LinearRgba::gray(0.08)), shading);
    world.entity_mut(object).insert(Transform::from_scale(Vec3::splat(0.5 * cells as f32)));
}

/// Of pixels an odd number a side, so that one lies on the axis.
fn picture(height: f64, above: LampAbove, shading: Shading) -> Result<Image, MeasureError> {
    drawn_at(UVec2::splat(SIDE), Mode::Mesh, |world| spawn(world, height, above, shading))
}

const SIDE: u32 = 129;

/// What Gouraud shading makes of a lamp close to a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearLight {
    /// Right below the lamp; the true intensity is 1.
    pub below: f64,
    /// All light on eight by eight edges; the true light is 1.
    pub total: f64,
}

/// Measures it with a lamp at a height in edge lengths.
///
/// # Errors
/// What the oracle cannot draw.
pub fn near_light(height: f64, above: LampAbove) -> Result<NearLight, MeasureError> {
    let (gouraud, phong) = (picture(height, above, Shading::Gouraud)?, picture(height, above, Shading::Phong)?);
    let below = |image: &Image| image.pixel(SIDE / 2, SIDE / 2)[0];
    Ok(NearLight { below: below(&gouraud) / below(&phong), total: light(&gouraud) / light(&phong) })
}

/// [`NearLight::below`] over the middle of a cell by formula: its corners are √(h² + ½) away, so that h/d³ is less by
/// (1 + 1/(2h²))^(−3/2).
pub fn below_by_formula(height: f64) -> f64 {
    (1.0 + 0.5 / (height * height)).powf(-1.5)
}

pub(super) fn page() -> Result<FailurePage, MeasureError> {
    let mut lines: [Vec<_>; 2] = [Vec::new(), Vec::new()];
    for (name, kind, above) in [("above a cell", 0, LampAbove::Cell), ("above a vertex", 1, LampAbove::Vertex)] {
        let found = HEIGHTS.into_iter().map(|height| Ok((height, near_light(height, above)?)));
        let found = found.collect::<Result<Vec<_>, MeasureError>>()?;
        let parts: [fn(&NearLight) -> f64; 2] = [|found| found.below, |found| found.total];
        for (lines, part) in lines.iter_mut().zip(parts) {
            let points: Vec<_> = found.iter().map(|(height, found)| (*height, part(found))).collect();
            lines.push(series(name, kind, &points, true));
        }
    }
    let [below, total] = lines;
    let look = |above, shading| drawn_at(SIZE, Mode::Mesh, |world| spawn(world, 0.3, above, shading));
    Ok(FailurePage {
        id: "near-light",
        title: "A light near a surface is lost between vertices",
        cause: "Close to a lamp light changes over a length of its height. Vertices farther apart miss it: below the lamp \
                Gouraud shading keeps (1 + 1/(2h²))^(−3/2) of it over the middle of a cell, h in edge lengths, and over a vertex \
                spreads the peak over the cells around. A lamp that moves flickers.",
        remedy: "Shade lights at pixels that are nearer than about two edges, or cut the surface finer there; Shading::Auto \
                 does so light by light.",
        test: "a_light_near_a_cell_keeps_what_the_formula_says",
        figures: vec![
            (
                "below the lamp",
                figure(
                    "near-light-below",
                    "Gouraud shading right below a lamp (true = 1)",
                    [log("height of the lamp (edge lengths)"), log("intensity (true = 1)")],
                    panel("attenuation 1/d²", below),
                ),
            ),
            (
                "all light",
                figure(
                    "near-light-total",
                    "All light that Gouraud shading shows on 8 × 8 cells (true = 1)",
                    [log("height of the lamp (edge lengths)"), log("light (true = 1)")],
                    panel("attenuation 1/d²", total),
                ),
            ),
        ],
        pictures: shown([
            ("Gouraud, lamp above a cell", &look(LampAbove::Cell, Shading::Gouraud)?),
            ("Gouraud, above a vertex", &look(LampAbove::Vertex, Shading::Gouraud)?),
            ("Phong, either", &look(LampAbove::Cell, Shading::Phong)?),
        ]),
    })
}
