//! Shared by the text formats: parts in world space.

use std::path::Path;

use glam::{DMat3, DVec3, Mat4, Vec3};

use super::file::WriteError;
use crate::{LinePart, Model, Part};

/// The vertices of a part in world space.
pub(super) struct Placed {
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    /// Whether triangles wind the opposite way because the part is mirrored.
    mirrored: bool,
}

impl Placed {
    pub(super) fn new(path: &Path, index: usize, part: &Part) -> Result<Self, WriteError> {
        let (positions, normals) = (part.mesh.positions(), part.mesh.normals());
        if part.world_from_part == Mat4::IDENTITY {
            return Ok(Self { positions: positions.to_vec(), normals: normals.to_vec(), mirrored: false });
        }
        let world_from_part = part.world_from_part.as_dmat4();
        let positions: Vec<Vec3> =
            positions.iter().map(|p| world_from_part.transform_point3(p.as_dvec3()).as_vec3()).collect();
        if !positions.iter().all(|p| p.is_finite()) {
            return Err(WriteError::NotFinite { path: path.to_owned(), part: index });
        }
        let m = DMat3::from_mat4(world_from_part);
        let mirrored = m.determinant() < 0.0;
        // The inverse transpose up to a factor, whose sign is corrected.
        let cofactors = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
        let sign = if mirrored { -1.0 } else { 1.0 };
        let turn = |n: &Vec3| (sign * (cofactors * n.as_dvec3())).try_normalize().unwrap_or(n.as_dvec3()).as_vec3();
        Ok(Self { normals: normals.iter().map(turn).collect(), positions, mirrored })
    }

    /// The positions of lines and points in world space.
    pub(super) fn line_positions(path: &Path, index: usize, part: &LinePart) -> Result<Vec<Vec3>, WriteError> {
        if part.world_from_part == Mat4::IDENTITY {
            return Ok(part.lines.positions().to_vec());
        }
        let world_from_part = part.world_from_part.as_dmat4();
        let place = |p: &Vec3| world_from_part.transform_point3(p.as_dvec3()).as_vec3();
        let positions: Vec<Vec3> = part.lines.positions().iter().map(place).collect();
        if positions.iter().all(|p| p.is_finite()) {
            return Ok(positions);
        }
        Err(WriteError::NotFinite { path: path.to_owned(), part: index })
    }

    /// The corners of a triangle, swapped if mirrored so that its front stays in front.
    pub(super) fn triangle(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.mirrored { [a, c, b] } else { [a, b, c] }
    }
}

/// A position as text: that of the world, `origin + p`. Far from 0 it has as many digits as give `p` again.
pub(super) fn coordinates(origin: DVec3, p: Vec3) -> String {
    if origin == DVec3::ZERO {
        return format!("{} {} {}", p.x, p.y, p.z);
    }
    let [x, y, z] = [0, 1, 2].map(|axis| coordinate(origin[axis], p[axis]));
    format!("{x} {y} {z}")
}

/// The shortest decimals of `origin + x` whose difference from `origin` is `x`.
fn coordinate(origin: f64, x: f32) -> String {
    let sum = origin + f64::from(x);
    let short = (0..12).map(|digits| format!("{sum:.digits$}")).find(|text| {
        let read: Result<f64, _> = text.parse();
        read.is_ok_and(|read| ((read - origin) as f32).to_bits() == x.to_bits())
    });
    short.unwrap_or_else(|| sum.to_string())
}

/// v upward, with all the digits needed to flip it back without loss.
pub(super) fn upward(v: f32) -> f64 {
    1.0 - f64::from(v)
}

/// Warnings about the contents that formats of meshes alone cannot hold.
pub(super) fn lost_in_text(model: &Model) -> Vec<String> {
    let mut lost = Vec::new();
    let mut add = |count: usize, what: &str| {
        if count > 0 {
            lost.push(format!("{count} {what}"));
        }
    };
    let parts = &model.parts;
    add(
        parts.iter().filter(|part| part.world_from_part != Mat4::IDENTITY).count()
            + model.lines.iter().filter(|part| part.world_from_part != Mat4::IDENTITY).count(),
        "places of parts; their vertices are moved instead",
    );
    add(parts.iter().filter(|part| part.mesh.tangents().is_some()).count(), "parts lose their tangents");
    let is_clear =
        |part: &&Part| part.mesh.colors().is_some_and(|colors| colors.iter().any(|c| (c.w - 1.0).abs() > 0.0));
    add(parts.iter().filter(is_clear).count(), "parts lose the opacity of their vertices");
    add(model.lights.len(), "lights");
    add(model.cameras.len(), "cameras");
    lost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_positions_have_the_digits_of_their_file() {
        for (origin, text) in [(400_000.0, "400000.1"), (5e6, "4999999.75"), (1e9, "1000000003"), (-5e6, "-5000000.3")]
        {
            let read: f64 = text.parse().unwrap();
            assert_eq!(coordinate(origin, (read - origin) as f32), text);
        }
        assert_eq!(coordinates(DVec3::ZERO, Vec3::new(0.1, -0.0, 1e30)), format!("{} -0 {}", 0.1, 1e30_f32));
    }
}
