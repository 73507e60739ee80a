//! The data of the Utah teapot: ten patches of 16 control points, and the symmetries that make 32 of them.
//!
//! Martin Newell's model of 1975 (Ph.D. thesis, University of Utah) in the form in which it was published: with the
//! lower height that James Blinn gave it and with the bottom that was added later. F. Crow, "The Origins of the
//! Teapot", IEEE Computer Graphics and Applications 7 (1), January 1987, pages 8–19, and the listing that accompanies
//! it.

use glam::DVec3;

/// The symmetry that maps a patch to the next one of its part of the teapot.
#[derive(Clone, Copy)]
pub(super) enum Symmetry {
    /// Quarter turns about the axis, clockwise as seen from above; four patches go around.
    Clockwise,
    /// Quarter turns the other way round.
    CounterClockwise,
    /// The mirror in the plane through spout and handle; there are two patches.
    Mirror,
}

impl Symmetry {
    /// How many patches there are.
    pub(super) fn count(self) -> usize {
        match self {
            Self::Clockwise | Self::CounterClockwise => 4,
            Self::Mirror => 2,
        }
    }

    /// The patch after this one. A mirrored one has its rows reversed, so that its outward side stays outside.
    pub(super) fn next(self, patch: &[DVec3; 16]) -> [DVec3; 16] {
        let next = match self {
            Self::Clockwise => patch.map(|p| DVec3::new(p.y, -p.x, p.z)),
            Self::CounterClockwise => patch.map(|p| DVec3::new(-p.y, p.x, p.z)),
            Self::Mirror => std::array::from_fn(|i| patch[4 * (i / 4) + 3 - i % 4] * DVec3::new(1.0, -1.0, 1.0)),
        };
        // −0 becomes 0.
        next.map(|p| p + DVec3::ZERO)
    }
}

