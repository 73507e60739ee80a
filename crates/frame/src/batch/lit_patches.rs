//! Illuminate: the patches of each object that may show, with its material and the lights that each needs.

use crate::batch::backend::Backend;
use crate::batch::key::DrawKey;
use crate::batch::lit_looks::{LitLook, LitLooks};
use crate::batch::lit_runs::{LitRun, OpenRun, most_between};
use crate::batch::object::Shared;
use crate::batch::shown_objects::ShownObjects;
use crate::batch::table::{ObjectTable, RunState};
use crate::batch::twins::Twins;
use crate::error::{RenderError, label};
use crate::geometry::outlines::Sight;
use crate::lights::gather::Lights;
use crate::lights::lists::LightLists;
use crate::lights::slots::Lists;
use crate::report::FrameReport;
use crate::values::{FrameValues, PixelValues};
use crate::view::camera::View;
use crate::view::looks::{Look, LookBits, Looks};
use crate::view::matrices::{Matrices, MatricesOf, ModelView, NormalMatrix, make_anew};
use crate::view::select::Selected;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use halfway_lighting::record::{InstanceRecord, SurfaceRecord};

/// The patches that may show, in the order of the objects. Holds after
/// [`RenderSet::Illuminate`](crate::sets::RenderSet::Illuminate).
#[derive(Resource, Debug, Default)]
pub struct LitPatches {
    /// Of opaque objects.
    pub(crate) opaque: Vec<LitRun>,
    pub(crate) blended: Vec<LitRun>,
    /// The matrices of each object that has runs.
    pub instances: Vec<InstanceRecord>,
    /// Materials with their lights.
    pub records: Vec<SurfaceRecord>,
    /// The light lists.
    pub lists: LightLists,
    /// The distinct materials and images of the objects.
    pub table: ObjectTable,
    /// The bounding spheres of opaque objects.
    twins: Twins,
    /// Everything that objects with the same components share. Its memory is kept.
    looks: LitLooks,
    /// The numbers of the object's patches that may show. Its memory is kept.
    seen: Vec<u32>,
    /// All that it is made of beside the objects; `None` where some were left out with an error, which is told anew in
    /// each frame.
    made_of: Option<MadeOf>,
    /// The number of the frame that it is of.
    pub(crate) frame: u64,
    /// Whether it is that of the frame before.
    pub(crate) stands: bool,
    counts: Counts,
}

/// Inputs of a frame beside its objects and lights.
#[derive(Debug, PartialEq)]
struct MadeOf {
    view: View,
    values: PixelValues,
    has_environment: bool,
    /// The numbers of meshes laid out and forgotten.
    meshes: [u64; 2],
}

/// The counts of a frame that tell of it.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    triangles_in: u64,
    patches: u32,
    patches_culled: u32,
}

/// The place of an object, and how it is drawn there.
struct Placed<'a> {
    model_view: &'a ModelView,
    normal_matrix: &'a NormalMatrix,
    key: DrawKey,
    depth: f32,
    instance: u32,
}

/// The components that say where an object is, and the number of its look.
pub(crate) type Places = (&'static mut Look, &'static ModelView, &'static NormalMatrix);

/// Selects the visible patches of each object, with their light lists and records.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub fn illuminate<B: Backend + Resource<Mutability = Mutable>>(
    objects: ShownObjects,
    mut places: ParamSet<(Query<Places>, Query<Matrices>)>,
    lights: Res<Lights>,
    (values, selected, mut matrices_of): (Res<FrameValues>, Res<Selected>, ResMut<MatricesOf>),
    mut looks: ResMut<Looks>,
    mut backend: ResMut<B>,
    mut lit: ResMut<LitPatches>,
    mut report: ResMut<FrameReport>,
) {
    let view = &objects.view;
    let (Some(camera), Some(values)) = (&view.camera, values.0) else {
        lit.begin(&lights);
        lit.made_of = None;
        return;
    };
    let made_of = MadeOf {
        view: (**view).clone(),
        values,
        has_environment: objects.surroundings.are_there(),
        meshes: [objects.geometries.laid_out, objects.geometries.forgotten],
    };
    lit.stands = selected.stands
        && lit.frame + 1 == selected.frame
        && lit.made_of.as_ref() == Some(&made_of)
        && !lights.is_changed()
        && backend.is_settled();
    lit.frame = selected.frame;
    if !lit.stands {
        lit.begin(&lights);
        let shared = Shared {
            lights: &lights,
            view,
            encoding: values.encoding(),
            eye: camera.eye(),
            unit: view.unit() as f32,
            share: values.share(),
        };
        let errors = report.errors.len();
        if std::mem::replace(&mut matrices_of.0, view.epoch) != view.epoch {
            make_anew(view, objects.visible(), places.p1());
        }
        lit.add_all(&objects, (&mut places.p0(), &mut looks), shared, &mut *backend, &mut report.errors);
        lit.made_of = (report.errors.len() == errors).then_some(made_of);
    }
    lit.report(&mut report);
}

impl LitPatches {
    fn report(&self, report: &mut FrameReport) {
        let Counts { triangles_in, patches, patches_culled } = self.counts;
        report.triangles_in += triangles_in;
        report.patches += patches;
        report.patches_culled += patches_culled;
        report.materials = self.table.materials_in_use();
        report.lights_assigned = self.lists.assigned;
        report.light_pairs = self.lists.pairs;
        report.left_out = self.lists.left_out;
    }

