//! Where the terms of each light are shaded, patch by patch: at the vertices where that is within the tolerance, and at
//! the fragments elsewhere.

use crate::device::costs::VertexPrices;
use crate::geometry::corners::CountedCorners;
use crate::lights::gains::{Extent, Movable};
use crate::lights::memory::{Before, PatchName, ROOM_TO_COME};
use crate::lights::patch_lights::TermLights;
use crate::lights::terms::{by_fragment_shader, by_vertex_shader};
use halfway_lighting::bounds::{
    Grain, Patch, PowerSlopes, STEP, Selected, TermChange, VertexChange, VertexChanges, VertexShading, linear_tolerance,
};
use halfway_lighting::equations::{Coefficients, Eye, Light, specular_exponent};
use halfway_lighting::{Encoding, Faces, Frequency, Reflectance, Terms};

/// The lights whose diffuse terms, and those whose specular terms, one stage shades. Ascending.
#[derive(Debug, Default)]
pub(super) struct StageLights {
    pub(crate) diffuse: Vec<u32>,
    pub(crate) specular: Vec<u32>,
}

/// Where the terms of a patch's lights are shaded, for one patch after the other.
#[derive(Debug, Default)]
pub(crate) struct PlacedTerms {
    pub(super) vertex: StageLights,
    pub(super) fragment: StageLights,
    /// The most that any channel of the patch may be off by, in steps of the picture.
    pub(super) spent: f64,
    /// Those that may move to the vertices, for one patch after the other.
    movable: Vec<Movable>,
    /// The lights of the patch at hand, and what shading them at the vertices changes of each side.
    numbers: Vec<u32>,
    found: [Vec<Option<VertexChange<f32>>>; 2],
    changes: VertexChanges,
    rooms: Rooms,
}

/// How far a channel that has at least this intensity may be off, in linear intensity. Pictures in floating point are
/// held to those of bytes that are not encoded, and are not clamped at white.
pub(crate) fn tolerated(encoding: Option<Encoding>, tolerance: f64, at_least: f64) -> f64 {
    encoding.map_or(tolerance, |encoding| linear_tolerance(encoding, tolerance, at_least))
}

/// [`tolerated`] for intensities from 0 to 1, as a table: the entry i is that of (i/256)², and no more than those of
/// all above.
#[derive(Debug, Default)]
struct Rooms {
    of: Option<(Option<Encoding>, f64)>,
    table: Vec<f64>,
}

impl Rooms {
    const STEPS: f64 = 256.0;

    fn begin(&mut self, encoding: Option<Encoding>, tolerance: f64) {
        if self.of != Some((encoding, tolerance)) {
            let entry = |i: u32| tolerated(encoding, tolerance, (f64::from(i) / Self::STEPS).powi(2));
            self.table.clear();
            self.table.extend((0..=Self::STEPS as u32).map(entry));
            self.of = Some((encoding, tolerance));
        }
    }

    /// For a channel that has at least this intensity.
    fn at(&self, at_least: f64) -> f64 {
        self.table[(at_least.clamp(0.0, 1.0).sqrt() * Self::STEPS) as usize]
    }
}

/// What an object's terms are placed by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Places {
    sides: [Side; 2],
    is_two_sided: bool,
    /// Whether its diffuse and its specular terms are placed light by light.
    placed: [bool; 2],
    view: Eye<f32>,
    reflectance: Reflectance,
    encoding: Option<Encoding>,
    /// How far a channel may be off, in the picture's encoding.
    tolerance: f64,
    prices: VertexPrices,
    /// How many lights are compiled in for a patch without lists; `None` where each has some.
    compiled_in: Option<usize>,
}

/// What an object's patches may change of the picture, and at which prices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spending {
    /// What the bytes of the picture hold; `None` for floating point.
    pub(crate) encoding: Option<Encoding>,
    /// In steps of 1/255 of the picture.
    pub(crate) steps: f64,
    pub(crate) prices: VertexPrices,
    /// How many lights are compiled in for a patch without lists; `None` where each has some.
    pub(crate) compiled_in: Option<usize>,
}

/// One side of a surface.
#[derive(Clone, Copy, Debug)]
struct Side {
    coefficients: Coefficients<f32>,
    slopes: PowerSlopes<f32>,
    faces: Faces,
    /// What every point of it has without lights.
    unlit: [f32; 3],
}

/// What is left of an object's reflectances on a patch at most, channel by channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PatchShares {
    pub(crate) ambient: [f32; 3],
    pub(crate) diffuse: [f32; 3],
    pub(crate) specular: [f32; 3],
}

