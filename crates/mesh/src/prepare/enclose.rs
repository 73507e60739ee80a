//! Small spheres around points and small cones around directions, that hold all of them to the last bit.

use bevy_math::{DVec3, Vec3};

/// A sphere that holds a set of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Its centre.
    pub center: Vec3,
    /// Its radius: no point lies further from the centre in exact arithmetic. Infinite where `f32` ends.
    pub radius: f32,
}

/// A cone of directions d from one point: those with `axis`·d ≥ `cos`.
///
/// Where `cos` is positive the cone is convex, and holds all normalised means of the directions it was made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionCone {
    /// Its middle, of unit length.
    pub axis: Vec3,
    /// The least cosine of a direction's angle to the axis, rounded down; −1 or less where there is no cone to speak
    /// of.
    pub cos: f32,
}

impl BoundingSphere {
    /// A sphere around the points, at least one; some hundredths larger than the smallest.
    pub(super) fn around(points: &[Vec3]) -> Self {
        let center = center(points).as_vec3();
        let reach = points.iter().map(|p| p.as_dvec3().distance(center.as_dvec3())).fold(0.0, f64::max);
        let mut radius = reach as f32;
        // The distance itself is rounded; a step more than it needs.
        if reach > 0.0 {
            radius = radius.next_up();
        }
        Self { center, radius }
    }
}

impl DirectionCone {
    /// A cone around unit directions; around none, +Y alone.
    pub(super) fn around(directions: &[Vec3]) -> Self {
        if directions.is_empty() {
            return Self { axis: Vec3::Y, cos: 1.0 };
        }
        let axis = center(directions).try_normalize().unwrap_or(DVec3::Y).as_vec3();
        let cos = directions.iter().map(|d| d.as_dvec3().dot(axis.as_dvec3())).fold(f64::INFINITY, f64::min);
        Self { axis, cos: (cos as f32).next_down() }
    }
}

/// The centre of a small sphere around points: Bădoiu and Clarkson 2003, "Smaller core-sets for balls". Each step goes
/// toward the farthest point, ever less; the best centre on the way is taken.
fn center(points: &[Vec3]) -> DVec3 {
    const STEPS: u32 = 64;
    let mut center = points.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / points.len() as f64;
    let (mut best, mut least) = (center, f64::INFINITY);
    for step in 0..STEPS {
        let mut farthest = (center, 0.0);
        for p in points {
            let p = p.as_dvec3();
            let distance2 = p.distance_squared(center);
            if distance2 > farthest.1 {
                farthest = (p, distance2);
            }
        }
        if farthest.1 < least {
            (best, least) = (center, farthest.1);
        }
        center += (farthest.0 - center) / f64::from(step + 2);
    }
    best
}