    fn begin(&mut self, lights: &Lights) {
        self.opaque.clear();
        self.blended.clear();
        self.instances.clear();
        self.records.clear();
        self.lists.begin(lights);
        self.table.begin(lights.ambient);
        self.looks.clear();
        self.twins.clear();
        self.counts = Counts::default();
        self.stands = false;
    }

    /// Adds all objects.
    fn add_all(
        &mut self,
        shown: &ShownObjects,
        (places, numbers): (&mut Query<Places>, &mut Looks),
        shared: Shared,
        backend: &mut impl Backend,
        errors: &mut Vec<RenderError>,
    ) {
        let mut without_environment = 0;
        let mut looks = std::mem::take(&mut self.looks);
        for &entity in shown.visible() {
            let Ok((mut number, model_view, normal_matrix)) = places.get_mut(entity) else { continue };
            let known = numbers.known(*number);
            if let Some(look) = known.and_then(|known| looks.of_number(known)) {
                self.add(look, (model_view, normal_matrix), shared, backend);
                continue;
            }
            let Some(object) = shown.get(entity, backend.lights_images_by_environments()) else { continue };
            without_environment += usize::from(object.lacks_environment);
            match LitLook::new(&object, shown, shared, &mut self.table) {
                Ok(Some(mut look)) => {
                    self.add(&mut look, (model_view, normal_matrix), shared, backend);
                    let found = |surface| numbers.number(number.bypass_change_detection(), LookBits::new(surface));
                    if let Some(number) = known.or_else(|| object.surface.map(found)) {
                        looks.add(number, look);
                    }
                }
                Ok(None) => {}
                Err(source) => {
                    errors.push(RenderError::Invalid { entity: label(object.entity, object.name), source });
                }
            }
        }
        self.tell_twins_apart();
        numbers.used = looks.len();
        self.looks = looks;
        if without_environment > 0 {
            errors.push(RenderError::ImagesInEnvironment(without_environment));
        }
    }

    /// Adds the patches of an object that may show. Neighbours with equal light lists are joined.
    fn add(
        &mut self,
        look: &mut LitLook,
        (model_view, normal_matrix): (&ModelView, &NormalMatrix),
        shared: Shared,
        backend: &mut impl Backend,
    ) {
        self.counts.triangles_in += look.triangles;
        let instance = self.instances.len() as u32;
        let record = InstanceRecord::new(&model_view.eye_from_model, normal_matrix.0, look.faces, shared.unit);
        self.instances.push(record);
        let sphere = look.patches.whole.sphere(model_view);
        if !look.key.blend {
            self.twins.add(instance, sphere);
        }
        let placed = Placed {
            model_view,
            normal_matrix,
            key: look.admitted(model_view.mirrored, backend),
            depth: -sphere.0.z,
            instance,
        };
        let mut seen = std::mem::take(&mut self.seen);
        let sight = || Sight::new(model_view, shared.view, look.faces, &look.patches.whole);
        let culled_from = look.patches.see(sight, look.demand, &mut seen) as u32;
        self.counts.patches += culled_from;
        self.counts.patches_culled += culled_from.saturating_sub(seen.len() as u32);
        if placed.key.lists == Lists::Listed {
            self.add_listed(look, &placed, &seen, shared);
        } else if !seen.is_empty() {
            let record = self.table.number(&mut self.records, look.material, self.lists.few);
            self.add_runs(look, &placed, seen.iter().map(|&patch| (patch, record)));
        }
        self.seen = seen;
    }

    /// Adds patches, each with the lists of its lights.
    fn add_listed(&mut self, look: &mut LitLook, placed: &Placed, seen: &[u32], shared: Shared) {
        let mut records = Vec::with_capacity(seen.len());
        for patch in seen {
            let patch = look.in_eye_space(*patch, placed.model_view, placed.normal_matrix);
            let listed = self.lists.list(shared.lights, &patch, look.listing(shared));
            records.push(self.table.number(&mut self.records, look.material, listed));
        }
        self.add_runs(look, placed, seen.iter().copied().zip(records));
    }

    /// Adds patches, each with the number of its record.
    fn add_runs(&mut self, look: &mut LitLook, placed: &Placed, patches: impl Iterator<Item = (u32, u32)>) {
        let most_between = most_between(look.patches.has_levels());
        let mut run: Option<OpenRun> = None;
        for (patch, record) in patches {
            let next = OpenRun { record, indices: look.patches.indices(patch) };
            match &mut run {
                Some(run) if run.goes_on_with(&next, most_between) => run.indices.end = next.indices.end,
                _ => {
                    if let Some(run) = run.replace(next) {
                        self.add_run(look, placed, &run);
                    }
                }
            }
        }
        if let Some(run) = run {
            self.add_run(look, placed, &run);
        }
    }

    fn add_run(&mut self, look: &mut LitLook, placed: &Placed, OpenRun { record, indices }: &OpenRun) {
        let &Placed { key, depth, instance, model_view, .. } = placed;
        let states = look.states(model_view.mirrored, (indices.start, indices.end), &mut self.table);
        for (pass, &state) in (0..).zip(states) {
            let runs = if key.blend { &mut self.blended } else { &mut self.opaque };
            runs.push(LitRun { state, pass, record: *record, depth, instance });
        }
    }

    /// Tells apart the runs of opaque objects that may coincide, so that the first is drawn first and wins.
    fn tell_twins_apart(&mut self) {
        let twins = self.twins.find();
        if twins.is_empty() {
            return;
        }
        for run in &mut self.opaque {
            if let Some(&twins_before) = twins.get(&run.instance) {
                let state = RunState { twins_before, ..self.table.states[run.state as usize] };
                run.state = self.table.state(state);
            }
        }
    }
}
