//! Surfaces seen nearly edge-on, in 32 bits.

use super::prelude::*;

/// Angles between the surface and the line of sight, in degrees.
const ANGLES: [f64; 9] = [60.0, 30.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01];
/// The viewer's distance.
const DISTANCE: f64 = 3.0;
/// The least intensity that is judged; full light is 1.
const LEAST: f64 = 0.05;

/// A square under a lamp; about one unit of it is visible along the line of sight, whatever the angle. All of it is
/// rotated against every axis, so that a matrix has sums to round, and points are given in world space.
fn spawn(world: &mut World, degrees: f64) {
    let turn = Quat::from_euler(EulerRot::XYZ, 0.5, 0.6, 0.7);
    let angle = degrees.to_radians();
    camera_above(world, DISTANCE as f32, (0.5 * angle.sin()) as f32);
    world.query::<(&Camera, &mut Transform)>().iter_mut(world).for_each(|(_, mut at)| {
        *at = Transform::from_rotation(turn) * *at;
    });
    let (up, along) = angle.sin_cos();
    let n = turn * Vec3::new(0.0, along as f32, up as f32);
    lamp(world, 0.5 * n + 0.1 * (turn * Vec3::X));
    let corner = |p: &Vec3| turn * (1.5 * Vec3::new(p.x, p.y * up as f32, -p.y * along as f32));
    let mesh = square(1, 1);
    let positions = mesh.positions().iter().map(corner).collect();
    let mesh = made(positions, Some(vec![n; 4]), mesh.indices().to_vec());
    show(world, mesh, Material::matte(LinearRgba::gray(0.9)), Shading::Phong);
}

/// The largest error of this adapter relative to the oracle's intensity at each of [`ANGLES`].
fn errors(adapter: &Adapter) -> Result<Vec<(f64, f64)>, ChartError> {
    let mut judged = JudgedApp::new(adapter, UVec2::splat(48), Pixels::Float);
    let error = |degrees: f64| {
        judged.set(|world| spawn(world, degrees));
        Ok((degrees, judged.relative_error(LEAST)?))
    };
    ANGLES.into_iter().map(error).collect()
}

/// The distance that a point slides along the surface, in units, if the surface moves by half a step of f32 at the
/// viewer's distance; at an angle in degrees. The light there changes by about as much, relatively.
fn slip(degrees: f64) -> f64 {
    DISTANCE * f64::from(f32::EPSILON) / 2.0 / degrees.to_radians().sin()
}

pub(super) fn page(renderers: &[ChartedAdapter]) -> Result<FailurePage, ChartError> {
    let mut lines = Vec::new();
    for ChartedAdapter { name, adapter } in renderers {
        lines.push(series(name, lines.len(), &errors(adapter)?, true));
    }
    lines.push(series(
        "half a step of f32 over the sine of the angle",
        3,
        &ANGLES.map(|degrees| (degrees, slip(degrees))),
        false,
    ));
    Ok(FailurePage {
        id: "edge-on",
        title: "Surfaces seen edge-on magnify rounding",
        cause: "A ray that grazes a surface meets it far along: what rounding moves the surface by, the point that is lit moves \
                by over the sine of the angle. The error of positions, and of light that depends on them, grows with one over \
                the angle.",
        remedy: "None is needed above a tenth of a degree, where less than a step of 8 bits is lost; cut surfaces that are seen \
                 so, so that their corners are near what is seen.",
        test: "errors_grow_with_one_over_the_angle",
        figures: vec![figure(
            "edge-on",
            "Largest relative error against the oracle, floating-point target",
            [Axis::log("angle between surface and line of sight (degrees)"), Axis::log("relative error")],
            Panel::new("diffuse light of a lamp half a unit above, viewer 3 units away", lines),
        )],
        pictures: judged(
            renderers,
            (SIZE, Pixels::Float),
            ("at 0.01°, drawn", "500 times their difference", 500.0),
            |world| spawn(world, 0.01),
        )?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::{slope, test_renderers};

    #[test]
    fn errors_grow_with_one_over_the_angle() {
        for ChartedAdapter { name, adapter } in test_renderers() {
            let found = errors(adapter).expect("a square can be drawn");
            for (degrees, error) in &found {
                let bound = 8.0 * slip(*degrees) + 16.0 * f64::from(f32::EPSILON);
                assert!(*error < bound, "{name}, {degrees}°: {error}");
            }
            let slope = slope(&found[4..]);
            assert!((slope + 1.0).abs() < 0.5, "{name}: {slope}, {found:?}");
        }
    }
}
