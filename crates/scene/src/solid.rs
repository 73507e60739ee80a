//! The solids that objects of a scene file are cut from.

use bevy_math::Mat4;
use halfway_lighting::Range;
use halfway_texture::noise::MOST_OCTAVES;
use halfway_texture::{SolidKind, SolidTexture};

use crate::check::Limits;
use crate::keys::{Object, keys, words};
use crate::transform::TransformEntry;

keys! {
    /// `solid`: a pattern that fills space, cut by the object's surface.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct SolidEntry {
        [optional]
        /// The pattern that fills space.
        kind: SolidKind = SolidTexture::default().kind,
        /// How many octaves of noise marble and noise have: 1 to 16.
        octaves: u32 = SolidTexture::default().octaves => Limits::Counts(1, MOST_OCTAVES),
        /// From the object's space to the solid's, in cells: a scale of 4 puts four to a length of 1.
        transform: TransformEntry = TransformEntry::default(),
        /// The two colors of the solid, linear RGB. 0 to 1.
        colors: [[f32; 3]; 2] = SolidTexture::default().colors => Limits::Numbers(Range::UNIT),
    }
}

impl Object for SolidEntry {
    const EXPECTED: &'static str = "an object such as {\"kind\": \"marble\"}";
}

impl SolidEntry {
    /// The solid of a part that stands so in the object.
    pub(crate) fn for_part(&self, object_from_part: &Mat4) -> SolidTexture {
        let solid_from_part = self.transform.matrix() * object_from_part.as_dmat4();
        let columns = solid_from_part.to_cols_array_2d().map(|column| column.map(|number| number as f32));
        let Self { kind, octaves, colors, .. } = *self;
        SolidTexture { octaves, ..SolidTexture::new(kind, colors) }.placed(columns)
    }
}

words! {
    /// The pattern that fills the space of a solid.
    SolidKind {
        /// Cubes of side 1 around whole numbers, in turns of the two colors.
        checker = Self::Checker,
        /// Veins across x, one a unit, bent by noise.
        marble = Self::Marble,
        /// Rings around the y axis, one a unit, made uneven by noise.
        wood = Self::Wood,
        /// A sum of octaves of noise.
        noise = Self::Noise,
    }
}
