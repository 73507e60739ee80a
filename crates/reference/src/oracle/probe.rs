//! Any point of the picture, for judges.

use bevy_ecs::entity::Entity;
use bevy_math::{DVec2, DVec3};

use super::raster::{Hit, Place, Primitive};
use super::{Layers, Oracle};

/// What is seen at a point of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// I, linear RGB, unclamped unless the oracle clamps.
    pub colour: [f64; 3],
    /// The nearest thing; `None` where there is only background.
    pub nearest: Option<Nearest>,
}

/// The nearest thing at a point of the picture, opaque or blended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The object.
    pub object: Entity,
    /// Its triangle, from 0; `None` where the surface that the mesh stands for is drawn.
    pub triangle: Option<u32>,
    /// Whether its front is seen.
    pub front: bool,
    /// Distance along the view in world units.
    pub depth: f64,
    /// The point in world space.
    pub position: DVec3,
}

/// What is seen close to a pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around {
    /// The least of each channel.
    pub low: [f64; 3],
    /// The greatest of each channel.
    pub high: [f64; 3],
    /// Whether more than one primitive (object, triangle, side, background) is seen or may be after rounding. Then `low`
    /// and `high` also cover what lies behind.
    pub edge: bool,
}

impl Oracle {
    /// What is seen at a point of the picture, in pixels from its top left corner; the centre of the first pixel is
    /// (0.5, 0.5). Beyond the picture there is no telling.
    pub fn seen(&self, x: f64, y: f64) -> Seen {
        let layers = self.layers_of(&self.hits(x, y));
        let nearest = layers.visible(&self.scene).min_by(|a, b| a.depth.total_cmp(&b.depth));
        let nearest = nearest.map(|hit| Nearest {
            object: self.scene.solids[hit.solid].entity,
            triangle: hit.triangle(),
            front: hit.front,
            depth: hit.depth,
            position: self.scene.view.world_from_point(self.scene.view.ray(x, y) * hit.depth),
        });
        Seen { colour: layers.colour(&self.scene, self.clamp), nearest }
    }

    /// What is seen within `radius` pixels of the centre of the pixel in column `x` of row `y`: at the centre, and at
    /// eight points each on the circle and on one half as wide; the radius is below half a pixel. For pictures that may show either side of an edge, since a
    /// renderer rounds where its vertices are.
    ///
    /// Slivers that lie between these points, being narrower than the circle, count as seen where nothing clearly hides
    /// them; so does what is within four rounding steps of f32 behind the nearest.
    pub fn around(&self, x: u32, y: u32, radius: f64) -> Around {
        let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let probes: Vec<Vec<Hit>> = points(centre, radius)
            .filter(|p| p.cmpge(DVec2::ZERO).all() && p.cmple(self.scene.view.size()).all())
            .map(|p| self.hits(p.x, p.y))
            .collect();
        let layers: Vec<Layers> = probes.iter().map(|hits| self.layers_of(hits)).collect();
        let mut values: Vec<[f64; 3]> = layers.iter().map(|of| of.colour(&self.scene, self.clamp)).collect();
        let slivers = self.slivers(centre, radius, &probes, &layers);
        let first = self.primitives_of(&layers[0]);
        let edge = !slivers.is_empty()
            || layers.iter().any(|layers| self.primitives_of(layers) != first)
            || probes.iter().any(|hits| close_depths(hits));
        if edge {
            values.extend(probes.iter().flatten().chain(&slivers).map(|hit| self.scene.value(hit)));
        }
        let bound = |pick: fn(f64, f64) -> f64| {
            values.iter().copied().reduce(|a, b| [0, 1, 2].map(|k| pick(a[k], b[k]))).unwrap_or_default()
        };
        Around { low: bound(f64::min), high: bound(f64::max), edge }
    }

    /// Where a point of the world lies on the picture, or beside it, in pixels from its top left corner; `None` before
    /// the near plane.
    pub fn project(&self, world: DVec3) -> Option<(f64, f64)> {
        let eye = self.scene.view.eye_from_point(world);
        (-eye.z >= self.scene.view.near).then(|| self.scene.view.pixel(eye).into())
    }

    /// Everything on the ray through a point of the picture, hidden or not, in the order of drawing.
    fn hits(&self, x: f64, y: f64) -> Vec<Hit> {
        let (scene, ray) = (&self.scene, self.scene.view.ray(x, y));
        let near: Vec<&Primitive> = self.tiles().at(x, y).filter(|primitive| primitive.reaches(x, y)).collect();
        let mut hits = Vec::new();
        for group in near.chunk_by(|a, b| a.solid == b.solid) {
            let solid = group[0].solid;
            if scene.solids[solid].smooth.is_some() {
                hits.extend(scene.pieces(solid, group.iter().copied(), ray));
            } else {
                hits.extend(group.iter().filter_map(|primitive| scene.triangle(primitive)(ray)));
            }
        }
        hits
    }