/// The first patch of each part, as four rows of four control points, Z up: the teapot stands on z = 0, its axis is the
/// Z axis, its spout points along +X.
#[rustfmt::skip]
pub(super) const PATCHES: [(Symmetry, [[f64; 3]; 16]); 10] = [
    // rim
    (Symmetry::Clockwise, [
        [1.4, 0.0, 2.4], [1.4, -0.784, 2.4], [0.784, -1.4, 2.4], [0.0, -1.4, 2.4],
        [1.3375, 0.0, 2.53125], [1.3375, -0.749, 2.53125], [0.749, -1.3375, 2.53125], [0.0, -1.3375, 2.53125],
        [1.4375, 0.0, 2.53125], [1.4375, -0.805, 2.53125], [0.805, -1.4375, 2.53125], [0.0, -1.4375, 2.53125],
        [1.5, 0.0, 2.4], [1.5, -0.84, 2.4], [0.84, -1.5, 2.4], [0.0, -1.5, 2.4],
    ]),
    // body, upper half
    (Symmetry::Clockwise, [
        [1.5, 0.0, 2.4], [1.5, -0.84, 2.4], [0.84, -1.5, 2.4], [0.0, -1.5, 2.4],
        [1.75, 0.0, 1.875], [1.75, -0.98, 1.875], [0.98, -1.75, 1.875], [0.0, -1.75, 1.875],
        [2.0, 0.0, 1.35], [2.0, -1.12, 1.35], [1.12, -2.0, 1.35], [0.0, -2.0, 1.35],
        [2.0, 0.0, 0.9], [2.0, -1.12, 0.9], [1.12, -2.0, 0.9], [0.0, -2.0, 0.9],
    ]),
    // body, lower half
    (Symmetry::Clockwise, [
        [2.0, 0.0, 0.9], [2.0, -1.12, 0.9], [1.12, -2.0, 0.9], [0.0, -2.0, 0.9],
        [2.0, 0.0, 0.45], [2.0, -1.12, 0.45], [1.12, -2.0, 0.45], [0.0, -2.0, 0.45],
        [1.5, 0.0, 0.225], [1.5, -0.84, 0.225], [0.84, -1.5, 0.225], [0.0, -1.5, 0.225],
        [1.5, 0.0, 0.15], [1.5, -0.84, 0.15], [0.84, -1.5, 0.15], [0.0, -1.5, 0.15],
    ]),
    // handle, upper half
    (Symmetry::Mirror, [
        [-1.6, 0.0, 2.025], [-1.6, -0.3, 2.025], [-1.5, -0.3, 2.25], [-1.5, 0.0, 2.25],
        [-2.3, 0.0, 2.025], [-2.3, -0.3, 2.025], [-2.5, -0.3, 2.25], [-2.5, 0.0, 2.25],
        [-2.7, 0.0, 2.025], [-2.7, -0.3, 2.025], [-3.0, -0.3, 2.25], [-3.0, 0.0, 2.25],
        [-2.7, 0.0, 1.8], [-2.7, -0.3, 1.8], [-3.0, -0.3, 1.8], [-3.0, 0.0, 1.8],
    ]),
    // handle, lower half
    (Symmetry::Mirror, [
        [-2.7, 0.0, 1.8], [-2.7, -0.3, 1.8], [-3.0, -0.3, 1.8], [-3.0, 0.0, 1.8],
        [-2.7, 0.0, 1.575], [-2.7, -0.3, 1.575], [-3.0, -0.3, 1.35], [-3.0, 0.0, 1.35],
        [-2.5, 0.0, 1.125], [-2.5, -0.3, 1.125], [-2.65, -0.3, 0.9375], [-2.65, 0.0, 0.9375],
        [-2.0, 0.0, 0.9], [-2.0, -0.3, 0.9], [-1.9, -0.3, 0.6], [-1.9, 0.0, 0.6],
    ]),
    // spout, lower half
    (Symmetry::Mirror, [
        [1.7, 0.0, 1.425], [1.7, -0.66, 1.425], [1.7, -0.66, 0.6], [1.7, 0.0, 0.6],
        [2.6, 0.0, 1.425], [2.6, -0.66, 1.425], [3.1, -0.66, 0.825], [3.1, 0.0, 0.825],
        [2.3, 0.0, 2.1], [2.3, -0.25, 2.1], [2.4, -0.25, 2.025], [2.4, 0.0, 2.025],
        [2.7, 0.0, 2.4], [2.7, -0.25, 2.4], [3.3, -0.25, 2.4], [3.3, 0.0, 2.4],
    ]),
    // spout, upper half
    (Symmetry::Mirror, [
        [2.7, 0.0, 2.4], [2.7, -0.25, 2.4], [3.3, -0.25, 2.4], [3.3, 0.0, 2.4],
        [2.8, 0.0, 2.475], [2.8, -0.25, 2.475], [3.525, -0.25, 2.49375], [3.525, 0.0, 2.49375],
        [2.9, 0.0, 2.475], [2.9, -0.15, 2.475], [3.45, -0.15, 2.5125], [3.45, 0.0, 2.5125],
        [2.8, 0.0, 2.4], [2.8, -0.15, 2.4], [3.2, -0.15, 2.4], [3.2, 0.0, 2.4],
    ]),
    // lid, knob
    (Symmetry::Clockwise, [
        [0.0, 0.0, 3.15], [0.0, 0.0, 3.15], [0.0, 0.0, 3.15], [0.0, 0.0, 3.15],
        [0.8, 0.0, 3.15], [0.8, -0.45, 3.15], [0.45, -0.8, 3.15], [0.0, -0.8, 3.15],
        [0.0, 0.0, 2.85], [0.0, 0.0, 2.85], [0.0, 0.0, 2.85], [0.0, 0.0, 2.85],
        [0.2, 0.0, 2.7], [0.2, -0.112, 2.7], [0.112, -0.2, 2.7], [0.0, -0.2, 2.7],
    ]),
    // lid
    (Symmetry::Clockwise, [
        [0.2, 0.0, 2.7], [0.2, -0.112, 2.7], [0.112, -0.2, 2.7], [0.0, -0.2, 2.7],
        [0.4, 0.0, 2.55], [0.4, -0.224, 2.55], [0.224, -0.4, 2.55], [0.0, -0.4, 2.55],
        [1.3, 0.0, 2.55], [1.3, -0.728, 2.55], [0.728, -1.3, 2.55], [0.0, -1.3, 2.55],
        [1.3, 0.0, 2.4], [1.3, -0.728, 2.4], [0.728, -1.3, 2.4], [0.0, -1.3, 2.4],
    ]),
    // bottom
    (Symmetry::CounterClockwise, [
        [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0],
        [1.425, 0.0, 0.0], [1.425, 0.798, 0.0], [0.798, 1.425, 0.0], [0.0, 1.425, 0.0],
        [1.5, 0.0, 0.075], [1.5, 0.84, 0.075], [0.84, 1.5, 0.075], [0.0, 1.5, 0.075],
        [1.5, 0.0, 0.15], [1.5, 0.84, 0.15], [0.84, 1.5, 0.15], [0.0, 1.5, 0.15],
    ]),
];
