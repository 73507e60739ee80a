//! How far the connected pieces of a mesh are from one another.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use crate::Mesh;
use crate::prepare::nearest::TriangleTree;

/// Of each vertex that is its own place, how far it is from the nearest triangle of another piece, infinitely far from
/// `within` on; `None` where there is only one. Triangles are of one piece that have a place in common, and so on.
/// Where `stop` has become true, some are 0.
pub(super) fn rooms(mesh: &Mesh, places: &[u32], within: f64, stop: &AtomicBool) -> Option<Vec<f64>> {
    let pieces = pieces(mesh, places)?;
    let piece = |triangle: u32| pieces[places[mesh.indices()[3 * triangle as usize] as usize] as usize];
    let tree = TriangleTree::of_pieces(mesh.triangle_count() as u32, |number| mesh.corners_of(number), piece, stop);
    let room = |(vertex, &own): (usize, &u32)| {
        if places[vertex] as usize != vertex || stop.load(Ordering::Relaxed) {
            return 0.0;
        }
        tree.nearest_of_others(mesh.positions()[vertex].as_dvec3(), own, piece, within)
    };
    Some(pieces.par_iter().enumerate().map(room).collect())
}

/// Of each place a number of its piece; `None` where there is one only.
fn pieces(mesh: &Mesh, places: &[u32]) -> Option<Vec<u32>> {
    // Each leads to another of its piece with a smaller number, or is the first.
    let mut leads: Vec<u32> = (0..places.len() as u32).collect();
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|vertex| first(&mut leads, places[vertex as usize]));
        let least = a.min(b).min(c);
        for number in [a, b, c] {
            leads[number as usize] = least;
        }
    }
    let pieces: Vec<u32> = (0..places.len() as u32).map(|vertex| first(&mut leads, vertex)).collect();
    let mut used = mesh.indices().iter().map(|&vertex| pieces[places[vertex as usize] as usize]);
    let one = used.next();
    used.any(|piece| Some(piece) != one).then_some(pieces)
}

/// The first of a piece, from one of its places; what lies between leads further then.
fn first(leads: &mut [u32], mut place: u32) -> u32 {
    while leads[place as usize] != place {
        let next = leads[leads[place as usize] as usize];
        leads[place as usize] = next;
        place = next;
    }
    place
}
