//! The property that fuzzing checks of the reader of scene files: that it does not panic, that an error names the file, and that what
//! was read can be written, and is read again as the same scene.

use halfway_scene::SceneFile;

/// Reads the bytes as a scene file. Bytes that are no UTF-8 are refused before, with the file.
pub(crate) fn feed(bytes: &[u8]) {
    let Ok(text) = str::from_utf8(bytes) else { return };
    match SceneFile::from_json(text, "fuzzed.json") {
        Ok(scene) => {
            let written = scene.to_json().expect("what was read can be written");
            let again = SceneFile::from_json(&written, "written.json").expect("what was written can be read");
            // Only what the file says is warned of.
            assert_eq!(again, SceneFile { warnings: Vec::new(), ..scene });
        }
        Err(error) => assert!(error.to_string().starts_with("fuzzed.json:"), "{error}"),
    }
}
