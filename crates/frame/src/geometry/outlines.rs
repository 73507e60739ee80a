//! Outlines: what tells whether a piece of a mesh shows, apart from all else that is known of it. In each frame those
//! of all patches are looked at, and of most patches nothing else.

use crate::geometry::shape::{ANGLE_SLACK, PatchShape, larger, radius_of, smaller, sphere_around};
use crate::view::camera::View;
use crate::view::matrices::ModelView;
use bevy_math::Vec3;
use halfway_lighting::equations::vector::length;
use halfway_lighting::{Faces, Lens};
use halfway_mesh::Mesh;

/// The bounding sphere of a part of a mesh and the directions it faces, in model space; fits in a cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outline {
    center: Vec3,
    radius: f32,
    facing: Facing,
}

/// The directions that triangles face: the viewpoints from which none of them shows its front, or none its back.
///
/// A triangle shows its front to the eye at e where n·(e − p) > 0, n its normal and p any of its points. With c the
/// centre of the patch and v = e − c, that is n·v + n·(c − p). The largest n·v of all triangles is a convex function of
/// v, twice as large for twice the v; so where v = Σ wᵢ dᵢ with no wᵢ below 0, it is at most Σ wᵢ times its value for
/// dᵢ. It is known for 18 directions d, the corners and the middles of edges of an octahedron, of which the three
/// around v serve. A cone around the normals is wider: it is as round as their farthest one is far.
///
/// Bounds for a direction are rounded up to a 20,000th.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Facing {
    /// The largest n·d of all triangles, in [`Facing::PARTS`], for ±x, ±y, ±z, then ±x ± y, ±x ± z, ±y ± z: numbered by
    /// the signs of their coordinates, 1 where they are negative.
    most: [i16; 18],
    /// The largest n·(c − p) of all, and the largest −n·(c − p).
    beyond: [f32; 2],
}

impl Facing {
    /// Numbered by the signs of their coordinates, 1 where they are negative: ±x, ±y, ±z; then ±x ± y, ±x ± z, ±y ± z.
    #[cfg(test)]
    const DIRECTIONS: [Vec3; 18] = {
        const fn d(x: i32, y: i32, z: i32) -> Vec3 {
            Vec3::new(x as f32, y as f32, z as f32)
        }
        [
            d(1, 0, 0),
            d(-1, 0, 0),
            d(0, 1, 0),
            d(0, -1, 0),
            d(0, 0, 1),
            d(0, 0, -1),
            d(1, 1, 0),
            d(1, -1, 0),
            d(-1, 1, 0),
            d(-1, -1, 0),
            d(1, 0, 1),
            d(1, 0, -1),
            d(-1, 0, 1),
            d(-1, 0, -1),
            d(0, 1, 1),
            d(0, 1, -1),
            d(0, -1, 1),
            d(0, -1, -1),
        ]
    };

    /// The unit of what is known for a direction: the largest there can be is √2.
    const PARTS: f32 = 20_000.0;

    /// Of triangles that may face anywhere.
    const UNKNOWN: Self = Self { most: [i16::MAX; 18], beyond: [f32::INFINITY; 2] };

    /// Of no triangle.
    const NONE: Self = Self { most: [i16::MIN; 18], beyond: [f32::NEG_INFINITY; 2] };

    /// Of triangles with these normals, whose corners are so far from the centre of the patch.
    pub(super) fn new(triangles: impl Iterator<Item = (Vec3, [Vec3; 3])>) -> Self {
        // For one of two opposite directions each: n·d is the least for the other.
        let mut most = [f32::NEG_INFINITY; 9];
        let mut least = [f32::INFINITY; 9];
        let mut beyond = [f32::NEG_INFINITY; 2];
        for (n, offsets) in triangles {
            let Vec3 { x, y, z } = n;
            let along = [x, y, z, x + y, x - y, x + z, x - z, y + z, y - z];
            most = std::array::from_fn(|i| larger(most[i], along[i]));
            least = std::array::from_fn(|i| smaller(least[i], along[i]));
            for height in offsets.map(|offset| n.dot(offset)) {
                beyond = [larger(beyond[0], -height), larger(beyond[1], height)];
            }
        }
        // By the numbers of the directions.
        let [x, y, z, x_y, x_ny, x_z, x_nz, y_z, y_nz] = std::array::from_fn(|i| [most[i], -least[i]]);
        let most = [
            x[0], x[1], y[0], y[1], z[0], z[1], //
            x_y[0], x_ny[0], x_ny[1], x_y[1], //
            x_z[0], x_nz[0], x_nz[1], x_z[1], //
            y_z[0], y_nz[0], y_nz[1], y_z[1],
        ];
        Self { most: most.map(|most| (Self::PARTS * most).ceil() as i16), beyond }
    }

