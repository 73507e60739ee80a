//! Probes a point of the picture.

use bevy_ecs::entity::Entity;
use bevy_math::DVec3;

use super::Oracle;
use super::layers::Layers;
use super::raster::{Hit, Primitive};

/// The colour and the nearest surface at a point of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// I, linear RGB, or the values that the oracle [shows](Oracle::showing); unclamped unless the oracle clamps, and before a policy that acts on the finished picture.
    pub color: [f64; 3],
    /// The nearest surface; `None` where there is only background.
    pub nearest: Option<Nearest>,
}

/// The nearest surface at a point of the picture, opaque or blended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The object.
    pub object: Entity,
    /// Its triangle, from 0; `None` where the surface that the mesh stands for is drawn.
    pub triangle: Option<u32>,
    /// Whether its front is visible.
    pub front: bool,
    /// Distance along the view in world units.
    pub depth: f64,
    /// The point in world space.
    pub position: DVec3,
}

impl Oracle {
    /// The colour and the nearest surface at a point of the picture, in pixels from its top left corner; the centre of
    /// the first pixel is (0.5, 0.5). Points outside the picture have no defined result.
    pub fn probe(&self, x: f64, y: f64) -> Probe {
        let layers = self.layers_of(&self.hits(x, y));
        let ray = self.scene.view.ray(self.scene.view.at(x, y));
        let nearest = layers.visible(&self.scene).min_by(|a, b| a.depth.total_cmp(&b.depth));
        let nearest = nearest.map(|hit| Nearest {
            object: self.scene.solids[hit.solid].entity,
            triangle: hit.on_triangle().map(|(triangle, _)| triangle),
            front: hit.front,
            depth: hit.depth,
            position: self.scene.view.world_from_point(ray.at(hit.depth)),
        });
        Probe { color: layers.color(&self.scene, self.scene.behind(ray.direction), self.clamps()), nearest }
    }

    /// Where a point of the world lies on the picture, or beside it, in pixels from its top left corner; `None` before
    /// the near plane and beyond the far one.
    pub fn project(&self, world: DVec3) -> Option<(f64, f64)> {
        let eye = self.scene.view.eye_from_point(world);
        self.scene.view.shows(-eye.z).then(|| self.scene.view.pixel(eye).into())
    }

    /// Everything on the ray through a point of the picture, hidden or not, in the order of drawing.
    pub(super) fn hits(&self, x: f64, y: f64) -> Vec<Hit> {
        let (scene, at) = (&self.scene, self.scene.view.at(x, y));
        let near: Vec<&Primitive> = self.tiles().at(x, y).filter(|primitive| primitive.reaches(x, y)).collect();
        let mut hits = Vec::new();
        for group in near.chunk_by(|a, b| a.solid == b.solid) {
            let solid = group[0].solid;
            if scene.solids[solid].smooth.is_some() {
                hits.extend(scene.pieces(solid, group.iter().copied(), at));
            } else {
                hits.extend(group.iter().filter_map(|primitive| scene.triangle(primitive)(at)));
            }
        }
        hits
    }

    pub(super) fn layers_of(&self, hits: &[Hit]) -> Layers {
        let mut layers = Layers::default();
        for hit in hits {
            layers.add(&self.scene, *hit);
        }
        layers
    }
}
