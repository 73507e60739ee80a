//! Image files: their decoded texels, and malformed ones.

use halfway_texture::environment::{Environment, EnvironmentMap, EnvironmentShape, MOST_FACE_TEXELS};
use halfway_texture::{LONGEST_SIDE, MOST_TEXELS, TexelImage, TexelMeaning, TextureError, decode, load};
use image::{DynamicImage, ImageFormat, Luma, Rgb, RgbImage, Rgba};
use std::fs::File;
use std::io::Cursor;

fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, ImageFormat::Png).expect("room for an image");
    bytes.into_inner()
}

#[test]
fn files_become_linear_light() {
    let color = png(RgbImage::from_pixel(3, 2, Rgb([255, 188, 0])));
    let image = decode(&color, "a.png", TexelMeaning::Color).expect("a PNG");
    assert_eq!(image.size(), [3, 2]);
    // 188 is the half of 255 in linear light, within half a step.
    let [r, g, b, a] = image.texels()[4];
    assert!((r, b, a) == (1.0, 0.0, 1.0) && (g - 0.5).abs() < 0.003, "{:?}", image.texels()[4]);
    let data = decode(&color, "a.png", TexelMeaning::Data).expect("a PNG");
    assert_eq!(data.texels()[0], [1.0, 188.0 / 255.0, 0.0, 1.0]);

    let grey = png(image::ImageBuffer::from_pixel(1, 1, Luma([0x8000_u16])));
    let [r, g, b, a] = decode(&grey, "grey.png", TexelMeaning::Data).expect("16 bits").texels()[0];
    assert!(r == g && g == b && a == 1.0 && (r - 32768.0 / 65535.0).abs() < 1e-7);
    let clear = png(image::RgbaImage::from_pixel(1, 1, Rgba([10, 20, 30, 128])));
    assert_eq!(decode(&clear, "clear.png", TexelMeaning::Color).expect("alpha").texels()[0][3], 128.0 / 255.0);

    let mut bytes = Cursor::new(Vec::new());
    let flat = RgbImage::from_pixel(16, 16, Rgb([200, 100, 50]));
    DynamicImage::from(flat).write_to(&mut bytes, ImageFormat::Jpeg).expect("room");
    let found = decode(&bytes.into_inner(), "flat.jpg", TexelMeaning::Data).expect("a JPEG").texels()[100];
    assert!((found[0] - 200.0 / 255.0).abs() < 0.02 && (found[2] - 50.0 / 255.0).abs() < 0.02, "{found:?}");
}

#[test]
fn invalid_images_are_refused_by_name() {
    let whole = png(RgbImage::from_fn(40, 40, |x, y| Rgb([x as u8 * 6, y as u8 * 6, (x * y) as u8])));
    for (bytes, says) in
        [(&b"not an image"[..], "note.png: is no image"), (&whole[..whole.len() / 2], "note.png: "), (&[], "note.png")]
    {
        let error = decode(bytes, "note.png", TexelMeaning::Color).expect_err("it is none").to_string();
        assert!(error.starts_with(says), "{error}");
    }
    // A file of a few bytes with a header of 60,000 × 60,000: refused before memory is allocated.
    let mut bomb = png(RgbImage::from_pixel(1, 1, Rgb([0; 3])));
    bomb[16..20].copy_from_slice(&60_000_u32.to_be_bytes());
    bomb[20..24].copy_from_slice(&60_000_u32.to_be_bytes());
    let checksum = crc(&bomb[12..29]).to_be_bytes();
    bomb[29..33].copy_from_slice(&checksum);
    let error = decode(&bomb, "bomb.png", TexelMeaning::Color).expect_err("too large");
    let bytes = 60_000 * 60_000 * 3;
    assert_eq!(error, TextureError::TooLargeDecoded { image: "bomb.png".into(), width: 60_000, height: 60_000, bytes });
    assert_eq!(
        error.to_string(),
        "bomb.png: is 60000 × 60000 texels, 10800000000 bytes when decoded; at most 1073741824 bytes are expected"
    );
    assert!(matches!(TexelImage::new(0, 3, Vec::new()), Err(TextureError::Empty { .. })));
    assert!(matches!(TexelImage::new(LONGEST_SIDE + 1, 1, Vec::new()), Err(TextureError::TooLarge { .. })));
    assert!(matches!(TexelImage::new(2, 1, vec![[0.0; 4]]), Err(TextureError::Count { found: 1, .. })));
    let nan = TexelImage::new(2, 1, vec![[0.0; 4], [0.0, f32::NAN, 0.0, 0.0]]);
    assert!(matches!(nan, Err(TextureError::NotFinite { x: 1, y: 0, .. })));
    let error = halfway_texture::load("no/such/file.png".as_ref(), TexelMeaning::Color).expect_err("it is not there");
    assert!(error.to_string().starts_with("no/such/file.png: cannot be read"), "{error}");
    // A folder is refused, as is a pipe, whose other end might never be opened.
    let error = halfway_texture::load("src".as_ref(), TexelMeaning::Color).expect_err("it is a folder");
    assert_eq!(error, TextureError::NotAFile { image: "src".into() });
}

