//! The parts of lines that lie behind surfaces.

/// The drawing of what lies behind surfaces: of [`Edges`](crate::Edges), and of the lines of a
/// [`LineStyle`](crate::LineStyle).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum HiddenEdges {
    /// It is left out.
    #[default]
    Omit,
    /// It is dashed: 5 pixels of line, 4 pixels of nothing.
    Dash,
}
