//! The options about how a scene is drawn.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// How the scene is drawn; what is given here wins over the scene file.
#[derive(Args, Clone, Debug)]
pub(crate) struct LookArgs {
    /// A scene file (.json) or a model (.smf, .obj, .gltf, .glb, .ply, .stl)
    #[arg(value_name = "SCENE|MODEL")]
    pub(crate) input: PathBuf,
    /// How often surfaces are shaded [default: the scene's; phong for a model]
    #[arg(long, value_enum)]
    pub(crate) shading: Option<ShadingArg>,
    /// How surfaces reflect [default: the scene's; blinn-phong for a model]
    #[arg(long, value_enum)]
    pub(crate) reflectance: Option<ReflectanceArg>,
    /// Coverage samples a pixel: 1, or 4 for smooth edges [default: the scene's; 1 for a model]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(["1", "4"]))]
    pub(crate) samples: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShadingArg {
    /// Once a triangle
    Flat,
    /// Once a vertex
    Gouraud,
    /// Once a pixel
    Phong,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ReflectanceArg {
    /// (v·r)^α
    Phong,
    /// (n·h)^β, β the shininess as it is
    BlinnPhong,
    /// (n·h)^β, β matched to the α that the shininess means
    BlinnPhongMatched,
}
