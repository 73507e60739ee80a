//! What fragments of tiny triangles take: what is interpolated, or what is at the nearest corner.

use crate::lanes::{Simd, each, f32x4};
use fearless_simd::prelude::*;

/// What a fragment takes beside 1/w.
#[derive(Clone, Copy)]
pub(crate) struct Left {
    pub(crate) lead: [f32; 3],
    /// Where it is shaded in eye space, if that is not where it is.
    pub(crate) place: Option<[f32; 3]>,
}

/// What says so.
pub(crate) trait Lead<S: Simd>: Copy {
    /// Whether it says where fragments are shaded.
    const HAS_PLACES: bool;

    /// At a place in pixels from the first that may be covered, where `between` is interpolated.
    fn at(&self, simd: S, between: f32x4<S>, place: [f32; 2]) -> Left;
}

/// The numbers that are interpolated.
#[derive(Clone, Copy)]
pub(crate) struct Interpolated;

impl<S: Simd> Lead<S> for Interpolated {
    const HAS_PLACES: bool = false;

    #[inline(always)]
    fn at(&self, _: S, between: f32x4<S>, _: [f32; 2]) -> Left {
        Left { lead: [between[1], between[2], between[3]], place: None }
    }
}

/// Those of the corner that is nearest on the picture.
#[derive(Clone, Copy)]
pub(crate) struct NearestCorner<'a> {
    /// Columns and rows of the corners, from the first pixel that may be covered.
    pub(crate) places: [[f32; 4]; 2],
    /// 1/w and the three numbers.
    pub(crate) corners: [&'a [f32; 4]; 3],
    /// In eye space.
    pub(crate) in_eye: [[f32; 3]; 3],
}

impl<S: Simd> Lead<S> for NearestCorner<'_> {
    const HAS_PLACES: bool = true;

    #[inline(always)]
    fn at(&self, simd: S, _: f32x4<S>, place: [f32; 2]) -> Left {
        let [x, y] = each!(axis in 2 => {
            f32x4::load_array_ref(simd, &self.places[axis]) - f32x4::simd_from(simd, place[axis])
        });
        let squared = x.mul_add_precise(x, y * y);
        let [a, b, c] = each!(k in 3 => squared[k]);
        let nearest = if c < a && c < b { 2 } else { usize::from(b < a) };
        let [_, x, y, z] = *self.corners[nearest];
        Left { lead: [x, y, z], place: Some(self.in_eye[nearest]) }
    }
}
