//! Projections: how eye space falls onto the picture. All that depends on the kind of a projection is in this file.

use std::f32::consts::{FRAC_PI_4, PI};
use std::ops::Bound::Excluded;

use crate::Viewer;
use crate::equations::vector::Real;
use crate::equations::{Eye, Transcendental};
use crate::invalid::{Fields, InvalidValue};
use crate::range::Range;

/// How a camera projects eye space onto its picture. Eye space is right-handed, the camera at its origin looking along
/// −Z with +Y up; the depth of a point is its distance along the view, −z. Default: a perspective of 45°.
///
/// Under a perspective all rays leave from the eye. Under an orthographic projection they are parallel: the size of an
/// object does not depend on its depth, and the vector to the viewer is v = (0, 0, 1) in eye space at every point, for
/// [`Viewer::Local`] too.
///
/// ```
/// use halfway_lighting::{Camera, Projection};
///
/// // A plan that shows 20 world units from its lower to its upper edge.
/// let camera = Camera { projection: Projection::orthographic(20.0), ..Camera::default() };
/// assert!(camera.validate().is_ok());
///
/// // Objects twice as far away are half as large, or not smaller at all.
/// let size = |projection: Projection, depth| 1.0 / projection.lens::<f64>([640, 480]).pixel_size(depth, 480.0);
/// let perspective = Projection::perspective(45_f32.to_radians());
/// assert!((size(perspective, 2.0) / size(perspective, 4.0) - 2.0).abs() < 1e-12);
/// assert_eq!(size(camera.projection, 2.0), size(camera.projection, 4.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays leave from the eye. There is no far plane.
    Perspective {
        /// Vertical field of view in radians, in (0, π). Default 45°.
        fov_y: f32,
        /// Distance of the near plane in world units, above 0. Default 0.1. Nearer points are cut off.
        near: f32,
    },
    /// All rays are parallel to −Z.
    Orthographic {
        /// How many world units the picture shows from its lower to its upper edge, above 0.
        height: f32,
        /// Depth of the near plane in world units, any finite number: at 0 or below it points beside and behind the
        /// camera are shown, too. Default 0.
        near: f32,
        /// Depth of the far plane in world units, above `near`; points beyond it are cut off. With `None`, the default,
        /// nothing is: the depth buffer spans the visible objects.
        far: Option<f32>,
    },
}

impl Default for Projection {
    fn default() -> Self {
        Self::perspective(FRAC_PI_4)
    }
}

impl Projection {
    /// A perspective with this vertical field of view in radians; its near plane is at 0.1.
    pub const fn perspective(fov_y: f32) -> Self {
        Self::Perspective { fov_y, near: 0.1 }
    }

    /// An orthographic projection that shows this many world units from the lower to the upper edge, from depth 0 on.
    pub const fn orthographic(height: f32) -> Self {
        Self::Orthographic { height, near: 0.0, far: None }
    }

    /// Depth of the near plane in world units.
    pub const fn near(&self) -> f32 {
        match *self {
            Self::Perspective { near, .. } | Self::Orthographic { near, .. } => near,
        }
    }

    /// The same projection with its near plane at this depth.
    #[must_use]
    pub const fn with_near(self, near: f32) -> Self {
        match self {
            Self::Perspective { fov_y, .. } => Self::Perspective { fov_y, near },
            Self::Orthographic { height, far, .. } => Self::Orthographic { height, near, far },
        }
    }

