//! Ambient occlusion, baked into an image over a mesh by rays.

mod dilated;
mod places;

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;
use thiserror::Error;

use self::dilated::dilated;
use self::places::{TexelPlaces, UvPlace};
use crate::triangle_tree::{Ray, TriangleTree};
use crate::{Mesh, face_normal};

/// Settings for baking ambient occlusion with [`Mesh::baked_occlusion`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionBake {
    /// Columns and rows of the image, 1 to [`MOST_SIDE`](Self::MOST_SIDE) each. Default 256 × 256.
    pub size: [u32; 2],
    /// Rays a texel, 1 to [`MOST_RAYS`](Self::MOST_RAYS). Default 256.
    pub rays: u32,
    /// Surfaces farther away do not occlude; positive, in units of the mesh. Default: infinite.
    pub reach: f32,
    /// The set of texture coordinates that lie on the image: 0 or 1. Default 0.
    pub uv_set: usize,
}

impl OcclusionBake {
    /// The most columns and rows.
    pub const MOST_SIDE: u32 = 8192;
    /// The most rays a texel.
    pub const MOST_RAYS: u32 = 1 << 16;

    fn validate(&self) -> Result<(), OcclusionError> {
        let [width, height] = self.size;
        if self.size.iter().any(|side| !(1..=Self::MOST_SIDE).contains(side)) {
            return Err(OcclusionError::Size { width, height });
        }
        if !(1..=Self::MOST_RAYS).contains(&self.rays) {
            return Err(OcclusionError::Rays { found: self.rays });
        }
        if self.reach.is_nan() || self.reach <= 0.0 {
            return Err(OcclusionError::Reach { found: self.reach });
        }
        Ok(())
    }
}

impl Default for OcclusionBake {
    fn default() -> Self {
        Self { size: [256; 2], rays: 256, reach: f32::INFINITY, uv_set: 0 }
    }
}

/// Why ambient occlusion was not baked.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum OcclusionError {
    /// The image is empty or too large.
    #[error("an image of {width} × {height} texels; 1 to {} along each side are expected", OcclusionBake::MOST_SIDE)]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// No rays, or too many.
    #[error("{found} rays a texel; 1 to {} are expected", OcclusionBake::MOST_RAYS)]
    Rays {
        /// The number that was given.
        found: u32,
    },
    /// The reach is not a positive length.
    #[error("a reach of {found}; a positive length is expected")]
    Reach {
        /// The reach that was given.
        found: f32,
    },
    /// The mesh has no such texture coordinates.
    #[error("the mesh has no texture coordinates number {set}, by which it lies on the image")]
    NoUvs {
        /// The number of the set.
        set: usize,
    },
    /// No texel's centre is on the mesh.
    #[error("no centre of a texel lies on the mesh; texture coordinates from 0 to 1 are expected")]
    NothingOnImage,
    /// The caller's progress function asked to stop.
    #[error("stopped")]
    Stopped,
}

/// The share of the light from all directions that arrives at each texel: 1 if unoccluded, 0 if fully occluded.
#[derive(Clone, Debug, PartialEq)]
pub struct OcclusionImage {
    size: [u32; 2],
    shares: Vec<f32>,
    baked: usize,
}

impl OcclusionImage {
    /// Columns and rows.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The shares, row by row from the top: (u, v) = (0, 0) is the top left corner of the first.
    pub fn shares(&self) -> &[f32] {
        &self.shares
    }

    /// How many texels have their centre on the mesh. The others continue their neighbours.
    pub fn baked(&self) -> usize {
        self.baked
    }
}

impl Mesh {
    /// The ambient occlusion of the mesh by itself and by `occluders`, which stand in the same space, in an image over
    /// its texture coordinates, ready for `MapKind::Occlusion`.
    ///
    /// At the point of each texel's centre it is A = 1/π·∫V(ω)·(n·ω)dω over the hemisphere around the interpolated
    /// normal n (Zhukov, Iones and Kronin 1998, "An ambient light illumination model", with a distance beyond which all
    /// is open), V being 0 where a triangle of either side is hit within the reach. The density of the rays is the
    /// cosine, so that A is the share of rays that hit nothing: the points of a Fibonacci spiral over the unit disc,
    /// raised onto the hemisphere (Nusselt's analogy), turned from texel to texel by Roberts' sequence R2. So the same
    /// call gives the same image.
    ///
    /// Rays of curved surfaces start on the rounded surface of their normals (Hanika 2021, "Hacking the shadow
    /// terminator"), so that a convex mesh does not occlude itself. Where triangles overlap on the image the first one
    /// counts; triangles beyond the image are not baked. Texels on no triangle continue the mean of their neighbours,
    /// ring by ring, so that filters find no foreign values beside a seam.
    ///
    /// `progress` is called with the number of finished rows and of all rows, from any thread, and may stop the work.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use halfway_mesh::{Mesh, OcclusionBake, Plane, UvSphere};
    ///
    /// let floor = Mesh::from(Plane { size: 4.0, divisions: 1 });
    /// let ball = Mesh::from(UvSphere::new(1.0, 16, 8));
    /// let bake = OcclusionBake { size: [9, 9], rays: 64, ..OcclusionBake::default() };
    /// let image = floor.baked_occlusion(&[&ball], &bake, &|_, _| ControlFlow::Continue(()))?;
    /// // Darker under the ball, in the middle, than in a corner.
    /// assert!(image.shares()[40] < image.shares()[0]);
    /// # Ok::<(), halfway_mesh::OcclusionError>(())
    /// ```
    ///
    /// # Errors
    /// Numbers out of their range, no such texture coordinates, nothing on the image, or [`OcclusionError::Stopped`].
    pub fn baked_occlusion(
        &self,
        occluders: &[&Self],
        bake: &OcclusionBake,
        progress: &(dyn Fn(u32, u32) -> ControlFlow<()> + Sync),
    ) -> Result<OcclusionImage, OcclusionError> {
        bake.validate()?;
        let uvs = self.uv_set(bake.uv_set).ok_or(OcclusionError::NoUvs { set: bake.uv_set })?;
        let places = TexelPlaces::new(self, uvs, bake.size);
        let all = || std::iter::once(self).chain(occluders.iter().copied());
        let triangles: Vec<[Vec3; 3]> = all().flat_map(Self::triangle_corners).collect();
        let tree = TriangleTree::new(triangles.len() as u32, |number| triangles[number as usize]);
        let is_open = |ray: &Ray| !tree.any_along(ray, |number| meets(ray, triangles[number as usize]));
        let largest = all().map(|mesh| mesh.bounds().min.abs().max(mesh.bounds().max.abs()).max_element());
        let clearance = CLEARANCE * f64::from(largest.fold(0.0, f32::max));
        let [width, height] = bake.size;
        let done = AtomicU32::new(0);
        let row = |y: u32| {
            let share = |x: u32| {
                let place = places.at(self, uvs, [x, y])?;
                Some(self.openness(&place, bake, [x, y], clearance, is_open) as f32)
            };
            let row: Vec<Option<f32>> = (0..width).map(share).collect();
            match progress(done.fetch_add(1, Ordering::Relaxed) + 1, height) {
                ControlFlow::Continue(()) => Ok(row),
                ControlFlow::Break(()) => Err(OcclusionError::Stopped),
            }
        };
        let rows = (0..height).into_par_iter().map(row).collect::<Result<Vec<_>, _>>()?;
        let shares: Vec<Option<f32>> = rows.into_iter().flatten().collect();
        let baked = shares.iter().flatten().count();
        if baked == 0 {
            return Err(OcclusionError::NothingOnImage);
        }
        Ok(OcclusionImage { size: bake.size, shares: dilated(shares, width as usize), baked })
    }

