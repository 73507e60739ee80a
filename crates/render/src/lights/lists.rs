//! Light lists: which of many lights each patch needs, term by term.

use crate::lights::gather::Lights;
use crate::lights::terms::{by_fragment_shader, by_vertex_shader};
use crate::shaders::light_slots::{COUNTED_LIGHTS, Highlights, Lists, filled_up};
use crate::shaders::records::{LightRecord, RecordLists};
use bevy_math::Vec3;
use halfway_lighting::bounds::{
    DEFAULT_TOLERANCE, LightTree, NearLights, Patch, Receiver, Region, Selected, linear_tolerance,
};
use halfway_lighting::equations::{Coefficients, Eye, specular_exponent};
use halfway_lighting::{Encoding, Frequency, Reflectance, Terms};

/// The lists of a frame.
#[derive(Debug, Default)]
pub(crate) struct LightLists {
    /// Lists, one after the other, as numbers of lights.
    pub(crate) numbers: Vec<u32>,
    /// Lights to be bound at fixed places, set after set: first all of a scene with few, at number 0.
    pub(crate) bound: Vec<LightRecord>,
    /// The numbers of a set of lights to be bound, those with highlights first.
    set: Vec<u32>,
    /// The set bound last.
    last_set: Vec<u32>,
    last_bound: Option<BoundLights>,
    /// The lists made last. Neighbouring patches often need the same.
    last: Option<(RecordLists, usize)>,
    /// The lights of the frame, and those near the patches at hand.
    tree: LightTree,
    near: NearLights,
    selected: Selected<f32>,
    /// How many terms of lights the lists name, over all patches.
    pub(crate) assigned: u64,
    /// How many terms are shaded at each point, over all patches.
    pub(crate) shaded: u64,
    /// The most that was left out anywhere, in linear intensity: the sum of the bounds, of the brightest channel.
    pub(crate) left_out: f64,
}

/// A set of lights at fixed places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BoundLights {
    /// The number of the first: a multiple of [`SET_ALIGNMENT`].
    pub(crate) start: u32,
    /// How many of each kind it was filled up to, and how many of these have highlights.
    counts: [u32; 3],
    highlights: Highlights,
}

/// Sets begin at numbers that are multiples of this, and so at offsets that are multiples of 256: any adapter can bind them.
const SET_ALIGNMENT: usize = 256 / size_of::<LightRecord>();
const _: () = assert!(SET_ALIGNMENT * size_of::<LightRecord>() == 256, "a LightRecord's bytes divide 256");

/// A software adapter reads lights at fixed places faster, but starts a draw for each set.
const MOST_BOUND: usize = 1 << 16;

/// What an object does with light.
pub(crate) struct Reflector {
    /// The sides that are seen; twice the same where one is.
    pub(crate) sides: [Coefficients<f32>; 2],
    pub(crate) reflectance: Reflectance,
    /// Where its terms are shaded.
    pub(crate) terms: Terms,
}

/// What the light lists of an object's patches are made by.
pub(crate) struct Listing {
    /// No smaller than either side's.
    material: Coefficients<f32>,
    reflectance: Reflectance,
    view: Eye<f32>,
    /// What may be left out of a patch, in linear intensity.
    tolerance: [f64; 3],
}

impl LightLists {
    /// Starts a frame; `changed` says whether the lights have, since the last.
    pub(crate) fn begin(&mut self, lights: &Lights, changed: bool) {
        if changed {
            self.tree.rebuild(&lights.sources);
        }
        self.numbers.clear();
        self.bound.clear();
        if lights.records.len() <= COUNTED_LIGHTS as usize {
            self.bound.extend(&lights.records);
        } else {
            // No set of a patch is number 0.
            self.bound.extend([LightRecord::BLACK; SET_ALIGNMENT]);
        }
        self.last_bound = None;
        self.last = None;
        self.assigned = 0;
        self.shaded = 0;
        self.left_out = 0.0;
    }

    /// Looks for the lights near patches in these spheres, of an object with this listing.
    pub(crate) fn look_around(&mut self, listing: &Listing, spheres: impl Iterator<Item = (Vec3, f32)>) {
        let Coefficients { ka, kd, ks, .. } = listing.material;
        let nowhere = Region {
            brightest: [ka, kd, ks].into_iter().flatten().fold(0.0, f32::max),
            tolerance: listing.tolerance.into_iter().fold(f64::INFINITY, f64::min),
            ..Region::EMPTY
        };
        self.near.begin(spheres.fold(nowhere, |region, (center, radius)| region.with(center.to_array(), radius)));
    }

