//! Numbering of distinct values.

use std::hash::BuildHasher;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::Vec3;
use hashbrown::{DefaultHashBuilder, HashTable};
use rayon::prelude::*;

use crate::buckets::Buckets;

/// The numbers of a list: equal elements have the same number, counted from 0 in the order of first occurrence.
pub(crate) struct Numbering {
    /// The number of each element.
    pub(crate) numbers: Vec<u32>,
    /// The first element of each number.
    pub(crate) firsts: Vec<u32>,
}

impl Numbering {
    /// Numbers `count` elements, at most 2³² − 1, by their keys. Keys are computed again, not stored.
    pub(crate) fn new<const N: usize>(count: usize, key: impl Fn(usize) -> [u32; N]) -> Self {
        let mut table = KeyNumbers::default();
        let mut firsts: Vec<u32> = Vec::new();
        let mut numbers = Vec::with_capacity(count);
        for thing in 0..count {
            let next = firsts.len() as u32;
            let number = table.number(next, key(thing), |number| key(firsts[number as usize] as usize));
            if number == next {
                firsts.push(thing as u32);
            }
            numbers.push(number);
        }
        Self { numbers, firsts }
    }

    /// Numbers positions; −0 and 0 are equal.
    pub(crate) fn from_positions(positions: &[Vec3]) -> Self {
        // Most are distinct, and told apart by their hashes alone, which are sorted in buckets: on all threads, and in the
        // cache. The seed is new each run, so that no file can be made to collide.
        let hasher = DefaultHashBuilder::default();
        let hash = |p: &Vec3| hasher.hash_one(position_key(*p)) as u32;
        let hashes: Vec<u32> = positions.par_iter().with_min_len(BUCKET).map(hash).collect();
        let bits = (positions.len() / BUCKET).checked_ilog2().unwrap_or(0);
        let bucket = |hash: &u32| Some(hash.checked_shr(32 - bits).unwrap_or(0));
        let mut buckets = Buckets::new(1 << bits, hashes.iter().map(bucket));
        let places = buckets.things().to_vec();
        let are_distinct = AtomicBool::new(true);
        buckets.par_each(Vec::new, |keys: &mut Vec<u64>, vertices| {
            keys.clear();
            keys.extend(vertices.iter().zip(0..).map(|(&v, at)| u64::from(hashes[v as usize]) << 32 | at));
            keys.sort_unstable();
            for equal in keys.chunk_by(|a, b| a >> 32 == b >> 32).filter(|equal| equal.len() > 1) {
                for (i, at) in equal.iter().map(|key| *key as u32 as usize).enumerate().skip(1) {
                    let position = positions[vertices[at] as usize];
                    let mut before = equal[..i].iter().map(|key| vertices[*key as u32 as usize]);
                    if let Some(first) = before.find(|other| positions[*other as usize] == position) {
                        vertices[at] = first;
                        are_distinct.store(false, Ordering::Relaxed);
                    }
                }
            }
        });
        if are_distinct.into_inner() {
            return Self::of_distinct(positions.len());
        }
        let mut numbers = hashes;
        for (&vertex, &first) in places.iter().zip(buckets.things()) {
            numbers[vertex as usize] = first;
        }
        let mut firsts = Vec::new();
        for vertex in 0..numbers.len() {
            let first = numbers[vertex] as usize;
            numbers[vertex] = if first == vertex {
                firsts.push(vertex as u32);
                firsts.len() as u32 - 1
            } else {
                numbers[first]
            };
        }
        Self { numbers, firsts }
    }

    /// Numbers things that are all distinct.
    pub(crate) fn of_distinct(count: usize) -> Self {
        let numbers: Vec<u32> = (0..count as u32).collect();
        Self { firsts: numbers.clone(), numbers }
    }

