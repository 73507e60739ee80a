//! Illuminate: what is seen of each object, patch by patch, with its material and the lights that it needs.

use crate::batch::backend::Backend;
use crate::batch::choosers::{Chooser, Choosers};
use crate::batch::clusters::Cluster;
use crate::batch::false_colors::FalseColors;
use crate::batch::ignored::tell_ignored;
use crate::batch::key::{DrawKey, MapLooks};
use crate::batch::lit_object::LitObject;
use crate::batch::lit_runs::{LitRun, OpenRun};
use crate::batch::object::{Circumstances, Shared};
use crate::batch::painted::Paints;
use crate::batch::shown_objects::{ShownObject, ShownObjects};
use crate::batch::sources::{FrameSources, Sources};
use crate::batch::table::ObjectTable;
use crate::device::costs::VertexPrices;
use crate::error::{RenderError, label};
use crate::frame::report::FrameReport;
use crate::geometry::allowed::{Allowed, Demand, geometry_steps};
use crate::geometry::corners::ShadedCorners;
use crate::geometry::near_objects::{CoarserObject, NearObjects, ObjectBox};
use crate::geometry::outlines::{Outline, Sight};
use crate::geometry::seen::{Choice, ObjectLook, SeenPatch};
use crate::lights::gather::Lights;
use crate::lights::lists::LightLists;
use crate::lights::memory::{ChosenBy, choosing};
use crate::lights::profit::Profit;
use crate::lights::terms::{by_fragment_shader, by_vertex_shader};
use crate::shaders::light_slots::Lists;
use crate::shaders::records::{DrawRecord, InstanceRecord, MaterialRecord, RecordLists};
use crate::target::frame::FrameValues;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use halfway_lighting::{Frequency, InvalidValue, Terms, Tolerance};
use std::sync::OnceLock;

/// What is seen, in the order of the objects. Holds after [`RenderSet::Illuminate`](crate::RenderSet::Illuminate).
#[derive(Resource, Debug, Default)]
pub(crate) struct LitPatches {
    pub(crate) runs: Vec<LitRun>,
    /// The matrices of each object that has runs.
    pub(crate) instances: Vec<InstanceRecord>,
    /// Materials with light lists.
    pub(crate) records: Vec<DrawRecord>,
    pub(crate) lists: LightLists,
    pub(crate) table: ObjectTable,
    pub(super) profit: Profit,
    pub(super) choosers: Choosers,
    choice: Choice,
    near: NearObjects,
    pub(super) paints: Paints,
    /// What the draws are made of, where nothing moves.
    pub(crate) sources: Sources,
    /// They are made of the same as in the frame before, and all is as it was.
    pub(super) are_kept: bool,
}

#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn illuminate<B: Backend + Resource<Mutability = Mutable>>(
    objects: ShownObjects,
    lights: Res<Lights>,
    false_colors: Res<FalseColors>,
    prices: Option<Res<VertexPrices>>,
    chosen_by: ChosenBy,
    values: Res<FrameValues>,
    mut backend: ResMut<B>,
    mut lit: ResMut<LitPatches>,
    mut report: ResMut<FrameReport>,
) {
    let lit = &mut *lit;
    lit.are_kept = false;
    let view = &objects.view;
    let (Some(camera), Some(values)) = (&view.camera, values.0) else {
        lit.begin(&lights);
        lit.sources.forget();
        return;
    };
    let (choosing, errors, costs) = (choosing(chosen_by), report.errors.len(), backend.costs());
    let mut vertex_prices = prices.map_or(costs.vertices, |prices| *prices);
    if let Err(source) = vertex_prices.validate() {
        report.errors.push(RenderError::Invalid { entity: "resource".into(), source });
        vertex_prices = costs.vertices;
    }
    // Where anything moves, nothing is compared.
    if !objects.have_moved() && !lights.is_changed() {
        let of_frame = FrameSources {
            view: (**view).clone(),
            values,
            costs,
            prices: vertex_prices,
            choosing,
            false_colors: false_colors.0,
            geometries: objects.geometries.changes,
            answers: backend.answers(),
        };
        lit.are_kept = lit.sources.are_again(of_frame, &objects);
        if lit.are_kept {
            return;
        }
    } else {
        lit.sources.forget();
    }
    lit.begin(&lights);
    lit.lists.memory.begin(choosing, lights.counts);
    let shared = Shared {
        lights: &lights,
        textures: &objects.textures,
        view,
        encoding: values.encoding(),
        viewer: camera.viewer,
        costs,
        prices: vertex_prices,
        false_colors: false_colors.0,
    };
    lit.add_all(&objects, values.share(), shared, &mut *backend, &mut report);
    lit.tell(&mut report, values.share());
    // What is refused is told in each frame anew.
    if report.errors.len() > errors {
        lit.sources.forget();
    }
}

