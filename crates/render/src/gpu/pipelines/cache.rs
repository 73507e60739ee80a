//! The pipelines that are there: bounded in number, and built when [`Compile`] says.

use crate::gpu::attachments::{Delivery, ShaderOutput, Target};
use crate::gpu::device::Gpu;
use crate::gpu::pipelines::compile::{Builder, Compile, build};
use crate::gpu::pipelines::key::PipelineKey;
use crate::gpu::shaders::text::{LightText, Shaders};
use bevy_ecs::prelude::*;
use bevy_platform::collections::{HashMap, HashSet};
use halfway_frame::batch::backend::Backend;
use halfway_frame::batch::key::DrawKey;
use halfway_frame::error::RenderError;
use halfway_frame::report::FrameReport;
use std::sync::Arc;

/// The most specialised pipelines that are kept. What a frame asks for beyond them is drawn by generic ones, which are
/// slower, and few: they differ only in where their terms are shaded, the reflectance, the viewer, faces, blending and
/// the target. A draw that looks up records for its instances has a pipeline beside that of its key.
const MOST_SPECIAL: usize = 128;

/// A specialised pipeline that was not used for more than this number of frames makes room for another. It is the
/// frames of a second: a scene that changes between more pipelines than are kept must not build them again and again.
const KEPT_FRAMES: u64 = 60;

/// The pipelines, with what they share.
#[derive(Resource, Default)]
pub(crate) struct Pipelines {
    shaders: Arc<Shaders>,
    /// Its hashes are the same in every run, and so is which of equally old ones goes first.
    variants: HashMap<PipelineKey, PipelineVariant>,
    /// How many of them are specialised, those that look up records aside.
    special: usize,
    /// The number of the frame.
    frame: u64,
    /// The output of the frame.
    output: ShaderOutput,
    lights_images_by_environments: bool,
    /// No specialised pipeline can make room in this frame.
    full: bool,
    /// The keys for which there was no room in this frame.
    refused: HashSet<PipelineKey>,
    /// The keys for which there was no room in the frame before.
    refused_before: HashSet<PipelineKey>,
    /// The last key of this frame, and the answer for it.
    last: Option<(DrawKey, DrawKey)>,
    compile: Option<Compile>,
    background: Background,
    /// Those that a frame has waited for, and whose relatives have not been asked for yet.
    unforeseen: Vec<PipelineKey>,
    /// Failures beside the frames that have not been reported yet.
    failures: Vec<RenderError>,
    /// Since the start.
    built: u32,
    /// Since the last report.
    awaited: u32,
}

/// The builder beside the frames.
#[derive(Default)]
enum Background {
    #[default]
    NotYet,
    Running(Builder),
    /// The system gives no thread. It is not tried again.
    Unavailable,
}

#[derive(Default)]
struct PipelineVariant {
    /// The frame that used it last.
    used: u64,
    state: VariantState,
}

#[derive(Default)]
enum VariantState {
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
    fn begin(&mut self, gpu: &Gpu, output: ShaderOutput, compile: Compile) {
        self.frame += 1;
        self.output = output;
        self.lights_images_by_environments = gpu.lights_images_by_environments();
        (self.full, self.last) = (false, None);
        std::mem::swap(&mut self.refused, &mut self.refused_before);
        self.refused.clear();
        self.take_in();
        if compile == Compile::Beside && self.built > 0 && matches!(self.background, Background::NotYet) {
            self.background = Builder::start(gpu, &self.shaders).map_or(Background::Unavailable, Background::Running);
        }
        self.compile = Some(if matches!(self.background, Background::Unavailable) { Compile::Now } else { compile });
        if !self.waits() {
            for key in std::mem::take(&mut self.unforeseen) {
                for draw in key.draw.relatives() {
                    self.ask(PipelineKey { draw, ..key });
                }
            }
        }
    }

    /// Takes in what has been built beside the frames.
    fn take_in(&mut self) {
        let Background::Running(builder) = &self.background else { return };
        for (key, result) in builder.built() {
            // A frame may have built it rather than wait for its turn, or it may have been given up.
            if let Some(variant) =
                self.variants.get_mut(&key).filter(|variant| matches!(variant.state, VariantState::Asked))
            {
                variant.state = VariantState::new(key, result);
                match &variant.state {
                    VariantState::Failed(error) => self.failures.push(error.clone()),
                    _ => self.built += 1,
                }
            }
        }
    }

    /// Whether the frame waits for the pipelines that it asks for.
    fn waits(&self) -> bool {
        self.compile != Some(Compile::Beside) || !matches!(self.background, Background::Running(_))
    }

    /// The layout of the bindings that such pipelines need; `None` before the first is built.
    pub(crate) fn bindings(&self, lights: LightText) -> Option<&wgpu::BindGroupLayout> {
        self.shaders.layouts.of_lights(lights).get()
    }

    /// The layout of an image's bindings; `None` before the first pipeline that has one.
    pub(crate) fn map_bindings(&self, has_solid: bool) -> Option<&wgpu::BindGroupLayout> {
        self.shaders.layouts.of_images(has_solid).get()
    }

