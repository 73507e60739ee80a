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

#[cfg(test)]
mod tests {
    use bevy_math::Vec3;

    use super::*;

    const ACROSS: u32 = 12;
    const APART: f32 = 0.05;

    /// A fine sheet from 0 to 1 over one large triangle that is turned about the sheet's middle line by an angle. They
    /// are one piece: a strip leads from a corner of one to one of the other. The large triangle's corners are last.
    fn sheet_over_a_triangle(angle: f32) -> Mesh {
        let step = |i: u32| i as f32 / ACROSS as f32;
        let row = |y| (0..=ACROSS).map(move |x| Vec3::new(step(x), step(y), APART));
        let mut positions: Vec<Vec3> = (0..=ACROSS).flat_map(row).collect();
        let (sin, cos) = angle.sin_cos();
        let at = |x: f32, y: f32| Vec3::new(0.5 + x * cos, y, x * sin);
        positions.extend([at(-9.0, -9.0), at(9.0, -9.0), at(0.0, 18.0)]);
        let last = positions.len() as u32 - 1;
        let mut indices = Vec::new();
        for (x, y) in (0..ACROSS).flat_map(|y| (0..ACROSS).map(move |x| (x, y))) {
            let a = y * (ACROSS + 1) + x;
            let [b, c, d] = [a + 1, a + ACROSS + 1, a + ACROSS + 2];
            indices.extend([a, b, d, a, d, c]);
        }
        indices.extend([0, 1, last - 2]);
        indices.extend([last - 2, last - 1, last]);
        Mesh::new(positions, indices).expect("a mesh")
    }

    fn rooms_of(mesh: &Mesh) -> Vec<f32> {
        let places: Vec<u32> = (0..mesh.positions().len() as u32).collect();
        rooms(mesh, &places, (1.0, 1.0), &AtomicBool::new(false))
    }

    /// The middle of the sheet, whose normal the strip does not turn.
    const MIDDLE: usize = ((ACROSS + 1) * (ACROSS / 2) + ACROSS / 2) as usize;

    #[test]
    fn what_lies_under_a_vertex_has_as_little_room_as_that() {
        let mesh = sheet_over_a_triangle(0.0);
        let rooms = rooms_of(&mesh);
        let last = rooms.len() - 1;
        // No line along a normal of the large triangle's corners meets the sheet.
        for vertex in [MIDDLE, last - 1, last] {
            assert!((rooms[vertex] - APART).abs() < 1e-6, "{vertex}: {}", rooms[vertex]);
        }
    }

    #[test]
    fn what_is_turned_by_more_than_45_degrees_lies_beside() {
        for (degrees, is_layer) in [(30.0_f32, true), (44.0, true), (46.0, false), (60.0, false)] {
            let angle = degrees.to_radians();
            let room = rooms_of(&sheet_over_a_triangle(angle))[MIDDLE];
            // The distance across the large triangle, whose normals the strip turns a little.
            let is_right =
                if is_layer { (room - APART * angle.cos()).abs() < 1e-3 * APART } else { room.is_infinite() };
            assert!(is_right, "{degrees}°: {room}");
        }
    }
}