/// CRC-32 of PNG (ISO 3309), bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 })
    })
}

/// A PNG of these chunks.
fn png_of(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    for (name, data) in chunks {
        let start = file.len() + 4;
        file.extend((data.len() as u32).to_be_bytes());
        file.extend(name.iter().chain(*data));
        let checksum = crc(&file[start..]);
        file.extend(checksum.to_be_bytes());
    }
    file
}

fn header(width: u32, height: u32, color_type: u8) -> Vec<u8> {
    [&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, color_type, 0, 0, 0]].concat()
}

/// Some bytes in zlib's form without compression (RFC 1950 and 1951).
fn stored(bytes: &[u8]) -> Vec<u8> {
    let (a, b) = bytes.iter().fold((1_u32, 0_u32), |(a, b), byte| {
        let a = (a + u32::from(*byte)) % 65_521;
        (a, (a + b) % 65_521)
    });
    let length = bytes.len() as u16;
    let lengths = [length.to_le_bytes(), (!length).to_le_bytes()].concat();
    [&[0x78, 0x01, 0x01], &lengths[..], bytes, &(b << 16 | a).to_be_bytes()].concat()
}

#[test]
fn palettes_are_converted_to_rgb() {
    let file = png_of(&[
        (b"IHDR", &header(3, 1, 3)),
        (b"PLTE", &[255, 0, 51, 0, 102, 255]),
        // The second color is half clear.
        (b"tRNS", &[255, 128]),
        // A row without a filter.
        (b"IDAT", &stored(&[0, 1, 0, 1])),
        (b"IEND", &[]),
    ]);
    let image = decode(&file, "palette.png", TexelMeaning::Data).expect("a palette");
    let [red, blue] = [[1.0, 0.0, 51.0 / 255.0, 1.0], [0.0, 102.0 / 255.0, 1.0, 128.0 / 255.0]];
    assert_eq!(image.texels(), [blue, red, blue]);
}

/// A baseline JPEG of 8 × 8 pixels of one color in four inks, stored as Adobe does, 255 for none (ITU-T T.81;
/// T.872, 6.5.3).
fn inks(values: [u8; 4]) -> Vec<u8> {
    let mut bits: Vec<bool> = Vec::new();
    for value in values {
        // The mean of a block, times eight, from 128: its category by two bits, its bits, and the end of the block.
        let mean = 8 * (i32::from(value) - 128);
        let size = 32 - mean.unsigned_abs().leading_zeros();
        let code = match size {
            0 => 0,
            10 => 1,
            11 => 2,
            _ => panic!("{value} has no code here"),
        };
        let offset = if mean < 0 { mean + (1 << size) - 1 } else { mean };
        bits.extend([code & 2 != 0, code & 1 != 0]);
        bits.extend((0..size).rev().map(|bit| offset >> bit & 1 != 0));
        bits.push(false);
    }
    bits.resize(bits.len().next_multiple_of(8), true);
    let scan = bits.chunks(8).map(|byte| byte.iter().fold(0_u8, |byte, bit| byte << 1 | u8::from(*bit)));
    let segment =
        |marker: u8, data: &[u8]| [&[0xFF, marker], &(data.len() as u16 + 2).to_be_bytes()[..], data].concat();
    let table = |class: u8, length: usize, symbols: &[u8]| {
        let mut counts = [0_u8; 16];
        counts[length - 1] = symbols.len() as u8;
        segment(0xC4, &[&[class], &counts[..], symbols].concat())
    };
    let parts = (1..=4_u8).flat_map(|part| [part, 0x11, 0]).collect::<Vec<_>>();
    let scanned = (1..=4_u8).flat_map(|part| [part, 0]).collect::<Vec<_>>();
    let mut file = [
        vec![0xFF, 0xD8],
        segment(0xEE, b"Adobe\0\x64\0\0\0\0\0"),
        segment(0xDB, &[&[0][..], &[1; 64]].concat()),
        segment(0xC0, &[&[8, 0, 8, 0, 8, 4][..], &parts].concat()),
        table(0x00, 2, &[0, 10, 11]),
        table(0x10, 1, &[0]),
        segment(0xDA, &[&[4], &scanned[..], &[0, 63, 0]].concat()),
    ]
    .concat();
    file.extend(scan.flat_map(|byte| [Some(byte), (byte == 0xFF).then_some(0)]).flatten());
    file.extend([0xFF, 0xD9]);
    file
}

