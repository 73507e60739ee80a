#![doc = include_str!("../README.md")]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use halfway_lighting::Encoding;
use halfway_record::output::SavePicture;
use halfway_reference::Image;
use halfway_reference::metrics::{Scale, compare, difference};
use halfway_render::Picture;
use image::DynamicImage;

/// Asserts that a [`Picture`] of bytes is the one that is stored as `tests/pictures/NAME.png` in this package; a third
/// argument allows so many steps of 255 in each channel. See the [crate](self).
#[macro_export]
macro_rules! assert_picture {
    ($picture:expr, $name:expr $(,)?) => {
        $crate::assert_picture!($picture, $name, 0)
    };
    ($picture:expr, $name:expr, $steps:expr $(,)?) => {
        if let Err(problem) = $crate::check(&$picture, $name, $steps, env!("CARGO_MANIFEST_DIR").as_ref()) {
            panic!("{problem}");
        }
    };
}

/// Compares a picture with the one that is stored as `tests/pictures/NAME.png` in a package's folder; each channel may
/// differ by `steps` of 255. With the variable `HALFWAY_UPDATE_PICTURES` set to 1 the picture is stored instead.
///
/// # Errors
/// A message with figures and the files that show the difference, or about a file that cannot be read or written.
pub fn check(picture: &Picture, name: &str, steps: u8, package: &Path) -> Result<(), String> {
    check_as(picture, name, steps, package, std::env::var_os("HALFWAY_UPDATE_PICTURES").is_some_and(|it| it == "1"))
}

fn check_as(picture: &Picture, name: &str, steps: u8, package: &Path, is_update: bool) -> Result<(), String> {
    let file = package.join("tests/pictures").join(format!("{name}.png"));
    let Picture::Byte(actual) = picture else {
        return Err(format!("{name}: a picture of floats; expected one of bytes"));
    };
    if is_update {
        return save(picture, &file);
    }
    if !file.is_file() {
        let file = file.display();
        return Err(format!(
            "{file}: there is no such picture; run the test with HALFWAY_UPDATE_PICTURES=1 to store it"
        ));
    }
    let expected = image::open(&file).map_err(|error| format!("{}: {error}", file.display()))?.into_rgba8();
    if expected.dimensions() != actual.dimensions() {
        let [(a, b), (c, d)] = [actual, &expected].map(image::RgbaImage::dimensions);
        return Err(format!("{}: the picture has {a} x {b} pixels; expected {c} x {d}", file.display()));
    }
    let worst = actual.as_raw().iter().zip(expected.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    if worst <= steps { Ok(()) } else { Err(told(picture, &Picture::Byte(expected), name, &file)) }
}

/// The message about a difference, which is drawn beside the actual picture.
fn told(actual: &Picture, expected: &Picture, name: &str, file: &Path) -> String {
    let encoding = Encoding::Srgb;
    let mut message = format!("{}: the picture differs", file.display());
    let (Picture::Byte(a), Picture::Byte(b)) = (actual, expected) else { return message };
    let [a, b] = [a, b].map(|image| Image::from_bytes(image, encoding));
    if let Ok(comparison) = compare(&a, &b, encoding) {
        let (at, steps) = (comparison.anywhere.at, comparison.anywhere.steps);
        let equal = 100.0 * comparison.equal;
        write!(message, ": {equal:.2} % of the pixels are equal; the largest difference is {steps} of 255, at {at:?}")
            .ok();
    }
    let folder = folder();
    let drawn = difference(&a, &b, encoding, Scale::default()).ok().map(|drawn| DynamicImage::from(drawn).into_rgba8());
    for (kind, picture) in [("actual", Some(actual.clone())), ("difference", drawn.map(Picture::Byte))] {
        let file = folder.join(format!("{name}-{kind}.png"));
        let Some(Ok(())) = picture.map(|picture| save(&picture, &file)) else { continue };
        write!(message, "\n  {kind}: {}", file.display()).ok();
    }
    message + "\nHALFWAY_UPDATE_PICTURES=1 stores the new picture"
}

/// `target/pictures` of the program that runs.
fn folder() -> PathBuf {
    let program = std::env::current_exe().unwrap_or_default();
    let target = program.ancestors().find(|folder| folder.join("CACHEDIR.TAG").is_file());
    target.map_or_else(std::env::temp_dir, Path::to_owned).join("pictures")
}

fn save(picture: &Picture, file: &Path) -> Result<(), String> {
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
    fs::create_dir_all(file.parent().unwrap_or(file)).map_err(|error| failed(&error))?;
    picture.save(file).map_err(|error| failed(&error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgba, RgbaImage};

    #[test]
    fn a_picture_is_stored_found_equal_and_told_apart() {
        let package = tempfile::tempdir().expect("a folder");
        let package = package.path();
        let mut image = RgbaImage::from_pixel(4, 3, Rgba([10, 20, 30, 255]));
        let picture = Picture::Byte(image.clone());
        let missing = check_as(&picture, "grey", 0, package, false).expect_err("none is stored");
        assert!(missing.contains("grey.png") && missing.contains("HALFWAY_UPDATE_PICTURES=1"), "{missing}");
        assert_eq!(check_as(&picture, "grey", 0, package, true), Ok(()));
        assert_eq!(check_as(&picture, "grey", 0, package, false), Ok(()));
        image.put_pixel(2, 1, Rgba([10, 22, 30, 255]));
        let other = Picture::Byte(image);
        assert_eq!(check_as(&other, "grey", 2, package, false), Ok(()));
        let told = check_as(&other, "grey", 1, package, false).expect_err("two steps");
        assert!(
            told.contains("91.67 % of the pixels are equal; the largest difference is 2 of 255, at (2, 1)"),
            "{told}"
        );
        for kind in ["actual", "difference"] {
            let file = told.lines().find_map(|line| line.trim().strip_prefix(kind)?.strip_prefix(": "));
            assert!(file.is_some_and(|file| Path::new(file).is_file()), "{kind}: {told}");
        }
        let small = Picture::Byte(RgbaImage::new(2, 2));
        let told = check_as(&small, "grey", 0, package, false).expect_err("another size");
        assert!(told.contains("2 x 2 pixels; expected 4 x 3"), "{told}");
    }

    #[test]
    fn the_macro_takes_pictures_of_this_package() {
        let picture = Picture::Byte(RgbaImage::from_fn(8, 8, |x, y| Rgba([32 * x as u8, 32 * y as u8, 0, 255])));
        assert_picture!(picture, "gradient");
        let package = env!("CARGO_MANIFEST_DIR").as_ref();
        assert!(check_as(&Picture::Byte(RgbaImage::new(8, 8)), "gradient", 9, package, false).is_err());
    }
}
