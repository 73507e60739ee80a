//! How the lights of a draw reach its shader: all of the scene at fixed places, or by lists.

/// Up to this many lights in a scene are all shaded everywhere; of more, each patch has those that it needs.
pub const COUNTED_LIGHTS: u32 = 8;

/// How the lights reach the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lists {
    /// All lights of the scene, as many directional, point and spot lights as this, bound in this order.
    Counted([u8; 3]),
    /// Those that the record's lists name, of all that are bound.
    Listed,
}

impl Lists {
    pub(crate) const NONE: Self = Self::Counted([0; 3]);

    /// For a scene with these numbers of directional, point and spot lights.
    pub(crate) fn new(counts: [u32; 3]) -> Self {
        if counts.iter().sum::<u32>() <= COUNTED_LIGHTS {
            Self::Counted(counts.map(|count| count as u8))
        } else {
            Self::Listed
        }
    }

    /// How many directional, point and spot lights the pipeline knows of.
    pub fn counts(self) -> [u8; 3] {
        match self {
            Self::Counted(counts) => counts,
            Self::Listed => [0; 3],
        }
    }
}
