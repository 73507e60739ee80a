//! Many blended layers in 8 bits.

use super::prelude::*;

/// The most layers.
const LAYERS: u32 = 64;
/// The emission of the layers.
const GLOW: [f32; 3] = [1.0, 0.6, 0.3];
const OPACITIES: [f32; 3] = [0.5, 0.05, 0.005];
/// Four pixels for each number of layers.
const SIZE: UVec2 = UVec2::new(4 * LAYERS, 64);

/// Layers on black; column i shows i + 1 of them.
fn spawn(world: &mut World, opacity: f32) {
    camera_above(world, 100.0, 0.25);
    world.query::<&mut Camera>().iter_mut(world).for_each(|mut camera| camera.encoding = Encoding::Raw);
    let quad = |layer: u32| {
        let left = 2.0 * layer as f32 / LAYERS as f32 - 1.0;
        let z = 1e-4 * layer as f32;
        [(left, -1.0), (1.1, -1.0), (1.1, 1.0), (left, 1.0)].map(|(x, y)| Vec3::new(x, y, z))
    };
    let indices = (0..LAYERS).flat_map(|layer| [0, 1, 2, 0, 2, 3].map(|corner| 4 * layer + corner)).collect();
    let mesh = made((0..LAYERS).flat_map(quad).collect(), None, indices);
    let [red, green, blue] = GLOW;
    let material = Material { opacity, ..Material::emissive(LinearRgba::rgb(red, green, blue)) };
    let object = show(world, mesh, material, Shading::Flat);
    world.entity_mut(object).insert(AlphaMode::Blend);
}

/// The exact sum of n layers of opacity o and color c, linear: c·(1 − (1 − o)ⁿ).
fn exact(layers: u32, opacity: f32) -> [f64; 3] {
    let shown = 1.0 - (1.0 - f64::from(opacity)).powi(layers as i32);
    GLOW.map(|glow| f64::from(glow) * shown)
}

/// The largest error of a channel in steps of 1/255, on 8 bits, for 1 to 64 layers of this opacity.
fn drawn(adapter: &Adapter, opacity: f32) -> Result<Vec<(f64, f64)>, ChartError> {
    let mut judged = JudgedApp::new(adapter, SIZE, Pixels::Byte);
    judged.set(|world| spawn(world, opacity));
    let picture = judged.picture()?;
    let error = |layers: u32| {
        let there = picture.pixel(4 * layers - 2, SIZE.y / 2);
        (f64::from(layers), steps(there, exact(layers, opacity)))
    };
    Ok((1..=LAYERS).map(error).collect())
}

/// The error by arithmetic: each layer is blended exactly and rounded to the nearest step.
fn rounded(opacity: f32) -> Vec<(f64, f64)> {
    let o = f64::from(opacity);
    let mut held = [0.0; 3];
    let mut error = |layers: u32| {
        for (held, glow) in held.iter_mut().zip(GLOW) {
            *held = (255.0 * (o * f64::from(glow) + (1.0 - o) * *held)).round() / 255.0;
        }
        (f64::from(layers), steps(held, exact(layers, opacity)))
    };
    (1..=LAYERS).map(&mut error).collect()
}

fn steps(there: [f64; 3], exact: [f64; 3]) -> f64 {
    there.into_iter().zip(exact).map(|(there, exact)| 255.0 * (there - exact).abs()).fold(0.0, f64::max)
}

/// The largest accumulated error, in steps, of `each` step a layer, after any number of layers: each·Σ (1 − o)ᵏ.
/// Rounding to the nearest step errs by ½, an adapter that truncates by 1.
fn most(opacity: f64, each: f64) -> f64 {
    each / opacity
}

pub(super) fn page(renderers: &[ChartedAdapter]) -> Result<FailurePage, ChartError> {
    let mut panels = Vec::new();
    for opacity in OPACITIES {
        let mut lines = Vec::new();
        for ChartedAdapter { name, adapter } in renderers {
            lines.push(series(name, lines.len(), &drawn(adapter, opacity)?, false));
        }
        lines.push(series("rounded after each layer, by arithmetic", 3, &rounded(opacity), false));
        let most = most(f64::from(opacity), 0.5).round();
        let steps = if most <= 1.0 { "step" } else { "steps" };
        panels.push(Panel::new(format!("opacity {opacity}: at most {most} {steps}"), lines));
    }
    let axes = [Axis::linear("layers"), Axis::linear("error (steps of 1/255)")];
    let title = "Largest error of a channel over the number of layers";
    Ok(FailurePage {
        id: "blended-layers",
        title: "Many thin layers stop in 8 bits",
        cause: "An 8-bit target rounds after each layer, some adapters downward. A layer that adds less than half a step adds \
                nothing: many thin layers stop short of what they should reach, by up to ½/o steps for an opacity of o, and blue \
                of 0.3 under 0.005 never shows. The CPU without a driver keeps tiles in floating point and rounds once.",
        remedy: "Blend into a floating-point target (Pixels::Float) and round once, or draw fewer layers of more opacity.",
        test: "thin_layers_stop_short_by_the_sum_of_roundings",
        figures: vec![Figure::new("failure-blended-layers", title, axes, panels)],
        pictures: judged(
            renderers,
            (SIZE, Pixels::Byte),
            ("1 to 64 layers of opacity 0.005 in 8 bits", "10 times their difference", 10.0),
            |world| spawn(world, OPACITIES[2]),
        )?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::test_renderers;

    #[test]
    fn thin_layers_stop_short_by_the_sum_of_roundings() {
        for opacity in [0.5f32, 0.05, 0.005] {
            let o = f64::from(opacity);
            for ChartedAdapter { name, adapter } in test_renderers() {
                // A step a layer at most, and half a step of the last one; on the CPU nothing but the last.
                let bound = if matches!(adapter, Adapter::Cpu(_)) { 0.0 } else { most(o, 1.0) };
                for (count, error) in drawn(adapter, opacity).expect("layers can be drawn") {
                    assert!(error <= bound + 0.51, "{name}, {opacity}, {count} layers: {error}");
                }
            }
            for (count, error) in rounded(opacity) {
                assert!(error <= most(o, 0.5), "{opacity}, {count} layers: {error}");
            }
        }
        // Blue of 0.3 at 0.005 is 0.38 of a step, and is never visible; 64 layers should come to 21.
        let lost = 255.0 * exact(LAYERS, 0.005)[2];
        let found = rounded(0.005).last().expect("64 layers").1;
        assert!(lost > 20.0 && found >= lost - 1e-9, "{lost}: {found}");
    }
}
