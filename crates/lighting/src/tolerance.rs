//! How far a picture may be off.

use bevy_ecs::component::Component;
use bevy_ecs::reflect::{ReflectComponent, ReflectResource};
use bevy_ecs::resource::Resource;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::field::{Described, Field, validate};
use crate::invalid::{Fields, InvalidValue};
use crate::range::Range;

/// What each number of [`Tolerance`] means, for its documentation and for the schema of scene files.
macro_rules! meaning {
    (steps) => {
        "How far a channel may be off, in steps of 1/255 of the output."
    };
    (pixels) => {
        "How far a point may move on the picture, in pixels; 0 draws every mesh as it is."
    };
}

/// How far what is drawn may be from the same with every triangle, every light and every term at its place; under
/// [`Shading::Auto`](crate::Shading::Auto) from Phong shading.
///
/// No channel of any pixel differs by more than `steps`/255 of the written picture, but for what moving the surface by
/// at most `pixels` on the picture explains. Roundings of what draws come on top. Lights left out and what `Auto`
/// shades at the vertices keep to proven bounds, and so does how far points move and normals turn on coarser triangles;
/// what interpolation between the corners of coarser triangles adds, under Gouraud and Phong shading, is an estimate of
/// the second order, at the terminator of the first; and a light that is nearer to a surface than those pixels may
/// change it by more, as its points also move in depth.
///
/// Half of `steps` is for coarser triangles, where there are any and `pixels` is above 0. Of the rest, lights that are
/// left out take as much as they can, under `Auto` no more than half of it; `Auto` takes what is left for terms that
/// are shaded at the vertices.
///
/// In pictures of floating point a step is 1/255 of linear intensity, and no light is left out but those that add
/// nothing.
///
/// On an object it wins over the [`ViewTolerance`].
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct Tolerance {
    #[doc = meaning!(steps)]
    ///
    /// Finite, 0 or more. Default 1.
    pub steps: f32,
    #[doc = meaning!(pixels)]
    ///
    /// Finite, 0 or more. Default ½.
    pub pixels: f32,
}

impl Tolerance {
    /// Only what adds nothing is left out: what is hidden, out of range or turned away.
    pub const EXACT: Self = Self { steps: 0.0, pixels: 0.0 };
    /// One step and half a pixel.
    pub const DEFAULT: Self = Self { steps: 1.0, pixels: 0.5 };
    /// Two steps and half a pixel: hardly seen side by side.
    pub const CLOSE: Self = Self { steps: 2.0, pixels: 0.5 };
    /// Eight steps and one pixel: for a look.
    pub const DRAFT: Self = Self { steps: 8.0, pixels: 1.0 };

    /// So many steps, with every mesh as it is.
    pub const fn steps(steps: f32) -> Self {
        Self { steps, pixels: 0.0 }
    }

    /// Checks both numbers.
    ///
    /// # Errors
    /// One is negative or not finite.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        validate(self, Fields::of("Tolerance"))
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Described for Tolerance {
    const FIELDS: &'static [Field<Self>] = &[
        Field::number("steps", Range::NON_NEGATIVE, meaning!(steps), |it| &mut it.steps),
        Field::number("pixels", Range::NON_NEGATIVE, meaning!(pixels), |it| &mut it.pixels),
    ];
}

/// The tolerance of objects that have none of their own.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Resource, Clone, Debug, Default, PartialEq)]
pub struct ViewTolerance(pub Tolerance);
