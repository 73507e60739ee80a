//! Frames by the reference renderer.

use std::collections::HashMap;
use std::ops::ControlFlow;

use bevy_app::App;
use bevy_ecs::prelude::{Entity, Resource, World};
use bevy_math::UVec2;
use halfway_lighting::{Camera, CameraTurn, Encoding, Legend, Load, SharedPart, current_camera};
use halfway_reference::{Mode, Oracle, OracleError, Shows};
use halfway_render::{
    Picture, Pixels, Quantity, QuantityImage, RenderError, draw_background, draw_kept, draw_legend, draw_lines,
    has_lines,
};
use image::DynamicImage;

use crate::oracle_quantities::{self, OracleFrame, sharing, side, surfaces};
use crate::recording::{FrameToDraw, RecordError};

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
        app.insert_resource(self.frame(frame.size));
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

    /// Quantities of the world as it is, in the order in which they are asked for, for a picture of this size. Those of
    /// surfaces are of the meshes, whatever [`mode`](Self::mode) is; averages are those of the picture.
    ///
    /// # Errors
    /// [`OracleError`] for a scene that cannot be drawn.
    pub fn take_quantities(
        &self,
        world: &mut World,
        size: UVec2,
        quantities: &[Quantity],
    ) -> Result<Vec<QuantityImage>, OracleError> {
        oracle_quantities::quantities(world, self.frame(size), quantities)
    }

    fn frame(&self, size: UVec2) -> OracleFrame {
        OracleFrame { size, mode: self.mode, supersampling: self.supersampling }
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
        let supersampling = self.supersampling.unwrap_or_else(|| side(camera.samples));
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
        if !oracle.has_sky() && (kept.is_some() || !camera.background_is_plain()) {
            let coverage = oracle.showing(Shows::Coverage).draw();
            let shares: Vec<f32> = coverage.pixels().iter().map(|&[coverage, ..]| (1.0 - coverage) as f32).collect();
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
