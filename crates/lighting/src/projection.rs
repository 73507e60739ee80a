//! Projections: how eye space falls onto the picture. All that depends on the kind of a projection is in this file.

use std::f32::consts::{FRAC_PI_4, PI};
use std::ops::Bound::{Excluded, Included};

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
/// let size = |projection: Projection, depth| 1.0 / projection.lens::<f64>([640, 480]).pixel_size(depth, [640.0, 480.0]);
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
        /// Where the picture lies, and the shape of its pixels. Default [`Film::DEFAULT`].
        film: Film,
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
        /// Where the picture lies, and the shape of its pixels. Default [`Film::DEFAULT`].
        film: Film,
    },
}

/// Where the picture lies in the plane that a [`Projection`] falls onto, and the shape of its pixels. By default its
/// middle is on the axis of the view and its pixels are square.
///
/// ```
/// use halfway_lighting::{Film, Projection};
///
/// // A shift lens: the camera looks level, and the picture's lower edge is at the horizon.
/// let film = Film { shift: [0.0, 0.5], ..Film::DEFAULT };
/// let lens = Projection::perspective(1.0).with_film(film).lens::<f64>([640, 480]);
/// let [_, y, _, w] = lens.clip_from_eye([0.0, 0.0, -5.0]);
/// assert_eq!(y / w, -1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// How far the middle of the picture is to the right of the axis of the view and above it, in heights of what the
    /// projection's `fov_y` or `height` shows; each −100 to 100. Default `[0.0, 0.0]`.
    pub shift: [f32; 2],
    /// Width over height of what is always seen, 10⁻⁴ to 10⁴. In a picture that is wider, more is seen on both sides;
    /// in one that is narrower, more is seen above and below, so that nothing is stretched or cut off. With `None`, the
    /// default, a narrower picture shows less of the sides.
    pub aspect: Option<f32>,
    /// Width over height of what a pixel shows, 10⁻⁴ to 10⁴. Default 1.
    pub pixel_aspect: f32,
}

impl Film {
    /// In the middle, with square pixels.
    pub const DEFAULT: Self = Self { shift: [0.0; 2], aspect: None, pixel_aspect: 1.0 };
    /// The range of each number of [`shift`](Self::shift).
    pub const SHIFT: Range = Range::new(Included(-100.0), Included(100.0), "a number from -100 to 100");
    /// The range of [`aspect`](Self::aspect) and [`pixel_aspect`](Self::pixel_aspect).
    pub const ASPECT: Range = Range::new(Included(1e-4), Included(1e4), "a number from 0.0001 to 10000");

    fn validate_in(&self, fields: Fields) -> Result<(), InvalidValue> {
        let Self { shift, aspect, pixel_aspect } = *self;
        shift.iter().try_for_each(|along| fields.within("film.shift", *along, Self::SHIFT))?;
        aspect.map_or(Ok(()), |aspect| fields.within("film.aspect", aspect, Self::ASPECT))?;
        fields.within("film.pixel_aspect", pixel_aspect, Self::ASPECT)
    }
}

impl Default for Film {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Default for Projection {
    fn default() -> Self {
        Self::perspective(FRAC_PI_4)
    }
}

impl Projection {
    /// A perspective with this vertical field of view in radians; its near plane is at 0.1.
    pub const fn perspective(fov_y: f32) -> Self {
        Self::Perspective { fov_y, near: 0.1, film: Film::DEFAULT }
    }

    /// An orthographic projection that shows this many world units from the lower to the upper edge, from depth 0 on.
    pub const fn orthographic(height: f32) -> Self {
        Self::Orthographic { height, near: 0.0, far: None, film: Film::DEFAULT }
    }