impl PatchShares {
    pub(crate) const ALL: Self = Self { ambient: [1.0; 3], diffuse: [1.0; 3], specular: [1.0; 3] };

    /// What is left of these.
    pub(crate) fn of(&self, material: Coefficients<f32>) -> Coefficients<f32> {
        let times = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|c| a[c] * b[c]);
        let Coefficients { ka, kd, ks, .. } = material;
        let (ka, kd, ks) = (times(ka, self.ambient), times(kd, self.diffuse), times(ks, self.specular));
        Coefficients { ka, kd, ks, ..material }
    }
}

/// A patch as it is looked at.
pub(crate) struct PlacedPatch<'a> {
    pub(crate) name: PatchName,
    pub(crate) patch: &'a Patch<f32>,
    /// What images leave; `None` where there are none.
    pub(crate) shares: Option<PatchShares>,
    pub(crate) grain: Grain<f32>,
    pub(crate) place: ShadedAt,
    pub(crate) extent: Extent,
}

/// Where those terms of a patch may be shaded that are placed light by light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShadedAt {
    /// At the vertices, or at the fragments as at the nearest: what corners show is as good as what is between them.
    Corners(CountedCorners),
    /// At the fragments: its vertices cost as much as its pixels.
    Fragments,
    /// Light by light.
    Either,
}

impl ShadedAt {
    /// Where they are, all in one place.
    pub(crate) fn of(self, terms: Terms) -> Terms {
        match self {
            Self::Corners(CountedCorners::All) => {
                terms.map(|term| if term == Frequency::Auto { Frequency::Vertex } else { term })
            }
            Self::Corners(CountedCorners::Nearest) | Self::Fragments | Self::Either => terms.at_fragments(),
        }
    }
}

impl Places {
    /// Of an object with these sides and terms; `None` where none of its terms is placed light by light.
    pub(crate) fn new(
        [front, back]: [Coefficients<f32>; 2],
        terms: Terms,
        reflectance: Reflectance,
        faces: Faces,
        unlit: [[f32; 3]; 2],
        view: Eye<f32>,
        Spending { encoding, steps, prices, compiled_in }: Spending,
    ) -> Option<Self> {
        let placed = [terms.diffuse, terms.specular].map(|term| term == Frequency::Auto);
        if placed == [false; 2] || prices == VertexPrices::NEVER {
            return None;
        }
        let side = |coefficients: Coefficients<f32>, faces, unlit| Side {
            coefficients,
            slopes: PowerSlopes::new(specular_exponent(reflectance, coefficients.shininess)),
            faces,
            unlit,
        };
        let first = if faces == Faces::Back { Faces::Back } else { Faces::Front };
        Some(Self {
            sides: [side(front, first, unlit[0]), side(back, Faces::Back, unlit[1])],
            is_two_sided: faces == Faces::Both,
            placed,
            view,
            reflectance,
            encoding,
            tolerance: steps * STEP,
            prices,
            compiled_in,
        })
    }

    fn sides(&self) -> &[Side] {
        &self.sides[..=usize::from(self.is_two_sided)]
    }
}

impl PlacedTerms {
    pub(crate) fn begin(&mut self) {
        self.changes.begin();
    }

    /// Places what was selected where `terms` says, whatever the light. Saves nothing.
    pub(crate) fn as_said(&mut self, selected: &Selected<f32>, terms: Terms) -> f32 {
        self.spent = 0.0;
        let [vertex, fragment] = [by_vertex_shader(terms), by_fragment_shader(terms)];
        for (stage, [diffuse, specular]) in [(&mut self.vertex, vertex), (&mut self.fragment, fragment)] {
            stage.set(if diffuse { &selected.diffuse } else { &[] }, if specular { &selected.specular } else { &[] });
        }
        0.0
    }

