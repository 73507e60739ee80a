//! Light lists: which of many lights each patch needs, term by term.

use crate::lights::gather::Lights;
use crate::lights::memory::{ChoiceMemory, NamedPatches};
use crate::lights::patch_lights::{PatchLights, TermLights};
use crate::lights::places::{Places, Spending, next};
use crate::lights::sent::SentLights;
use crate::lights::terms::{by_fragment_shader, by_vertex_shader};
use crate::shaders::light_slots::{
    BOUND_LIGHTS, COUNTED_LIGHTS, Counted, Highlights, Lists, filled_up, filled_up_roughly,
};
use crate::shaders::records::{LightRecord, RecordLists};
use bevy_math::Vec3;
use halfway_lighting::bounds::{STEP, linear_tolerance};
use halfway_lighting::equations::{Coefficients, Eye, specular_exponent};
use halfway_lighting::{Faces, Frequency, Reflectance, Terms};

/// The lists of a frame.
#[derive(Debug, Default)]
pub(crate) struct LightLists {
    /// The lights that lists name; all of a scene with few, in their order.
    pub(crate) sent: SentLights,
    /// Lists, one after the other, as places of lights in `sent`.
    pub(crate) numbers: Vec<u32>,
    /// Lights to be bound at fixed places, set after set: first all of a scene with few, at number 0.
    pub(crate) bound: Vec<LightRecord>,
    /// The set of lights that are to be bound.
    set: BoundSet,
    /// The set bound last.
    last_set: BoundSet,
    last_bound: Option<BoundLights>,
    /// The lists made last. Neighbouring patches often need the same.
    last: Option<(RecordLists, usize)>,
    pub(crate) memory: ChoiceMemory,
    /// How many terms of lights the lists name, over all patches.
    pub(crate) assigned: u64,
    /// How many terms are shaded at each point, over all patches.
    pub(crate) shaded: u64,
    /// How many terms are shaded where, over all patches.
    pub(crate) at_vertices: u64,
    pub(crate) at_fragments: u64,
    /// The most that any channel of any patch may be off by for terms that are at the vertices, in steps of the
    /// picture.
    pub(crate) spent: f64,
    /// The most that was left out anywhere, in linear intensity: the sum of the bounds, of the brightest channel.
    pub(crate) left_out: f64,
}

/// A set of lights at fixed places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BoundLights {
    /// The number of the first: a multiple of [`SET_ALIGNMENT`].
    pub(crate) start: u32,
    pub(crate) lists: Lists,
    /// Where their terms are shaded.
    pub(crate) terms: Terms,
}

/// Which lights are bound together, those with highlights first: by number, and at the vertices with which terms where
/// the others are shaded at the fragments.
#[derive(Debug, Default, PartialEq)]
struct BoundSet {
    /// Those of the fragment shader, or of all.
    lights: Vec<u32>,
    at_vertices: Vec<(u32, [bool; 2])>,
}

/// Sets begin at numbers that are multiples of this, and so at offsets that are multiples of 256: any adapter can bind
/// them.
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
    pub(super) material: Coefficients<f32>,
    pub(super) reflectance: Reflectance,
    pub(super) view: Eye<f32>,
    /// What may be left out of a patch, in linear intensity.
    pub(super) tolerance: [f64; 3],
    pub(crate) places: Option<Places>,
}

impl LightLists {
    /// Starts a frame.
    pub(crate) fn begin(&mut self, lights: &Lights) {
        self.numbers.clear();
        self.bound.clear();
        self.sent.begin(lights);
        if lights.len() <= COUNTED_LIGHTS as usize {
            for number in 0..lights.len() as u32 {
                self.sent.place(lights, number);
            }
            self.bound.extend(&self.sent.records);
        } else {
            // No set of a patch is number 0.
            self.bound.extend([LightRecord::BLACK; SET_ALIGNMENT]);
        }
        self.last_bound = None;
        self.last = None;
        self.assigned = 0;
        self.shaded = 0;
        (self.at_vertices, self.at_fragments) = (0, 0);
        (self.left_out, self.spent) = (0.0, 0.0);
    }

    /// Takes note of where the terms of patches are shaded.
    pub(crate) fn note(&mut self, of: NamedPatches, lights: &PatchLights) {
        self.memory.note(of, lights.vertex, lights.fragment);
    }

    /// Counts so many patches and their lights.
    pub(crate) fn count(&mut self, lights: &PatchLights, patches: usize) {
        self.left_out = self.left_out.max(lights.left_out);
        let count = |of: TermLights| patches as u64 * of.count();
        self.assigned += count(lights.selected);
        self.at_vertices += count(lights.vertex);
        self.at_fragments += count(lights.fragment);
        self.spent = self.spent.max(lights.spent);
    }