    /// The perspective of a camera that was calibrated: its focal lengths [fx, fy] and its principal point [cx, cy] in
    /// pixels of a picture that is [width, height] pixels large. Pixels count from the upper left corner of the picture,
    /// x to the right and y down; the middle of the first pixel is at (0.5, 0.5). A program that puts it at (0, 0), as
    /// `OpenCV` does, has principal points that are less by 0.5.
    ///
    /// In a picture of another size with the same proportions the same is seen; of other proportions, more
    /// ([`Film::aspect`]). The near plane is at 0.1. Poses of computer vision have the camera look along +Z with +Y
    /// down: turn them by 180° about their X axis.
    ///
    /// ```
    /// use halfway_lighting::Projection;
    ///
    /// let lens = Projection::intrinsics([500.0, 510.0], [310.0, 250.0], [640, 480]).lens::<f64>([640, 480]);
    /// let [x, y, _, w] = lens.clip_from_eye([0.2, 0.1, -2.0]);
    /// let pixel = [320.0 * (1.0 + x / w), 240.0 * (1.0 - y / w)];
    /// assert!((pixel[0] - (310.0 + 500.0 * 0.1)).abs() < 1e-3);
    /// assert!((pixel[1] - (250.0 - 510.0 * 0.05)).abs() < 1e-3);
    /// ```
    pub fn intrinsics([fx, fy]: [f32; 2], [cx, cy]: [f32; 2], [width, height]: [u32; 2]) -> Self {
        let [fx, fy, cx, cy] = [fx, fy, cx, cy].map(f64::from);
        let [width, height] = [width, height].map(f64::from);
        let pixel_aspect = fy / fx;
        let shift = [(0.5 * width - cx) * pixel_aspect / height, (cy - 0.5 * height) / height];
        let film = Film {
            shift: shift.map(|along| along as f32),
            aspect: Some((width * pixel_aspect / height) as f32),
            pixel_aspect: pixel_aspect as f32,
        };
        Self::Perspective { fov_y: (2.0 * (0.5 * height / fy).arc_tangent()) as f32, near: 0.1, film }
    }

    /// A perspective whose picture shows, in the plane at the depth `near`, x from `left` to `right` and y from `bottom`
    /// to `top`, as OpenGL's `glFrustum` does: half of a stereo pair, a tile of a larger picture, a window onto a scene.
    /// In a picture of other proportions more is seen ([`Film::aspect`]).
    ///
    /// ```
    /// use halfway_lighting::Projection;
    ///
    /// // The right half of what a perspective of 90° shows.
    /// let lens = Projection::frustum([0.0, 1.0], [-1.0, 1.0], 1.0).lens::<f64>([50, 100]);
    /// let [x, _, _, w] = lens.clip_from_eye([0.0, 0.0, -3.0]);
    /// assert!((x / w + 1.0).abs() < 1e-6);
    /// ```
    pub fn frustum([left, right]: [f32; 2], [bottom, top]: [f32; 2], near: f32) -> Self {
        let [left, right, bottom, top] = [left, right, bottom, top].map(f64::from);
        let height = top - bottom;
        let film = Film {
            shift: [left + right, bottom + top].map(|both| (0.5 * both / height) as f32),
            aspect: Some(((right - left) / height) as f32),
            ..Film::DEFAULT
        };
        Self::Perspective { fov_y: (2.0 * (0.5 * height / f64::from(near)).arc_tangent()) as f32, near, film }
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
            Self::Perspective { fov_y, film, .. } => Self::Perspective { fov_y, near, film },
            Self::Orthographic { height, far, film, .. } => Self::Orthographic { height, near, far, film },
        }
    }

    /// Where the picture lies, and the shape of its pixels.
    pub const fn film(&self) -> Film {
        match *self {
            Self::Perspective { film, .. } | Self::Orthographic { film, .. } => film,
        }
    }

    /// The same projection with this film.
    #[must_use]
    pub const fn with_film(self, film: Film) -> Self {
        match self {
            Self::Perspective { fov_y, near, .. } => Self::Perspective { fov_y, near, film },
            Self::Orthographic { height, near, far, .. } => Self::Orthographic { height, near, far, film },
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
        self.film().validate_in(fields)?;
        match *self {
            Self::Perspective { fov_y, near, .. } => {
                fields.within("fov_y", fov_y, Self::FIELD_OF_VIEW)?;
                fields.positive("near", near)
            }
            Self::Orthographic { height, near, far, .. } => {
                fields.positive("height", height)?;
                fields.within("near", near, Range::FINITE)?;
                let Some(far) = far else { return Ok(()) };
                fields.number("far", far, far.is_finite() && far > near, "a finite number above near")
            }
        }
    }

    const FIELD_OF_VIEW: Range = Range::new(Excluded(0.0), Excluded(PI), "an angle above 0 and below π radians");

    /// The height of what the picture shows at a depth, in world units; of a picture that is narrower than its
    /// [`Film::aspect`] this is the least.
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
        // The shift is counted in heights, which become smaller.
        let zoomed = |film: Film| Film { shift: film.shift.map(|shift| shift * zoom), ..film };
        match self {
            // Not by an angle and back, which is not exact.
            Self::Perspective { .. } if (zoom - 1.0).abs() < f32::EPSILON => self,
            Self::Perspective { fov_y, near, film } => {
                let half = (f64::from(fov_y) * 0.5).tangent() / f64::from(zoom);
                Self::Perspective { fov_y: 2.0 * libm::atan(half) as f32, near, film: zoomed(film) }
            }
            Self::Orthographic { height, near, far, film } => {
                Self::Orthographic { height: height / zoom, near, far, film: zoomed(film) }
            }
        }
    }