    fn layers_of(&self, hits: &[Hit]) -> Layers {
        let mut layers = Layers::default();
        for hit in hits {
            layers.add(&self.scene, *hit);
        }
        layers
    }

    fn primitives_of(&self, layers: &Layers) -> Vec<(usize, Option<u32>, bool)> {
        layers.visible(&self.scene).map(|hit| (hit.solid, hit.triangle(), hit.front)).collect()
    }

    /// Triangles that no probe met, narrower than the circle, which pass through it and are not clearly hidden: the point
    /// of each that is nearest to the centre, on each side that is shown.
    fn slivers(&self, centre: DVec2, radius: f64, probes: &[Vec<Hit>], layers: &[Layers]) -> Vec<Hit> {
        let view = &self.scene.view;
        let farthest = layers.iter().map(Layers::opaque_depth).fold(0.0, f64::max);
        let mut slivers = Vec::new();
        for primitive in self.tiles().at(centre.x, centre.y) {
            let solid = &self.scene.solids[primitive.solid];
            let near = (primitive.low - radius).cmple(centre).all() && (primitive.high + radius).cmpge(centre).all();
            let met = |hit: &Hit| hit.solid == primitive.solid && hit.triangle() == Some(primitive.index);
            if !near || solid.smooth.is_some() || probes.iter().flatten().any(met) {
                continue;
            }
            let corners = solid.triangle(primitive.index);
            if corners.iter().any(|corner| -corner.z < view.near) {
                continue;
            }
            let pixels = corners.map(|corner| view.pixel(corner));
            let Some((edge, along)) = nearest_of_edges(pixels, centre, radius) else { continue };
            let weights = on_edge(corners, edge, along);
            let depth = -(0..3).map(|i| weights[i] * corners[i].z).sum::<f64>();
            if depth <= farthest * (1.0 + SAME_IN_F32) {
                let place = Place::Triangle(primitive.index, weights);
                let hit = |front| Hit { solid: primitive.solid, depth, front, place };
                slivers.extend([true, false].into_iter().filter(|front| solid.side(*front).shown).map(hit));
            }
        }
        slivers
    }
}

/// Depths closer than this share may come out in any order in f32.
const SAME_IN_F32: f64 = 4.0 * f32::EPSILON as f64;

/// The centre, then eight points at each of two distances.
fn points(centre: DVec2, radius: f64) -> impl Iterator<Item = DVec2> {
    let ring =
        |radius: f64| (0..8).map(move |i| radius * DVec2::from_angle(f64::from(i) * std::f64::consts::FRAC_PI_4));
    std::iter::once(DVec2::ZERO).chain(ring(radius)).chain(ring(0.5 * radius)).map(move |offset| centre + offset)
}

/// Whether two hits on a ray are so close that a renderer may take either as the nearer one.
fn close_depths(hits: &[Hit]) -> bool {
    let mut depths: Vec<f64> = hits.iter().map(|hit| hit.depth).collect();
    depths.sort_by(f64::total_cmp);
    depths.windows(2).any(|pair| pair[1] - pair[0] <= SAME_IN_F32 * pair[1])
}

/// The edge of a triangle that comes within `radius` of a point, nearest first, and how far along it that is; `None`
/// where none does, or the triangle is not narrower than the circle.
fn nearest_of_edges(pixels: [DVec2; 3], point: DVec2, radius: f64) -> Option<([usize; 2], f64)> {
    let edges = [[0, 1], [1, 2], [2, 0]];
    let longest = edges.map(|[i, j]| pixels[i].distance(pixels[j])).into_iter().fold(0.0, f64::max);
    let twice_area = (pixels[1] - pixels[0]).perp_dot(pixels[2] - pixels[0]).abs();
    if twice_area > 2.0 * radius * longest {
        return None;
    }
    let nearest = edges.map(|[i, j]| {
        let edge = pixels[j] - pixels[i];
        let along = ((point - pixels[i]).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        // An edge seen end on is its first corner.
        let along = if along.is_nan() { 0.0 } else { along };
        (point.distance(pixels[i] + edge * along), [i, j], along)
    });
    let (distance, edge, along) = nearest.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    (distance <= radius).then_some((edge, along))
}

/// The weights of the point that is seen at a share of the way along an edge: 1/depth is linear on the picture.
fn on_edge(corners: [DVec3; 3], [i, j]: [usize; 2], along: f64) -> [f64; 3] {
    let (u, v) = ((1.0 - along) / -corners[i].z, along / -corners[j].z);
    let mut weights = [0.0; 3];
    weights[i] = u / (u + v);
    weights[j] = v / (u + v);
    weights
}