    /// Selects the lights that `patch`, one of those last looked around, needs: those left out change no channel of a
    /// pixel by more than half an 8-bit step together. A picture in floating point, which has no encoding, keeps all that
    /// reach the patch at all.
    pub(crate) fn select(&mut self, lights: &Lights, patch: &Patch<f32>, listing: &Listing) {
        let receiver = Receiver::new(patch, &listing.material, &listing.view, listing.reflectance);
        self.near.select(&self.tree, &lights.sources, &receiver, listing.tolerance, &mut self.selected);
        self.left_out = self.selected.left_out.into_iter().fold(self.left_out, f64::max);
        self.assigned += (self.selected.diffuse.len() + self.selected.specular.len()) as u64;
    }

    /// How many pairs of a patch and a light have been looked at since this was last asked.
    pub(crate) fn take_pairs(&mut self) -> u64 {
        self.near.take_pairs()
    }

    /// Binds what was selected at fixed places; `None` where it is too much. Of each kind the lights with highlights come
    /// first, and the others' are left out as far as [`Highlights`] can say; or none, unless highlights `take_powers`: a few
    /// squarings cost less than more pipelines. A light that is needed for its highlight alone is shaded with both terms.
    pub(crate) fn bind(&mut self, lights: &Lights, take_powers: bool) -> Option<BoundLights> {
        let Selected { diffuse, specular, .. } = &self.selected;
        self.set.clear();
        self.set.extend(specular.iter().chain(without(diffuse, specular)));
        let (highlit, rest) = self.set.split_at(specular.len());
        let [highlit, rest] = [highlit, rest].map(|numbers| split(numbers, lights.counts));
        let needed = highlit.map(|of_kind| of_kind.len() as u32);
        let counts = filled_up([0, 1, 2].map(|kind| needed[kind] + rest[kind].len() as u32), lights.counts)?;
        let highlights = if take_powers { Highlights::at_least(needed, counts) } else { Highlights::All };
        if let Some(last) = self.last_bound
            && self.last_set == self.set
            && (last.counts, last.highlights) == (counts, highlights)
        {
            return Some(last);
        }
        if self.bound.len() > MOST_BOUND {
            return None;
        }
        self.bound.resize(self.bound.len().next_multiple_of(SET_ALIGNMENT), LightRecord::default());
        let bound = BoundLights { start: self.bound.len() as u32, counts, highlights };
        for ((highlit, rest), count) in highlit.into_iter().zip(rest).zip(counts) {
            let end = self.bound.len() + count as usize;
            self.bound.extend(highlit.iter().chain(rest).map(|&light| lights.records[light as usize]));
            self.bound.resize(end, LightRecord::BLACK);
        }
        std::mem::swap(&mut self.set, &mut self.last_set);
        self.last_bound = Some(bound);
        Some(bound)
    }

    /// Counts what a patch shades of the lights that are bound for it.
    pub(crate) fn count_bound(&mut self, bound: BoundLights, terms: Terms) {
        let lights = |share: Highlights| bound.counts.into_iter().map(|count| u64::from(share.of(count))).sum::<u64>();
        self.shaded += u64::from(terms.diffuse != Frequency::Never) * lights(Highlights::All);
        self.shaded += u64::from(terms.specular != Frequency::Never) * lights(bound.highlights);
    }

    /// The lists of what was selected: appended, unless they are what was appended last.
    pub(crate) fn list(&mut self, Lights { counts, .. }: &Lights, terms: Terms) -> RecordLists {
        let start = self.numbers.len();
        let (by_vertex, by_fragment) = (by_vertex_shader(terms), by_fragment_shader(terms));
        let [vertex, vertex_diffuse] = self.append_terms(*counts, by_vertex);
        let [fragment, fragment_diffuse] = self.append_terms(*counts, by_fragment);
        let lists = RecordLists { vertex, vertex_diffuse, fragment, fragment_diffuse };
        let lights = |[directional, points, spots, _]: [u32; 4]| u64::from(directional + points + spots);
        let count = |terms: [bool; 2]| terms.map(u64::from).iter().sum::<u64>();
        self.shaded += lights(vertex) * count(by_vertex) + lights(fragment) * count(by_fragment);
        self.shaded += lights(vertex_diffuse) + lights(fragment_diffuse);
        if let Some((last, last_start)) = self.last
            && last.starting_at(0, last_start) == lists.starting_at(0, start)
            && self.numbers[last_start..start] == self.numbers[start..]
        {
            self.numbers.truncate(start);
            return last;
        }
        self.last = Some((lists, start));
        lists
    }

    /// The lights with all terms that one shader evaluates, and those with the diffuse alone where it evaluates both.
    fn append_terms(&mut self, counts: [u32; 3], [has_diffuse, has_specular]: [bool; 2]) -> [[u32; 4]; 2] {
        let Selected { diffuse, specular, .. } = &self.selected;
        match (has_diffuse, has_specular) {
            (false, false) => [[0; 4]; 2],
            (true, false) => [append(&mut self.numbers, counts, diffuse.iter().copied()), [0; 4]],
            (false, true) => [append(&mut self.numbers, counts, specular.iter().copied()), [0; 4]],
            (true, true) => {
                let both = append(&mut self.numbers, counts, specular.iter().copied());
                [both, append(&mut self.numbers, counts, without(diffuse, specular).copied())]
            }
        }
    }
}