    /// Places what was selected of these lights for a patch: at the vertices as much as the tolerance allows, the terms
    /// first that change least by it, and before them those that were there `before`. Returns what that saves, in
    /// lights at a pixel, less what it has to; where it saves less all are at the fragments, and what the look has cost
    /// is returned, below 0.
    pub(crate) fn place(
        &mut self,
        places: &Places,
        patch: &PlacedPatch,
        terms: Terms,
        lights: &[Light<f32>],
        selected: &Selected<f32>,
        before: Before,
    ) -> f32 {
        self.as_said(selected, patch.place.of(terms));
        if patch.place != ShadedAt::Either || places.tolerance <= 0.0 {
            return 0.0;
        }
        self.movable.clear();
        self.numbers.clear();
        let Some([brighter, darker]) = self.movable(places, patch, lights, selected, before) else {
            return self.gain_of_all(places, patch.extent);
        };
        let shares = |change: [f64; 3], room: [f64; 3]| {
            (0..3).map(|c| if change[c] > 0.0 { change[c] / room[c] } else { 0.0 }).fold(0.0, f64::max)
        };
        for item in &mut self.movable {
            item.share = shares(item.brighter, brighter).max(shares(item.darker, darker));
        }
        let comes = |item: &Movable| item.stays == Some(false);
        self.movable.sort_unstable_by(|a, b| comes(a).cmp(&comes(b)).then(a.share.total_cmp(&b.share)));
        let mut spent = [[0.0; 3]; 2];
        let mut gain = 0.0;
        let fits = |sum: &[[f64; 3]; 2], item: &Movable| {
            let part = if comes(item) { ROOM_TO_COME } else { 1.0 };
            (0..3).all(|c| sum[0][c] <= part * brighter[c] && sum[1][c] <= part * darker[c])
        };
        // Twice, since what pays only beside the other term of its light may come before that.
        for is_again in [false, true] {
            let is_open = |item: &&mut Movable| !item.is_moved && (!is_again || item.gains[0].is_none());
            for item in self.movable.iter_mut().filter(is_open) {
                let is_beside = (0..2).any(|term| !item.terms[term] && self.vertex.list(term).contains(&item.light));
                let Some(saved) = item.gains[usize::from(is_beside)] else { continue };
                let with = |spent: [f64; 3], more: [f64; 3]| [0, 1, 2].map(|c| spent[c] + more[c]);
                let sum = [with(spent[0], item.brighter), with(spent[1], item.darker)];
                if fits(&sum, item) {
                    (spent, item.is_moved) = (sum, true);
                    gain += saved;
                    for term in [0, 1] {
                        if item.terms[term] {
                            self.vertex.list(term).push(item.light);
                        }
                    }
                }
            }
        }
        for term in [0, 1] {
            if places.placed[term] {
                let moved = self.vertex.list(term);
                moved.sort_unstable();
                self.fragment.list(term).retain(|light| moved.binary_search(light).is_err());
            }
        }
        gain += self.gain_of_all(places, patch.extent);
        let most = patch.extent.pixels * (self.numbers.len() as f32 + places.prices.pixel);
        gain -= before.least_gain(most) + if self.vertex.is_empty() { 0.0 } else { places.prices.least_gain(most) };
        if gain < 0.0 {
            self.as_said(selected, terms.at_fragments());
            return (-places.prices.look * self.numbers.len() as f32).min(-f32::MIN_POSITIVE);
        }
        let left_out = selected.left_out;
        let darker_with = [0, 1, 2].map(|c| if spent[1][c] > 0.0 { spent[1][c] + left_out[c] } else { 0.0 });
        let most = shares(spent[0], brighter).max(shares(darker_with, brighter));
        self.spent = most * places.tolerance / STEP;
        gain
    }

    /// What is saved of a patch beside what each moved term saves, less what it took to find that.
    fn gain_of_all(&self, places: &Places, extent: Extent) -> f32 {
        let is_emptied = self.fragment.is_empty() && places.placed == [true; 2];
        places.prices.of_all(extent, self.numbers.len(), is_emptied, places.compiled_in)
    }

