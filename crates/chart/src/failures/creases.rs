//! Normals across creases.

use halfway::mesh::{Cylinder, NormalWeighting, Normals, ParametricSurface, Tessellation, Weld};

use super::prelude::*;

/// A can with the normals of this policy; without one, those of the surface itself.
fn can(policy: Option<Normals>) -> Mesh {
    let can = Cylinder { radius: 0.8, height: 1.2, capped: true };
    let mesh = sound(can.mesh(Tessellation::Count { rows: 3, columns: 24 }));
    let Some(policy) = policy else { return mesh };
    // As from a file with positions only.
    let (welded, _) = sound(mesh.welded(Weld::positions(1e-5)));
    welded.with_normals(policy).0
}

fn picture(policy: Option<Normals>) -> Result<Image, ChartError> {
    drawn(Mode::Mesh, |world| {
        camera(world, Vec3::new(0.0, 1.5, 2.4), Vec3::Y);
        sun(world, Vec3::new(0.6, 1.0, 0.5));
        show(world, can(policy), Material::matte(LinearRgba::gray(0.8)), Shading::Phong);
    })
}

/// Means across all edges, means up to creases of 40°, and the true normals.
fn pictures() -> Result<[Image; 3], ChartError> {
    let weighting = NormalWeighting::default();
    let creased = Normals::Creased { angle: 40.0_f32.to_radians(), weighting };
    let [mean, creased, own] = [Some(Normals::Weighted(weighting)), Some(creased), None].map(picture);
    Ok([mean?, creased?, own?])
}

/// The first channel down the middle column.
fn column(image: &Image) -> Vec<(f64, f64)> {
    let x = SIZE.x / 2;
    (0..SIZE.y).map(|y| (f64::from(y), image.pixel(x, y)[0])).collect()
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let [mean, creased, own] = &pictures()?;
    let seen = [("mean normals", mean), ("creased at 40°", creased), ("the surface’s own", own)];
    let lines = (1..).zip(seen).map(|(kind, (name, image))| series(name, kind, &column(image), false));
    Ok(FailurePage {
        id: "creases",
        title: "Mean normals round off what is sharp",
        cause: "A vertex on a sharp edge has one normal, the mean of both sides; interpolated, it shades flat faces \
                as if they were bent. Flat shading keeps the edge, and facets what is round.",
        remedy: "Split vertices where the angle between faces is larger than a crease angle (Normals::Creased), or by \
                 smoothing groups.",
        test: "mean_normals_are_wrong_at_creases",
        figures: vec![figure(
            "creases",
            "Intensity down the middle of a can, Phong shading",
            [Axis::linear("pixel"), Axis::linear("intensity (linear)")],
            Panel::new("middle column", lines.collect()),
        )],
        pictures: shown(seen),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway::reference::metrics;

    #[test]
    fn mean_normals_are_wrong_at_creases() {
        let [mean, creased, own] = pictures().unwrap();
        let [mean, creased] =
            [mean, creased].map(|image| metrics::compare(&image, &own, Encoding::Srgb).unwrap().linear.all.rmse);
        // Mean normals are wrong all over the lid; creased ones by the difference of means over facets from true ones.
        assert!(mean > 0.05 && creased < 0.1 * mean, "{mean}, {creased}");
    }
}
