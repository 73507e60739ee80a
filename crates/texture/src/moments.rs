//! The moments of normals, texel by texel: the inputs of LEAN mapping.

/// Slopes are clamped to this, 86° from the surface's normal: steeper ones would dominate the means.
const STEEPEST: f64 = 16.0;

/// For each normal its slopes x/z and y/z, and their products xx, xy and yy. Slopes of normals that lie flat or point
/// into the surface are clamped.
pub(crate) fn moments(normals: &[[f32; 4]]) -> [Vec<[f32; 4]>; 2] {
    let slopes = || normals.iter().map(slopes_of);
    let squares = slopes().map(|[x, y]| [x * x, x * y, y * y].map(|number| number as f32));
    [
        slopes().map(|[x, y]| [x as f32, y as f32, 0.0, 1.0]).collect(),
        squares.map(|[xx, xy, yy]| [xx, xy, yy, 1.0]).collect(),
    ]
}

fn slopes_of(&[x, y, z, _]: &[f32; 4]) -> [f64; 2] {
    let [x, y, z] = [x, y, z].map(|number| 2.0 * f64::from(number) - 1.0);
    [x, y].map(|side| (side / z.max(1e-9)).clamp(-STEEPEST, STEEPEST))
}
