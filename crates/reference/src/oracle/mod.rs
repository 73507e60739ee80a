//! The oracle: what each pixel of a scene should be.
//!
//! `scene` transforms the world's entities into eye space (`view`, `solid`), `raster` intersects the ray through a
//! point of the picture, `shade` computes the colour of a hit and `shows` other values, `layers` blends the hits of a ray,
//! `draw` does so for every pixel, `probe` for any point, and `explained` says how a pixel came to its colour. `possible`
//! lists the other colours that a pixel may show, for the judge. `student` draws the scene with mistakes.

mod draw;
mod environment;
mod environment_terms;
mod error;
mod explained;
mod grid;
mod layers;
mod mapped;
mod maps;
mod mode;
mod possible;
mod probe;
mod raster;
mod scene;
mod shade;
mod shows;
mod solid;
mod student;
mod view;

use std::sync::OnceLock;

use bevy_ecs::world::World;
use bevy_math::UVec2;
use halfway_lighting::equations::divisor;
use halfway_lighting::{Intensity, Samples};

pub use error::{OracleError, Stopped};
pub use mode::Mode;
pub use possible::{ColorRange, Possible};
pub use probe::{Nearest, Probe};
pub use shows::Shows;
pub(crate) use student::HitSheet;

use grid::VertexGrid;
use raster::Tiles;
use scene::OracleScene;

use crate::Image;

/// A scene, ready to be drawn in f64.
///
/// Visibility:
/// - A point of the picture shows the surfaces on the ray through it: the nearest opaque one beyond the near plane, and
///   the blended ones before it. Of two triangles that share an edge exactly one is hit (top-left rule). Triangles
///   without area are not drawn.
/// - Opaque surfaces at equal depth (to 10⁻⁹ of it): the one that was spawned first, then the one that comes first in
///   the mesh.
/// - The camera's [`Intensity`] acts on the finished picture, after samples are averaged.
/// - Blended objects are drawn over the opaque ones from back to front by the view depth of the middle of their bounds,
///   those of equal depth (in f32) as they were spawned; of a two-sided one the back faces, then the front faces; then
///   in the order of the mesh. Each gives opacity·I + (1 − opacity)·B, where B is the color behind it.
#[derive(Clone, Debug)]
pub struct Oracle {
    scene: OracleScene,
    size: UVec2,
    supersampling: u32,
    clamp: bool,
    /// The grid that vertices are on.
    grid: Option<VertexGrid>,
    /// The divisor of the frame before.
    before: Option<f64>,
    /// Computed at first use, since they depend on the mode.
    tiles: OnceLock<Tiles>,
}

impl Oracle {
    /// The most pixels of a picture, 2²⁶.
    pub const MAX_PIXELS: u64 = 1 << 26;
    /// The most samples a pixel along each axis, 64.
    pub const MAX_SUPERSAMPLING: u32 = 64;

    /// Reads the current scene of `world`, for a picture of `size` pixels.
    ///
    /// Of several cameras, the one whose [turn](halfway_lighting::CameraTurn) it is sees it: for its part of a picture that
    /// cameras share, with the size of the part.
    ///
    /// `GlobalTransform`s have to be current, as they are after a frame of the App. Without a `GlobalAmbient` resource
    /// its default is used.
    ///
    /// # Errors
    /// The first reason for which the scene cannot be drawn.
    pub fn new(world: &mut World, size: UVec2) -> Result<Self, OracleError> {
        let UVec2 { x: width, y: height } = size;
        if width == 0 || height == 0 {
            return Err(OracleError::EmptyPicture { width, height });
        }
        if u64::from(width) * u64::from(height) > Self::MAX_PIXELS {
            return Err(OracleError::TooLarge { width, height, limit: Self::MAX_PIXELS });
        }
        let scene = OracleScene::from_world(world, size)?;
        Ok(Self { scene, size, supersampling: 1, clamp: false, grid: None, before: None, tiles: OnceLock::new() })
    }

