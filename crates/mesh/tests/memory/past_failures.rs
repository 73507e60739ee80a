//! Inputs on which fuzzing failed once, and its seeds: the files of `past_failures/TARGET/` here and of
//! `fuzz/seeds/TARGET/`.

use std::fs;
use std::path::Path;

use crate::{ALLOCATOR, alone, targets};

/// Feeds all files of the folders in a folder, which are named after targets; returns how many there are.
fn feed_all(folder: &Path) -> usize {
    let mut count = 0;
    for target in fs::read_dir(folder).unwrap() {
        let target = target.unwrap();
        let name = target.file_name().into_string().unwrap();
        // Readers of other crates, which feed their own.
        if name == "scene" || name == "image" {
            continue;
        }
        for file in fs::read_dir(target.path()).unwrap() {
            let file = file.unwrap().path();
            // Shown where the test fails.
            println!("{}", file.display());
            targets::feed(&name, &fs::read(&file).unwrap(), &ALLOCATOR);
            count += 1;
        }
    }
    count
}

#[test]
fn past_failures_and_seeds_are_read_or_refused_soundly() {
    let _alone = alone();
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    assert!(feed_all(&here.join("../../fuzz/seeds")) > 0);
    feed_all(&here.join("tests/past_failures"));
}
