//! Numbers of a piece's vertices, four by four.

/// More than the vertices of any piece; a number of 8 bits is always in range.
pub(crate) const SLOTS: usize = 256;

/// Four numbers a vertex.
pub(crate) type Attributes = [[f32; 4]; SLOTS];

/// Numbers of a vertex, four each, over w: texture coordinates of both sets; the color and opacity; then, where light
/// is shaded at the vertices, the ambient, diffuse and specular part; else the normal, the tangent with w (or the
/// transformed normal, for height maps), the part that is shaded at the vertices, and its ambient part.
pub(crate) const GROUPS: usize = 7;
pub(crate) const UVS: usize = 0;
pub(crate) const COLOR: usize = 1;
pub(crate) const PARTS: usize = 2;
pub(crate) const NORMAL: usize = 2;
pub(crate) const FRAME: usize = 3;
pub(crate) const OF_VERTICES: usize = 4;
pub(crate) const AMBIENT_OF_VERTICES: usize = 5;

/// Groups that any draw may have; the group of solids follows them.
pub(crate) const GROUPS_BUT_SOLID: usize = 6;
/// The group of the position in mesh space, in draws with a solid.
pub(crate) const PLACE: usize = 6;

/// The group of the normal, in draws with an environment whose light is shaded at the vertices, or that are unlit.
pub(crate) const MIRROR_NORMAL: usize = 5;

/// The numbers of a piece's vertices, by side and group.
pub(crate) struct MappedVertices(Vec<Attributes>);

impl MappedVertices {
    pub(crate) fn new() -> Self {
        Self(Vec::new())
    }

    /// Allocates the memory, at the first mapped draw.
    pub(crate) fn prepare(&mut self) {
        if self.0.is_empty() {
            self.0 = vec![[[0.0; 4]; SLOTS]; 2 * GROUPS];
        }
    }

    pub(crate) fn group(&mut self, back: bool, group: usize) -> &mut [[f32; 4]] {
        &mut self.0[usize::from(back) * GROUPS + group][..]
    }

    /// The attributes of a vertex, on the visible side.
    pub(crate) fn at(&self, back: bool, group: usize, vertex: usize) -> &[f32; 4] {
        &self.0[usize::from(back) * GROUPS + group][vertex]
    }
}
