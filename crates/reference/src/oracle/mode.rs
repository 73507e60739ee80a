//! What the oracle shows of a mesh.

/// What a pixel shows of an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Exactly the mesh, shaded as its [`Shading`](halfway_lighting::Shading) says. Judges an implementation.
    #[default]
    Mesh,
    /// Where a mesh stands for a surface that is known by formula, that surface with its analytic normal at every
    /// pixel, whatever the shading; other meshes with Phong shading. Terms that are
    /// [`Never`](halfway_lighting::Frequency::Never) shaded stay so. Judges a method: what flat, Gouraud and Phong lose
    /// at a tessellation.
    Surface,
}
