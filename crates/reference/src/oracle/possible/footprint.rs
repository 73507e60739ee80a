//! The part of a triangle that lies within a small area of the picture.

use bevy_math::{DVec2, DVec3};
use halfway_lighting::Frequency;

use crate::oracle::raster::{Primitive, RayTriangle};
use crate::oracle::scene::OracleScene;
use crate::oracle::solid::Solid;
use crate::oracle::view::PictureView;

/// A small convex area of the picture, in pixels.
pub(super) struct Zone {
    centre: DVec2,
    /// Unit vectors across its sides, outward.
    sides: Vec<DVec2>,
    /// How far each side is from the centre.
    reach: f64,
    /// Whether the area is the disc within the sides, and not all that lies within them.
    round: bool,
}

/// The sides of the polygon around a disc. Each of its corners lies 2 % of the radius outside, so that the corners are
/// on both sides of any straight line that cuts the disc.
const SIDES: u32 = 16;

/// 0, 22.5, 45 and 67.5 degrees as cosine and sine, to the nearest f64.
const ANGLES: [[f64; 2]; 4] = [
    [1.0, 0.0],
    [0.923_879_532_511_286_7, 0.382_683_432_365_089_8],
    [std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2],
    [0.382_683_432_365_089_8, 0.923_879_532_511_286_7],
];

impl Zone {
    /// The disc around a point.
    pub(super) fn disc(centre: DVec2, radius: f64) -> Self {
        let side = |i: u32| {
            let quarter = DVec2::from_array(ANGLES[i as usize % ANGLES.len()]);
            (0..i / ANGLES.len() as u32).fold(quarter, |turned, _| turned.perp())
        };
        Self { centre, sides: (0..SIDES).map(side).collect(), reach: radius, round: true }
    }

    /// The square around a point, its sides `2·half` long.
    pub(super) fn square(centre: DVec2, half: f64) -> Self {
        let sides = vec![DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
        Self { centre, sides, reach: half, round: false }
    }

    /// The corners of a box that holds the area.
    pub(super) fn bounds(&self) -> [DVec2; 2] {
        [self.centre - self.reach, self.centre + self.reach]
    }

    /// How far a point before the eye lies beyond a side, in pixels, times its w: linear in space, so that an edge is cut
    /// there without a division by numbers near 0.
    fn beyond(&self, view: &PictureView, side: DVec2, p: DVec3) -> f64 {
        view.pixel_by_w(p, self.centre).dot(side) - self.reach * view.w(p)
    }

    /// Whether an outline that is clipped to the sides reaches the area.
    fn meets(&self, view: &PictureView, outline: &[FootprintCorner]) -> bool {
        !outline.is_empty() && (!self.round || distance(view, outline, self.centre) <= self.reach)
    }
}

/// A corner of a part of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct FootprintCorner {
    pub(super) p: DVec3,
    /// The weights of the triangle's corners.
    pub(super) weights: [f64; 3],
}

impl FootprintCorner {
    pub(super) fn between(&self, other: &Self, share: f64) -> Self {
        let weights = std::array::from_fn(|i| self.weights[i] + share * (other.weights[i] - self.weights[i]));
        Self { p: self.p + share * (other.p - self.p), weights }
    }

    pub(super) fn depth(&self) -> f64 {
        -self.p.z
    }
}

/// The offset from the disc's centre to the point where coverage is tested, in pixels: right and then down, by the
/// top-left rule. Snapped vertices may lie exactly at the centre, where rounding would decide each edge on its own.
const AT_CENTRE: DVec2 = DVec2::new(1e-9, 1e-10);

/// A triangle within a disc around a point of the picture.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub(super) struct Footprint {
    pub(super) solid: usize,
    pub(super) triangle: u32,
    /// Whether the front is visible.
    pub(super) front: bool,
    /// Whether it winds counter-clockwise as seen.
    pub(super) counter_clockwise: bool,
    /// Whether it covers the disc's centre: exactly one of two triangles that share an edge does.
    pub(super) at_centre: bool,
    /// So thin that vertices moved by the disc's radius may turn it over.
    pub(super) thin: bool,
    /// The part within the polygon around the disc.
    pub(super) outline: Vec<FootprintCorner>,
    /// The least and the greatest nearness within the disc, widened by rounding errors: 1/depth in a perspective, else
    /// −depth.
    pub(super) nearness: [f64; 2],
    /// The triangle's corners, for comparison: of equal ones the bits are equal.
    pub(super) corners: [[u64; 3]; 3],
    /// Which edges cross the disc; edge i leads from corner i to the next.
    pub(super) edges: [bool; 3],
    /// Whether the near plane or the far one cuts it within the disc.
    pub(super) cut: bool,
    /// The distance outside its outline up to which a renderer may draw it, in pixels.
    pub(super) beside: f64,
}

