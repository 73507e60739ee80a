//! Pictures of what the viewer shows, written into files beside the window.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};

use halfway::prelude::*;
use halfway::record::{Continue, Recording, record};
use halfway::render::AdapterChoice;
use halfway::scene::{SceneFile, Turntable, spawn};

use crate::error::ViewerError;

/// The frames of a full turn, at 30 a second.
const TURN: u32 = 90;

/// A picture to be drawn.
pub(crate) struct Wanted {
    pub(crate) scene: SceneFile,
    pub(crate) base_dir: PathBuf,
    pub(crate) file: PathBuf,
    pub(crate) turns: bool,
    pub(crate) choice: AdapterChoice,
}

/// A picture that is being drawn by a thread of its own: at its end comes a sentence.
pub(crate) struct Drawing(Receiver<String>);

impl Drawing {
    pub(crate) fn begin(wanted: Wanted) -> Self {
        let (sender, receiver) = channel();
        std::thread::spawn(move || {
            let file = wanted.file.display().to_string();
            let sentence = match draw(wanted) {
                Ok(()) => format!("saved {file}"),
                Err(error) => error.to_string(),
            };
            // The window may be closed by now.
            let _ = sender.send(sentence);
        });
        Self(receiver)
    }

    /// The sentence, once it is done.
    pub(crate) fn ended(&self) -> Option<String> {
        self.0.try_recv().ok()
    }
}

fn draw(wanted: Wanted) -> Result<(), ViewerError> {
    let Wanted { scene, base_dir, file, turns, choice } = wanted;
    let size = UVec2::from_array(scene.size);
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(size)).insert_resource(choice);
    let spawned = spawn(&scene, &base_dir, app.world_mut()).map_err(ViewerError::Scene)?;
    let mut recording = Recording { size, ..Recording::new(file) };
    if turns {
        recording.frames = 0..TURN;
        Turntable::turn(&mut app, spawned.camera, Vec3::Y, std::f32::consts::TAU / TURN as f32);
    }
    record(&mut app, &recording, |_, _| Continue::Yes).map_err(|error| ViewerError::Picture(error.to_string()))
}
