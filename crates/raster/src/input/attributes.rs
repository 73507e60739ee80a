//! Numbers of a piece's vertices, four by four.

/// More than the vertices of any piece; a number of 8 bits is always in range.
pub(crate) const SLOTS: usize = 256;

/// Four numbers a vertex.
pub(crate) type Attributes = [[f32; 4]; SLOTS];

/// Numbers of a vertex, four each, over w: texture coordinates of both sets; the color and opacity; then, where light
/// is shaded at the vertices, the ambient, diffuse and specular part; else the normal, the tangent with w (or what a
/// rise of 1 along the normal becomes), the part that is shaded at the vertices, and its ambient part.
pub(crate) const GROUPS: usize = 7;
pub(crate) const UVS: usize = 0;
pub(crate) const COLOR: usize = 1;
pub(crate) const PARTS: usize = 2;
pub(crate) const NORMAL: usize = 2;
pub(crate) const FRAME: usize = 3;
pub(crate) const OF_VERTICES: usize = 4;
pub(crate) const AMBIENT_OF_VERTICES: usize = 5;

/// Groups that any draw may have; after them is what solids take.
pub(crate) const GROUPS_BUT_SOLID: usize = 6;
/// Of draws with a solid: the place in the mesh's space.
pub(crate) const PLACE: usize = 6;

/// Of surrounded draws whose light is shaded at the vertices, or that have none: the normal.
pub(crate) const MIRROR_NORMAL: usize = 5;

/// The numbers of a piece's vertices, by side and group.
pub(crate) struct MappedVertices(Vec<Attributes>);

impl MappedVertices {
    pub(crate) fn new() -> Self {
        Self(Vec::new())
    }

    /// Makes room, once a mapped draw is met.
    pub(crate) fn prepare(&mut self) {
        if self.0.is_empty() {
            self.0 = vec![[[0.0; 4]; SLOTS]; 2 * GROUPS];
        }
    }

    pub(crate) fn group(&mut self, back: bool, group: usize) -> &mut [[f32; 4]] {
        &mut self.0[usize::from(back) * GROUPS + group][..]
    }

    /// Those of a vertex, of the side that is seen.
    pub(crate) fn of(&self, back: bool, group: usize, vertex: usize) -> &[f32; 4] {
        &self.0[usize::from(back) * GROUPS + group][vertex]
    }
}
