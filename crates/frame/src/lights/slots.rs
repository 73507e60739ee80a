//! The lights of a draw in its shader: all of the scene in fixed slots, or by lists.

use halfway_lighting::lights::KindSet;

/// Up to this many lights in a scene are all shaded everywhere; of more, each patch has those that it needs.
pub const COUNTED_LIGHTS: u32 = 8;

/// The way the lights reach the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lists {
    /// All lights of the scene, so many and of these kinds.
    Counted(u8, KindSet),
    /// The lights that the record's lists name, of all that are bound; of any kind.
    Listed,
}

impl Lists {
    pub(crate) const NONE: Self = Self::Counted(0, KindSet::EMPTY);

    /// For a scene with so many lights, of these kinds.
    pub(crate) fn new(count: usize, kinds: KindSet) -> Self {
        match u8::try_from(count) {
            Ok(few) if u32::from(few) <= COUNTED_LIGHTS => Self::Counted(few, kinds),
            _ => Self::Listed,
        }
    }

    /// The number of lights that the pipeline is compiled for.
    pub fn count(self) -> u8 {
        match self {
            Self::Counted(count, _) => count,
            Self::Listed => 0,
        }
    }

    /// The kinds of light that the pipeline draws.
    pub fn kinds(self) -> KindSet {
        match self {
            Self::Counted(_, kinds) => kinds,
            Self::Listed => KindSet::ALL,
        }
    }
}
