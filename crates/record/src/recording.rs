//! Pictures without a window: one, a numbered sequence, or an animated PNG.

use std::io::{IsTerminal, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use bevy_app::{App, AppExit, Plugin, PluginsState};
use bevy_math::UVec2;
use bevy_time::TimeUpdateStrategy;
use halfway_lighting::{Camera, Encoding, Intensity};
use halfway_reference::OracleError;
use halfway_render::{Headless, Picture, Pixels, Quantity, RenderError, render_picture, take_quantities};
use thiserror::Error;

use crate::oracle_quantities::{self, OracleFrame};
use crate::output::{
    AnimationWriter, ContactSheet, FrameDelay, OutputError, PictureFormat, check_quantity_file, encode_picture,
    write_picture, write_quantities,
};

/// Makes the target a texture of `size` pixels. Part of `HalfwayPlugins::headless`.
///
/// ```no_run
/// use bevy_app::App;
/// use bevy_math::UVec2;
/// use halfway_record::HeadlessPlugin;
/// use halfway_render::{RenderPlugin, render_picture};
///
/// let mut app = App::new();
/// app.add_plugins((HeadlessPlugin { size: UVec2::new(640, 480) }, RenderPlugin::default()));
/// let picture = render_picture(&mut app)?;
/// assert_eq!(picture.dimensions(), (640, 480));
/// # Ok::<(), halfway_render::RenderError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeadlessPlugin {
    /// Width and height in pixels, each at least 1.
    pub size: UVec2,
}

impl Plugin for HeadlessPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Headless { size: self.size, ..Headless::default() });
    }
}

/// The frames to draw and the files to write. As a plugin it gives the App a runner that records and exits.
///
/// ```
/// use bevy_math::UVec2;
/// use halfway_record::Recording;
///
/// // Two seconds of an animated PNG.
/// let mut recording = Recording::new("turntable.png".into());
/// recording.frames = 0..60;
/// recording.size = UVec2::new(320, 240);
/// assert_eq!(recording.rate, 30);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// The file. One frame makes a picture: `.png`, `.jpg`, `.webp` or `.exr`. More make an animated PNG, or a file each
    /// where the path has a `{}`, which becomes the frame's number with four digits. `-` is standard output, for one
    /// frame.
    pub path: PathBuf,
    /// The frames to keep, counted from 0. Those before the first run as well, since motion continues from frame to
    /// frame; they are drawn small, or in full if the camera's intensity policy depends on the frame before. Default
    /// 0..1.
    pub frames: Range<u32>,
    /// Width and height in pixels. Default 1280 × 720.
    pub size: UVec2,
    /// Bits a channel, as [`PictureFormat::from_path`] takes them; `None` is the format's default.
    pub bits: Option<u32>,
    /// The format of pictures, as the ending of a file without its dot; `None` where the path has it. PNG on standard
    /// output.
    pub format: Option<String>,
    /// Frames a second: the App's time advances by 1/`rate` between frames. Default 30.
    pub rate: u16,
    /// The file for a contact sheet of up to 16 of the frames, if any.
    pub contact_sheet: Option<PathBuf>,
    /// Quantities to write beside the picture, each with its file, `.exr` or `.png` ([`write_quantities`]); those with
    /// one EXR share it. Where the path of a sequence has a `{}`, these have one, too. Default none.
    pub also: Vec<(Quantity, PathBuf)>,
}

impl Recording {
    /// The default size.
    pub const SIZE: UVec2 = UVec2::new(1280, 720);

    /// Records the first frame, at 1280 × 720, to `path`.
    pub fn new(path: PathBuf) -> Self {
        Self {
            path,
            frames: 0..1,
            size: Self::SIZE,
            bits: None,
            format: None,
            rate: 30,
            contact_sheet: None,
            also: Vec::new(),
        }
    }

    /// Whether the picture goes to standard output.
    pub fn is_standard_output(&self) -> bool {
        self.path == Path::new("-")
    }