    /// The pipeline that draws this into what the frame draws into.
    fn key(&self, draw: DrawKey) -> PipelineKey {
        PipelineKey { draw, output: self.output }
    }

    /// Whether a specialised pipeline may be there; it is kept for now if so.
    fn has_room(&mut self, draw: DrawKey) -> bool {
        let key = self.key(draw);
        if let Some(variant) = self.variants.get_mut(&key) {
            variant.used = self.frame;
            return true;
        }
        // The pipelines that a frame uses are known when it is over. Only those refused in the frame before takes the place of
        // another, so that nothing takes the place of what this frame is about to ask for, which would then take
        // another's.
        let asked_before = self.refused_before.contains(&key);
        if self.special < MOST_SPECIAL || asked_before && self.give_up_one() {
            self.special += 1;
            self.variants.insert(key, PipelineVariant { used: self.frame, state: VariantState::Admitted });
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
        let special = self.variants.iter().filter(|(key, _)| key.draw.is_special() && !key.draw.per_instance);
        let oldest = special.min_by_key(|(_, variant)| variant.used);
        let Some((&key, _)) = oldest.filter(|(_, variant)| variant.used + KEPT_FRAMES < self.frame) else {
            self.full = true;
            return false;
        };
        log::debug!("giving up pipeline {key}");
        self.variants.remove(&key);
        self.variants.remove(&PipelineKey { draw: key.draw.looking_up(), ..key });
        self.special -= 1;
        true
    }

    /// Asks for the pipeline if it is not there.
    fn is_there(&mut self, draw: DrawKey) -> bool {
        self.ask(self.key(draw));
        self.get(draw).is_some()
    }

    /// Has it built beside the frames, unless it was asked for before.
    fn ask(&mut self, key: PipelineKey) {
        let Background::Running(builder) = &self.background else { return };
        let variant = self.variants.entry(key).or_default();
        if matches!(variant.state, VariantState::Admitted) && builder.ask(key) {
            variant.state = VariantState::Asked;
        }
    }

    /// Whether it is known that the pipeline cannot be built.
    fn has_failed(&self, draw: DrawKey) -> bool {
        matches!(self.variants.get(&self.key(draw)), Some(PipelineVariant { state: VariantState::Failed(_), .. }))
    }

    /// The pipeline of such draws in this frame, if it is there.
    pub(crate) fn get(&self, draw: DrawKey) -> Option<&wgpu::RenderPipeline> {
        match &self.variants.get(&self.key(draw))?.state {
            VariantState::Built(pipeline) => Some(pipeline),
            _ => None,
        }
    }

    /// Builds the pipeline unless it is there.
    ///
    /// # Errors
    /// Why it cannot be built.
    pub(crate) fn ensure(&mut self, gpu: &Gpu, draw: DrawKey) -> Result<(), RenderError> {
        let key = self.key(draw);
        let state = &mut self.variants.entry(key).or_default().state;
        if matches!(state, VariantState::Admitted | VariantState::Asked) {
            log::debug!("building pipeline {key}");
            *state = VariantState::new(key, build(gpu, &self.shaders, key));
            self.awaited += 1;
            self.built += u32::from(matches!(state, VariantState::Built(_)));
            if self.compile == Some(Compile::Beside) {
                self.unforeseen.push(key);
            }
        }
        if let VariantState::Failed(error) = state { Err(error.clone()) } else { Ok(()) }
    }

    /// Tells how many there are, and what went wrong beside the frames.
    pub(crate) fn report(&mut self, report: &mut FrameReport) {
        let count =
            |is: fn(&VariantState) -> bool| self.variants.values().filter(|variant| is(&variant.state)).count() as u32;
        report.pipelines = self.built;
        report.pipelines_live = count(|state| matches!(state, VariantState::Built(_)));
        report.pipelines_pending = count(|state| matches!(state, VariantState::Asked));
        report.pipelines_awaited = std::mem::take(&mut self.awaited);
        report.errors.append(&mut self.failures);
    }
}

impl VariantState {
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

impl Backend for Pipelines {
    fn lights_images_by_environments(&self) -> bool {
        self.lights_images_by_environments
    }

    /// The key itself, or the generic one: where there is no room, where what the key needs cannot be
    /// built, and until it is there.
    fn admit(&mut self, key: DrawKey) -> DrawKey {
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

    fn looks_up(&mut self, key: DrawKey) -> bool {
        if self.compile != Some(Compile::Beside) {
            return !self.has_failed(key.looking_up());
        }
        self.ask(self.key(key.generic().looking_up()));
        self.is_there(key.looking_up())
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
        let shows = matches!(frame.delivery, Delivery::Present(_));
        let by_target = if shows { Compile::Beside } else { Compile::Now };
        pipelines.begin(&gpu, frame.output, compile.map_or(by_target, |compile| *compile));
    }
}

#[cfg(test)]
mod tests;
