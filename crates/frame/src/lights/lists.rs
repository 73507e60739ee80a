//! Light lists: which of many lights each patch needs, term by term.

use crate::lights::gather::Lights;
use crate::lights::sent::SentLights;
use crate::lights::slots::COUNTED_LIGHTS;
use bevy_math::Vec3;
use halfway_lighting::bounds::{Patch, Receiver, STEP, Selected, linear_tolerance};
use halfway_lighting::equations::{Coefficients, Eye};
use halfway_lighting::record::{LightRange, SurfaceLights};
use halfway_lighting::{Encoding, Frequency, Reflectance, Terms};

/// The light lists of a frame.
#[derive(Debug, Default)]
pub struct LightLists {
    /// The lights that lists name; all of a scene with few, in their order.
    pub sent: SentLights,
    /// All lights of a scene with few; none of others.
    pub(crate) few: SurfaceLights,
    /// Lists, one after the other, as places of lights in `sent`.
    pub numbers: Vec<u32>,
    /// The newest lists, and where they begin. Neighbouring patches often need the same.
    last: Option<(SurfaceLights, usize)>,
    /// The lights of the patch at hand.
    selected: Selected,
    /// The number of light terms in the lists, over all patches.
    pub(crate) assigned: u64,
    /// The number of pairs of a patch and a light that were evaluated.
    pub(crate) pairs: u64,
    /// The most that was left out anywhere, in linear intensity: the sum of the bounds, of the brightest channel.
    pub(crate) left_out: f64,
}

/// The reflection of light by an object.
#[derive(Debug)]
pub(crate) struct Reflector {
    /// The sides that are seen; twice the same where one is.
    pub(crate) sides: [Coefficients<f32>; 2],
    pub(crate) reflectance: Reflectance,
    /// The frequencies of its terms.
    pub terms: Terms,
}

/// Inputs for building the light lists of an object's patches.
#[derive(Debug)]
pub(crate) struct Listing {
    /// No smaller than either side's.
    material: Coefficients<f32>,
    reflectance: Reflectance,
    terms: Terms,
    view: Eye<f32>,
    /// The light that may be omitted from a patch, in linear intensity.
    tolerance: [f64; 3],
}

impl LightLists {
    /// Starts a frame.
    pub(crate) fn begin(&mut self, lights: &Lights) {
        self.numbers.clear();
        self.sent.begin(lights);
        self.few = SurfaceLights::default();
        if lights.len() <= COUNTED_LIGHTS as usize {
            self.few.both.count = lights.len() as u32;
            self.numbers.extend((0..lights.len() as u32).map(|number| self.sent.place(lights, number)));
        }
        self.last = None;
        (self.assigned, self.pairs, self.left_out) = (0, 0, 0.0);
    }

    /// The lists of a patch: the lights left out change no channel of a pixel by more than the listing's tolerance
    /// together.
    pub(crate) fn list(&mut self, lights: &Lights, patch: &Patch<f32>, listing: &Listing) -> SurfaceLights {
        let receiver = Receiver::new(patch, &listing.material, &listing.view, listing.reflectance);
        lights.tree.select(&lights.sources, &receiver, listing.tolerance, &mut self.selected);
        let Selected { diffuse, specular, left_out, evaluated, .. } = &self.selected;
        self.pairs += *evaluated as u64;
        self.assigned += (diffuse.len() + specular.len()) as u64;
        self.left_out = left_out.iter().copied().fold(self.left_out, f64::max);
        let start = self.numbers.len();
        let listed = append_terms(&mut self.numbers, listing.terms, [diffuse, specular]);
        for number in &mut self.numbers[start..] {
            *number = self.sent.place(lights, *number);
        }
        if let Some((last, last_start)) = self.last
            && starting_at_0(last, last_start) == starting_at_0(listed, start)
            && self.numbers[last_start..start] == self.numbers[start..]
        {
            self.numbers.truncate(start);
            return last;
        }
        self.last = Some((listed, start));
        listed
    }
}

