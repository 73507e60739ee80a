//! Frames by the reference renderer.

use std::collections::HashMap;
use std::ops::ControlFlow;

use bevy_app::App;
use bevy_color::LinearRgba;
use bevy_ecs::prelude::{Entity, Resource, World};
use bevy_math::UVec2;
use halfway_lighting::{Camera, CameraTurn, Encoding, Intensity, Legend, Load, Samples, SharedPart, current_camera};
use halfway_reference::{Mode, Oracle, OracleError};
use halfway_render::{
    Picture, Pixels, Quantity, QuantityImage, RenderError, draw_background, draw_kept, draw_legend, draw_lines,
    has_lines,
};
use image::DynamicImage;

use crate::oracle_surfaces::{OracleFrame, sharing, surfaces};
use crate::recording::{FrameToDraw, RecordError, of_oracle};

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
    /// The square root of the samples a pixel. `None`, the default, is that of the camera's: 1, 2, 4 or 8.
    pub supersampling: Option<u32>,
}

/// The divisors of the last picture of each camera, where it was divided.
#[derive(Resource, Default)]
struct LastDivisors(HashMap<Entity, f64>);

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
        let parts = sharing(app.world_mut(), frame.size);
        app.insert_resource(OracleFrame(frame.size));
        if parts.is_empty() {
            let mut picture = self.of_camera(app, frame, None, progress)?;
            add_legend(app.world_mut(), &mut picture);
            return Ok(picture);
        }
        let mut whole: Option<Picture> = None;
        for SharedPart { camera, corner, size, load } in parts {
            let (corner, size) = (corner.into(), size.into());
            app.insert_resource(CameraTurn(Some(camera)));
            let kept = whole.as_ref().filter(|_| load == Load::Keep).map(|whole| whole.part(corner, size));
            let part = self.of_camera(app, FrameToDraw { size, ..frame }, kept.as_ref(), progress);
            app.insert_resource(CameraTurn(None));
            let part = part?;
            whole.get_or_insert_with(|| part.black(frame.size)).put(corner, &part)?;
        }
        let mut whole = whole.ok_or(RenderError::NoCamera)?;
        add_legend(app.world_mut(), &mut whole);
        Ok(whole)
    }

    /// Pictures of quantities of the frame that was drawn last, of `size` pixels.
    ///
    /// # Errors
    /// [`RecordError::Oracle`], and [`RecordError::NotOfReference`] for a quantity that the reference renderer has not.
    pub fn quantities(
        &self,
        app: &mut App,
        size: UVec2,
        quantities: &[Quantity],
    ) -> Result<Vec<QuantityImage>, RecordError> {
        of_oracle(app.world_mut(), size, quantities)
    }

    /// The picture of the camera to draw, over what is `kept` of other cameras.
    fn of_camera(
        &self,
        app: &mut App,
        frame: FrameToDraw,
        kept: Option<&Picture>,
        progress: &(dyn Fn(u32, u32) -> ControlFlow<()> + Sync),
    ) -> Result<Picture, RecordError> {
        let entity = current_camera(app.world_mut()).map_err(|_| RenderError::NoCamera)?;
        let camera = *app.world().get::<Camera>(entity).ok_or(RenderError::NoCamera)?;
        let supersampling = self.supersampling.unwrap_or(match camera.samples {
            Samples::One => 1,
            Samples::Four => 2,
            Samples::Sixteen => 4,
            Samples::SixtyFour => 8,
        });
        let oracle = Oracle::new(app.world_mut(), frame.size)?
            .with_mode(self.mode)
            .with_supersampling(supersampling)
            .with_clamping(frame.pixels == Pixels::Byte)
            .after(app.world().get_resource::<LastDivisors>().and_then(|last| last.0.get(&entity).copied()));
        let image = oracle.draw_with(progress).map_err(|_| RecordError::Stopped(frame.number))?;
        let mut last = app.world_mut().get_resource_or_init::<LastDivisors>();
        match image.divisor() {
            Some(divisor) => last.0.insert(entity, divisor),
            None => last.0.remove(&entity),
        };
        let mut picture = match frame.pixels {
            Pixels::Byte => Picture::Byte(DynamicImage::from(image.to_bytes(camera.encoding)).into_rgba8()),
            Pixels::Float => Picture::Float(image.to_float()),
        };
        let world = app.world_mut();
        if kept.is_some() || !camera.background_is_plain() {
            let shares = background_shares(world, (entity, camera), frame.size, supersampling)?;
            match kept {
                Some(kept) => draw_kept(&mut picture, &shares, &camera, kept),
                None => draw_background(&mut picture, &shares, &camera),
            }
        }
        if has_lines(world) {
            // Edges are those of the mesh, whatever is drawn for it.
            let surfaces = surfaces(world, frame.size)?;
            draw_lines(world, &mut picture, &surfaces)?;
        }
        Ok(picture)
    }
}

/// Draws the legend, in the encoding of the first camera.
fn add_legend(world: &mut World, picture: &mut Picture) {
    let encoding = world.query::<&Camera>().iter(world).next().map_or_else(Encoding::default, |camera| camera.encoding);
    if let Some(legend) = world.get_resource::<Legend>() {
        draw_legend(picture, legend, encoding);
    }
}

/// How much of the background is seen in each pixel: what a white one adds to a black one.
fn background_shares(
    world: &mut World,
    (entity, camera): (Entity, Camera),
    size: UVec2,
    supersampling: u32,
) -> Result<Vec<f32>, OracleError> {
    let mut drawn = |background| {
        world.entity_mut(entity).insert(Camera { background, intensity: Intensity::Clamp, ..camera });
        Ok(Oracle::new(world, size)?.with_supersampling(supersampling).with_clamping(true).draw().to_float())
    };
    let pictures = [LinearRgba::BLACK, LinearRgba::WHITE].map(&mut drawn);
    world.entity_mut(entity).insert(camera);
    let [black, white] = pictures;
    let pixels = black?.into_raw().into_iter().zip(white?.into_raw());
    Ok(pixels.step_by(4).map(|(black, white)| white - black).collect())
}
