//! Pictures written and read back by the decoders of other crates.

#![allow(clippy::float_cmp, reason = "what is written has to be read back exactly")]

use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use halfway_lighting::Encoding;
use halfway_render::{Picture, Pixels};
use image::{DynamicImage, Rgba, Rgba32FImage, RgbaImage};

use super::*;

/// A temporary folder of a test, removed at its end.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNTER: AtomicU32 = AtomicU32::new(0);
        let number = COUNTER.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("halfway-output-{}-{number}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn names(&self) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(&self.0).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// 3 × 2 pixels, all different, so that a swapped axis or channel shows.
fn bytes() -> Picture {
    Picture::Byte(RgbaImage::from_fn(3, 2, |x, y| Rgba([10 * x as u8, 100 + 50 * y as u8, 7, 255])))
}

fn floats() -> Picture {
    Picture::Float(Rgba32FImage::from_fn(3, 2, |x, y| Rgba([0.25 * x as f32, 3.5 * y as f32, 1e-3, 1.0])))
}

fn chunks(file: &Path) -> Vec<String> {
    let data = fs::read(file).unwrap();
    let mut names = Vec::new();
    let mut at = 8;
    while at + 8 <= data.len() {
        let length = u32::from_be_bytes(data[at..at + 4].try_into().unwrap()) as usize;
        names.push(String::from_utf8_lossy(&data[at + 4..at + 8]).into_owned());
        at += length + 12;
    }
    names
}

#[test]
fn a_picture_is_saved_by_its_ending() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    bytes().save(file("byte.png")).unwrap();
    assert_eq!(image::open(file("byte.png")).unwrap().into_rgb8(), to_bytes(&bytes(), Encoding::Srgb));
    floats().save(file("float.PNG")).unwrap();
    assert_eq!(image::open(file("float.PNG")).unwrap().into_rgb8(), to_bytes(&floats(), Encoding::Srgb));
    floats().save(file("float.exr")).unwrap();
    let Picture::Float(drawn) = floats() else { unreachable!("floats") };
    let read = image::open(file("float.exr")).unwrap().into_rgb32f();
    assert!(read.pixels().zip(drawn.pixels()).all(|(read, drawn)| read.0[..] == drawn.0[..3]));

    let error = bytes().save(file("byte.exr")).unwrap_err().to_string();
    assert!(error.contains("Pixels::Float"), "{error}");
    let error = bytes().save(file("byte.bmp")).unwrap_err().to_string();
    assert!(error.ends_with("expected a file that ends in .png, .jpg, .jpeg, .webp or .exr"), "{error}");
    assert!(!file("byte.exr").exists() && !file("byte.bmp").exists());
}

#[test]
fn formats_by_ending_and_bits() {
    use PictureFormat::{Exr, Jpeg, Png8, Png16, WebP};
    for (file, bits, expected) in [
        ("a.png", None, Ok(Png8)),
        ("a.PNG", Some(8), Ok(Png8)),
        ("a.png", Some(16), Ok(Png16)),
        ("dir.exr/a.png", None, Ok(Png8)),
        ("a.exr", None, Ok(Exr)),
        ("a.Exr", Some(32), Ok(Exr)),
        ("a.png", Some(10), Err("a.png: 10 bits a channel were asked for; expected 8 or 16 in a PNG")),
        (
            "a.exr",
            Some(16),
            Err("a.exr: 16 bits a channel were asked for; expected 32 in an EXR, or the bits left out"),
        ),
        ("a.jpg", None, Ok(Jpeg)),
        ("a.JPEG", Some(8), Ok(Jpeg)),
        ("a.webp", None, Ok(WebP)),
        ("a.jpg", Some(16), Err("a.jpg: 16 bits a channel were asked for; expected 8 in a JPEG")),
        ("a.webp", Some(16), Err("a.webp: 16 bits a channel were asked for; expected 8 in a WebP")),
        ("a.bmp", None, Err("a.bmp: unknown ending; expected a file that ends in .png, .jpg, .jpeg, .webp or .exr")),
        ("png", None, Err("png: unknown ending; expected a file that ends in .png, .jpg, .jpeg, .webp or .exr")),
        ("", None, Err(": unknown ending; expected a file that ends in .png, .jpg, .jpeg, .webp or .exr")),
    ] {
        let found = PictureFormat::from_path(Path::new(file), bits).map_err(|error| error.to_string());
        assert_eq!(found, expected.map_err(str::to_owned), "{file} {bits:?}");
    }
    assert_eq!([Png8, Png16, Exr].map(PictureFormat::pixels), [Pixels::Byte, Pixels::Float, Pixels::Float]);
    assert_eq!([Jpeg, WebP].map(PictureFormat::pixels), [Pixels::Byte; 2]);
}

