//! Directions of any length, and the rotation of a light that shines along one.

use glam::{Quat, Vec3};

use crate::equations::vector::normalize;
use crate::invalid::{Fields, InvalidValue, Problem};

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
