//! Bézier patches, subdivided until Newton's iteration is sure to find the single hit.

use bevy_math::{DVec2, DVec3};
use halfway_mesh::{BezierPatch, Parameter};

use super::net::{Net, spans};
use super::ray::{Ray, SurfaceHit, extent};

/// A patch is cut until its pieces are no longer than this fraction of the whole surface …
const PIECE: f64 = 1.0 / 24.0;

/// … or until an edge is cut into 2 to this power.
const MOST_CUTS: u32 = 6;

/// The fraction of a piece's size within which a ray hits a point: far above the rounding of f64.
const SLACK: f64 = 1e-12;

/// The fraction of a piece's size below which a cell is a point.
const POINT: f64 = 1e-10;

/// How far outside a cell, in the patch's parameters, a hit still belongs to it.
const MARGIN: f64 = 1e-10;

/// Only a ray that lies in the surface needs this many cells of a piece.
const MOST_CELLS: usize = 10_000;

/// Patches in pieces.
#[derive(Clone, Debug)]
pub(super) struct Patches {
    patches: Vec<BezierPatch>,
    pieces: Vec<Piece>,
}

/// A part of a patch.
#[derive(Clone, Debug)]
struct Piece {
    patch: usize,
    net: Net<DVec3>,
    domain: Domain,
    center: DVec3,
    /// Its longest extent.
    size: f64,
    /// The distance from a ray at which a point is still on it.
    slack: f64,
}

/// A range of u and of v.
#[derive(Clone, Copy, Debug)]
struct Domain {
    min: DVec2,
    max: DVec2,
}

impl Domain {
    const WHOLE: Self = Self { min: DVec2::ZERO, max: DVec2::ONE };

    /// The halves along an axis: u is 0, v is 1.
    fn halves(self, axis: usize) -> [Self; 2] {
        let middle = 0.5 * (self.min[axis] + self.max[axis]);
        let (mut first, mut second) = (self, self);
        first.max[axis] = middle;
        second.min[axis] = middle;
        [first, second]
    }

    fn holds(self, uv: DVec2, margin: DVec2) -> bool {
        uv.cmpge(self.min - margin).all() && uv.cmple(self.max + margin).all()
    }
}

impl Patches {
    pub(super) fn new(patches: Vec<BezierPatch>) -> Self {
        let longest = PIECE * extent(patches.iter().flat_map(BezierPatch::points).copied());
        let mut pieces = Vec::new();
        for (patch, whole) in patches.iter().enumerate() {
            let net = Net { columns: whole.columns(), points: whole.points().to_vec() };
            let mut rest = vec![(net, Domain::WHOLE, [0, 0])];
            while let Some((net, domain, cuts)) = rest.pop() {
                let mut lengths = spans(&net, DVec3::distance);
                for axis in 0..2 {
                    if cuts[axis] == MOST_CUTS {
                        lengths[axis] = 0.0;
                    }
                }
                let axis = usize::from(lengths[1] > lengths[0]);
                if lengths[axis] <= longest {
                    pieces.push(Piece::new(patch, net, domain));
                    continue;
                }
                let mut cuts = cuts;
                cuts[axis] += 1;
                for (net, domain) in net.split(axis).into_iter().zip(domain.halves(axis)) {
                    rest.push((net, domain, cuts));
                }
            }
        }
        Self { patches, pieces }
    }

    pub(super) fn len(&self) -> usize {
        self.pieces.len()
    }

    pub(super) fn hull(&self, piece: usize) -> &[DVec3] {
        &self.pieces[piece].net.points
    }

    /// The points of all hulls.
    pub(super) fn hulls(&self) -> impl Iterator<Item = &DVec3> + Clone {
        self.pieces.iter().flat_map(|piece| &piece.net.points)
    }

    pub(super) fn meet(&self, piece: usize, ray: &Ray, hits: &mut Vec<SurfaceHit>) {
        let piece = &self.pieces[piece];
        let patch = &self.patches[piece.patch];
        let (beside, t_beside) = ray.beside(piece.center);
        let plane = RayPlane::along(&beside);
        if plane.misses(piece) {
            return;
        }
        plane.meet(patch, piece, |uv, position| {
            let t = t_beside + (position - beside.origin).dot(ray.direction) / ray.direction.length_squared();
            if t > 0.0 {
                let [u, v] = uv.clamp(DVec2::ZERO, DVec2::ONE).to_array().map(Parameter::from);
                let normal = patch.normal(u, v).unwrap_or_else(|| -ray.direction.normalize());
                hits.push(SurfaceHit { t, position, normal });
            }
        });
    }
}

impl Piece {
    fn new(patch: usize, net: Net<DVec3>, domain: Domain) -> Self {
        let points = || net.points.iter().copied();
        let center = points().sum::<DVec3>() / net.points.len() as f64;
        let size = extent(points());
        let furthest = points().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        // Points far from the origin are rounded more coarsely than the piece's own size.
        let slack = SLACK * size + 16.0 * f64::EPSILON * furthest;
        Self { patch, net, domain, center, size, slack }
    }
}

/// The plane perpendicular to a ray, in which the ray is the point (0, 0).
struct RayPlane {
    origin: DVec3,
    axes: [DVec3; 2],
}

/// A part of a piece as projected along the ray.
struct Cell {
    net: Net<DVec2>,
    domain: Domain,
}

/// The relation of a cell to the ray.
enum CellCase {
    /// The ray misses it, or only touches it.
    Miss,
    /// No two of its points coincide in projection: the ray hits it once at most.
    Single,
    /// Its projection is a point, with one side only, at this corner.
    Point(DVec2),
    /// Undecided.
    Open,
}

