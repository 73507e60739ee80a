//! What `halfway bench` can be asked.

use clap::{Args, ValueEnum};
use halfway::prelude::*;
use halfway::record::parse_size;
use halfway_chart::timing::TimedLook;

use crate::levels::LevelsArgs;

#[derive(Args, Debug)]
pub(crate) struct BenchArgs {
    /// What is timed
    #[arg(value_enum)]
    pub(super) subject: Subject,
    /// Width and height in pixels [default: the scene's]; 16x16 leaves hardly more than the work before the pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(super) size: Option<UVec2>,
    /// Draw the spheres of S2 as octahedra: 10,000 moving entities and few triangles
    #[arg(long)]
    pub(super) octahedra: bool,
    #[command(flatten)]
    pub(super) levels: LevelsArgs,
    /// Rounds; each times two frames of everything that is compared, in turn
    #[arg(long, default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(super) rounds: u32,
    /// Also time the first frame without the shaders that the driver keeps on disk (Mesa's do)
    #[arg(long)]
    pub(super) cold: bool,
    /// Print JSON instead of a table: all figures
    #[arg(long)]
    pub(super) json: bool,
    /// Draw one frame of one shading and print when it was finished and the peak memory: what the table's last
    /// columns run in a process of their own
    #[arg(long, value_enum, hide = true)]
    pub(super) once: Option<BenchShading>,
}

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Subject {
    /// One sphere of 261,120 triangles, 4 lights, 1280 × 720
    S1,
    /// 10,000 turning spheres of 224 triangles each, 1 light, 1280 × 720
    S2,
    /// 400 spheres on a plane, 256 moving lights of range 12, 1280 × 720
    S3,
    /// One sphere of 3,968 triangles, 1 light, 256 × 256
    S4,
    /// What each feature of lighting costs once a vertex and once a pixel, beside one directional light
    Features,
}

/// How a scene is shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BenchShading {
    Constant,
    Flat,
    Gouraud,
    Phong,
}

impl BenchShading {
    pub(super) const ALL: [Self; 4] = [Self::Constant, Self::Flat, Self::Gouraud, Self::Phong];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Flat => "flat",
            Self::Gouraud => "gouraud",
            Self::Phong => "phong",
        }
    }

    pub(super) fn look(self) -> TimedLook {
        match self {
            Self::Constant => TimedLook::Constant,
            Self::Flat => TimedLook::Shaded(Shading::Flat),
            Self::Gouraud => TimedLook::Shaded(Shading::Gouraud),
            Self::Phong => TimedLook::Shaded(Shading::Phong),
        }
    }
}