    /// Counts patches of which so many `lights` together are shaded where `terms` says.
    pub(crate) fn count_all(&mut self, terms: Terms, lights: usize) {
        let count = |at: [bool; 2]| at.map(u64::from).iter().sum::<u64>() * lights as u64;
        self.at_vertices += count(by_vertex_shader(terms));
        self.at_fragments += count(by_fragment_shader(terms));
    }

    /// Binds what a patch needs at fixed places, for a draw with these terms; `None` where it is too much. Of each kind
    /// the lights with highlights come first, and the others' are left out as far as [`Highlights`] can say; or none,
    /// unless highlights `take_powers`: a few squarings cost less than more pipelines. A light that is needed for its
    /// highlight alone is shaded with both terms.
    pub(crate) fn bind(
        &mut self,
        lights: &Lights,
        of: &PatchLights,
        terms: Terms,
        take_powers: bool,
    ) -> Option<BoundLights> {
        let both_stages = !of.vertex.is_empty() && !of.fragment.is_empty();
        let (lists, terms) = if both_stages && terms.has(Frequency::Auto) {
            self.split(lights, of, terms, take_powers)?
        } else {
            let stage = if of.fragment.is_empty() { of.vertex } else { of.fragment };
            let all = if both_stages { of.selected } else { stage };
            self.set.at_vertices.clear();
            (Lists::Counted(self.set.collect(all, lights.counts, take_powers)?), terms)
        };
        if let Some(last) = self.last_bound
            && self.last_set == self.set
            && (last.lists, last.terms) == (lists, terms)
        {
            return Some(last);
        }
        if self.bound.len() > MOST_BOUND {
            return None;
        }
        self.bound.resize(self.bound.len().next_multiple_of(SET_ALIGNMENT), LightRecord::default());
        let bound = BoundLights { start: self.bound.len() as u32, lists, terms };
        let records = |light: &u32| lights.record(*light);
        let [(vertex, _), (fragment, _)] = lists.of_stages();
        append_bound(&mut self.bound, self.set.lights.iter().map(|light| (*light, records(light))), fragment, lights);
        let at_vertices = self.set.at_vertices.iter().map(|&(light, [diffuse, specular])| {
            let record = records(&light);
            let black = [0.0; 3];
            let ambient = if diffuse { record.ambient } else { black };
            let record = LightRecord {
                ambient,
                diffuse: if diffuse { record.diffuse } else { black },
                specular: if specular { record.specular } else { black },
                ..record
            };
            (light, record)
        });
        if !self.set.at_vertices.is_empty() {
            append_bound(&mut self.bound, at_vertices, vertex, lights);
        }
        std::mem::swap(&mut self.set, &mut self.last_set);
        self.last_bound = Some(bound);
        Some(bound)
    }

    /// Collects lights of which some terms are shaded at the vertices and others at the fragments. All that the
    /// fragment shader takes have their diffuse terms there, or none has; what is shaded there is not shaded at the
    /// vertices.
    fn split(
        &mut self,
        lights: &Lights,
        &PatchLights { vertex, fragment, .. }: &PatchLights,
        terms: Terms,
        take_powers: bool,
    ) -> Option<(Lists, Terms)> {
        let fragment_counted = self.set.collect(fragment, lights.counts, take_powers)?;
        let has_diffuse = !fragment.diffuse.is_empty();
        let has_specular = !fragment.specular.is_empty();
        let at_vertices = &mut self.set.at_vertices;
        at_vertices.clear();
        let TermLights { mut diffuse, mut specular } = vertex;
        while let Some(light) = next(&mut diffuse, &mut specular) {
            let place = self.set.lights.iter().position(|&at_fragments| at_fragments == light.number);
            let is_highlit = place.is_some_and(|place| {
                has_specular && is_highlit(&self.set.lights, place, fragment_counted, lights.counts)
            });
            let left = [light.has_diffuse && !(has_diffuse && place.is_some()), light.has_specular && !is_highlit];
            if left != [false; 2] {
                at_vertices.push((light.number, left));
            }
        }
        let any = |term: usize| at_vertices.iter().any(|(_, terms)| terms[term]);
        let frequency = |term, at_vertices: bool, at_fragments: bool| match (at_vertices, at_fragments) {
            _ if term != Frequency::Auto => term,
            (true, true) => Frequency::Auto,
            (true, false) => Frequency::Vertex,
            (false, true) => Frequency::Fragment,
            (false, false) => Frequency::Never,
        };
        let terms = Terms {
            diffuse: frequency(terms.diffuse, any(0), has_diffuse),
            specular: frequency(terms.specular, any(1), has_specular),
        };
        if at_vertices.is_empty() {
            return Some((Lists::Counted(fragment_counted), terms));
        }
        let mut counts = [0; 3];
        for (light, _) in at_vertices.iter() {
            counts[kind(*light, lights.counts)] += 1;
        }
        let vertex = Counted::new(filled_up_roughly(counts, lights.counts)?, Highlights::All);
        let fits = vertex.len() + fragment_counted.len() <= BOUND_LIGHTS;
        fits.then_some((Lists::Split { vertex, fragment: fragment_counted }, terms))
    }