#[test]
fn cmyk_jpegs_are_converted_to_rgb() {
    let half = 128.0 / 255.0;
    for (values, expected) in [
        ([255, 255, 255, 255], [1.0, 1.0, 1.0]),
        ([0, 255, 255, 255], [0.0, 1.0, 1.0]),
        ([255, 0, 255, 255], [1.0, 0.0, 1.0]),
        ([255, 255, 0, 255], [1.0, 1.0, 0.0]),
        ([255, 255, 255, 0], [0.0, 0.0, 0.0]),
        ([255, 0, 255, 128], [half, 0.0, half]),
    ] {
        let image = decode(&inks(values), "inks.jpg", TexelMeaning::Data).expect("four inks");
        assert_eq!(image.size(), [8, 8]);
        for texel in image.texels() {
            let off = (0..3).map(|k| (texel[k] - expected[k]).abs()).fold(0.0, f32::max);
            assert!(off <= 1.5 / 255.0 && texel[3] == 1.0, "{values:?}: {texel:?} for {expected:?}");
        }
    }
}

#[test]
fn images_beyond_the_limits_are_scaled_down() {
    // Columns by turns black and white, and one more.
    let file = png(image::GrayImage::from_fn(2 * LONGEST_SIDE, 2, |x, _| Luma([if x % 2 == 0 { 0 } else { 255 }])));
    let image = decode(&file, "long.png", TexelMeaning::Data).expect("a long image");
    assert_eq!(image.size(), [LONGEST_SIDE, 1]);
    assert!(image.texels().iter().all(|texel| *texel == [0.5, 0.5, 0.5, 1.0]), "{:?}", image.texels()[0]);
    let said = image.reduction().expect("it was longer");
    assert_eq!(said, "is scaled down from 16384 × 2 to 8192 × 1 texels, to keep within the limits");
    let within = png(image::GrayImage::new(LONGEST_SIDE, 1));
    assert_eq!(decode(&within, "within.png", TexelMeaning::Data).expect("an image").reduction(), None);
    assert!(u64::from(LONGEST_SIDE) * u64::from(LONGEST_SIDE) > MOST_TEXELS);
}

/// The place of a wrong number is that in the file.
#[test]
fn nan_in_a_large_image_is_refused_by_its_texel() {
    let mut floats = image::Rgb32FImage::new(LONGEST_SIDE + 1, 300);
    floats.put_pixel(7, 299, Rgb([0.0, f32::NAN, 0.0]));
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::from(floats).write_to(&mut bytes, ImageFormat::OpenExr).expect("room");
    match decode(&bytes.into_inner(), "large.exr", TexelMeaning::Data) {
        Err(TextureError::NotFinite { image, x: 7, y: 299, .. }) => assert_eq!(image, "large.exr"),
        other => panic!("{:?}", other.map(|image| image.size())),
    }
}

/// A small image in a format.
fn file_in(format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = RgbImage::from_fn(40, 40, |x, y| Rgb([x as u8 * 6, y as u8 * 6, (x * y) as u8]));
    let image = DynamicImage::from(image);
    let floats = matches!(format, ImageFormat::Hdr | ImageFormat::OpenExr);
    let image = if floats { DynamicImage::from(image.to_rgb32f()) } else { image };
    image.write_to(&mut bytes, format).expect("room for an image");
    bytes.into_inner()
}