impl LitPatches {
    fn begin(&mut self, lights: &Lights) {
        self.runs.clear();
        self.instances.clear();
        self.records.clear();
        self.lists.begin(lights);
        self.choosers.begin();
        self.table.begin(lights.ambient);
        self.paints.begin();
        self.near.begin();
        self.profit = Profit::default();
    }

    /// What the frame's lists came to; `share` is how much of a tolerance the values have.
    fn tell(&mut self, report: &mut FrameReport, share: f64) {
        report.materials = self.table.materials_in_use();
        report.lights_assigned = self.lists.assigned;
        report.terms_shaded = self.lists.shaded;
        report.light_pairs = self.choosers.take_pairs();
        report.left_out = self.lists.left_out;
        report.terms_at_vertices = self.lists.at_vertices;
        report.terms_at_fragments = self.lists.at_fragments;
        report.steps_spent = self.lists.spent / share;
        report.choices_changed = self.lists.memory.changed;
    }

    /// Adds all objects, where `share` of a tolerance is left for the values.
    fn add_all(
        &mut self,
        shown: &ShownObjects,
        share: f64,
        shared: Shared,
        backend: &mut impl Backend,
        report: &mut FrameReport,
    ) {
        let (mut seen, mut clusters) = (Vec::new(), Vec::new());
        let mut without_environment = 0;
        for (number, object) in (0..).zip(shown.iter(shared.costs)) {
            without_environment += usize::from(object.lacks_environment);
            match self.lit_object(number, &object, shown, share, shared) {
                Ok(Some((lit, prices))) => {
                    let shared = Shared { prices, ..shared };
                    self.add(&lit, ((&mut seen, &mut clusters), || shown.boxes()), shared, backend, report);
                }
                Ok(None) => {}
                Err(source) => {
                    report.errors.push(RenderError::Invalid { entity: label(object.entity, object.name), source });
                }
            }
        }
        if without_environment > 0 {
            report.errors.push(RenderError::ImagesInEnvironment(without_environment));
        }
    }

