//! Lights close to a surface.

use super::prelude::*;

/// Cells along a side if the lamp is above the middle of one.
const ABOVE_CELL: u32 = 9;
/// Cells along a side if it is above a vertex.
const ABOVE_VERTEX: u32 = 8;
/// Heights of the lamp, in edge lengths.
const HEIGHTS: [f64; 9] = [0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0];

/// Cells of edge 1 in a square, drawn from above under a lamp whose light falls off as 1/d².
fn spawn(world: &mut World, height: f64, cells: u32, shading: Shading) {
    // 8 edges are visible.
    camera_above(world, 40.0, 4.0);
    let lamp = PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..PointLight::white() };
    world.spawn((lamp, Transform::from_xyz(0.0, 0.0, height as f32)));
    let object = show(world, square(cells, cells), Material::matte(LinearRgba::gray(0.08)), shading);
    world.entity_mut(object).insert(Transform::from_scale(Vec3::splat(0.5 * cells as f32)));
}

/// An odd number of pixels a side, so that one lies on the axis.
fn picture(height: f64, cells: u32, shading: Shading) -> Result<Image, ChartError> {
    drawn_at(UVec2::splat(SIDE), Mode::Mesh, |world| spawn(world, height, cells, shading))
}

const SIDE: u32 = 129;

/// The light of Gouraud shading right below a lamp at a height in edge lengths, and the total light on eight by eight
/// edges; the true light is 1.
fn near_light(height: f64, cells: u32) -> Result<[f64; 2], ChartError> {
    let (gouraud, phong) = (picture(height, cells, Shading::Gouraud)?, picture(height, cells, Shading::Phong)?);
    let below = |image: &Image| image.pixel(SIDE / 2, SIDE / 2)[0];
    Ok([below(&gouraud) / below(&phong), light(&gouraud) / light(&phong)])
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let mut lines: [Vec<_>; 2] = [Vec::new(), Vec::new()];
    for (name, kind, cells) in [("above a cell", 0, ABOVE_CELL), ("above a vertex", 1, ABOVE_VERTEX)] {
        for (part, lines) in lines.iter_mut().enumerate() {
            let heights = HEIGHTS.map(|height| (height, height));
            lines.push(measured(name, kind, heights, |height| Ok(near_light(height, cells)?[part]))?);
        }
    }
    let [below, total] = lines;
    let look = |cells, shading| drawn_at(SIZE, Mode::Mesh, |world| spawn(world, 0.3, cells, shading));
    Ok(FailurePage {
        id: "near-light",
        title: "A light near a surface is lost between vertices",
        cause: "Close to a lamp light changes over a length of its height. Vertices farther apart miss it: below the lamp \
                Gouraud shading keeps (1 + 1/(2h²))^(−3/2) of it over the middle of a cell, h in edge lengths, and over a vertex \
                spreads the peak over the cells around. A lamp that moves flickers.",
        remedy: "Shade lights at pixels that are nearer than about two edges, or cut the surface finer there.",
        test: "a_light_near_a_cell_loses_light_as_the_formula_says",
        figures: vec![
            figure(
                "near-light-below",
                "Gouraud shading right below a lamp (true = 1)",
                [Axis::log("height of the lamp (edge lengths)"), Axis::log("intensity (true = 1)")],
                Panel::new("attenuation 1/d²", below),
            )
            .named("below the lamp"),
            figure(
                "near-light-total",
                "All light that Gouraud shading shows on 8 × 8 cells (true = 1)",
                [Axis::log("height of the lamp (edge lengths)"), Axis::log("light (true = 1)")],
                Panel::new("attenuation 1/d²", total),
            )
            .named("all light"),
        ],
        pictures: shown([
            ("Gouraud, lamp above a cell", &look(ABOVE_CELL, Shading::Gouraud)?),
            ("Gouraud, above a vertex", &look(ABOVE_VERTEX, Shading::Gouraud)?),
            ("Phong, either", &look(ABOVE_CELL, Shading::Phong)?),
        ]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::is_near;

    /// The light right below the lamp over the middle of a cell by formula: its corners are √(h² + ½) away, so that
    /// h/d³ is less by (1 + 1/(2h²))^(−3/2).
    fn below_by_formula(height: f64) -> f64 {
        (1.0 + 0.5 / (height * height)).powf(-1.5)
    }

    #[test]
    fn a_light_near_a_cell_loses_light_as_the_formula_says() {
        for height in [0.2, 0.5, 1.0, 3.0] {
            let found = near_light(height, ABOVE_CELL).expect("a square can be drawn");
            // The height is rounded to f32.
            is_near(&format!("{height}"), found[0], below_by_formula(height), 1e-6);
            let found = near_light(height, ABOVE_VERTEX).expect("a square can be drawn");
            is_near("a vertex", found[0], 1.0, 1e-6);
        }
        let [cell, vertex] =
            [ABOVE_CELL, ABOVE_VERTEX].map(|cells| near_light(0.2, cells).expect("a square can be drawn")[1]);
        assert!(cell < 0.7 && vertex > 2.0, "it flickers: {cell}, {vertex}");
        let far = near_light(5.0, ABOVE_CELL).expect("a square can be drawn")[1];
        // By a twelfth of the curvature over the light: −6/(12·25).
        is_near("a light that is far enough", far, 1.0, 0.03);
    }
}
