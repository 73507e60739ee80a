//! The tolerance of a picture: its allowed difference from the exact one.

use crate::field::{Described, Field, validate};
use crate::invalid::{Fields, InvalidValue};
use crate::range::Range;

/// The meaning of each number of [`Tolerance`], for its documentation and for the schema of scene files.
macro_rules! meaning {
    (steps) => {
        "How much light may be left out of a pixel's channel, in steps of 1/255 of the output."
    };
    (pixels) => {
        "How far a point of a surface may move on the picture, in pixels; 0 draws every triangle."
    };
}

/// The allowed difference of a picture from the exact one, which has every triangle and every light. Default: not at
/// all.
///
/// `steps` allows lights to be left out that are too weak to show: for each patch of a surface the weakest, as long as
/// a proven bound of their *sum* changes no channel of any pixel by more than `steps`/255 of the written picture.
/// Lights that add nothing, because they are out of range, behind the surface or outside of their cone, are always left
/// out. In floating-point pictures no others are.
///
/// `pixels` allows coarser triangles where a mesh is finer than the picture: no point is meant to move by more than
/// that. This is an estimate, not a bound. Objects that are shaded once a vertex or a triangle keep every triangle, since
/// there the triangles show; so do blended objects and meshes with tangents.
///
/// On an object it wins over the [`ViewTolerance`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
pub struct Tolerance {
    #[doc = meaning!(steps)]
    ///
    /// Finite, 0 or more. Default 0.
    pub steps: f32,
    #[doc = meaning!(pixels)]
    ///
    /// Finite, 0 or more. Default 0.
    pub pixels: f32,
}

impl Tolerance {
    /// Every triangle is drawn, and every light that adds anything. The default.
    pub const EXACT: Self = Self { steps: 0.0, pixels: 0.0 };

    /// The given number of steps, with every mesh in full detail.
    pub const fn steps(steps: f32) -> Self {
        Self { steps, pixels: 0.0 }
    }

    /// Checks both numbers.
    ///
    /// # Errors
    /// Returns [`InvalidValue`] if one is negative or not finite.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        validate(self, Fields::for_owner("Tolerance"))
    }
}

impl Described for Tolerance {
    const FIELDS: &'static [Field<Self>] = &[
        Field::number("steps", Range::NON_NEGATIVE, meaning!(steps), |it| &mut it.steps),
        Field::number("pixels", Range::NON_NEGATIVE, meaning!(pixels), |it| &mut it.pixels),
    ];
}

/// The tolerance of objects that have none of their own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::resource::Resource))]
pub struct ViewTolerance(pub Tolerance);