#[test]
fn webp_keeps_every_byte_and_jpeg_nearly() {
    let folder = Folder::new();
    let drawn = Picture::Byte(RgbaImage::from_fn(32, 24, |x, y| Rgba([8 * x as u8, 10 * y as u8, 100, 255])));
    for (name, most) in [("a.webp", 0), ("a.jpg", 12)] {
        for picture in [&drawn, &floats()] {
            let file = folder.file(name);
            write_picture(picture, &file, PictureFormat::from_path(&file, None).unwrap(), Encoding::Srgb).unwrap();
            let (found, expected) = (image::open(&file).unwrap().into_rgb8(), to_bytes(picture, Encoding::Srgb));
            assert_eq!(found.dimensions(), expected.dimensions());
            if picture.dimensions() == (32, 24) {
                let off = found.iter().zip(expected.iter()).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(off.is_some_and(|off| off <= most), "{name}: {off:?}");
            }
        }
    }
}

#[test]
fn a_picture_too_long_for_its_format_leaves_no_file() {
    let folder = Folder::new();
    let file = folder.file("a.webp");
    let long = Picture::Byte(RgbaImage::new(16_385, 1));
    let error = write_picture(&long, &file, PictureFormat::WebP, Encoding::Srgb).unwrap_err().to_string();
    assert!(error.contains("16385 × 1 pixels; expected sides of at most 16384"), "{error}");
    assert_eq!(folder.names(), Vec::<String>::new());
}

#[test]
fn a_png_of_bytes_stores_them_unchanged() {
    let folder = Folder::new();
    let file = folder.file("a.png");
    for (encoding, marked) in [(Encoding::Srgb, true), (Encoding::Raw, false)] {
        write_picture(&bytes(), &file, PictureFormat::Png8, encoding).unwrap();
        let DynamicImage::ImageRgb8(image) = image::open(&file).unwrap() else { panic!("8 bits") };
        assert_eq!(image, to_bytes(&bytes(), encoding));
        assert_eq!(image.get_pixel(2, 1).0, [20, 150, 7]);
        for chunk in ["sRGB", "gAMA", "cHRM"] {
            assert_eq!(chunks(&file).contains(&chunk.to_owned()), marked, "{chunk} {encoding:?}");
        }
    }
    assert_eq!(folder.names(), ["a.png"], "the second picture replaced the first, and nothing else is there");
}

#[test]
fn a_png_of_floats_is_clamped_and_encoded() {
    let folder = Folder::new();
    let file = folder.file("a.png");
    for (format, encoding, expected) in [
        // x = 2, y = 1: 0.5, 3.5 and 0.001. sRGB of 0.5 is 0.735357, of 0.001 12.92 times that.
        (PictureFormat::Png8, Encoding::Srgb, [188, 255, 3]),
        (PictureFormat::Png8, Encoding::Raw, [128, 255, 0]),
        (PictureFormat::Png16, Encoding::Srgb, [48192, 65535, 847]),
        (PictureFormat::Png16, Encoding::Raw, [32768, 65535, 66]),
    ] {
        write_picture(&floats(), &file, format, encoding).unwrap();
        let found = match image::open(&file).unwrap() {
            DynamicImage::ImageRgb8(image) => image.get_pixel(2, 1).0.map(u16::from),
            DynamicImage::ImageRgb16(image) => image.get_pixel(2, 1).0,
            other => panic!("{:?}", other.color()),
        };
        assert_eq!(found, expected, "{format:?} {encoding:?}");
    }
}

#[test]
fn an_exr_stores_every_number_unchanged() {
    let folder = Folder::new();
    let file = folder.file("a.exr");
    for encoding in [Encoding::Srgb, Encoding::Raw] {
        write_picture(&floats(), &file, PictureFormat::Exr, encoding).unwrap();
        let DynamicImage::ImageRgb32F(image) = image::open(&file).unwrap() else { panic!("three floats") };
        assert_eq!(image.dimensions(), (3, 2));
        for (x, y, pixel) in image.enumerate_pixels() {
            assert_eq!(pixel.0, [0.25 * x as f32, 3.5 * y as f32, 1e-3]);
        }
    }
    let beyond = Picture::Float(Rgba32FImage::from_pixel(1, 1, Rgba([f32::INFINITY, -2.0, f32::MAX, 1.0])));
    write_picture(&beyond, &file, PictureFormat::Exr, Encoding::Srgb).unwrap();
    assert_eq!(image::open(&file).unwrap().into_rgb32f().get_pixel(0, 0).0, [f32::INFINITY, -2.0, f32::MAX]);
}