    /// A at a point, by rays that start at a distance of `clearance` above its triangle.
    fn openness(
        &self,
        place: &UvPlace,
        bake: &OcclusionBake,
        texel: [u32; 2],
        clearance: f64,
        is_open: impl Fn(&Ray) -> bool,
    ) -> f64 {
        let vertices = self.indices().as_chunks::<3>().0[place.triangle as usize].map(|vertex| vertex as usize);
        let corners = vertices.map(|vertex| self.positions()[vertex].as_dvec3());
        let normals = vertices.map(|vertex| self.normals()[vertex].as_dvec3());
        let mixed = |[a, b, c]: [DVec3; 3]| a * place.weights[0] + b * place.weights[1] + c * place.weights[2];
        let p = mixed(corners);
        // p projected onto the plane through each corner along its normal, if that is above p.
        let raised = std::array::from_fn(|i| normals[i] * -(p - corners[i]).dot(normals[i]).min(0.0));
        let [a, b, c] = vertices.map(|vertex| self.positions()[vertex]);
        let face = face_normal(a, b, c).map_or(DVec3::ZERO, Vec3::as_dvec3);
        let n = mixed(normals).try_normalize().unwrap_or(face);
        // Normals may be opposite to the winding; rays start on the side of the normals.
        let face = if face.dot(n) < 0.0 { -face } else { face };
        let origin = p + mixed(raised) + face * clearance;
        let axes = axes_about(n);
        let turn = f64::from(texel[0]) * R2[0] + f64::from(texel[1]) * R2[1];
        let ray = |number: u32| {
            let direction = axes * cosine_weighted(number, bake.rays, turn);
            Ray { origin, direction, reach: bake.reach.into() }
        };
        let open = (0..bake.rays).filter(|&number| is_open(&ray(number))).count();
        open as f64 / f64::from(bake.rays)
    }
}

/// The distance of ray origins above a triangle, relative to the largest coordinate, so that no rounding lets them hit
/// it: some roundings of `f32` positions.
const CLEARANCE: f64 = 1.0 / (1 << 20) as f64;

/// Whether a ray hits a triangle, from either side (Möller and Trumbore 1997, "Fast, minimum storage ray/triangle
/// intersection").
fn meets(ray: &Ray, corners: [Vec3; 3]) -> bool {
    let [corner, b, c] = corners.map(Vec3::as_dvec3);
    let (b, c) = (b - corner, c - corner);
    let normal = ray.direction.cross(c);
    let determinant = b.dot(normal);
    if determinant == 0.0 {
        return false;
    }
    let from = ray.origin - corner;
    let u = from.dot(normal) / determinant;
    let across = from.cross(b);
    let v = ray.direction.dot(across) / determinant;
    let t = c.dot(across) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t <= ray.reach
}

/// The fractions of the sequence R2 (Roberts 2018): 1/g and 1/g², g³ = g + 1.
const R2: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];
/// The golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Ray number `ray` of `rays`, distributed over the hemisphere around +Z by the cosine; all turned by `turn`.
fn cosine_weighted(ray: u32, rays: u32, turn: f64) -> DVec3 {
    let squared = (f64::from(ray) + 0.5) / f64::from(rays);
    let angle = TAU * (f64::from(ray) * GOLDEN + turn).fract();
    let (sine, cosine) = angle.sin_cos();
    let radius = squared.sqrt();
    DVec3::new(radius * cosine, radius * sine, (1.0 - squared).sqrt())
}

/// Unit axes of which the last is `n` (Duff et al. 2017, "Building an orthonormal basis, revisited").
fn axes_about(n: DVec3) -> DMat3 {
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    let x = DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    DMat3::from_cols(x, DVec3::new(b, sign + n.y * n.y * a, -n.y), n)
}
