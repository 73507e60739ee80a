//! The colours of a triangle within a small area of the picture.

use super::footprint::{Footprint, FootprintCorner, Zone};
use super::range::ColorRange;
use crate::oracle::raster::{Hit, HitPoint};
use crate::oracle::scene::OracleScene;
use crate::oracle::solid::Color;
use halfway_lighting::Frequency;

/// The colours of one side of a triangle near a point of the picture.
#[derive(Clone, Debug)]
pub(super) struct SideColors {
    pub(super) range: ColorRange,
    /// The least and the greatest opacity.
    pub(super) opacity: [f64; 2],
    /// Whether any colour of the range is right: they jump within the area, or the triangle's position is uncertain.
    pub(super) jumps: bool,
}

/// How often the segment between two points is halved to tell a jump from a slope: its ends are then 2⁻¹² as far apart.
const HALVINGS: u32 = 12;
/// If this share of the colour difference remains between the ends, it is a jump; of a slope a few thousandths remain.
const JUMP: f64 = 0.125;
/// The share of a square that a triangle may leave open and still counts as covering it.
const ROUNDING: f64 = 1e-9;

impl SideColors {
    /// The colours of a side within the last of some areas, or within the first of them if the triangle covers the
    /// last.
    ///
    /// They are sampled at the corners of the part of the triangle that lies within, and in its middle. Interpolated
    /// values are extreme at corners, and a jump along a straight line has corners on both sides. Colours curve in
    /// between by less than the judge's bars if the area is a small part of a pixel. If it is larger (a pixel of four
    /// samples, or a triangle seen edge-on), more points between are sampled, and a search starts from the extreme
    /// ones. The same search is used everywhere under images and solids, whose colours may rise and fall within any
    /// area.
    pub(super) fn new(scene: &OracleScene, footprint: &Footprint, front: bool, shading: &[&Zone]) -> Self {
        let (outline, cuts) = part(scene, footprint, shading);
        let points = points(&outline, cuts);
        let color = |corner: &FootprintCorner| color(scene, footprint, front, corner);
        let colors: Vec<Color> = points.iter().map(color).collect();
        let mut range = ColorRange::from_colors(colors.iter().copied());
        let solid = &scene.solids[footprint.solid];
        let is_textured = solid.maps.is_some() || solid.cut_from.is_some();
        let jumps = (solid.terms.has(Frequency::Fragment) || is_textured) && jumps(&points, &colors, &range, color)
            || shading.len() > 1 && is_in_parts(scene, footprint)
            || solid.is_uncertain(footprint.triangle);
        if cuts > 1 || is_textured {
            range = range.with(&sought(&outline, (&points, &colors), 0.5 / cuts as f64, color));
        }
        let opacity = extremes(&points, |corner| scene.opacity(&hit(footprint, front, corner)));
        Self { range, opacity, jumps }
    }
}

/// The part of a triangle in which it is shaded, and the number of parts that each segment from its middle to a corner
/// is cut into. On a fine grid it may cover a point [`BESIDE`] it, where unrounded slopes extrapolate.
fn part(scene: &OracleScene, footprint: &Footprint, shading: &[&Zone]) -> (Vec<FootprintCorner>, usize) {
    let beside = footprint.beside.max(BESIDE);
    let (mut outline, mut cuts) = match shading {
        [zone] => (footprint.reaching(scene, zone, beside), 1),
        [first, .., last] => {
            let whole = footprint.within(scene, last);
            let is_at_centre = covers(scene, &whole, last) && !is_in_parts(scene, footprint);
            if is_at_centre {
                (footprint.within(scene, first), 1)
            } else {
                (footprint.reaching(scene, last, beside), CUTS_OF_A_PIXEL)
            }
        }
        [] => (Vec::new(), 1),
    };
    if footprint.thin {
        // A renderer's slopes across it come from rounded corners alone, so all of its colours are right.
        (outline, cuts) = (widened(scene, &footprint.whole(scene)), CUTS_OF_A_TRIANGLE);
    } else if outline.is_empty() {
        (outline, cuts) = (footprint.outline.clone(), 1);
    }
    (outline, if curves(scene, footprint) { cuts } else { 1 })
}

