//! The pipelines that are there: bounded in number, and built when [`Compile`] says.

use crate::device::gpu::Gpu;
use crate::error::RenderError;
use crate::frame::report::FrameReport;
use crate::pipelines::compile::{Builder, Compile, build};
use crate::pipelines::key::PipelineKey;
use crate::shaders::text::{Shaders, Text};
use crate::target::frame::Target;
use bevy_ecs::prelude::*;
use bevy_platform::collections::{HashMap, HashSet};
use std::sync::Arc;

/// So many specialised pipelines live at most; what more a frame asks for is drawn by generic ones, which are slower and
/// few: they differ in the stages of their terms, the reflectance, the viewer, faces, blending and the target alone. A
/// draw that looks up records for its instances has a pipeline beside that of its key.
const MOST_SPECIAL: usize = 128;

/// A specialised pipeline that no frame has used for longer makes room for another. A second's worth of frames: a scene
/// that goes round and round among more pipelines than live must not build them over and over.
const KEPT_FRAMES: u64 = 60;

/// The pipelines, with what they share.
#[derive(Resource, Default)]
pub(crate) struct Pipelines {
    shaders: Arc<Shaders>,
    /// Its hashes are the same in every run, and so is which of equally old ones goes first.
    variants: HashMap<PipelineKey, Variant>,
    /// How many of them are specialised, those that look up records aside.
    special: usize,
    /// The number of the frame.
    frame: u64,
    /// No specialised one can make room in this frame.
    full: bool,
    /// For which there was no room in this frame.
    refused: HashSet<PipelineKey>,
    /// The same of the frame before.
    refused_before: HashSet<PipelineKey>,
    /// What was asked last in this frame, and the answer.
    last: Option<(PipelineKey, PipelineKey)>,
    compile: Option<Compile>,
    background: Background,
    /// Those that a frame has waited for, and whose relatives have not been asked for yet.
    unforeseen: Vec<PipelineKey>,
    /// What went wrong beside the frames, until it is reported.
    failures: Vec<RenderError>,
    /// Since the start.
    built: u32,
    /// Since the last report.
    awaited: u32,
}

/// What builds beside the frames.
#[derive(Default)]
enum Background {
    #[default]
    NotYet,
    Running(Builder),
    /// The system gives no thread, or the thread has died. It is not tried again.
    Unavailable,
}

#[derive(Default)]
struct Variant {
    /// The frame that used it last.
    used: u64,
    state: State,
}

#[derive(Default)]
enum State {
    /// It may be built.
    #[default]
    Admitted,
    /// On its way.
    Asked,
    Built(wgpu::RenderPipeline),
    Failed(RenderError),
}

impl Pipelines {
    /// Begins a frame, and takes in what has been built beside the frames.
    fn begin(&mut self, gpu: &Gpu, compile: Compile) {
        self.frame += 1;
        (self.full, self.last) = (false, None);
        std::mem::swap(&mut self.refused, &mut self.refused_before);
        self.refused.clear();
        self.take_in();
        if compile == Compile::Beside && self.built > 0 && matches!(self.background, Background::NotYet) {
            self.background = Builder::start(gpu, &self.shaders).map_or(Background::Unavailable, Background::Running);
        }
        self.compile = Some(if matches!(self.background, Background::Unavailable) { Compile::Now } else { compile });
        if !self.waits() {
            for key in std::mem::take(&mut self.unforeseen).into_iter().flat_map(PipelineKey::relatives) {
                self.ask(key);
            }
        }
    }

    /// Takes in what has been built beside the frames. What a thread that has died leaves unbuilt is for the frames.
    fn take_in(&mut self) {
        let Background::Running(builder) = &self.background else { return };
        // Before it is emptied: whatever a dead thread has built is in it by now.
        let is_alive = builder.is_alive();
        for (key, result) in builder.built() {
            // A frame may have built it rather than wait for its turn, or it may have been given up.
            if let Some(variant) = self.variants.get_mut(&key).filter(|variant| matches!(variant.state, State::Asked)) {
                variant.state = State::new(key, result);
                match &variant.state {
                    State::Failed(error) => self.failures.push(error.clone()),
                    _ => self.built += 1,
                }
            }
        }
        if !is_alive {
            self.background = Background::Unavailable;
            for variant in self.variants.values_mut().filter(|variant| matches!(variant.state, State::Asked)) {
                variant.state = State::Admitted;
            }
            let reason =
                "the thread that builds pipelines beside the frames has died; from now on frames wait for them";
            self.failures.push(RenderError::Device(reason.into()));
        }
    }

    /// Whether the frame waits for the pipelines that it asks for.
    fn waits(&self) -> bool {
        self.compile != Some(Compile::Beside) || !matches!(self.background, Background::Running(_))
    }

    /// The layout of the bindings that such pipelines need; `None` before the first is built.
    pub(crate) fn bindings(&self, text: Text) -> Option<&wgpu::BindGroupLayout> {
        self.shaders.get(text).map(|shader| &shader.bindings)
    }

