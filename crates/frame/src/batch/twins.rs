//! Twins: opaque objects whose bounding spheres are equal, as are those of objects whose triangles all coincide.

use bevy_math::Vec3;
use bevy_platform::collections::HashMap;

/// The bounding spheres of a frame's opaque objects.
#[derive(Debug, Default)]
pub(super) struct Twins {
    /// Each with the instance that has it.
    spheres: Vec<(u32, [u32; 4])>,
    /// A bit for each hash that a sphere has, and one for each that several have, most of which are not equal. Its memory
    /// is kept, like that of the others.
    bits: Vec<[u64; 2]>,
    counts: HashMap<[u32; 4], u32>,
    found: HashMap<u32, u32>,
}

impl Twins {
    /// The bits for each sphere: of spheres that all differ, one in so many shares a hash with another, about.
    const BITS: usize = 32;

    pub(super) fn clear(&mut self) {
        self.spheres.clear();
    }

    /// Adds the sphere of an instance, in the order of the objects.
    pub(super) fn add(&mut self, instance: u32, (center, radius): (Vec3, f32)) {
        self.spheres.push((instance, [center.x, center.y, center.z, radius].map(f32::to_bits)));
    }

    /// Of each instance before which others have the same sphere, how many.
    pub(super) fn find(&mut self) -> &HashMap<u32, u32> {
        let Self { spheres, bits, counts, found } = self;
        found.clear();
        let words = (Self::BITS * spheres.len() / 64).next_power_of_two();
        bits.clear();
        bits.resize(words, [0; 2]);
        let slot = |sphere| {
            let hash = hash(sphere);
            ((hash as usize / 64) & (words - 1), 1 << (hash % 64))
        };
        let mut any_shared = 0;
        for (_, sphere) in &*spheres {
            let (word, bit) = slot(sphere);
            let [one, several] = &mut bits[word];
            any_shared |= *one & bit;
            *several |= *one & bit;
            *one |= bit;
        }
        if any_shared == 0 {
            return found;
        }
        counts.clear();
        for (instance, sphere) in &*spheres {
            let (word, bit) = slot(sphere);
            if bits[word][1] & bit != 0 {
                let count = counts.entry(*sphere).or_default();
                if *count > 0 {
                    found.insert(*instance, *count);
                }
                *count += 1;
            }
        }
        found
    }
}

/// Spreads the bits of a sphere over a word: both halves of a product, which all of its bits have part in.
fn hash(&[x, y, z, r]: &[u32; 4]) -> u64 {
    let word = |high: u32, low: u32| u64::from(high) << 32 | u64::from(low);
    let product = u128::from(word(x, y) ^ 0x9e37_79b9_7f4a_7c15) * u128::from(word(z, r) ^ 0xc2b2_ae3d_27d4_eb4f);
    product as u64 ^ (product >> 64) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_spheres_are_counted_in_their_order() {
        let mut twins = Twins::default();
        // A second frame begins anew.
        for _ in 0..2 {
            twins.clear();
            for instance in 0..1000_u32 {
                let at = if instance % 100 == 7 { 3.0 } else { f32::from(instance as u16) };
                twins.add(instance, (Vec3::new(at, -2.0 * at, 0.25), 1.0));
            }
            // 3 itself is the first of them.
            let expected = (0..10).map(|hundred| (100 * hundred + 7, hundred + 1)).collect::<HashMap<_, _>>();
            assert_eq!(*twins.find(), expected);
        }
    }

    #[test]
    fn hashes_of_a_grid_are_spread() {
        let mut twins = Twins::default();
        for instance in 0..10_000_u32 {
            let (x, z) = ((instance % 100) as f32, (instance / 100) as f32);
            twins.add(instance, (Vec3::new(x, 0.0, z), 1.5));
        }
        assert!(twins.find().is_empty());
        // So many were looked at closely.
        assert!(twins.counts.len() < 10_000 / 8, "{}", twins.counts.len());
    }
}
