//! Lines and discs, each with its colours, laid over a picture in the order of their depth.

use crate::lines::disc::Disc;
use crate::lines::drawing::{Drawing, Placed, Sight, is_dash};
use crate::lines::mix::lay_over;
use crate::lines::segment::{Reached, Segment, pixels};
use crate::picture::Picture;
use bevy_math::{DVec2, UVec2, Vec3, Vec4};
use halfway_lighting::{Encoding, HiddenEdges};
use rayon::prelude::*;
use std::ops::Range;

/// A line or a disc on the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    shape: Shape,
    hidden: Hidden,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    Line {
        segment: Segment,
        /// Of its ends; see [`Lens::unfitted_nearness`](halfway_lighting::Lens::unfitted_nearness).
        nearness: [f64; 2],
        inks: [Ink; 2],
        /// The length of the path before it, in pixels, for dashes.
        before: f64,
    },
    Disc {
        disc: Disc,
        depth: f64,
        ink: Ink,
    },
}

/// The part of a mark that lies behind surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hidden {
    Omit,
    Dash,
    Show,
}

impl From<HiddenEdges> for Hidden {
    fn from(hidden: HiddenEdges) -> Self {
        match hidden {
            HiddenEdges::Omit => Self::Omit,
            HiddenEdges::Dash => Self::Dash,
        }
    }
}

/// A colour, linear RGB, and its opacity.
pub(super) type Ink = Vec4;

impl Mark {
    /// A line between two points of eye space.
    pub(super) fn line(placed: &Placed, widths: [f64; 2], inks: [Ink; 2], hidden: Hidden) -> Self {
        let segment = Segment { from: placed.ends[0], to: placed.ends[1], widths };
        let inks = placed.shares.map(|share| inks[0].lerp(inks[1], share as f32));
        Self { shape: Shape::Line { segment, nearness: placed.nearness, inks, before: 0.0 }, hidden }
    }

    /// The same line as a part of a path that is this long before it, in pixels.
    pub(super) fn after(mut self, length: f64) -> Self {
        if let Shape::Line { before, .. } = &mut self.shape {
            *before = length;
        }
        self
    }

    pub(super) fn disc(middle: DVec2, diameter: f64, depth: f64, ink: Ink) -> Self {
        let disc = Disc { middle, radius: 0.5 * diameter };
        Self { shape: Shape::Disc { disc, depth, ink }, hidden: Hidden::Omit }
    }

    /// The rows that it may reach.
    fn rows(&self, size: UVec2) -> Range<u32> {
        match self.shape {
            Shape::Line { segment, .. } => segment.rows(size.y),
            Shape::Disc { disc: Disc { middle, radius }, .. } => {
                pixels(middle.y - radius - 1.0, middle.y + radius + 1.0, &(0..size.y))
            }
        }
    }

    /// About how many pixels it reaches.
    fn pixels(&self, size: UVec2) -> u64 {
        let across = |length: f64, most: u32| length.min(f64::from(most)) as u64 + 2;
        match self.shape {
            Shape::Line { segment: Segment { from, to, widths }, .. } => {
                across((to - from).length(), size.x + size.y) * across(widths[0].max(widths[1]), size.x)
            }
            Shape::Disc { disc, .. } => across(2.0 * disc.radius, size.x) * across(2.0 * disc.radius, size.y),
        }
    }

