//! The sRGB curve (IEC 61966-2-1), by which files write colours of vertices.

/// The linear intensity of an encoded value; values below 0 stay.
pub(super) fn decoded(encoded: f32) -> f32 {
    if encoded <= 0.0 {
        encoded
    } else if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// The encoded value of a linear intensity, the inverse of [`decoded`].
pub(super) fn encoded(linear: f32) -> f32 {
    if linear <= 0.0 {
        linear
    } else if linear <= 0.003_130_8 {
        linear * 12.92
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}
