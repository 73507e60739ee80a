//! The sets View and Draw: prepares the canvas, and draws the pass into it.

use crate::cpu::canvas::{Canvas, CanvasTarget};
use crate::cpu::device::Cpu;
use crate::cpu::error::raster_error;
use crate::cpu::meshes::MeshPieces;
use crate::cpu::pass::PassLists;
use crate::cpu::policy;
use crate::headless::Headless;
use crate::picture::Pixels;
use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use halfway_frame::batch::backend::Backend;
use halfway_frame::batch::batches::Batches;
use halfway_frame::batch::key::DrawKey;
use halfway_frame::batch::lit_patches::LitPatches;
use halfway_frame::error::RenderError;
use halfway_frame::lights::surroundings::Surroundings;
use halfway_frame::passes::{Passes, Phase};
use halfway_frame::report::FrameReport;
use halfway_frame::values::{FrameValues, PixelValues};
use halfway_frame::view::camera::{PictureSize, View};
use halfway_lighting::{Encoding, Frequency, Lens};
use halfway_raster::{LARGEST_SIDE, Pass, PixelFormat};

impl Backend for Cpu {
    fn lights_images_by_environments(&self) -> bool {
        true
    }

    /// The same for all draws that differ only in the specialisation of a shader.
    fn admit(&mut self, key: DrawKey) -> DrawKey {
        DrawKey {
            local_viewer: false,
            attenuated_ambient: key.terms.diffuse != Frequency::Never,
            shared_color: false,
            ranged: key.is_lit(),
            squarings: None,
            ..key
        }
    }

    fn looks_up(&mut self, _: DrawKey) -> bool {
        true
    }

    fn is_settled(&self) -> bool {
        true
    }
}

/// Prepares the memory that the frame is drawn into.
pub(crate) fn prepare(
    headless: Res<Headless>,
    window: Option<Res<CanvasTarget>>,
    view: Res<View>,
    size: Res<PictureSize>,
    mut canvas: ResMut<Canvas>,
    mut values: ResMut<FrameValues>,
    mut report: ResMut<FrameReport>,
) {
    canvas.end(false);
    // The view has reported this already.
    if size.0.min_element() == 0 {
        return;
    }
    if size.0.max_element() > LARGEST_SIDE {
        report.errors.push(RenderError::TooLarge {
            what: "the picture's longer side, in pixels,".into(),
            needed: size.0.max_element().into(),
            limit: LARGEST_SIDE.into(),
        });
        return;
    }
    let is_float = window.is_none() && headless.pixels == Pixels::Float;
    let camera = view.camera.unwrap_or_default();
    if let Err(error) = canvas.begin(size.0, is_float, camera.intensity.acts_on_pictures()) {
        report.errors.push(error);
        return;
    }
    let written = if is_float { PixelValues::Floats } else { PixelValues::Bytes(camera.encoding) };
    values.0 = Some(written.under(camera.intensity));
    report.picture_passes = policy::passes(camera.intensity);
}

/// Draws the frame.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn draw(
    cpu: Res<Cpu>,
    view: Res<View>,
    size: Res<PictureSize>,
    values: Res<FrameValues>,
    lit: Res<LitPatches>,
    batches: Res<Batches>,
    surroundings: Res<Surroundings>,
    passes: Res<Passes>,
    lists: Res<PassLists>,
    meshes: Res<MeshPieces>,
    mut canvas: ResMut<Canvas>,
    mut report: ResMut<FrameReport>,
) {
    let (Some(values), Some(camera)) = (values.0, view.camera) else { return };
    let LinearRgba { red, green, blue, .. } = camera.background;
    let pieces: Vec<_> = lists.meshes.iter().filter_map(|&(id, form)| meshes.get(id, form)).collect();
    let pass = Pass {
        size: size.0.to_array(),
        samples: camera.samples,
        pixels: match values {
            PixelValues::Bytes(Encoding::Srgb) => PixelFormat::SrgbBytes,
            PixelValues::Bytes(Encoding::Raw) => PixelFormat::RawBytes,
            PixelValues::Floats | PixelValues::Toned { .. } => PixelFormat::Floats,
        },
        clear: [red, green, blue],
        lens: lens(&view),
        local_viewer: camera.eye::<f32>().is_local(),
        lights: &lit.lists.sent.records,
        lists: &lit.lists.numbers,
        surfaces: &lit.records,
        instances: &batches.instances,
        meshes: &pieces,
        maps: &lists.maps,
        surroundings: surroundings.0.as_ref(),
        draws: &lists.draws,
    };
    let (output, clear_tiles) = canvas.output();
    let mut rasterizer = cpu.rasterizer();
    let drawn = rasterizer.draw(&pass, output, clear_tiles);
    let drawn = if passes.has(Phase::Policy) {
        drawn.and_then(|()| policy::finish(&mut canvas, &rasterizer, &camera))
    } else {
        drawn
    };
    canvas.end(drawn.is_ok());
    report.errors.extend(drawn.err().map(raster_error));
}

/// The view's projection, in its unit.
fn lens(view: &View) -> Lens {
    let lens = view.lens_of_shaders();
    // A positive number that underflows would be refused.
    let near = if view.lens.near > 0.0 { lens.near.max(f32::MIN_POSITIVE) } else { lens.near };
    Lens { near, ..lens }
}
