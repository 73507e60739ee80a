//! Where lines are on the picture, and what of them is hidden.

use crate::quantities::{SeenPlane, Surfaces};
use bevy_ecs::entity::Entity;
use bevy_math::{DAffine3, DVec2, DVec3, IVec2, UVec2};
use bevy_platform::collections::HashMap;
use halfway_lighting::{Lens, Width};
use std::cell::RefCell;

/// Dashes and gaps, in pixels.
const DASH: [f64; 2] = [5.0, 4.0];

/// Up to here, in pixels, a mark is seen where its middle is.
const NARROW: f64 = 2.0;

/// Whether a dashed line is there at this length, in pixels.
pub(super) fn is_dash(length: f64) -> bool {
    length % (DASH[0] + DASH[1]) < DASH[0]
}

/// The largest width: beyond all pictures.
const MOST_PIXELS: f64 = 1e6;

/// The part of a line before the camera, on the picture.
pub(super) struct Placed {
    /// In pixels from the top left corner.
    pub(super) ends: [DVec2; 2],
    /// See [`Lens::unfitted_nearness`].
    pub(super) nearness: [f64; 2],
    /// Where its ends are on the whole line, from 0 to 1.
    pub(super) shares: [f64; 2],
}

/// The picture that lines are drawn over.
pub(super) struct Drawing<'a> {
    surfaces: &'a Surfaces,
    /// The numbers of the objects that pixels may show.
    numbers: HashMap<Entity, u32>,
}

impl<'a> Drawing<'a> {
    pub(super) fn new(surfaces: &'a Surfaces) -> Self {
        Self { surfaces, numbers: surfaces.entities().zip(0..).collect() }
    }

    pub(super) fn lens(&self) -> &Lens<f64> {
        self.surfaces.lens()
    }

    pub(super) fn size(&self) -> UVec2 {
        self.surfaces.size()
    }

    pub(super) fn eye_from_world(&self) -> DAffine3 {
        self.surfaces.eye_from_world()
    }

    /// The number of an object among those that pixels may show.
    pub(super) fn number_of(&self, entity: Entity) -> Option<u32> {
        self.numbers.get(&entity).copied()
    }

    /// A width in pixels at a depth, given by its [`Lens::unfitted_nearness`].
    pub(super) fn in_pixels(&self, width: Width, nearness: f64) -> f64 {
        width.in_pixels(self.pixel_size(self.lens().depth_at(nearness))).min(MOST_PIXELS)
    }

    /// The size of a pixel at a depth, in world units.
    pub(super) fn pixel_size(&self, depth: f64) -> f64 {
        self.lens().pixel_size(depth, self.size().as_dvec2().to_array())
    }

    /// The part of a line before the camera, on the picture; `None` where there is none.
    pub(super) fn placed(&self, ends: [DVec3; 2]) -> Option<Placed> {
        let [a, b] = ends.map(|end| -end.z);
        let near = self.lens().near;
        let cut = |inside: DVec3, outside: DVec3| {
            let share = (-inside.z - near) / (outside.z - inside.z);
            (inside + share * (outside - inside), share)
        };
        let (ends, shares) = match (a >= near, b >= near) {
            (true, true) => (ends, [0.0, 1.0]),
            (true, false) => {
                let (end, share) = cut(ends[0], ends[1]);
                ([ends[0], end], [0.0, share])
            }
            (false, true) => {
                let (end, share) = cut(ends[1], ends[0]);
                ([end, ends[1]], [1.0 - share, 1.0])
            }
            (false, false) => return None,
        };
        let size = self.size().as_dvec2();
        let at = ends.map(|end| {
            let [x, y, _, w] = self.lens().clip_from_eye(end.to_array());
            DVec2::new(0.5 + 0.5 * x / w, 0.5 - 0.5 * y / w) * size
        });
        let is_finite = at.iter().all(|end| end.is_finite());
        is_finite.then(|| {
            let nearness = ends.map(|end| self.lens().unfitted_nearness(-end.z));
            Placed { ends: at, nearness, shares }
        })
    }

    /// A point of eye space on the picture, with its nearness; `None` before the near plane.
    pub(super) fn placed_point(&self, eye: DVec3) -> Option<(DVec2, f64)> {
        self.placed([eye, eye]).map(|placed| (placed.ends[0], placed.nearness[0]))
    }
}

/// The view of one thread on the surfaces of a picture.
pub(super) struct Sight<'a> {
    pub(super) drawing: &'a Drawing<'a>,
    /// The pixels asked for last, each at its number modulo [`KEPT`].
    kept: RefCell<Vec<(u32, SeenPlane)>>,
    /// The farthest surfaces beside the pixels asked for last, in the same way.
    beside: RefCell<Vec<(u32, f64)>>,
}

/// The most pixels whose surfaces are kept: lines ask for the same ones again and again.
const KEPT: usize = 1 << 14;

