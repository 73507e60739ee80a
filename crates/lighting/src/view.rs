//! Views: the direction from which a model is seen, and a camera whose picture it fills.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, PI};

use crate::choices::{Choice, Choices};

#[cfg(feature = "ecs")]
pub use framing::{Framing, TightFit};

/// The direction from which a model is seen, by two angles. Front is the side toward +Z where +Y is up, as in glTF, and
/// the side toward −Y where +Z is up, as in CAD; right is the side toward +X in both.
///
/// ```
/// use std::str::FromStr;
/// use halfway_lighting::{Choices, View};
///
/// assert_eq!("right".parse::<View>(), Ok(View::RIGHT));
/// assert_eq!("90,0".parse::<View>(), Ok(View::RIGHT));
/// assert_eq!(View::from_key("iso"), Some(View::ISO));
/// assert!(View::from_str("rigth").unwrap_err().contains("front, back, left, right, top, bottom, iso"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The angle about the upright axis, from the front toward the right side, in radians; any finite number. Default
    /// 30°.
    pub azimuth: f32,
    /// The angle above the ground, in radians, −π/2 (from below) to π/2 (from above). Default 20°.
    pub elevation: f32,
}

/// From the front, 30° from the right and 20° from above.
impl Default for View {
    fn default() -> Self {
        Self { azimuth: FRAC_PI_6, elevation: PI / 9.0 }
    }
}

impl View {
    /// From the front.
    pub const FRONT: Self = Self { azimuth: 0.0, elevation: 0.0 };
    /// From behind.
    pub const BACK: Self = Self { azimuth: PI, elevation: 0.0 };
    /// From the left side: the front is at the right of the picture.
    pub const LEFT: Self = Self { azimuth: -FRAC_PI_2, elevation: 0.0 };
    /// From the right side: the front is at the left of the picture.
    pub const RIGHT: Self = Self { azimuth: FRAC_PI_2, elevation: 0.0 };
    /// From above: the front is at the lower edge of the picture.
    pub const TOP: Self = Self { azimuth: 0.0, elevation: FRAC_PI_2 };
    /// From below: the front is at the upper edge of the picture.
    pub const BOTTOM: Self = Self { azimuth: 0.0, elevation: -FRAC_PI_2 };
    /// Between front, right and top, equally far from each: under an orthographic projection the isometric view.
    pub const ISO: Self = Self { azimuth: FRAC_PI_4, elevation: 0.615_479_7 };
}

const fn named(value: View, key: &'static str, meaning: &'static str) -> Choice<View> {
    Choice { value, key, name: key, meaning }
}

impl Choices for View {
    const CHOICES: &'static [Choice<Self>] = &[
        named(Self::FRONT, "front", "From the front: the side toward +Z, or −Y where Z is up."),
        named(Self::BACK, "back", "From behind."),
        named(Self::LEFT, "left", "From the left side, that toward −X."),
        named(Self::RIGHT, "right", "From the right side, that toward +X."),
        named(Self::TOP, "top", "From above."),
        named(Self::BOTTOM, "bottom", "From below."),
        named(Self::ISO, "iso", "Between front, right and top, equally far from each."),
    ];
}

/// A name, or azimuth and elevation in degrees, such as `30,20`.
impl std::str::FromStr for View {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let angle = |text: &str| text.trim().parse::<f32>().ok().filter(|angle| angle.is_finite());
        let angles = || {
            let (azimuth, elevation) = text.split_once(',')?;
            let elevation = angle(elevation).filter(|angle| (-90.0..=90.0).contains(angle))?;
            Some(Self { azimuth: angle(azimuth)?.to_radians(), elevation: elevation.to_radians() })
        };
        Self::from_key(text).or_else(angles).ok_or_else(|| {
            let names: Vec<&str> = Self::CHOICES.iter().map(|choice| choice.key).collect();
            let names = names.join(", ");
            format!("expected {names}, or azimuth and elevation in degrees, the second from -90 to 90, such as 30,20")
        })
    }
}

#[cfg(feature = "ecs")]
mod framing {
    use bevy_transform::components::Transform;
    use glam::{DMat3, DQuat, DVec3, Quat, Vec3};

    use super::View;
    use crate::equations::Transcendental;
    use crate::{Camera, Projection};

