//! Which vertex of a triangle gives what is not interpolated.

/// The vertex of a triangle from which its fragments get what is not interpolated, its provoking vertex. The texts ask
/// for the first, in WGSL `@interpolate(flat, first)`. OpenGL takes the last, OpenGL ES without a choice, and wgpu
/// refuses such a text there. So for OpenGL the text asks for `either`, and triangles are turned so that their own
/// vertex is the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ProvokingVertex {
    First,
    Last,
}

impl ProvokingVertex {
    pub(crate) fn of(backend: wgpu::Backend) -> Self {
        if backend == wgpu::Backend::Gl { Self::Last } else { Self::First }
    }

    /// Turns triangles with the vertex of their own in first place so that it is where it is looked for; windings stay.
    pub(crate) fn place(self, corners: &mut [u32]) {
        if self == Self::Last {
            corners.as_chunks_mut::<3>().0.iter_mut().for_each(|triangle| triangle.rotate_left(1));
        }
    }

    /// A text that asks for the first vertex, for the adapter.
    pub(crate) fn text(self, wgsl: &str) -> String {
        match self {
            Self::First => wgsl.into(),
            Self::Last => wgsl.replace("@interpolate(flat, first)", "@interpolate(flat, either)"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opengl_finds_the_first_vertex_last() {
        let placed = |backend| {
            let mut corners = [4, 5, 6, 9, 8, 7];
            ProvokingVertex::of(backend).place(&mut corners);
            corners
        };
        assert_eq!(placed(wgpu::Backend::Vulkan), [4, 5, 6, 9, 8, 7]);
        assert_eq!(placed(wgpu::Backend::Gl), [5, 6, 4, 8, 7, 9]);
    }
}