    /// Collects what may move, and returns by how much a channel may come out brighter, and darker; `None` where
    /// nothing is known of the patch.
    fn movable(
        &mut self,
        places: &Places,
        PlacedPatch { patch, grain, extent, .. }: &PlacedPatch,
        lights: &[Light<f32>],
        selected: &Selected<f32>,
        before: Before,
    ) -> Option<[[f64; 3]; 2]> {
        let mut shadings = [None, None];
        for (shading, side) in shadings.iter_mut().zip(places.sides()) {
            let patch = Patch { faces: side.faces, ..**patch };
            *shading = Some(VertexShading::new(&patch, grain, side.slopes, &places.view, places.reflectance)?);
        }
        self.rooms.begin(places.encoding, places.tolerance);
        let mut least = [0, 1].map(|i: usize| places.sides[i].unlit.map(f64::from));
        let lists = || [&selected.diffuse[..], &selected.specular[..]];
        let [mut diffuse, mut specular] = lists();
        self.numbers.clear();
        // Both lists ascend: they are walked side by side.
        while let Some(light) = next(&mut diffuse, &mut specular) {
            self.numbers.push(light.number);
        }
        for (found, shading) in self.found.iter_mut().zip(&shadings) {
            found.clear();
            if let Some(shading) = shading {
                found.extend_from_slice(self.changes.find(shading, lights, &self.numbers));
            }
        }
        let [mut diffuse, mut specular] = lists();
        for place in 0..self.numbers.len() {
            let Some(light) = next(&mut diffuse, &mut specular) else { break };
            let (number, of_light) = (light.number, &lights[light.number as usize]);
            let mut changes = [[Some([[0.0_f64; 3]; 2]); 2]; 2];
            for (i, side) in places.sides().iter().enumerate() {
                let Some(change) = self.found[i][place] else {
                    changes[i] = [None; 2];
                    continue;
                };
                let Coefficients { ka, kd, ks, .. } = side.coefficients;
                let mut took = |term: usize, sum: [[f64; 3]; 3]| {
                    changes[i][term] = Some([sum[0], sum[1]]);
                    least[i] = [0, 1, 2].map(|c| least[i][c] + sum[2][c]);
                };
                if light.has_diffuse {
                    let mut sum = [[0.0; 3]; 3];
                    add(&mut sum, change.diffuse, kd, of_light.ld);
                    if of_light.attenuate_ambient {
                        add(&mut sum, change.ambient, ka, of_light.la);
                    }
                    took(0, sum);
                }
                if light.has_specular {
                    let mut sum = [[0.0; 3]; 3];
                    add(&mut sum, change.specular, ks, of_light.ls);
                    took(1, sum);
                }
            }
            let has = [light.has_diffuse, light.has_specular];
            let change = |term: usize| {
                let [Some(front), Some(back)] = [changes[0][term], changes[1][term]] else { return None };
                let larger = |i: usize| [0, 1, 2].map(|c| front[i][c].max(back[i][c]));
                (has[term] && places.placed[term]).then(|| [larger(0), larger(1)])
            };
            let movable = places.prices.movable(number, has, [change(0), change(1)], *extent, before);
            self.movable.extend(movable.into_iter().flatten());
        }
        let sides = places.sides().len();
        let room = [0, 1, 2].map(|c| {
            let at_least = least[..sides].iter().map(|least| least[c]).fold(f64::INFINITY, f64::min);
            self.rooms.at(at_least)
        });
        Some([room, [0, 1, 2].map(|c| (room[c] - selected.left_out[c]).max(0.0))])
    }
}

/// Brighter, darker and least of a change, by its colours.
fn add<T: Into<f64> + Copy>(sum: &mut [[f64; 3]; 3], change: TermChange<f32>, coefficient: [T; 3], color: [T; 3]) {
    for (sum, factor) in sum.iter_mut().zip([change.brighter, change.darker, change.least]) {
        for c in 0..3 {
            let product: f64 = coefficient[c].into() * color[c].into();
            // Black stays black, also where nothing is known of the factor.
            if product > 0.0 {
                sum[c] += product * f64::from(factor);
            }
        }
    }
}

/// A light of two lists.
pub(crate) struct NextLight {
    pub(crate) number: u32,
    pub(crate) has_diffuse: bool,
    pub(crate) has_specular: bool,
}

/// The next light of two ascending lists.
pub(crate) fn next(diffuse: &mut &[u32], specular: &mut &[u32]) -> Option<NextLight> {
    let number = [diffuse.first(), specular.first()].into_iter().flatten().copied().min()?;
    let take = |list: &mut &[u32]| {
        let has = list.first() == Some(&number);
        *list = &list[usize::from(has)..];
        has
    };
    Some(NextLight { number, has_diffuse: take(diffuse), has_specular: take(specular) })
}

impl StageLights {
    fn set(&mut self, diffuse: &[u32], specular: &[u32]) {
        for (list, lights) in [(&mut self.diffuse, diffuse), (&mut self.specular, specular)] {
            list.clear();
            list.extend_from_slice(lights);
        }
    }

    /// The list of the diffuse terms, 0, or of the specular ones, 1.
    fn list(&mut self, term: usize) -> &mut Vec<u32> {
        if term == 0 { &mut self.diffuse } else { &mut self.specular }
    }

    pub(super) fn lights(&self) -> TermLights<'_> {
        TermLights { diffuse: &self.diffuse, specular: &self.specular }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.diffuse.is_empty() && self.specular.is_empty()
    }
}
