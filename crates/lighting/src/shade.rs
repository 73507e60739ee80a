//! The whole equation, from its parts.

use crate::Reflectance;
use crate::equations::vector::{add, mul};
use crate::equations::{Coefficients, Eye, Incidence, Irradiance, Real, ShadedPoint};
use crate::lights::{Light, LightSource};

/// The terms that one light adds at a point. Their sum is [`light_contribution`].
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
/// ([`COINCIDENT`](crate::equations::COINCIDENT)) l is n and the distance 0.
pub fn incidence<T: Real>(surface: &ShadedPoint<T>, light: &Light<T>) -> Option<Incidence<T>> {
    light.incidence(surface)
}

/// The light that arrives at a point of a surface: before the material's reflectances, but with the shape of its
/// highlight.
pub fn irradiance<T: Real>(
    surface: &ShadedPoint<T>,
    light: &Light<T>,
    view: &Eye<T>,
    reflectance: Reflectance,
    material: &Coefficients<T>,
) -> Irradiance<T> {
    light.irradiance(surface, view, reflectance, material)
}

/// The reflected part of the light that arrives: `ka·ambient + kd·diffuse + ks·specular`.
pub fn reflected<T: Real>(irradiance: &Irradiance<T>, material: &Coefficients<T>) -> [T; 3] {
    let LightTerms { ambient, diffuse, specular } = reflected_terms(irradiance, material);
    add(ambient, add(diffuse, specular))
}

// ANCHOR: reflected_terms
fn reflected_terms<T: Real>(irradiance: &Irradiance<T>, material: &Coefficients<T>) -> LightTerms<T> {
    LightTerms {
        ambient: mul(material.ka, irradiance.ambient),
        diffuse: mul(material.kd, irradiance.diffuse),
        specular: mul(material.ks, irradiance.specular),
    }
}
// ANCHOR_END: reflected_terms

/// The ambient, diffuse and specular term that one light adds at a point.
pub fn light_terms<T: Real>(
    surface: &ShadedPoint<T>,
    material: &Coefficients<T>,
    light: &Light<T>,
    view: &Eye<T>,
    reflectance: Reflectance,
) -> LightTerms<T> {
    reflected_terms(&irradiance(surface, light, view, reflectance, material), material)
}

/// The light that one source adds at a point: the summand of the equation.
pub fn light_contribution<T: Real>(
    surface: &ShadedPoint<T>,
    material: &Coefficients<T>,
    light: &Light<T>,
    view: &Eye<T>,
    reflectance: Reflectance,
) -> [T; 3] {
    reflected(&irradiance(surface, light, view, reflectance, material), material)
}

// ANCHOR: shade
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
// ANCHOR_END: shade