    /// The share of each pixel of these rows in which it is seen.
    fn each(&self, sight: &Sight, rows: &Range<u32>, mut reach: impl FnMut(u32, u32, Fragment)) {
        let (drawing, width) = (sight.drawing, sight.drawing.size().x);
        match self.shape {
            Shape::Line { segment, nearness, inks, before } => {
                let length = (segment.to - segment.from).length();
                let is_parallel = drawing.lens().is_parallel;
                segment.each(width, rows, |Reached { x, y, coverage, along }| {
                    let near = nearness[0] + along * (nearness[1] - nearness[0]);
                    let depth = drawing.lens().depth_at(near);
                    let at = segment.from.lerp(segment.to, along);
                    let half = 0.5 * (segment.widths[0] + along * (segment.widths[1] - segment.widths[0]));
                    let sees = || sight.sees(at, depth, None);
                    let shows = match self.hidden {
                        Hidden::Show => true,
                        Hidden::Omit => sight.shows(sees, (at, half), depth, [x, y]),
                        Hidden::Dash => {
                            is_dash(before + along * length) || sight.shows(sees, (at, half), depth, [x, y])
                        }
                    };
                    if shows {
                        // Where on the line itself the point is that is seen there.
                        let share = if is_parallel { along } else { along * nearness[1] / near };
                        let ink = inks[0].lerp(inks[1], share as f32);
                        reach(x, y, Fragment::new(ink, coverage, depth, false));
                    }
                });
            }
            Shape::Disc { disc, depth, ink } => {
                let mut seen = None;
                disc.each(width, rows, |x, y, coverage| {
                    let sees = || *seen.get_or_insert_with(|| sight.sees(disc.middle, depth, None));
                    if sight.shows(sees, (disc.middle, disc.radius), depth, [x, y]) {
                        reach(x, y, Fragment::new(ink, coverage, depth, true));
                    }
                });
            }
        }
    }
}

/// The part of a mark in one pixel.
#[derive(Clone, Copy, Debug)]
struct Fragment {
    color: Vec3,
    /// Coverage · opacity.
    share: f32,
    depth: f64,
    /// Whether it covers a part of the pixel that does not depend on what others cover; lines that meet overlap.
    alone: bool,
}

impl Fragment {
    fn new(ink: Ink, coverage: f64, depth: f64, alone: bool) -> Self {
        Self { color: ink.truncate(), share: coverage as f32 * ink.w, depth, alone }
    }

    /// Lays it over what lies farther away: a colour and how much of the pixel it takes.
    fn over(&self, (color, share): (Vec3, f32)) -> (Vec3, f32) {
        let behind = if self.alone { share * (1.0 - self.share) } else { (share - self.share).max(0.0) };
        let sum = self.share + behind;
        (if sum > 0.0 { (self.color * self.share + color * behind) / sum } else { color }, sum)
    }
}

/// The most fragments that a thread keeps at a time, but for those of one row.
const MOST_FRAGMENTS: u64 = 1 << 20;

/// The least bands of rows that are drawn at once.
const LEAST_BANDS: u64 = 32;

/// Lays marks over a picture. Nearer ones cover farther ones; of equally near ones the later one covers the earlier.
pub(super) fn draw(picture: &mut Picture, drawing: &Drawing, marks: &[Mark], encoding: Encoding) {
    if marks.is_empty() {
        return;
    }
    let size = drawing.size();
    let fragments: u64 = marks.iter().map(|mark| mark.pixels(size)).sum();
    let bands = (fragments / MOST_FRAGMENTS + LEAST_BANDS).min(size.y.into()) as u32;
    let height = size.y.div_ceil(bands);
    let mut of_bands = vec![Vec::new(); bands as usize];
    for mark in marks {
        let Range { start, end } = mark.rows(size);
        for band in start / height..end.div_ceil(height) {
            of_bands[band as usize].push(*mark);
        }
    }
    let mut inks = vec![(Vec3::ZERO, 0.0_f32); size.element_product() as usize];
    let in_bands = inks.par_chunks_mut((height * size.x) as usize).zip(&of_bands).enumerate();
    in_bands.with_min_len(bands.div_ceil(4 * rayon::current_num_threads() as u32) as usize).for_each_init(
        || (Sight::new(drawing), Vec::new()),
        |(sight, reached), (band, (inks, marks))| {
            let first = band as u32 * height;
            let rows = first..first + inks.len() as u32 / size.x;
            reached.clear();
            for mark in marks {
                mark.each(sight, &rows, |x, y, fragment| reached.push(((y - first) * size.x + x, fragment)));
            }
            // Stable: of equally near ones the later one stays the later.
            reached.sort_by(|(a, one), (b, other)| a.cmp(b).then(other.depth.total_cmp(&one.depth)));
            for (pixel, fragment) in &*reached {
                let ink = &mut inks[*pixel as usize];
                *ink = fragment.over(*ink);
            }
        },
    );
    lay_over(picture, encoding, inks.into_iter().map(|(color, share)| (color.to_array(), share)));
}