impl<'a> Sight<'a> {
    pub(super) fn new(drawing: &'a Drawing) -> Self {
        Self {
            drawing,
            kept: RefCell::new(vec![(u32::MAX, SeenPlane::default()); KEPT]),
            beside: RefCell::new(vec![(u32::MAX, 0.0); KEPT]),
        }
    }

    /// The surface in a pixel; `None` where there is only background.
    fn seen(&self, x: u32, y: u32) -> Option<SeenPlane> {
        let surfaces = self.drawing.surfaces;
        surfaces.numbers_at(x, y)?;
        let pixel = y * surfaces.size().x + x;
        let place = pixel as usize % KEPT;
        let (kept, plane) = self.kept.borrow()[place];
        if kept == pixel {
            return Some(plane);
        }
        let plane = surfaces.plane_at(x, y)?;
        self.kept.borrow_mut()[place] = (pixel, plane);
        Some(plane)
    }

    /// Whether a mark is seen in a pixel, around a point and as far as half its width in pixels. `sees` says whether that
    /// point is seen.
    ///
    /// Near the point that decides it. Farther out, a surface behind the mark shows it, and one before it hides it, unless
    /// that is the slope on which the mark lies: its plane passes the point by no more than a quarter of the mark's width.
    pub(super) fn shows(
        &self,
        mut sees: impl FnMut() -> bool,
        (middle, half): (DVec2, f64),
        depth: f64,
        [x, y]: [u32; 2],
    ) -> bool {
        let away = (UVec2::new(x, y).as_dvec2() + 0.5 - middle).length();
        if half <= NARROW || away <= NARROW {
            return sees();
        }
        let Some(seen) = self.seen(x, y) else { return true };
        let pixel = self.drawing.pixel_size(depth);
        let is_slope = || depth - (0.25 + 0.5 * half) * pixel <= self.plane_depth(&seen, middle);
        depth - 0.25 * pixel <= seen.depth || is_slope() && sees()
    }

    /// Whether no surface lies before a point at this depth. `own` are the triangles that it belongs to, if any, and
    /// their object's [number](Drawing::number_of).
    ///
    /// It is seen where its pixel or one beside it shows a triangle that it belongs to, something that lies farther away,
    /// or nothing: at a silhouette the pixel itself may show either side. In its pixel, the plane of the surface counts.
    pub(super) fn sees(&self, at: DVec2, depth: f64, own: Option<(u32, [u32; 2])>) -> bool {
        let (size, surfaces) = (self.drawing.size(), self.drawing.surfaces);
        let UVec2 { x, y } = at.floor().as_ivec2().clamp(IVec2::ZERO, size.as_ivec2() - 1).as_uvec2();
        let shows = |numbers: Option<[u32; 2]>| match (numbers, own) {
            (None, _) => true,
            (Some([object, triangle]), Some((of, triangles))) => object == of && triangles.contains(&triangle),
            (Some(_), None) => false,
        };
        let around = |x: u32, limit: u32| x.saturating_sub(1)..=(x + 1).min(limit - 1);
        if around(y, size.y).any(|y| around(x, size.x).any(|x| shows(surfaces.numbers_at(x, y)))) {
            return true;
        }
        // Nearer by a quarter of a pixel, so that an edge is not hidden by its own surface.
        let depth = depth - 0.25 * self.drawing.pixel_size(depth);
        depth <= self.farthest_beside(x, y) || self.seen(x, y).is_none_or(|seen| depth <= self.plane_depth(&seen, at))
    }

    /// The depth of the farthest surface in the pixels beside this one, all of which show one.
    fn farthest_beside(&self, x: u32, y: u32) -> f64 {
        let size = self.drawing.size();
        let pixel = y * size.x + x;
        let place = pixel as usize % KEPT;
        let (kept, farthest) = self.beside.borrow()[place];
        if kept == pixel {
            return farthest;
        }
        let mut farthest = f64::NEG_INFINITY;
        for row in y.saturating_sub(1)..=(y + 1).min(size.y - 1) {
            for column in x.saturating_sub(1)..=(x + 1).min(size.x - 1) {
                if (column, row) != (x, y) {
                    farthest = self.seen(column, row).map_or(f64::INFINITY, |seen| farthest.max(seen.depth));
                }
            }
        }
        self.beside.borrow_mut()[place] = (pixel, farthest);
        farthest
    }

    /// The depth of a surface's plane on the ray through a point of the picture, or of the surface if that lies farther.
    fn plane_depth(&self, seen: &SeenPlane, at: DVec2) -> f64 {
        let middle = at / self.drawing.size().as_dvec2();
        let ray = self.drawing.lens().ray([2.0 * middle.x - 1.0, 1.0 - 2.0 * middle.y]);
        let [origin, direction] = [ray.origin, ray.direction].map(DVec3::from);
        let depth = seen.normal.dot(seen.point - origin) / seen.normal.dot(direction);
        if depth.is_finite() { depth.max(seen.depth) } else { seen.depth }
    }
}