/// Searches the least and the greatest value of each channel from the extreme points: toward whichever corner changes
/// it most, at first by a part `step` of the distance.
fn sought(
    corners: &[FootprintCorner],
    (points, colors): (&[FootprintCorner], &[Color]),
    step: f64,
    color: impl Fn(&FootprintCorner) -> Color,
) -> ColorRange {
    let mut range = ColorRange::from_colors([]);
    // Channels often have their extremes at one point.
    let mut begun: Vec<(usize, bool)> = Vec::new();
    for (channel, greatest) in (0..3).flat_map(|channel| [(channel, false), (channel, true)]) {
        let value = |color: &Color| if greatest { color[channel] } else { -color[channel] };
        let numbers = 0..points.len();
        let Some(first) = numbers.max_by(|a, b| value(&colors[*a]).total_cmp(&value(&colors[*b]))) else { break };
        let is_flat = colors.iter().all(|color| color[channel].to_bits() == colors[0][channel].to_bits());
        if is_flat || begun.contains(&(first, greatest)) {
            continue;
        }
        begun.push((first, greatest));
        let (mut place, mut most, mut step) = (points[first], value(&colors[first]), step);
        for _ in 0..TRIALS {
            let beside = corners.iter().map(|corner| place.between(corner, step)).map(|there| (there, color(&there)));
            let beside: Vec<_> = beside.collect();
            range = range.with(&ColorRange::from_colors(beside.iter().map(|(_, color)| *color)));
            match beside.into_iter().max_by(|a, b| value(&a.1).total_cmp(&value(&b.1))) {
                Some((there, color)) if value(&color) > most => (place, most) = (there, value(&color)),
                _ => step *= 0.5,
            }
        }
    }
    range
}

/// The number of steps of a search. If every second one succeeds, the extreme is then known to a sixteenth of the
/// difference between the points.
const TRIALS: u32 = 8;

/// A thin triangle, extended as far as a fine grid may move it. A renderer that takes its slopes from unrounded
/// vertices extrapolates its colours that far.
fn widened(scene: &OracleScene, corners: &[FootprintCorner]) -> Vec<FootprintCorner> {
    let pixels: Vec<_> = corners.iter().map(|corner| scene.view.pixel(corner.p)).collect();
    let ends = || (0..pixels.len()).map(|i| (pixels[i], pixels[(i + 1) % pixels.len()]));
    let twice_area: f64 = ends().map(|(a, b)| (a - pixels[0]).perp_dot(b - pixels[0])).sum();
    let longest = ends().map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
    // The longest side lies a third of the height from the middle.
    let third_of_height = twice_area.abs() / (3.0 * longest);
    let middle = middle(corners);
    let factor = 1.0 + (BESIDE / third_of_height).min(MOST_BESIDE);
    corners.iter().map(|corner| middle.between(corner, factor)).collect()
}

/// How far a grid of 1/256 pixel moves vertices, in pixels: half of a step along each axis. The colours of a triangle
/// may extend that far beside it.
const BESIDE: f64 = std::f64::consts::SQRT_2 / 512.0;
/// The most that a triangle is extended, as a share of the distance from its middle: beyond that, slopes are taken from
/// rounded vertices.
const MOST_BESIDE: f64 = 0.5;

/// Whether a renderer draws a triangle in parts, since the near plane or the far one leaves a quadrangle of it. With four samples a
/// pixel on the seam is shaded in both parts, where the samples lie that each covers.
fn is_in_parts(scene: &OracleScene, footprint: &Footprint) -> bool {
    scene.solids[footprint.solid].triangle(footprint.triangle).iter().any(|corner| !scene.view.shows(-corner.z))
}

/// Whether the colours of a triangle are more than linear in its corners'.
fn curves(scene: &OracleScene, footprint: &Footprint) -> bool {
    let solid = &scene.solids[footprint.solid];
    let is_textured = solid.maps.is_some() || solid.cut_from.is_some();
    solid.terms.has(Frequency::Fragment) || is_textured || scene.environment.is_some()
}

/// The number of parts that each segment from the middle to a corner is cut into, for an area of about a pixel and for
/// a whole triangle. A mirrored environment curves by up to 2 % of a picture's range within a pixel: cut in half, by a
/// quarter of that.
const CUTS_OF_A_PIXEL: usize = 4;
const CUTS_OF_A_TRIANGLE: usize = 8;

