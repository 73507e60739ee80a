//! Light as it arrives at a point, before the material.

use super::Real;
use super::scene::{Eye, ShadedPoint};
use super::vector::toward;

/// A light counts as being at the lit point p where its distance is at most this share of ‖p‖: its direction is n and
/// its distance 0 there. Positions in eye space, made by a matrix in `f32`, are known to about half of this share of
/// their distance from the eye, so a nearer light has no direction but that of rounding errors.
pub const COINCIDENT: f32 = 2e-6;

/// A light counts as in the plane of a surface, and so as behind it, where its height over that is at most this share
/// of ‖p‖ and its distance together. In `f32` heights are known to no more: rounding would decide, pixel by pixel, on
/// which side a light is that stands in a floor.
pub const GRAZING: f32 = 5e-7;

/// The way of a light to a point: its direction, and what distance, range and cone leave of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival<T> {
    /// l, the unit vector from the point toward the light.
    pub l: [T; 3],
    /// d in world units; `None` of a directional light.
    pub distance: Option<T>,
    /// See [`Incidence::grazing`].
    pub grazing: T,
    /// `[a, b, c]` of the attenuation; `None` of a directional light.
    pub constants: Option<[T; 3]>,
    /// att, without the range: 1 of a directional light.
    pub attenuation: T,
    /// The factor of the range: 1 where there is none.
    pub window: T,
    /// The cosine of the angle between the axis of the cone and the ray to the point; `None` without a cone.
    pub cos_phi: Option<T>,
    /// spot: 1 without a cone.
    pub spot: T,
}

impl<T: Real> Arrival<T> {
    /// The direction, with attenuation, range and cone as one weight.
    pub fn incidence(&self) -> Incidence<T> {
        Incidence { l: self.l, grazing: self.grazing, weight: self.attenuation * self.window * self.spot }
    }
}

/// A light as it arrives at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence<T> {
    /// l, the unit vector from the point toward the light.
    pub l: [T; 3],
    /// Up to this n·l the light counts as in the plane of the surface, and as behind it: [`GRAZING`]·(1 + ‖p‖/d) of a
    /// light at a distance d, [`GRAZING`] of a directional one, 0 of one at the point.
    pub grazing: T,
    /// att·spot: attenuation, range window and cone together; 0 to [`ATTENUATION_MAX`](super::ATTENUATION_MAX).
    pub weight: T,
}

/// The light of one source at a point, before the material: its colours, weakened. The specular part depends on the
/// material's shininess.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Irradiance<T> {
    /// La, times att·spot where the light attenuates its ambient.
    pub ambient: [T; 3],
    /// att·spot·Ld·max(n·l, 0), and 0 unless n·l is above [`Incidence::grazing`].
    pub diffuse: [T; 3],
    /// att·spot·Ls·S, and 0 unless n·l is above that.
    pub specular: [T; 3],
}

/// v: the unit vector from the surface toward the viewer. Where a local eye is at the surface itself v is n.
pub fn view_vector<T: Real>(surface: &ShadedPoint<T>, view: &Eye<T>) -> [T; 3] {
    match *view {
        Eye::Local(eye) => toward(surface.position, eye).0.unwrap_or(surface.normal),
        Eye::Infinite(v) => v,
    }
}
