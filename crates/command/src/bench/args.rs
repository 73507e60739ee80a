//! The options of `halfway bench`.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use halfway::lighting::Choices;
use halfway::prelude::*;
use halfway_chart::timing::TimedShading;

use crate::adapters::AdapterArgs;
use crate::drawing::SizeArgs;
use crate::failure::Failure;
use crate::scenery::BenchmarkScene;
use crate::scenery::growth::Growing;
use crate::tolerance::ToleranceArgs;

#[derive(Args, Debug)]
pub(crate) struct BenchArgs {
    /// The subject: a scene file or a model, its camera turning by 1° a frame; or one of these
    ///
    /// s1: one sphere of 261,120 triangles, 4 lights, 1280 × 720;
    /// s1x16: the same under 16 lights;
    /// s2: 10,000 turning spheres of 224 triangles each, 1 light, 1280 × 720;
    /// s3: 400 spheres on a plane, 256 moving lights of range 12, 1280 × 720;
    /// s4: one sphere of 3,968 triangles, 1 light, 256 × 256;
    /// s5: 60 objects of five kinds, 2,393,700 triangles, 6 lights, 1280 × 720;
    /// s6: one scan of 1,000,000 triangles with noise, 3 lights, 1280 × 720;
    /// features: the cost of each feature of lighting once a vertex and once a pixel, beside one directional light;
    /// lights: the CPU's cost of a light for each patch that it touches, and of one of 20,000 that touches nothing;
    /// growth: own CPU, drawing and memory over objects, lights, triangles and pixels, up to a million and more;
    /// load: the parts of the time from a model file to its first picture
    #[arg(value_name = "s1|s1x16|s2|s3|s4|s5|s6|features|lights|growth|load|SCENE|MODEL", verbatim_doc_comment)]
    pub(super) subject: OsString,
    /// The model file of `load`
    #[arg(value_name = "FILE", required_if_eq("subject", "load"))]
    file: Option<PathBuf>,
    #[command(flatten)]
    pub(super) size: SizeArgs,
    #[command(flatten)]
    pub(super) adapter: AdapterArgs,
    /// Draw the spheres of S2 as octahedra: 10,000 moving entities and few triangles
    #[arg(long)]
    pub(super) octahedra: bool,
    #[command(flatten)]
    pub(super) tolerance: ToleranceArgs,
    /// Rounds; each times two frames of everything that is compared, in turn
    #[arg(long, default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(super) rounds: u32,
    /// Also time the first frame without the shaders that the driver keeps on disk (Mesa's do)
    #[arg(long)]
    pub(super) cold: bool,
    /// Print JSON instead of a table: all figures
    #[arg(long)]
    pub(super) json: bool,
    /// Of `growth`: also write its chart, an SVG
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Measure one point of `growth` and print its values, for the table, which takes each from a process of its own
    #[arg(long, hide = true)]
    pub(super) point: Option<Growing>,
    /// Draw one frame of one shading and print when it was finished and the peak memory, for the table's last columns,
    /// each from a process of its own
    #[arg(long, value_enum, hide = true)]
    pub(super) once: Option<BenchShading>,
}

/// The subject of a benchmark.
pub(super) enum Subject {
    Scene(BenchmarkScene),
    Features,
    Lights,
    Growth,
    /// The loading of a model.
    Load(PathBuf),
    /// A scene file or a model.
    File(PathBuf),
}

impl BenchArgs {
    pub(super) fn subject(&self) -> Subject {
        match self.subject.to_str().unwrap_or_default() {
            "features" => Subject::Features,
            "lights" => Subject::Lights,
            "growth" => Subject::Growth,
            "load" => Subject::Load(self.file.clone().unwrap_or_default()),
            name => match BenchmarkScene::from_str(name, false) {
                Ok(scene) => Subject::Scene(scene),
                Err(_) => Subject::File(PathBuf::from(&self.subject)),
            },
        }
    }

    /// Refuses a chart of anything but growth.
    pub(super) fn expect_chart_of_growth(&self) -> Result<(), Failure> {
        if self.output.is_some() && !matches!(self.subject(), Subject::Growth) {
            return Err("--output: expected the subject growth, of which it is the chart".to_owned().into());
        }
        Ok(())
    }

    /// Refuses the options that apply to scenes only.
    pub(super) fn expect_no_scene(&self, subject: &str) -> Result<(), Failure> {
        let about_scenes = self.size.size.is_some() || self.octahedra || self.tolerance.given().is_some();
        if about_scenes || self.cold || self.once.is_some() {
            return Err(format!("bench {subject}: expected no option but --adapter, --rounds and --json").into());
        }
        Ok(())
    }
}

/// How a scene is shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BenchShading {
    /// In a constant colour, without lights.
    Constant,
    /// By one of the shadings that have names.
    Shaded(Shading),
    /// Phong with all lights on the full mesh, whatever the tolerance. The other rows show the saving of the tolerance
    /// relative to it.
    ExactPhong,
}

impl BenchShading {
    /// A constant colour first, exact Phong shading last.
    pub(super) const ALL: [Self; Shading::LIT.len() + 2] = {
        let mut all = [Self::Constant; Shading::LIT.len() + 2];
        let mut i = 0;
        while i < Shading::LIT.len() {
            all[1 + i] = Self::Shaded(Shading::LIT[i]);
            i += 1;
        }
        all[1 + i] = Self::ExactPhong;
        all
    };

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Shaded(shading) => shading.choice().map_or("", |choice| choice.key),
            Self::ExactPhong => "exact-phong",
        }
    }

    /// The tolerance of its pictures; `said` is that of the command line.
    pub(super) fn tolerance(self, said: Tolerance) -> Tolerance {
        if self == Self::ExactPhong { Tolerance::EXACT } else { said }
    }

    pub(super) fn look(self) -> TimedShading {
        match self {
            Self::Constant => TimedShading::Constant,
            Self::Shaded(shading) => TimedShading::Shaded(shading),
            Self::ExactPhong => TimedShading::Shaded(Shading::Phong),
        }
    }
}

impl ValueEnum for BenchShading {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}