/// The lights of both terms. Lights with both terms are listed once if both are shaded in the same stage.
fn append_terms(numbers: &mut Vec<u32>, terms: Terms, [diffuse, specular]: [&[u32]; 2]) -> SurfaceLights {
    let mut append = |lights: &mut dyn Iterator<Item = u32>| append(numbers, lights);
    let none = LightRange::default();
    if terms.diffuse != terms.specular {
        let (diffuse, specular) = (append(&mut diffuse.iter().copied()), append(&mut specular.iter().copied()));
        return SurfaceLights { both: none, diffuse, specular };
    }
    // True of most patches, and found sooner.
    if diffuse == specular {
        return SurfaceLights { both: append(&mut diffuse.iter().copied()), diffuse: none, specular: none };
    }
    SurfaceLights {
        both: append(&mut specular.iter().filter(|light| diffuse.binary_search(light).is_ok()).copied()),
        diffuse: append(&mut without(diffuse, specular).copied()),
        specular: append(&mut without(specular, diffuse).copied()),
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

/// Appends lights; where they begin, and how many.
fn append(numbers: &mut Vec<u32>, lights: impl Iterator<Item = u32>) -> LightRange {
    let start = numbers.len();
    numbers.extend(lights);
    LightRange { start: start as u32, count: (numbers.len() - start) as u32 }
}

/// The same lights, had what was appended from `start` on been appended from 0 on.
fn starting_at_0(lights: SurfaceLights, start: usize) -> SurfaceLights {
    let moved = |range: LightRange| {
        let first = if range.is_empty() { 0 } else { range.start - start as u32 };
        LightRange { start: first, ..range }
    };
    SurfaceLights { both: moved(lights.both), diffuse: moved(lights.diffuse), specular: moved(lights.specular) }
}

impl Reflector {
    /// Inputs for the light lists of its patches, for pictures that hold values in this encoding (`None` for floating
    /// point), of which each channel may be off by so many `steps` of 1/255.
    pub(crate) fn listing(&self, ambient: Vec3, view: Eye<f32>, encoding: Option<Encoding>, steps: f64) -> Listing {
        let unlit = |side: &Coefficients<f32>| Vec3::from_array(side.ke) + Vec3::from_array(side.ka) * ambient;
        let [front, back] = self.sides.each_ref().map(unlit);
        let tolerance = front
            .min(back)
            .to_array()
            .map(|at_least| encoding.map_or(0.0, |encoding| linear_tolerance(encoding, steps * STEP, at_least.into())));
        let Self { reflectance, terms, .. } = *self;
        Listing { material: self.larger_side(), reflectance, terms, view, tolerance }
    }

    /// Coefficients that are nowhere below either side's, so that bounds hold for both; black for terms that are not
    /// shaded.
    fn larger_side(&self) -> Coefficients<f32> {
        let [front, back] = &self.sides;
        let mut larger = front.brightest(back);
        if self.terms.diffuse == Frequency::Never {
            (larger.ka, larger.kd) = ([0.0; 3], [0.0; 3]);
        }
        if self.terms.specular == Frequency::Never {
            larger.ks = [0.0; 3];
        }
        larger
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_lighting::{DirectionalLight, Faces, PointLight, SpotLight};

    /// The list of a small sphere's diffuse terms at the fragments.
    fn list(lists: &mut LightLists, lights: &Lights, center: [f32; 3]) -> LightRange {
        let kd = [1.0; 3];
        let side = Coefficients { kd, shininess: 1.0, ..Coefficients::black() };
        let terms = Terms { diffuse: Frequency::Fragment, specular: Frequency::Never };
        let reflector = Reflector { sides: [side; 2], reflectance: Reflectance::Phong, terms };
        let view = Eye::in_eye_space(halfway_lighting::Viewer::Local);
        let listing = reflector.listing(Vec3::ZERO, view, None, 0.0);
        let patch = Patch { center, radius: 0.1, normals: None, half_thickness: 0.1, faces: Faces::Both };
        lists.list(lights, &patch, &listing).diffuse
    }

    #[test]
    fn listed_lights_are_uploaded_once() {
        // At 0, 10, 20 and so on along the x axis, each reaching 6 units.
        let lights = Lights::in_a_row(1000, 10.0, 6.0);
        let mut lists = LightLists::default();
        // A second frame begins anew.
        for _ in 0..2 {
            lists.begin(&lights);
            let two = |start| LightRange { start, count: 2 };
            assert_eq!(list(&mut lists, &lights, [75.0, 0.0, -1.0]), two(0));
            assert_eq!(list(&mut lists, &lights, [75.0, 0.0, -1.1]), two(0), "equal to the newest");
            assert_eq!(list(&mut lists, &lights, [85.0, 0.0, -1.0]), two(2));
            assert_eq!(lists.numbers, [0, 1, 1, 2]);
            assert_eq!(lists.sent.records, [7, 8, 9].map(|number| lights.record(number)));
            assert_eq!(lists.assigned, 6);
        }
    }

    #[test]
    fn few_lights_are_all_uploaded_in_their_order() {
        let (sun, lamp, spot) = (DirectionalLight::white(), PointLight::white(), SpotLight::default());
        let lights = Lights::at_the_origin(&[sun.into(), lamp.into(), lamp.into(), spot.into()]);
        let mut lists = LightLists::default();
        lists.begin(&lights);
        assert_eq!(lists.sent.records, [0, 1, 2, 3].map(|number| lights.record(number)));
    }
}
