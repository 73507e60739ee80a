//! Temporal stability: how steady a highlight is while its light moves.
//!
//! A light moves slowly across a coarse sphere that shows nothing but its highlight (kd = ka = 0). The energy E(t) of a
//! frame is the sum of its linear intensities, over all pixels and channels. On the true surface it hardly changes from
//! frame to frame; under Gouraud shading it swells as the highlight passes a vertex and shrinks between vertices.

use halfway::prelude::*;
use halfway::reference::{Image, Mode};

use super::{ChartObject, ChartScene, MeasureError, MeasureProgress, SHADINGS, SceneApp};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HighlightPlan {
    /// Width and height of the frames in pixels.
    pub size: u32,
    /// The sphere's level ([`ChartObject::level`]): n bands, 2n meridians.
    pub level: u32,
    /// How many frames the light takes for its way.
    pub frames: u32,
}

/// The energy of every frame, in linear intensity times pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Energies {
    /// On the true surface.
    pub truth: Vec<f64>,
    /// Under each of [`SHADINGS`].
    pub shaded: [Vec<f64>; SHADINGS.len()],
}

/// How unsteady a highlight is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unsteadiness {
    /// The root of the mean over all pairs of frames of δ(t)², where
    /// δ(t) = (\[E(t + 1) − E(t)\] − \[E*(t + 1) − E*(t)\]) / mean E*, E the energy that is judged and E* the true one.
    pub rms: f64,
    /// The largest |δ(t)|.
    pub worst: f64,
    /// The frame t + 1 in which that shows.
    pub worst_frame: usize,
}

/// How far the energy's changes from frame to frame are from the true energy's. `None` where there are no two frames,
/// not as many of one as of the other, or no true energy at all.
pub fn unsteadiness(energy: &[f64], truth: &[f64]) -> Option<Unsteadiness> {
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    if energy.len() != truth.len() || truth.len() < 2 || mean <= 0.0 {
        return None;
    }
    let changes = |values: &[f64]| values.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>();
    let deltas: Vec<f64> = changes(energy).into_iter().zip(changes(truth)).map(|(a, b)| (a - b) / mean).collect();
    let rms = (deltas.iter().map(|delta| delta * delta).sum::<f64>() / deltas.len() as f64).sqrt();
    let (t, worst) = deltas.iter().map(|delta| delta.abs()).enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Unsteadiness { rms, worst, worst_frame: t + 1 })
}

impl HighlightPlan {
    /// The units of [`MeasureProgress`] that [`sweep`] will report.
    pub fn units(self) -> u64 {
        u64::from(self.frames)
    }
}

/// Draws every frame with the oracle: the true surface, and the mesh under every shading.
///
/// # Errors
/// The first frame that could not be drawn.
pub fn sweep(plan: HighlightPlan, progress: &mut MeasureProgress<'_>) -> Result<Energies, MeasureError> {
    let mut stage = SceneApp::new(UVec2::splat(plan.size));
    let mut energies = Energies { truth: Vec::new(), shaded: [const { Vec::new() }; SHADINGS.len()] };
    for frame in 0..plan.frames {
        let light = light(frame, plan.frames);
        let scene =
            ChartScene { material: ChartScene::highlight(), light, ..ChartScene::new(ChartObject::Sphere, plan.level) };
        stage.show(&scene);
        energies.truth.push(energy(&stage.oracle(Mode::Surface)?));
        for (shading, energies) in SHADINGS.into_iter().zip(&mut energies.shaded) {
            stage.show(&ChartScene { shading: Some(shading), ..scene });
            energies.push(energy(&stage.oracle(Mode::Mesh)?));
        }
        progress.advance(1, "moving highlight");
    }
    Ok(energies)
}

/// The direction toward the light: along a line that crosses meridians and parallels aslant, so that the highlight,
/// which stays well inside the sphere's outline, meets vertices, edges and faces in turn.
fn light(frame: u32, frames: u32) -> Vec3 {
    let t = frame as f32 / frames.saturating_sub(1).max(1) as f32;
    Vec3::new(-1.0, 0.2, 1.0).lerp(Vec3::new(1.0, 0.8, 1.0), t)
}

fn energy(image: &Image) -> f64 {
    image.pixels().iter().flatten().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changes_like_the_truth_is_steady() {
        // Brighter by a constant is an error of each frame, but not an unsteady one.
        let truth = [10.0, 11.0, 9.0, 10.0];
        let found = unsteadiness(&truth.map(|energy| energy + 5.0), &truth).unwrap();
        assert!(found.rms < 1e-15 && found.worst < 1e-15);
    }

    #[test]
    fn a_jump_is_found_where_it_is() {
        let found = unsteadiness(&[10.0, 10.0, 14.0, 14.0, 13.0], &[10.0; 5]).unwrap();
        assert_eq!(found.worst_frame, 2);
        assert!((found.worst - 0.4).abs() < 1e-15);
        // √((0.4² + 0.1²)/4)
        assert!((found.rms - (0.17f64 / 4.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn nothing_is_said_of_nothing() {
        assert_eq!(unsteadiness(&[1.0], &[1.0]), None);
        assert_eq!(unsteadiness(&[1.0, 2.0], &[1.0]), None);
        assert_eq!(unsteadiness(&[1.0, 2.0], &[0.0, 0.0]), None);
    }
}
