//! An object in eye space.

use std::sync::OnceLock;

use bevy_ecs::entity::Entity;
use bevy_math::{DAffine3, DMat3, DVec3, DVec4};
use halfway_lighting::equations::vector::{length, normalize};
use halfway_lighting::equations::{Coefficients, normal_matrix, transform_normal};
use halfway_lighting::{Faces, Frequency, Material, Reflectance, Terms};
use halfway_mesh::Mesh;
use halfway_texture::{FarNormals, MapKind, SolidTexture};
use rayon::prelude::*;

use super::maps::{MapSlots, MapSource, SolidMaps, prepared};
use super::mode::Mode;
use crate::surface::Traced;

pub(super) type Color = [f64; 3];

/// The components that decide how an object appearance, with defaults filled in.
#[derive(Clone, Debug)]
pub(super) struct Appearance {
    pub(super) front: Material,
    pub(super) back: Material,
    pub(super) reflectance: Reflectance,
    pub(super) faces: Faces,
    pub(super) blend: bool,
    pub(super) terms: Terms,
    /// Whether light has part in it; else it shows its base colour.
    pub(super) lit: bool,
    /// Whether vertex colours are used.
    pub(super) colored: bool,
    /// The images that its mesh shows.
    pub(super) maps: MapSlots<MapSource>,
    /// The opacity below which it is not there.
    pub(super) mask: Option<f64>,
    /// The solid texture, if it has one.
    pub(super) cut_from: Option<SolidTexture>,
}

/// On the surface itself every term that is evaluated at all is evaluated at the visible point.
fn at_the_point(frequency: Frequency) -> Frequency {
    match frequency {
        Frequency::Never => Frequency::Never,
        _ => Frequency::Fragment,
    }
}

/// Sums of terms, separated by the images that multiply them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TermSums {
    pub(super) ambient: Color,
    pub(super) diffuse: Color,
    pub(super) specular: Color,
}

/// One side of an object.
#[derive(Clone, Debug)]
pub(super) struct Side {
    pub(super) coefficients: Coefficients<f64>,
    pub(super) shown: bool,
    /// Cached shading of the vertices or of the triangles, filled on first use.
    pub(super) shaded: Vec<OnceLock<TermSums>>,
}

/// A mesh in eye space, with everything that shading it needs.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub(super) entity: Entity,
    /// The name of the entity, after the name of the one that it is a part of.
    pub(super) name: String,
    pub(super) mesh: Mesh,
    pub(super) eye_from_model: DAffine3,
    /// Model-space normals to eye space.
    normal_matrix: [[f64; 3]; 3],
    /// Whether the transform flips windings.
    pub(super) mirrored: bool,
    pub(super) corners: Vec<DVec3>,
    /// The snapped positions of the corners, if they are snapped, and whether each may snap elsewhere.
    drawn: Option<Vec<(DVec3, bool)>>,
    pub(super) normals: Vec<DVec3>,
    /// The colours of the vertices, if they are used.
    pub(super) colors: Option<Vec<DVec4>>,
    pub(super) maps: Option<SolidMaps>,
    /// The opacity below which it is not there.
    pub(super) mask: Option<f64>,
    /// The solid texture, if it has one.
    pub(super) cut_from: Option<SolidTexture>,
    /// Front and back.
    pub(super) sides: [Side; 2],
    pub(super) faces: Faces,
    pub(super) reflectance: Reflectance,
    pub(super) blend: bool,
    /// The frequencies of the lights' terms.
    pub(super) terms: Terms,
    /// Whether light has part in it; else its ambient reflectance is its base colour.
    pub(super) lit: bool,
    given: Terms,
    /// The surface that is drawn in place of the triangles.
    pub(super) smooth: Option<Smooth>,
}

/// The surface that a mesh stands for, and the way to it.
#[derive(Clone, Debug)]
pub(super) struct Smooth {
    pub(super) traced: Traced,
    pub(super) model_from_eye: DAffine3,
}

/// Transforms are kept in f32, so a determinant of unit columns this near 0 is a rounding error.
const FLAT: f64 = 8.0 * f32::EPSILON as f64;

