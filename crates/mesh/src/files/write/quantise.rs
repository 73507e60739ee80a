//! Vertices as integers of 16 bits.

use glam::{DMat4, DVec3};

use crate::Mesh;

/// The largest value of an unsigned integer of 16 bits.
const MOST: f64 = 65535.0;

/// The grid that a mesh's positions are rounded to: the same step along all axes, so that normals stay as they are.
pub(super) struct Grid {
    origin: DVec3,
    step: f64,
}

impl Grid {
    pub(super) fn for_mesh(mesh: &Mesh) -> Self {
        let bounds = mesh.bounds();
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let step = (max - min).max_element() / MOST;
        // A node's matrix is in f32, which has to hold the step.
        Self { origin: min, step: step.max(f64::from(f32::MIN_POSITIVE)) }
    }

    /// The steps of a position.
    pub(super) fn round(&self, p: DVec3) -> [u16; 3] {
        ((p - self.origin) / self.step).to_array().map(|steps| steps.round().clamp(0.0, MOST) as u16)
    }

    pub(super) fn mesh_from_steps(&self) -> DMat4 {
        DMat4::from_translation(self.origin) * DMat4::from_scale(DVec3::splat(self.step))
    }

    /// How far a position moves at most: half a step along each axis, and what f32 rounds off the matrix.
    pub(super) fn largest_error(&self) -> f64 {
        let size = self.origin.abs().max_element() + MOST * self.step;
        0.5 * 3_f64.sqrt() * self.step + 4.0 * f64::from(f32::EPSILON) * size
    }
}

/// A number from −1 to 1 as glTF's normalised `SHORT`.
pub(super) fn signed(x: f32) -> i16 {
    (f64::from(x.clamp(-1.0, 1.0)) * 32767.0).round() as i16
}

/// A number from 0 to 1 as glTF's normalised `UNSIGNED_SHORT`.
pub(super) fn unsigned(x: f32) -> u16 {
    (f64::from(x.clamp(0.0, 1.0)) * MOST).round() as u16
}
