//! The effect of an opacity below 1: none, a cut, or blending.

use crate::invalid::{Fields, InvalidValue};

/// The effect of an opacity below 1 on a surface: none, a cut, or blending. Default: none, the surface is opaque.
///
/// The opacity is the material's, times that of the vertices' colours and of images, where there are any. A cutoff is a
/// finite number, 0 or more; 0 cuts nothing away.
///
/// ```
/// use bevy_ecs::world::World;
/// use halfway_lighting::{AlphaMode, Material};
///
/// let mut world = World::new();
/// world.spawn((Material { opacity: 0.5, ..Material::JADE }, AlphaMode::Blend));
/// world.spawn((Material::BRASS, AlphaMode::Mask(AlphaMode::CUTOFF)));
/// assert!(AlphaMode::MaskAndBlend(0.1).blends());
/// assert_eq!(AlphaMode::MaskAndBlend(0.1).cutoff(), Some(0.1));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
pub enum AlphaMode {
    /// The surface is opaque, whatever its opacity.
    #[default]
    Opaque,
    /// The surface is cut out: it is not there where its opacity is below this cutoff, and opaque elsewhere.
    Mask(f32),
    /// The surface is blended by its opacity: drawn after the opaque ones, sorted back to front.
    Blend,
    /// The surface is cut out as by [`Mask`](Self::Mask), and blended where it is there.
    MaskAndBlend(f32),
}

impl AlphaMode {
    /// The cutoff of masks that name none, as in glTF 2.0 (§3.9.4).
    pub const CUTOFF: f32 = 0.5;

    /// Cut out below `cutoff`, if there is one, and blended or not.
    pub const fn new(cutoff: Option<f32>, blend: bool) -> Self {
        match (cutoff, blend) {
            (None, false) => Self::Opaque,
            (Some(cutoff), false) => Self::Mask(cutoff),
            (None, true) => Self::Blend,
            (Some(cutoff), true) => Self::MaskAndBlend(cutoff),
        }
    }

    /// The opacity below which the surface is not there, of those that are cut out.
    pub const fn cutoff(self) -> Option<f32> {
        match self {
            Self::Opaque | Self::Blend => None,
            Self::Mask(cutoff) | Self::MaskAndBlend(cutoff) => Some(cutoff),
        }
    }

    /// Whether the surface is blended.
    pub const fn blends(self) -> bool {
        matches!(self, Self::Blend | Self::MaskAndBlend(_))
    }

    /// Checks the cutoff.
    ///
    /// # Errors
    /// Returns [`InvalidValue`] if the cutoff is negative or not finite.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        self.cutoff().map_or(Ok(()), |cutoff| Fields::for_owner("AlphaMode").non_negative("cutoff", cutoff))
    }
}
