//! Past findings of fuzzing in the reader of scene files, and its seeds: the files of `past_failures` here and
//! of `fuzz/seeds/scene`.

use std::fs;
use std::path::Path;

use crate::fuzzed::feed;

#[test]
fn past_failures_and_seeds_are_read_or_refused_soundly() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for folder in ["../../fuzz/seeds/scene", "tests/past_failures"] {
        for file in fs::read_dir(here.join(folder)).unwrap() {
            let file = file.unwrap().path();
            // Shown where the test fails.
            println!("{}", file.display());
            feed(&fs::read(&file).unwrap());
            count += 1;
        }
    }
    assert!(count > 0);
}
