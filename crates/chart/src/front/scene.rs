//! The charted scenes.

use halfway::prelude::*;

/// The level of detail of a scene's surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SceneDetail {
    /// Surfaces cut into N cells, as the scene defines them.
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

/// While this resource exists the scene does not move, so that all pictures show its first moment.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Still;

/// Spawns a scene in this detail into an App that has halfway's plugins, or says why it cannot.
pub type BuildScene = Box<dyn Fn(&mut App, SceneDetail) -> Result<(), String>>;

/// A scene, and its levels of detail.
pub struct ChartedScene {
    /// Its name on the command line: lower case, no spaces, unless it is a file's.
    pub name: String,
    /// Its subject, in a line.
    pub about: String,
    /// The reference of the errors, in a line: the true surface, or the mesh with every triangle.
    pub truth: String,
    /// From coarse to fine; not empty.
    pub details: Vec<SceneDetail>,
    /// The detail that the oracle draws as reference; at least as fine as any of `details`.
    pub true_detail: SceneDetail,
    /// The reflectance of the scene, for scenes that do not set it.
    pub reflectance: Option<Reflectance>,
    /// Width and height of its pictures in pixels.
    pub size: UVec2,
    /// Spawns it into an App.
    pub build: BuildScene,
}

impl ChartedScene {
    /// A scene of surfaces that are known by formula, in square pictures, all of it made at once by `spawn`.
    pub fn from_surfaces(
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
    pub fn from_meshes(name: &str, about: &str, build: BuildScene) -> Self {
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