/// The determinant of the matrix with its columns brought to unit length.
fn unit_determinant(m: &DMat3) -> f64 {
    let unit = |column: DVec3| normalize(column.to_array()).map_or(DVec3::ZERO, DVec3::from_array);
    unit(m.x_axis).cross(unit(m.y_axis)).dot(unit(m.z_axis))
}

impl Solid {
    pub(super) fn new(entity: Entity, mesh: Mesh, eye_from_model: DAffine3, appearance: &Appearance) -> Self {
        let mesh = prepared(mesh, &appearance.maps);
        let m = eye_from_model.matrix3;
        let determinant = unit_determinant(&m);
        let mirrored = determinant < -FLAT;
        let normal_matrix = signed_cofactors(&m, determinant, mirrored);
        let terms = appearance.terms;
        let colors = if appearance.colored { mesh.drawn_colors() } else { None };
        let maps = SolidMaps::new(&mesh, &appearance.maps, &eye_from_model, mirrored);
        let evaluations = match (terms.has(Frequency::Triangle), terms.has(Frequency::Vertex)) {
            (true, _) => mesh.triangle_count(),
            (false, true) => mesh.positions().len(),
            (false, false) => 0,
        };
        let side = |material: &Material, shown: bool| Side {
            coefficients: if appearance.lit { material.into() } else { Coefficients::from(material).unlit() },
            shown,
            shaded: if shown { (0..evaluations).map(|_| OnceLock::new()).collect() } else { Vec::new() },
        };
        Self {
            entity,
            name: String::new(),
            eye_from_model,
            normal_matrix,
            mirrored,
            corners: mesh.positions().par_iter().map(|p| eye_from_model.transform_point3(p.as_dvec3())).collect(),
            normals: mesh.normals().par_iter().map(|n| turned(normal_matrix, n.as_dvec3())).collect(),
            drawn: None,
            colors: colors.map(|colors| colors.iter().map(|color| color.as_dvec4()).collect()),
            maps,
            mask: appearance.mask,
            cut_from: appearance.cut_from,
            sides: [
                side(&appearance.front, appearance.faces.shows_front()),
                side(&appearance.back, appearance.faces.shows_back()),
            ],
            faces: appearance.faces,
            reflectance: appearance.reflectance,
            blend: appearance.blend,
            terms,
            lit: appearance.lit,
            given: terms,
            smooth: None,
            mesh,
        }
    }

    pub(super) fn named(self, name: String) -> Self {
        Self { name, ..self }
    }

    pub(super) fn set_mode(&mut self, mode: Mode) {
        (self.terms, self.smooth) = match mode {
            Mode::Mesh => (self.given, None),
            Mode::Surface => (self.given.map(at_the_point), self.smooth()),
        };
    }

    /// The surface that the mesh stands for. `None` if it is unknown, if the mesh has colours, images or a solid, which
    /// the surface does not have, or if the transform flattens it and has no inverse.
    fn smooth(&self) -> Option<Smooth> {
        let surface = self.mesh.surface()?;
        let is_flat = unit_determinant(&self.eye_from_model.matrix3).abs() <= FLAT;
        let is_painted = self.colors.is_some() || self.maps.is_some() || self.cut_from.is_some();
        (!is_flat && !is_painted)
            .then(|| Smooth { traced: Traced::new(surface), model_from_eye: self.eye_from_model.inverse() })
    }

    /// A unit normal in eye space; 0 if the transform flattens it.
    pub(super) fn turned(&self, n: DVec3) -> DVec3 {
        turned(self.normal_matrix, n)
    }

    /// Whether images change the exponent of highlights.
    pub(super) fn has_exponents_of_images(&self) -> bool {
        self.maps.as_ref().is_some_and(|maps| maps.has(MapKind::Shininess) || maps.far_normals() != FarNormals::Mean)
    }

    pub(super) fn side(&self, front: bool) -> &Side {
        &self.sides[usize::from(!front)]
    }

