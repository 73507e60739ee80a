//! The connected pieces of a mesh.

use crate::Mesh;

/// Of each place a number of its piece; `None` where there is one only.
pub(super) fn pieces(mesh: &Mesh, places: &[u32]) -> Option<Vec<u32>> {
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
