//! The diagonal along which a quad is split.

use super::prelude::*;

/// A square in the plane z = 0, split along one of its diagonals.
fn square(rising: bool) -> Mesh {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let positions = corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    let indices = if rising { vec![0, 1, 2, 0, 2, 3] } else { vec![0, 1, 3, 1, 2, 3] };
    made(positions, None, indices)
}

fn picture(rising: bool, shading: Shading) -> Result<Image, ChartError> {
    drawn(Mode::Mesh, |world| {
        camera(world, Vec3::new(0.0, 0.0, 2.9), Vec3::Y);
        let lamp = PointLight { attenuation: Attenuation::new(0.3, 0.0, 0.5), ..PointLight::white() };
        world.spawn((lamp, Transform::from_xyz(0.9, 0.9, 0.6)));
        show(world, square(rising), Material::matte(LinearRgba::gray(0.8)), shading);
    })
}

/// Gouraud shading over either diagonal, and Phong shading over either.
fn pictures() -> Result<[Image; 4], ChartError> {
    let [a, b, c, d] =
        [(true, Shading::Gouraud), (false, Shading::Gouraud), (true, Shading::Phong), (false, Shading::Phong)]
            .map(|(rising, shading)| picture(rising, shading));
    Ok([a?, b?, c?, d?])
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let [rising, falling, phong, _] = &pictures()?;
    let seen = [("Gouraud, rising diagonal", rising), ("Gouraud, falling diagonal", falling), ("Phong, either", phong)];
    let lines = [0, 1, 3].into_iter().zip(seen);
    let lines = lines.map(|(kind, (name, image))| series(name, kind, &row(image, SIZE.y / 2), false));
    Ok(FailurePage {
        id: "diagonals",
        title: "The diagonal of a quad is seen",
        cause: "A quad is drawn as two triangles, and each interpolates three of its four vertices: along the \
                diagonal it depends on two of them alone.",
        remedy: "Shade at pixels, or cut quads finer, or along the diagonal whose ends are more alike.",
        test: "gouraud_depends_on_the_diagonal_and_phong_does_not",
        figures: vec![figure(
            "diagonals",
            "Intensity along the middle row of a square with a light near one corner",
            [Axis::linear("pixel"), Axis::linear("intensity (linear)")],
            Panel::new("middle row", lines.collect()),
        )],
        pictures: shown(seen),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gouraud_depends_on_the_diagonal_and_phong_does_not() {
        let [rising, falling, phong, other] = &pictures().unwrap();
        let apart = |a: &Image, b: &Image| {
            let pairs = a.pixels().iter().flatten().zip(b.pixels().iter().flatten());
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        // At the middle: the mean of a bright corner and a dark one, or of two that are dimly lit.
        assert!(apart(rising, falling) > 0.1, "{}", apart(rising, falling));
        assert!(apart(phong, other) < 1e-9, "{}", apart(phong, other));
    }
}
