//! The light along a row of pixels over a sphere: bands where slopes jump, and light over the terminator.

use super::prelude::*;

/// Toward the light, for the bands.
const FRONT: Vec3 = Vec3::new(0.3, 0.2, 1.0);
/// From the right and a little from the viewer's side, for the terminator, so that it lies on no meridian.
const SIDE: Vec3 = Vec3::new(1.0, 0.0, 0.2);
/// Between the equator and the next parallel, where cells are widest.
const ROW: u32 = SIZE.y / 2 - 12;

/// A sphere of 16 meridians and 8 bands, so that a cell is 22.5° wide.
fn pictures(light: Vec3) -> Result<[Image; 4], ChartError> {
    four(SIZE, |world, shading| {
        camera(world, Vec3::new(0.0, 0.0, 2.9), Vec3::Y);
        sun(world, light);
        show(world, UvSphere::new(1.0, 16, 8), Material::matte(LinearRgba::gray(0.9)), shading);
    })
}

fn figure_of_row(id: &str, title: &str, all: &[Image; 4]) -> Figure {
    let lines = NAMES.into_iter().zip(all).enumerate();
    let lines = lines.map(|(kind, (name, image))| series(name, kind, &row(image, ROW), false));
    let axes = [Axis::linear("pixel"), Axis::linear("intensity (linear)")];
    figure(id, title, axes, Panel::new(format!("row {ROW} of {}", SIZE.y), lines.collect()))
}

pub(super) fn mach_bands() -> Result<FailurePage, ChartError> {
    let all = pictures(FRONT)?;
    let [flat, gouraud, phong, _] = &all;
    Ok(FailurePage {
        id: "mach-bands",
        title: "Bands where slopes jump",
        cause: "Flat shading jumps from triangle to triangle; Gouraud shading is continuous, but its slope jumps at \
                every edge, and the eye exaggerates both (E. Mach, 1865).",
        remedy: "Interpolate normals, not intensities; or use more triangles, whose jumps are smaller.",
        test: "slopes_jump_under_gouraud_and_hardly_under_phong",
        figures: vec![figure_of_row(
            "mach-bands",
            "Intensity along a row of pixels over a sphere of 16 meridians",
            &all,
        )],
        pictures: shown([("flat", flat), ("Gouraud", gouraud), ("Phong", phong)]),
    })
}

// ANCHOR: terminator
pub(super) fn terminator() -> Result<FailurePage, ChartError> {
    let all = pictures(SIDE)?;
    let [flat, gouraud, phong, truth] = &all;
    Ok(FailurePage {
        id: "terminator",
        title: "Light leaks over the terminator",
        cause: "max(n·l, 0) has a corner where light turns to shadow. A vertex on the lit side lights all of its \
                cells, also where they lie in the dark: Gouraud shading cuts the corner off, and the terminator follows the edges of the mesh.",
        remedy: "Shade at pixels, where the corner is met; it is the diffuse term that needs it, not the highlight.",
        test: "gouraud_leaks_light_over_the_terminator",
        figures: vec![figure_of_row("terminator", "Intensity along a row of pixels across the terminator", &all)],
        pictures: shown([("flat", flat), ("Gouraud", gouraud), ("Phong", phong), ("true sphere", truth)]),
    })
}
// ANCHOR_END: terminator

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest change of slope from pixel to pixel over the middle half of the row, which the eye sees as a band.
    fn kink(image: &Image) -> f64 {
        let row = row(image, ROW);
        let middle = &row[row.len() / 4..row.len() * 3 / 4];
        middle.windows(3).map(|w| (w[0].1 - 2.0 * w[1].1 + w[2].1).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn slopes_jump_under_gouraud_and_hardly_under_phong() {
        let [flat, gouraud, phong, truth] = pictures(FRONT).unwrap().each_ref().map(kink);
        // Measured: several times apart each.
        assert!(
            flat > 3.0 * gouraud && gouraud > 2.0 * phong && phong < 5.0 * truth,
            "{flat} {gouraud} {phong} {truth}"
        );
    }

    #[test]
    fn gouraud_leaks_light_over_the_terminator() {
        let [_, gouraud, phong, truth] = &pictures(SIDE).unwrap();
        // The most light where the true sphere is black, at least a few pixels from its edge.
        let dark = |image: &Image| {
            let pairs = row(image, ROW).into_iter().zip(row(truth, ROW));
            pairs.filter(|(_, (_, truth))| *truth == 0.0).map(|((_, value), _)| value).fold(0.0, f64::max)
        };
        // A vertex up to a cell of 22.5° from the terminator has up to 0.9·sin 22.5° = 0.34.
        assert!(dark(gouraud) > 0.03 && dark(phong) < 0.25 * dark(gouraud), "{} {}", dark(gouraud), dark(phong));
    }
}