    /// Checks every field against its range.
    ///
    /// # Errors
    /// An [`InvalidValue`] that names the field.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        self.validate_in(Fields::for_owner("Projection"))
    }

    pub(crate) fn validate_in(&self, fields: Fields) -> Result<(), InvalidValue> {
        match *self {
            Self::Perspective { fov_y, near } => {
                fields.within("fov_y", fov_y, Self::FIELD_OF_VIEW)?;
                fields.positive("near", near)
            }
            Self::Orthographic { height, near, far } => {
                fields.positive("height", height)?;
                fields.within("near", near, Range::FINITE)?;
                let Some(far) = far else { return Ok(()) };
                fields.number("far", far, far.is_finite() && far > near, "a finite number above near")
            }
        }
    }

    const FIELD_OF_VIEW: Range = Range::new(Excluded(0.0), Excluded(PI), "an angle above 0 and below π radians");

    /// The height of what the picture shows at a depth, in world units.
    pub fn height_at<T: Real>(&self, depth: T) -> T {
        match *self {
            Self::Perspective { fov_y, .. } => {
                T::from_f64(2.0) * depth * (T::from_f64(fov_y.into()) * T::from_f64(0.5)).tangent()
            }
            Self::Orthographic { height, .. } => T::from_f64(height.into()),
        }
    }

    /// The projection with the middle of the picture magnified, `zoom` times and above 0: a narrower field of view, or
    /// less height.
    #[must_use]
    pub fn zoomed(self, zoom: f32) -> Self {
        match self {
            // Not by an angle and back, which is not exact.
            Self::Perspective { .. } if (zoom - 1.0).abs() < f32::EPSILON => self,
            Self::Perspective { fov_y, near } => {
                let half = (f64::from(fov_y) * 0.5).tangent() / f64::from(zoom);
                Self::Perspective { fov_y: 2.0 * libm::atan(half) as f32, near }
            }
            Self::Orthographic { height, near, far } => Self::Orthographic { height: height / zoom, near, far },
        }
    }

    /// The projection after the camera has moved along its view from one distance from what it looks at to another. An
    /// orthographic picture shows more by the same factor, and its planes stay where they are; a perspective stays as it
    /// is.
    #[must_use]
    pub fn moved(self, from: f32, to: f32) -> Self {
        match self {
            Self::Perspective { .. } => self,
            Self::Orthographic { height, near, far } => {
                let plane = |depth: f32| depth + (to - from);
                Self::Orthographic { height: height * (to / from), near: plane(near), far: far.map(plane) }
            }
        }
    }

    /// How far from its centre, along the view, a camera stands that shows a sphere of this radius as large as it can
    /// in a picture no higher than wide; and the projection that it takes there.
    #[cfg(feature = "ecs")]
    pub(crate) fn framing(self, radius: f32) -> (f32, Self) {
        match self {
            Self::Perspective { fov_y, near } => {
                let distance = radius / (fov_y * 0.5).sine();
                let room = 0.5 * (distance - radius);
                (distance, if near <= room { self } else { self.with_near(room) })
            }
            Self::Orthographic { near, far, .. } => {
                let distance = near + 2.0 * radius;
                (distance, Self::Orthographic { height: 2.0 * radius, near, far })
            }
        }
    }

    /// Where the viewer is in eye space: [`view_vector`](crate::equations::view_vector) of it is the vector to the
    /// viewer at a point.
    pub fn eye<T: Real>(&self, viewer: Viewer) -> Eye<T> {
        match self {
            Self::Perspective { .. } => Eye::in_eye_space(viewer),
            Self::Orthographic { .. } => Eye::in_eye_space(Viewer::Infinite),
        }
    }

    /// The projection onto a picture of this many columns and rows of pixels.
    pub fn lens<T: Real>(&self, [width, height]: [u32; 2]) -> Lens<T> {
        let (y, far, is_parallel) = match *self {
            Self::Perspective { fov_y, .. } => (1.0 / (f64::from(fov_y) * 0.5).tangent(), f64::INFINITY, false),
            Self::Orthographic { height, far, .. } => {
                (2.0 / f64::from(height), far.map_or(f64::INFINITY, f64::from), true)
            }
        };
        let x = y * f64::from(height) / f64::from(width);
        Lens {
            scale: [T::from_f64(x), T::from_f64(y)],
            near: T::from_f64(self.near().into()),
            far: T::from_f64(far),
            is_parallel,
        }
    }
}

