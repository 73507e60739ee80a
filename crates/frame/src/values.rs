//! The properties of a picture that constrain its frame: the values of its pixels, and whether it is read back.

use bevy_ecs::prelude::Resource;
use halfway_lighting::{Encoding, Intensity};

/// The values that the frame draws; `None` where there is nothing to draw into.
/// Holds after [`RenderSet::View`](crate::sets::RenderSet::View).
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct FrameValues(pub Option<PixelValues>);

/// Whether the picture waits for the levels of detail of its meshes. Pictures that are read back do, so that they are
/// the same in every process; windows draw full detail until the levels are there.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaitsForLevels(pub bool);

impl Default for WaitsForLevels {
    fn default() -> Self {
        Self(true)
    }
}

/// Whether the App draws a single picture. Then large meshes are drawn in the order of their triangles: to cut them into
/// patches takes longer than a picture, and pays from the second one on. `false` by default.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DrawsOnce(pub bool);

/// The values of a target's pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PixelValues {
    /// Bytes in this encoding.
    Bytes(Encoding),
    /// Linear I.
    Floats,
    /// Linear I, of which a policy makes the picture.
    Toned {
        /// A change of I by a step changes the picture by at most a step over this number.
        share: f64,
    },
}

impl PixelValues {
    /// The encoding of bytes; `None` for floating point.
    pub fn encoding(self) -> Option<Encoding> {
        match self {
            Self::Bytes(encoding) => Some(encoding),
            Self::Floats | Self::Toned { .. } => None,
        }
    }

    /// The share of a tolerance in steps of the picture that is left for the values.
    pub fn share(self) -> f64 {
        match self {
            Self::Bytes(_) | Self::Floats => 1.0,
            Self::Toned { share } => share,
        }
    }

    /// The values that are drawn for such a picture under a policy.
    #[must_use]
    pub fn under(self, policy: Intensity) -> Self {
        // Nothing is known of how dark it becomes, so that the curve of bytes may be as steep as it is at 0.
        let steepest = match self {
            Self::Bytes(Encoding::Srgb) => 12.92,
            _ => 1.0,
        };
        if policy.acts_on_pictures() { Self::Toned { share: 1.0 / (steepest * policy.steepest()) } } else { self }
    }
}
