//! Very near and very distant lights and viewers, in 32 bits.

use super::prelude::*;

/// The thing that is moved away from a square of edge 6.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Distant {
    /// A lamp, above the middle of the picture; the viewer is 3 units away.
    Light,
    /// The viewer, whose view stays as wide; a lamp is 1.234 units above.
    Viewer,
}

/// Powers of ten.
const POWERS: std::ops::RangeInclusive<i32> = -3..=7;
/// Factors of the distances, of which the worst counts: the loss by rounding varies at random.
const NEAR_BY: [f64; 6] = [0.83, 0.91, 0.97, 1.07, 1.13, 1.21];
/// The height of the square: not a whole number, which f32 would hold exactly.
const HEIGHT: f32 = 0.37;
/// The height of the lamp above it when the viewer moves; not a whole number, or both would be rounded alike.
const LAMP: f32 = 1.234;
/// The least intensity that is judged; full light is 1.
const LEAST: f64 = 0.05;
const SMALL: UVec2 = UVec2::splat(48);

fn distances() -> Vec<f64> {
    POWERS.map(|power| 10f64.powi(power)).collect()
}

fn spawn(world: &mut World, distant: Distant, distance: f32) {
    let [viewer, half, shift, light] = match distant {
        // The light of a near lamp fills the picture.
        Distant::Light => [3.0, (2.0 * distance).min(1.0), distance.min(1.0), distance],
        Distant::Viewer => [distance, distance.min(1.0), 1.0, LAMP],
    };
    camera_above(world, viewer, half);
    lamp(world, Vec3::new(0.3 * shift, 0.2 * shift, light));
    let object = show(world, square(1, 1), Material::matte(LinearRgba::gray(0.9)), Shading::Phong);
    world.entity_mut(object).insert(Transform::from_scale(Vec3::splat(3.0)));
    for mut at in world.query::<&mut Transform>().iter_mut(world) {
        at.translation.z += HEIGHT;
    }
}

/// The largest error of this adapter relative to the oracle's intensity at six distances about each power of ten, from
/// 10⁻³ to 10⁷ units; 10⁻⁹ where there is none.
fn errors(adapter: &Adapter, distant: Distant) -> Result<Vec<(f64, f64)>, ChartError> {
    let mut judged = JudgedApp::new(adapter, SMALL, Pixels::Float);
    let mut worst = |distance: f64| {
        // A logarithmic axis cannot show an error of 0.
        let mut worst = 1e-9;
        for factor in NEAR_BY {
            judged.set(|world| spawn(world, distant, (factor * distance) as f32));
            worst = judged.relative_error(LEAST)?.max(worst);
        }
        Ok((distance, worst))
    };
    distances().into_iter().map(&mut worst).collect()
}

/// The largest relative difference of the oracle's picture from the same view for a viewer 3 units away: the loss by
/// definition. A lamp counts as lying on the surface if it is nearer than 2·10⁻⁶ of the viewer's distance
/// ([`COINCIDENT`](halfway::lighting::equations::COINCIDENT)).
fn by_definition(distance: f64) -> Result<f64, ChartError> {
    let draw = |distance| drawn_at(SMALL, Mode::Mesh, |world| spawn(world, Distant::Viewer, distance));
    let (there, near) = (draw(distance as f32)?, draw(3.0)?);
    let channels = there.pixels().iter().flatten().zip(near.pixels().iter().flatten());
    Ok(channels.map(|(there, near)| (there / near - 1.0).abs()).fold(0.0, f64::max))
}

pub(super) fn page(renderers: &[ChartedAdapter]) -> Result<FailurePage, ChartError> {
    let mut lines = Vec::new();
    for ChartedAdapter { name, adapter } in renderers {
        for (words, distant) in [("the light", Distant::Light), ("the viewer", Distant::Viewer)] {
            lines.push(series(&format!("{name}, {words}"), lines.len(), &errors(adapter, distant)?, true));
        }
    }
    let far = distances().into_iter().filter(|distance| *distance >= 1.0);
    lines.push(measured("by definition, viewer", 4, far.map(|distance| (distance, distance)), by_definition)?);
    Ok(FailurePage {
        id: "distances",
        title: "A far viewer rounds what is near",
        cause: "Points are lit in eye space, where a coordinate at distance D is known to about D·2⁻²⁴ in 32 bits: a lamp one \
                unit from a surface is out of place by that much, and one very near it by that over its distance. Where that \
                leaves no direction, from about 5·10⁵ times the lamp’s distance on, a lamp counts as being on the surface. A far \
                lamp loses nothing.",
        remedy: "Keep the viewer within about 10⁴ times the distance between a lamp and what it lights, where 8 bits do not show \
                 it; a directional light has no place that could be rounded.",
        test: "rounding_bounds_errors_of_far_viewers_and_near_lights",
        figures: vec![figure(
            "distances",
            "Largest relative error against the oracle, floating-point target",
            [Axis::log("distance from the surface (units)"), Axis::log("relative error")],
            Panel::new("diffuse light of a lamp; errors below 10⁻⁹ are drawn there", lines),
        )],
        pictures: judged(
            renderers,
            (SIZE, Pixels::Float),
            ("viewer 113,000 units away, drawn", "20 times their difference", 20.0),
            |world| spawn(world, Distant::Viewer, 1.13e5),
        )?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::{slope, test_renderers};

    #[test]
    fn rounding_bounds_errors_of_far_viewers_and_near_lights() {
        for ChartedAdapter { name, adapter } in test_renderers() {
            let near = errors(adapter, Distant::Light).expect("a lamp can be drawn");
            // A few roundings of the viewer's distance, 3, over that of the lamp; and of what is computed.
            for (distance, error) in &near {
                let bound = f64::from(f32::EPSILON) * (8.0 + 12.0 / distance);
                assert!(*error < bound, "{name}, light at {distance}: {error}");
            }
            assert!(near[0].1 > 30.0 * near[6].1, "{name}: {near:?}");
            let far = errors(adapter, Distant::Viewer).expect("a lamp can be drawn");
            for (distance, error) in &far {
                // And where the lamp is about to count as being on the surface, it may do so in one and not in the
                // other.
                let bound = f64::from(f32::EPSILON) * (16.0 + 8.0 * distance);
                assert!(*error < bound, "{name}, viewer at {distance}: {error}");
            }
            // From 10 to 100,000 units.
            let slope = slope(&far[4..9]);
            assert!((slope - 1.0).abs() < 0.3, "{name}: {slope}, {far:?}");
        }
        let by_definition = |distance| by_definition(distance).expect("a lamp can be drawn");
        // The angle of view is rounded to f32; beyond that the lamp counts as lying on the surface, where light is
        // full.
        assert!(by_definition(4e5) < 1e-5 && by_definition(4e6) > 0.5, "{} {}", by_definition(4e5), by_definition(4e6));
    }
}
