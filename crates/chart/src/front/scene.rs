//! What is charted.

use halfway::prelude::*;

/// How finely a scene's surfaces are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SceneDetail {
    /// Surfaces cut into N cells; what a cell is, is the scene's.
    Cells(u32),
    /// Meshes with one of N of their triangles left.
    Simplified(u32),
    /// Meshes as they are.
    Full,
}

impl SceneDetail {
    /// As the command line takes it.
    pub fn id(self) -> String {
        match self {
            Self::Cells(cells) => cells.to_string(),
            Self::Simplified(to) => format!("1-of-{to}"),
            Self::Full => "full".to_owned(),
        }
    }

    /// In words.
    pub fn words(self) -> String {
        match self {
            Self::Cells(cells) => format!("{cells} cells"),
            Self::Simplified(to) => format!("simplified to 1 of {to} triangles"),
            Self::Full => "full mesh".to_owned(),
        }
    }
}

/// While this resource is there nothing of the scene moves, so that all pictures show the same moment: its first.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Still;

/// Puts a scene, its surfaces in this detail, into an App that has halfway's plugins, or says why it cannot.
pub type BuildScene = Box<dyn Fn(&mut App, SceneDetail) -> Result<(), String>>;

/// Something to look at, and how finely it can be drawn.
pub struct ChartedScene {
    /// As the command line takes it: lower case, no spaces, unless it is a file's.
    pub name: String,
    /// What there is to see, in a line.
    pub about: String,
    /// What errors are errors from, in a line: the true surface, or the mesh with every triangle.
    pub truth: String,
    /// From coarse to fine; not empty.
    pub details: Vec<SceneDetail>,
    /// What the oracle draws to compare with; as fine as any of `details`, or finer.
    pub true_detail: SceneDetail,
    /// How the scene reflects, where the scene does not say so itself.
    pub reflectance: Option<Reflectance>,
    /// Width and height of its pictures in pixels.
    pub size: UVec2,
    /// Puts it into an App.
    pub build: BuildScene,
}

impl ChartedScene {
    /// A scene of surfaces that are known by formula, in square pictures, all of it made at once by `spawn`.
    pub fn of_surfaces(
        name: &str,
        about: &str,
        details: impl IntoIterator<Item = u32>,
        spawn: impl Fn(&mut World, u32) + 'static,
    ) -> Self {
        let details: Vec<SceneDetail> = details.into_iter().map(SceneDetail::Cells).collect();
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
            truth: "the true surface, with its own normal at every pixel".to_owned(),
            true_detail: details.last().copied().unwrap_or(SceneDetail::Cells(1)),
            details,
            reflectance: Some(Reflectance::BlinnPhong),
            size: UVec2::splat(640),
            build: Box::new(move |app, detail| {
                if let SceneDetail::Cells(cells) = detail {
                    spawn(app.world_mut(), cells);
                }
                Ok(())
            }),
        }
    }

    /// A scene of meshes, simplified or as they are.
    pub fn of_meshes(name: &str, about: &str, build: BuildScene) -> Self {
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
            truth: "every triangle of the meshes, shaded at every pixel, or the true surface where one is known"
                .to_owned(),
            details: [64, 16, 4].map(SceneDetail::Simplified).into_iter().chain([SceneDetail::Full]).collect(),
            true_detail: SceneDetail::Full,
            reflectance: None,
            size: UVec2::splat(640),
            build,
        }
    }
}
