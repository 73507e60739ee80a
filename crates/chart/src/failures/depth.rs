//! The least gap between two surfaces that the depth buffer resolves.

use super::prelude::*;

/// Gaps are powers of two relative to the distance; the last leaves both at one position in f32.
const LEAST_POWER: i32 = 4;
const GAPS: u32 = 21;
/// Pixels of a gap's column.
const COLUMN: u32 = 4;
/// Distances of the nearer surface over that of the near plane: powers of two, which f32 holds exactly.
const DISTANCES: [i32; 9] = [1, 3, 5, 7, 9, 11, 13, 15, 17];

/// Column i shows a surface at `distance` in front of another that is farther by 2⁻⁽ⁱ⁺⁴⁾ of it, which was spawned first
/// and so wins where depths are equal.
fn spawn(world: &mut World, distance: f32) {
    let half = GAPS as f32;
    // From −half to half across, −1 to 1 upward at distance 1: a column is two units wide.
    let camera = Camera::perspective(2.0 * 1f32.atan()).with_near(1.0);
    world.spawn((camera, Transform::default()));
    let quad = |[left, right]: [f32; 2], depth: f32| {
        [(left, -1.5), (right, -1.5), (right, 1.5), (left, 1.5)].map(|(x, y)| Vec3::new(x, y, -1.0) * depth)
    };
    let mesh = |quads: Vec<[Vec3; 4]>| {
        let indices = (0..quads.len() as u32).flat_map(|i| [0, 1, 2, 0, 2, 3].map(|corner| 4 * i + corner));
        let indices = indices.collect();
        made(quads.into_iter().flatten().collect(), None, indices)
    };
    let behind = (0..GAPS).map(|i| {
        let left = 2.0 * i as f32 - half;
        quad([left, left + 2.0], distance * (1.0 + 2f32.powi(-(i as i32) - LEAST_POWER)))
    });
    let [green, red] = [LinearRgba::rgb(0.0, 1.0, 0.0), LinearRgba::rgb(1.0, 0.0, 0.0)].map(Material::emissive);
    show(world, mesh(behind.collect()), red, Shading::Flat);
    show(world, mesh(vec![quad([-half - 1.0, half + 1.0], distance)]), green, Shading::Flat);
}

/// The least gap, relative to the distance, from which on the nearer of two surfaces hides the other, for each of these
/// distances; the near plane is at distance 1, the far plane at infinity. `None` where not even 1/16 is enough.
fn parted(adapter: &Adapter, distances: &[f64]) -> Result<Vec<(f64, Option<f64>)>, ChartError> {
    let mut judged = JudgedApp::new(adapter, UVec2::new(COLUMN * GAPS, COLUMN), Pixels::Byte);
    let gap = |&distance: &f64| {
        judged.set(|world| spawn(world, distance as f32));
        Ok((distance, least_parted(&judged.picture()?)))
    };
    distances.iter().map(gap).collect()
}

/// The least resolved gap in a picture.
fn least_parted(picture: &Image) -> Option<f64> {
    let hides = |i: &u32| {
        // Without the columns' edges.
        let pixels = (1..COLUMN - 1).flat_map(|x| (0..COLUMN).map(move |y| (COLUMN * i + x, y)));
        pixels.map(|(x, y)| picture.pixel(x, y)).all(|[red, green, _]| red < 0.5 && green > 0.5)
    };
    (0..GAPS).take_while(hides).last().map(|i| 2f64.powi(-(i as i32) - LEAST_POWER))
}

/// The stored depth of a distance, as increasing integers: 0 at the near plane and 1 at infinity, in 24 bits of fixed
/// point.
fn standard(distance: f64) -> i64 {
    ((1.0 - distance.recip()) * f64::from((1 << 24) - 1)).round() as i64
}

/// The stored depth from 1 at the near plane to 0 at infinity, in 32-bit floating point: as this project stores it.
fn reversed(distance: f64) -> i64 {
    -i64::from((distance.recip() as f32).to_bits())
}

