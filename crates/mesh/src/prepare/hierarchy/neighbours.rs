//! Which patches touch, and groups of those that touch most.

use rayon::prelude::*;

/// At a place where more patches than this meet, as at a pole, only those that follow each other are taken for
/// neighbours.
const MOST_AT_PLACE: usize = 8;

/// Groups of fewer patches than this join others.
const FEWEST: usize = 4;

/// How many patches a group has, before others join it.
const GROUP: usize = 8;

/// No group becomes larger by those that join it.
const LARGEST: usize = 12;

/// The patches that touch each patch, and at how many places.
struct Neighbours {
    starts: Vec<usize>,
    /// A patch and the number of places.
    each: Vec<(u32, u32)>,
}

impl Neighbours {
    /// `touched` has each place of each patch: the place, and the patch.
    fn new(mut touched: Vec<(u32, u32)>, patches: usize) -> Self {
        touched.par_sort_unstable_by_key(|&pair| as_one(pair));
        touched.dedup();
        let mut pairs = Vec::new();
        for at_place in touched.chunk_by(|a, b| a.0 == b.0).filter(|at_place| at_place.len() > 1) {
            for (i, &(_, a)) in at_place.iter().enumerate() {
                let others = if at_place.len() > MOST_AT_PLACE { 1 } else { at_place.len() };
                pairs.extend(at_place[i + 1..].iter().take(others).flat_map(|&(_, b)| [(a, b), (b, a)]));
            }
        }
        drop(touched);
        pairs.par_sort_unstable_by_key(|&pair| as_one(pair));
        let mut each = Vec::new();
        let mut starts = vec![0; patches + 1];
        for same in pairs.chunk_by(|a, b| a == b) {
            each.push((same[0].1, same.len() as u32));
            starts[same[0].0 as usize + 1] = each.len();
        }
        for patch in 0..patches {
            starts[patch + 1] = starts[patch + 1].max(starts[patch]);
        }
        Self { starts, each }
    }

    fn of(&self, patch: u32) -> &[(u32, u32)] {
        &self.each[self.starts[patch as usize]..self.starts[patch as usize + 1]]
    }
}

/// Two numbers in one, of the same order; which is compared sooner.
fn as_one((first, second): (u32, u32)) -> u64 {
    u64::from(first) << 32 | u64::from(second)
}

const NONE: u32 = u32::MAX;

/// Parts patches into groups of neighbours, those of a group in ascending order. Each patch has places in common with
/// others: `touched` has each of them, and the patch, in any order.
pub(super) fn group(touched: Vec<(u32, u32)>, patches: usize) -> Vec<Vec<u32>> {
    let neighbours = Neighbours::new(touched, patches);
    let mut group_of = vec![NONE; patches];
    let mut groups: Vec<Vec<u32>> = Vec::new();
    // Of each patch outside, at how many places it touches the group.
    let mut touching: Vec<(u32, u32)> = Vec::new();
    for seed in 0..patches as u32 {
        if group_of[seed as usize] != NONE {
            continue;
        }
        let number = groups.len() as u32;
        let mut group = Vec::with_capacity(GROUP);
        touching.clear();
        let mut next = Some(seed);
        while let Some(patch) = next {
            group_of[patch as usize] = number;
            group.push(patch);
            touching.retain(|&(other, _)| other != patch);
            for &(other, places) in neighbours.of(patch).iter().filter(|(other, _)| group_of[*other as usize] == NONE) {
                match touching.iter_mut().find(|(known, _)| *known == other) {
                    Some((_, sum)) => *sum += places,
                    None => touching.push((other, places)),
                }
            }
            let most = touching.iter().max_by_key(|(other, places)| (*places, std::cmp::Reverse(*other)));
            next = if group.len() < GROUP { most.map(|&(other, _)| other) } else { None };
        }
        groups.push(group);
    }
    join_small(&mut groups, &mut group_of, &neighbours);
    groups.retain(|group| !group.is_empty());
    for group in &mut groups {
        group.sort_unstable();
    }
    groups
}

/// Small groups join the one that they touch most, or, where they touch none, the small one before.
fn join_small(groups: &mut [Vec<u32>], group_of: &mut [u32], neighbours: &Neighbours) {
    let mut small_before: Option<usize> = None;
    for number in 0..groups.len() {
        let len = groups[number].len();
        if len >= FEWEST {
            continue;
        }
        let mut touched: Vec<(u32, u32)> = Vec::new();
        for &(other, places) in groups[number].iter().flat_map(|&patch| neighbours.of(patch)) {
            let other = group_of[other as usize];
            if other as usize == number || groups[other as usize].len() + len > LARGEST {
                continue;
            }
            match touched.iter_mut().find(|(known, _)| *known == other) {
                Some((_, sum)) => *sum += places,
                None => touched.push((other, places)),
            }
        }
        let most = touched.iter().max_by_key(|(other, places)| (*places, std::cmp::Reverse(*other)));
        let target = most
            .map(|&(other, _)| other as usize)
            .or_else(|| small_before.filter(|&before| groups[before].len() + len <= GROUP));
        if let Some(target) = target {
            let patches = std::mem::take(&mut groups[number]);
            for &patch in &patches {
                group_of[patch as usize] = target as u32;
            }
            groups[target].extend(patches);
        } else {
            small_before = Some(number);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The places of patches that are cells of a grid, by the corners that they share.
    fn grid(columns: u32, rows: u32) -> Vec<(u32, u32)> {
        let corners = |x: u32, y: u32| [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
        let cells = (0..rows).flat_map(move |y| (0..columns).map(move |x| (x, y)));
        cells.flat_map(|(x, y)| corners(x, y).map(|(cx, cy)| (cy * (columns + 1) + cx, y * columns + x))).collect()
    }

    #[test]
    fn groups_hold_every_patch_once() {
        for (columns, rows) in [(1, 1), (3, 1), (16, 16), (31, 7)] {
            let count = (columns * rows) as usize;
            let groups = group(grid(columns, rows), count);
            let mut all: Vec<u32> = groups.concat();
            all.sort_unstable();
            assert_eq!(all, (0..count as u32).collect::<Vec<_>>());
            assert!(groups.iter().all(|group| group.len() <= LARGEST));
            assert!(groups.len() <= count.div_ceil(4), "{} groups of {count}", groups.len());
        }
    }

    #[test]
    fn patches_that_touch_nothing_are_grouped_as_they_come() {
        let touched = (0..20).map(|patch| (patch, patch)).collect();
        let groups = group(touched, 20);
        assert_eq!(groups.iter().map(Vec::len).collect::<Vec<_>>(), [8, 8, 4]);
    }

    #[test]
    fn a_place_where_all_meet_ties_those_that_follow_each_other() {
        let touched = (0..1000).map(|patch| (0, patch)).collect();
        let groups = group(touched, 1000);
        assert!(groups.iter().all(|group| group.len() >= FEWEST && group.len() <= LARGEST));
    }
}
