//! The pipeline cache: bounded in size, and filled as [`Compile`] says.

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

/// The most specialised pipelines that are kept. Further draws of a frame use generic ones, which are slower, and few:
/// they differ only in the frequencies of their terms, the reflectance, the viewer, faces, blending and the target. A
/// draw that looks up records for its instances has a second pipeline beside that of its key.
const MOST_SPECIAL: usize = 128;

/// A specialised pipeline may be evicted once it was unused for more than this number of frames, about a second: a
/// scene that alternates between more pipelines than are kept must not rebuild them over and over.
const KEPT_FRAMES: u64 = 60;

/// The pipelines, with their shared state.
#[derive(Resource, Default)]
pub(crate) struct Pipelines {
    shaders: Arc<Shaders>,
    /// Its hashes are the same in every run, and so is the order of eviction among equally old ones.
    variants: HashMap<PipelineKey, PipelineVariant>,
    /// The number of specialised ones, without those that look up records.
    special: usize,
    /// The number of the frame.
    frame: u64,
    /// The output of the frame.
    output: ShaderOutput,
    lights_images_by_environments: bool,
    /// Whether no specialised pipeline can be evicted in this frame.
    full: bool,
    /// The keys that were refused for lack of space in this frame.
    refused: HashSet<PipelineKey>,
    /// The keys that were refused in the previous frame.
    refused_before: HashSet<PipelineKey>,
    /// The last key of this frame, and the key that was admitted for it.
    last: Option<(DrawKey, DrawKey)>,
    compile: Option<Compile>,
    /// The newest frame with other answers than the one before may have had.
    unsettled: u64,
    background: Background,
    /// Pipelines that a frame has waited for, and whose generic relatives are not requested yet.
    unforeseen: Vec<PipelineKey>,
    /// Failures in the background that are not reported yet.
    failures: Vec<RenderError>,
    /// Since the start.
    built: u32,
    /// Since the last report.
    awaited: u32,
}

/// The builder in the background.
#[derive(Default)]
enum Background {
    #[default]
    NotYet,
    Running(Builder),
    /// The system refused a thread, which is not tried again.
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
    /// It is being built.
    Asked,
    Built(wgpu::RenderPipeline),
    Failed(RenderError),
}

impl Pipelines {
    /// Begins a frame, and collects pipelines built in the background.
    fn begin(&mut self, gpu: &Gpu, output: ShaderOutput, compile: Compile) {
        self.frame += 1;
        let before = (self.output, self.compile, self.lights_images_by_environments);
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
        let is_same = before == (self.output, self.compile, self.lights_images_by_environments);
        if !is_same || !self.refused_before.is_empty() || !self.waits() && !self.unforeseen.is_empty() {
            self.unsettled = self.frame;
        }
        if !self.waits() {
            for key in std::mem::take(&mut self.unforeseen) {
                for draw in key.draw.relatives() {
                    self.ask(PipelineKey { draw, ..key });
                }
            }
        }
    }

    /// Collects pipelines built in the background.
    fn take_in(&mut self) {
        let Background::Running(builder) = &self.background else { return };
        for (key, result) in builder.built() {
            // A frame may have built it itself instead of waiting, or it may have been evicted.
            if let Some(variant) =
                self.variants.get_mut(&key).filter(|variant| matches!(variant.state, VariantState::Asked))
            {
                variant.state = VariantState::new(key, result);
                self.unsettled = self.frame;
                match &variant.state {
                    VariantState::Failed(error) => self.failures.push(error.clone()),
                    _ => self.built += 1,
                }
            }
        }
    }

    /// Whether the frame waits for the pipelines that it requests.
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

    /// The key of a draw's pipeline for the frame's output.
    fn key(&self, draw: DrawKey) -> PipelineKey {
        PipelineKey { draw, output: self.output }
    }

    /// Whether a specialised pipeline may be in the cache; if so it is marked as used.
    fn has_room(&mut self, draw: DrawKey) -> bool {
        let key = self.key(draw);
        if let Some(variant) = self.variants.get_mut(&key) {
            variant.used = self.frame;
            return true;
        }
        // The pipelines that a frame uses are known only at its end. Only keys refused in the previous frame may evict
        // others, so that no key evicts a pipeline that this frame still needs, which would then evict another.
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

    /// Evicts the least recently used specialised pipeline, unless it was used too recently.
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

    /// Requests the pipeline if it is missing.
    fn is_there(&mut self, draw: DrawKey) -> bool {
        self.ask(self.key(draw));
        self.get(draw).is_some()
    }

    /// Requests it in the background, unless it was requested before.
    fn ask(&mut self, key: PipelineKey) {
        let Background::Running(builder) = &self.background else { return };
        let variant = self.variants.entry(key).or_default();
        if matches!(variant.state, VariantState::Admitted) && builder.ask(key) {
            variant.state = VariantState::Asked;
        }
    }

    /// Whether the pipeline has failed to build.
    fn has_failed(&self, draw: DrawKey) -> bool {
        matches!(self.variants.get(&self.key(draw)), Some(PipelineVariant { state: VariantState::Failed(_), .. }))
    }

    /// The pipeline of such draws in this frame, if it exists.
    pub(crate) fn get(&self, draw: DrawKey) -> Option<&wgpu::RenderPipeline> {
        match &self.variants.get(&self.key(draw))?.state {
            VariantState::Built(pipeline) => Some(pipeline),
            _ => None,
        }
    }

    /// Builds the pipeline unless it exists.
    ///
    /// # Errors
    /// The reason why it cannot be built.
    pub(crate) fn ensure(&mut self, gpu: &Gpu, draw: DrawKey) -> Result<(), RenderError> {
        let key = self.key(draw);
        let state = &mut self.variants.entry(key).or_default().state;
        if matches!(state, VariantState::Admitted | VariantState::Asked) {
            log::debug!("building pipeline {key}");
            *state = VariantState::new(key, build(gpu, &self.shaders, key));
            self.awaited += 1;
            self.unsettled = self.frame + 1;
            self.built += u32::from(matches!(state, VariantState::Built(_)));
            if self.compile == Some(Compile::Beside) {
                self.unforeseen.push(key);
            }
        }
        if let VariantState::Failed(error) = state { Err(error.clone()) } else { Ok(()) }
    }

    /// Reports the number of pipelines, and failures in the background.
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

    /// The key itself, or the generic one if the cache has no space, if the pipeline cannot be built, and until it is
    /// built.
    fn admit(&mut self, key: DrawKey) -> DrawKey {
        if let Some((asked, answer)) = self.last
            && asked == key
        {
            return answer;
        }
        // Both passes request space, whether or not the first gets it, so that both get it in the same frame.
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

    fn is_settled(&self) -> bool {
        self.unsettled < self.frame
    }
}

/// Begins a frame that has a target.
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