#[test]
fn failed_pictures_leave_no_file() {
    let folder = Folder::new();
    let file = folder.file("a.png");
    let exr = folder.file("a.exr");
    // A folder on the way is a file.
    let nowhere = folder.file("a.png/b.png");
    let is_folder = folder.file("folder.png");
    fs::create_dir(&is_folder).unwrap();
    fs::write(&file, "what was there").unwrap();
    let empty = Picture::Byte(RgbaImage::new(0, 5));
    for (picture, file, format, message) in [
        (&bytes(), &file, PictureFormat::Png16, "the picture was drawn with 8 bits a channel"),
        (&bytes(), &exr, PictureFormat::Exr, "the picture was drawn with 8 bits a channel"),
        (&empty, &file, PictureFormat::Png8, "the picture is 0 × 5 pixels; expected at least 1 × 1"),
        (&bytes(), &nowhere, PictureFormat::Png8, "cannot be written: "),
        (&bytes(), &is_folder, PictureFormat::Png8, "is there already, and is not a file"),
    ] {
        let error = write_picture(picture, file, format, Encoding::Srgb).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{}: {message}", file.display())), "{error}");
    }
    assert_eq!(folder.names(), ["a.png", "folder.png"]);
    assert_eq!(fs::read_to_string(&file).unwrap(), "what was there");
}

#[test]
fn missing_folders_are_created() {
    let folder = Folder::new();
    let file = folder.file("some/where/a.png");
    write_picture(&bytes(), &file, PictureFormat::Png8, Encoding::Srgb).unwrap();
    assert!(image::open(&file).is_ok());
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link() {
    let folder = Folder::new();
    let (target, link) = (folder.file("target.png"), folder.file("link.png"));
    fs::write(&target, "old").unwrap();
    std::os::unix::fs::symlink(&target, &link).unwrap();
    write_picture(&bytes(), &link, PictureFormat::Png8, Encoding::Srgb).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(image::open(&target).unwrap().width(), 3);
}

fn frame(grey: u8) -> Picture {
    Picture::Byte(RgbaImage::from_pixel(4, 3, Rgba([grey, grey, grey, 255])))
}

#[test]
fn an_animation_has_its_frames_and_their_delay() {
    let folder = Folder::new();
    let file = folder.file("a.png");
    let delay = FrameDelay::per_second(24);
    let mut writer = AnimationWriter::create(&file, (4, 3), 3, delay, Encoding::Srgb).unwrap();
    for grey in [10, 20, 30] {
        writer.frame(&frame(grey)).unwrap();
    }
    assert!(!file.exists(), "not before it is complete");
    writer.finish().unwrap();
    assert_eq!(folder.names(), ["a.png"]);

    let mut reader = png::Decoder::new(BufReader::new(File::open(&file).unwrap())).read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (3, 0));
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    for grey in [10, 20, 30] {
        reader.next_frame(&mut data).unwrap();
        let shown = reader.info().frame_control().unwrap();
        assert_eq!((shown.delay_num, shown.delay_den), (1, 24));
        assert!(data.iter().all(|&byte| byte == grey), "{grey}");
    }
    // A viewer that does not animate shows the first frame.
    assert_eq!(image::open(&file).unwrap().into_rgb8().get_pixel(0, 0).0, [10, 10, 10]);
}

