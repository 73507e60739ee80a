//! The oracle's two ways to draw a mesh.

/// Whether the oracle draws the triangles of a mesh or the surface that it stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Exactly the mesh, shaded by its [`Shading`](halfway_lighting::Shading).
    /// Judges an implementation.
    #[default]
    Mesh,
    /// Where a mesh stands for a surface that is known by formula, that surface with its analytic normal at every
    /// pixel, whatever the shading; other meshes with Phong shading. Terms that are
    /// [`Never`](halfway_lighting::Frequency::Never) shaded stay so. Judges a method: the error of flat, Gouraud and
    /// Phong shading at a tessellation.
    Surface,
}
