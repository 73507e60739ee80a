//! Pictures in the 256 steps of a byte, and the mistakes that are made there.

use halfway_lighting::Encoding;
use halfway_lighting::equations::{Transcendental, srgb_encoded};

use crate::mistakes::{Mistake, Mistakes};

/// A pixel in steps of 1/255.
pub(super) type Steps = [u8; 3];

/// The mistakes that are made when intensities become bytes.
const OF_ENCODING: [Mistake; 6] = [
    Mistake::ClampMissing,
    Mistake::GammaMissing,
    Mistake::GammaTwice,
    Mistake::GammaUnasked,
    Mistake::GammaAsPower,
    Mistake::RedAndBlueSwapped,
];

/// Whether the mistake changes only how intensities become bytes, or where pixels are.
pub(super) fn is_of_picture(mistake: Mistake) -> bool {
    mistake != Mistake::ClampMissing && (OF_ENCODING.contains(&mistake) || is_move(mistake))
}

/// Whether the mistake puts pixels elsewhere.
pub(super) fn is_move(mistake: Mistake) -> bool {
    matches!(mistake, Mistake::UpsideDown | Mistake::Mirrored)
}

/// Whether a mistake of the encoding could show in pictures of this encoding; `true` for others.
pub(super) fn could_show(mistake: Mistake, encoding: Encoding) -> bool {
    match mistake {
        Mistake::GammaMissing | Mistake::GammaTwice | Mistake::GammaAsPower => encoding == Encoding::Srgb,
        Mistake::GammaUnasked => encoding == Encoding::Raw,
        _ => true,
    }
}

/// An intensity as bytes, encoded with these mistakes.
pub(super) fn encoded(i: [f64; 3], encoding: Encoding, mistakes: Mistakes) -> Steps {
    let bytes = i.map(|channel| {
        let channel = if channel.is_finite() { channel } else { 0.0 };
        let wraps = mistakes.has(Mistake::ClampMissing);
        let channel = if wraps { channel.max(0.0) } else { channel.clamp(0.0, 1.0) };
        let steps = (255.0 * curve(channel, encoding, mistakes)).round();
        if wraps { (steps as u64 % 256) as u8 } else { steps as u8 }
    });
    let [r, g, b] = bytes;
    if mistakes.has(Mistake::RedAndBlueSwapped) { [b, g, r] } else { bytes }
}

fn curve(i: f64, encoding: Encoding, mistakes: Mistakes) -> f64 {
    if mistakes.has(Mistake::GammaUnasked) {
        return srgb_encoded(i);
    }
    if mistakes.has(Mistake::GammaMissing) {
        return i;
    }
    let once = if mistakes.has(Mistake::GammaAsPower) { i.pow(1.0 / 2.2) } else { encoding.encode(i) };
    if mistakes.has(Mistake::GammaTwice) { srgb_encoded(once) } else { once }
}

/// Where somebody who makes these mistakes puts what belongs into the pixel `at`.
pub(super) fn put(at: (u32, u32), (width, height): (u32, u32), mistakes: Mistakes) -> (u32, u32) {
    let (x, y) = at;
    (
        if mistakes.has(Mistake::Mirrored) { width - 1 - x } else { x },
        if mistakes.has(Mistake::UpsideDown) { height - 1 - y } else { y },
    )
}
