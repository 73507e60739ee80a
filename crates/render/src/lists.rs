//! Light lists: which of many lights each patch needs, term by term.

use crate::lights::{LightRecord, Lights, rgb};
use crate::pipeline::COUNTED_LIGHTS;
use crate::records::RecordLists;
use crate::shader::filled_up;
use crate::terms::TermMask;
use bevy_math::Vec3;
use halfway_lighting::bounds::{DEFAULT_TOLERANCE, Patch, Receiver, Selected, linear_tolerance};
use halfway_lighting::equations::{Coefficients, View};
use halfway_lighting::{Encoding, Material, Reflectance};

/// The lists of a frame.
#[derive(Debug, Default)]
pub(crate) struct LightLists {
    /// Lists, one after the other, as numbers of lights.
    pub(crate) numbers: Vec<u32>,
    /// Lights to be bound at fixed places, set after set: first all of a scene with few, at number 0.
    pub(crate) bound: Vec<LightRecord>,
    /// The set bound last: its lights' numbers, its start, and how many of each kind it was filled up to.
    last_bound: (Vec<u32>, Bound),
    union: Vec<u32>,
    /// The lists made last. Neighbouring patches often need the same.
    last: Option<(RecordLists, usize)>,
    selected: Selected<f32>,
    /// How many terms of lights the lists name, over all patches.
    pub(crate) assigned: u64,
    /// The most that was left out anywhere, in linear intensity: the sum of the bounds, of the brightest channel.
    pub(crate) left_out: f64,
}

/// A set of lights at fixed places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Bound {
    /// The number of the first, even, so that its bytes begin at a multiple of 256.
    pub(crate) start: u32,
    pub(crate) counts: [u32; 3],
}

/// A software adapter reads lights at fixed places faster, but starts a draw for each set.
const MOST_BOUND: usize = 1 << 16;

/// What a patch does with light.
pub(crate) struct Surface<'a> {
    /// The materials of the sides that are seen.
    pub(crate) sides: [&'a Material; 2],
    pub(crate) reflectance: Reflectance,
    /// The terms that are shaded at the vertices.
    pub(crate) vertex: TermMask,
    /// The terms that are shaded at the fragments.
    pub(crate) fragment: TermMask,
}

impl LightLists {
    pub(crate) fn begin(&mut self, lights: &Lights) {
        self.numbers.clear();
        self.bound.clear();
        if lights.records.len() <= COUNTED_LIGHTS as usize {
            self.bound.extend(&lights.records);
        } else {
            // No set of a patch is number 0.
            self.bound.extend([LightRecord::BLACK; 2]);
        }
        self.last_bound = Default::default();
        self.last = None;
        self.assigned = 0;
        self.left_out = 0.0;
    }

    /// Selects the lights that `patch` needs: those left out change no channel of a pixel by more than half an 8-bit
    /// step together. A picture in floating point, which has no `encoding`, keeps all that reach the patch at all.
    pub(crate) fn select(
        &mut self,
        lights: &Lights,
        patch: &Patch<f32>,
        surface: &Surface,
        view: &View<f32>,
        encoding: Option<Encoding>,
    ) {
        let receiver = Receiver::new(patch, &surface.coefficients(), view, surface.reflectance);
        let base = surface.base(lights.ambient).to_array();
        let tolerance = base.map(|at_least| {
            encoding.map_or(0.0, |encoding| linear_tolerance(encoding, DEFAULT_TOLERANCE, at_least.into()))
        });
        receiver.select((0..).zip(&lights.sources), tolerance, &mut self.selected);
        self.left_out = self.selected.left_out.into_iter().fold(self.left_out, f64::max);
        self.assigned += (self.selected.diffuse.len() + self.selected.specular.len()) as u64;
    }