/// A [`Projection`] onto a picture of known proportions, as numbers that a drawer takes over. Nothing but its methods
/// knows which kind of projection it is.
///
/// The coordinate w of clip space is the depth in a perspective, and 1 where rays are parallel; on the picture, −1 to 1
/// from the left to the right and from the lower to the upper edge, a point is at `scale`·xy/w.
///
/// ```
/// use halfway_lighting::Projection;
///
/// let lens = Projection::orthographic(4.0).lens::<f64>([200, 100]).fitted([0.5, 8.0]);
/// let [x, y, z, w] = lens.clip_from_eye([1.0, 2.0, -3.0]);
/// assert_eq!([x / w, y / w], [0.25, 1.0]);
/// assert!(z / w > 0.0 && z / w < 1.0);
/// let ray = lens.ray([0.25, 1.0]);
/// assert_eq!((ray.origin, ray.direction), ([1.0, 2.0, 0.0], [0.0, 0.0, -1.0]));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lens<T = f32> {
    /// x and y of clip space are these times x and y of eye space; above 0.
    pub scale: [T; 2],
    /// Depth of the near plane.
    pub near: T,
    /// Depth of the far plane; infinite where there is none.
    pub far: T,
    /// Whether all rays are parallel to −Z; else they leave from the eye.
    pub is_parallel: bool,
}

/// A ray through a point of the picture, in eye space. The point at depth d is `origin + d·direction`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRay<T> {
    /// Its point in the plane of the camera, z = 0.
    pub origin: [T; 3],
    /// Its direction, as long as takes it 1 along the view: z = −1.
    pub direction: [T; 3],
}

impl<T: Real> Lens<T> {
    /// A perspective by its numbers: cot(fov/2)/aspect and cot(fov/2), and the distance of the near plane.
    pub fn perspective(scale: [T; 2], near: T) -> Self {
        Self { scale, near, far: T::infinity(), is_parallel: false }
    }

    /// An orthographic projection by its numbers: 2/width and 2/height, and the depths of the near and the far plane.
    pub fn orthographic(scale: [T; 2], [near, far]: [T; 2]) -> Self {
        Self { scale, near, far, is_parallel: true }
    }

    /// In another precision.
    pub fn cast<U: Real>(&self) -> Lens<U> {
        let of = |value: T| U::from(value).unwrap_or_else(U::nan);
        Lens { scale: self.scale.map(of), near: of(self.near), far: of(self.far), is_parallel: self.is_parallel }
    }

    /// The lens for an eye space in which a world unit is `unit` long.
    #[must_use]
    pub fn in_unit(&self, unit: T) -> Self {
        let Self { scale, near, far, is_parallel } = *self;
        let scale = if is_parallel { scale.map(|scale| scale / unit) } else { scale };
        Self { scale, near: near * unit, far: far * unit, is_parallel }
    }

    /// The lens whose depth buffer spans what lies between the near and the far plane of objects from the nearest to the
    /// farthest of these depths, with room beside them. A parallel one has to be fitted before depths are taken from it
    /// unless its far plane is finite; a perspective stays as it is.
    #[must_use]
    pub fn fitted(&self, [nearest, farthest]: [T; 2]) -> Self {
        if !self.is_parallel {
            return *self;
        }
        let (mut near, mut far) = (self.near, self.far);
        if nearest <= farthest {
            let room =
                (farthest - nearest) * T::from_f64(1.0 / 16.0) + nearest.abs().max(farthest.abs()) * T::from_f64(1e-5);
            (near, far) = (near.max(nearest - room), far.min(farthest + room));
        }
        // A buffer has some depth, also where nothing is shown.
        let least = near + near.abs() * T::from_f64(1e-4);
        let far = if far > least && far.is_finite() { far } else { near + near.abs().max(T::one()) };
        Self { near, far, ..*self }
    }

