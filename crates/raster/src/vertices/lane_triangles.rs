//! Triangles of a piece in the lanes of a vector, which are lit together.

use crate::input::pieces::PIECE_TRIANGLES;
use crate::simd::lanes::{F, MOST_LANES, Simd, lanes, store_fours};

/// The numbers of some triangles of a piece, at most as many as a vector has lanes.
pub(crate) struct LaneTriangles {
    numbers: [u8; MOST_LANES],
    count: usize,
}

impl LaneTriangles {
    /// Takes the first out of a set, bit k being the k-th triangle.
    #[inline(always)]
    pub(crate) fn first_of<S: Simd>(set: &mut u64) -> Self {
        let mut these = Self { numbers: [0; MOST_LANES], count: 0 };
        while *set != 0 && these.count < lanes::<S>() {
            these.numbers[these.count] = set.trailing_zeros() as u8;
            these.count += 1;
            *set &= *set - 1;
        }
        these
    }

    #[inline(always)]
    pub(crate) fn each(&self) -> impl Iterator<Item = (usize, usize)> {
        self.numbers[..self.count].iter().map(|&number| usize::from(number) % PIECE_TRIANGLES).enumerate()
    }
}

/// Scatters numbers from lanes to their triangles.
#[inline(always)]
pub(crate) fn spread<S: Simd>(numbers: [F<S>; 4], of: &LaneTriangles, to: &mut [[f32; 4]; PIECE_TRIANGLES]) {
    let mut fours = [[0.0; 4]; MOST_LANES];
    store_fours::<S>(numbers, &mut fours, 0);
    for (lane, number) in of.each() {
        to[number] = fours[lane];
    }
}
