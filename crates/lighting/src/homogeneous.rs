//! Light positions in homogeneous coordinates: w = 0 is a direction, any other w a point.

use glam::{Vec3, Vec4};

use crate::direction::direction;
use crate::invalid::{Fields, InvalidValue, Problem};

/// The homogeneous position of a light, as `GL_POSITION` of OpenGL.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightPlace {
    /// w ≠ 0: the point xyz/w.
    Point(Vec3),
    /// w = 0: infinitely far away in this direction, *toward* the light, unit length.
    Directional(Vec3),
}

/// The place of a light at the homogeneous position (x, y, z, w).
///
/// # Errors
/// A coordinate is not finite, all four are 0, or xyz/w lies beyond the range of `f32`.
pub fn from_homogeneous(position: Vec4) -> Result<LightPlace, InvalidValue> {
    let refused = || {
        let problem = Problem::NotHomogeneous { value: position.to_array() };
        Fields::for_owner("Light").error("position", problem)
    };
    if !position.is_finite() {
        return Err(refused());
    }
    let xyz = position.truncate();
    if position.w == 0.0 {
        return direction(xyz, "Light", "position").map(LightPlace::Directional).map_err(|_| refused());
    }
    let point = xyz / position.w;
    if point.is_finite() { Ok(LightPlace::Point(point)) } else { Err(refused()) }
}

impl TryFrom<Vec4> for LightPlace {
    type Error = InvalidValue;

    fn try_from(position: Vec4) -> Result<Self, InvalidValue> {
        from_homogeneous(position)
    }
}

#[cfg(feature = "ecs")]
impl LightPlace {
    /// The transform of an entity whose light is to be here: at the point, or shining away from the direction.
    pub fn transform(self) -> bevy_transform::components::Transform {
        use crate::direction::rotation_along;
        use bevy_transform::components::Transform;

        match self {
            Self::Point(point) => Transform::from_translation(point),
            // A `Directional` from outside may hold 0; then there is nothing to turn to.
            Self::Directional(toward) => Transform::from_rotation(rotation_along(-toward).unwrap_or_default()),
        }
    }
}
