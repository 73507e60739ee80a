//! glTF's `KHR_lights_punctual`.

use core::f32::consts::FRAC_1_PI;

use bevy_color::LinearRgba;

use crate::invalid::{Fields, InvalidValue};
use crate::{Attenuation, Cone, DirectionalLight, PointLight, SpotLight};

/// The scale under which a shaded value is the radiance that glTF defines: 1/π.
///
/// glTF's diffuse reflection is c/π times the light that arrives; the classic equation has no π, so the light carries
/// it.
pub const RADIANCE_SCALE: f32 = FRAC_1_PI;

/// The numbers of one punctual light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunctualNumbers {
    /// `type`, with the cone of a spot.
    pub kind: PunctualKind,
    /// `color`: linear RGB. The extension's default is white.
    pub color: [f32; 3],
    /// `intensity`: candela for point and spot lights, lux for directional ones. The extension's default is 1.
    pub intensity: f32,
    /// `range` in metres; `None` for no end. Ignored for directional lights.
    pub range: Option<f32>,
}

/// The kinds of punctual light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PunctualKind {
    /// Parallel rays.
    Directional,
    /// All directions.
    Point,
    /// A cone.
    Spot {
        /// `innerConeAngle` in radians, 0 to `outer`. The extension's default is 0.
        inner: f32,
        /// `outerConeAngle` in radians, 0 to π/2. The extension's default is π/4.
        outer: f32,
    },
}

/// A punctual light as this crate's component. Like glTF's, it shines along its entity's local −Z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PunctualLight {
    /// Parallel rays.
    Directional(DirectionalLight),
    /// All directions.
    Point(PointLight),
    /// A cone.
    Spot(SpotLight),
}

/// The component for a punctual light.
///
/// Diffuse and specular colour are color·intensity·`scale`, ambient is black. Point and spot lights fall off as 1/d²
/// (attenuation 0, 0, 1; the metre is the world unit), range and inner and outer angle are the file's: their formulas
/// are the extension's own. `scale` brings candela and lux to this project's unitless colours. [`RADIANCE_SCALE`] keeps
/// the file's photometry, which is right for files written for an exposure of 1; for a file in real candela multiply it
/// by the exposure that the scene needs.
///
/// # Errors
/// A number is outside its range or not finite, as `PunctualLight.intensity: …`.
pub fn from_punctual(numbers: &PunctualNumbers, scale: f32) -> Result<PunctualLight, InvalidValue> {
    let fields = Fields::of("PunctualLight");
    fields.channels("color", numbers.color)?;
    fields.non_negative("intensity", numbers.intensity)?;
    fields.non_negative("scale", scale)?;
    let strength = f64::from(numbers.intensity) * f64::from(scale);
    let [red, green, blue] = numbers.color.map(|channel| (f64::from(channel) * strength) as f32);
    fields.channels("color·intensity·scale", [red, green, blue])?;
    let color = LinearRgba::rgb(red, green, blue);
    if numbers.kind == PunctualKind::Directional {
        return Ok(PunctualLight::Directional(DirectionalLight::from_color(color)));
    }
    let light =
        PointLight { attenuation: Attenuation::INVERSE_SQUARE, range: numbers.range, ..PointLight::from_color(color) };
    light.validate()?;
    match numbers.kind {
        PunctualKind::Spot { inner, outer } => {
            let spot = SpotLight { light, cone: Cone { cutoff: outer, inner: Some(inner), exponent: 0.0 } };
            spot.validate().map(|()| PunctualLight::Spot(spot))
        }
        PunctualKind::Directional | PunctualKind::Point => Ok(PunctualLight::Point(light)),
    }
}
