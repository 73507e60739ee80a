//! The points of the picture that a triangle covers, and the tiles that it reaches.

use bevy_math::{DVec2, DVec3};

use super::scene::OracleScene;
use super::view::{OracleRay, PictureView};

/// A point of an object that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// The object, in the scene's order.
    pub(super) solid: usize,
    /// Distance along the view.
    pub(super) depth: f64,
    /// Whether the front is hit.
    pub(super) front: bool,
    pub(super) place: HitPoint,
}

/// The position of a hit on its object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum HitPoint {
    /// On a triangle, by the weights of its corners: barycentric in space, which is perspective-correct on the picture.
    Triangle(u32, [f64; 3]),
    /// On the surface that a mesh stands for: the point, and the unit normal of the front there.
    Surface { p: DVec3, n: DVec3 },
}

impl Hit {
    /// The triangle and the weights of its corners, unless the hit is on the surface itself.
    pub(super) fn on_triangle(&self) -> Option<(u32, [f64; 3])> {
        match self.place {
            HitPoint::Triangle(triangle, weights) => Some((triangle, weights)),
            HitPoint::Surface { .. } => None,
        }
    }
}

/// A triangle of an object or a piece of its surface, and the part of the picture that it may reach, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Primitive {
    pub(super) solid: usize,
    pub(super) index: u32,
    pub(super) low: DVec2,
    pub(super) high: DVec2,
}

/// The picture cut into squares, and the primitives that each of them may show, in drawing order.
#[derive(Clone, Debug)]
pub(super) struct Tiles {
    pub(super) primitives: Vec<Primitive>,
    /// Numbers of primitives, a list a tile, row by row.
    lists: Vec<Vec<u32>>,
    columns: usize,
}

/// The edge of a tile in pixels.
pub(super) const TILE: u32 = 32;

/// Boxes are widened by this many pixels, so that they hold all covered points despite rounding.
const MARGIN: f64 = 1e-3;

impl Tiles {
    pub(super) fn new(scene: &OracleScene) -> Self {
        let size = scene.view.size();
        let count = |pixels: f64| (pixels / f64::from(TILE)).ceil() as usize;
        let (columns, rows) = (count(size.x), count(size.y));
        let mut tiles = Self { primitives: Vec::new(), lists: vec![Vec::new(); columns * rows], columns };
        for (number, solid) in scene.solids.iter().enumerate() {
            if let Some(smooth) = &solid.smooth {
                for piece in 0..smooth.traced.pieces() {
                    let hull = smooth.traced.hull(piece).iter();
                    let hull: Vec<DVec3> = hull.map(|p| solid.eye_from_model.transform_point3(*p)).collect();
                    tiles.add(scene, number, piece as u32, &hull);
                }
                continue;
            }
            for triangle in 0..solid.mesh.triangle_count() as u32 {
                if solid.face(triangle).is_some() {
                    tiles.add(scene, number, triangle, &solid.triangle(triangle));
                }
            }
        }
        tiles
    }

    fn add(&mut self, scene: &OracleScene, solid: usize, index: u32, hull: &[DVec3]) {
        let Some([low, high]) = reach(scene, hull) else { return };
        let number = self.primitives.len() as u32;
        self.primitives.push(Primitive { solid, index, low, high });
        let tile = |pixels: f64| pixels as usize / TILE as usize;
        for row in tile(low.y)..=tile(high.y).min(self.lists.len() / self.columns - 1) {
            for column in tile(low.x)..=tile(high.x).min(self.columns - 1) {
                self.lists[row * self.columns + column].push(number);
            }
        }
    }

    pub(super) fn count(&self) -> usize {
        self.lists.len()
    }

    /// The top left pixel of a tile.
    pub(super) fn origin(&self, tile: usize) -> [u32; 2] {
        [tile % self.columns, tile / self.columns].map(|number| number as u32 * TILE)
    }

    pub(super) fn of_tile(&self, tile: usize) -> impl Iterator<Item = &Primitive> {
        self.lists[tile].iter().map(|&number| &self.primitives[number as usize])
    }

