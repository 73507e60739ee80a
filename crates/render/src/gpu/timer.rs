//! The GPU time of the pass, by the GPU's clock.

use crate::gpu::device::Gpu;
use bevy_ecs::prelude::Resource;
use halfway_frame::mean::{FrameWeights, approach};
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::{Duration, Instant};

/// While this resource exists, every frame's pass is timed on the GPU, if the adapter supports it
/// (`wgpu::Features::TIMESTAMP_QUERY`). It exists only if inserted, as the window does for its title.
///
/// No frame waits for a time: it is read when it has arrived, some frames later. If more frames are pending than there
/// are buffers, the next one is not timed.
///
/// ```no_run
/// # use bevy_app::App;
/// # use halfway_render::GpuTimer;
/// # let mut app = App::new();
/// app.init_resource::<GpuTimer>();
/// # app.update();
/// if let Some(time) = app.world().resource::<GpuTimer>().newest() {
///     println!("{time:?}");
/// }
/// ```
#[derive(Resource, Default)]
pub struct GpuTimer {
    queries: Option<Queries>,
    newest: Option<Duration>,
    /// In seconds.
    smoothed: f64,
    arrived: Option<Instant>,
    weights: FrameWeights,
}

impl GpuTimer {
    /// The time from the beginning of the pass to its end, for the newest frame whose time has arrived. `None` before
    /// the first one, and always if the adapter has no such clock. It includes other work of the GPU meanwhile, and the
    /// clock may be coarse.
    pub fn newest(&self) -> Option<Duration> {
        self.newest
    }

    /// The mean over frames, each with a weight that falls to 1/e within a second; without the first frame once there
    /// is a second.
    pub fn smoothed(&self) -> Option<Duration> {
        self.newest.map(|_| Duration::from_secs_f64(self.smoothed))
    }

    /// Collects times that have arrived, and returns the time stamps for the next pass to write; `None` if it is not
    /// timed.
    pub(crate) fn begin(&mut self, gpu: &Gpu) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let mut queries = self.queries.take().unwrap_or_else(|| Queries::new(gpu));
        while let Some(time) = queries.take_oldest() {
            self.push(time, Instant::now());
        }
        self.queries.insert(queries).writes()
    }

    /// Copies the pass's time stamps to the CPU; after the pass, in the same submission.
    pub(crate) fn end(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(queries) = &mut self.queries {
            queries.read_back(encoder);
        }
    }

    /// Drops everything that belongs to a device.
    pub(crate) fn forget_device(&mut self) {
        self.queries = None;
    }

    fn push(&mut self, time: Duration, now: Instant) {
        let interval = self.arrived.replace(now).map_or(Duration::ZERO, |before| now.saturating_duration_since(before));
        self.smoothed = approach(self.smoothed, time.as_secs_f64(), self.weights.share(interval));
        self.newest = Some(time);
    }
}

/// The most frames with pending times; a display keeps two or three frames pending.
const RING: usize = 4;

/// Ticks at the beginning and the end of a pass.
type Ticks = [u64; 2];
const TICKS_BYTES: u64 = size_of::<Ticks>() as u64;

/// The two ticks of a pass and the ring of buffers by which they come to the CPU.
struct Queries {
    set: wgpu::QuerySet,
    /// A buffer cannot be both resolved into and mapped.
    resolved: wgpu::Buffer,
    ring: [ReadBack; RING],
    /// The next to be written, which is the one whose ticks are the oldest.
    next: usize,
    /// Whether the pass that was begun writes ticks.
    written: bool,
    /// Nanoseconds a tick.
    period: f64,
}

struct ReadBack {
    buffer: wgpu::Buffer,
    /// The last ticks that it delivered.
    ticks: Ticks,
    state: Arc<AtomicU8>,
}

/// States of a [`ReadBack`].
const FREE: u8 = 0;
const UNDER_WAY: u8 = 1;
const ARRIVED: u8 = 2;