/// The corners of an outline, its middle, and points between: each triangle of the middle and a side has `cuts` rows of
/// them.
fn points(outline: &[FootprintCorner], cuts: usize) -> Vec<FootprintCorner> {
    let middle = middle(outline);
    let mut points = outline.to_vec();
    points.push(middle);
    for (i, from) in outline.iter().enumerate() {
        let to = &outline[(i + 1) % outline.len()];
        for row in 1..=cuts {
            for column in (0..row).filter(|column| row < cuts || *column > 0) {
                let on_side = from.between(to, column as f64 / row as f64);
                points.push(middle.between(&on_side, row as f64 / cuts as f64));
            }
        }
    }
    points
}

/// Whether a mask may cut the triangle away at a nearby point, and whether it may keep it.
pub(super) fn cuts(scene: &OracleScene, footprint: &Footprint, shading: &[&Zone]) -> [bool; 2] {
    let Some(cutoff) = scene.solids[footprint.solid].mask else { return [false, true] };
    let (outline, cuts) = part(scene, footprint, shading);
    let outline = points(&outline, cuts);
    let there = |corner: &FootprintCorner| scene.surface_opacity(&hit(footprint, footprint.front, corner));
    let [least, greatest] = extremes(&outline, there);
    [least < cutoff + CUT, greatest >= cutoff - CUT]
}

/// Opacities this near to a cutoff may be on either side of it: more than the error of filters in f32, some 10⁻⁵.
const CUT: f64 = 5e-5;

fn extremes(outline: &[FootprintCorner], number: impl Fn(&FootprintCorner) -> f64) -> [f64; 2] {
    let numbers = || outline.iter().map(&number);
    [numbers().fold(f64::INFINITY, f64::min), numbers().fold(0.0, f64::max)]
}

fn color(scene: &OracleScene, footprint: &Footprint, front: bool, corner: &FootprintCorner) -> Color {
    scene.value(&hit(footprint, front, corner))
}

fn hit(footprint: &Footprint, front: bool, corner: &FootprintCorner) -> Hit {
    let place = HitPoint::Triangle(footprint.triangle, corner.weights);
    Hit { solid: footprint.solid, depth: corner.depth(), front, place }
}

fn middle(outline: &[FootprintCorner]) -> FootprintCorner {
    let share = 1.0 / outline.len() as f64;
    let weights = std::array::from_fn(|i| share * outline.iter().map(|corner| corner.weights[i]).sum::<f64>());
    FootprintCorner { p: share * outline.iter().map(|corner| corner.p).sum::<bevy_math::DVec3>(), weights }
}

/// Whether an outline fills the square of a zone.
fn covers(scene: &OracleScene, outline: &[FootprintCorner], zone: &Zone) -> bool {
    let [low, high] = zone.bounds();
    let pixels: Vec<_> = outline.iter().map(|corner| scene.view.pixel(corner.p) - low).collect();
    let twice_area: f64 = (0..pixels.len()).map(|i| pixels[i].perp_dot(pixels[(i + 1) % pixels.len()])).sum();
    let square = (high - low).x * (high - low).y;
    0.5 * twice_area.abs() >= (1.0 - ROUNDING) * square
}

/// Whether the colour jumps between the two points that differ most.
fn jumps(
    outline: &[FootprintCorner],
    colors: &[Color],
    range: &ColorRange,
    color: impl Fn(&FootprintCorner) -> Color,
) -> bool {
    let span = |k: &usize| range.high[*k] - range.low[*k];
    let channel = [0, 1, 2].into_iter().max_by(|a, b| span(a).total_cmp(&span(b))).unwrap_or(0);
    let whole = span(&channel);
    let by_channel = |a: &&usize, b: &&usize| colors[**a][channel].total_cmp(&colors[**b][channel]);
    let numbers: Vec<usize> = (0..outline.len()).collect();
    let (Some(low), Some(high)) = (numbers.iter().min_by(by_channel), numbers.iter().max_by(by_channel)) else {
        return false;
    };
    let [mut low, mut high] = [*low, *high].map(|number| (outline[number], colors[number][channel]));
    for _ in 0..HALVINGS {
        let between = low.0.between(&high.0, 0.5);
        let value = color(&between)[channel];
        let half = (between, value);
        if high.1 - value > value - low.1 { low = half } else { high = half }
    }
    whole > 0.0 && high.1 - low.1 > JUMP * whole
}
