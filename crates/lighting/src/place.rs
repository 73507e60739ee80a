//! From an entity's transform to a light's place and back.

use bevy_math::{Quat, Vec3};
use bevy_transform::components::GlobalTransform;

use crate::equations::vector::normalize;
use crate::invalid::{Fields, InvalidValue, Problem};
use crate::lights::LightFrame;

/// The position of a light: the translation of its entity.
///
/// # Errors
/// A coordinate is not finite.
pub fn light_position(transform: &GlobalTransform) -> Result<Vec3, InvalidValue> {
    let position = transform.translation();
    if position.is_finite() {
        Ok(position)
    } else {
        let problem = Problem::NoPosition { value: position.to_array() };
        Err(Fields::for_owner("GlobalTransform").error("translation", problem))
    }
}

/// The direction in which a light shines: its entity's local −Z axis in world space, unit length.
///
/// # Errors
/// The axis has length 0 (a scale of 0 along it, here or in a parent) or is not finite.
pub fn light_direction(transform: &GlobalTransform) -> Result<Vec3, InvalidValue> {
    direction(-Vec3::from(transform.affine().matrix3.z_axis), "GlobalTransform", "local −Z axis")
}

/// The direction of an entity's local +Y axis in world space, unit length.
///
/// # Errors
/// The axis has length 0 (a scale of 0 along it, here or in a parent) or is not finite.
pub fn light_up(transform: &GlobalTransform) -> Result<Vec3, InvalidValue> {
    direction(Vec3::from(transform.affine().matrix3.y_axis), "GlobalTransform", "local +Y axis")
}

impl LightFrame for GlobalTransform {
    fn position(&self) -> Result<[f64; 3], InvalidValue> {
        light_position(self).map(|position| position.as_dvec3().to_array())
    }

    fn forward(&self) -> Result<[f64; 3], InvalidValue> {
        light_direction(self).map(|direction| direction.as_dvec3().to_array())
    }

    fn up(&self) -> Result<[f64; 3], InvalidValue> {
        light_up(self).map(|direction| direction.as_dvec3().to_array())
    }
}

/// The rotation that makes a light shine along `direction`: it turns −Z there by the shortest way.
///
/// The direction needs no unit length.
///
/// # Errors
/// The direction is 0 or not finite.
pub fn rotation_along(along: Vec3) -> Result<Quat, InvalidValue> {
    let along = direction(along, "Light", "direction")?;
    Ok(Quat::from_rotation_arc(Vec3::NEG_Z, along))
}

/// The unit vector along `value`, whatever its magnitude; glam's own normalisation underflows at 10⁻²³.
pub(crate) fn direction(value: Vec3, owner: &'static str, field: &str) -> Result<Vec3, InvalidValue> {
    normalize(value.to_array())
        .map(Vec3::from_array)
        .ok_or_else(|| Fields::for_owner(owner).error(field, Problem::NoDirection { value: value.to_array() }))
}
