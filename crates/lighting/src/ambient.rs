//! The ambient light of a scene.

use crate::LinearRgba;

use crate::equations::{Real, rgb};
use crate::invalid::{Fields, InvalidValue};

/// Ga: ambient light that no light source brings. Every material reflects it by its ambient colour.
///
/// Linear RGB, 0 to 10¹²; alpha is ignored. Default 0.1 grey.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::resource::Resource))]
pub struct GlobalAmbient(pub LinearRgba);

impl GlobalAmbient {
    /// Checks the colour.
    ///
    /// # Errors
    /// The first channel that is negative, above 10¹² or not a number.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        Fields::for_owner("GlobalAmbient").color("0", self.0)
    }
}

impl GlobalAmbient {
    /// Ga.
    pub fn ga<T: Real>(&self) -> [T; 3] {
        rgb(self.0)
    }
}

impl Default for GlobalAmbient {
    fn default() -> Self {
        Self(LinearRgba::rgb(0.1, 0.1, 0.1))
    }
}
