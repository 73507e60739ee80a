//! The rims of spots.

use super::prelude::*;

/// Cells along a side; odd, so that the axis meets the middle of one.
const CELLS: [u32; 4] = [9, 17, 33, 65];
/// Cutoffs in degrees.
const CUTOFFS: [f64; 9] = [2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 14.0, 18.0, 24.0];
/// The height of the light above the square, whose edge is 2.
const HEIGHT: f64 = 2.0;
/// The cutoff of the pictures, in degrees.
const WIDE: f64 = 20.0;

fn picture(cells: u32, cutoff: f64, shading: Shading) -> Result<Image, ChartError> {
    drawn(Mode::Mesh, |world| {
        camera_above(world, 10.0, 0.99);
        let mut spot = SpotLight::white(cutoff.to_radians() as f32);
        spot.light.attenuation = Attenuation::NONE;
        world.spawn((spot, Transform::from_xyz(0.0, 0.0, HEIGHT as f32)));
        show(world, square(cells, cells), Material::matte(LinearRgba::gray(0.9)), shading);
    })
}

/// The total light of a spot on the middle of a cell under Gouraud shading, relative to the true light. `cells` of them
/// make a side of the square that the spot is one side above; the cutoff is in degrees.
fn spot_light(cells: u32, cutoff: f64) -> Result<f64, ChartError> {
    Ok(light(&picture(cells, cutoff, Shading::Gouraud)?) / light(&picture(cells, cutoff, Shading::Phong)?))
}

/// The cutoff in degrees below which the cone contains no corner of the cell below it.
fn first_met(cells: u32) -> f64 {
    let half_edge = 1.0 / f64::from(cells);
    (half_edge * 2f64.sqrt() / HEIGHT).atan().to_degrees()
}

/// The RMS error, linear, of a spot of 20° under Gouraud shading.
fn rim_error(cells: u32) -> Result<f64, ChartError> {
    rms(&picture(cells, WIDE, Shading::Gouraud)?, &picture(cells, WIDE, Shading::Phong)?)
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let mut lights = Vec::new();
    for (kind, cells) in CELLS.into_iter().take(3).enumerate() {
        let name = format!("{cells} × {cells} cells, corners met from {:.1}°", first_met(cells));
        let cutoffs = CUTOFFS.map(|cutoff| (cutoff, cutoff));
        lights.push(measured(&name, kind, cutoffs, |cutoff| spot_light(cells, cutoff))?);
    }
    let errors = measured("Gouraud", 1, CELLS.map(|cells| (2.0 / f64::from(cells), cells)), rim_error)?;
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
            figure(
                "spot-rims-light",
                "All light of a spot above the middle of a cell under Gouraud shading (true = 1; 0 has no place here)",
                [Axis::log("cutoff (degrees)"), Axis::log("light (true = 1)")],
                Panel::new("a square as wide as the spot is high", lights),
            )
            .named("light"),
            figure(
                "spot-rims-error",
                "RMS error of a spot of 20° under Gouraud shading",
                [Axis::log("edge of the cells"), Axis::log("RMS error (linear)")],
                Panel::new("slope ½", vec![errors]),
            )
            .named("rim"),
        ],
        pictures: shown([
            ("Gouraud, 9 × 9 cells", &coarse?),
            ("Gouraud, 33 × 33", &fine?),
            ("Phong", &picture(9, WIDE, Shading::Phong)?),
        ]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::slope;

    #[test]
    fn spots_between_vertices_are_lost_and_rims_fall_by_the_root() {
        for cells in [9, 17, 33] {
            let light = |cutoff: f64| spot_light(cells, cutoff).expect("a square can be drawn");
            assert!(light(0.99 * first_met(cells)) <= 0.0, "{cells}: the cone meets no corner");
            assert!(light(1.01 * first_met(cells)) > 0.5, "{cells}: the cone meets four corners");
        }
        let found =
            [9, 17, 33, 65].map(|cells| (1.0 / f64::from(cells), rim_error(cells).expect("a square can be drawn")));
        let slope = slope(&found);
        assert!((slope - 0.5).abs() < 0.15, "by the root: {slope}, {found:?}");
    }
}
