//! Large exponents in 32 bits.

use super::prelude::*;

/// Exponents.
const EXPONENTS: [f32; 9] = [1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 10_000.0];
/// The least intensity that is judged, relative to the brightest, which is 1.
const LEAST: f64 = 0.01;

/// A highlight on a sphere that fills the picture, whatever its exponent, and nothing else.
fn spawn(world: &mut World, exponent: f32, reflectance: Reflectance) {
    // cosᵅψ falls to 0.01 at about ψ = √(2·ln 100/α); with r·v in place of n·h at half of that.
    let angle = (2.0 * 100f32.ln() / exponent).sqrt().min(0.5);
    let angle = if reflectance == Reflectance::Phong { 0.5 * angle } else { angle };
    camera_above(world, 3.0, 0.7 * angle);
    sun(world, Vec3::new(0.02, 0.01, 1.0));
    let object = show(world, UvSphere::new(1.0, 64, 32), shine(exponent), Shading::Phong);
    world.entity_mut(object).insert(reflectance);
}

/// The largest error of this adapter relative to the oracle's intensity, where that is more than a hundredth of the
/// highlight's, for each of these exponents.
fn errors(adapter: &Adapter, reflectance: Reflectance, exponents: &[f32]) -> Result<Vec<(f64, f64)>, ChartError> {
    let mut judged = JudgedApp::new(adapter, UVec2::splat(64), Pixels::Float);
    let error = |&exponent: &f32| {
        judged.set(|world| spawn(world, exponent, reflectance));
        Ok((f64::from(exponent), judged.relative_error(LEAST)?))
    };
    exponents.iter().map(error).collect()
}

/// The error of a power whose cosine is off by some roundings of f32: α times as many, and those of the power itself.
/// Blinn's is a product of two vectors of three roundings each, and a sum of three; Phong's reflected direction has
/// twice n's.
fn bound(reflectance: Reflectance, exponent: f64) -> f64 {
    let roundings = if reflectance == Reflectance::Phong { 16.0 } else { 8.0 };
    (roundings * exponent + 32.0) * f64::from(f32::EPSILON) / 2.0
}

pub(super) fn page(renderers: &[ChartedAdapter]) -> Result<FailurePage, ChartError> {
    let mut lines = Vec::new();
    for ChartedAdapter { name, adapter } in renderers {
        for (words, reflectance) in [("Phong", Reflectance::Phong), ("Blinn–Phong", Reflectance::BlinnPhong)] {
            let points = errors(adapter, reflectance, &EXPONENTS)?;
            lines.push(series(&format!("{name}, {words}"), lines.len(), &points, true));
        }
    }
    let bounds = EXPONENTS.map(|exponent| (f64::from(exponent), bound(Reflectance::Phong, exponent.into())));
    lines.push(series("(16α + 32)·2⁻²⁴", 4, &bounds, false));
    Ok(FailurePage {
        id: "exponents",
        title: "Large exponents magnify rounding",
        cause: "A cosine near 1 is known to about 2⁻²⁴ in 32 bits, and a power of α multiplies that by α: the relative error \
                of a highlight grows in proportion to its exponent, to a few thousandths at 10⁴.",
        remedy: "Blinn–Phong, whose cosine is rounded less than that of a reflected direction; larger exponents than 10⁴ take \
                 more than 32 bits.",
        test: "errors_grow_with_the_exponent_and_keep_to_its_bound",
        figures: vec![figure(
            "exponents",
            "Largest relative error of a highlight against the oracle, floating-point target",
            [Axis::log("exponent α"), Axis::log("relative error")],
            Panel::new("where the highlight is above 0.01", lines),
        )],
        pictures: judged(
            renderers,
            (SIZE, Pixels::Float),
            ("shininess 10⁴, drawn", "500 times their difference", 500.0),
            |world| spawn(world, 10_000.0, Reflectance::BlinnPhong),
        )?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::{slope, test_renderers};

    #[test]
    fn errors_grow_with_the_exponent_and_keep_to_its_bound() {
        for ChartedAdapter { name, adapter } in test_renderers() {
            for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong] {
                let found = errors(adapter, reflectance, &EXPONENTS).expect("highlights can be drawn");
                for (exponent, error) in &found {
                    assert!(*error <= bound(reflectance, *exponent), "{name}, {reflectance:?}, {exponent}: {error}");
                }
                let slope = slope(&found[4..]);
                assert!((slope - 1.0).abs() < 0.35, "{name}, {reflectance:?}: {slope}, {found:?}");
            }
        }
    }
}