    /// w of clip space at a depth.
    #[inline]
    pub fn w(&self, depth: T) -> T {
        if self.is_parallel { T::one() } else { depth }
    }

    /// A number that is greater the nearer a depth is, and linear over the picture of any plane: 1/depth, or, where rays
    /// are parallel, 1 at the near plane to 0 at the far one.
    #[inline]
    pub fn nearness(&self, depth: T) -> T {
        if self.is_parallel { (self.far - depth) / (self.far - self.near) } else { depth.recip() }
    }

    /// The [`nearness`](Self::nearness) for a lens that is not [fitted](Self::fitted): its scale does not depend on the
    /// planes. 1/depth, or, where rays are parallel, −depth.
    pub fn unfitted_nearness(&self, depth: T) -> T {
        if self.is_parallel { -depth } else { depth.recip() }
    }

    /// How far the [`unfitted_nearness`](Self::unfitted_nearness) of a vertex is off where its depth is off by one part of
    /// the `terms` that it is the sum of, and a depth buffer that spans `depths` by one part of its values.
    pub fn nearness_error(&self, depth: T, terms: T, depths: T) -> T {
        if self.is_parallel {
            terms + depths
        } else if depth > self.near {
            (terms / depth).max(T::one()) / depth
        } else {
            // In place of what lies before the near plane there are corners on it.
            self.near.recip()
        }
    }

    /// The first number with which nothing can be drawn: its name, its value and what is expected of it. A parallel lens
    /// is expected to be [fitted](Self::fitted).
    pub fn fault(&self) -> Option<(&'static str, T, &'static str)> {
        let Self { scale, near, far, is_parallel } = *self;
        let fault = |field, value, is_right: bool, expected| (!is_right).then_some((field, value, expected));
        let positive =
            |field, value: T| fault(field, value, value.is_finite() && value > T::zero(), "a finite number above 0");
        let planes = || {
            if !is_parallel {
                return positive("near", near);
            }
            fault("near", near, near.is_finite(), "a finite number")
                .or_else(|| fault("far", far, far.is_finite() && far > near, "a finite number above near"))
        };
        positive("scale", scale[0]).or_else(|| positive("scale", scale[1])).or_else(planes)
    }

    /// 1/w where this is the [nearness](Self::nearness).
    #[inline]
    pub fn inverse_w(&self, nearness: T) -> T {
        if self.is_parallel { T::one() } else { nearness }
    }

    /// By how much 1/w changes from a pixel to the next where the nearness changes by this.
    #[inline]
    pub fn inverse_w_step(&self, nearness_step: T) -> T {
        if self.is_parallel { T::zero() } else { nearness_step }
    }

    /// By how much the depth changes from a pixel to the next where the nearness changes by this and w is known.
    #[inline]
    pub fn depth_step(&self, nearness_step: T, w: T) -> T {
        let by = if self.is_parallel { self.far - self.near } else { w * w };
        -by * nearness_step
    }

    /// Where a point of eye space lies in clip space, with reversed depth: z/w is 1 at the near plane and 0 at the far
    /// plane or infinitely far away.
    pub fn clip_from_eye(&self, [x, y, z]: [T; 3]) -> [T; 4] {
        let LensTerms { depth, w } = self.terms();
        let at = |[a, b]: [T; 2]| -z * a + b;
        [self.scale[0] * x, self.scale[1] * y, at(depth), at(w)]
    }

    /// z and w of clip space as functions of the depth.
    pub fn terms(&self) -> LensTerms<T> {
        let (zero, one) = (T::zero(), T::one());
        if self.is_parallel {
            let span = self.far - self.near;
            LensTerms { depth: [-span.recip(), self.far / span], w: [zero, one] }
        } else {
            LensTerms { depth: [zero, self.near], w: [one, zero] }
        }
    }

