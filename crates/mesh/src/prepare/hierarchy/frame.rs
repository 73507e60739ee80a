//! A coarse triangle from which a fine surface is seen.

use bevy_math::{DVec2, DVec3, Vec3A, Vec4};

use crate::prepare::nearest::TriangleCorners;

/// Further off than this part of a triangle's longest edge nothing is looked for over it.
const REACH: f64 = 0.25;

/// From a triangle that makes no more than this with the surface around it, as a cosine, it is looked along its own
/// normal.
const LEAST_COSINE: f64 = 0.1;

/// A coarse triangle, and where points are over it: along the mean normal of the surface around its corners, which
/// noise turns less than the triangle itself.
pub(super) struct Frame {
    pub(super) origin: DVec3,
    /// What the weights of its second and third corner grow by, and the height over it.
    pub(super) axes: [DVec3; 3],
    /// Along which heights are, of unit length.
    upward: DVec3,
    /// At the first corner, and what is added towards the second and the third.
    normals: [DVec3; 3],
    /// Of unit length.
    pub(super) mean_normal: DVec3,
    pub(super) reach: f64,
    pub(super) quick: QuickFrame,
}

impl Frame {
    /// Of a triangle with these normals, on a surface that faces `outward`, of any length. `None` where the triangle
    /// has no area to speak of.
    pub(super) fn new([a, b, c]: TriangleCorners, [na, nb, nc]: [DVec3; 3], outward: DVec3) -> Option<Self> {
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let longest = longest_edge([a, b, c]);
        if normal.length() <= 1e-9 * longest * longest {
            return None;
        }
        let mean_normal = (na + nb + nc).normalize_or_zero();
        let own = normal.normalize();
        let outward = outward.normalize_or_zero();
        let upward = if own.dot(outward) > LEAST_COSINE { outward } else { own };
        let volume = normal.dot(upward);
        let axes = [ac.cross(upward) / volume, upward.cross(ab) / volume, normal / volume];
        let (normals, reach) = ([na, nb - na, nc - na], REACH * longest);
        Some(Self { origin: a, axes, upward, normals, mean_normal, reach, quick: QuickFrame::new(a, axes, reach) })
    }

    /// The interpolated normal, not of unit length; beside the triangle it goes on as it is over it.
    pub(super) fn normal(&self, at: DVec2) -> DVec3 {
        self.normals[0] + at.x * self.normals[1] + at.y * self.normals[2]
    }
}

pub(super) fn longest_edge([a, b, c]: TriangleCorners) -> f64 {
    a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a)).sqrt()
}

/// The box around a coarse triangle and what lies over it within its reach.
pub(super) fn reached([a, b, c]: TriangleCorners, frame: &Frame) -> [DVec3; 2] {
    let reach = frame.reach * frame.upward.abs();
    [a.min(b).min(c) - reach, a.max(b).max(c) + reach]
}

/// How vertices lie to a coarse triangle, quickly and more or less: what is left out by this does not count for its
/// cover.
pub(super) struct QuickFrame {
    origin: Vec3A,
    /// What the depths within three sides and the height grow by along each axis, and what they are at the origin.
    along: [Vec4; 3],
    at_origin: Vec4,
    reach: f32,
    /// What is no more than this at all corners is away, or beside.
    away: Vec4,
    beside: Vec4,
}

impl QuickFrame {
    fn new(origin: DVec3, [x, y, z]: [DVec3; 3], reach: f64) -> Self {
        let third = -x - y;
        let along = [0, 1, 2].map(|axis| Vec4::from_array([x, y, third, z].map(|side| side[axis] as f32)));
        let reach = reach as f32;
        let [away, beside] = [NEAR, A_LITTLE].map(|near| Vec4::new(-near, -near, -near, -reach));
        Self { origin: origin.as_vec3a(), along, at_origin: Vec4::Z, reach, away, beside }
    }

    pub(super) fn way(&self, corners: &[Vec3A; 3]) -> QuickWay {
        let [x, y, z] = self.along;
        let depths = |p: Vec3A| {
            let offset = p - self.origin;
            self.at_origin + x * offset.x + y * offset.y + z * offset.z
        };
        let [a, b, c] = [depths(corners[0]), depths(corners[1]), depths(corners[2])];
        let (most, least) = (a.max(b).max(c), a.min(b).min(c));
        if most.cmple(self.away).any() || least.w >= self.reach {
            QuickWay::Away
        } else if most.cmple(self.beside).any() {
            QuickWay::Beside
        } else {
            QuickWay::Over
        }
    }
}

/// How a fine triangle lies to a coarse one, more or less.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum QuickWay {
    /// Neither near nor in reach.
    Away,
    /// Near, but not over it.
    Beside,
    /// Probably over it.
    Over,
}

/// What lies beside a triangle by this part of its height lies near it, and over others in its place that face a little
/// otherwise.
const NEAR: f32 = 0.2;

/// Far more than rounding to single precision makes of a part of a triangle's height, also of a thin one.
const A_LITTLE: f32 = 0.02;