    /// The primitives that may be visible at a point of the picture.
    pub(super) fn at(&self, x: f64, y: f64) -> impl Iterator<Item = &Primitive> {
        self.of_tile(self.tile(DVec2::new(x, y)))
    }

    /// The primitives that may be visible in a box that is smaller than a tile.
    pub(super) fn within(&self, low: DVec2, high: DVec2) -> Vec<&Primitive> {
        let mut tiles =
            [low, DVec2::new(high.x, low.y), DVec2::new(low.x, high.y), high].map(|p| self.tile(p)).to_vec();
        tiles.dedup();
        let mut numbers: Vec<u32> = tiles.into_iter().flat_map(|tile| &self.lists[tile]).copied().collect();
        numbers.retain(|number| {
            let primitive = &self.primitives[*number as usize];
            primitive.low.cmple(high).all() && primitive.high.cmpge(low).all()
        });
        // In drawing order, each once.
        numbers.sort_unstable();
        numbers.dedup();
        numbers.into_iter().map(|number| &self.primitives[number as usize]).collect()
    }

    /// The tile of a point, or the one next to it.
    fn tile(&self, p: DVec2) -> usize {
        let last = [self.columns, self.lists.len() / self.columns].map(|count| count - 1);
        let tile = |pixels: f64| pixels.max(0.0) as usize / TILE as usize;
        tile(p.y).min(last[1]) * self.columns + tile(p.x).min(last[0])
    }
}

/// The corners of the box, in pixels and inside the picture, that holds what lies in the hull of some points and beyond
/// the near plane. `None` where the picture shows nothing of it.
fn reach(scene: &OracleScene, hull: &[DVec3]) -> Option<[DVec2; 2]> {
    let (near, size) = (scene.view.near(), scene.view.size());
    let beyond = |p: &DVec3| -p.z >= near;
    let mut low = DVec2::INFINITY;
    let mut high = DVec2::NEG_INFINITY;
    let mut add = |p: DVec3| {
        let pixel = scene.view.pixel(p);
        (low, high) = (low.min(pixel), high.max(pixel));
    };
    for (i, a) in hull.iter().enumerate() {
        if beyond(a) {
            add(*a);
        }
        // Where the hull is cut by the near plane its corners lie between points on either side.
        for b in hull[..i].iter().filter(|b| beyond(a) != beyond(b)) {
            let share = (-a.z - near) / (b.z - a.z);
            add((a + (b - a) * share).with_z(-near));
        }
    }
    let (low, high) = (low - MARGIN, high + MARGIN);
    let on_picture = low.x <= size.x && low.y <= size.y && high.x >= 0.0 && high.y >= 0.0;
    on_picture.then(|| [low.clamp(DVec2::ZERO, size), high.clamp(DVec2::ZERO, size)])
}

/// A triangle in eye space, ready to be met by rays.
pub(super) struct RayTriangle {
    /// The corners' depths.
    depths: [f64; 3],
    /// Normals of the planes through the origin and the edge opposite to each corner, in homogeneous coordinates. The
    /// edge that two triangles share has exactly opposite ones.
    normals: [DVec3; 3],
}

/// The intersection of a ray and a triangle.
pub(super) struct Intersection {
    pub(super) weights: [f64; 3],
    pub(super) depth: f64,
    /// Whether the triangle winds counter-clockwise as seen.
    pub(super) counter_clockwise: bool,
}

impl RayTriangle {
    pub(super) fn new(view: &PictureView, corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners.map(|corner| view.homogeneous(corner));
        Self { depths: corners.map(|corner| -corner.z), normals: [b.cross(c), c.cross(a), a.cross(b)] }
    }

