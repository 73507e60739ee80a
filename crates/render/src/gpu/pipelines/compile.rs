//! Builds pipelines in the frame that needs them, or in the background on a thread.

use crate::gpu::device::Gpu;
use crate::gpu::pipelines::key::PipelineKey;
use crate::gpu::shaders::text::{Shaders, Text};
use bevy_ecs::prelude::Resource;
use futures_lite::future::block_on;
use halfway_frame::error::panic_message;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

/// When pipelines are built. Without this resource the target decides: [`Compile::Beside`] for a window's surface,
/// [`Compile::Now`] for headless pictures.
///
/// A software adapter generates machine code when a pipeline first draws, whichever thread has built it; there only the
/// earlier work runs in the background.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compile {
    /// In the frame that first needs them, which waits. Every frame is drawn by the pipelines made for it, so that two
    /// runs are equal to the byte.
    Now,
    /// In the background on a thread, except those of the first frame that draws anything. Until a specialised pipeline
    /// is built, a generic one draws in its place: the same picture up to rounding, more slowly. Generic ones are built
    /// in advance for visible objects, under every shading and reflectance; a frame waits only for one that was not
    /// built in advance or is not ready ([`FrameReport::pipelines_awaited`](crate::FrameReport::pipelines_awaited)).
    /// Without a thread this is the same as [`Compile::Now`].
    Beside,
}

/// Builds a pipeline, or returns the driver's error message.
pub(crate) fn build(gpu: &Gpu, shaders: &Shaders, key: PipelineKey) -> Result<wgpu::RenderPipeline, String> {
    use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
    // Error scopes are per thread, so that two building threads do not mix their errors.
    let scopes = [Validation, OutOfMemory, Internal].map(|filter| gpu.device.push_error_scope(filter));
    let pipeline = shaders.with(gpu, Text::from_key(&key.draw), |shader| shader.build(gpu, key));
    // Popped in reverse order, and all of them.
    let error = scopes.into_iter().rev().filter_map(|scope| block_on(scope.pop())).last();
    error.map_or(Ok(pipeline), |error| Err(error.to_string()))
}

/// A thread that builds pipelines, one after the other.
pub(crate) struct Builder {
    ends: Option<Ends>,
    thread: Option<JoinHandle<()>>,
}

struct Ends {
    wanted: Sender<PipelineKey>,
    built: Mutex<Receiver<Built>>,
}

type Built = (PipelineKey, Result<wgpu::RenderPipeline, String>);

impl Builder {
    /// `None` if the system refuses a thread.
    pub(crate) fn start(gpu: &Gpu, shaders: &Arc<Shaders>) -> Option<Self> {
        let (gpu, shaders) = (gpu.clone(), Arc::clone(shaders));
        Self::with_build(move |key| build(&gpu, &shaders, key))
    }

    /// A thread that builds with this function; `None` if the system refuses one.
    pub(crate) fn with_build(
        build: impl Fn(PipelineKey) -> Result<wgpu::RenderPipeline, String> + Send + 'static,
    ) -> Option<Self> {
        let (wanted, wishes) = channel();
        let (sender, built) = channel();
        let work = move || {
            // Ends when the builder is dropped.
            for key in wishes {
                log::debug!("building pipeline {key} beside the frames");
                let built = catch_unwind(AssertUnwindSafe(|| build(key)));
                if sender.send((key, built.unwrap_or_else(|panic| Err(panic_message(&*panic))))).is_err() {
                    break;
                }
            }
        };
        let thread = std::thread::Builder::new().name("pipelines".into()).spawn(work).ok()?;
        Some(Self { ends: Some(Ends { wanted, built: Mutex::new(built) }), thread: Some(thread) })
    }

    /// Requests a pipeline; returns whether a thread will build it.
    pub(crate) fn ask(&self, key: PipelineKey) -> bool {
        self.ends.as_ref().is_some_and(|ends| ends.wanted.send(key).is_ok())
    }

    /// The pipelines that have been built since the last call.
    pub(crate) fn built(&self) -> Vec<Built> {
        let built = |ends: &Ends| ends.built.lock().unwrap_or_else(PoisonError::into_inner).try_iter().collect();
        self.ends.as_ref().map_or_else(Vec::new, built)
    }
}

impl Drop for Builder {
    /// Waits for the pipeline that is being built, since a driver may not be unloaded while it works.
    fn drop(&mut self) {
        self.ends = None;
        if let Some(thread) = self.thread.take() {
            // The thread does not panic: panics of builds are caught.
            drop(thread.join());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::attachments::ShaderOutput;
    use halfway_frame::batch::key::DrawKey;

    #[test]
    fn a_failed_pipeline_returns_an_error() {
        let gpu = Gpu::open_headless().unwrap();
        let shaders = Arc::default();
        let builder = Builder::start(&gpu, &shaders).unwrap();
        // No adapter takes three samples a pixel.
        let right = PipelineKey { draw: DrawKey::plain(), output: ShaderOutput::default() };
        let wrong = PipelineKey { output: ShaderOutput { samples: 3, ..right.output }, ..right };
        assert!(builder.ask(wrong) && builder.ask(right));
        let mut built = Vec::new();
        while built.len() < 2 {
            built.extend(builder.built());
            std::thread::yield_now();
        }
        let [(first, failed), (second, fine)] = &built[..] else { panic!("{} pipelines", built.len()) };
        assert_eq!((*first, *second), (wrong, right));
        assert!(failed.as_ref().is_err_and(|reason| reason.to_lowercase().contains("sample")), "{failed:?}");
        assert!(fine.is_ok(), "{fine:?}");
        assert_eq!(gpu.take_failure(), None, "what is handed back is not reported again");
    }

    #[test]
    fn the_thread_ends_with_the_builder() {
        let gpu = Gpu::open_headless().unwrap();
        let shaders = Arc::default();
        let builder = Builder::start(&gpu, &shaders).unwrap();
        for squarings in 0..16 {
            let draw = DrawKey { squarings: Some(squarings), ..DrawKey::plain() };
            assert!(builder.ask(PipelineKey { draw, output: ShaderOutput::default() }));
        }
        drop(builder);
        assert_eq!(Arc::strong_count(&shaders), 1, "the thread shares the shaders as long as it lives");
    }
}