#[test]
fn a_wrong_number_of_frames_leaves_no_file() {
    let folder = Folder::new();
    let file = folder.file("a.apng");
    let create =
        |file: &Path, size, frames| AnimationWriter::create(file, size, frames, FrameDelay::default(), Encoding::Raw);
    let refused = |result: Result<AnimationWriter, OutputError>| result.map(|_| ()).unwrap_err().to_string();
    let name = file.display();
    assert_eq!(
        refused(create(&file, (4, 3), 0)),
        format!("{name}: 0 frames were given; expected 0 as announced, and at least 1")
    );
    assert!(refused(create(&file, (0, 3), 1)).contains("the picture is 0 × 3 pixels"));
    let gif = folder.file("a.gif");
    assert!(
        refused(create(&gif, (4, 3), 1)).contains("a.gif: unknown ending; expected a file that ends in .png or .apng")
    );

    let mut writer = create(&file, (4, 3), 2).unwrap();
    writer.frame(&frame(1)).unwrap();
    let error = writer.frame(&bytes()).unwrap_err().to_string();
    assert_eq!(error, format!("{name}: frame 1 is 3 × 2 pixels; expected 4 × 3 as announced"));
    let error = writer.finish().unwrap_err().to_string();
    assert_eq!(error, format!("{name}: 1 frames were given; expected 2 as announced, and at least 1"));

    let mut writer = create(&file, (4, 3), 1).unwrap();
    writer.frame(&frame(1)).unwrap();
    let error = writer.frame(&frame(2)).unwrap_err().to_string();
    assert_eq!(error, format!("{name}: 2 frames were given; expected 1 as announced, and at least 1"));
    drop(writer);
    assert_eq!(folder.names(), Vec::<String>::new());
}

#[test]
fn contact_sheets_lay_frames_out_in_a_grid() {
    let mut sheet = ContactSheet::new(2, 2, Encoding::Srgb);
    assert!(sheet.is_empty());
    for grey in [10, 20, 30] {
        sheet.push(&frame(grey));
    }
    sheet.push(&Picture::Byte(RgbaImage::new(0, 0)));
    assert_eq!(sheet.len(), 3);
    let Picture::Byte(picture) = sheet.picture() else { panic!("bytes") };
    // Two columns of 2, two rows of 2 (3 · 2/4, rounded up), gaps of 4 between and around.
    assert_eq!(picture.dimensions(), (16, 16));
    for (x, y, grey) in [(4, 4, 10), (10, 4, 20), (5, 11, 30)] {
        assert_eq!(picture.get_pixel(x, y).0, [grey, grey, grey, 255], "{x} {y}");
    }
    for (x, y) in [(3, 4), (8, 4), (10, 10), (15, 15)] {
        assert_eq!(picture.get_pixel(x, y).0, [24, 24, 24, 255], "paper at {x} {y}");
    }
}

#[test]
fn captions_stand_below_their_frames() {
    let mut sheet = ContactSheet::new(2, 40, Encoding::Srgb);
    let white = Picture::Byte(RgbaImage::from_pixel(40, 20, Rgba([255; 4])));
    sheet.push_with_caption(&white, "top");
    sheet.push(&white);
    let Picture::Byte(picture) = sheet.picture() else { panic!("bytes") };
    // A line of 8 pixels with gaps of 4 above and below it, and gaps of 4 between and around the cells.
    assert_eq!(picture.dimensions(), (92, 20 + 16 + 8));
    let ink = |x: u32| {
        (24..40)
            .flat_map(|y| (x..x + 40).map(move |x| (x, y)))
            .filter(|&(x, y)| picture.get_pixel(x, y)[0] > 200)
            .count()
    };
    assert!(ink(4) > 20 && ink(48) == 0, "three letters below the first: {} {}", ink(4), ink(48));
}

#[test]
fn pictures_are_written_to_streams() {
    for format in
        [PictureFormat::Png8, PictureFormat::Png16, PictureFormat::Jpeg, PictureFormat::WebP, PictureFormat::Exr]
    {
        let mut bytes = Vec::new();
        encode_picture(&floats(), &mut bytes, Path::new("memory"), format, Encoding::Srgb).unwrap();
        assert_eq!(image::load_from_memory(&bytes).unwrap().width(), 3, "{format:?}");
    }
    let error = encode_picture(&bytes(), &mut Vec::new(), Path::new("memory"), PictureFormat::Exr, Encoding::Srgb);
    assert!(matches!(error, Err(OutputError::TooCoarse { .. })));
}

#[test]
fn frames_are_scaled_down_in_linear_light() {
    let stripes = RgbaImage::from_fn(64, 64, |_, y| Rgba(if y % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] }));
    // Half the light is 0.5 in linear intensity: 188 of 255 in sRGB, 128 raw.
    for (encoding, expected) in [(Encoding::Srgb, 188), (Encoding::Raw, 128)] {
        let mut sheet = ContactSheet::new(1, 8, encoding);
        sheet.push(&Picture::Byte(stripes.clone()));
        let Picture::Byte(picture) = sheet.picture() else { panic!("bytes") };
        let [grey, ..] = picture.get_pixel(8, 8).0;
        assert!(grey.abs_diff(expected) <= 1, "{encoding:?}: {grey}; 1 for the weights' rounding");
    }
}

