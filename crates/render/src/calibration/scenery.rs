//! The scenes that are timed, each a little different from another.

use crate::device::costs::VertexPrices;
use bevy_color::LinearRgba;
use bevy_math::{UVec2, Vec3};
use halfway_lighting::{Attenuation, Material, PointLight, Shading, Tolerance};
use halfway_mesh::{Mesh, Plane};
use std::f32::consts::TAU;

/// One object and where it is seen from: what scenes that are compared have in common.
pub(super) struct StagePlace {
    pub(super) mesh: Mesh,
    pub(super) size: UVec2,
    /// Of the camera above the surface.
    pub(super) height: f32,
}

/// How light is given back, where it is shaded, and by which lights.
#[derive(Clone)]
pub(super) struct StagedScene {
    pub(super) material: Material,
    pub(super) shading: Shading,
    pub(super) tolerance: Tolerance,
    pub(super) lights: Vec<(PointLight, Vec3)>,
    /// `None` for the adapter's own.
    pub(super) prices: Option<VertexPrices>,
}

/// Lights at which a patch is looked in [`StagedScene::looked_at`].
pub(super) const LOOKED_AT: u32 = 4;

/// Prices by which each light of each patch is looked at, and none is moved.
pub(super) const LOOK: VertexPrices =
    VertexPrices { light: 1e9, pixel: 1e12, look: 0.0, draw: 0.0, ..VertexPrices::FREE };

/// Of the ball that [`StagePlace::of_dome`] is a part of.
const DOME_RADIUS: f32 = 4.0;

pub(super) fn grey(intensity: f32) -> LinearRgba {
    LinearRgba::rgb(intensity, intensity, intensity)
}

/// A shininess that is no power of two, as most are.
pub(super) fn material() -> Material {
    Material { specular: LinearRgba::WHITE, shininess: 33.0, ..Material::matte(LinearRgba::rgb(0.55, 0.42, 0.3)) }
}

/// Lights on a circle above the surface, none of which is out of anything's reach.
fn circle(count: u32) -> Vec<(PointLight, Vec3)> {
    let at = |i: u32| {
        let (sin, cos) = (TAU * i as f32 / count as f32).sin_cos();
        Vec3::new(1.2 * cos, 2.5, 1.2 * sin)
    };
    let light = PointLight { attenuation: Attenuation::new(1.0, 0.1, 0.05), ..PointLight::from_color(grey(0.3)) };
    (0..count).map(|i| (light, at(i))).collect()
}

/// 24 lights near the surface, each of which reaches a part of it, or all.
fn grid(range: Option<f32>) -> Vec<(PointLight, Vec3)> {
    let light = PointLight { attenuation: Attenuation::NONE, range, ..PointLight::from_color(grey(0.3)) };
    let at = |i: u16| {
        let (column, row) = (f32::from(i % 6), f32::from(i / 6));
        Vec3::new(0.6 * (column - 2.5) + 0.1 * (row % 2.0), 0.3, 0.9 * (row - 1.5))
    };
    (0..24).map(|i| (light, at(i))).collect()
}

impl StagePlace {
    /// A square that fills the picture.
    pub(super) fn of_pixels(size: UVec2) -> Self {
        Self { mesh: Mesh::from(Plane { size: 4.0, divisions: 1 }), size, height: 3.4 }
    }

    /// A square of many vertices on hardly any pixels. One of 128 divisions has 512 patches.
    pub(super) fn of_vertices(divisions: u32) -> Self {
        Self { mesh: Mesh::from(Plane { size: 4.0, divisions }), size: UVec2::splat(16), height: 6.0 }
    }

    /// A part of a ball, so finely cut that it may be shaded at its vertices: 96 × 96 cells of half a degree. Or so
    /// rough that little may.
    pub(super) fn of_dome(size: UVec2, is_rough: bool) -> Self {
        let flat = Mesh::from(Plane { size: 4.0, divisions: 96 });
        // Two of three vertices are lower, by two fifths of a cell.
        let raised = |number: usize| if is_rough && number.is_multiple_of(3) { 1.004 } else { 1.0 };
        let curved = |(number, &Vec3 { x, z, .. }): (usize, &Vec3)| {
            DOME_RADIUS * (raised(number) * Vec3::new(x, DOME_RADIUS, z).normalize() - Vec3::Y)
        };
        let positions = flat.positions().iter().enumerate().map(curved).collect();
        let mesh = Mesh::new(positions, flat.indices().to_vec()).unwrap_or(flat);
        Self { mesh, size, height: 3.4 }
    }
}

impl StagedScene {
    pub(super) fn under(shading: Shading, material: Material, lights: u32) -> Self {
        Self { material, shading, tolerance: Tolerance::EXACT, lights: circle(lights), prices: None }
    }

    /// Under automatic shading within one step.
    pub(super) fn by(prices: VertexPrices, lights: u32) -> Self {
        let tolerance = Tolerance::steps(1.0);
        Self { tolerance, prices: Some(prices), ..Self::under(Shading::Auto, material(), lights) }
    }

    /// Of which nothing is drawn otherwise for what is found of its lights: highlights are so wide that none is left
    /// out of any patch.
    pub(super) fn looked_at(prices: VertexPrices) -> Self {
        Self { material: Material { shininess: 2.0, ..material() }, ..Self::by(prices, LOOKED_AT) }
    }

    /// Lights of which each patch has others, or all.
    pub(super) fn in_reach(range: Option<f32>) -> Self {
        Self { lights: grid(range), ..Self::under(Shading::Phong, material(), 0) }
    }
}