impl Queries {
    fn new(gpu: &Gpu) -> Self {
        let buffer = |label, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: TICKS_BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        let read_back = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        Self {
            set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pass"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer("ticks", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            ring: std::array::from_fn(|_| ReadBack {
                buffer: buffer("ticks read back", read_back),
                ticks: Ticks::default(),
                state: Arc::default(),
            }),
            next: 0,
            written: false,
            period: f64::from(gpu.queue.get_timestamp_period()),
        }
    }

    /// The time of the oldest pass that has not been taken; `None` while it has not arrived.
    fn take_oldest(&mut self) -> Option<Duration> {
        loop {
            // Passes end in order, so pending buffers lie between the taken ones and the next.
            let mut places = (0..RING).map(|i| (self.next + i) % RING);
            let place = places.find(|&place| self.ring[place].state() != FREE)?;
            let oldest = &mut self.ring[place];
            if oldest.state() != ARRIVED {
                return None;
            }
            let ticks = oldest.buffer.get_mapped_range(..).map(|bytes| bytemuck::pod_read_unaligned::<Ticks>(&bytes));
            oldest.buffer.unmap();
            oldest.state.store(FREE, Ordering::Relaxed);
            // A frame whose commands were refused leaves the old ticks.
            if let Ok(ticks) = ticks
                && ticks != std::mem::replace(&mut oldest.ticks, ticks)
            {
                return Some(elapsed(ticks, self.period));
            }
        }
    }

    fn writes(&mut self) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        self.written = self.ring[self.next].state() == FREE;
        self.written.then_some(wgpu::RenderPassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        })
    }

    fn read_back(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if !std::mem::take(&mut self.written) {
            return;
        }
        let ReadBack { buffer, state, .. } = &self.ring[self.next];
        encoder.resolve_query_set(&self.set, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, buffer, 0, TICKS_BYTES);
        state.store(UNDER_WAY, Ordering::Relaxed);
        let arrived = Arc::clone(state);
        // Submitting a later frame calls this. After a failure the buffer is not mapped, and is free again.
        encoder.map_buffer_on_submit(buffer, wgpu::MapMode::Read, .., move |result| {
            arrived.store(if result.is_ok() { ARRIVED } else { FREE }, Ordering::Release);
        });
        self.next = (self.next + 1) % RING;
    }
}

impl ReadBack {
    fn state(&self) -> u8 {
        self.state.load(Ordering::Acquire)
    }
}

/// Zero if the clock ran backwards, which it may between submissions of some drivers.
fn elapsed([begin, end]: Ticks, period: f64) -> Duration {
    Duration::from_nanos((end.saturating_sub(begin) as f64 * period) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_have_a_period() {
        let rows = [([1000, 4000], 1.0, 3000), ([7, 10], 83.25, 249), ([5, 5], 1.0, 0), ([9, 2], 1.0, 0)];
        for (ticks, period, nanoseconds) in rows {
            assert_eq!(elapsed(ticks, period), Duration::from_nanos(nanoseconds), "{ticks:?} of {period} ns");
        }
        // A tick that was never written is zero; whatever the other says, nothing overflows.
        assert!(elapsed([0, u64::MAX], 83.25) > Duration::ZERO);
    }

    #[test]
    fn times_are_smoothed_once_the_first_is_past() {
        let (mut timer, start, ms) = (GpuTimer::default(), Instant::now(), Duration::from_millis(1));
        assert_eq!((timer.newest(), timer.smoothed()), (None, None));
        timer.push(500 * ms, start);
        timer.push(2 * ms, start + 10 * ms);
        assert_eq!(timer.smoothed(), Some(2 * ms));
        timer.push(4 * ms, start + 20 * ms);
        let (newest, smoothed) = (timer.newest().unwrap(), timer.smoothed().unwrap());
        assert_eq!(newest, 4 * ms);
        // A hundredth of the memory later, both weigh nearly alike.
        assert!(smoothed > 3 * ms && smoothed < 3 * ms + ms / 100, "{smoothed:?}");
    }

    /// A pass over one pixel; refused as a whole where it is `wrong`.
    fn frame(timer: &mut GpuTimer, gpu: &Gpu, wrong: bool) {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d::default(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let view = &texture.create_view(&wgpu::TextureViewDescriptor::default());
            let attachment = wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(attachment)],
                timestamp_writes: timer.begin(gpu),
                ..Default::default()
            });
            if wrong {
                // No pipeline is set.
                pass.draw(0..3, 0..1);
            }
        }
        timer.end(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        assert_eq!(gpu.take_failure().is_some(), wrong);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is there");
    }

    #[test]
    fn frames_that_are_refused_have_no_time() {
        let gpu = Gpu::open_headless().expect("there is an adapter");
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return;
        }
        let mut timer = GpuTimer::default();
        // More than the ring has buffers.
        for _ in 0..2 * RING {
            frame(&mut timer, &gpu, true);
        }
        assert_eq!(timer.newest(), None, "nothing but refused frames");
        frame(&mut timer, &gpu, false);
        timer.begin(&gpu);
        let first = timer.newest();
        assert!(first.is_some(), "a frame after refused ones");
        let arrived = timer.arrived;
        for _ in 0..2 * RING {
            frame(&mut timer, &gpu, true);
        }
        timer.begin(&gpu);
        assert_eq!((timer.newest(), timer.arrived), (first, arrived), "a refused frame has brought a time");
        frame(&mut timer, &gpu, false);
        timer.begin(&gpu);
        assert!(timer.arrived > arrived, "a frame after more refused ones");
    }
}