    /// Of all of these, around centres that are so far from the centre of all.
    fn around<'a>(parts: impl Iterator<Item = (&'a Self, f32)>) -> Self {
        let mut facing = Self::NONE;
        for (part, away) in parts {
            facing.most = std::array::from_fn(|i| facing.most[i].max(part.most[i]));
            facing.beyond = std::array::from_fn(|i| facing.beyond[i].max(part.beyond[i] + away));
        }
        facing
    }

    /// Whether no triangle turns its front, or its `back`, to an eye that is so far from the centre of the patch; where
    /// `w` is 0, to one that is infinitely far away in that direction.
    fn hides(&self, (eye, w): (Vec3, f32), back: bool) -> bool {
        let v = if back { -eye } else { eye };
        let [x, y, z] = v.to_array().map(|at| usize::from(at < 0.0));
        let Vec3 { x: a, y: b, z: c } = v.abs();
        let [of_x, of_y, of_z] = [x, 2 + y, 4 + z].map(|i| f32::from(self.most[i]));
        let [of_xy, of_xz, of_yz] = [6 + 2 * x + y, 10 + 2 * x + z, 14 + 2 * y + z].map(|i| f32::from(self.most[i]));
        let most = if a >= b + c {
            (a - b - c) * of_x + b * of_xy + c * of_xz
        } else if b >= a + c {
            (b - a - c) * of_y + a * of_xy + c * of_yz
        } else if c >= a + b {
            (c - a - b) * of_z + a * of_xz + b * of_yz
        } else {
            0.5 * ((a + b - c) * of_xy + (a + c - b) * of_xz + (b + c - a) * of_yz)
        };
        // Where nothing is known this is infinite, or no number, and hides nothing.
        most / Self::PARTS + w * self.beyond[usize::from(back)] < -ANGLE_SLACK * (a + b + c)
    }
}

/// From where, and which sides of an object are seen: what tells whether a patch of it shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight<'a> {
    pub(super) model_view: &'a ModelView,
    pub(super) view: &'a View,
    /// Where the eye is, and whether back faces are drawn rather than front faces; `None` where both are or the
    /// transform has no inverse.
    pub(super) eye: Option<(ModelEye, bool)>,
    /// None of it is beside the picture.
    is_inside: bool,
}

/// The eye in model space, by homogeneous coordinates: a point, or a direction toward an eye that is infinitely far
/// away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ModelEye {
    xyz: Vec3,
    /// 1 for a point, 0 for a direction.
    w: f32,
}

impl ModelEye {
    fn new(lens: &Lens, model_view: &ModelView) -> Self {
        // In single precision the determinant leaves the number range where a scale is 7·10¹² or 10⁻¹³.
        let model_from_eye = model_view.eye_from_model.as_daffine3().inverse();
        let [x, y, z, w] = lens.eye_position();
        let xyz = model_from_eye.matrix3 * Vec3::new(x, y, z).as_dvec3() + f64::from(w) * model_from_eye.translation;
        Self { xyz: xyz.as_vec3(), w }
    }

    /// The vector from a point of model space to the eye.
    fn vector_from(&self, p: Vec3) -> (Vec3, f32) {
        (self.xyz - self.w * p, self.w)
    }
}

impl<'a> Sight<'a> {
    /// Of an object; `whole` is all of it.
    pub(crate) fn new(model_view: &'a ModelView, view: &'a View, faces: Faces, whole: &Outline) -> Self {
        let side = match faces {
            Faces::Both => None,
            Faces::Front => Some(false),
            Faces::Back => Some(true),
        };
        let eye = ModelEye::new(&view.lens, model_view);
        let eye = side.filter(|_| eye.xyz.is_finite()).map(|back| (eye, back));
        let (center, radius) = whole.sphere(model_view);
        Self { model_view, view, eye, is_inside: view.lens.holds(center.to_array(), radius) }
    }

