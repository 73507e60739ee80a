//! Objects whose patches have light lists: what was chosen for each cluster becomes lists, one by one.

use crate::batch::backend::Backend;
use crate::batch::choosers::{Chooser, ClusterChoice};
use crate::batch::clusters::Cluster;
use crate::batch::key::DrawKey;
use crate::batch::lit_object::LitObject;
use crate::batch::lit_patches::LitPatches;
use crate::batch::lit_runs::OpenRun;
use crate::batch::object::Shared;
use crate::batch::painted::PaintedObject;
use crate::geometry::seen::SeenPatch;
use crate::lights::patch_lights::PatchLights;
use crate::lights::places::ShadedAt;
use crate::shaders::light_slots::Lists;
use crate::shaders::records::RecordLists;

/// What draws a cluster: its key, the lights that are bound for it, its lists, and how many terms of lights it shades
/// at the vertices and at the fragments, where lists tell.
type Listed = (DrawKey, u32, RecordLists, Option<[u64; 2]>);

impl LitPatches {
    /// Adds what is seen of an object; of `is_placed` ones terms may be in one place or another.
    pub(super) fn add_listed(
        &mut self,
        chooser: &Chooser,
        seen: &[SeenPatch],
        is_placed: bool,
        backend: &mut impl Backend,
    ) {
        let &Chooser { object, shared, .. } = chooser;
        let mut painted = (!object.reflecting.maps.is_empty()).then(|| self.take_painted(object, shared));
        let mut choosers = std::mem::take(&mut self.choosers);
        let (groups, spare) = choosers.choose(chooser, seen, &self.lists, painted.as_ref());
        let mut run = None;
        for group in groups {
            for (cluster, chosen) in group.clusters.iter().zip(&group.choices) {
                let patch = seen[cluster.members.start].number;
                if is_placed && chosen.place == ShadedAt::Fragments {
                    self.lists.memory.note_at_fragments(object.name(cluster));
                }
                if let (Some(painted), Some(paint)) = (&mut painted, chosen.paint) {
                    painted.remember(patch, paint);
                }
                let (key, lights, lists, terms) = if let Some(number) = chosen.lights {
                    self.lit(chooser, (cluster, chosen), &group.lights.get(number), backend)
                } else if let Some(key) = self.unlisted(object, chosen.place, cluster.members.len(), shared, backend) {
                    (key, 0, RecordLists::default(), None)
                } else {
                    // What would draw it without a list is not to be had.
                    chooser.look_around(spare, std::iter::once(&cluster.shape));
                    let paint = painted.as_ref().map(|painted| painted.of(object.geometry, patch));
                    chooser.select(spare, (cluster, chosen.place), paint.as_ref(), &self.lists);
                    self.lit(chooser, (cluster, chosen), &spare.lights(), backend)
                };
                let (key, lights, record) = if shared.false_colors {
                    self.false_colored(object, patch, key, terms, backend)
                } else {
                    (key, lights, self.table.number(&mut self.records, object.material, lists))
                };
                for &SeenPatch { number, stretch, .. } in &seen[cluster.members.clone()] {
                    let indices = object.geometry.detail.indices(number);
                    let next = OpenRun { key: &key, lights, record, indices, stretch };
                    self.go_on(object, &mut run, next);
                }
            }
        }
        if let Some(run) = run {
            self.add_run(object, run);
        }
        if let Some(painted) = painted {
            self.paints.keep((object.mesh, object.form), painted);
        }
        self.choosers = choosers;
    }

    /// What is known of the images on an object.
    fn take_painted(&mut self, object: &LitObject, shared: Shared) -> PaintedObject {
        let of = (object.mesh, object.form, object.geometry);
        let maps = self.table.maps[object.maps as usize - 1];
        self.paints.take(of, object.reflecting.maps, &maps, shared.textures)
    }

    /// What draws a cluster with these lights.
    fn lit(
        &mut self,
        chooser: &Chooser,
        (cluster, chosen): (&Cluster, &ClusterChoice),
        of: &PatchLights,
        backend: &mut impl Backend,
    ) -> Listed {
        let &Chooser { object, shared, .. } = chooser;
        let patches = cluster.members.len();
        if chooser.placing.is_some() && chosen.place == ShadedAt::Either {
            self.lists.note(object.name(cluster), of);
            self.profit.add(chosen.gain);
        }
        if chosen.gain < 0.0
            && let Some(key) = self.unlisted(object, ShadedAt::Fragments, patches, shared, backend)
        {
            return (key, 0, RecordLists::default(), None);
        }
        self.lists.count(of, patches);
        let terms = Some([of.vertex.count(), of.fragment.count()]);
        let key = object.key_at(chosen.place).with_terms(of.terms(object.key.terms));
        if !key.is_lit() {
            return (backend.admit(key), 0, RecordLists::default(), terms);
        }
        let key = if shared.costs.lights_at_fixed_places
            && key.lists == Lists::Listed
            && let Some(bound) = self.lists.bind(shared.lights, of, key.terms, key.takes_powers())
        {
            let counted = DrawKey { lists: bound.lists, ..key.with_terms(bound.terms) };
            if backend.admit(counted) == counted {
                self.lists.count_bound(bound, patches);
                return (counted, bound.start, RecordLists::default(), terms);
            }
            // One with lists that is not generic either would take up room and time of those that are to draw.
            key.generic()
        } else {
            backend.admit(key)
        };
        (key, 0, self.lists.list(shared.lights, of, patches), terms)
    }
}