    /// [`clip_from_eye`](Self::clip_from_eye) as a matrix, by its columns.
    pub fn matrix(&self) -> [[T; 4]; 4] {
        let zero = T::zero();
        let [x, y] = self.scale;
        let LensTerms { depth, w } = self.terms();
        [[x, zero, zero, zero], [zero, y, zero, zero], [zero, zero, -depth[0], -w[0]], [zero, zero, depth[1], w[1]]]
    }

    /// The ray through a point of the picture, which is given as −1 to 1 from the left to the right and from the lower
    /// to the upper edge.
    pub fn ray(&self, at: [T; 2]) -> ViewRay<T> {
        self.ray_at([at[0] / self.scale[0], at[1] / self.scale[1]])
    }

    /// The ray through a point of the picture, which is given by x and y of eye space where w is 1.
    pub fn ray_at(&self, [x, y]: [T; 2]) -> ViewRay<T> {
        let (zero, one) = (T::zero(), T::one());
        if self.is_parallel {
            ViewRay { origin: [x, y, zero], direction: [zero, zero, -one] }
        } else {
            ViewRay { origin: [zero; 3], direction: [x, y, -one] }
        }
    }

    /// The eye in eye space, by homogeneous coordinates: the origin, or infinitely far along +Z where rays are parallel.
    pub fn eye_position(&self) -> [T; 4] {
        let (zero, one) = (T::zero(), T::one());
        if self.is_parallel { [zero, zero, one, zero] } else { [zero, zero, zero, one] }
    }

    /// The direction in which a point of eye space is seen, of any length: z = −w.
    pub fn sight(&self, p: [T; 3]) -> [T; 3] {
        if self.is_parallel { [T::zero(), T::zero(), -T::one()] } else { p }
    }

    /// Whether a depth lies between the near and the far plane.
    pub fn shows(&self, depth: T) -> bool {
        depth >= self.near && depth <= self.far
    }

    /// Whether a sphere of eye space may reach the picture. Never false for one that does.
    pub fn sees(&self, center: [T; 3], radius: T) -> bool {
        let depth = -center[2];
        let sides = [0, 1].iter().all(|&axis| self.beyond(axis, center) <= self.across(axis, radius));
        depth + radius >= self.near && depth - radius <= self.far && sides
    }

    /// Whether no part of a sphere of eye space is beside the picture, before the near plane, or beyond the far plane.
    /// Never true for one of which a part is.
    pub fn holds(&self, center: [T; 3], radius: T) -> bool {
        let depth = -center[2];
        let sides = [0, 1].iter().all(|&axis| self.beyond(axis, center) <= -self.across(axis, radius));
        let reach = radius * T::from_f64(ROOM);
        depth - reach >= self.near && depth + reach <= self.far && sides
    }

    /// How far a point is outside the two side planes of an axis; their normals are [`across`](Self::across) long.
    #[inline]
    fn beyond(&self, axis: usize, center: [T; 3]) -> T {
        self.scale[axis] * center[axis].abs() - self.w(-center[2])
    }

    /// A radius times the length of the normals of an axis' side planes: |scale·x| ≤ w. The planes pass through the eye,
    /// or are parallel.
    #[inline]
    fn across(&self, axis: usize, radius: T) -> T {
        let scale = self.scale[axis];
        if self.is_parallel {
            radius * scale * T::from_f64(ROOM) + T::from_f64(1e-6)
        } else {
            radius * (scale * scale + T::one()).sqrt() * T::from_f64(ROOM)
        }
    }

