//! Mach bands.

use halfway::prelude::*;
use halfway::reference::Image;

use super::plots::{names, row, series, shown};
use super::stage::{SIZE, camera, four, show, sun};
use super::{FailurePage, only};
use crate::figure::{Axis, AxisScale, Figure, Panel};
use crate::measure::MeasureError;

fn pictures() -> Result<[Image; 4], MeasureError> {
    four(|world, shading| {
        camera(world, Vec3::new(0.0, 0.0, 2.9), Vec3::Y);
        sun(world, Vec3::new(0.3, 0.2, 1.0));
        show(world, UvSphere::new(1.0, 16, 8), Material::matte(LinearRgba::gray(0.9)), shading);
    })
}

/// Between the equator and the next parallel, where cells are widest.
const ROW: u32 = SIZE.y / 2 - 12;

/// The largest change of slope from pixel to pixel over the middle half of the row: what an eye sees as a band.
#[cfg(test)]
fn kink(image: &Image) -> f64 {
    let row = row(image, ROW);
    let middle = &row[row.len() / 4..row.len() * 3 / 4];
    middle.windows(3).map(|w| (w[0].1 - 2.0 * w[1].1 + w[2].1).abs()).fold(0.0, f64::max)
}

pub(super) fn page() -> Result<FailurePage, MeasureError> {
    let all = pictures()?;
    let lines = names().into_iter().zip(&all).enumerate();
    let panel = Panel {
        title: format!("row {ROW} of {}", SIZE.y),
        x_label: None,
        notes: Vec::new(),
        series: lines.map(|(kind, (name, image))| series(name, kind, &row(image, ROW), false)).collect(),
    };
    let [flat, gouraud, phong, _] = &all;
    Ok(FailurePage {
        id: "mach-bands",
        title: "Bands where slopes jump",
        cause: "Flat shading jumps from triangle to triangle; Gouraud shading is continuous, but its slope jumps at \
                every edge, and the eye exaggerates both (E. Mach, 1865).",
        remedy: "Interpolate normals, not intensities; or use more triangles, whose jumps are smaller.",
        test: "slopes_jump_under_gouraud_and_hardly_under_phong",
        figures: only(Figure {
            id: "failure-mach-bands".to_owned(),
            title: "Intensity along a row of pixels over a sphere of 16 meridians".to_owned(),
            x: Axis::new("pixel", AxisScale::Linear),
            y: Axis::new("intensity (linear)", AxisScale::Linear),
            columns: 1,
            panels: vec![panel],
        }),
        pictures: shown([("flat", flat), ("Gouraud", gouraud), ("Phong", phong)]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_jump_under_gouraud_and_hardly_under_phong() {
        let [flat, gouraud, phong, truth] = pictures().unwrap().each_ref().map(kink);
        // Measured: several times apart each.
        assert!(
            flat > 3.0 * gouraud && gouraud > 2.0 * phong && phong < 5.0 * truth,
            "{flat} {gouraud} {phong} {truth}"
        );
    }
}
