//! Illuminate: what is seen of each object, patch by patch, with its material and the lights that it needs.

use crate::batch::backend::Backend;
use crate::batch::false_colors::FalseColors;
use crate::batch::ignored::tell_ignored;
use crate::batch::key::{DrawKey, MapLooks};
use crate::batch::lit_object::LitObject;
use crate::batch::lit_runs::{LitRun, OpenRun};
use crate::batch::object::{Circumstances, Shared};
use crate::batch::painted::{PaintedObject, Paints};
use crate::batch::shown_objects::{ShownObject, ShownObjects};
use crate::batch::sources::{FrameSources, Sources};
use crate::batch::table::ObjectTable;
use crate::device::costs::VertexPrices;
use crate::error::{RenderError, label};
use crate::frame::report::FrameReport;
use crate::geometry::allowed::{Allowed, Demand, geometry_steps};
use crate::geometry::detail::Choice;
use crate::geometry::near_objects::{CoarserObject, NearObjects, ObjectBox};
use crate::geometry::patches::{MeshPatch, Sight};
use crate::lights::gains::Extent;
use crate::lights::gather::Lights;
use crate::lights::lists::{LightLists, Listing};
use crate::lights::memory::{ChosenBy, choosing};
use crate::lights::places::{ShadedAt, Spending};
use crate::lights::profit::Profit;
use crate::lights::terms::{by_fragment_shader, by_vertex_shader};
use crate::shaders::light_slots::Lists;
use crate::shaders::records::{DrawRecord, InstanceRecord, MaterialRecord, RecordLists};
use crate::target::frame::FrameValues;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use halfway_lighting::{InvalidValue, Terms, Tolerance, equations};

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
    choice: Choice,
    near: NearObjects,
    paints: Paints,
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
        lit.begin(&lights, lights.is_changed());
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
    lit.begin(&lights, lights.is_changed());
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

/// A patch that is drawn, and its stretch: see [`Detail::each_seen`](crate::geometry::detail::Detail::each_seen).
pub(super) type SeenPatch<'a> = (&'a MeshPatch, u32);

