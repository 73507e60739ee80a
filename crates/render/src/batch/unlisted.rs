//! Objects and patches that need no light lists.

use crate::batch::backend::Backend;
use crate::batch::key::DrawKey;
use crate::batch::lit_object::LitObject;
use crate::batch::lit_patches::LitPatches;
use crate::batch::lit_runs::OpenRun;
use crate::batch::object::Shared;
use crate::device::costs::VertexPrices;
use crate::lights::places::ShadedAt;
use crate::shaders::light_slots::Lists;
use crate::shaders::records::RecordLists;
use halfway_lighting::Frequency;

impl LitPatches {
    /// Adds an object of one patch of which nothing is chosen; whether it is one.
    pub(super) fn add_unchosen(&mut self, object: &LitObject, shared: Shared, backend: &mut impl Backend) -> bool {
        let [all] = object.geometry.detail.patches() else { return false };
        let may_move = all.has_normal_cone() && shared.prices != VertexPrices::NEVER;
        let Some(key) = self.unchosen(object, may_move, shared, backend) else { return false };
        let record = self.table.number(&mut self.records, object.material, RecordLists::default());
        self.add_run(object, OpenRun { key, lights: 0, record, indices: all.indices.clone(), stretch: 0 });
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
            return if may_move { None } else { self.unlisted(object, ShadedAt::Fragments, shared, backend) };
        }
        let admitted = (object.key.lists != Lists::Listed).then(|| backend.admit(object.key));
        admitted.filter(|admitted| admitted.lists != Lists::Listed)
    }

    /// The key that draws a patch under all lights of a scene with few, where its terms have one place whatever the
    /// light: to look at each would cost more than it saves. `None` where the patch has lists.
    pub(super) fn unlisted(
        &mut self,
        object: &LitObject,
        place: ShadedAt,
        Shared { lights, .. }: Shared,
        backend: &mut impl Backend,
    ) -> Option<DrawKey> {
        if !object.may_be_unlisted(place, lights) {
            return None;
        }
        let key = DrawKey { lists: Lists::new(lights.counts), ..object.key }.with_terms(place.of(object.key.terms));
        let admitted = backend.admit(key);
        if admitted.lists == Lists::Listed {
            return None;
        }
        self.lists.count_all(admitted.terms, lights.records.len());
        Some(admitted)
    }
}