impl Footprint {
    /// The part of a triangle within the disc `zone`, whichever side faces the eye and whether or not that side is
    /// drawn; `None` if it is empty. A renderer may extend it by `beside` pixels.
    pub(super) fn new(scene: &OracleScene, primitive: &Primitive, zone: &Zone, beside: f64) -> Option<Self> {
        let (view, solid) = (&scene.view, &scene.solids[primitive.solid]);
        let corners = solid.triangle(primitive.index);
        let outline = clipped(view, &whole(corners), zone);
        if !zone.meets(view, &outline) {
            return None;
        }
        let [a, b, c] = corners;
        let counter_clockwise = (b - a).cross(c - a).dot(view.sight(a)) < 0.0;
        let DVec2 { x, y } = zone.centre + AT_CENTRE;
        let met = RayTriangle::new(view, corners).intersect(view.at(x, y)).filter(|met| view.shows(met.depth));
        let edge = |i: usize| {
            let ends = [whole(corners)[i], whole(corners)[(i + 1) % 3]];
            zone.meets(view, &clipped(view, &ends, zone))
        };
        let is_cut = |corner: &FootprintCorner| view.is_cut_at(corner.depth());
        Some(Self {
            solid: primitive.solid,
            triangle: primitive.index,
            front: counter_clockwise != solid.mirrored,
            counter_clockwise,
            at_centre: met.is_some(),
            thin: is_thin(view, corners, zone.reach),
            nearness: nearness(scene, solid, primitive.index, &outline),
            corners: corners.map(|p| p.to_array().map(|x| (x + 0.0).to_bits())),
            edges: [0, 1, 2].map(edge),
            cut: outline.iter().any(is_cut),
            beside,
            outline,
        })
    }

    /// The part within another area around the same point, to be shaded there.
    pub(super) fn within(&self, scene: &OracleScene, zone: &Zone) -> Vec<FootprintCorner> {
        clipped(&scene.view, &self.whole(scene), zone)
    }

    /// The same for the triangle extended in its plane by `reach` pixels.
    pub(super) fn reaching(&self, scene: &OracleScene, zone: &Zone, reach: f64) -> Vec<FootprintCorner> {
        let whole = whole(scene.solids[self.solid].triangle(self.triangle));
        clipped(&scene.view, &grown(&scene.view, &whole, reach).unwrap_or(whole), zone)
    }

    /// The whole triangle.
    pub(super) fn whole(&self, scene: &OracleScene) -> Vec<FootprintCorner> {
        whole(scene.solids[self.solid].triangle(self.triangle)).to_vec()
    }

    /// Whether two of them are the same triangle of space, drawn twice, so that their depths are equal to the bit.
    pub(super) fn coincides(&self, other: &Self, scene: &OracleScene) -> bool {
        let place = |it: &Self| {
            let solid = &scene.solids[it.solid];
            // For flat shading corners may come in another order, which rounds depths within the triangle otherwise.
            (solid.eye_from_model, solid.terms.has(Frequency::Triangle))
        };
        self.corners == other.corners && place(self) == place(other)
    }
}

fn whole(corners: [DVec3; 3]) -> [FootprintCorner; 3] {
    let mut number = 0;
    corners.map(|p| {
        let mut weights = [0.0; 3];
        weights[number] = 1.0;
        number += 1;
        FootprintCorner { p, weights }
    })
}

/// A triangle whose sides are moved outward on the picture by a number of pixels; `None` where it comes before the near
/// plane or beyond the far one, or where its plane would go on behind the eye.
fn grown(view: &PictureView, corners: &[FootprintCorner; 3], by: f64) -> Option<[FootprintCorner; 3]> {
    if corners.iter().any(|corner| !view.shows(corner.depth())) {
        return None;
    }
    let pixels = corners.map(|corner| view.pixel(corner.p));
    let twice_area = (pixels[1] - pixels[0]).perp_dot(pixels[2] - pixels[0]).abs();
    // How far a side moves, of its distance from the corner that faces it.
    let shares = [0, 1, 2].map(|i| by * pixels[(i + 1) % 3].distance(pixels[(i + 2) % 3]) / twice_area);
    let moved = [0, 1, 2].map(|i| {
        let on_picture = |k: usize| if k == i { 1.0 + shares[(i + 1) % 3] + shares[(i + 2) % 3] } else { -shares[k] };
        // A function linear on the picture is linear in space after division by w.
        let by_w = [0, 1, 2].map(|k| on_picture(k) / view.w(corners[k].p));
        let sum: f64 = by_w.iter().sum();
        let weights = by_w.map(|weight| weight / sum);
        let p = weights.iter().zip(corners).map(|(weight, corner)| *weight * corner.p).sum();
        (sum > 0.0).then_some(FootprintCorner { p, weights })
    });
    let [a, b, c] = moved;
    Some([a?, b?, c?])
}

