//! What is charted.

use halfway::prelude::*;

/// How finely a scene's surfaces are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SceneDetail {
    /// Surfaces cut into N cells, every triangle drawn; what a cell is, is the scene's.
    Cells(u32),
    /// Meshes with one of N of their triangles left, and those drawn.
    Simplified(u32),
    /// Meshes as they are, drawn as coarsely as the tolerance allows, points moving by up to half a pixel.
    Levels,
    /// Every triangle.
    Full,
}

impl SceneDetail {
    /// As the command line takes it.
    pub fn id(self) -> String {
        match self {
            Self::Cells(cells) => cells.to_string(),
            Self::Simplified(to) => format!("1-of-{to}"),
            Self::Levels => "levels".to_owned(),
            Self::Full => "full".to_owned(),
        }
    }

    /// In words.
    pub fn words(self) -> String {
        match self {
            Self::Cells(cells) => format!("{cells} cells"),
            Self::Simplified(to) => format!("simplified to 1 of {to} triangles"),
            Self::Levels => "levels of detail".to_owned(),
            Self::Full => "every triangle".to_owned(),
        }
    }

    /// The tolerance of a method that keeps to `steps` steps, or to the default.
    pub(super) fn tolerance(self, steps: Option<f64>) -> Tolerance {
        let Tolerance { steps: by_default, pixels } = Tolerance { steps: 1.0, pixels: 0.5 };
        let steps = steps.map_or(by_default, |steps| steps as f32);
        match self {
            Self::Levels => Tolerance { steps, pixels },
            Self::Cells(_) | Self::Simplified(_) | Self::Full => Tolerance::steps(steps),
        }
    }
}

/// While this resource is there nothing of the scene moves, so that all pictures show the same moment: its first.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Still;

/// Why a scene could not be set up, in words.
pub type SceneProblem = String;

/// Puts a scene, its surfaces in this detail, into an App that has halfway's plugins.
pub type BuildScene = Box<dyn Fn(&mut App, SceneDetail) -> Result<(), SceneProblem>>;

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

impl std::fmt::Debug for ChartedScene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ChartedScene").field("name", &self.name).field("details", &self.details).finish_non_exhaustive()
    }
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

    /// A scene of meshes, simplified, drawn with levels of detail, or as they are.
    pub fn of_meshes(name: &str, about: &str, build: BuildScene) -> Self {
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
            truth: "every triangle of the meshes, shaded at every pixel, or the true surface where one is known"
                .to_owned(),
            details: vec![
                SceneDetail::Simplified(64),
                SceneDetail::Simplified(16),
                SceneDetail::Simplified(4),
                SceneDetail::Levels,
                SceneDetail::Full,
            ],
            true_detail: SceneDetail::Full,
            reflectance: None,
            size: UVec2::splat(640),
            build,
        }
    }
}