    /// The projection after the camera has moved along its view from one distance from what it looks at to another. An
    /// orthographic picture shows more by the same factor, and its planes stay where they are; a perspective stays as it
    /// is.
    #[must_use]
    pub fn moved(self, from: f32, to: f32) -> Self {
        match self {
            Self::Perspective { .. } => self,
            Self::Orthographic { height, near, far, film } => {
                let plane = |depth: f32| depth + (to - from);
                Self::Orthographic { height: height * (to / from), near: plane(near), far: far.map(plane), film }
            }
        }
    }

    /// Where in eye space the centre of a sphere of this radius is when a square picture shows it in its middle, as large
    /// as it can; and the projection that the camera takes there.
    #[cfg(feature = "ecs")]
    pub(crate) fn framing(self, radius: f32) -> ([f32; 3], Self) {
        let film = self.film();
        let (depth, projection) = match self {
            Self::Perspective { fov_y, near, .. } => {
                let distance = if film == Film::DEFAULT {
                    radius / (fov_y * 0.5).sine()
                } else {
                    radius * self.lens::<f32>([1, 1]).steepest_side()
                };
                let room = 0.5 * (distance - radius);
                (distance, if near <= room { self } else { self.with_near(room) })
            }
            Self::Orthographic { near, far, .. } => {
                let [x, y] = Self::orthographic(2.0).with_film(film).half_extent([1, 1]);
                let height = 2.0 * f64::from(radius) / x.min(y);
                (near + 2.0 * radius, Self::Orthographic { height: height as f32, near, far, film })
            }
        };
        let [x, y] = film.shift.map(|along| along * projection.height_at(depth));
        ([x, y, -depth], projection)
    }

    /// Where the viewer is in eye space: [`view_vector`](crate::equations::view_vector) of it is the vector to the
    /// viewer at a point.
    pub fn eye<T: Real>(&self, viewer: Viewer) -> Eye<T> {
        match self {
            Self::Perspective { .. } => Eye::in_eye_space(viewer),
            Self::Orthographic { .. } => Eye::in_eye_space(Viewer::Infinite),
        }
    }

    /// Half the width and half the height of what a picture of this many columns and rows of pixels shows where w of clip
    /// space is 1, in units of eye space.
    pub fn half_extent(&self, [width, height]: [u32; 2]) -> [f64; 2] {
        let [width, height] = [width, height].map(f64::from);
        let Film { aspect, pixel_aspect, .. } = self.film();
        let half = 0.5 * self.height_at(1.0);
        let pixel_aspect = f64::from(pixel_aspect);
        let of_picture = width * pixel_aspect / height;
        let y = half * aspect.map_or(1.0, |aspect| (f64::from(aspect) / of_picture).max(1.0));
        [y * width / height * pixel_aspect, y]
    }

    /// The projection of which a picture of this many columns and rows shows at the middle of each pixel what this one's
    /// shows so many pixels to the right of it and below it.
    #[must_use]
    pub fn moved_by_pixels(self, [right, down]: [f64; 2], [width, height]: [u32; 2]) -> Self {
        let [x, y] = self.half_extent([width, height]);
        let pixel = [2.0 * x / f64::from(width), 2.0 * y / f64::from(height)].map(|size| size / self.height_at(1.0));
        let film = self.film();
        let shift = [f64::from(film.shift[0]) + right * pixel[0], f64::from(film.shift[1]) - down * pixel[1]];
        self.with_film(Film { shift: shift.map(|along| along as f32), ..film })
    }

    /// The middle of the picture where w of clip space is 1, in units of eye space.
    pub fn middle(&self) -> [f64; 2] {
        self.film().shift.map(|along| f64::from(along) * self.height_at(1.0))
    }