    /// The format of the picture of a frame.
    ///
    /// # Errors
    /// As [`PictureFormat::from_path`].
    pub fn format_of(&self, frame: u32) -> Result<PictureFormat, OutputError> {
        let path = self.path_of(frame);
        let ending = self.format.as_deref().or(self.is_standard_output().then_some("png"));
        // Errors name the file as it was given.
        match ending {
            Some(ending) => PictureFormat::from_ending(ending, &path, self.bits),
            None => PictureFormat::from_path(&path, self.bits),
        }
    }

    /// Writes the picture of a frame to its file, or to standard output.
    ///
    /// # Errors
    /// As [`write_picture`].
    pub fn write(&self, frame: u32, picture: &Picture, encoding: Encoding) -> Result<(), OutputError> {
        let format = self.format_of(frame)?;
        if self.is_standard_output() {
            let name = Path::new("standard output");
            return encode_picture(picture, &mut std::io::stdout().lock(), name, format, encoding);
        }
        write_picture(picture, &self.path_of(frame), format, encoding)
    }

    /// Whether the frames go into one animated PNG.
    fn is_animation(&self) -> bool {
        self.frames.len() > 1 && !self.is_sequence()
    }

    fn is_sequence(&self) -> bool {
        self.path.to_string_lossy().contains("{}")
    }

    fn path_of(&self, frame: u32) -> PathBuf {
        numbered(&self.path, frame)
    }

    /// Writes the quantities of the newest frame.
    fn write_quantities(&self, app: &mut App, frame: u32) -> Result<(), RecordError> {
        if self.also.is_empty() {
            return Ok(());
        }
        let quantities: Vec<_> = self.also.iter().map(|&(quantity, _)| quantity).collect();
        let files = self.also.iter().map(|(_, file)| numbered(file, frame));
        let world = app.world_mut();
        let images = match world.remove_resource::<OracleFrame>() {
            Some(frame) => oracle_quantities::quantities(world, frame, &quantities)?,
            None => take_quantities(world, &quantities)?,
        };
        let images: Vec<_> = images.into_iter().zip(files).collect();
        Ok(write_quantities(&images)?)
    }
}

/// A file's name, with the frame's number in place of a `{}`.
fn numbered(path: &Path, frame: u32) -> PathBuf {
    match path.to_string_lossy() {
        name if name.contains("{}") => PathBuf::from(name.replace("{}", &format!("{frame:04}"))),
        _ => path.to_owned(),
    }
}

impl Plugin for Recording {
    fn build(&self, app: &mut App) {
        let recording = self.clone();
        app.set_runner(move |mut app| match record(&mut app, &recording, on_stderr) {
            Ok(()) => {
                println!("{}", recording.path.display());
                if let Some(sheet) = &recording.contact_sheet {
                    println!("{}", sheet.display());
                }
                app.should_exit().unwrap_or(AppExit::Success)
            }
            Err(error) => {
                eprintln!("error: {error}");
                AppExit::from_code(2)
            }
        });
    }
}

/// Reports the progress of an animation on standard error; on a terminal as a bar, else every tenth part.
fn on_stderr(done: u32, of: u32) -> Continue {
    const WIDTH: u32 = 40;
    if of > 1 {
        let mut stderr = std::io::stderr().lock();
        // A closed standard error is ignored.
        let _ = if stderr.is_terminal() {
            let full = (WIDTH * done / of) as usize;
            let end = if done == of { "\n" } else { "" };
            write!(stderr, "\r[{:<width$}] {done}/{of} frames{end}", "=".repeat(full), width = WIDTH as usize)
        } else if done * 10 / of > (done - 1) * 10 / of {
            writeln!(stderr, "{done}/{of} frames")
        } else {
            Ok(())
        };
    }
    Continue::Yes
}

/// Parses a size in pixels, such as `1280x720`.
///
/// ```
/// assert_eq!(halfway_record::parse_size("640x480")?, bevy_math::UVec2::new(640, 480));
/// assert!(halfway_record::parse_size("640").is_err());
/// # Ok::<(), String>(())
/// ```
///
/// # Errors
/// The message names the expected sizes: each side from 1 to 16384.
pub fn parse_size(text: &str) -> Result<UVec2, String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (1..=16384).contains(side));
    text.split_once(['x', 'X', '×'])
        .and_then(|(width, height)| Some(UVec2::new(side(width)?, side(height)?)))
        .ok_or_else(|| format!("size {text}: expected WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 1280x720"))
}

