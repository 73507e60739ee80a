//! Frames by the reference renderer.

use std::ops::ControlFlow;

use bevy_app::App;
use bevy_color::LinearRgba;
use bevy_ecs::prelude::{Resource, World};
use bevy_math::UVec2;
use halfway_lighting::{Camera, Intensity, Samples};
use halfway_reference::{Mode, Oracle, OracleError};
use halfway_render::{Picture, Pixels, Surfaces, draw_background, draw_lines, has_lines};
use image::DynamicImage;

use crate::recording::{FrameToDraw, RecordError, camera};

/// Draws frames with the reference renderer: in f64 on the CPU, without a graphics adapter.
///
/// ```no_run
/// use bevy_app::App;
/// use halfway_record::{Continue, RecordError, Recording, ReferenceDrawing, record_with};
/// use std::ops::ControlFlow;
///
/// fn draw(app: &mut App) -> Result<(), RecordError> {
///     let drawing = ReferenceDrawing::default();
///     record_with(
///         app,
///         &Recording::new("teapot.png".into()),
///         |app, frame| drawing.picture(app, frame, &|_done, _of| ControlFlow::Continue(())),
///         |_done, _of| Continue::Yes,
///     )
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReferenceDrawing {
    /// The geometry that is drawn for each object. Default [`Mode::Mesh`].
    pub mode: Mode,
    /// The square root of the samples a pixel. `None`, the default, is 2 if the camera has four samples, else 1.
    pub supersampling: Option<u32>,
}

/// The divisor of the App's last picture, where it was divided.
#[derive(Resource)]
struct LastDivisor(f64);

impl ReferenceDrawing {
    /// Runs the App once and draws it. `progress` is called with the number of finished tiles of the picture and of all
    /// tiles, from any thread, and may stop the work.
    ///
    /// # Errors
    /// [`RecordError::Oracle`] for a scene that cannot be drawn, [`RecordError::Stopped`].
    pub fn picture(
        &self,
        app: &mut App,
        frame: FrameToDraw,
        progress: &(dyn Fn(u32, u32) -> ControlFlow<()> + Sync),
    ) -> Result<Picture, RecordError> {
        app.update();
        let camera = camera(app);
        let supersampling = self.supersampling.unwrap_or(match camera.samples {
            Samples::One => 1,
            Samples::Four => 2,
        });
        let oracle = Oracle::new(app.world_mut(), frame.size)?
            .with_mode(self.mode)
            .with_supersampling(supersampling)
            .with_clamping(frame.pixels == Pixels::Byte)
            .after(app.world().get_resource::<LastDivisor>().map(|last| last.0));
        let image = oracle.draw_with(progress).map_err(|_| RecordError::Stopped(frame.number))?;
        app.world_mut().remove_resource::<LastDivisor>();
        if let Some(divisor) = image.divisor() {
            app.insert_resource(LastDivisor(divisor));
        }
        let mut picture = match frame.pixels {
            Pixels::Byte => Picture::Byte(DynamicImage::from(image.to_bytes(camera.encoding)).into_rgba8()),
            Pixels::Float => Picture::Float(image.to_float()),
        };
        let world = app.world_mut();
        if !camera.background_is_plain() {
            let shares = background_shares(world, frame.size, supersampling)?;
            draw_background(&mut picture, &shares, &camera);
        }
        if has_lines(world) {
            // Edges are those of the mesh, whatever is drawn for it.
            let oracle = Oracle::new(world, frame.size)?;
            let surfaces = Surfaces::found_by(world, frame.size, |x, y| {
                let nearest = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5).nearest?;
                Some((nearest.object, nearest.triangle?))
            })?;
            draw_lines(world, &mut picture, &surfaces)?;
        }
        Ok(picture)
    }
}

/// How much of the background is seen in each pixel: what a white one adds to a black one.
fn background_shares(world: &mut World, size: UVec2, supersampling: u32) -> Result<Vec<f32>, OracleError> {
    let mut cameras = world.query::<&mut Camera>();
    let Some(before) = cameras.iter(world).next().copied() else { return Ok(Vec::new()) };
    let mut drawn = |background| {
        for mut camera in cameras.iter_mut(world) {
            *camera = Camera { background, intensity: Intensity::Clamp, ..before };
        }
        Ok(Oracle::new(world, size)?.with_supersampling(supersampling).with_clamping(true).draw().to_float())
    };
    let pictures = [LinearRgba::BLACK, LinearRgba::WHITE].map(&mut drawn);
    for mut camera in cameras.iter_mut(world) {
        *camera = before;
    }
    let [black, white] = pictures;
    let pixels = black?.into_raw().into_iter().zip(white?.into_raw());
    Ok(pixels.step_by(4).map(|(black, white)| white - black).collect())
}
