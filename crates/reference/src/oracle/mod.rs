//! The oracle: what each pixel of a scene should be.
//!
//! `gather` takes the world's entities into eye space (`view`, `solid`), `raster` finds what a ray through a point of
//! the picture meets, `shade` says what that gives back, `layers` puts it one over the other, `draw` does so for every
//! pixel and `probe` for any point. `possible` says what else a pixel may show, for judges.

mod draw;
mod error;
mod gather;
mod grid;
mod layers;
mod mapped;
mod maps;
mod mode;
mod possible;
mod probe;
mod raster;
mod shade;
mod solid;
mod surrounded;
mod surroundings;
mod view;

use std::sync::OnceLock;

use bevy_ecs::world::World;
use bevy_math::UVec2;
use halfway_lighting::equations::divisor;
use halfway_lighting::{Intensity, Samples};

pub use error::{OracleError, Stopped};
pub use mode::Mode;
pub use possible::{ColorRange, Possible};
pub use probe::{Nearest, Seen};

use gather::OracleScene;
use grid::VertexGrid;
use raster::Tiles;

use crate::Image;

/// A scene, ready to be drawn in f64.
///
/// What is drawn where:
/// - A point of the picture shows what the ray through it meets: the nearest opaque surface beyond the near plane, and
///   the blended ones before it. Of two triangles that share an edge exactly one is met (top-left rule). Triangles
///   without area are not drawn.
/// - Opaque surfaces at equal depth (to 10⁻⁹ of it): the one that was spawned first, then the one that comes first in
///   the mesh.
/// - What the camera's [`Intensity`] makes of the finished picture is done last, after samples are averaged.
/// - Blended objects are drawn over the opaque ones from back to front by the view depth of the middle of their bounds,
///   those of equal depth (in f32) as they were spawned; of a two-sided one the back faces, then the front faces; then
///   in the order of the mesh. Each gives opacity·I + (1 − opacity)·what is behind.
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
    /// Found when they are first needed: they depend on the mode.
    tiles: OnceLock<Tiles>,
}

impl Oracle {
    /// The most pixels of a picture, 2²⁶.
    pub const MAX_PIXELS: u64 = 1 << 26;
    /// The most samples a pixel along each axis, 64.
    pub const MAX_SUPERSAMPLING: u32 = 64;

    /// Takes the scene as it stands in `world`, for a picture of `size` pixels.
    ///
    /// `GlobalTransform`s have to be current, as they are after a frame of the App. Where there is no `GlobalAmbient`
    /// resource its default counts.
    ///
    /// # Errors
    /// The first thing that keeps the scene from being drawn as asked.
    pub fn new(world: &mut World, size: UVec2) -> Result<Self, OracleError> {
        let UVec2 { x: width, y: height } = size;
        if width == 0 || height == 0 {
            return Err(OracleError::EmptyPicture { width, height });
        }
        if u64::from(width) * u64::from(height) > Self::MAX_PIXELS {
            return Err(OracleError::TooLarge { width, height, limit: Self::MAX_PIXELS });
        }
        let scene = OracleScene::gather(world, size)?;
        Ok(Self { scene, size, supersampling: 1, clamp: false, grid: None, before: None, tiles: OnceLock::new() })
    }

    /// What is drawn of each object; [`Mode::Mesh`] unless said.
    #[must_use]
    pub fn with_mode(mut self, mode: Mode) -> Self {
        for solid in &mut self.scene.solids {
            solid.set_mode(mode);
        }
        self.tiles = OnceLock::new();
        self
    }

    /// Draws as a rasterizer that puts vertices on a grid of N bits within a pixel; exactly unless said. What is
    /// interpolated between vertices, and how it changes from a pixel to the next, is then as on the moved triangles;
    /// what is shaded at vertices is not.
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

    /// `n` × `n` samples a pixel, averaged, in place of its centre; 1 unless said. They are the centres of the pixel's
    /// `n` × `n` squares. `n` is taken into 1 to [`MAX_SUPERSAMPLING`](Self::MAX_SUPERSAMPLING).
    #[must_use]
    pub fn with_supersampling(self, n: u32) -> Self {
        Self { supersampling: n.clamp(1, Self::MAX_SUPERSAMPLING), ..self }
    }

    /// Whether each surface, and the background, is clamped to 1 before it is blended, as 8-bit pictures are; not
    /// unless said, and never where the camera's [`Intensity`] acts on the finished picture.
    #[must_use]
    pub fn with_clamping(self, clamp: bool) -> Self {
        Self { clamp: clamp && !self.scene.intensity.acts_on_pictures(), ..self }
    }

    /// Draws the frame after one that was divided by `before`, which counts under [`Intensity::Renormalize`] with
    /// smoothing; unless said there is none before.
    #[must_use]
    pub fn after(self, before: Option<f64>) -> Self {
        Self { before, ..self }
    }

    /// The finished picture, as the camera's policy has it.
    fn under_policy(&self, image: Image) -> Image {
        match self.scene.intensity {
            Intensity::Clamp => image,
            Intensity::Renormalize { smoothing } => {
                let (largest, plain) = (image.largest(), 0.0);
                let by = divisor(largest, self.before.unwrap_or(plain), self.before.map_or(0.0, |_| smoothing.into()));
                image.divided(by)
            }
            policy => image.mapped(|channel| policy.toned(channel)),
        }
    }

    /// Coverage samples a pixel of the pictures that are judged, as the camera says.
    pub(crate) fn samples(&self) -> Samples {
        self.scene.samples
    }

    fn tiles(&self) -> &Tiles {
        self.tiles.get_or_init(|| Tiles::new(&self.scene))
    }
}