    /// The intersection of the line through a point of the picture with the triangle, before the camera or behind it.
    /// The point has homogeneous coordinates with w = 1.
    ///
    /// The edge functions are the volumes of the tetrahedra of the origin, the point and each edge (homogeneous
    /// rasterisation, Olano and Greer 1997): they need no clipping, and are proportional to the weights. A ray through
    /// an edge belongs to the triangle that it enters when it is moved right by less than anything, or else down: the
    /// top-left rule.
    pub(super) fn intersect(&self, at: DVec3) -> Option<Intersection> {
        let volumes = self.normals.map(|n| n.dot(at));
        let inside = |i: usize| {
            let (n, volume) = (self.normals[i], volumes[i]);
            [volume, n.x, -n.y].into_iter().find(|side| *side != 0.0).map(|side| side > 0.0)
        };
        let side = inside(0)?;
        let sum: f64 = volumes.iter().sum();
        if inside(1)? != side || inside(2)? != side || sum == 0.0 {
            return None;
        }
        let weights = volumes.map(|volume| volume / sum);
        let depth = (0..3).map(|i| weights[i] * self.depths[i]).sum();
        // The sum is the point · (b − a)×(c − a).
        Some(Intersection { weights, depth, counter_clockwise: sum < 0.0 })
    }
}

impl Primitive {
    /// Whether the primitive may reach a point of the picture.
    pub(super) fn reaches(&self, x: f64, y: f64) -> bool {
        self.low.x <= x && x <= self.high.x && self.low.y <= y && y <= self.high.y
    }
}

impl OracleScene {
    /// Whether a corner of a triangle lies beside the picture, before the near plane or beyond the far one.
    pub(super) fn reaches_beyond(&self, primitive: &Primitive) -> bool {
        let size = self.view.size();
        let is_there = |p: &DVec3| {
            let pixel = self.view.pixel(*p);
            self.view.shows(-p.z) && pixel.cmpge(DVec2::ZERO).all() && pixel.cmple(size).all()
        };
        !self.solids[primitive.solid].triangle(primitive.index).iter().all(is_there)
    }

    /// The intersection of rays with a triangle: its hit if a shown side lies between the near and the far plane. A ray
    /// is given by its point of the picture.
    pub(super) fn triangle(&self, primitive: &Primitive) -> impl Fn(DVec3) -> Option<Hit> {
        let &Primitive { solid: number, index, .. } = primitive;
        let solid = &self.solids[number];
        let edges = RayTriangle::new(&self.view, solid.triangle(index));
        move |at| {
            let Intersection { weights, depth, counter_clockwise } = edges.intersect(at)?;
            let front = counter_clockwise != solid.mirrored;
            let seen = self.view.shows(depth) && solid.side(front).shown;
            seen.then_some(Hit { solid: number, depth, front, place: HitPoint::Triangle(index, weights) })
        }
    }

    /// The hits of the ray through a point of the picture on the pieces of one object's surface, where a side that is
    /// shown lies between the near and the far plane.
    pub(super) fn pieces<'a>(
        &self,
        number: usize,
        pieces: impl Iterator<Item = &'a Primitive>,
        at: DVec3,
    ) -> impl Iterator<Item = Hit> {
        let solid = &self.solids[number];
        let OracleRay { origin, direction: ray } = self.view.ray(at);
        // Hits lie beyond the origin of the ray.
        let begin = if self.view.near() > 0.0 { 0.0 } else { 2.0 * self.view.near() - 1.0 };
        let origin = origin + begin * ray;
        let met = solid.smooth.as_ref().map_or_else(Vec::new, |smooth| {
            let origin = smooth.model_from_eye.transform_point3(origin);
            let direction = smooth.model_from_eye.matrix3 * ray;
            let mut met = Vec::new();
            for piece in pieces {
                smooth.traced.meet(piece.index as usize, origin, direction, &mut met);
            }
            smooth.traced.settle(direction, &mut met);
            met
        });
        met.into_iter().filter_map(move |met| {
            // The ray's length along the view is 1, in either space.
            let depth = begin + met.t;
            let n = solid.turned(met.normal);
            let front = n.dot(ray) < 0.0;
            let seen = self.view.shows(depth) && solid.side(front).shown;
            seen.then_some(Hit { solid: number, depth, front, place: HitPoint::Surface { p: origin + ray * met.t, n } })
        })
    }
}