impl RayPlane {
    fn along(ray: &Ray) -> Self {
        let (x, y) = ray.direction.normalize().any_orthonormal_pair();
        Self { origin: ray.origin, axes: [x, y] }
    }

    fn project(&self, p: DVec3) -> DVec2 {
        self.project_vector(p - self.origin)
    }

    fn project_vector(&self, d: DVec3) -> DVec2 {
        DVec2::new(d.dot(self.axes[0]), d.dot(self.axes[1]))
    }

    /// Whether the box around the piece's hull excludes the ray.
    fn misses(&self, piece: &Piece) -> bool {
        let (min, max) = bounds(piece.net.points.iter().map(|&p| self.project(p)));
        min.max_element() > piece.slack || max.min_element() < -piece.slack
    }

    /// Calls `found` with the parameters and the position of each point of the piece on the ray.
    fn meet(&self, patch: &BezierPatch, piece: &Piece, mut found: impl FnMut(DVec2, DVec3)) {
        let mut cells = vec![Cell { net: piece.net.mapped(|p| self.project(p)), domain: piece.domain }];
        for _ in 0..MOST_CELLS {
            let Some(cell) = cells.pop() else { return };
            match cell.verdict(piece) {
                CellCase::Miss => continue,
                CellCase::Point(uv) => {
                    found(uv, patch.position(uv.x.into(), uv.y.into()));
                    continue;
                }
                CellCase::Single => {
                    let place = self.iterate(patch, cell.domain, piece.slack);
                    if let Some((uv, p)) = place.filter(|(uv, _)| cell.domain.holds(*uv, DVec2::splat(MARGIN))) {
                        found(uv, p);
                        continue;
                    }
                }
                CellCase::Open => {}
            }
            cells.extend(cell.halves());
        }
    }

    /// Newton's iteration from the middle of the domain; `None` if it leaves it by more than its width.
    fn iterate(&self, patch: &BezierPatch, domain: Domain, slack: f64) -> Option<(DVec2, DVec3)> {
        let mut uv = 0.5 * (domain.min + domain.max);
        for _ in 0..12 {
            let [p, pu, pv] = patch.jet(uv.x.into(), uv.y.into());
            let (f, fu, fv) = (self.project(p), self.project_vector(pu), self.project_vector(pv));
            let step = DVec2::new(fv.perp_dot(f), f.perp_dot(fu)) / fu.perp_dot(fv);
            uv += step;
            // Not finite if the determinant is 0: then it is not held either.
            if !domain.holds(uv, domain.max - domain.min + DVec2::splat(MARGIN)) {
                return None;
            }
            if f.length() <= slack {
                return Some((uv, p + step.x * pu + step.y * pv));
            }
        }
        None
    }
}

impl Cell {
    fn halves(&self) -> [Self; 2] {
        let [down, across] = spans(&self.net, DVec2::distance);
        let axis = usize::from(across > down);
        let [first, second] = self.net.split(axis);
        let [first_domain, second_domain] = self.domain.halves(axis);
        [Self { net: first, domain: first_domain }, Self { net: second, domain: second_domain }]
    }

    fn verdict(&self, piece: &Piece) -> CellCase {
        // The box is aligned with the longest extent of the projected cell, so that one seen edge-on is thin.
        let [a, b, c, d] = self.net.corners();
        let (down, across) = (c + d - a - b, b + d - a - c);
        let longest = if down.length_squared() > across.length_squared() { down } else { across };
        let axis = longest.try_normalize().unwrap_or(DVec2::X);
        let turned = |p: DVec2| DVec2::new(axis.dot(p), axis.perp_dot(p));
        let (min, max) = bounds(self.net.points.iter().map(|&p| turned(p)));
        if min.max_element() > piece.slack || max.min_element() < -piece.slack {
            return CellCase::Miss;
        }
        let (least, most) = self.facing();
        if least > 0.0 || most < 0.0 {
            return CellCase::Single;
        }
        let size = max - min;
        if size.max_element() <= POINT * piece.size {
            // Rounding may flip the smallest facets.
            let one_sided = least.abs().min(most.abs()) <= 1e-3 * least.abs().max(most.abs()) && least < most;
            return if one_sided { CellCase::Point(self.nearest_corner()) } else { CellCase::Miss };
        }
        if size.y <= piece.slack { CellCase::Miss } else { CellCase::Open }
    }

    /// The least and the greatest of the cross products of a step between rows and a step between columns.
    ///
    /// The difference of two points of the cell is Δu·a + Δv·b with a and b means of such steps. If all the products
    /// have one sign, a × b has it too, so that the difference is not 0: no two points coincide in projection.
    fn facing(&self) -> (f64, f64) {
        let (points, columns) = (&self.net.points, self.net.columns);
        let downs = || (columns..points.len()).map(|i| points[i] - points[i - columns]);
        let across = || (0..points.len()).filter(|i| i % columns > 0).map(|i| points[i] - points[i - 1]);
        downs().fold((f64::INFINITY, f64::NEG_INFINITY), |range, down| {
            across().fold(range, |(least, most), across| {
                let product = down.perp_dot(across);
                (least.min(product), most.max(product))
            })
        })
    }

    /// The parameters of the corner next to the ray.
    fn nearest_corner(&self) -> DVec2 {
        let Domain { min, max } = self.domain;
        let corners = [min, DVec2::new(min.x, max.y), DVec2::new(max.x, min.y), max];
        let seen = self.net.corners().into_iter().map(DVec2::length_squared);
        let nearest = corners.into_iter().zip(seen).min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.expect("there are four").0
    }
}

fn bounds(points: impl Iterator<Item = DVec2>) -> (DVec2, DVec2) {
    points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
}
