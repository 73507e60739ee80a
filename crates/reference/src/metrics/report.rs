//! The report of a failing image test.

use std::fs;
use std::path::Path;

use image::{ImageResult, RgbImage};

use super::comparison::Comparison;
use super::difference::difference;
use super::scale::Scale;
use crate::Image;

/// Writes `NAME.actual.png`, `NAME.expected.png` and `NAME.difference.png` into `folder`, and returns one line with the
/// largest error, its pixel, and the files.
///
/// Characters of `name` other than letters, digits, `-`, `_` and `.` become `_` in the files' names. If a picture
/// cannot be written, the line says so besides the failure.
///
/// ```
/// use halfway_lighting::Encoding;
/// use halfway_reference::Image;
/// use halfway_reference::metrics::{compare, report_failure};
///
/// let [expected, actual] = [0.5, 0.25].map(|gray| Image::new(1, 1, vec![[gray; 3]]));
/// let comparison = compare(&actual, &expected, Encoding::Srgb)?;
/// # let folder = std::env::temp_dir().join(format!("halfway_report_{}", std::process::id()));
/// if !comparison.is_within(1) {
///     let line = report_failure(&folder, "flat/point", &actual, &expected, &comparison);
///     assert!(line.starts_with("flat/point: up to 51 steps"), "{line}");
/// }
/// # std::fs::remove_dir_all(folder).unwrap();
/// # Ok::<(), halfway_reference::metrics::SizeMismatch>(())
/// ```
#[must_use]
pub fn report_failure(folder: &Path, name: &str, actual: &Image, expected: &Image, comparison: &Comparison) -> String {
    let stem: String = name.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
    let pictures = match leave(folder, &stem, actual, expected, comparison) {
        Ok(()) => format!("pictures: {}", folder.join(stem).display()) + ".{actual,expected,difference}.png",
        Err(problem) => format!("no pictures: {}: {problem}", folder.join(stem).display()),
    };
    format!("{name}: {comparison}; {pictures}")
}

fn leave(
    folder: &Path,
    stem: &str,
    actual: &Image,
    expected: &Image,
    comparison: &Comparison,
) -> Result<(), Box<dyn std::error::Error>> {
    let encoding = comparison.encoding;
    fs::create_dir_all(folder)?;
    let save =
        |kind: &str, picture: &RgbImage| -> ImageResult<()> { picture.save(folder.join(format!("{stem}.{kind}.png"))) };
    save("actual", &actual.to_bytes(encoding))?;
    save("expected", &expected.to_bytes(encoding))?;
    save("difference", &difference(actual, expected, encoding, Scale::default())?)?;
    Ok(())
}