/// Whether to go on after a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continue {
    /// Draw the next frame.
    Yes,
    /// Stop; an animation leaves no file, finished files of a sequence stay.
    No,
}

/// Why a recording failed.
#[derive(Debug, Error)]
pub enum RecordError {
    /// A frame could not be drawn.
    #[error("{0}")]
    Render(#[from] RenderError),
    /// The reference renderer cannot draw a frame.
    #[error("{0}")]
    Oracle(#[from] OracleError),
    /// A frame could not be written.
    #[error("{0}")]
    Output(#[from] OutputError),
    /// The contact sheet has the name of the animation, or of a frame.
    #[error("{}: is to be both the contact sheet and a picture; expected two names", .0.display())]
    SheetOverFrame(PathBuf),
    /// A quantity has the name of the picture.
    #[error("{}: is to be both a picture and a quantity; expected two names", .0.display())]
    QuantityOverFrame(PathBuf),
    /// Several frames are to be written into one file of a quantity.
    #[error("{}: is to hold a quantity of several frames; expected a name with {{}}, which becomes the frame's number", .0.display())]
    OneFileForAll(PathBuf),
    /// There is no frame in the range.
    #[error("frames {}..{}: the range is empty; expected A..B with A below B", .0.start, .0.end)]
    NoFrames(Range<u32>),
    /// The progress function stopped it.
    #[error("stopped at frame {0}")]
    Stopped(u32),
}

/// A frame that is to be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameToDraw {
    /// Counted from 0, as in [`Recording::frames`].
    pub number: u32,
    /// Width and height in pixels.
    pub size: UVec2,
    /// The pixels with which the file can be written without loss.
    pub pixels: Pixels,
}

/// Runs `app` frame by frame and writes the pictures. Time advances by exactly 1/rate a frame, so that recordings
/// repeat, to the byte on the same adapter. `progress` is called with the number of finished frames and of all frames,
/// and may stop the work.
///
/// # Errors
/// The first error of drawing or writing a frame.
pub fn record(
    app: &mut App,
    recording: &Recording,
    progress: impl FnMut(u32, u32) -> Continue,
) -> Result<(), RecordError> {
    record_with(app, recording, |app, _| Ok(render_picture(app)?), progress)
}

/// [`record`] with another renderer, such as [`ReferenceDrawing::picture`](crate::ReferenceDrawing::picture). For each
/// frame that is kept, and for those before on which it depends, `draw` runs the App once and returns the picture.
///
/// # Errors
/// The first error of drawing or writing a frame.
pub fn record_with(
    app: &mut App,
    recording: &Recording,
    mut draw: impl FnMut(&mut App, FrameToDraw) -> Result<Picture, RecordError>,
    mut progress: impl FnMut(u32, u32) -> Continue,
) -> Result<(), RecordError> {
    if recording.frames.is_empty() {
        return Err(RecordError::NoFrames(recording.frames.clone()));
    }
    let mut sink = Sink::new(recording)?;
    let pixels = if recording.is_animation() { Pixels::Byte } else { recording.format_of(0)?.pixels() };
    let [full, small] =
        [recording.size, (recording.size / SMALLER).max(UVec2::ONE)].map(|size| Headless { size, pixels });
    app.insert_resource(full);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs(1) / u32::from(recording.rate.max(1))));
    ready(app);
    for number in 0..recording.frames.start {
        if depends_on_the_frame_before(app) {
            app.insert_resource(full);
            draw(app, FrameToDraw { number, size: recording.size, pixels })?;
        } else {
            app.insert_resource(small);
            app.update();
        }
    }
    app.insert_resource(full);
    for number in recording.frames.clone() {
        let picture = draw(app, FrameToDraw { number, size: recording.size, pixels })?;
        sink.write(number, &picture, encoding(app))?;
        recording.write_quantities(app, number)?;
        let done = number - recording.frames.start + 1;
        if progress(done, recording.frames.len() as u32) == Continue::No {
            return Err(RecordError::Stopped(number));
        }
    }
    sink.finish(encoding(app))
}

/// The factor by which frames before the first are scaled down along each side.
const SMALLER: u32 = 16;

