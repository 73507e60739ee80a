//! Inputs of the image reader on which fuzzing failed once, and its seeds: the files of `past_failures` here and of
//! `fuzz/seeds/image`.

use std::fs;
use std::path::Path;

use halfway_texture::{TexelMeaning, load};

#[test]
fn past_failures_and_seeds_do_not_panic() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for folder in ["../../fuzz/seeds/image", "tests/past_failures"] {
        for file in fs::read_dir(here.join(folder)).unwrap() {
            let file = file.unwrap().path();
            // Printed if the test fails.
            println!("{}", file.display());
            crate::fuzzed::feed(&fs::read(&file).unwrap());
            count += 1;
        }
    }
    assert!(count > 0);
}

/// The seeds are whole images, of every format.
#[test]
fn the_seeds_are_images() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/image");
    let mut endings = std::collections::BTreeSet::new();
    for file in fs::read_dir(folder).unwrap() {
        let file = file.unwrap().path();
        // Those that fuzzing kept have no ending.
        let Some(ending) = file.extension() else { continue };
        load(&file, TexelMeaning::Color).unwrap();
        endings.insert(ending.to_owned());
    }
    assert_eq!(
        endings.into_iter().collect::<Vec<_>>(),
        ["bmp", "exr", "gif", "hdr", "jpg", "png", "tga", "tiff", "webp"]
    );
}