    /// Binds what was selected at fixed places; `None` where it is too much. A light that is needed for one term alone is
    /// shaded with both: pipelines differ by numbers of lights, and two numbers a kind would make too many.
    pub(crate) fn bind(&mut self, lights: &Lights) -> Option<Bound> {
        let Selected { diffuse, specular, .. } = &self.selected;
        self.union.clear();
        self.union.extend(diffuse.iter().chain(specular));
        self.union.sort_unstable();
        self.union.dedup();
        let (last, bound) = &self.last_bound;
        if *last == self.union {
            return Some(*bound);
        }
        let [directional, points, spots] = split(&self.union, lights.counts);
        let counts = filled_up([directional.len() as u32, points.len() as u32, spots.len() as u32])?;
        if self.bound.len() > MOST_BOUND {
            return None;
        }
        self.bound.resize(self.bound.len().next_multiple_of(2), LightRecord::default());
        let start = self.bound.len();
        for (of_kind, count) in [directional, points, spots].into_iter().zip(counts) {
            let end = self.bound.len() + count as usize;
            self.bound.extend(of_kind.iter().map(|&light| lights.records[light as usize]));
            self.bound.resize(end, LightRecord::BLACK);
        }
        let bound = Bound { start: start as u32, counts };
        self.last_bound.0.clone_from(&self.union);
        self.last_bound.1 = bound;
        Some(bound)
    }

    /// The lists of what was selected: appended, unless they are what was appended last.
    pub(crate) fn list(&mut self, Lights { counts, .. }: &Lights, surface: &Surface) -> RecordLists {
        let start = self.numbers.len();
        let [vertex, vertex_diffuse] = self.append_stage(*counts, surface.vertex);
        let [fragment, fragment_diffuse] = self.append_stage(*counts, surface.fragment);
        let lists = RecordLists { vertex, vertex_diffuse, fragment, fragment_diffuse };
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

    /// The lights with all terms of the stage, and those with the diffuse alone where it has both.
    fn append_stage(&mut self, counts: [u32; 3], mask: TermMask) -> [[u32; 4]; 2] {
        let Selected { diffuse, specular, .. } = &self.selected;
        match (mask.diffuse, mask.specular) {
            (false, false) => [[0; 4]; 2],
            (true, false) => [append(&mut self.numbers, counts, diffuse.iter().copied()), [0; 4]],
            (false, true) => [append(&mut self.numbers, counts, specular.iter().copied()), [0; 4]],
            (true, true) => {
                let rest = diffuse.iter().copied().filter(|light| specular.binary_search(light).is_err());
                let both = append(&mut self.numbers, counts, specular.iter().copied());
                [both, append(&mut self.numbers, counts, rest)]
            }
        }
    }
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
        let Self { vertex, vertex_diffuse, fragment, fragment_diffuse } = self;
        Self {
            vertex: moved(vertex),
            vertex_diffuse: moved(vertex_diffuse),
            fragment: moved(fragment),
            fragment_diffuse: moved(fragment_diffuse),
        }
    }
}

impl Surface<'_> {
    /// Coefficients that are nowhere below either side's, so that bounds hold for both.
    fn coefficients(&self) -> Coefficients<f32> {
        let [front, back] = self.sides.map(Coefficients::<f32>::from);
        let larger =
            |a: [f32; 3], b: [f32; 3], used: bool| if used { [0, 1, 2].map(|k| a[k].max(b[k])) } else { [0.0; 3] };
        let Self { vertex, fragment, .. } = self;
        let diffuse = vertex.diffuse || fragment.diffuse;
        Coefficients {
            ka: larger(front.ka, back.ka, diffuse),
            kd: larger(front.kd, back.kd, diffuse),
            ks: larger(front.ks, back.ks, vertex.specular || fragment.specular),
            ke: front.ke,
            // The smaller exponent is the wider highlight.
            shininess: front.shininess.min(back.shininess),
        }
    }

    /// What every point of both sides has without lights.
    fn base(&self, ambient: Vec3) -> Vec3 {
        let [front, back] = self.sides.map(|side| rgb(side.emission) + rgb(side.ambient) * ambient);
        front.min(back)
    }
}
