//! A picture that is judged and, where it differs, diagnosed.

use std::ops::ControlFlow;

use bevy_ecs::entity::Entity;
use bevy_ecs::name::Name;
use bevy_ecs::world::World;
use bevy_math::UVec2;
use halfway_lighting::{Camera, Encoding, Samples};
use thiserror::Error;

use super::diagnosis::{Diagnosis, Finding, Marker};
use super::rubric::Rubric;
use crate::metrics::{Bars, SizeMismatch, Verdict, judge};
use crate::oracle::{OracleError, Stopped};
use crate::{Image, Oracle};

/// The verdict on a picture, and the mistakes in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Examined {
    /// Whether it passes. Where it does not, figures cover only some pixels.
    pub verdict: Verdict,
    /// The mistakes; `None` for a picture that passes.
    pub diagnosis: Option<Diagnosis>,
    /// The names of the objects that explanations are about.
    names: Vec<(Entity, String)>,
}

/// The reason why a picture cannot be examined.
#[derive(Clone, Debug, Error)]
pub enum ExamineError {
    /// The scene cannot be drawn.
    #[error(transparent)]
    Scene(#[from] OracleError),
    /// `progress` stopped the work.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// The pictures have different sizes.
    #[error(transparent)]
    Size(#[from] SizeMismatch),
}

/// Judges a picture of what `world` shows by these bars, and finds the mistakes in one that does not pass.
///
/// A picture passes with the camera's samples a pixel or with one: nobody has to smooth edges. If it does not, the cameras
/// of the world have one sample afterwards. `progress` receives the number of finished tiles and of all tiles of the
/// right picture, from any thread, and may stop the work.
///
/// # Errors
/// The scene cannot be drawn, or `progress` stopped the work.
pub fn examine(
    world: &mut World,
    actual: &Image,
    encoding: Encoding,
    bars: Bars,
    progress: &(dyn Fn(u32, u32) -> ControlFlow<()> + Sync),
) -> Result<Examined, ExamineError> {
    let size = UVec2::from(actual.dimensions());
    let oracle = Oracle::new(world, size)?.with_clamping(bars.are_clamped());
    let expected = oracle.draw_with(progress)?;
    // Whether it passes is enough: the share of right pixels comes from the diagnosis.
    let judged = |oracle: &Oracle| judge(oracle, &expected, actual, bars.until_wrong());
    let mut verdict = judged(&oracle)?;
    let smooths = world.query::<&Camera>().iter(world).any(|camera| camera.samples != Samples::One);
    if !verdict.is_within() && smooths {
        world.query::<&mut Camera>().iter_mut(world).for_each(|mut camera| camera.samples = Samples::One);
        let of_one = judged(&Oracle::new(world, size)?.with_clamping(bars.are_clamped()))?;
        verdict = if of_one.is_within() { of_one } else { verdict };
    }
    let diagnosis = if verdict.is_within() { None } else { Some(diagnosed(&oracle, actual, encoding, smooths)?) };
    let explanations = diagnosis.iter().flat_map(|it| it.explanations.iter().chain(&it.nearest));
    let name = |object: Entity| Some((object, world.get::<Name>(object)?.to_string()));
    let names = explanations.filter_map(|it| it.object).filter_map(name).collect();
    Ok(Examined { verdict, diagnosis, names })
}

/// The diagnosis of a picture with one sample a pixel, or with several if the scene asks for them and they explain more.
fn diagnosed(oracle: &Oracle, actual: &Image, encoding: Encoding, smooths: bool) -> Result<Diagnosis, SizeMismatch> {
    let of_one = Marker::new(oracle, encoding).diagnose(actual)?;
    if !smooths || !of_one.explanations.is_empty() {
        return Ok(of_one);
    }
    let of_four = Marker::smoothed(oracle, encoding).diagnose(actual)?;
    Ok(if of_four.share() > of_one.share() { of_four } else { of_one })
}

impl Examined {
    /// Whether the picture passes.
    pub fn passes(&self) -> bool {
        self.diagnosis.is_none()
    }

    /// The name of the object on which an explanation explains most, if that is an object with a name.
    pub fn object(&self, explanation: &Finding) -> Option<&str> {
        let object = explanation.object?;
        self.names.iter().find(|(entity, _)| *entity == object).map(|(_, name)| name.as_str())
    }

    /// Its points.
    pub fn mark(&self, rubric: &Rubric) -> f64 {
        self.diagnosis.as_ref().map_or(rubric.points(), |diagnosis| rubric.mark(diagnosis))
    }
}