    /// The projection onto a picture of this many columns and rows of pixels.
    pub fn lens<T: Real>(&self, [width, height]: [u32; 2]) -> Lens<T> {
        let (far, is_parallel) = match *self {
            Self::Perspective { .. } => (f64::INFINITY, false),
            Self::Orthographic { far, .. } => (far.map_or(f64::INFINITY, f64::from), true),
        };
        let y = self.half_extent([width, height])[1].recip();
        let scale = [y * f64::from(height) / f64::from(width) / f64::from(self.film().pixel_aspect), y];
        let middle = self.middle();
        Lens {
            scale: scale.map(T::from_f64),
            // Zero is exact.
            center: [0, 1].map(|axis| T::from_f64(0.0 - scale[axis] * middle[axis])),
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
/// from the left to the right and from the lower to the upper edge, a point is at `scale`·xy/w + `center`.
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
    /// x and y of clip space are these times x and y of eye space, plus `center` times w; above 0.
    pub scale: [T; 2],
    /// Where the axis of the view meets the picture: −1 to 1 if it does, from the left to the right and from the lower
    /// to the upper edge. 0 without a [shift](Film::shift).
    pub center: [T; 2],
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
        Self { scale, center: [T::zero(); 2], near, far: T::infinity(), is_parallel: false }
    }

    /// An orthographic projection by its numbers: 2/width and 2/height, and the depths of the near and the far plane.
    pub fn orthographic(scale: [T; 2], [near, far]: [T; 2]) -> Self {
        Self { scale, center: [T::zero(); 2], near, far, is_parallel: true }
    }

    /// The same lens where the axis of the view meets the picture at another point.
    #[must_use]
    pub fn with_center(self, center: [T; 2]) -> Self {
        Self { center, ..self }
    }

    /// In another precision.
    pub fn cast<U: Real>(&self) -> Lens<U> {
        let of = |value: T| U::from(value).unwrap_or_else(U::nan);
        let [scale, center] = [self.scale, self.center].map(|both| both.map(of));
        Lens { scale, center, near: of(self.near), far: of(self.far), is_parallel: self.is_parallel }
    }

    /// The lens for an eye space in which a world unit is `unit` long.
    #[must_use]
    pub fn in_unit(&self, unit: T) -> Self {
        let Self { scale, center, near, far, is_parallel } = *self;
        let scale = if is_parallel { scale.map(|scale| scale / unit) } else { scale };
        Self { scale, center, near: near * unit, far: far * unit, is_parallel }
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

    /// The depth whose [`unfitted_nearness`](Self::unfitted_nearness) this is.
    pub fn depth_at(&self, unfitted_nearness: T) -> T {
        if self.is_parallel { -unfitted_nearness } else { unfitted_nearness.recip() }
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
        let Self { scale, center, near, far, is_parallel } = *self;
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
        let finite = |value: T| fault("center", value, value.is_finite(), "a finite number");
        let center = || finite(center[0]).or_else(|| finite(center[1]));
        positive("scale", scale[0]).or_else(|| positive("scale", scale[1])).or_else(center).or_else(planes)
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
        let w = at(w);
        let across = |axis: usize, along: T| self.scale[axis] * along + self.center[axis] * w;
        [across(0, x), across(1, y), at(depth), w]
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
        let [[x2, y2], [x3, y3]] = [-w[0], w[1]].map(|w| self.center.map(|center| center * w + zero));
        [[x, zero, zero, zero], [zero, y, zero, zero], [x2, y2, -depth[0], -w[0]], [x3, y3, depth[1], w[1]]]
    }

    /// The ray through a point of the picture, which is given as −1 to 1 from the left to the right and from the lower
    /// to the upper edge.
    pub fn ray(&self, at: [T; 2]) -> ViewRay<T> {
        self.ray_at([0, 1].map(|axis| (at[axis] - self.center[axis]) / self.scale[axis]))
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
    #[inline]
    pub fn sees(&self, center: [T; 3], radius: T) -> bool {
        let depth = -center[2];
        let sides = [0, 1].iter().all(|&axis| {
            let (beyond, across) = (self.beyond(axis, center), self.across(axis, radius));
            beyond[0] <= across[0] && beyond[1] <= across[1]
        });
        depth + radius >= self.near && depth - radius <= self.far && sides
    }

    /// Whether no part of a sphere of eye space is beside the picture, before the near plane, or beyond the far plane.
    /// Never true for one of which a part is.
    pub fn holds(&self, center: [T; 3], radius: T) -> bool {
        let depth = -center[2];
        let sides = [0, 1].iter().all(|&axis| {
            let (beyond, across) = (self.beyond(axis, center), self.across(axis, radius));
            beyond[0] <= -across[0] && beyond[1] <= -across[1]
        });
        let reach = radius * T::from_f64(ROOM);
        depth - reach >= self.near && depth + reach <= self.far && sides
    }

    /// How far a point is outside the two side planes of an axis, those of less and of more; their normals are
    /// [`across`](Self::across) long.
    #[inline]
    fn beyond(&self, axis: usize, center: [T; 3]) -> [T; 2] {
        let w = self.w(-center[2]);
        let at = self.scale[axis] * center[axis] + self.center[axis] * w;
        [-at - w, at - w]
    }

    /// A radius times the lengths of the normals of an axis' side planes: −w ≤ scale·x + center·w ≤ w. The planes pass
    /// through the eye, or are parallel.
    #[inline]
    fn across(&self, axis: usize, radius: T) -> [T; 2] {
        if self.is_parallel {
            [radius * self.scale[axis] * T::from_f64(ROOM) + T::from_f64(1e-6); 2]
        } else {
            self.side_lengths(axis).map(|length| radius * length * T::from_f64(ROOM))
        }
    }

    /// The lengths of the normals of an axis' side planes in a perspective.
    #[inline]
    fn side_lengths(&self, axis: usize) -> [T; 2] {
        let scale = self.scale[axis];
        [T::one(), -T::one()].map(|side| {
            let along = side + self.center[axis];
            (scale * scale + along * along).sqrt()
        })
    }

    /// The depth of the middle of a sphere of radius 1 that touches the nearest side planes of a perspective and lies in
    /// the middle of the picture.
    #[cfg(feature = "ecs")]
    fn steepest_side(&self) -> T {
        // On the ray through the middle of the picture both planes of an axis are depth/length away.
        [0, 1].into_iter().flat_map(|axis| self.side_lengths(axis)).fold(T::zero(), T::max)
    }

    /// From where to where a box reaches along an axis on the picture, as −1 to 1; it holds the points that are up to
    /// `reach` from `offset` along the axis, at depths up to `depth.reach` from the middle. `None` where it is beside the
    /// picture.
    pub fn span(&self, axis: usize, (offset, reach): (T, T), depth: &DepthSpan<T>) -> Option<[T; 2]> {
        let (scale, center) = (self.scale[axis], self.center[axis]);
        let (low, high) = (offset - reach, offset + reach);
        if self.is_parallel {
            return Some([scale * low + center, scale * high + center]);
        }
        let (nearest, farthest) = (depth.middle - depth.reach, depth.middle + depth.reach);
        if nearest > T::from_f64(1e-3) * depth.radius && nearest > T::zero() {
            let low = scale * low / if low < T::zero() { nearest } else { farthest };
            let high = scale * high / if high < T::zero() { farthest } else { nearest };
            return Some([low + center, high + center]);
        }
        // It surrounds the eye, or nearly: only the side planes can leave it out.
        let at = scale * offset + center * depth.middle;
        let lengths = self.side_lengths(axis).map(|length| depth.radius * length * T::from_f64(1.0001));
        let beyond = -at - depth.middle > lengths[0] || at - depth.middle > lengths[1];
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

    /// How many pixels a length of 1 across the view takes where w is 1, in a picture of this many columns and rows; along
    /// the axis on which they are more, where pixels are not square.
    pub fn pixels_at_unit_w(&self, [columns, rows]: [T; 2]) -> T {
        let across = |axis: usize, count: T| T::from_f64(0.5) * self.scale[axis] * count;
        let (x, y) = (across(0, columns), across(1, rows));
        // Of square pixels both are one number but for rounding.
        if x > y * T::from_f64(ROOM) { x } else { y }
    }

    /// The size of a pixel at a depth, in units of eye space, in a picture of this many columns and rows; the smaller side
    /// of one that is not square.
    pub fn pixel_size(&self, depth: T, size: [T; 2]) -> T {
        self.w(depth) / self.pixels_at_unit_w(size)
    }

    /// The angle between the rays of neighbouring pixels where the axis of the view meets the picture, in radians; the
    /// smaller one where pixels are not square.
    pub fn pixel_angle(&self, size: [T; 2]) -> T {
        if self.is_parallel { T::zero() } else { self.pixels_at_unit_w(size).recip() }
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
        let one = T::one();
        let nearest = (-center[2] - radius).max(self.near);
        let aside = (center[0] * center[0] + center[1] * center[1]).sqrt() + radius;
        let aside2 = aside * aside / (nearest * nearest);
        // The slopes of the rays through the corner that is farthest from the axis.
        let [x2, y2] = [0, 1].map(|axis| {
            let (scale, end) = (self.scale[axis], one + self.center[axis].abs());
            end * end / (scale * scale)
        });
        let slope2 = aside2.min(x2 + y2);
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
