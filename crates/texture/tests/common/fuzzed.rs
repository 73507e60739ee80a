//! The fuzz target of the image reader: it does not panic, errors name the image, and an image that was read has values
//! in their ranges.

use std::mem::discriminant;

use halfway_texture::{TexelImage, TexelMeaning, decode};

/// Reads the bytes as an image, by either meaning.
pub(crate) fn feed(bytes: &[u8]) {
    let [color, data] = [TexelMeaning::Color, TexelMeaning::Data].map(|meaning| decode(bytes, "fuzzed", meaning));
    match (color, data) {
        (Ok(color), Ok(data)) => {
            assert_eq!(color.size(), data.size());
            // EXR, HDR, and TIFF, which may hold either.
            let marks: [&[u8]; 4] = [b"\x76\x2F\x31\x01", b"#?", b"II*\0", b"MM\0*"];
            let is_float = marks.iter().any(|mark| bytes.starts_with(mark));
            for image in [color, data] {
                check(&image, is_float);
            }
        }
        (Err(color), Err(data)) => {
            // Not their texts: of an EXR file with two faults the decoder names either.
            assert_eq!(discriminant(&color), discriminant(&data), "{color}, and {data}");
            assert!(color.to_string().starts_with("fuzzed"), "{color}");
        }
        (color, data) => panic!("as a color {:?}, and as data {:?}", color.err(), data.err()),
    }
}

fn check(image: &TexelImage, is_float: bool) {
    let [width, height] = image.size();
    assert_eq!(image.texels().len() as u64, u64::from(width) * u64::from(height));
    assert!(!image.texels().is_empty());
    for number in image.texels().as_flattened() {
        assert!(if is_float { number.is_finite() } else { (0.0..=1.0).contains(number) }, "{number}");
    }
}