    /// Draws each object's mesh or its surface. Default [`Mode::Mesh`].
    #[must_use]
    pub fn with_mode(mut self, mode: Mode) -> Self {
        for solid in &mut self.scene.solids {
            solid.set_mode(mode);
        }
        self.tiles = OnceLock::new();
        self
    }

    /// Draws like a rasterizer that snaps vertices to a grid of N bits within a pixel; by default vertices are exact.
    /// Interpolated values, and their derivatives, are then those of the snapped triangles; shading at vertices is not
    /// affected.
    #[must_use]
    pub fn on_grid(mut self, bits: u32) -> Self {
        let (view, grid) = (self.scene.view, VertexGrid::new(bits));
        for solid in &mut self.scene.solids {
            solid.draw_at(|p| view.on_grid(p, grid));
        }
        self.grid = Some(grid);
        self.tiles = OnceLock::new();
        self
    }

    /// Averages `n` × `n` samples a pixel, default 1. They are the centres of the pixel's `n` × `n` squares. `n` is
    /// clamped to 1 to [`MAX_SUPERSAMPLING`](Self::MAX_SUPERSAMPLING).
    #[must_use]
    pub fn with_supersampling(self, n: u32) -> Self {
        Self { supersampling: n.clamp(1, Self::MAX_SUPERSAMPLING), ..self }
    }

    /// Averages as many samples a pixel as the camera has, in as many squares.
    #[must_use]
    pub fn with_samples_of_camera(self) -> Self {
        let side = self.scene.samples.count().isqrt();
        self.with_supersampling(side)
    }

    /// Whether each surface, and the background, is clamped to 1 before it is blended, as in 8-bit pictures. Default
    /// `false`; ignored where the camera's [`Intensity`] acts on the finished picture.
    #[must_use]
    pub fn with_clamping(self, clamp: bool) -> Self {
        Self { clamp, ..self }
    }

    /// Shows other values in place of the colours, which are then neither clamped nor changed by the camera's [`Intensity`].
    /// Default [`Shows::Color`].
    #[must_use]
    pub fn showing(mut self, shows: Shows) -> Self {
        self.scene.shows = shows;
        self
    }

    /// Whether the camera sees an environment as its background.
    pub fn has_sky(&self) -> bool {
        self.scene.environment.as_ref().is_some_and(|environment| environment.sky.is_some())
    }

    /// Draws the frame after one that was divided by `before`, which matters under [`Intensity::Renormalize`] with
    /// smoothing. Default `None`: there was no frame before.
    #[must_use]
    pub fn after(self, before: Option<f64>) -> Self {
        Self { before, ..self }
    }

    /// Whether intensities are clamped to 1 before they are blended.
    fn clamps(&self) -> bool {
        self.clamp && self.scene.shows == Shows::Color && !self.scene.intensity.acts_on_pictures()
    }

    /// The policy for the finished picture.
    pub(crate) fn policy(&self) -> Intensity {
        if self.scene.shows == Shows::Color { self.scene.intensity } else { Intensity::Clamp }
    }

    /// Applies the camera's intensity policy to the picture.
    fn under_policy(&self, image: Image) -> Image {
        match self.policy() {
            Intensity::Clamp => image,
            Intensity::Renormalize { smoothing } => {
                let (largest, plain) = (image.largest(), 0.0);
                let by = divisor(largest, self.before.unwrap_or(plain), self.before.map_or(0.0, |_| smoothing.into()));
                image.divided(by)
            }
            policy => image.mapped(|channel| policy.toned(channel)),
        }
    }

    /// Width and height of the picture in pixels.
    pub(crate) fn size(&self) -> (u32, u32) {
        self.size.into()
    }

    /// The camera's coverage samples a pixel, for the judge.
    pub(crate) fn samples(&self) -> Samples {
        self.scene.samples
    }

    fn tiles(&self) -> &Tiles {
        self.tiles.get_or_init(|| Tiles::new(&self.scene))
    }
}