    /// An upper bound of how many pixels a way of a unit of the mesh takes, anywhere in a sphere of the mesh where the
    /// picture shows it; no less for a sphere that holds another.
    pub(super) fn pixels_per_unit(&self, (center, radius): (Vec3, f32)) -> f32 {
        let scale = self.model_view.largest_scale();
        let center = self.model_view.eye_from_model.transform_point3(center);
        let step = self.view.pixels_at_unit_w * scale;
        self.view.lens.largest_step(step, (center.to_array(), radius * scale))
    }
}

impl Outline {
    /// Of a patch whose triangles face like that.
    pub(super) fn new(shape: &PatchShape, facing: Facing) -> Self {
        Self { center: shape.center, radius: shape.radius(), facing }
    }

    /// All of a mesh, of whose normals nothing is known.
    pub(crate) fn whole(mesh: &Mesh) -> Self {
        let center = mesh.bounds().center();
        let radius = radius_of(mesh.positions().iter().map(|p| *p - center));
        Self { center, radius, facing: Facing::UNKNOWN }
    }

    /// Of all of these together, one or more.
    pub(super) fn around(parts: &[Self]) -> Self {
        let (center, radius) = sphere_around(parts.iter().map(|part| (part.center, part.radius)));
        let facing = Facing::around(parts.iter().map(|part| (&part.facing, length((part.center - center).to_array()))));
        Self { center, radius, facing }
    }

    /// A patch with this sphere around it, of whose normals nothing is known.
    pub(super) fn shape(&self) -> PatchShape {
        PatchShape { center: self.center, radius: self.radius, faces: None, normals: None }
    }

    /// The radius of the sphere around it, in the mesh's units.
    pub(super) fn radius(&self) -> f32 {
        self.radius
    }

    /// The sphere around it in eye space.
    pub(crate) fn sphere(&self, model_view: &ModelView) -> (Vec3, f32) {
        (model_view.eye_from_model.transform_point3(self.center), self.radius * model_view.largest_scale())
    }

    /// Whether any of it may show: it reaches into the frustum, and not all its triangles turn the side away that is
    /// drawn. Never false for one that shows.
    pub(crate) fn is_seen(&self, sight: &Sight) -> bool {
        // The first leaves out about half, and takes no longer.
        let faces = sight.eye.is_none_or(|(eye, back)| !self.facing.hides(eye.vector_from(self.center), back));
        faces
            && (sight.is_inside || {
                let (center, radius) = self.sphere(sight.model_view);
                sight.view.lens.sees(center.to_array(), radius)
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_is_a_line_of_a_cache() {
        assert!(size_of::<Outline>() <= 64, "{}", size_of::<Outline>());
    }

    #[test]
    fn directions_have_their_numbers() {
        let n = Vec3::new(0.3, -0.5, 0.8).normalize();
        let facing = Facing::new(std::iter::once((n, [Vec3::ZERO; 3])));
        assert_eq!(facing.most, Facing::DIRECTIONS.map(|d| (Facing::PARTS * n.dot(d)).ceil() as i16));
    }

    /// Rounded bounds are never less, and nothing hides what may face anywhere.
    #[test]
    fn patches_that_face_the_eye_are_not_hidden() {
        let mut seed = 3_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        let (mut hidden, mut turned) = (0, 0);
        for _ in 0..10_000 {
            let [n, eye] = [(); 2].map(|()| Vec3::new(random(), random(), random()).normalize_or(Vec3::X));
            let facing = Facing::new(std::iter::once((n, [Vec3::ZERO; 3])));
            let hides = [facing.hides((eye, 1.0), false), facing.hides((eye, 1.0), true)];
            let shows = n.dot(eye);
            assert!(!(hides[0] && shows > 0.0 || hides[1] && shows < 0.0), "{n} from {eye}");
            for w in [0.0, 1.0] {
                assert!(!Facing::UNKNOWN.hides((eye, w), false) && !Facing::UNKNOWN.hides((eye, w), true));
                assert!([false, true].into_iter().all(|back| facing.hides((eye, w), back) == hides[usize::from(back)]));
            }
            turned += usize::from(shows < 0.0);
            hidden += usize::from(hides[0]);
        }
        assert!(4 * hidden > 3 * turned, "{hidden} of {turned}");
    }
}
