//! Invalid recordings are refused before anything is drawn.

use bevy_app::App;
use halfway_record::output::OutputError;
use halfway_record::{Continue, RecordError, Recording, record_with};
use std::path::{Path, PathBuf};

/// Records where no frame may be drawn.
fn refused(recording: &Recording) -> RecordError {
    let draw = |_: &mut App, _| -> Result<_, RecordError> { panic!("a frame was drawn") };
    record_with(&mut App::new(), recording, draw, |_, _| Continue::Yes).expect_err("it cannot be recorded")
}

#[test]
fn an_animation_in_another_format_is_refused_early() {
    for name in ["turn.exr", "turn.gif", "turn"] {
        let recording = Recording { frames: 0..2, ..Recording::new(name.into()) };
        let error = refused(&recording);
        assert!(
            matches!(&error, RecordError::Output(OutputError::UnknownEnding { file, .. }) if file == Path::new(name))
        );
    }
}

#[test]
fn a_contact_sheet_is_a_file_of_its_own() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("refused");
    std::fs::create_dir_all(&folder).expect("the target folder can be written");
    let at = |name: &str| folder.join(name);
    let rows = [
        (at("a.png"), at("a.png")),
        (at("a.png"), at("../refused/a.png")),
        (at("a.png"), at("./a.png")),
        (PathBuf::from("a.png"), PathBuf::from("./a.png")),
        (at("missing/a.png"), at("missing/a.png")),
        (at("a-{}.png"), at("a-0004.png")),
    ];
    for (path, sheet) in rows {
        let recording = Recording { frames: 3..5, contact_sheet: Some(sheet.clone()), ..Recording::new(path) };
        assert!(matches!(refused(&recording), RecordError::SheetOverFrame(file) if file == sheet), "{recording:?}");
    }
}