impl LitPatches {
    fn begin(&mut self, lights: &Lights, changed: bool) {
        self.runs.clear();
        self.instances.clear();
        self.records.clear();
        self.lists.begin(lights, changed);
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
        report.light_pairs = self.lists.take_pairs();
        report.left_out = self.lists.left_out;
        report.terms_at_vertices = self.lists.placed.at_vertices;
        report.terms_at_fragments = self.lists.placed.at_fragments;
        report.steps_spent = self.lists.placed.spent / share;
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
        let mut seen = Vec::new();
        let mut without_environment = 0;
        for (number, object) in (0..).zip(shown.iter(shared.costs)) {
            without_environment += usize::from(object.lacks_environment);
            match self.lit_object(number, &object, shown, share, shared) {
                Ok(Some((lit, prices))) => {
                    let shared = Shared { prices, ..shared };
                    self.add(&lit, (&mut seen, || shown.boxes()), shared, backend, report);
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
        let prices = if tolerance.steps > 0.0 { shared.prices } else { VertexPrices::NEVER };
        let circumstances =
            Circumstances { terms, blend, mirrored: model_view.mirrored, opposite_normals: geometry.opposite_normals };
        let key = reflecting.key(look, circumstances, Shared { prices, ..shared });
        let material = look.material;
        let sphere = geometry.detail.whole.sphere(model_view);
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
            tolerance: if blend { Tolerance { pixels: 0.0, ..tolerance } } else { tolerance },
        };
        Ok(Some((lit, prices)))
    }

    /// Adds what is seen of an object: its patches, neighbours with equal light lists joined. `seen` is room for them;
    /// `boxes` are those around all visible objects.
    fn add<'a, I: Iterator<Item = ObjectBox>>(
        &mut self,
        object: &LitObject<'a>,
        (seen, boxes): (&mut Vec<SeenPatch<'a>>, impl Fn() -> I),
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
        };
        let allowed = if detail.has_levels() { Allowed::new(demand) } else { Allowed::NOTHING };
        let steps = f64::from(object.tolerance.steps);
        let steps = steps - if allowed.is_nothing() { 0.0 } else { geometry_steps(object.tolerance) };
        let sight = Sight::new(model_view, view, reflecting.faces, &detail.whole);
        // Where all lights are compiled in, no patch has lists.
        let admitted = if key.lists == Lists::Listed { *key } else { backend.admit(*key) };
        let compiled_in = (Lists::new(lights.counts) != Lists::Listed).then_some(lights.records.len());
        let is_listed = admitted.lists == Lists::Listed;
        let make_listing = |prices| {
            let eye = equations::Eye::in_eye_space(shared.viewer);
            let spending = Spending { encoding, steps, prices, compiled_in };
            // A color may be black: then there is no ambient light that could hide what is left out. None is above 1.
            let ambient = if key.is_painted() { Vec3::ZERO } else { shared.lights.ambient };
            reflector.listing(reflecting.faces, ambient, eye, spending)
        };
        seen.clear();
        let coarser = CoarserObject { number: object.number, model_view, view, pixels: object.tolerance.pixels };
        let is_near = |patch: &MeshPatch, error| self.near.is_near(&coarser, patch, error, &boxes);
        let add_seen = |patch, stretch| seen.push((patch, stretch));
        let looked_at = detail.each_seen(&allowed, &sight, &mut self.choice, is_near, add_seen);
        report.patches += looked_at;
        // What is whole has been found to be seen, and is not counted.
        report.patches_culled += looked_at.saturating_sub(seen.len() as u32);
        // Light by light; else all terms of a patch are in one place.
        let is_placed = is_listed && object.may_move(seen, &shared.prices);
        let placing = is_placed.then(|| make_listing(shared.prices));
        let placing = placing.filter(|placing| self.pays(object, seen, placing, &sight, (shared, compiled_in)));
        let prices = if placing.is_some() { &shared.prices } else { &VertexPrices::NEVER };
        // Of what does not move lights that are left out may take all of the tolerance.
        let mut staying = None;
        let mut painted = (is_listed && !reflecting.maps.is_empty()).then(|| self.take_painted(object, shared));
        let mut run: Option<OpenRun> = None;
        for together in seen.chunks(TOGETHER) {
            let mut has_looked_around = false;
            for &(patch, stretch) in together {
                let (key, lights, lists, has_list) = if is_listed {
                    let place = object.place(patch, &sight, (prices, compiled_in), &self.lists.memory);
                    if is_placed && place.0 == ShadedAt::Fragments {
                        self.lists.memory.note_at_fragments(object.name(patch));
                    }
                    if let Some(key) = self.unlisted(object, place.0, shared, backend) {
                        (key, 0, RecordLists::default(), false)
                    } else {
                        let listing = match &placing {
                            Some(placing) if place.0 == ShadedAt::Either => placing,
                            _ => staying.get_or_insert_with(|| make_listing(VertexPrices::NEVER)),
                        };
                        if !has_looked_around {
                            // With the smaller tolerance of both.
                            let listing = placing.as_ref().unwrap_or(listing);
                            self.lists.look_around(listing, together.iter().map(|(patch, _)| patch.sphere(model_view)));
                            has_looked_around = true;
                        }
                        let lit = self.lit(object, (patch, place), painted.as_mut(), listing, shared, backend);
                        (lit.0, lit.1, lit.2, true)
                    }
                } else {
                    (admitted, 0, RecordLists::default(), false)
                };
                let (key, lights, record) = if shared.false_colors {
                    self.false_colored(object, patch, key, has_list, backend)
                } else {
                    (key, lights, self.table.number(&mut self.records, object.material, lists))
                };
                let next = OpenRun { key, lights, record, indices: patch.indices.clone(), stretch };
                match &mut run {
                    Some(run) if run.goes_on_with(&next) => run.indices.end = next.indices.end,
                    _ => {
                        if let Some(run) = run.replace(next) {
                            self.add_run(object, run);
                        }
                    }
                }
            }
        }
        if let Some(run) = run {
            self.add_run(object, run);
        }
        if let Some(painted) = painted {
            self.paints.keep((object.mesh, object.form), painted);
        }
    }

    /// What is known of the images on an object.
    fn take_painted(&mut self, object: &LitObject, shared: Shared) -> PaintedObject {
        let of = (object.mesh, object.form, object.geometry);
        let maps = self.table.maps[object.maps as usize - 1];
        self.paints.take(of, object.reflecting.maps, &maps, shared.textures)
    }

    /// What draws a patch in the colour of its terms, in place of what would draw it by `key`.
    fn false_colored(
        &mut self,
        object: &LitObject,
        patch: &MeshPatch,
        key: DrawKey,
        has_list: bool,
        backend: &mut impl Backend,
    ) -> (DrawKey, u32, u32) {
        let [at_vertices, at_fragments] = if has_list {
            self.lists.placed.terms()
        } else {
            [by_vertex_shader(key.terms), by_fragment_shader(key.terms)].map(|terms| terms.map(u64::from).iter().sum())
        };
        let base = FalseColors::color(at_vertices, at_fragments, patch.longest_edge.is_finite());
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

    /// The key that draws a patch, the lights that are bound for it, and its lists.
    fn lit(
        &mut self,
        object: &LitObject,
        (patch, place): (&MeshPatch, (ShadedAt, Extent)),
        painted: Option<&mut PaintedObject>,
        listing: &Listing,
        shared: Shared,
        backend: &mut impl Backend,
    ) -> (DrawKey, u32, RecordLists) {
        let LitObject { key, .. } = object;
        let paint = painted.map(|painted| painted.of(object.geometry, patch));
        let gain = object.placed(patch, place, paint.as_ref(), |placed| {
            self.lists.select(shared.lights, placed, listing, key.terms)
        });
        if listing.places.is_some() && place.0 == ShadedAt::Either {
            self.lists.note(object.name(patch));
            self.profit.add(gain);
        }
        if gain < 0.0
            && let Some(key) = self.unlisted(object, ShadedAt::Fragments, shared, backend)
        {
            return (key, 0, RecordLists::default());
        }
        self.lists.count();
        let key = key.with_terms(self.lists.terms(key.terms));
        if !key.is_lit() {
            return (backend.admit(key), 0, RecordLists::default());
        }
        let key = if shared.costs.lights_at_fixed_places
            && key.lists == Lists::Listed
            && let Some(bound) = self.lists.bind(shared.lights, key.terms, key.takes_powers())
        {
            let counted = DrawKey { lists: bound.lists, ..key.with_terms(bound.terms) };
            if backend.admit(counted) == counted {
                self.lists.count_bound(bound);
                return (counted, bound.start, RecordLists::default());
            }
            // One with lists that is not generic either would take up room and time of those that are to draw.
            key.generic()
        } else {
            backend.admit(key)
        };
        (key, 0, self.lists.list(shared.lights))
    }

    pub(super) fn add_run(&mut self, object: &LitObject, OpenRun { key, lights, record, indices, .. }: OpenRun) {
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

/// The number of neighbouring patches that look for their lights together.
const TOGETHER: usize = 32;
