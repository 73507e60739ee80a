//! Equal things get equal numbers.

use std::hash::{BuildHasher, RandomState};

use bevy_math::Vec3;

/// The numbers of a list of things: equal ones have the same, counted from 0 in the order in which they first come.
pub(crate) struct Numbering {
    /// The number of each thing.
    pub(crate) numbers: Vec<u32>,
    /// The first thing of each number.
    pub(crate) firsts: Vec<u32>,
}

/// A place of the table that holds no number.
const FREE: u32 = u32::MAX;

impl Numbering {
    /// Numbers `count` things, at most 2³² − 1, by their keys.
    pub(crate) fn new<const N: usize>(count: usize, key: impl Fn(usize) -> [u32; N]) -> Self {
        // An open table at most half full, which grows with what it holds: corners are many more than their vertices. Its
        // seed is drawn anew each run, so that no file can be made to collide; the numbers do not depend on it.
        let seed = RandomState::new().hash_one(0);
        let mut table = vec![FREE; 64];
        let mut firsts: Vec<u32> = Vec::new();
        let mut numbers = Vec::with_capacity(count);
        for thing in 0..count {
            if 2 * firsts.len() >= table.len() {
                table = vec![FREE; 2 * table.len()];
                for (number, &first) in firsts.iter().enumerate() {
                    let free = places(&table, hash(seed, key(first as usize))).find(|&place| table[place] == FREE);
                    table[free.expect("half of the places are free")] = number as u32;
                }
            }
            let this = key(thing);
            let is_its = |number: u32| number == FREE || key(firsts[number as usize] as usize) == this;
            let place = places(&table, hash(seed, this)).find(|&place| is_its(table[place]));
            let place = place.expect("half of the places are free");
            if table[place] == FREE {
                table[place] = firsts.len() as u32;
                firsts.push(thing as u32);
            }
            numbers.push(table[place]);
        }
        Self { numbers, firsts }
    }

    /// Numbers positions; −0 and 0 are one.
    pub(crate) fn of_positions(positions: &[Vec3]) -> Self {
        Self::new(positions.len(), |vertex| position_key(positions[vertex]))
    }

    /// How many numbers there are.
    pub(crate) fn count(&self) -> usize {
        self.firsts.len()
    }

    /// The triangles of a mesh by the numbers of their corners.
    pub(crate) fn triangles(&self, indices: &[u32]) -> Vec<[u32; 3]> {
        indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(|i| self.numbers[i as usize])).collect()
    }
}

/// The places of a table, a power of two of them, in the order in which a hash looks at them.
fn places(table: &[u32], hash: u64) -> impl Iterator<Item = usize> + use<> {
    let mask = table.len() - 1;
    (0..=mask).map(move |step| (hash as usize).wrapping_add(step) & mask)
}

/// The bits of a position, after −0 has become 0.
pub(crate) fn position_key(p: Vec3) -> [u32; 3] {
    (p + Vec3::ZERO).to_array().map(f32::to_bits)
}

/// Folded multiplication, word by word: every bit of the key reaches the low bits that choose the place.
pub(crate) fn hash<const N: usize>(seed: u64, key: [u32; N]) -> u64 {
    key.iter().fold(seed, |hash, &word| {
        let wide = u128::from(hash ^ u64::from(word)) * 0x9e37_79b9_7f4a_7c15;
        wide as u64 ^ (wide >> 64) as u64
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_things_have_equal_numbers_in_order_of_their_first() {
        let things = [7, 3, 7, 9, 3, 7];
        let numbering = Numbering::new(things.len(), |i| [things[i]]);
        assert_eq!(numbering.numbers, [0, 1, 0, 2, 1, 0]);
        assert_eq!(numbering.firsts, [0, 1, 3]);
        assert_eq!(Numbering::new(0, |_| [0]).count(), 0);
    }

    #[test]
    fn many_keys_of_few_bits_stay_apart() {
        // A grid of whole numbers, whose f32 patterns end in zeros: what a weak hash would pile up.
        let side = 40;
        let at = |i: usize| Vec3::new((i % side) as f32, (i / side % side) as f32, (i / side / side) as f32);
        let points: Vec<Vec3> = (0..side * side * side).map(at).collect();
        let numbering = Numbering::of_positions(&points);
        assert!(numbering.numbers.iter().enumerate().all(|(i, &number)| number as usize == i));
        assert_eq!(Numbering::of_positions(&[Vec3::ZERO, -Vec3::ZERO, Vec3::X]).numbers, [0, 0, 1]);
    }
}
