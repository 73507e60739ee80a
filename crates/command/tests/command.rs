//! The `halfway` command from outside: its output, and its errors for bad input.

mod command {
    mod adapters;
    mod bad_input;
    #[cfg(feature = "measure")]
    mod bench;
    #[cfg(feature = "measure")]
    mod chart;
    mod demos;
    mod explain;
    mod lines;
    mod looks;
    mod marking;
    mod models;
    mod pictures;
    mod reference;
    mod terms;
    mod tolerances;

    use std::fs;
    use std::path::{Path, PathBuf};
    use std::process::{Command, Output};

    /// A folder of its own for each test, empty at the start.
    fn folder(test: &str) -> PathBuf {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("command").join(test);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("the target folder can be written");
        folder
    }

    fn halfway(folder: &Path, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_halfway"))
            .args(arguments)
            .current_dir(folder)
            .output()
            .expect("the command was built with this test")
    }

    /// A file of the repository, by its path from there.
    fn asset(name: &str) -> String {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name).to_string_lossy().into_owned()
    }

    #[track_caller]
    fn succeeds(folder: &Path, arguments: &[&str]) -> String {
        let output = halfway(folder, arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {:?}: {error}", output.status);
        String::from_utf8_lossy(&output.stdout).into_owned()
    }
}
