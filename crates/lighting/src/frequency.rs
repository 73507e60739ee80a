//! The frequency at which a term is evaluated.

// ANCHOR: frequency
/// The frequency at which a term of the lights is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Frequency {
    /// Nowhere: the term is left out.
    Never,
    /// Once a triangle, at its centroid, with its geometric normal turned to the side seen.
    Triangle,
    /// At each vertex, interpolated perspective-correctly.
    Vertex,
    /// At each fragment, with the interpolated normal.
    Fragment,
}
// ANCHOR_END: frequency