    /// The key itself, or the generic one that draws the same: where there is no room, where what the key needs cannot be
    /// built, and until it is there.
    pub(crate) fn admit(&mut self, key: PipelineKey) -> PipelineKey {
        if let Some((asked, answer)) = self.last
            && asked == key
        {
            return answer;
        }
        // Both passes ask for room, whether or not the first gets any, so that both get it in the same frame.
        let special = key.is_special()
            && key.passes().filter(|&pass| !self.has_room(pass)).count() == 0
            && !key.passes().any(|pass| self.has_failed(pass))
            && (self.waits() || key.passes().filter(|&pass| !self.is_there(pass)).count() == 0);
        let answer = if special { key } else { key.generic() };
        self.last = Some((key, answer));
        answer
    }

    /// Whether instances can look up their records in such a draw. If not, each record is a draw.
    pub(crate) fn looks_up(&mut self, key: PipelineKey) -> bool {
        if self.compile != Some(Compile::Beside) {
            return !self.has_failed(key.looking_up());
        }
        self.ask(key.generic().looking_up());
        self.is_there(key.looking_up())
    }

    /// Whether a specialised pipeline may be there; it is kept for now if so.
    fn has_room(&mut self, key: PipelineKey) -> bool {
        if let Some(variant) = self.variants.get_mut(&key) {
            variant.used = self.frame;
            return true;
        }
        // What a frame uses is known when it is over. Only what was refused in the frame before takes the place of another,
        // so that nothing takes the place of what this frame is about to ask for, which would then take another's.
        let asked_before = self.refused_before.contains(&key);
        if self.special < MOST_SPECIAL || asked_before && self.give_up_one() {
            self.special += 1;
            self.variants.insert(key, Variant { used: self.frame, state: State::Admitted });
            return true;
        }
        if self.refused.len() < MOST_SPECIAL {
            self.refused.insert(key);
        }
        false
    }

    /// Gives up the specialised pipeline that has not been used for longest, unless it was used too lately.
    fn give_up_one(&mut self) -> bool {
        if self.full {
            return false;
        }
        let special = self.variants.iter().filter(|(key, _)| key.is_special() && !key.per_instance);
        let oldest = special.min_by_key(|(_, variant)| variant.used);
        let Some((&key, _)) = oldest.filter(|(_, variant)| variant.used + KEPT_FRAMES < self.frame) else {
            self.full = true;
            return false;
        };
        log::debug!("giving up pipeline {key}");
        self.variants.remove(&key);
        self.variants.remove(&key.looking_up());
        self.special -= 1;
        true
    }

    /// Asks for the pipeline if it is not there.
    fn is_there(&mut self, key: PipelineKey) -> bool {
        self.ask(key);
        self.get(&key).is_some()
    }

    /// Has it built beside the frames, unless it was asked for before.
    fn ask(&mut self, key: PipelineKey) {
        let Background::Running(builder) = &self.background else { return };
        let variant = self.variants.entry(key).or_default();
        if matches!(variant.state, State::Admitted) && builder.ask(key) {
            variant.state = State::Asked;
        }
    }

    /// Whether it is known that the pipeline cannot be built.
    fn has_failed(&self, key: PipelineKey) -> bool {
        matches!(self.variants.get(&key), Some(Variant { state: State::Failed(_), .. }))
    }

    pub(crate) fn get(&self, key: &PipelineKey) -> Option<&wgpu::RenderPipeline> {
        match &self.variants.get(key)?.state {
            State::Built(pipeline) => Some(pipeline),
            _ => None,
        }
    }

    /// Builds the pipeline unless it is there.
    ///
    /// # Errors
    /// Why it cannot be built.
    pub(crate) fn ensure(&mut self, gpu: &Gpu, key: PipelineKey) -> Result<(), RenderError> {
        let state = &mut self.variants.entry(key).or_default().state;
        if matches!(state, State::Admitted | State::Asked) {
            log::debug!("building pipeline {key}");
            *state = State::new(key, build(gpu, &self.shaders, key));
            self.awaited += 1;
            self.built += u32::from(matches!(state, State::Built(_)));
            if self.compile == Some(Compile::Beside) {
                self.unforeseen.push(key);
            }
        }
        if let State::Failed(error) = state { Err(error.clone()) } else { Ok(()) }
    }

    /// Tells how many there are, and what went wrong beside the frames.
    pub(crate) fn report(&mut self, report: &mut FrameReport) {
        let count = |is: fn(&State) -> bool| self.variants.values().filter(|variant| is(&variant.state)).count() as u32;
        report.pipelines = self.built;
        report.pipelines_live = count(|state| matches!(state, State::Built(_)));
        report.pipelines_pending = count(|state| matches!(state, State::Asked));
        report.pipelines_awaited = std::mem::take(&mut self.awaited);
        report.errors.append(&mut self.failures);
    }
}

impl State {
    fn new(key: PipelineKey, result: Result<wgpu::RenderPipeline, String>) -> Self {
        result.map_or_else(
            |reason| {
                log::error!("pipeline {key}: {reason}");
                Self::Failed(RenderError::Device(reason))
            },
            Self::Built,
        )
    }
}

/// Begins a frame that has something to draw into.
pub(crate) fn begin(
    gpu: Res<Gpu>,
    target: Res<Target>,
    compile: Option<Res<Compile>>,
    mut pipelines: ResMut<Pipelines>,
) {
    if let Some(frame) = &target.frame {
        let by_target = if frame.surface.is_some() { Compile::Beside } else { Compile::Now };
        pipelines.begin(&gpu, compile.map_or(by_target, |compile| *compile));
    }
}

#[cfg(test)]
mod tests;
