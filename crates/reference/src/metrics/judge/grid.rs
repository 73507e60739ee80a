//! Pictures of adapters that put the corners of triangles on a grid within a pixel.

use super::divisor::judge_divided;
use super::{Bars, SizeMismatch, Verdict, judge};
use crate::{Image, Oracle, VertexGrid};

/// From so many bits on a grid is fine: the first rule has no wider bars. On a slope it may still move a value by more.
const FINE_BITS: u32 = 8;

/// Where corners are on the drawer's own grid, all that is left to move an edge is single precision; in pixels.
const RADIUS_ON_GRID: f64 = 1.0 / 64.0;

impl Bars {
    /// For a drawer that rounds vertices to a grid of N bits within a pixel. One of fewer than 8 moves what is
    /// interpolated by so much that on any slope all colours of the disc are right: by up to 1/32 pixel along each axis
    /// with 4 bits. How many pixels are equal then says nothing.
    #[must_use]
    pub fn on_grid(self, bits: u32) -> Self {
        if bits < FINE_BITS { Self { steep: 0.0, equal: 0.0, ..self } } else { self }
    }
}

/// [`judge`] for a drawer that rounds the corners of triangles to a grid of N bits within a pixel. The picture is
/// right as a whole by one of two rules: what the exact triangles show, with [`Bars::on_grid`]; or what `rounded`
/// shows with its corners [on the grid](Oracle::on_grid), with `bars` as they are and edges within 1/64 of a pixel.
/// By the second images seen from afar and slopes of triangles less than a pixel high are judged. Where corners lie
/// so near the middle between two places that single precision rounds them to either, all of those may also have
/// gone to one side along each axis ([`VertexGrid`]). With 8 bits or more the first rule is [`judge`].
///
/// # Errors
/// [`SizeMismatch`].
pub fn judge_on_grid(
    (oracle, expected): (&Oracle, &Image),
    (mut rounded, bits): (Oracle, u32),
    actual: &Image,
    bars: Bars,
) -> Result<Verdict, SizeMismatch> {
    let exact = judge(oracle, expected, actual, bars.on_grid(bits))?;
    if exact.is_within() {
        return Ok(exact);
    }
    for grid in VertexGrid::all(bits) {
        rounded = rounded.on_grid(grid);
        let possible = |x, y| rounded.possible(x, y, RADIUS_ON_GRID);
        let drawn = rounded.draw();
        let verdict = judge_divided(possible, rounded.samples(), (&drawn, None), actual, bars.until_wrong())?;
        if verdict.is_within() {
            // All has been asked then.
            let bars = Bars { until_wrong: bars.until_wrong, ..verdict.bars };
            return Ok(Verdict { bars, ..verdict });
        }
        if !rounded.has_ties(bits) {
            break;
        }
    }
    Ok(exact)
}