/// Whether the camera's picture may depend on the frame before, so that all frames have to be drawn. A camera that is
/// spawned later may be of either kind.
fn depends_on_the_frame_before(app: &mut App) -> bool {
    let world = app.world_mut();
    let mut cameras = world.query::<&Camera>();
    let follows = |intensity| matches!(intensity, Intensity::Renormalize { smoothing } if smoothing > 0.0);
    cameras.iter(world).next().is_none_or(|camera| follows(camera.intensity))
}

/// Finishes the plugins, which is a runner's task.
fn ready(app: &mut App) {
    if app.plugins_state() != PluginsState::Cleaned {
        app.finish();
        app.cleanup();
    }
}

fn encoding(app: &mut App) -> Encoding {
    camera(app).encoding
}

/// The world's camera; a default one where there is none, which the renderer will refuse.
pub(crate) fn camera(app: &mut App) -> Camera {
    let world = app.world_mut();
    world.query::<&Camera>().iter(world).next().copied().unwrap_or_default()
}

/// The destination of frames.
struct Sink<'a> {
    recording: &'a Recording,
    animation: Option<AnimationWriter>,
    sheet: Option<(&'a Path, ContactSheet)>,
}

/// Whether both paths lead to one file, existing or not.
fn is_same_file(a: &Path, b: &Path) -> bool {
    if a.file_name() != b.file_name() {
        // Different names may still be links to one file.
        return matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
    }
    let folder = |file: &Path| {
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        folder.canonicalize().or_else(|_| std::path::absolute(folder)).ok()
    };
    folder(a) == folder(b)
}

const SHEET_CELLS: u32 = 16;

impl<'a> Sink<'a> {
    fn new(recording: &'a Recording) -> Result<Self, RecordError> {
        // Refuses a bad ending before the first frame is drawn.
        if recording.is_animation() {
            AnimationWriter::check(&recording.path)?;
            if let Some(bits) = recording.bits.filter(|&bits| bits != 8) {
                let file = recording.path.clone();
                return Err(OutputError::Bits { file, bits, expected: "8 in an animated PNG" }.into());
            }
        } else {
            recording.format_of(0)?;
        }
        for (quantity, file) in &recording.also {
            check_quantity_file(*quantity, file)?;
            if recording.frames.len() > 1 && !file.to_string_lossy().contains("{}") {
                return Err(RecordError::OneFileForAll(file.clone()));
            }
            if recording.frames.clone().any(|frame| is_same_file(&recording.path_of(frame), &numbered(file, frame))) {
                return Err(RecordError::QuantityOverFrame(file.clone()));
            }
        }
        if let Some(sheet) = &recording.contact_sheet {
            PictureFormat::from_path(sheet, Some(8))?;
            if recording.frames.clone().any(|frame| is_same_file(&recording.path_of(frame), sheet)) {
                return Err(RecordError::SheetOverFrame(sheet.clone()));
            }
        }
        Ok(Self { recording, animation: None, sheet: None })
    }

    fn write(&mut self, frame: u32, picture: &Picture, encoding: Encoding) -> Result<(), RecordError> {
        let recording = self.recording;
        if recording.is_animation() {
            let animation = match &mut self.animation {
                Some(animation) => animation,
                none => none.insert(AnimationWriter::create(
                    &recording.path,
                    picture.dimensions(),
                    recording.frames.len() as u32,
                    FrameDelay::per_second(recording.rate),
                    encoding,
                )?),
            };
            animation.frame(picture)?;
        } else {
            recording.write(frame, picture, encoding)?;
        }
        if let Some(path) = &recording.contact_sheet {
            let index = frame - recording.frames.start;
            if index.is_multiple_of((recording.frames.len() as u32).div_ceil(SHEET_CELLS)) {
                let (_, sheet) = self.sheet.get_or_insert_with(|| (path, ContactSheet::new(4, 400, encoding)));
                sheet.push(picture);
            }
        }
        Ok(())
    }

    fn finish(self, encoding: Encoding) -> Result<(), RecordError> {
        if let Some(animation) = self.animation {
            animation.finish()?;
        }
        if let Some((path, sheet)) = self.sheet {
            write_picture(&sheet.picture(), path, PictureFormat::Png8, encoding)?;
        }
        Ok(())
    }
}