/// The part of a convex outline between the near and the far plane and inside the sides of a zone (Sutherland and Hodgman 1974).
fn clipped(view: &PictureView, outline: &[FootprintCorner], zone: &Zone) -> Vec<FootprintCorner> {
    let mut rest = cut(outline, |corner| view.near() - corner.depth());
    if view.far().is_finite() {
        rest = cut(&rest, |corner| corner.depth() - view.far());
    }
    for side in &zone.sides {
        if rest.is_empty() {
            break;
        }
        rest = cut(&rest, |corner| zone.beyond(view, *side, corner.p));
    }
    rest
}

/// The part of a convex outline where `beyond`, linear in space, is at most 0.
fn cut(outline: &[FootprintCorner], beyond: impl Fn(&FootprintCorner) -> f64) -> Vec<FootprintCorner> {
    let mut rest = Vec::with_capacity(outline.len() + 1);
    for (i, from) in outline.iter().enumerate() {
        let to = &outline[(i + 1) % outline.len()];
        let (here, there) = (beyond(from), beyond(to));
        if here <= 0.0 {
            rest.push(*from);
        }
        if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
            rest.push(from.between(to, here / (here - there)));
        }
    }
    rest
}

/// How far a point of the picture lies outside a convex outline, or a line, in pixels.
fn distance(view: &PictureView, outline: &[FootprintCorner], point: DVec2) -> f64 {
    let pixels: Vec<DVec2> = outline.iter().map(|corner| view.pixel(corner.p) - point).collect();
    let edges = || (0..pixels.len()).map(|i| (pixels[i], pixels[(i + 1) % pixels.len()]));
    let turns = |sign: f64| edges().all(|(a, b)| sign * a.perp_dot(b) > 0.0);
    if turns(1.0) || turns(-1.0) {
        return 0.0;
    }
    let to_edge = |(a, b): (DVec2, DVec2)| {
        let along = b - a;
        let share = (-a.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        // An edge seen end on is its first corner.
        if share.is_nan() { a.length() } else { (a + share * along).length() }
    };
    edges().map(to_edge).fold(f64::INFINITY, f64::min)
}

/// Whether the height of a triangle on the picture is at most twice `reach`.
fn is_thin(view: &PictureView, corners: [DVec3; 3], reach: f64) -> bool {
    if corners.iter().any(|corner| !view.shows(-corner.z)) {
        return false;
    }
    let [a, b, c] = corners.map(|corner| view.pixel(corner));
    let longest = [(a, b), (b, c), (c, a)].map(|(from, to)| from.distance(to)).into_iter().fold(0.0, f64::max);
    (b - a).perp_dot(c - a).abs() <= 2.0 * reach * longest
}

/// A depth buffer in f32 holds near/depth, or what is linear in the depth. A renderer knows it, of a triangle, to a few
/// roundings of the greatest one on it, from which it interpolates.
const ROUNDINGS: f64 = 4.0 * f32::EPSILON as f64;

/// The least and the greatest nearness of an outline, widened by the roundings of f32: those of the vertices, whose
/// depths are sums of larger terms, and those of the interpolation between them.
fn nearness(scene: &OracleScene, solid: &Solid, triangle: u32, outline: &[FootprintCorner]) -> [f64; 2] {
    let view = &scene.view;
    let all = || outline.iter().map(|corner| view.nearness(corner.depth()));
    let z = solid.eye_from_model.matrix3.row(2).abs();
    let rounding = solid.vertices(triangle).map(|vertex| {
        let position = solid.mesh.positions()[vertex].as_dvec3();
        let terms = z.dot(position.abs()) + solid.eye_from_model.translation.z.abs();
        ROUNDINGS * view.nearness_error(-solid.corners[vertex].z, terms, scene.depth_span)
    });
    let rounding = rounding.into_iter().fold(0.0, f64::max);
    [all().fold(f64::INFINITY, f64::min) - rounding, all().fold(f64::NEG_INFINITY, f64::max) + rounding]
}