    /// An object that is to be lit, and the prices of moving its terms; none while its mesh is not laid out.
    fn lit_object<'a>(
        &mut self,
        number: u32,
        object: &ShownObject<'a>,
        shown: &'a ShownObjects,
        share: f64,
        shared: Shared,
    ) -> Result<Option<(LitObject<'a>, VertexPrices)>, InvalidValue> {
        let &ShownObject { entity, mesh, reflecting, paint, blend, terms, mut tolerance, .. } = object;
        let &ShownObject { model_view, normal_matrix, .. } = object;
        if let Some(wrong) = &object.wrong_paint {
            return Err(wrong.clone());
        }
        let Some(geometry) = object.geometry(&shown.geometries) else { return Ok(None) };
        tell_ignored(&reflecting.maps, terms, paint.surrounded);
        let look = self.table.look(&reflecting);
        if let Some(invalid) = &look.invalid {
            return Err(invalid.clone());
        }
        tolerance.validate()?;
        tolerance.steps *= share as f32;
        // Nothing moves where nothing may change.
        let may_change = tolerance.steps > 0.0;
        let mut prices = if may_change { shared.prices } else { VertexPrices::NEVER };
        // Of what is shaded at the fragments, coarser patches may be as well at their corners. Of what is one patch,
        // few triangles are saved, and looking takes as long.
        let in_patches = geometry.source.triangle_count() > geometry.source.triangles_of_a_patch();
        let may_be_coarser = may_change && tolerance.pixels > 0.0 && in_patches && geometry.detail.has_levels;
        let is_by_fragments =
            terms == terms.map(|term| if term == Frequency::Never { term } else { Frequency::Fragment });
        let terms = if may_be_coarser && is_by_fragments && !blend && !paint.is_any() {
            prices = VertexPrices::NEVER;
            terms.map(|term| if term == Frequency::Fragment { Frequency::Auto } else { term })
        } else {
            terms
        };
        let tolerance = if blend { Tolerance { pixels: 0.0, ..tolerance } } else { tolerance };
        let circumstances =
            Circumstances { terms, blend, mirrored: model_view.mirrored, opposite_normals: geometry.opposite_normals };
        let key = reflecting.key(look, circumstances, Shared { prices, ..shared });
        let material = look.material;
        let sphere = geometry.detail.whole.sphere(model_view);
        // What the near plane cuts has corners of its own.
        let may_be_nearest = shared.costs.nearest_corner
            && key.terms == key.terms.map(|term| if term == Frequency::Never { term } else { Frequency::Auto })
            && !(blend || paint.is_any())
            && -sphere.0.z - sphere.1 > shared.view.projection.near;
        let lit = LitObject {
            entity,
            number,
            depth: -sphere.0.z,
            twins_before: if blend { 0 } else { self.table.twins_before(sphere) },
            reflecting,
            key,
            material,
            maps: object.maps().map_or(0, |maps| self.table.maps(&maps)),
            has_relief: paint.has_relief(),
            mesh,
            form: object.form(),
            geometry,
            model_view,
            normal_matrix,
            tolerance,
            corners: ShadedCorners::new(tolerance, may_be_nearest),
        };
        Ok(Some((lit, prices)))
    }

    /// Adds what is seen of an object: its patches, neighbours with equal light lists joined. `seen` and `clusters` are
    /// room for them; `boxes` are those around all visible objects.
    fn add<I: Iterator<Item = ObjectBox>>(
        &mut self,
        object: &LitObject,
        ((seen, clusters), boxes): ((&mut Vec<SeenPatch>, &mut Vec<Cluster>), impl Fn() -> I),
        shared: Shared,
        backend: &mut impl Backend,
        report: &mut FrameReport,
    ) {
        let LitObject { ref reflecting, ref key, geometry, model_view, normal_matrix, .. } = *object;
        let detail = &geometry.detail;
        report.triangles_in += geometry.source.triangle_count() as u64;
        self.instances.push(InstanceRecord::new(
            model_view,
            normal_matrix,
            reflecting.faces,
            shared.view.unit() as f32,
        ));
        if self.add_unchosen(object, shared, backend) {
            return;
        }
        let reflector = reflecting.reflector(key.terms);
        let Shared { lights, view, encoding, .. } = shared;
        let sight = Sight::new(model_view, view, reflecting.faces, &detail.whole);
        let demand = Demand {
            tolerance: object.tolerance,
            listed: Lists::new(lights.counts) == Lists::Listed,
            blinn_phong: key.blinn_phong,
            local_viewer: key.local_viewer,
            reflector: &reflector,
            lights,
            encoding,
            model_view,
            sphere: detail.whole.sphere(model_view),
            corners: object.corners,
            least: &detail.least,
            pixels_per_unit: detail.pixels_per_unit(&sight),
        };
        let allowed = if detail.has_levels { Allowed::new(demand) } else { Allowed::NOTHING };
        let steps = f64::from(object.tolerance.steps);
        let steps = steps - if allowed.is_nothing() { 0.0 } else { geometry_steps(object.tolerance) };
        // Where all lights are compiled in, no patch has lists.
        let admitted = if key.lists == Lists::Listed { *key } else { backend.admit(*key) };
        let coarser = CoarserObject { number: object.number, model_view, view, pixels: object.tolerance.pixels };
        let is_near = |patch: &Outline, error| self.near.is_near(&coarser, patch, error, &boxes);
        let has_lists = admitted.lists == Lists::Listed;
        let look = ObjectLook { sight: &sight, allowed: &allowed, corners: has_lists.then_some(object.corners) };
        let looked_at = detail.see(look, &mut self.choice, is_near, seen);
        report.patches += looked_at;
        // What is whole has been found to be seen, and is not counted.
        report.patches_culled += looked_at.saturating_sub(seen.len() as u32);
        if !has_lists {
            self.add_alike(object, seen, |_| &admitted, shared, backend);
            return;
        }
        // Light by light; else all terms of a patch are in one place.
        let is_placed = object.may_move(seen, &shared.prices);
        let compiled_in = (Lists::new(lights.counts) != Lists::Listed).then_some(lights.len());
        let staying = OnceLock::new();
        let reflector = &reflector;
        let clustering = object.clustering(&sight);
        let mut chooser = Chooser { object, shared, reflector, clustering, steps, compiled_in, placing: None, staying };
        chooser.placing = is_placed.then(|| chooser.listing(shared.prices));
        if is_placed && !self.pays(&chooser, (seen, clusters)) {
            chooser.placing = None;
        }
        if chooser.placing.is_some() || !self.add_in_place(&chooser, (seen, clusters), is_placed, backend) {
            self.add_listed(&chooser, seen, is_placed, backend);
        }
    }

    /// Adds what is seen of an object of which no patch has a list, each by its key.
    pub(super) fn add_alike<'k>(
        &mut self,
        object: &LitObject,
        seen: &[SeenPatch],
        key: impl Fn(&SeenPatch) -> &'k DrawKey,
        shared: Shared,
        backend: &mut impl Backend,
    ) {
        let mut run = None;
        let is_plain = !shared.false_colors && !seen.is_empty();
        let of_all = is_plain.then(|| self.table.number(&mut self.records, object.material, RecordLists::default()));
        for of_patch @ &SeenPatch { number, stretch, .. } in seen {
            let false_colored;
            let (key, record) = if let Some(record) = of_all {
                (key(of_patch), record)
            } else {
                false_colored = self.false_colored(object, number, *key(of_patch), None, backend);
                (&false_colored.0, false_colored.2)
            };
            let indices = object.geometry.detail.indices(number);
            self.go_on(object, &mut run, OpenRun { key, lights: 0, record, indices, stretch });
        }
        if let Some(run) = run {
            self.add_run(object, run);
        }
    }

    /// What draws a patch in the colour of its terms, in place of what would draw it by `key`: of so many at the
    /// vertices and at the fragments, or where the key has them.
    pub(super) fn false_colored(
        &mut self,
        object: &LitObject,
        patch: u32,
        key: DrawKey,
        terms: Option<[u64; 2]>,
        backend: &mut impl Backend,
    ) -> (DrawKey, u32, u32) {
        let [at_vertices, at_fragments] = terms.unwrap_or_else(|| {
            [by_vertex_shader(key.terms), by_fragment_shader(key.terms)].map(|terms| terms.map(u64::from).iter().sum())
        });
        let base = FalseColors::color(at_vertices, at_fragments, object.geometry.detail.is_coarser(patch));
        let side = MaterialRecord::plain(base);
        let colored = DrawRecord { front: side, back: side, ..DrawRecord::default() };
        if self.records.last() != Some(&colored) {
            self.records.push(colored);
        }
        let unpainted = DrawKey { colored: false, maps: MapLooks::default(), masked: false, ..key };
        let plain = DrawKey { solid: None, surrounded: false, ..unpainted };
        let key = backend.admit(DrawKey { blend: object.key.blend, ..plain.with_terms(Terms::NONE) });
        (key, 0, self.records.len() as u32 - 1)
    }

    /// Goes on with a run, or with another where the next patch is drawn otherwise.
    pub(super) fn go_on(&mut self, object: &LitObject, run: &mut Option<OpenRun<DrawKey>>, next: OpenRun<&DrawKey>) {
        match run {
            Some(run) if run.goes_on_with(&next) => run.indices.end = next.indices.end,
            _ => {
                if let Some(run) = run.replace(next.begun()) {
                    self.add_run(object, run);
                }
            }
        }
    }

    pub(super) fn add_run(
        &mut self,
        object: &LitObject,
        OpenRun { key, lights, record, indices, .. }: OpenRun<DrawKey>,
    ) {
        let LitObject { depth, twins_before, maps, .. } = *object;
        let mut add = |pass, key: DrawKey| {
            let call = self.table.call((key, object.mesh, object.form, if key.is_mapped() { maps } else { 0 }));
            let indices = (indices.start, indices.end);
            let instance = self.instances.len() as u32 - 1;
            let blend = key.blend;
            self.runs.push(LitRun { blend, call, pass, twins_before, indices, lights, record, depth, instance });
        };
        if key.blend {
            for (pass, key) in (0..).zip(key.passes()) {
                add(pass, key);
            }
        } else {
            add(0, key);
        }
    }
}