    /// From where to where a box reaches along an axis on the picture, as −1 to 1; it holds the points that are up to
    /// `reach` from `offset` along the axis, at depths up to `depth.reach` from the middle. `None` where it is beside the
    /// picture.
    pub fn span(&self, axis: usize, (offset, reach): (T, T), depth: &DepthSpan<T>) -> Option<[T; 2]> {
        let scale = self.scale[axis];
        let (low, high) = (offset - reach, offset + reach);
        if self.is_parallel {
            return Some([scale * low, scale * high]);
        }
        let (nearest, farthest) = (depth.middle - depth.reach, depth.middle + depth.reach);
        if nearest > T::from_f64(1e-3) * depth.radius && nearest > T::zero() {
            let low = scale * low / if low < T::zero() { nearest } else { farthest };
            let high = scale * high / if high < T::zero() { farthest } else { nearest };
            return Some([low, high]);
        }
        // It surrounds the eye, or nearly: only the side planes can leave it out.
        let beyond = scale * offset.abs() - depth.middle
            > depth.radius * (scale * scale + T::one()).sqrt() * T::from_f64(1.0001);
        (!beyond).then_some([T::neg_infinity(), T::infinity()])
    }

    /// Whether no point of a sphere shows a face whose normal lies in a cone: for each such normal n and each point p of
    /// the sphere n·p > 0, or n·(0, 0, −1) > 0 where rays are parallel. `axis` and the cosine and sine of the half angle
    /// say which normals.
    pub fn hides(&self, (center, radius): ([T; 3], T), axis: [T; 3], [cos, sin]: [T; 2]) -> bool {
        let p = self.sight(center);
        let along = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
        let square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        let across = (square - along * along).max(T::zero()).sqrt();
        // Over the sphere and the cone n·p is at least D·cos(γ + α) − r; where that is above 0 all faces turn away.
        let room = if self.is_parallel { T::from_f64(1e-4) } else { radius * T::from_f64(1.0001) };
        along * cos - across * sin > room
    }

    /// How many pixels a length of 1 across the view takes where w is 1, in a picture of this many rows.
    pub fn pixels_at_unit_w(&self, rows: T) -> T {
        T::from_f64(0.5) * self.scale[1] * rows
    }

    /// The height of a pixel at a depth, in units of eye space, in a picture of this many rows.
    pub fn pixel_size(&self, depth: T, rows: T) -> T {
        self.w(depth) / self.pixels_at_unit_w(rows)
    }

    /// The angle between the rays of a pixel in the middle of the picture and the one above it, in radians.
    pub fn pixel_angle(&self, rows: T) -> T {
        if self.is_parallel { T::zero() } else { self.pixels_at_unit_w(rows).recip() }
    }

    /// An upper bound of how large a step is on the picture, anywhere in a sphere of eye space where the picture shows
    /// it; `step` is its length in pixels where w is 1. No less for a sphere that holds another.
    ///
    /// In a perspective a step of length e at (x, y, −z) moves its end by at most f·e/z·√(1 + (x² + y²)/z²), f pixels
    /// being the step of a point at depth 1 that moves by 1.
    pub fn largest_step(&self, step: T, (center, radius): ([T; 3], T)) -> T {
        if self.is_parallel {
            return step;
        }
        let [x, y] = self.scale;
        let one = T::one();
        let nearest = (-center[2] - radius).max(self.near);
        let aside = (center[0] * center[0] + center[1] * center[1]).sqrt() + radius;
        let aside2 = aside * aside / (nearest * nearest);
        let slope2 = aside2.min(one / (x * x) + one / (y * y));
        step * (one + slope2).sqrt() / nearest
    }
}

/// A little more than 1: spheres are widened by it.
const ROOM: f64 = 1.0 + 1e-5;

/// z and w of clip space at the depth d: `depth[0]·d + depth[1]` and `w[0]·d + w[1]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensTerms<T> {
    /// The terms of z.
    pub depth: [T; 2],
    /// The terms of w.
    pub w: [T; 2],
}

/// How deep something is in eye space: its middle, how far it reaches before and beyond it, and in any direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthSpan<T> {
    /// The depth of its middle.
    pub middle: T,
    /// How far it reaches along the view from there.
    pub reach: T,
    /// How far it reaches in any direction.
    pub radius: T,
}
