//! The upright direction of what a camera sees.

use glam::Vec3;

use crate::invalid::{Fields, InvalidValue, Problem};

/// The direction that is upright in what a camera sees, as a component of the camera: of any length above 0. Default +Y.
///
/// A window's orbit camera turns about it and keeps it up in the picture, and the ground of [`Show`](crate::Show) lies
/// across it. It does not turn the camera by itself: where that looks is its `Transform`'s.
///
/// ```
/// use bevy_ecs::world::World;
/// use glam::Vec3;
/// use halfway_lighting::{Camera, Upright};
///
/// let mut world = World::new();
/// // Parts for machines stand on z.
/// world.spawn((Camera::default(), Upright(Vec3::Z)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
pub struct Upright(pub Vec3);

impl Default for Upright {
    fn default() -> Self {
        Self(Vec3::Y)
    }
}

impl Upright {
    /// Checks the direction.
    ///
    /// # Errors
    /// It has no length, or is not finite.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        if self.0.is_finite() && self.0 != Vec3::ZERO {
            return Ok(());
        }
        Err(Fields::for_owner("Upright").error("0", Problem::NoDirection { value: self.0.to_array() }))
    }
}
