//! Where light turns to shadow.

use halfway::prelude::*;
use halfway::reference::Image;

use super::plots::{names, row, series, shown};
use super::stage::{SIZE, camera, four, show, sun};
use super::{FailurePage, only};
use crate::figure::{Axis, AxisScale, Figure, Panel};
use crate::measure::MeasureError;

/// Bands of the sphere; a cell is 180°/8 wide.
const LEVEL: u32 = 8;

/// Lit from the right and a little from the viewer's side, so that the terminator lies on no meridian.
fn pictures() -> Result<[Image; 4], MeasureError> {
    four(|world, shading| {
        camera(world, Vec3::new(0.0, 0.0, 2.9), Vec3::Y);
        sun(world, Vec3::new(1.0, 0.0, 0.2));
        show(world, UvSphere::new(1.0, 2 * LEVEL, LEVEL), Material::matte(LinearRgba::gray(0.9)), shading);
    })
}

const ROW: u32 = SIZE.y / 2 - 12;

pub(super) fn page() -> Result<FailurePage, MeasureError> {
    let all = pictures()?;
    let lines = names().into_iter().zip(&all).enumerate();
    let panel = Panel {
        title: format!("row {ROW} of {}", SIZE.y),
        x_label: None,
        notes: Vec::new(),
        series: lines.map(|(kind, (name, image))| series(name, kind, &row(image, ROW), false)).collect(),
    };
    let [flat, gouraud, phong, truth] = &all;
    Ok(FailurePage {
        id: "terminator",
        title: "Light leaks over the terminator",
        cause: "max(n·l, 0) has a corner where light turns to shadow. A vertex on the lit side lights all of its \
                cells, also where they lie in the dark: Gouraud shading cuts the corner off, and the terminator follows the edges of the mesh.",
        remedy: "Shade at pixels, where the corner is met; it is the diffuse term that needs it, not the highlight.",
        test: "gouraud_lights_what_is_in_the_dark",
        figures: only(Figure {
            id: "failure-terminator".to_owned(),
            title: "Intensity along a row of pixels across the terminator".to_owned(),
            x: Axis::new("pixel", AxisScale::Linear),
            y: Axis::new("intensity (linear)", AxisScale::Linear),
            columns: 1,
            panels: vec![panel],
        }),
        pictures: shown([("flat", flat), ("Gouraud", gouraud), ("Phong", phong), ("true sphere", truth)]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gouraud_lights_what_is_in_the_dark() {
        let [_, gouraud, phong, truth] = &pictures().unwrap();
        // The most light where the true sphere is black, and a few pixels from its edge.
        let dark = |image: &Image| {
            let pairs = row(image, ROW).into_iter().zip(row(truth, ROW));
            pairs.filter(|(_, (_, truth))| *truth == 0.0).map(|((_, value), _)| value).fold(0.0, f64::max)
        };
        // A vertex up to a cell of 22.5° from the terminator has up to 0.9·sin 22.5° = 0.34.
        assert!(dark(gouraud) > 0.03 && dark(phong) < 0.25 * dark(gouraud), "{} {}", dark(gouraud), dark(phong));
    }
}