    /// Sine and cosine, exact at multiples of a right angle.
    fn sine_cosine(angle: f32) -> (f64, f64) {
        let exact = |x: f64| if (x - x.round()).abs() < 1e-7 { x.round() } else { x };
        (exact(f64::from(angle).sine()), exact(f64::from(angle).cosine()))
    }

    impl View {
        /// The rotation of a camera that sees a model from here, where `up` is the model's upright direction, of any
        /// length above 0; one of length 0 counts as +Y.
        ///
        /// The model's front follows from `up` by the smallest turn from +Y, which is about the x axis where ±Z is up,
        /// and about the z axis where ±X or −Y is.
        pub fn rotation(self, up: Vec3) -> Quat {
            let (sin, cos) = sine_cosine(self.azimuth);
            let (rise, level) = sine_cosine(self.elevation);
            let back = DVec3::new(sin * level, rise, cos * level);
            let right = DVec3::new(cos, 0.0, -sin);
            let upward = back.cross(right);
            let up = up.as_dvec3().normalize_or(DVec3::Y);
            let turn = if up.y < -1.0 + 1e-12 {
                DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0)
            } else {
                DQuat::from_rotation_arc(DVec3::Y, up)
            };
            let camera = DQuat::from_mat3(&DMat3::from_cols(right, upward, back));
            (turn * camera).normalize().as_quat()
        }
    }

    /// A camera's place before a model of which only the points are known, so that the model fills the picture:
    /// [`camera`](Self::camera).
    ///
    /// ```
    /// use glam::Vec3;
    /// use halfway_lighting::{Camera, Framing, Projection, View};
    ///
    /// // A plank, 4 long and 1 high, fills 90 % of the width of a picture of 2 : 1.
    /// let plank = [Vec3::new(-2.0, 0.0, 0.0), Vec3::new(2.0, 1.0, 0.0)];
    /// let framing = Framing { fit: 0.9, ..Framing::new(View::FRONT, Vec3::Y) };
    /// let (camera, transform) = framing.camera(Camera::orthographic(1.0), plank, 2.0);
    /// let Projection::Orthographic { height, .. } = camera.projection else { unreachable!() };
    /// assert!((height - 2.0 / 0.9).abs() < 1e-6);
    /// assert_eq!(transform.translation.truncate(), glam::Vec2::new(0.0, 0.5));
    /// ```
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Framing {
        /// The camera's rotation; it looks along its −Z axis.
        pub rotation: Quat,
        /// The share of the picture that the points fill in width or height, whichever is the tighter: above 0, at most
        /// 1. Default [`Framing::FIT`].
        pub fit: f32,
        /// The magnification about the middle of the picture, above 0; above 1 the edges of the model are cut. Default
        /// 1.
        pub zoom: f32,
    }

    impl Framing {
        /// The default share of the picture.
        pub const FIT: f32 = 0.9;

        /// From this view of a model with this upright direction; see [`View::rotation`].
        pub fn new(view: View, up: Vec3) -> Self {
            Self { rotation: view.rotation(up), fit: Self::FIT, zoom: 1.0 }
        }

        /// The camera and its place. `aspect` is the picture's width over its height; points that are not finite are
        /// left out.
        ///
        /// A perspective keeps its field of view, and `zoom` narrows it; an orthographic projection gets its height.
        /// Near planes are in front of all points, and there is no far plane. Without points, or where all are one, it
        /// is as if they were a unit apart.
        pub fn camera(
            &self,
            camera: Camera,
            points: impl IntoIterator<Item = Vec3>,
            aspect: f32,
        ) -> (Camera, Transform) {
            let points: Vec<DVec3> = points.into_iter().filter(|p| p.is_finite()).map(Vec3::as_dvec3).collect();
            let axes = DMat3::from_quat(self.rotation.as_dquat().normalize());
            let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
            let aspect = f64::from(aspect.clamp(1e-4, 1e4));
            let [fit, zoom] = [self.fit, self.zoom].map(|x| if x > 0.0 { f64::from(x) } else { 1.0 });
            let (place, projection) = match camera.projection {
                Projection::Orthographic { .. } => orthographic(&points, axes, aspect, fit * zoom),
                projection @ Projection::Perspective { .. } => {
                    let tan = (0.5 * projection.height_at(1.0_f64)) * fit;
                    let fitted = TightFit::new(&points, axes, [tan * aspect, tan]);
                    let least = fitted.center.abs().max_element() * 1e-5;
                    let distance = if fitted.distance > 0.0 { fitted.distance.max(least) } else { 3.0_f64.max(least) };
                    let near = ((distance - fitted.nearest) * 0.5).min(distance * 0.01);
                    let near = near.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32;
                    (fitted.target + axes[2] * distance, projection.with_near(near).zoomed(zoom as f32))
                }
            };
            let translation = place.clamp(DVec3::splat(f32::MIN.into()), DVec3::splat(f32::MAX.into())).as_vec3();
            let transform = Transform { translation, rotation: self.rotation, ..Transform::IDENTITY };
            (Camera { projection, ..camera }, transform)
        }
    }

    /// The place of an orthographic camera, and its projection.
    fn orthographic(points: &[DVec3], axes: [DVec3; 3], aspect: f64, share: f64) -> (DVec3, Projection) {
        let spans = axes.map(|axis| {
            let along = points.iter().map(|p| p.dot(axis));
            let (least, most) = along.fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(x), most.max(x)));
            if least <= most { (least, most) } else { (-0.5, 0.5) }
        });
        let [width, height, depth] = spans.map(|(least, most)| most - least);
        let needed = height.max(width / aspect);
        let shown = if needed > 0.0 { needed } else { 1.0 } / share;
        let [x, y, _] = spans.map(|(least, most)| 0.5 * (least + most));
        // Well in front of everything, also after rounding.
        let z = spans[2].1 + 0.5 * depth.max(shown) + spans[2].1.abs() * 1e-5;
        let height = shown.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32;
        (axes[0] * x + axes[1] * y + axes[2] * z, Projection::orthographic(height))
    }

    /// The nearest place of a perspective camera from which points lie within its field of view.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct TightFit {
        /// The middle of the box around the points.
        pub center: DVec3,
        /// The point on the camera's axis whose distance is [`distance`](Self::distance), at the depth of the middle of
        /// the points.
        pub target: DVec3,
        /// The least distance of the camera from `target`; 0 where all points are one.
        pub distance: f64,
        /// How much nearer than `target` the nearest point is, along the view.
        pub nearest: f64,
    }

    impl TightFit {
        /// For points seen by a camera with these right, upward and backward axes of unit length, and the tangents of
        /// the half angles to the sides and up. Without points it is for the origin.
        pub fn new(points: &[DVec3], [right, up, back]: [DVec3; 3], [tan_x, tan_y]: [f64; 2]) -> Self {
            let first = points.first().copied().unwrap_or(DVec3::ZERO);
            let (min, max) = points.iter().fold((first, first), |(min, max), &p| (min.min(p), max.max(p)));
            let center = (min + max) * 0.5;
            let points = if points.is_empty() { &[DVec3::ZERO] } else { points };
            let (aside, distance_x) = fit(points, center, right, back, tan_x);
            let (above, distance_y) = fit(points, center, up, back, tan_y);
            Self {
                center,
                target: center + right * aside + up * above,
                distance: distance_x.max(distance_y),
                nearest: points.iter().map(|p| (*p - center).dot(back)).fold(0.0, f64::max),
            }
        }
    }

    /// The offset from `center` along `axis`, and the least distance along `back`, of an eye, so that the points lie
    /// within the half angle of this tangent to both sides of its line of sight.
    ///
    /// A point (x, z) is inside when |x − c| ≤ (d − z)·tan, that is, when c + d·tan is at least x + z·tan and d·tan − c
    /// at least z·tan − x. The largest of each over all points decides, and half their sum is the least d·tan.
    fn fit(points: &[DVec3], center: DVec3, axis: DVec3, back: DVec3, tan: f64) -> (f64, f64) {
        let (right, left) = points.iter().fold((f64::MIN, f64::MIN), |(right, left), p| {
            let (x, z) = ((*p - center).dot(axis), (*p - center).dot(back));
            (right.max(z * tan + x), left.max(z * tan - x))
        });
        ((right - left) * 0.5, (right + left) * 0.5 / tan)
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use crate::choices::Choices;

        /// The camera's right, upward and backward axes.
        fn axes(view: View, up: Vec3) -> [Vec3; 3] {
            let rotation = view.rotation(up);
            [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| rotation * axis)
        }

        #[test]
        fn views_look_from_their_side() {
            let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
            for (view, up, expected) in [
                (View::FRONT, y, [x, y, z]),
                (View::BACK, y, [-x, y, -z]),
                (View::RIGHT, y, [-z, y, x]),
                (View::LEFT, y, [z, y, -x]),
                (View::TOP, y, [x, -z, y]),
                (View::BOTTOM, y, [x, z, -y]),
                (View::FRONT, z, [x, z, -y]),
                (View::RIGHT, z, [y, z, x]),
                (View::TOP, z, [x, y, z]),
                (View::FRONT, -z, [x, -z, y]),
                (View::FRONT, x, [-y, x, z]),
                (View::FRONT, -x, [y, -x, z]),
                (View::FRONT, -y, [-x, -y, z]),
            ] {
                for (found, expected) in axes(view, up).into_iter().zip(expected) {
                    assert!(found.distance(expected) < 1e-6, "{view:?} {up}: {found} {expected}");
                }
            }
            let [_, _, back] = axes(View::ISO, y);
            assert!(back.distance(Vec3::ONE.normalize()) < 1e-6);
        }

        /// Where a point is in the picture, ±1 at its edges.
        fn in_picture(camera: &Camera, place: &Transform, aspect: f32, p: Vec3) -> [f32; 2] {
            let eye = place.rotation.inverse() * (p - place.translation);
            let half = 0.5 * camera.projection.height_at(-eye.z);
            assert!(-eye.z > camera.projection.near(), "{eye} is before the near plane");
            [eye.x / (half * aspect), eye.y / half]
        }

        #[test]
        fn the_points_fill_the_share_that_is_asked_for() {
            let corners = |min: Vec3, max: Vec3| {
                (0..8).map(move |i: u32| {
                    let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
                    Vec3::new(pick(0), pick(1), pick(2))
                })
            };
            let boxes = [
                (Vec3::splat(-1.0), Vec3::splat(1.0)),
                (Vec3::new(-5.0, 0.0, -5.0), Vec3::new(5.0, 0.0, 5.0)),
                (Vec3::new(100.0, 7.0, -3.0), Vec3::new(101.0, 29.0, -2.0)),
            ];
            let views = View::CHOICES.iter().map(|choice| choice.value).chain([View::default()]);
            for view in views {
                for (min, max) in boxes {
                    for camera in [Camera::default(), Camera::orthographic(1.0)] {
                        for (aspect, fit, zoom) in [(0.4, 1.0, 1.0), (1.0, 0.9, 1.0), (2.0, 0.5, 1.5)] {
                            let framing = Framing { fit, zoom, ..Framing::new(view, Vec3::Y) };
                            let (camera, place) = framing.camera(camera, corners(min, max), aspect);
                            assert_eq!(camera.validate(), Ok(()));
                            let seen = corners(min, max).map(|p| in_picture(&camera, &place, aspect, p));
                            let far =
                                |axis: usize, sign: f32| seen.clone().map(|p| p[axis] * sign).fold(f32::MIN, f32::max);
                            let sides = [far(0, 1.0), far(0, -1.0), far(1, 1.0), far(1, -1.0)];
                            let most = sides.into_iter().fold(f32::MIN, f32::max);
                            let error = (most - fit * zoom).abs();
                            assert!(error < 1e-4, "{view:?} {min} {camera:?} {aspect}: {sides:?} {fit} {zoom}");
                        }
                    }
                }
            }
        }

        #[test]
        fn nothing_and_one_point_are_framed() {
            for camera in [Camera::default(), Camera::orthographic(1.0)] {
                for points in [vec![], vec![Vec3::ZERO], vec![Vec3::splat(1e9)], vec![Vec3::NAN]] {
                    let (camera, place) = Framing::new(View::ISO, Vec3::Y).camera(camera, points, 1.0);
                    assert_eq!(camera.validate(), Ok(()));
                    assert!(place.translation.is_finite() && place.rotation.is_finite());
                }
            }
        }
    }
}
