//! Equal things get equal numbers, as they come.

use std::hash::{BuildHasher, RandomState};

use crate::numbering::hash;

/// Distinct keys, numbered from 0 in the order in which they came first.
///
/// The twin of [`Numbering`](crate::numbering::Numbering) for keys that are not all known beforehand: the corners of a
/// file of any length, of which only the distinct ones are kept.
pub(super) struct Distinct {
    /// The key of each number.
    keys: Vec<[u32; 3]>,
    /// An open table at most half full.
    table: Vec<u32>,
    seed: u64,
}

/// A place of the table that holds no number.
const FREE: u32 = u32::MAX;

impl Distinct {
    pub(super) fn new() -> Self {
        // Drawn anew each run, so that no file can be made to collide; the numbers do not depend on it.
        Self { keys: Vec::new(), table: Vec::new(), seed: RandomState::new().hash_one(0) }
    }

    /// The number of a key. There are fewer than 2³² − 1 of them, since each takes bytes of the file.
    pub(super) fn number(&mut self, key: [u32; 3]) -> u32 {
        if self.table.len() < 2 * (self.keys.len() + 1) {
            self.grow();
        }
        let mask = self.table.len() - 1;
        let mut place = hash(self.seed, key) as usize & mask;
        loop {
            match self.table[place] {
                FREE => {
                    let number = self.keys.len() as u32;
                    self.table[place] = number;
                    self.keys.push(key);
                    return number;
                }
                number if self.keys[number as usize] == key => return number,
                _ => place = (place + 1) & mask,
            }
        }
    }

    /// The key of each number.
    pub(super) fn into_keys(self) -> Vec<[u32; 3]> {
        self.keys
    }

    fn grow(&mut self) {
        let length = (2 * self.table.len()).max(16);
        let mask = length - 1;
        self.table.clear();
        self.table.resize(length, FREE);
        for (number, &key) in self.keys.iter().enumerate() {
            let mut place = hash(self.seed, key) as usize & mask;
            while self.table[place] != FREE {
                place = (place + 1) & mask;
            }
            self.table[place] = number as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Distinct;

    #[test]
    fn equal_keys_have_equal_numbers() {
        let mut distinct = Distinct::new();
        let key = |i: u32| [i, i / 7, i.wrapping_mul(1 << 20)];
        for i in 0..5000 {
            assert_eq!(distinct.number(key(i)), i);
            assert_eq!(distinct.number(key(i / 2)), i / 2);
        }
        assert_eq!(distinct.into_keys().len(), 5000);
    }
}
