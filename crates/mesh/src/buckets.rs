//! Sorting by a number below a known limit, in linear time.

use std::ops::Range;

use rayon::prelude::*;

/// Things, counted from 0, in buckets: those of each bucket together, in ascending order.
pub(crate) struct Buckets {
    /// Where the things of each bucket begin, and where those of the last one end.
    starts: Vec<u32>,
    things: Vec<u32>,
}

/// Buckets of so many things together are worth a thread.
const WORTH_A_THREAD: usize = 1 << 14;

impl Buckets {
    /// Puts each thing into the bucket that `buckets` names for it, below `count`; those with `None` into no bucket. The
    /// iterator has fewer than 2³² items.
    pub(crate) fn new(count: usize, buckets: impl Iterator<Item = Option<u32>> + Clone) -> Self {
        // Counted two places ahead: after the sums each place holds the start of the bucket before it, which becomes its
        // end as the things are put in.
        let mut starts = vec![0_u32; count + 2];
        for bucket in buckets.clone().flatten() {
            starts[bucket as usize + 2] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut things = vec![0; sum as usize];
        for (thing, bucket) in (0..).zip(buckets) {
            if let Some(bucket) = bucket {
                let place = &mut starts[bucket as usize + 1];
                things[*place as usize] = thing;
                *place += 1;
            }
        }
        starts.truncate(count + 1);
        Self { starts, things }
    }

    /// All things, bucket by bucket.
    pub(crate) fn things(&self) -> &[u32] {
        &self.things
    }

    /// Runs of buckets that are worth a thread, by their things.
    pub(crate) fn parts(&self) -> Vec<Range<usize>> {
        let mut parts = Vec::new();
        let mut first = 0;
        for &end in &self.starts {
            if end as usize - first >= WORTH_A_THREAD {
                parts.push(first..end as usize);
                first = end as usize;
            }
        }
        if first < self.things.len() {
            parts.push(first..self.things.len());
        }
        parts
    }

    /// Calls `change` with the things of each bucket, on all threads, each of which has a state of its own.
    pub(crate) fn par_each<S>(&mut self, state: impl Fn() -> S + Sync, change: impl Fn(&mut S, &mut [u32]) + Sync) {
        let parts = self.parts();
        let Self { starts, things } = self;
        let mut rest = (&starts[..], &mut things[..], 0);
        let mut shares = Vec::with_capacity(parts.len());
        for part in parts {
            let (starts, things, first) = rest;
            let (own, others) = things.split_at_mut(part.end - first);
            // Empty buckets at the end of a part may belong to either.
            let buckets = starts.partition_point(|&start| (start as usize) < part.end);
            shares.push((&starts[..=buckets.min(starts.len() - 1)], own, first));
            rest = (&starts[buckets..], others, part.end);
        }
        let change_all = |(starts, own, first): (&[u32], &mut [u32], usize)| {
            let mut state = state();
            for ends in starts.array_windows::<2>() {
                let [start, end] = ends.map(|end| end as usize - first);
                if start < end {
                    change(&mut state, &mut own[start..end]);
                }
            }
        };
        // Few things do not wake the threads.
        if shares.len() == 1 {
            shares.into_iter().for_each(change_all);
        } else {
            shares.into_par_iter().for_each(change_all);
        }
    }

    /// Sorts the things of each bucket by a key, equal ones in ascending order.
    pub(crate) fn sort_each(&mut self, key: impl Fn(u32) -> u32 + Sync) {
        self.par_each(Vec::new, |keys, things| {
            keys.clear();
            keys.extend(things.iter().map(|&thing| u64::from(key(thing)) << 32 | u64::from(thing)));
            keys.sort_unstable();
            things.iter_mut().zip(&*keys).for_each(|(thing, key)| *thing = *key as u32);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_sorted_by_bucket_and_key() {
        for (count, buckets) in [(0, 1), (7, 3), (100_000, 5), (100_000, 90_000)] {
            let bucket = |thing: u32| (thing % 11 != 3).then_some(thing.wrapping_mul(2_654_435_761) % buckets);
            let key = |thing: u32| thing.wrapping_mul(40_503) % 17;
            let mut sorted = Buckets::new(buckets as usize, (0..count).map(bucket));
            sorted.sort_each(key);
            let mut expected: Vec<u32> = (0..count).filter(|&thing| bucket(thing).is_some()).collect();
            expected.sort_by_key(|&thing| (bucket(thing), key(thing), thing));
            assert_eq!(sorted.things(), expected, "{count} in {buckets}");
            let parts = sorted.parts();
            assert_eq!(parts.iter().map(ExactSizeIterator::len).sum::<usize>(), expected.len());
            for part in parts.windows(2) {
                let [before, after] = [part[0].end - 1, part[1].start].map(|at| bucket(expected[at]));
                assert!(part[0].end == part[1].start && before != after, "a bucket is in one part");
            }
        }
    }
}
