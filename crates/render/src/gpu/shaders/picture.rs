//! The shader text of passes over the finished picture, and the record that it reads.

use bytemuck::{Pod, Zeroable};
use halfway_lighting::Intensity;

/// The files of the text, concatenated; the first for the sRGB curve.
pub(crate) const PICTURE_FILES: [&str; 3] =
    [include_str!("lighting.wgsl"), include_str!("tone.wgsl"), include_str!("picture.wgsl")];

/// `PicturePolicy` of `picture.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct PicturePolicyRecord {
    pub(crate) smoothing: f32,
    pub(crate) per_white: f32,
    pub(crate) curve: u32,
    pub(crate) encoded: u32,
}

impl PicturePolicyRecord {
    /// `None` for a policy that does not act on the finished picture.
    pub(crate) fn new(policy: Intensity, encoded: bool) -> Option<Self> {
        let encoded = encoded.into();
        match policy {
            Intensity::Renormalize { smoothing } => Some(Self { smoothing, per_white: 0.0, curve: 0, encoded }),
            // A number that underflows is a white point that no picture reaches.
            Intensity::Reinhard { white } => {
                Some(Self { smoothing: 0.0, per_white: f64::from(white).powi(-2) as f32, curve: 1, encoded })
            }
            Intensity::Aces => Some(Self { smoothing: 0.0, per_white: 0.0, curve: 2, encoded }),
            _ => None,
        }
    }

    /// Whether it divides.
    pub(crate) fn divides(&self) -> bool {
        self.curve == 0
    }
}
