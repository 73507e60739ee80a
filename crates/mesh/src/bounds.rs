//! Axis-aligned boxes.

use glam::{DVec3, Mat4, Vec3};

/// An axis-aligned box: the smallest that holds a set of points. Never empty, always finite.
///
/// ```
/// use glam::Vec3;
/// use halfway_mesh::{Bounds, Mesh, Teapot};
///
/// let teapot = Mesh::from(Teapot::new(8)).bounds();
/// assert!((teapot.size().y - 2.3625).abs() < 1e-5);
/// let both = teapot.union(&Bounds::from_points([Vec3::Y * 4.0]).expect("one point"));
/// assert_eq!(both.max.y, 4.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least coordinate along each axis.
    pub min: Vec3,
    /// The greatest coordinate along each axis.
    pub max: Vec3,
}

impl Bounds {
    /// The box around the points, or `None` where there is none.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        Some(
            points.fold(Self { min: first, max: first }, |bounds, p| Self {
                min: bounds.min.min(p),
                max: bounds.max.max(p),
            }),
        )
    }

    /// The middle of the box. Halved before it is added, so that no finite box overflows.
    pub fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// The lengths of the edges; `f32::MAX` where an edge is longer than that.
    pub fn size(&self) -> Vec3 {
        (self.max - self.min).min(Vec3::splat(f32::MAX))
    }

    /// The radius of the sphere about [`center`](Self::center) that holds the box: half its diagonal, at most
    /// `f32::MAX`.
    pub fn radius(&self) -> f32 {
        let diagonal = self.max.as_dvec3() - self.min.as_dvec3();
        to_finite_f32(0.5 * diagonal.length())
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The box around this box's eight corners after `to_from` has moved them: it may be larger than the box around the
    /// moved points themselves. Coordinates that leave the range of `f32` stop at its ends.
    #[must_use]
    pub fn transformed(&self, to_from: &Mat4) -> Self {
        let to_from = to_from.as_dmat4();
        let corner = |i: u32| {
            let pick = |bit: u32, low: f32, high: f32| f64::from(if i & bit == 0 { low } else { high });
            let p = to_from.transform_point3(DVec3::new(
                pick(1, self.min.x, self.max.x),
                pick(2, self.min.y, self.max.y),
                pick(4, self.min.z, self.max.z),
            ));
            Vec3::new(to_finite_f32(p.x), to_finite_f32(p.y), to_finite_f32(p.z))
        };
        let first = corner(0);
        (1..8)
            .map(corner)
            .fold(Self { min: first, max: first }, |bounds, p| Self { min: bounds.min.min(p), max: bounds.max.max(p) })
    }
}

fn to_finite_f32(x: f64) -> f32 {
    x.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_of_points() {
        assert_eq!(Bounds::from_points([]), None);
        let bounds = Bounds::from_points([Vec3::new(1.0, -2.0, 3.0), Vec3::new(-1.0, 4.0, 3.0), Vec3::ZERO]).unwrap();
        assert_eq!(bounds.min, Vec3::new(-1.0, -2.0, 0.0));
        assert_eq!(bounds.max, Vec3::new(1.0, 4.0, 3.0));
        assert_eq!(bounds.center(), Vec3::new(0.0, 1.0, 1.5));
        assert_eq!(bounds.size(), Vec3::new(2.0, 6.0, 3.0));
        assert!((bounds.radius() - 3.5).abs() < 1e-6); // half of √(4 + 36 + 9) = 7
    }

    #[test]
    fn the_largest_box_has_finite_figures() {
        let bounds = Bounds { min: Vec3::splat(f32::MIN), max: Vec3::splat(f32::MAX) };
        assert_eq!(bounds.center(), Vec3::ZERO);
        assert_eq!(bounds.size(), Vec3::splat(f32::MAX));
        assert!(bounds.radius() >= f32::MAX && bounds.radius().is_finite());
        let far = Bounds { min: Vec3::splat(0.5 * f32::MAX), max: Vec3::splat(f32::MAX) };
        assert_eq!(far.center(), Vec3::splat(0.75 * f32::MAX));
        let larger = bounds.transformed(&Mat4::from_scale(Vec3::splat(10.0)));
        assert_eq!(larger, bounds);
    }

    #[test]
    fn moved_and_joined() {
        let unit = Bounds { min: Vec3::ZERO, max: Vec3::ONE };
        let mirrored = unit.transformed(&Mat4::from_scale(Vec3::new(-2.0, 1.0, 1.0)));
        assert_eq!(mirrored.min, Vec3::new(-2.0, 0.0, 0.0));
        assert_eq!(mirrored.max, Vec3::ONE.with_x(0.0));
        let both = unit.union(&mirrored);
        assert_eq!(both.min, Vec3::new(-2.0, 0.0, 0.0));
        assert_eq!(both.max, Vec3::ONE);
    }
}
