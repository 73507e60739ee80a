//! Colours of vertices. The text formats and PLY say nothing of their encoding; programs write what they show, which is
//! sRGB (IEC 61966-2-1). A mesh has linear ones.

/// The linear value of an encoded one; the straight part goes on below 0, the curve above 1.
pub(super) fn linear(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The encoded value of a linear one.
pub(super) fn encoded(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoding_is_undone() {
        for i in 0..=255_u8 {
            let x = f32::from(i) / 255.0;
            // A few roundings of f32, and what powf is off.
            assert!((encoded(linear(x)) - x).abs() < 1e-6, "{x}");
        }
        assert_eq!((linear(0.0), linear(1.0)), (0.0, 1.0));
        assert!(linear(f32::MAX).is_infinite() && encoded(f32::MAX).is_finite());
    }
}
