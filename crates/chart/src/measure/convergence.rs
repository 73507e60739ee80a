//! Rates of convergence: how fast a mesh's picture nears the true surface's as the mesh is refined.
//!
//! Both pictures are the oracle's, so that it is the shading method that is judged, not its implementation.

use halfway::prelude::*;
use halfway::reference::Mode;
use halfway::reference::metrics::{self, Comparison};

use super::{ChartObject, ChartScene, Line, MeasureError, MeasureProgress, SHADINGS, SceneApp, longest_edge};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConvergencePlan {
    /// Width and height of the pictures in pixels.
    pub size: u32,
    /// How many levels of tessellation ([`ChartObject::level`]).
    pub levels: u32,
}

/// How many of the finest levels the slopes are fitted to.
pub const FITTED: usize = 3;

/// What the object is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConvergenceSurface {
    /// Without a highlight.
    Diffuse,
    /// With a highlight of shininess 32.
    Shiny,
}

impl ConvergenceSurface {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Diffuse, Self::Shiny];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Diffuse => "diffuse only",
            Self::Shiny => "highlight of shininess 32",
        }
    }

    fn material(self) -> Material {
        match self {
            Self::Diffuse => ChartScene::matte(),
            Self::Shiny => ChartScene::shiny(),
        }
    }
}

/// One object of one material under one shading, at every level.
#[derive(Clone, Debug)]
pub struct Convergence {
    /// What was drawn.
    pub object: ChartObject,
    /// Of what.
    pub surface: ConvergenceSurface,
    /// How often it was shaded.
    pub shading: Shading,
    /// The levels, the coarsest first.
    pub levels: Vec<Refinement>,
}

/// One level of tessellation.
#[derive(Clone, Debug)]
pub struct Refinement {
    /// Its number ([`ChartObject::level`]).
    pub level: u32,
    /// How many triangles it has.
    pub triangles: usize,
    /// The mesh's longest edge, in its units; the sphere's radius is 1, that of the teapot's body 1.5.
    pub edge: f64,
    /// How far the picture is from the true surface, on pixels that both cover.
    pub comparison: Comparison,
}

impl Refinement {
    /// The largest linear error of a channel.
    pub fn max(&self) -> f64 {
        self.comparison.linear.all.max()
    }

    /// The root of the mean squared linear error.
    pub fn rms(&self) -> f64 {
        self.comparison.linear.all.rmse
    }

    /// The linear error that 95 % of the channels keep to: that of the inside, without the outline's.
    pub fn common(&self) -> f64 {
        const P95: usize = 1;
        self.comparison.linear.all.percentiles[P95]
    }
}

/// What is told of a level: a name, and the figure.
pub type ErrorMeasure = (&'static str, fn(&Refinement) -> f64);

/// Every figure whose order of convergence is told.
pub const QUANTITIES: [ErrorMeasure; 3] = [
    ("largest error", Refinement::max),
    ("RMS error", Refinement::rms),
    ("error that 95 % keep to", Refinement::common),
];

impl Convergence {
    /// The order of convergence of an error: p where it goes with the edge length to the p, fitted to the [`FITTED`]
    /// finest levels.
    pub fn order(&self, error: fn(&Refinement) -> f64) -> Option<f64> {
        let points: Vec<_> = self.levels.iter().map(|level| (level.edge, error(level))).collect();
        Line::order(&points, FITTED)
    }
}

impl ConvergencePlan {
    /// The units of [`MeasureProgress`] that [`sweep`] will report.
    pub fn units(self) -> u64 {
        (ChartObject::ALL.len() * ConvergenceSurface::ALL.len() * SHADINGS.len()) as u64 * u64::from(self.levels)
    }
}

/// Measures every object, material and shading; in this order, the last the quickest to change.
///
/// # Errors
/// The first picture that could not be drawn.
pub fn sweep(plan: ConvergencePlan, progress: &mut MeasureProgress<'_>) -> Result<Vec<Convergence>, MeasureError> {
    let mut stage = SceneApp::new(UVec2::splat(plan.size));
    let mut all = Vec::new();
    for object in ChartObject::ALL {
        let levels = (0..plan.levels).map(|i| object.level(i));
        let meshes: Vec<_> = levels.map(|level| (level, object.mesh(level))).collect();
        for surface in ConvergenceSurface::ALL {
            let scene = |level| ChartScene { material: surface.material(), ..ChartScene::new(object, level) };
            stage.show(&scene(object.level(plan.levels - 1)));
            let truth = stage.oracle(Mode::Surface)?;
            for shading in SHADINGS {
                let mut levels = Vec::new();
                for (level, mesh) in &meshes {
                    stage.show(&ChartScene { shading: Some(shading), ..scene(*level) });
                    let comparison = metrics::compare(&stage.oracle(Mode::Mesh)?, &truth, Encoding::Srgb)?;
                    let (triangles, edge) = (mesh.triangle_count(), longest_edge(mesh));
                    levels.push(Refinement { level: *level, triangles, edge, comparison });
                    progress.advance(1, &format!("convergence, {}", object.name()));
                }
                all.push(Convergence { object, surface, shading, levels });
            }
        }
    }
    Ok(all)
}
