//! What a failing image test leaves behind.

use std::fs;
use std::path::Path;

use image::{ImageResult, RgbImage};

use super::comparison::Comparison;
use super::difference::difference;
use super::scale::Scale;
use crate::Image;

/// Leaves `NAME.actual.png`, `NAME.expected.png` and `NAME.difference.png` in `folder`, and says in one line where and
/// how far off, and where the pictures are.
///
/// Characters of `name` other than letters, digits, `-`, `_` and `.` become `_` in the files' names. A picture that
/// cannot be written is said to be so in the line; the failure that it was to show stands.
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
