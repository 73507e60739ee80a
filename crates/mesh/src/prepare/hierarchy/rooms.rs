//! How far vertices are from what may come to lie before them, or behind.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use rayon::prelude::*;

use super::layers::{Layer, LayerSearch};
use super::pieces::pieces;
use crate::Mesh;
use crate::prepare::nearest::TriangleTree;

/// Of each vertex that is its own place, how far it is from the nearest triangle of another piece, and from the next
/// layer of its own; infinitely far from `within` on. Triangles are of one piece that have a place in common, and so
/// on. `unit` is a length of the mesh's size. Where `stop` has become true, some are 0.
pub(super) fn rooms(mesh: &Mesh, places: &[u32], (unit, within): (f64, f64), stop: &AtomicBool) -> Vec<f32> {
    let pieces = pieces(mesh, places);
    let piece = |triangle: u32| match &pieces {
        Some(pieces) => pieces[places[mesh.indices()[3 * triangle as usize] as usize] as usize],
        None => 0,
    };
    let tree = TriangleTree::of_pieces(mesh.triangle_count() as u32, |number| mesh.corners_of(number), piece, stop);
    let rooms: Vec<AtomicU32> = places.iter().map(|_| AtomicU32::new(f32::INFINITY.to_bits())).collect();
    // Of numbers that are not negative the least has the least bits, and so whichever comes first.
    let lower = |place: u32, room: f64| {
        let room = if room < f64::INFINITY { (room as f32).next_down().max(0.0) } else { f32::INFINITY };
        rooms[place as usize].fetch_min(room.to_bits(), Ordering::Relaxed);
    };
    let layers = LayerSearch::new(mesh, places, &tree, unit);
    (0..places.len() as u32).into_par_iter().filter(|&vertex| places[vertex as usize] == vertex).for_each(|vertex| {
        if stop.load(Ordering::Relaxed) {
            return lower(vertex, 0.0);
        }
        if let Some(pieces) = &pieces {
            let p = mesh.positions()[vertex as usize].as_dvec3();
            lower(vertex, tree.nearest_of_others(p, pieces[vertex as usize], piece, within));
        }
        if let Some(Layer { places, distance }) = layers.next_to(vertex, within) {
            for place in [vertex, places[0], places[1], places[2]] {
                lower(place, distance);
            }
        }
    });
    rooms.into_iter().map(|room| f32::from_bits(room.into_inner())).collect()
}