    /// Whether all are distinct.
    pub(crate) fn are_distinct(&self) -> bool {
        self.firsts.len() == self.numbers.len()
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

/// So many positions are numbered together.
const BUCKET: usize = 1 << 11;

/// Distinct keys that arrive one by one, numbered from 0 in the order of first occurrence: the corners of a file of any
/// length, of which only the distinct ones are stored.
#[cfg(feature = "formats")]
#[derive(Default)]
pub(crate) struct DistinctKeys {
    /// The key of each number.
    keys: Vec<[u32; 3]>,
    table: KeyNumbers,
}

#[cfg(feature = "formats")]
impl DistinctKeys {
    /// The number of a key. There are fewer than 2³² of them, since each takes bytes of the file.
    pub(crate) fn number(&mut self, key: [u32; 3]) -> u32 {
        let Self { keys, table } = self;
        let next = keys.len() as u32;
        let number = table.number(next, key, |number| keys[number as usize]);
        if number == next {
            keys.push(key);
        }
        number
    }

    /// Adds a key that is known to be new and [`number`](Self::number) is not asked for before it is
    /// [remembered](Self::remember).
    pub(crate) fn add(&mut self, key: [u32; 3]) -> u32 {
        self.keys.push(key);
        self.keys.len() as u32 - 1
    }

    /// Lets [`number`](Self::number) find a key again.
    pub(crate) fn remember(&mut self, number: u32) {
        let Self { keys, table } = self;
        table.number(number, keys[number as usize], |number| keys[number as usize]);
    }

    /// The keys, by their numbers.
    pub(crate) fn keys(&self) -> &[[u32; 3]] {
        &self.keys
    }

    /// The key of each number.
    pub(crate) fn into_keys(self) -> Vec<[u32; 3]> {
        self.keys
    }
}

/// The numbers of keys, found by the keys, which are stored elsewhere. Hashes have a new seed each run, so that no file
/// can be made to collide; the numbers do not depend on it.
#[derive(Default)]
struct KeyNumbers {
    numbers: HashTable<u32>,
    hasher: DefaultHashBuilder,
}

impl KeyNumbers {
    /// The number of a key: `next` if the key is new; `key_of` gives the keys of those that exist.
    fn number<const N: usize>(&mut self, next: u32, key: [u32; N], key_of: impl Fn(u32) -> [u32; N]) -> u32 {
        let Self { numbers, hasher } = self;
        let hash = |key: [u32; N]| hasher.hash_one(key);
        *numbers.entry(hash(key), |&number| key_of(number) == key, |&number| hash(key_of(number))).or_insert(next).get()
    }
}

/// The bits of a position, after −0 has become 0.
pub(crate) fn position_key(p: Vec3) -> [u32; 3] {
    (p + Vec3::ZERO).to_array().map(f32::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_follow_the_order_of_first_occurrence() {
        let things = [7, 3, 7, 9, 3, 7];
        let numbering = Numbering::new(things.len(), |i| [things[i]]);
        assert_eq!(numbering.numbers, [0, 1, 0, 2, 1, 0]);
        assert_eq!(numbering.firsts, [0, 1, 3]);
        assert_eq!(Numbering::new(0, |_| [0]).count(), 0);
    }

    #[test]
    fn positions_in_buckets_are_numbered_as_others() {
        let mut seed = 7_u32;
        let mut random = |most: u32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) % most
        };
        let mut coordinate = |most: u32| random(most) as f32 - 0.5 * most as f32;
        let positions: Vec<Vec3> =
            (0..50_000).map(|_| Vec3::new(coordinate(60), -coordinate(50), coordinate(10))).collect();
        let found = Numbering::from_positions(&positions);
        let expected = Numbering::new(positions.len(), |i| position_key(positions[i]));
        assert!(found.count() > 10_000 && !found.are_distinct());
        assert_eq!((found.numbers, found.firsts), (expected.numbers, expected.firsts));
    }

    #[test]
    fn incremental_numbering_agrees_with_batch_numbering() {
        let key = |i: u32| [i, i / 7, i.wrapping_mul(1 << 20)];
        let mut distinct = DistinctKeys::default();
        for i in 0..5000 {
            assert_eq!(distinct.number(key(i)), i);
            assert_eq!(distinct.number(key(i / 2)), i / 2);
        }
        let added = distinct.add(key(5000));
        distinct.remember(added);
        distinct.remember(added);
        assert_eq!((added, distinct.number(key(5000))), (5000, 5000));
        assert_eq!(distinct.into_keys().len(), 5001);
    }

    #[test]
    fn many_keys_of_few_bits_stay_apart() {
        // A grid of whole numbers, whose f32 patterns end in zeros, where a weak hash would collide.
        let side = 40;
        let at = |i: usize| Vec3::new((i % side) as f32, (i / side % side) as f32, (i / side / side) as f32);
        let points: Vec<Vec3> = (0..side * side * side).map(at).collect();
        let numbering = Numbering::from_positions(&points);
        assert!(numbering.numbers.iter().enumerate().all(|(i, &number)| number as usize == i));
        assert_eq!(Numbering::from_positions(&[Vec3::ZERO, -Vec3::ZERO, Vec3::X]).numbers, [0, 0, 1]);
    }
}