/// The file with another size in its header.
fn resized(format: ImageFormat, [width, height]: [u32; 2]) -> Vec<u8> {
    let mut file = file_in(format);
    let after = |file: &[u8], mark: &[u8]| {
        file.windows(mark.len()).position(|window| window == mark).expect("its header") + mark.len()
    };
    match format {
        ImageFormat::Png => {
            file[16..20].copy_from_slice(&width.to_be_bytes());
            file[20..24].copy_from_slice(&height.to_be_bytes());
            let checksum = crc(&file[12..29]).to_be_bytes();
            file[29..33].copy_from_slice(&checksum);
        }
        ImageFormat::Jpeg => {
            // The length of the segment and the precision stand before the height.
            let at = after(&file, &[0xFF, 0xC0]) + 3;
            file[at..at + 2].copy_from_slice(&(height as u16).to_be_bytes());
            file[at + 2..at + 4].copy_from_slice(&(width as u16).to_be_bytes());
        }
        ImageFormat::Bmp => {
            file[18..22].copy_from_slice(&width.to_le_bytes());
            file[22..26].copy_from_slice(&height.to_le_bytes());
        }
        ImageFormat::Tga => {
            file[12..14].copy_from_slice(&(width as u16).to_le_bytes());
            file[14..16].copy_from_slice(&(height as u16).to_le_bytes());
        }
        ImageFormat::Gif => {
            file[6..8].copy_from_slice(&(width as u16).to_le_bytes());
            file[8..10].copy_from_slice(&(height as u16).to_le_bytes());
        }
        ImageFormat::Tiff => {
            for (tag, size) in [(0x100_u16, width), (0x101, height)] {
                // A tag, its type and count, and its value.
                let at = after(&file, &[&tag.to_le_bytes()[..], &[4, 0, 1, 0, 0, 0]].concat());
                file[at..at + 4].copy_from_slice(&size.to_le_bytes());
            }
        }
        ImageFormat::Hdr => {
            let at = after(&file, b"\n\n");
            let end = at + after(&file[at..], b"\n");
            file.splice(at..end, format!("-Y {height} +X {width}\n").into_bytes());
        }
        _ => {
            // The name of the type and the length of a box stand before its corners; that of the texels, and the
            // displayed one.
            for name in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
                let at = after(&file, name) + 4;
                let corners = [0, 0, width as i32 - 1, height as i32 - 1].map(i32::to_le_bytes).concat();
                file[at..at + 16].copy_from_slice(&corners);
            }
        }
    }
    file
}

const FORMATS: [ImageFormat; 9] = [
    ImageFormat::Png,
    ImageFormat::Jpeg,
    ImageFormat::WebP,
    ImageFormat::Bmp,
    ImageFormat::Tga,
    ImageFormat::Tiff,
    ImageFormat::Gif,
    ImageFormat::Hdr,
    ImageFormat::OpenExr,
];

/// A file's name, which tells TGA files of the old kind.
fn name_in(format: ImageFormat) -> String {
    format!("image.{}", format.extensions_str()[0])
}

#[test]
fn every_format_gives_the_same_picture() {
    let expected = decode(&file_in(ImageFormat::Png), "image.png", TexelMeaning::Data).expect("a PNG");
    // JPEG and GIF, of 256 colors, lose more: tests of their own read them.
    let lossy = [ImageFormat::Jpeg, ImageFormat::Gif];
    for format in FORMATS.into_iter().filter(|format| !lossy.contains(format)) {
        let found = decode(&file_in(format), &name_in(format), TexelMeaning::Data).expect("an image");
        assert_eq!(found.size(), [40, 40], "{format:?}");
        // A texel of an HDR has one exponent for three channels.
        let slack = if format == ImageFormat::Hdr { 0.01 } else { 1e-6 };
        let pairs = found.texels().as_flattened().iter().zip(expected.texels().as_flattened());
        let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off <= slack, "{format:?}: {off}");
    }
}

/// TGA files have no mark at their beginning: newer ones have one at their end.
#[test]
fn tga_is_told_by_its_end_or_by_its_name() {
    let old = file_in(ImageFormat::Tga);
    let size = |bytes: &[u8], name: &str| decode(bytes, name, TexelMeaning::Color).map(|image| image.size());
    assert_eq!(size(&old, "Bricks.TGA"), Ok([40, 40]));
    assert!(matches!(size(&old, "bricks"), Err(TextureError::Decode { .. })));
    let new = [&old[..], &[0; 8], b"TRUEVISION-XFILE.\0"].concat();
    assert_eq!(size(&new, "bricks"), Ok([40, 40]));
}

