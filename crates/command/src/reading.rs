//! The files of the command line, and how models among them are read.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use halfway::mesh::{Format, LoadOptions, LoadProgress, Model, load_stream, load_with};

use crate::failure::Failure;
use crate::progress::Bar;

const EXPECTED: &str = "neither a scene that is known by a name nor a file that ends in .json, .smf, .obj, .gltf, .glb, .ply, .stl, .off or .3mf";
/// The name of standard input and standard output.
pub(crate) const STANDARD: &str = "-";

/// A scene file or models.
#[derive(Args, Clone, Debug)]
pub(crate) struct InputArgs {
    /// A scene file (.json), or models (.smf, .obj, .gltf, .glb, .ply, .stl, .off, .3mf): all in one picture, each at its own
    /// coordinates; - reads a model from standard input, of --format
    #[arg(value_name = "SCENE|MODELS", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

impl InputArgs {
    /// The ending of the picture's format.
    pub(crate) fn picture_format(&self) -> Option<&'static str> {
        self.reading.picture_format()
    }

    /// Refuses the format of a picture where none is written.
    pub(crate) fn without_picture(&self) -> Result<(), Failure> {
        self.reading.without_picture()
    }
}

/// How model files are read.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct ReadingArgs {
    /// The format of the models, whatever their names end in, or of the picture, or both, such as stl,png
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', value_parser = formats())]
    format: Vec<GivenFormat>,
    /// Read files that the models refer to outside their own folders, too
    #[arg(long)]
    outside: bool,
    /// The most bytes of a file [default: any number, and 1 GiB through a pipe]
    #[arg(skip)]
    limit: Option<u64>,
}

/// A value of `--format`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GivenFormat {
    Model(Format),
    /// By the ending of its files.
    Picture(&'static str),
}

const PICTURES: [&str; 4] = ["png", "jpeg", "webp", "exr"];

fn formats() -> impl TypedValueParser<Value = GivenFormat> {
    let models = Format::ALL.map(|format| (format.extension(), GivenFormat::Model(format)));
    let all: Vec<_> = models.into_iter().chain(PICTURES.map(|ending| (ending, GivenFormat::Picture(ending)))).collect();
    PossibleValuesParser::new(all.iter().map(|(ending, _)| *ending).collect::<Vec<_>>()).try_map(move |text| {
        all.iter().find(|(ending, _)| *ending == text).map(|(_, format)| *format).ok_or("not one of the values")
    })
}

impl ReadingArgs {
    /// For files of at most so many bytes.
    pub(crate) fn within(limit: u64) -> Self {
        Self { limit: Some(limit), ..Self::default() }
    }

    /// The formats of models, in their order.
    pub(crate) fn model_formats(&self) -> Vec<Format> {
        let of_model =
            |format: &GivenFormat| if let GivenFormat::Model(format) = format { Some(*format) } else { None };
        self.format.iter().filter_map(of_model).collect()
    }

    /// How a model of this format is read.
    pub(crate) fn options(&self, format: Option<Format>) -> LoadOptions {
        LoadOptions { outside: self.outside, format, limit: self.limit }
    }

    /// The ending of the picture's format.
    fn picture_format(&self) -> Option<&'static str> {
        self.format
            .iter()
            .find_map(|format| if let GivenFormat::Picture(ending) = format { Some(*ending) } else { None })
    }

    /// Refuses the format of a picture where none is written.
    pub(crate) fn without_picture(&self) -> Result<(), Failure> {
        self.picture_format().map_or(Ok(()), |format| {
            Err(format!("--format {format}: no picture is written; expected the format of a model").into())
        })
    }

    /// Reads a model file or standard input.
    pub(crate) fn load(&self, file: &Path) -> Result<Model, Failure> {
        let options = self.options(self.model_formats().first().copied());
        let model = if file == Path::new(STANDARD) {
            let Some(format) = options.format else {
                return Err(
                    "standard input: the format is not known; expected --format smf, obj, glb, ply, stl, off or 3mf"
                        .to_owned()
                        .into(),
                );
            };
            load_stream(format, Path::new("standard input"), std::io::stdin().lock(), options)
        } else if options.format.is_none() && Format::from_path(file).is_none() {
            let way = Format::converter(file).map_or_else(String::new, |way| format!(" ({way})"));
            return Err(format!("{}: {EXPECTED}{way}", file.display()).into());
        } else {
            // Until a picture is begun, Ctrl-C ends the process at once.
            let bar = Bar::after(Duration::from_secs(1));
            load_with(file, options, &mut |LoadProgress { done, of }| {
                bar.show(done, of, "reading");
                ControlFlow::Continue(())
            })
        };
        Ok(model?)
    }
}
