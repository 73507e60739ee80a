//! Selects the lights of patches.

use crate::lights::gather::Lights;
use crate::lights::lists::{LightLists, Listing};
use crate::lights::patch_lights::{PatchLights, TermLights};
use crate::lights::places::{PlacedPatch, PlacedTerms};
use bevy_math::Vec3;
use halfway_lighting::Terms;
use halfway_lighting::bounds::{NearLights, Receiver, Region, Selected};
use halfway_lighting::equations::Coefficients;

/// Lights that are nearer to the middle of a sphere than so many times its radius are among its parts.
const AMONG: f32 = 4.0;

/// Selects the lights of one patch after the other, and places their terms. Its memory is kept.
#[derive(Debug, Default)]
pub(crate) struct Selector {
    /// The lights near the patches at hand.
    near: NearLights,
    selected: Selected<f32>,
    placed: PlacedTerms,
}

impl Selector {
    /// Starts a frame.
    pub(crate) fn begin(&mut self) {
        self.placed.begin();
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

    /// Whether this sphere, of what was last looked around, has a light so near that its parts are lit otherwise: by
    /// other lights, or from elsewhere.
    pub(crate) fn is_among(&mut self, lights: &Lights, (center, radius): (Vec3, f32)) -> bool {
        self.near.any_within(&lights.tree, &lights.sources, center.to_array(), AMONG * radius)
    }

    /// Selects the lights that `patch`, one of those last looked around, needs: those left out change no channel of a
    /// pixel by more than the listing's tolerance together. And says where their terms are shaded. Returns what that
    /// saves, in lights at a pixel; below 0 where nothing is at the vertices for that.
    pub(crate) fn select(
        &mut self,
        lights: &Lights,
        lists: &LightLists,
        placed: &PlacedPatch,
        listing: &Listing,
        terms: Terms,
    ) -> f32 {
        let material = placed.shares.map_or(listing.material, |shares| shares.of(listing.material));
        let receiver = Receiver::new(placed.patch, &material, &listing.view, listing.reflectance);
        self.near.select(&lights.tree, &lights.sources, &receiver, listing.tolerance, &mut self.selected);
        match &listing.places {
            Some(places) => {
                let before = lists.memory.before(placed.name);
                self.placed.place(places, placed, terms, &lights.sources, &self.selected, before)
            }
            None => self.placed.as_said(&self.selected, placed.place.of(terms)),
        }
    }

    /// Those of the patch last selected for.
    pub(crate) fn lights(&self) -> PatchLights<'_> {
        let Selected { diffuse, specular, left_out, .. } = &self.selected;
        let PlacedTerms { vertex, fragment, spent, .. } = &self.placed;
        PatchLights {
            selected: TermLights { diffuse, specular },
            vertex: vertex.lights(),
            fragment: fragment.lights(),
            left_out: left_out.iter().copied().fold(0.0, f64::max),
            spent: *spent,
        }
    }

    /// How many pairs of a patch and a light have been looked at since this was last asked.
    pub(crate) fn take_pairs(&mut self) -> u64 {
        self.near.take_pairs()
    }
}
