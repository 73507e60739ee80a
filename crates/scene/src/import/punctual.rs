//! Lights of glTF's `KHR_lights_punctual`.

use core::f32::consts::FRAC_1_PI;

use bevy_color::LinearRgba;
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use halfway_lighting::{
    Attenuation, Cone, DirectionalLight, Fields, InvalidValue, PointLight, SpotLight, rotation_along,
};
use halfway_mesh::{SourceLight, SourceLightKind};

use halfway_lighting::LightComponent;

/// The scale under which a shaded value is the radiance that glTF defines: 1/π.
///
/// glTF's diffuse reflection is c/π times the light that arrives; the classic equation has no π, so the light carries
/// it.
pub const RADIANCE_SCALE: f32 = FRAC_1_PI;

/// The component for a punctual light.
///
/// Diffuse and specular color are color·intensity·`scale`, ambient is black. Point and spot lights fall off as 1/d²
/// (attenuation 0, 0, 1; the metre is the world unit), range and inner and outer angle are the file's: their formulas
/// are the extension's own. `scale` brings candela and lux to this project's unitless colors. [`RADIANCE_SCALE`] keeps
/// the file's photometry, which is right for files written for an exposure of 1; for a file in real candela multiply it
/// by the exposure that the scene needs.
///
/// # Errors
/// A number is outside its range or not finite, as `PunctualLight.intensity: …`.
pub fn from_punctual(source: &SourceLight, scale: f32) -> Result<LightComponent, InvalidValue> {
    let fields = Fields::for_owner("PunctualLight");
    fields.channels("color", source.color)?;
    fields.non_negative("intensity", source.intensity)?;
    fields.non_negative("scale", scale)?;
    let strength = f64::from(source.intensity) * f64::from(scale);
    let [red, green, blue] = source.color.map(|channel| (f64::from(channel) * strength) as f32);
    fields.channels("color·intensity·scale", [red, green, blue])?;
    let color = LinearRgba::rgb(red, green, blue);
    if source.kind == SourceLightKind::Directional {
        return Ok(LightComponent::Directional(DirectionalLight::new(color)));
    }
    let light = PointLight { attenuation: Attenuation::INVERSE_SQUARE, range: source.range, ..PointLight::new(color) };
    light.validate()?;
    match source.kind {
        SourceLightKind::Spot { inner, outer } => {
            let spot = SpotLight { light, cone: Cone { cutoff: outer, inner: Some(inner), exponent: 0.0 } };
            spot.validate().map(|()| LightComponent::Spot(spot))
        }
        SourceLightKind::Directional | SourceLightKind::Point => Ok(LightComponent::Point(light)),
    }
}

/// The light that a model file describes, scaled by [`RADIANCE_SCALE`], and its place in the model. The frame of a
/// light may scale, which has no meaning for one: position and direction are taken from it.
///
/// # Errors
/// [`InvalidValue`] for a number out of its range, and for a frame that leaves no direction.
pub fn model_light(source: &SourceLight) -> Result<(LightComponent, Transform), InvalidValue> {
    let component = from_punctual(source, RADIANCE_SCALE)?;
    let mut transform = Transform::from_translation(source.world_from_light.w_axis.truncate());
    // A point light has no direction that could be wrong.
    if source.kind != SourceLightKind::Point {
        transform.rotation = rotation_along(source.world_from_light.transform_vector3(Vec3::NEG_Z))?;
    }
    Ok((component, transform))
}
