//! Backends, which draw batches.

use crate::batch::key::DrawKey;

/// A drawer of batches, as far as it has a say in how they are made. All else that it takes is data:
/// [`LitPatches`](super::lit_patches::LitPatches), [`Batches`](super::batches::Batches) and the triangles in
/// [`Geometries`](crate::geometry::meshes::Geometries), none of which holds anything of wgpu's.
pub trait Backend {
    /// Whether it lights by an environment what has images or a solid.
    fn lights_images_by_environments(&self) -> bool;

    /// The key itself, or a more general one that draws the same, where there is nothing that draws this one alone.
    fn admit(&mut self, key: DrawKey) -> DrawKey;

    /// Whether the instances of such a draw can look up their records. If not, each record is a draw.
    fn looks_up(&mut self, key: DrawKey) -> bool;

    /// Whether it answers as it did in the last frame. Then a frame that is equal in all else is not made anew.
    fn is_settled(&self) -> bool;
}