/// The lights that `others` lack; both ascend.
fn without<'a>(lights: &'a [u32], others: &'a [u32]) -> impl Iterator<Item = &'a u32> {
    let mut others = others.iter().peekable();
    lights.iter().filter(move |light| {
        while others.next_if(|other| other < light).is_some() {}
        others.peek() != Some(light)
    })
}

/// Appends lights, which are sorted by kind; how many of each, and where they begin.
fn append(numbers: &mut Vec<u32>, counts: [u32; 3], lights: impl Iterator<Item = u32>) -> [u32; 4] {
    let start = numbers.len();
    numbers.extend(lights);
    let [directional, points, spots] = split(&numbers[start..], counts).map(|of_kind| of_kind.len() as u32);
    [directional, points, spots, start as u32]
}

/// Numbers of lights, which are sorted by kind, kind by kind; `counts` are those of all lights.
fn split(numbers: &[u32], [directional, points, _]: [u32; 3]) -> [&[u32]; 3] {
    let first_point = numbers.partition_point(|&light| light < directional);
    let first_spot = numbers.partition_point(|&light| light < directional + points);
    [&numbers[..first_point], &numbers[first_point..first_spot], &numbers[first_spot..]]
}

impl BoundLights {
    pub(crate) fn lists(self) -> Lists {
        Lists::counted(self.counts, self.highlights)
    }
}

impl RecordLists {
    /// The same lists, had what was appended from `from` on been appended from `to` on.
    fn starting_at(self, to: usize, from: usize) -> Self {
        let moved = |[x, y, z, first]: [u32; 4]| {
            let first = if x + y + z == 0 { 0 } else { first - from as u32 + to as u32 };
            [x, y, z, first]
        };
        let Self { vertex, vertex_diffuse, fragment, fragment_diffuse } = self;
        Self {
            vertex: moved(vertex),
            vertex_diffuse: moved(vertex_diffuse),
            fragment: moved(fragment),
            fragment_diffuse: moved(fragment_diffuse),
        }
    }
}

impl Reflector {
    /// For a picture of this encoding, which has none in floating point.
    pub(crate) fn listing(&self, ambient: Vec3, view: Eye<f32>, encoding: Option<Encoding>) -> Listing {
        let tolerance = self.unlit(ambient).to_array().map(|at_least| {
            encoding.map_or(0.0, |encoding| linear_tolerance(encoding, DEFAULT_TOLERANCE, at_least.into()))
        });
        Listing { material: self.larger_side(), reflectance: self.reflectance, view, tolerance }
    }

    /// Coefficients that are nowhere below either side's, so that bounds hold for both.
    pub(crate) fn larger_side(&self) -> Coefficients<f32> {
        let [front, back] = &self.sides;
        let larger = |a: [f32; 3], b: [f32; 3], term: Frequency| {
            if term == Frequency::Never { [0.0; 3] } else { [0, 1, 2].map(|k| a[k].max(b[k])) }
        };
        let Terms { diffuse, specular } = self.terms;
        Coefficients {
            ka: larger(front.ka, back.ka, diffuse),
            kd: larger(front.kd, back.kd, diffuse),
            ks: larger(front.ks, back.ks, specular),
            // The smaller exponent is the wider highlight.
            shininess: front.shininess.min(back.shininess),
            ..*front
        }
    }

    /// The smaller and the larger specular exponent of both sides.
    pub(crate) fn exponents(&self) -> [f32; 2] {
        let [a, b] = [0, 1].map(|side: usize| specular_exponent(self.reflectance, self.sides[side].shininess));
        [a.min(b), a.max(b)]
    }

    /// What every point of both sides has without lights.
    pub(crate) fn unlit(&self, ambient: Vec3) -> Vec3 {
        let [front, back] = self.sides.map(|side| Vec3::from_array(side.ke) + Vec3::from_array(side.ka) * ambient);
        front.min(back)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bound_set_begins_where_any_adapter_can_bind_it() {
        let lights = Lights { records: vec![LightRecord::BLACK; 40], counts: [4, 20, 16], ..Lights::default() };
        let mut lists = LightLists::default();
        lists.begin(&lights, true);
        // Sets of 1 to 24 lights, one after the other, from all kinds.
        for count in 1..=24 {
            lists.selected.diffuse = (40 - count..40).collect();
            lists.selected.specular = (40 - count / 2..40).collect();
            let bound = lists.bind(&lights, true).expect("so few lights fit");
            let offset = bound.start as usize * size_of::<LightRecord>();
            assert!(offset > 0 && offset.is_multiple_of(256), "the set of {count} lights begins at {offset}");
        }
        assert!(lists.bound.len() > 24 * 8, "each set is another");
    }
}
