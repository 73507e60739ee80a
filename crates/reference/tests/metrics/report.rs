//! Reports of failing tests.

use std::fs;
use std::path::{Path, PathBuf};

use halfway_lighting::Encoding::Srgb;
use halfway_reference::metrics::{compare, report_failure};

use crate::grey;

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("metrics").join(test);
    let _ = fs::remove_dir_all(&folder);
    folder
}

#[test]
fn three_pictures_and_one_line() {
    let folder = folder("report");
    let (actual, expected) = (grey(2, &[0.5, 0.25]), grey(2, &[0.5, 0.5]));
    let comparison = compare(&actual, &expected, Srgb).unwrap();
    let line = report_failure(&folder, "flat × point/1", &actual, &expected, &comparison);
    assert!(!line.contains('\n') && line.starts_with("flat × point/1: up to 51 steps"), "{line}");
    assert!(line.contains("(1, 0) red"), "{line}");
    for kind in ["actual", "expected", "difference"] {
        let file = folder.join(format!("flat___point_1.{kind}.png"));
        assert!(image::open(&file).is_ok(), "{}", file.display());
    }
    assert!(line.contains("flat___point_1.{actual,expected,difference}.png"), "{line}");
    let kept = image::open(folder.join("flat___point_1.actual.png")).unwrap().into_rgb8();
    assert_eq!(kept, actual.to_bytes(Srgb));
}

#[test]
fn an_unwritable_folder_does_not_hide_the_failure() {
    let folder = folder("unwritable");
    fs::create_dir_all(folder.parent().unwrap()).unwrap();
    let _ = fs::remove_file(&folder);
    fs::write(&folder, "a file").unwrap();
    let (actual, expected) = (grey(2, &[0.5, 0.25]), grey(2, &[0.5, 0.5]));
    let comparison = compare(&actual, &expected, Srgb).unwrap();
    let line = report_failure(&folder, "row", &actual, &expected, &comparison);
    assert!(line.contains("up to 51 steps") && line.contains("no pictures: "), "{line}");
}
