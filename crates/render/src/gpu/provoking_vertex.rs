//! The provoking vertex of triangles.

/// The provoking vertex of a triangle: its fragments get flat varyings from it. The shaders request the first, in WGSL
/// `@interpolate(flat, first)`. OpenGL uses the last, OpenGL ES always, and wgpu refuses such shaders there. So for
/// OpenGL the shader requests `either`, and triangles are rotated so that their own vertex is the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ProvokingVertex {
    First,
    Last,
}

impl ProvokingVertex {
    pub(crate) fn for_backend(backend: wgpu::Backend) -> Self {
        if backend == wgpu::Backend::Gl { Self::Last } else { Self::First }
    }

    /// Rotates triangles whose own vertex comes first so that it is the provoking one; windings stay.
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
            ProvokingVertex::for_backend(backend).place(&mut corners);
            corners
        };
        assert_eq!(placed(wgpu::Backend::Vulkan), [4, 5, 6, 9, 8, 7]);
        assert_eq!(placed(wgpu::Backend::Gl), [5, 6, 4, 8, 7, 9]);
    }
}