/// The least power of two, relative to the distance, that separates two surfaces there, by arithmetic alone.
fn gap(stored: fn(f64) -> i64, distance: f64) -> f64 {
    let parts = |power: &i32| stored(distance * (1.0 + 2f64.powi(-power))) > stored(distance);
    (0..40).take_while(parts).last().map_or(1.0, |power| 2f64.powi(-power))
}

/// A picture of two surfaces that intersect far away, where the first hides the second as `hides` says.
fn crossing(hides: impl Fn(f64, f64) -> bool) -> Image {
    let pixel = |i: u32| {
        let [x, y] = [i % SIZE.x, i / SIZE.x].map(|at| (f64::from(at) + 0.5) / f64::from(SIZE.x) - 0.5);
        let [a, b] = [5e4 * (1.0 + 0.04 * y), 5e4 * (1.0 + 0.04 * y + 0.02 * x + 0.01 * y)];
        if hides(a, b) { [0.75, 0.35, 0.05] } else { [0.1, 0.3, 0.6] }
    };
    Image::new(SIZE.x, SIZE.y, (0..SIZE.x * SIZE.y).map(pixel).collect())
}

pub(super) fn page(renderers: &[ChartedAdapter]) -> Result<FailurePage, ChartError> {
    let distances = DISTANCES.map(|power| 2f64.powi(power));
    let mut lines = Vec::new();
    for ChartedAdapter { name, adapter } in renderers {
        let found = parted(adapter, &distances)?;
        let points: Vec<_> = found.into_iter().filter_map(|(distance, gap)| Some((distance, gap?))).collect();
        lines.push(series(&format!("{name}, measured"), 2 + lines.len(), &points, true));
    }
    let standard_gaps = distances.map(|distance| (distance, gap(standard, distance)));
    lines.push(series("standard, 24 bits", 0, &standard_gaps, true));
    Ok(FailurePage {
        id: "depth",
        title: "Depth that is nearly all spent near the viewer",
        cause: "1 − n/d is nearly 1 for all that is far: in 24 bits two surfaces at distance d are told apart from a gap of d²/n \
                times 2⁻²⁴ on, 0.6 % at a hundred thousand times the near plane's distance n.",
        remedy: "Reversed depth, n/d, in floating point, as this project has it: gaps of about 2⁻²³ at any distance. Else move \
                 the near plane away.",
        test: "reversed_depth_separates_closer_surfaces",
        figures: vec![figure(
            "depth",
            "The least gap between two surfaces that the nearer one hides (powers of two)",
            [Axis::log("distance (near plane = 1)"), Axis::log("gap (part of the distance)")],
            Panel::new("far end at infinity; standard depth by arithmetic", lines),
        )],
        pictures: shown([
            ("crossing at 5·10⁴, standard in 24 bits", &crossing(|a, b| standard(a) <= standard(b))),
            ("reversed float", &crossing(|a, b| reversed(a) <= reversed(b))),
            ("exact", &crossing(|a, b| a <= b)),
        ]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::test_renderers;

    #[test]
    fn reversed_depth_separates_closer_surfaces() {
        let distances: Vec<f64> = (1..=17).map(|power| 2f64.powi(power)).collect();
        for ChartedAdapter { name, adapter } in test_renderers() {
            for (distance, gap) in parted(adapter, &distances).expect("squares can be drawn") {
                // f32 tells these apart, with room for a few roundings on the way to the depth.
                assert!(gap.is_some_and(|gap| gap <= 2f64.powi(-21)), "{name} at {distance}: {gap:?}");
            }
        }
        for distance in distances {
            let of_standard = gap(standard, distance);
            // d·2⁻²⁴ to the next power of two, and by half a step of rounding more or less.
            let expected = distance * 2f64.powi(-24);
            assert!(of_standard >= 0.5 * expected && of_standard <= 4.0 * expected, "{distance}: {of_standard}");
            assert!(gap(reversed, distance) <= 2f64.powi(-23));
        }
    }
}