    /// Counts what so many patches shade of the lights that are bound for each.
    pub(crate) fn count_bound(&mut self, bound: BoundLights, patches: usize) {
        let [vertex, fragment] = bound.lists.of_stages().map(|(counted, _)| {
            let lights =
                |share: Highlights| counted.counts.map(|count| u64::from(share.of(count.into()))).iter().sum::<u64>();
            [lights(Highlights::All), lights(counted.highlights)]
        });
        for (term, frequency) in [bound.terms.diffuse, bound.terms.specular].into_iter().enumerate() {
            self.shaded += patches as u64
                * match frequency {
                    Frequency::Never => 0,
                    Frequency::Triangle | Frequency::Vertex => vertex[term],
                    Frequency::Fragment => fragment[term],
                    Frequency::Auto => vertex[term] + fragment[term],
                };
        }
    }

    /// The lists of so many patches: appended, unless they are what was appended last.
    pub(crate) fn list(&mut self, lights: &Lights, of: &PatchLights, patches: usize) -> RecordLists {
        let start = self.numbers.len();
        let mut append = |stage| append_stage(&mut self.numbers, lights.counts, stage);
        let [vertex, vertex_diffuse, vertex_specular] = append(of.vertex);
        let [fragment, fragment_diffuse, fragment_specular] = append(of.fragment);
        for number in &mut self.numbers[start..] {
            *number = self.sent.place(lights, *number);
        }
        let lists =
            RecordLists { vertex, vertex_diffuse, vertex_specular, fragment, fragment_diffuse, fragment_specular };
        self.shaded += patches as u64 * (of.vertex.count() + of.fragment.count());
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
}

impl BoundSet {
    /// Collects the lights of one stage, those with highlights first; how many of each kind they are filled up to.
    /// `None` where they are too many.
    fn collect(&mut self, of: TermLights, all: [u32; 3], take_powers: bool) -> Option<Counted> {
        let TermLights { diffuse, specular } = of;
        self.lights.clear();
        self.lights.extend(specular.iter().chain(without(diffuse, specular)));
        let (highlit, rest) = self.lights.split_at(specular.len());
        let [highlit, rest] = [highlit, rest].map(|numbers| split(numbers, all));
        let needed = highlit.map(|of_kind| of_kind.len() as u32);
        let counts = filled_up([0, 1, 2].map(|kind| needed[kind] + rest[kind].len() as u32), all)?;
        let highlights = if take_powers { Highlights::at_least(needed, counts) } else { Highlights::All };
        Some(Counted::new(counts, highlights))
    }
}

/// Appends lights kind by kind, in their order, and fills each kind up.
fn append_bound(
    bound: &mut Vec<LightRecord>,
    of: impl Iterator<Item = (u32, LightRecord)> + Clone,
    counted: Counted,
    lights: &Lights,
) {
    for (number, count) in counted.counts.into_iter().enumerate() {
        let end = bound.len() + usize::from(count);
        bound.extend(of.clone().filter(|(light, _)| kind(*light, lights.counts) == number).map(|(_, record)| record));
        bound.resize(end, LightRecord::BLACK);
    }
}

/// 0 of a directional light, 1 of a point, 2 of a spot.
fn kind(light: u32, [directional, points, _]: [u32; 3]) -> usize {
    usize::from(light >= directional) + usize::from(light >= directional + points)
}

/// Whether the light at a place among those bound has its highlight there.
fn is_highlit(bound: &[u32], place: usize, counted: Counted, all: [u32; 3]) -> bool {
    let of_kind = kind(bound[place], all);
    let before = bound[..place].iter().filter(|&&light| kind(light, all) == of_kind).count() as u32;
    before < counted.highlights.of(counted.counts[of_kind].into())
}

/// The lists of one stage: lights with both terms, with the diffuse alone, and with the specular alone.
fn append_stage(
    numbers: &mut Vec<u32>,
    counts: [u32; 3],
    TermLights { diffuse, specular }: TermLights,
) -> [[u32; 4]; 3] {
    // Which is so of most patches, and found sooner.
    if diffuse == specular {
        let both = append(numbers, counts, diffuse.iter().copied());
        let none = [0, 0, 0, numbers.len() as u32];
        return [both, none, none];
    }
    let both = specular.iter().filter(|light| diffuse.binary_search(light).is_ok());
    [
        append(numbers, counts, both.copied()),
        append(numbers, counts, without(diffuse, specular).copied()),
        append(numbers, counts, without(specular, diffuse).copied()),
    ]
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

impl RecordLists {
    /// The same lists, had what was appended from `from` on been appended from `to` on.
    fn starting_at(self, to: usize, from: usize) -> Self {
        let moved = |[x, y, z, first]: [u32; 4]| {
            let first = if x + y + z == 0 { 0 } else { first - from as u32 + to as u32 };
            [x, y, z, first]
        };
        Self {
            vertex: moved(self.vertex),
            vertex_diffuse: moved(self.vertex_diffuse),
            vertex_specular: moved(self.vertex_specular),
            fragment: moved(self.fragment),
            fragment_diffuse: moved(self.fragment_diffuse),
            fragment_specular: moved(self.fragment_specular),
        }
    }
}

impl Reflector {
    pub(crate) fn listing(&self, faces: Faces, ambient: Vec3, view: Eye<f32>, spending: Spending) -> Listing {
        let unlit = self.unlit_sides(ambient);
        let places = Places::new(self.sides, self.terms, self.reflectance, faces, unlit, view, spending);
        let Spending { encoding, steps, .. } = spending;
        let for_lights = if places.is_some() { 0.5 * steps } else { steps };
        let tolerance = self.unlit(ambient).to_array().map(|at_least| {
            encoding.map_or(0.0, |encoding| linear_tolerance(encoding, for_lights * STEP, at_least.into()))
        });
        Listing { material: self.larger_side(), reflectance: self.reflectance, view, tolerance, places }
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
        let [front, back] = self.unlit_sides(ambient).map(Vec3::from_array);
        front.min(back)
    }

    fn unlit_sides(&self, ambient: Vec3) -> [[f32; 3]; 2] {
        self.sides.map(|side| (Vec3::from_array(side.ke) + Vec3::from_array(side.ka) * ambient).to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bound_set_begins_where_any_adapter_can_bind_it() {
        let lights = Lights::of_kinds([4, 20, 16]);
        let mut lists = LightLists::default();
        lists.begin(&lights);
        // Sets of 1 to 24 lights, one after the other, from all kinds.
        for count in 1..=24 {
            let [diffuse, specular] = [count, count / 2].map(|count| (40 - count..40).collect::<Vec<u32>>());
            let selected = TermLights { diffuse: &diffuse, specular: &specular };
            let (vertex, terms) = (TermLights::default(), Terms::both(Frequency::Fragment));
            let of = PatchLights { selected, vertex, fragment: selected, left_out: 0.0, spent: 0.0 };
            let bound = lists.bind(&lights, &of, terms, true).expect("so few lights fit");
            let offset = bound.start as usize * size_of::<LightRecord>();
            assert!(offset > 0 && offset.is_multiple_of(256), "the set of {count} lights begins at {offset}");
        }
        assert!(lists.bound.len() > 24 * 8, "each set is another");
    }

    #[test]
    fn of_many_lights_those_that_lists_name_are_sent_once() {
        let lights = Lights::of_kinds([0, 1000, 0]);
        let mut lists = LightLists::default();
        // A second frame begins anew.
        for _ in 0..2 {
            lists.begin(&lights);
            let mut list = |numbers: &[u32]| {
                let selected = TermLights { diffuse: numbers, specular: &[] };
                let vertex = TermLights::default();
                let of = PatchLights { selected, vertex, fragment: selected, left_out: 0.0, spent: 0.0 };
                lists.list(&lights, &of, 1).fragment_diffuse
            };
            assert_eq!(list(&[7, 900]), [0, 2, 0, 0]);
            assert_eq!(list(&[7, 900]), [0, 2, 0, 0], "what was appended last");
            assert_eq!(list(&[7, 8, 900]), [0, 3, 0, 2]);
            assert_eq!(lists.numbers, [0, 1, 0, 2, 1]);
            assert_eq!(lists.sent.records, [7, 900, 8].map(|number| lights.record(number)));
        }
    }

    #[test]
    fn few_lights_are_all_sent_in_their_order() {
        let lights = Lights::of_kinds([1, 2, 1]);
        let mut lists = LightLists::default();
        lists.begin(&lights);
        assert_eq!(lists.sent.records, [0, 1, 2, 3].map(|number| lights.record(number)));
        assert_eq!(lists.bound, lists.sent.records);
    }
}