/// Of an animation the first frame is read.
#[test]
fn a_gif_is_its_first_frame() {
    let mut bytes = Vec::new();
    {
        let mut encoder = image::codecs::gif::GifEncoder::new(&mut bytes);
        let frame = |red| image::Frame::new(image::RgbaImage::from_pixel(4, 4, Rgba([red, 0, 0, 255])));
        encoder.encode_frames([frame(255), frame(0)]).expect("room");
    }
    let image = decode(&bytes, "moving.gif", TexelMeaning::Color).expect("a GIF");
    assert_eq!((image.size(), image.texels()[5]), ([4, 4], [1.0, 0.0, 0.0, 1.0]));
}

#[test]
fn impossible_sizes_are_refused_in_every_format() {
    // The size of a WebP is spread over the bits of its stream.
    for format in FORMATS.into_iter().filter(|format| *format != ImageFormat::WebP) {
        let name = name_in(format);
        let found = decode(&resized(format, [40, 40]), &name, TexelMeaning::Color).expect("the size that it has");
        assert_eq!(found.size(), [40, 40], "{name}");
        let refused = |size| {
            let found = decode(&resized(format, size), &name, TexelMeaning::Color);
            found.map(|image| image.size()).expect_err("no such size")
        };
        let error = refused([60_000, 60_000]);
        // The number of parts of an EXR or a TIFF file has to match its size: that is checked first.
        let has_parts = matches!(format, ImageFormat::OpenExr | ImageFormat::Tiff);
        let is_miscounted = has_parts && matches!(error, TextureError::Decode { .. });
        let is_too_large = matches!(error, TextureError::TooLargeDecoded { width: 60_000, height: 60_000, .. });
        assert!(is_miscounted || is_too_large, "{error}");
        for size in [[0, 40], [40, 0]] {
            let error = refused(size);
            assert!(matches!(error, TextureError::Empty { .. } | TextureError::Decode { .. }), "{name}: {error}");
            assert!(error.to_string().starts_with(&name), "{name}: {error}");
        }
    }
}

#[test]
fn truncated_files_are_refused_in_every_format() {
    for format in FORMATS {
        let (name, file) = (name_in(format), file_in(format));
        for length in [4, 20, file.len() / 3, file.len() / 2, file.len() * 9 / 10] {
            let found = decode(&file[..length], &name, TexelMeaning::Color);
            let error = found.map(|image| image.size()).expect_err("a part of it");
            assert!(error.to_string().starts_with(&format!("{name}: is no image")), "{length}: {error}");
        }
    }
}

/// A preview within a segment has an end marker of its own, and any bytes may follow the end of the picture.
#[test]
fn the_end_of_a_jpeg_is_that_of_its_picture() {
    let file = file_in(ImageFormat::Jpeg);
    let preview = [&[0xFF, 0xE1, 0, 8][..], b"ab", &[0xFF, 0xD9, 0, 0]].concat();
    let with_preview = [&file[..2], &preview, &file[2..]].concat();
    let size = |bytes: &[u8]| decode(bytes, "a.jpg", TexelMeaning::Color).map(|image| image.size());
    assert_eq!(size(&with_preview), Ok([40, 40]));
    assert_eq!(size(&[&file[..], b"more"].concat()), Ok([40, 40]));
    let error = size(&with_preview[..with_preview.len() - 2]).expect_err("its end is missing");
    assert_eq!(error.to_string(), "a.jpg: is no image that can be read: the file ends before the picture does");
}

#[test]
fn files_have_so_many_bytes_at_most() {
    let path = std::env::temp_dir().join(format!("halfway-long-{}.png", std::process::id()));
    // A sparse file, which takes no space on the disk.
    File::create(&path).and_then(|file| file.set_len((1 << 28) + 1)).expect("a file");
    let error = load(&path, TexelMeaning::Color);
    std::fs::remove_file(&path).expect("it was there");
    assert_eq!(error, Err(TextureError::TooLong { image: path.display().to_string(), limit: 1 << 28 }));
}

#[test]
fn environments_are_limited_in_size() {
    let cube = Environment::from_fn(EnvironmentShape::Cube, MOST_FACE_TEXELS + 1, |_| [0.25, 0.5, 1.0, 1.0]);
    let map = EnvironmentMap::new(&cube.expect("an environment")).expect("a smaller one");
    assert_eq!(map.levels()[0].side, MOST_FACE_TEXELS);
}
