//! The colours that a pixel may show in a renderer that rounds vertex positions.
//!
//! `footprint` finds the triangles near a sampling point, `covering` those that certainly cover it, `values` the
//! colours of each, and `stack` blends them.

mod covering;
mod footprint;
mod range;
mod stack;
mod values;

use bevy_math::DVec2;
use halfway_lighting::Samples;

use super::Oracle;
use super::grid::VertexGrid;
use footprint::{Footprint, Zone};
use stack::Stack;

pub use range::{ColorRange, Possible};

/// Where the four samples of a pixel lie, from its top left corner (WebGPU, "multisample state"; Vulkan, "standard
/// sample locations").
pub(super) const FOUR: [[f64; 2]; 4] = [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]];

/// The most combinations of the samples' colours; more are merged into one range.
const MOST_RANGES: usize = 4096;

impl Oracle {
    /// The colours that the pixel in column `x` of row `y` may show, drawn by a renderer that moves each vertex by at
    /// most `radius` pixels, coincident vertices together: all that a sampling point displaced by that much could hit.
    /// The radius is below 1/8. Near triangles with a corner that may snap to either of two points of the
    /// [grid](Self::on_grid) it is the step of the grid, if that is more. For triangles that reach beyond the picture
    /// this holds for their coverage and not for their colours: a renderer may clip them at the sides of the picture,
    /// and snap the new corners to the grid.
    ///
    /// - A triangle may be visible if it reaches the disc of that radius, unless a surface certainly hides it: one that
    ///   covers the disc's centre, has neither a border nor a silhouette within the disc, and whose farthest point in
    ///   the disc is nearer than the triangle's nearest one.
    /// - Depths are equal if they differ by no more than four roundings of f32 of the nearest depth on the triangle,
    ///   from which a renderer interpolates, and of the terms of its vertices' depths. Of two opaque objects with
    ///   equal meshes and the same transform, both flat or neither, the one that was spawned first is seen.
    /// - Blended surfaces are composed in every combination, in drawing order.
    /// - Where the camera takes four samples a pixel, each of them has a disc of its own. A triangle is shaded once,
    ///   anywhere in the part of the pixel that it covers, or at the centre if it covers the pixel.
    ///
    /// The camera's [`Intensity`](halfway_lighting::Intensity) has been applied, except for a divisor.
    ///
    /// For [`Mode::Mesh`](super::Mode::Mesh). Surfaces that are drawn by their formula are not supported here.
    pub fn possible(&self, x: u32, y: u32, radius: f64) -> Possible {
        let policy = self.policy();
        // The curves are monotonic, so that they map the ends of a range to its ends.
        self.drawn_there(x, y, radius).mapped(|channel| policy.toned(channel))
    }

    fn drawn_there(&self, x: u32, y: u32, radius: f64) -> Possible {
        let corner = DVec2::new(f64::from(x), f64::from(y));
        let centre = corner + 0.5;
        let radius =
            if self.is_uncertain(corner) { self.grid.map_or(radius, |grid| radius.max(grid.step())) } else { radius };
        // The background, too, is shaded once a pixel.
        let behind = self.scene.behind(self.scene.view.direction(centre.x, centre.y));
        match self.samples() {
            Samples::One => {
                let shading = [&Zone::disc(centre, radius)];
                self.stack(centre, radius, &shading).possible(&self.scene, behind, self.clamps())
            }
            Samples::Four | Samples::Sixteen | Samples::SixtyFour => {
                let shading = [&Zone::disc(centre, radius), &Zone::square(centre, 0.5 + radius)];
                let at = |at: DVec2| self.stack(at, radius, &shading).possible(&self.scene, behind, self.clamps());
                let samples = FOUR.map(|sample| at(corner + DVec2::from_array(sample)));
                // The oracle's own picture shows the centre, where something may lie that no sample hits.
                let centre = at(centre);
                let is_edge = centre.is_edge || centre.ranges != samples[0].ranges;
                let possible = mean(&samples);
                Possible { is_edge: possible.is_edge || is_edge, ..possible }
            }
        }
    }

    /// Whether a triangle with an uncertain corner lies near a pixel.
    fn is_uncertain(&self, corner: DVec2) -> bool {
        let Some(grid) = self.grid else { return false };
        let near = self.tiles().within(corner - grid.step(), corner + 1.0 + grid.step());
        near.into_iter().any(|primitive| self.scene.solids[primitive.solid].is_uncertain(primitive.index))
    }

    fn stack(&self, at: DVec2, radius: f64, shading: &[&Zone]) -> Stack {
        let step = self.grid.map_or(0.0, VertexGrid::step);
        let [disc, wide] = [radius, radius.max(step)].map(|radius| Zone::disc(at, radius));
        let [low, high] = wide.bounds();
        let footprints = self.tiles().within(low, high).into_iter().filter_map(|primitive| {
            let (zone, beside) = if self.scene.reaches_beyond(primitive) { (&wide, step) } else { (&disc, 0.0) };
            Footprint::new(&self.scene, primitive, zone, beside)
        });
        Stack::new(&self.scene, footprints.collect(), shading)
    }
}

/// The means of all combinations of the samples' colours.
fn mean(samples: &[Possible; 4]) -> Possible {
    let mut sums = vec![ColorRange { low: [0.0; 3], high: [0.0; 3] }];
    for sample in samples {
        let more: Vec<ColorRange> = if sums.len() * sample.ranges.len() > MOST_RANGES {
            let all = |ranges: &[ColorRange]| ranges.iter().copied().reduce(|a, b| a.with(&b));
            all(&sums).zip(all(&sample.ranges)).map(|(a, b)| add_quarter(&a, &b)).into_iter().collect()
        } else {
            sums.iter().flat_map(|sum| sample.ranges.iter().map(move |range| add_quarter(sum, range))).collect()
        };
        sums.clear();
        for sum in more {
            if !sums.contains(&sum) {
                sums.push(sum);
            }
        }
    }
    let is_edge = samples.iter().any(|sample| sample.is_edge || sample.ranges != samples[0].ranges);
    Possible { is_edge, ranges: sums, layers: samples.iter().map(|sample| sample.layers).max().unwrap_or(0) }
}

fn add_quarter(sum: &ColorRange, range: &ColorRange) -> ColorRange {
    sum.through(range, |sum, part| sum + 0.25 * part)
}
