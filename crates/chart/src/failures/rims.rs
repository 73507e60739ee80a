//! The rims of spots.

use halfway::prelude::*;
use halfway::reference::{Image, Mode};

use super::FailurePage;
use super::plots::{figure, log, panel, series, shown};
use super::stage::{camera_above, drawn, light, rms, show, square};
use crate::measure::MeasureError;

/// Cells along a side; odd, so that the axis meets the middle of one.
const CELLS: [u32; 4] = [9, 17, 33, 65];
/// Cutoffs in degrees.
const CUTOFFS: [f64; 9] = [2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 14.0, 18.0, 24.0];
/// The height of the light above the square, whose edge is 2.
const HEIGHT: f64 = 2.0;
/// The cutoff of the pictures, in degrees.
const WIDE: f64 = 20.0;

fn picture(cells: u32, cutoff: f64, shading: Shading) -> Result<Image, MeasureError> {
    drawn(Mode::Mesh, |world| {
        camera_above(world, 10.0, 0.99);
        let mut spot = SpotLight::white(cutoff.to_radians() as f32);
        spot.light.attenuation = Attenuation::NONE;
        world.spawn((spot, Transform::from_xyz(0.0, 0.0, HEIGHT as f32)));
        show(world, square(cells, cells), Material::matte(LinearRgba::gray(0.9)), shading);
    })
}

/// All light of a spot onto the middle of a cell under Gouraud shading, the true light being 1. `cells` of them make a
/// side of the square that the spot is one side above; the cutoff is in degrees.
///
/// # Errors
/// What the oracle cannot draw.
pub fn spot_light(cells: u32, cutoff: f64) -> Result<f64, MeasureError> {
    Ok(light(&picture(cells, cutoff, Shading::Gouraud)?) / light(&picture(cells, cutoff, Shading::Phong)?))
}

/// The cutoff in degrees below which the cone meets no corner of the cell that it is above.
pub fn first_met(cells: u32) -> f64 {
    let half_edge = 1.0 / f64::from(cells);
    (half_edge * 2f64.sqrt() / HEIGHT).atan().to_degrees()
}

/// The RMS error, linear, of a spot of 20° under Gouraud shading.
///
/// # Errors
/// What the oracle cannot draw.
pub fn rim_error(cells: u32) -> Result<f64, MeasureError> {
    rms(&picture(cells, WIDE, Shading::Gouraud)?, &picture(cells, WIDE, Shading::Phong)?)
}

pub(super) fn page() -> Result<FailurePage, MeasureError> {
    let mut lights = Vec::new();
    for (kind, cells) in CELLS.into_iter().take(3).enumerate() {
        let points = CUTOFFS.into_iter().map(|cutoff| Ok((cutoff, spot_light(cells, cutoff)?)));
        let points = points.collect::<Result<Vec<_>, MeasureError>>()?;
        let name = format!("{cells} × {cells} cells, corners met from {:.1}°", first_met(cells));
        lights.push(series(&name, kind, &points, true));
    }
    let errors = CELLS.into_iter().map(|cells| Ok((2.0 / f64::from(cells), rim_error(cells)?)));
    let errors = series("Gouraud", 1, &errors.collect::<Result<Vec<_>, MeasureError>>()?, true);
    let [coarse, fine] = [9, 33].map(|cells| picture(cells, WIDE, Shading::Gouraud));
    Ok(FailurePage {
        id: "spot-rims",
        title: "Spots are cut to the mesh",
        cause: "A cone is inside or outside at a vertex, and nothing in between: Gouraud shading ramps its rim over a cell, \
                and a cone that lies between vertices is not there at all. As the rim is a jump, its error falls with the root \
                of the edge length only.",
        remedy: "Shade spots at pixels; or give the cone an inner angle, so that it fades over more than a cell.",
        test: "spots_between_vertices_are_lost_and_rims_fall_by_the_root",
        figures: vec![
            (
                "light",
                figure(
                    "spot-rims-light",
                    "All light of a spot above the middle of a cell under Gouraud shading (true = 1; 0 has no place here)",
                    [log("cutoff (degrees)"), log("light (true = 1)")],
                    panel("a square as wide as the spot is high", lights),
                ),
            ),
            (
                "rim",
                figure(
                    "spot-rims-error",
                    "RMS error of a spot of 20° under Gouraud shading",
                    [log("edge of the cells"), log("RMS error (linear)")],
                    panel("slope ½", vec![errors]),
                ),
            ),
        ],
        pictures: shown([
            ("Gouraud, 9 × 9 cells", &coarse?),
            ("Gouraud, 33 × 33", &fine?),
            ("Phong", &picture(9, WIDE, Shading::Phong)?),
        ]),
    })
}
