//! The whole equation, from its parts.

use super::Real;
use super::scene::{Coefficients, Eye, ShadedPoint};
use super::vector::{add, mul, toward};
use crate::Reflectance;
use crate::lights::{Light, LightSource};

/// A light counts as being at the lit point p where its distance is at most this share of ‖p‖: its direction is n and
/// its distance 0 there. Positions in eye space, made by a matrix in `f32`, are known to about half of this share of
/// their distance from the eye, so a nearer light has no direction but that of rounding errors.
pub const COINCIDENT: f32 = 2e-6;

/// A light counts as in the plane of a surface, and so as behind it, where its height over that is at most this share
/// of ‖p‖ and its distance together. In `f32` heights are known to no more: rounding would decide, pixel by pixel, on
/// which side a light is that stands in a floor.
pub const GRAZING: f32 = 5e-7;

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

/// What one light brings to a point, before the material: its colours, weakened. The specular part depends on the
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

/// What one light adds to a point, term by term. Their sum is [`light_contribution`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightTerms<T> {
    /// ka·La, weakened where the light attenuates its ambient.
    pub ambient: [T; 3],
    /// att·spot·kd·Ld·max(n·l, 0).
    pub diffuse: [T; 3],
    /// att·spot·ks·Ls·S.
    pub specular: [T; 3],
}

/// Direction and strength of a light at a point; `None` for light from all around. Where a light is at the point itself
/// ([`COINCIDENT`]) l is n and the distance 0.
pub fn incidence<T: Real>(surface: &ShadedPoint<T>, light: &Light<T>) -> Option<Incidence<T>> {
    light.incidence(surface)
}

/// v: the unit vector from the surface toward the viewer. Where a local eye is at the surface itself v is n.
pub fn view_vector<T: Real>(surface: &ShadedPoint<T>, view: &Eye<T>) -> [T; 3] {
    match *view {
        Eye::Local(eye) => toward(surface.position, eye).0.unwrap_or(surface.normal),
        Eye::Infinite(v) => v,
    }
}

/// What one light brings to a point whose material has this shininess.
pub fn irradiance<T: Real>(
    surface: &ShadedPoint<T>,
    light: &Light<T>,
    view: &Eye<T>,
    reflectance: Reflectance,
    shininess: T,
) -> Irradiance<T> {
    light.irradiance(surface, view, reflectance, shininess)
}

/// What a material gives back of what lights bring: `ka·ambient + kd·diffuse + ks·specular`.
pub fn reflected<T: Real>(irradiance: &Irradiance<T>, material: &Coefficients<T>) -> [T; 3] {
    let LightTerms { ambient, diffuse, specular } = reflected_terms(irradiance, material);
    add(ambient, add(diffuse, specular))
}

fn reflected_terms<T: Real>(irradiance: &Irradiance<T>, material: &Coefficients<T>) -> LightTerms<T> {
    LightTerms {
        ambient: mul(material.ka, irradiance.ambient),
        diffuse: mul(material.kd, irradiance.diffuse),
        specular: mul(material.ks, irradiance.specular),
    }
}

/// The ambient, diffuse and specular term that one light adds at a point.
pub fn light_terms<T: Real>(
    surface: &ShadedPoint<T>,
    material: &Coefficients<T>,
    light: &Light<T>,
    view: &Eye<T>,
    reflectance: Reflectance,
) -> LightTerms<T> {
    reflected_terms(&irradiance(surface, light, view, reflectance, material.shininess), material)
}

/// What one light adds at a point: the summand of the equation.
pub fn light_contribution<T: Real>(
    surface: &ShadedPoint<T>,
    material: &Coefficients<T>,
    light: &Light<T>,
    view: &Eye<T>,
    reflectance: Reflectance,
) -> [T; 3] {
    reflected(&irradiance(surface, light, view, reflectance, material.shininess), material)
}

/// I: the colour of a point under all lights, linear RGB, unclamped.
///
/// Never NaN, infinite or negative where the components that the arguments came from pass `validate()`, positions are
/// finite and `surface.normal` has unit length (in `f32` for up to 10⁸ lights at the largest values).
pub fn shade<T: Real>(
    surface: &ShadedPoint<T>,
    material: &Coefficients<T>,
    lights: &[Light<T>],
    global_ambient: [T; 3],
    view: &Eye<T>,
    reflectance: Reflectance,
) -> [T; 3] {
    let unlit = add(material.ke, mul(material.ka, global_ambient));
    lights.iter().fold(unlit, |sum, light| add(sum, light_contribution(surface, material, light, view, reflectance)))
}