    /// The indices of a triangle's vertices.
    pub(super) fn vertices(&self, triangle: u32) -> [usize; 3] {
        let first = 3 * triangle as usize;
        [0, 1, 2].map(|corner| self.mesh.indices()[first + corner] as usize)
    }

    /// The vertex colour and opacity at a point of a triangle, by the weights of its corners; under flat shading the
    /// mean of the corners.
    pub(super) fn color(&self, place: Option<(u32, [f64; 3])>) -> DVec4 {
        let (Some(colors), Some((triangle, weights))) = (&self.colors, place) else { return DVec4::ONE };
        let [u, v, w] = if self.terms.has(Frequency::Triangle) { [1.0 / 3.0; 3] } else { weights };
        let [a, b, c] = self.vertices(triangle).map(|number| colors[number]);
        a * u + b * v + c * w
    }

    /// Snaps each corner; `place` gives its position and whether that is uncertain.
    pub(super) fn draw_at(&mut self, place: impl Fn(DVec3) -> (DVec3, bool) + Sync) {
        self.drawn = Some(self.corners.par_iter().map(|p| place(*p)).collect());
    }

    /// The positions at which a triangle's corners are drawn, in eye space.
    pub(super) fn triangle(&self, triangle: u32) -> [DVec3; 3] {
        let drawn = self.drawn.as_ref();
        self.vertices(triangle).map(|vertex| drawn.map_or(self.corners[vertex], |drawn| drawn[vertex].0))
    }

    /// Whether the snapped position of a triangle's corner is uncertain.
    pub(super) fn is_uncertain(&self, triangle: u32) -> bool {
        self.drawn.as_ref().is_some_and(|drawn| self.vertices(triangle).iter().any(|vertex| drawn[*vertex].1))
    }

    /// The positions at which a triangle's corners are lit, in eye space.
    pub(super) fn lit_triangle(&self, triangle: u32) -> [DVec3; 3] {
        self.vertices(triangle).map(|vertex| self.corners[vertex])
    }

    /// The geometric normal of a triangle's front; `None` where the triangle has no area.
    pub(super) fn face(&self, triangle: u32) -> Option<DVec3> {
        let [a, b, c] = self.vertices(triangle).map(|vertex| self.mesh.positions()[vertex].as_dvec3());
        // Differences in model space: those of eye space would hold the rounding of its distances.
        let [ab, ac, bc] = [b - a, c - a, c - b].map(|edge| self.eye_from_model.matrix3 * edge);
        let longest = [ab, ac, bc].map(|edge| length(edge.to_array())).into_iter().fold(0.0, f64::max);
        let n = ab.cross(ac).to_array();
        let turned = if self.mirrored { n.map(|x| -x) } else { n };
        (length(n) > NO_AREA * longest * longest).then(|| normalize(turned).map(DVec3::from_array))?
    }

    /// The view depth of the middle of the mesh's bounds, in the precision of the transforms: nearer ones are equal.
    pub(super) fn centre_depth(&self) -> f32 {
        -self.eye_from_model.transform_point3(self.mesh.bounds().center().as_dvec3()).z as f32
    }
}

/// A triangle whose height is this share of its longest edge has no area: far above the rounding of f64, and far below
/// what could be seen.
const NO_AREA: f64 = 1e-12;

/// The matrix of [`normal_matrix`] with its sign decided in the precision of the transforms, so that normals and
/// windings turn over together.
fn signed_cofactors(m: &DMat3, determinant: f64, mirrored: bool) -> [[f64; 3]; 3] {
    // cof(−M) = cof(M), and of M and −M one has no negative determinant: its sign is +.
    let upright = if determinant < 0.0 { -*m } else { *m };
    let cofactors = normal_matrix(upright.to_cols_array_2d());
    if mirrored { cofactors.map(|column| column.map(|x| -x)) } else { cofactors }
}

fn turned(normal_matrix: [[f64; 3]; 3], n: DVec3) -> DVec3 {
    transform_normal(normal_matrix, n.to_array()).map_or(DVec3::ZERO, DVec3::from_array)
}
