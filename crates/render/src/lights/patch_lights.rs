//! The lights that patches need, and where their terms are shaded.

use halfway_lighting::{Frequency, Terms};

/// Numbers of lights, ascending: those whose diffuse terms are meant, and those whose specular ones are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TermLights<'a> {
    pub(crate) diffuse: &'a [u32],
    pub(crate) specular: &'a [u32],
}

impl<'a> TermLights<'a> {
    pub(crate) fn is_empty(self) -> bool {
        self.diffuse.is_empty() && self.specular.is_empty()
    }

    /// How many terms there are.
    pub(crate) fn count(self) -> u64 {
        (self.diffuse.len() + self.specular.len()) as u64
    }

    pub(crate) fn lists(self) -> [&'a [u32]; 2] {
        [self.diffuse, self.specular]
    }
}

/// The lights that a patch needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PatchLights<'a> {
    /// All of them.
    pub(crate) selected: TermLights<'a>,
    /// Those of their terms that one stage shades.
    pub(crate) vertex: TermLights<'a>,
    pub(crate) fragment: TermLights<'a>,
    /// The most that is left out, in linear intensity: the sum of the bounds, of the brightest channel.
    pub(crate) left_out: f64,
    /// The most that a channel may be off by for terms that are at the vertices, in steps of the picture.
    pub(crate) spent: f64,
}

impl PatchLights<'_> {
    /// Where its terms are shaded, of an object whose terms are these.
    pub(crate) fn terms(&self, terms: Terms) -> Terms {
        let of = |term, vertex: &[u32], fragment: &[u32]| match (term, vertex.is_empty(), fragment.is_empty()) {
            (Frequency::Auto, true, true) => Frequency::Never,
            (Frequency::Auto, false, true) => Frequency::Vertex,
            (Frequency::Auto, true, false) => Frequency::Fragment,
            (term, ..) => term,
        };
        let Self { vertex, fragment, .. } = self;
        Terms {
            diffuse: of(terms.diffuse, vertex.diffuse, fragment.diffuse),
            specular: of(terms.specular, vertex.specular, fragment.specular),
        }
    }
}

/// The lights of one patch after the other. Its memory is kept.
#[derive(Debug, Default)]
pub(crate) struct KeptLights {
    /// List after list.
    numbers: Vec<u32>,
    patches: Vec<KeptPatch>,
}

#[derive(Debug)]
struct KeptPatch {
    start: usize,
    /// How long each of its six lists is.
    counts: [u32; 6],
    left_out: f64,
    spent: f64,
}

impl KeptLights {
    pub(crate) fn clear(&mut self) {
        self.numbers.clear();
        self.patches.clear();
    }

    /// Keeps those of the next patch; the number that it goes by.
    pub(crate) fn keep(&mut self, lights: &PatchLights) -> usize {
        let &PatchLights { selected, vertex, fragment, left_out, spent } = lights;
        let lists = [selected, vertex, fragment].map(TermLights::lists);
        let lists: &[&[u32]; 6] = lists.as_flattened().first_chunk().expect("three times two");
        let start = self.numbers.len();
        for list in lists {
            self.numbers.extend_from_slice(list);
        }
        self.patches.push(KeptPatch { start, counts: lists.map(|list| list.len() as u32), left_out, spent });
        self.patches.len() - 1
    }

    pub(crate) fn get(&self, number: usize) -> PatchLights<'_> {
        let &KeptPatch { start, counts, left_out, spent } = &self.patches[number];
        let mut rest = &self.numbers[start..];
        let [a, b, c, d, e, f] = counts.map(|count| {
            let (list, after) = rest.split_at(count as usize);
            rest = after;
            list
        });
        let [selected, vertex, fragment] =
            [[a, b], [c, d], [e, f]].map(|[diffuse, specular]| TermLights { diffuse, specular });
        PatchLights { selected, vertex, fragment, left_out, spent }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back() {
        let numbers: Vec<u32> = (0..40).collect();
        let lights = |from: usize, left_out| {
            let mut at = from;
            let mut next = |count: usize| {
                at += count;
                &numbers[at - count..at]
            };
            let mut of = |diffuse, specular| TermLights { diffuse: next(diffuse), specular: next(specular) };
            PatchLights { selected: of(3, 2), vertex: of(0, 1), fragment: of(4, 0), left_out, spent: 2.0 * left_out }
        };
        let all = [lights(0, 0.5), lights(7, 0.25), lights(20, 0.0)];
        let mut kept = KeptLights::default();
        for _ in 0..2 {
            kept.clear();
            assert_eq!(all.each_ref().map(|lights| kept.keep(lights)), [0, 1, 2]);
            assert_eq!([2, 0, 1].map(|number| kept.get(number)), [all[2], all[0], all[1]]);
        }
    }
}
