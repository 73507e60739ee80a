//! The order in which blended surfaces are drawn.

use super::prelude::*;

/// The colours of the two squares; they differ by 1 in red and blue.
const COLORS: [LinearRgba; 2] = [LinearRgba::rgb(1.0, 0.25, 0.0), LinearRgba::rgb(0.0, 0.25, 1.0)];
const OPACITIES: [f32; 9] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];

/// The order in which two squares that intersect are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Squares {
    /// Whole: neither is behind the other.
    Crossing,
    /// Whole, the second one spawned first.
    Swapped,
    /// Cut along their intersection: each of the four halves is behind or in front of the others.
    Cut,
}

/// A part of a square from z = left to z = right along the diagonal x = z, or x = −z.
fn part(rises: bool, [left, right]: [f32; 2]) -> Mesh {
    let corner = |x: f32, y: f32| Vec3::new(x, y, if rises { x } else { -x });
    let corners = [corner(left, -1.0), corner(right, -1.0), corner(right, 1.0), corner(left, 1.0)];
    made(corners.to_vec(), None, vec![0, 1, 2, 0, 2, 3])
}

fn picture(squares: Squares, opacity: f32) -> Result<Image, ChartError> {
    drawn(Mode::Mesh, |world| {
        camera(world, Vec3::new(0.0, 0.0, 4.5), Vec3::Y);
        let order = if squares == Squares::Swapped { [1, 0] } else { [0, 1] };
        let parts: &[[f32; 2]] = if squares == Squares::Cut { &[[-1.0, 0.0], [0.0, 1.0]] } else { &[[-1.0, 1.0]] };
        for (which, ends) in order.into_iter().flat_map(|which| parts.iter().map(move |ends| (which, *ends))) {
            let material = Material { opacity, ..Material::emissive(COLORS[which]) };
            let object = show(world, part(which == 0, ends), material, Shading::Flat);
            world.entity_mut(object).insert(AlphaMode::Blend);
        }
    })
}

/// Draws two intersecting blended squares object by object, and compares them with the same squares cut along their
/// intersection: the fraction of wrong pixels, among those that show both, and the largest error, linear.
fn wrong_order(opacity: f32) -> Result<(f64, f64), ChartError> {
    let [first, second, truth] =
        [Squares::Crossing, Squares::Swapped, Squares::Cut].map(|squares| picture(squares, opacity));
    let (first, second, truth) = (first?, second?, truth?);
    let differ = |a: &Image, b: &Image| {
        let pixels = a.pixels().iter().zip(b.pixels());
        pixels.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 1e-9)).count()
    };
    // Where both are visible, the two orders differ.
    let share = differ(&first, &truth) as f64 / differ(&first, &second).max(1) as f64;
    Ok((share, compared(&first, &truth)?.linear.all.max()))
}

/// The error by formula: o·a + (1 − o)·o·b less o·b + (1 − o)·o·a is o²·(a − b).
fn wrong_by(opacity: f64) -> f64 {
    opacity * opacity
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let opacities = OPACITIES.map(|opacity| (f64::from(opacity), opacity));
    let drawn = measured("drawn object by object", 0, opacities, |opacity| Ok(wrong_order(opacity)?.1))?;
    let formula: Vec<_> = (0..=20).map(|i| f64::from(i) / 20.0).map(|opacity| (opacity, wrong_by(opacity))).collect();
    Ok(FailurePage {
        id: "blend-order",
        title: "Blended objects that cross have no order",
        cause: "Blended objects are drawn whole, from back to front by the middle of each. Of two that pass through each other \
                each is in front somewhere: half of the pixels blend in the wrong order, wrong by o²·|a − b| for opacities o and \
                colours a and b, and which half that is jumps as the camera passes.",
        remedy: "Cut objects where they cross; where a mask will do, cut them out instead of blending (AlphaMode::Mask).",
        test: "crossing_objects_are_wrong_by_the_square_of_their_opacity",
        figures: vec![figure(
            "blend-order",
            "Largest error of two crossing squares whose colours differ by 1",
            [Axis::linear("opacity"), Axis::linear("error (linear)")],
            Panel::new("wrong on half of the pixels", vec![series("opacity²", 3, &formula, false), drawn]),
        )],
        pictures: shown([
            ("by object", &picture(Squares::Crossing, 0.7)?),
            ("the other first", &picture(Squares::Swapped, 0.7)?),
            ("cut where they cross", &picture(Squares::Cut, 0.7)?),
        ]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::is_near;

    #[test]
    fn crossing_objects_are_wrong_by_the_square_of_their_opacity() {
        for opacity in [0.2f32, 0.5, 0.8] {
            let (share, most) = wrong_order(opacity).expect("squares can be drawn");
            // Rounded to f32 is the opacity, and nothing else.
            is_near("by how much", most, wrong_by(opacity.into()), 1e-6);
            assert!((share - 0.5).abs() < 0.02, "half of the pixels: {share}");
        }
    }
}
