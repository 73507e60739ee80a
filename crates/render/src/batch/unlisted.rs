//! Objects and patches that need no light lists.

use crate::batch::backend::Backend;
use crate::batch::choosers::Chooser;
use crate::batch::clusters::Cluster;
use crate::batch::key::DrawKey;
use crate::batch::lit_object::LitObject;
use crate::batch::lit_patches::LitPatches;
use crate::batch::lit_runs::OpenRun;
use crate::batch::object::Shared;
use crate::device::costs::VertexPrices;
use crate::geometry::corners::CountedCorners;
use crate::geometry::seen::SeenPatch;
use crate::geometry::shape::PatchShape;
use crate::lights::places::ShadedAt;
use crate::shaders::light_slots::Lists;
use crate::shaders::records::RecordLists;
use halfway_lighting::Frequency;

impl LitPatches {
    /// Adds an object of one patch of which nothing is chosen; whether it is one.
    pub(super) fn add_unchosen(&mut self, object: &LitObject, shared: Shared, backend: &mut impl Backend) -> bool {
        let [all] = object.geometry.detail.patches() else { return false };
        let may_move = all.shape.has_normal_cone() && shared.prices != VertexPrices::NEVER;
        let Some(key) = self.unchosen(object, may_move, shared, backend) else { return false };
        let record = self.table.number(&mut self.records, object.material, RecordLists::default());
        self.add_run(
            object,
            OpenRun { key, lights: 0, record, indices: object.geometry.detail.indices(0), stretch: 0 },
        );
        true
    }

    /// The key that draws an object of one patch, where there is nothing to choose: neither lights nor the places of
    /// terms.
    fn unchosen(
        &mut self,
        object: &LitObject,
        may_move: bool,
        shared: Shared,
        backend: &mut impl Backend,
    ) -> Option<DrawKey> {
        if shared.false_colors {
            return None;
        }
        if object.key.terms.has(Frequency::Auto) {
            return if may_move { None } else { self.unlisted(object, ShadedAt::Fragments, 1, shared, backend) };
        }
        let admitted = (object.key.lists != Lists::Listed).then(|| backend.admit(object.key));
        admitted.filter(|admitted| admitted.lists != Lists::Listed)
    }

    /// Adds what is seen of an object of which no term is placed light by light, all without lists; whether it could,
    /// which takes that what draws it is there. What was moved in the frame before is noted where that is `is_placed`.
    pub(super) fn add_in_place(
        &mut self,
        chooser: &Chooser,
        (seen, clusters): (&[SeenPatch], &mut Vec<Cluster>),
        is_placed: bool,
        backend: &mut impl Backend,
    ) -> bool {
        let &Chooser { object, shared, .. } = chooser;
        if !object.may_be_unlisted(ShadedAt::Fragments, shared.lights) {
            return false;
        }
        let number = |seen: &SeenPatch| seen.corners.map_or(0, |counted| 1 + counted as usize);
        let places =
            [ShadedAt::Fragments, ShadedAt::Corners(CountedCorners::All), ShadedAt::Corners(CountedCorners::Nearest)];
        let mut counts = [0; 3];
        for seen in seen {
            counts[number(seen)] += 1;
        }
        let mut keys = [object.key; 3];
        for ((key, place), count) in keys.iter_mut().zip(places).zip(counts) {
            if count > 0 {
                let Some(unlisted) = Self::unlisted_key(object, place, shared, backend) else { return false };
                *key = unlisted;
            }
        }
        for (key, count) in keys.iter().zip(counts) {
            self.lists.count_all(key.terms, count * shared.lights.len());
        }
        if is_placed && self.lists.memory.has_moved(object.entity) {
            // They were joined, or were not.
            let mut noted = Vec::new();
            for apart in [false, true] {
                let all = (seen, 0..seen.len());
                chooser.clustering.fill(all, &mut |_: &PatchShape| apart, &self.lists.memory, clusters);
                noted.extend(
                    clusters.iter().filter(|cluster| cluster.corners.is_none()).map(|cluster| object.name(cluster)),
                );
            }
            noted.sort_unstable();
            noted.dedup_by_key(|patches| patches.name);
            for patches in noted {
                self.lists.memory.note_at_fragments(patches);
            }
        }
        let alone = counts.iter().position(|count| *count == seen.len());
        let key = |seen: &SeenPatch| &keys[alone.unwrap_or_else(|| number(seen))];
        self.add_alike(object, seen, key, shared, backend);
        true
    }

    /// The key that draws so many patches under all lights of a scene with few, where their terms have one place
    /// whatever the light: to look at each would cost more than it saves. `None` where they have lists.
    pub(super) fn unlisted(
        &mut self,
        object: &LitObject,
        place: ShadedAt,
        patches: usize,
        shared: Shared,
        backend: &mut impl Backend,
    ) -> Option<DrawKey> {
        let key = Self::unlisted_key(object, place, shared, backend)?;
        self.lists.count_all(key.terms, patches * shared.lights.len());
        Some(key)
    }

    /// As [`Self::unlisted`], and counts nothing.
    fn unlisted_key(
        object: &LitObject,
        place: ShadedAt,
        Shared { lights, .. }: Shared,
        backend: &mut impl Backend,
    ) -> Option<DrawKey> {
        if !object.may_be_unlisted(place, lights) {
            return None;
        }
        let key = DrawKey { lists: Lists::new(lights.counts), ..object.key_at(place) };
        let key = key.with_terms(place.of(object.key.terms));
        let admitted = backend.admit(key);
        (admitted.lists != Lists::Listed).then_some(admitted)
    }
}