#[test]
fn texts_are_written_whole_or_not_at_all() {
    let folder = std::env::temp_dir().join(format!("halfway-write-text-{}", std::process::id()));
    let file = folder.join("new/page.html");
    write_text(&file, "one").unwrap();
    write_text(&file, "two").unwrap();
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "two");
    // A folder stands where the file should be.
    let taken = folder.join("new");
    let problem = write_text(&taken, "three").unwrap_err().to_string();
    assert!(problem.starts_with(&taken.display().to_string()), "{problem}");
    let left: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["new"]);
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_picture_that_is_not_opaque_has_four_channels() {
    let folder = tempfile::tempdir().expect("a folder");
    let float = Rgba32FImage::from_fn(2, 1, |x, _| Rgba([0.5, 0.25, 1.0, [1.0, 0.5][x as usize]]));
    let byte = RgbaImage::from_fn(2, 1, |x, _| Rgba([10, 20, 30, [255, 0][x as usize]]));
    let read = |name: &str, picture: &Picture, bits| {
        let file = folder.path().join(name);
        let format = PictureFormat::from_path(&file, bits).expect("a format");
        write_picture(picture, &file, format, Encoding::Raw).expect("it is written");
        image::open(&file).expect("it is read")
    };
    // Straight in a PNG.
    let eight = read("8.png", &Picture::Float(float.clone()), None);
    assert_eq!(eight.as_rgba8().expect("four channels").as_raw()[..], [128, 64, 255, 255, 128, 64, 255, 128]);
    let sixteen = read("16.png", &Picture::Float(float.clone()), Some(16));
    assert_eq!(sixteen.as_rgba16().expect("four channels").as_raw()[4..], [32768, 16384, 65535, 32768]);
    assert_eq!(read("b.png", &Picture::Byte(byte.clone()), None).as_rgba8(), Some(&byte));
    // Multiplied in an EXR.
    let exr = read("f.exr", &Picture::Float(float.clone()), None);
    assert_eq!(exr.as_rgba32f().expect("four channels").as_raw()[4..], [0.25, 0.125, 0.5, 0.5]);
    let opaque = Rgba32FImage::from_pixel(2, 1, Rgba([0.5, 0.25, 1.0, 1.0]));
    assert!(read("o.png", &Picture::Float(opaque.clone()), None).as_rgb8().is_some());
    assert!(read("o.exr", &Picture::Float(opaque), None).as_rgb32f().is_some());
}

#[test]
fn an_animation_keeps_its_opacity() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("clear.png");
    let mut animation =
        AnimationWriter::create(&file, (4, 3), 2, FrameDelay::per_second(10), Encoding::Srgb).expect("a file");
    let frames = [0, 255].map(|alpha| RgbaImage::from_pixel(4, 3, Rgba([10, 20, 30, alpha])));
    for frame in &frames {
        animation.frame(&Picture::Byte(frame.clone())).expect("a frame");
    }
    animation.finish().expect("a file");
    assert_eq!(image::open(&file).expect("a picture").as_rgba8(), Some(&frames[0]));
}

#[test]
fn what_has_no_opacity_refuses_a_picture_that_is_not_opaque() {
    let folder = tempfile::tempdir().expect("a folder");
    let clear = Picture::Byte(RgbaImage::from_pixel(4, 3, Rgba([10, 20, 30, 0])));
    let file = folder.path().join("clear.jpg");
    let error = write_picture(&clear, &file, PictureFormat::Jpeg, Encoding::Srgb).expect_err("refused").to_string();
    assert!(error.contains("clear.jpg") && error.contains(".png, .webp or .exr"), "{error}");
    let file = folder.path().join("clear.png");
    let mut animation =
        AnimationWriter::create(&file, (4, 3), 2, FrameDelay::per_second(10), Encoding::Srgb).expect("a file");
    let opaque = Picture::Byte(RgbaImage::from_pixel(4, 3, Rgba([10, 20, 30, 255])));
    animation.frame(&opaque).expect("the first frame");
    let error = animation.frame(&clear).expect_err("refused").to_string();
    assert!(error.contains("an animated PNG whose first frame is opaque has no opacity"), "{error}");
    // On a sheet it lies over the paper.
    let mut sheet = ContactSheet::new(1, 4, Encoding::Srgb);
    sheet.push(&clear);
    let Picture::Byte(sheet) = sheet.picture() else { panic!("bytes") };
    assert!(sheet.pixels().all(|pixel| pixel.0 == [24, 24, 24, 255]));
}
