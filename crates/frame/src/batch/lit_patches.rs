//! Illuminate: the patches of each object that may show, with its material and the lights that each needs.

use crate::batch::backend::Backend;
use crate::batch::ignored::log_ignored;
use crate::batch::key::DrawKey;
use crate::batch::lit_runs::{LitRun, OpenRun, most_between};
use crate::batch::object::{Circumstances, Shared};
use crate::batch::shown_objects::{ShownObject, ShownObjects};
use crate::batch::table::ObjectTable;
use crate::error::{RenderError, label};
use crate::geometry::meshes::{Form, Geometry, shades_pixels_alone};
use crate::geometry::outlines::Sight;
use crate::geometry::patches::DetailDemand;
use crate::geometry::shape::{PatchNormals, PatchShape};
use crate::lights::gather::Lights;
use crate::lights::lists::LightLists;
use crate::lights::slots::Lists;
use crate::report::FrameReport;
use crate::values::FrameValues;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use halfway_lighting::bounds::Patch;
use halfway_lighting::record::{InstanceRecord, SurfaceRecord};
use halfway_lighting::{InvalidValue, Tolerance};

/// The patches that may show, in the order of the objects. Holds after
/// [`RenderSet::Illuminate`](crate::sets::RenderSet::Illuminate).
#[derive(Resource, Debug, Default)]
pub struct LitPatches {
    pub(crate) runs: Vec<LitRun>,
    /// The matrices of each object that has runs.
    pub instances: Vec<InstanceRecord>,
    /// Materials with their lights.
    pub records: Vec<SurfaceRecord>,
    /// The light lists.
    pub lists: LightLists,
    /// The distinct materials and images of the objects.
    pub table: ObjectTable,
    /// The numbers of the object's patches that may show. Its memory is kept.
    seen: Vec<u32>,
}

/// An object whose patches are being lit.
struct LitObject<'a> {
    shown: &'a ShownObject<'a>,
    key: DrawKey,
    material: u32,
    depth: f32,
    twins_before: u32,
    maps: u32,
    form: Form,
    geometry: &'a Geometry,
    tolerance: Tolerance,
}

/// Selects the visible patches of each object, with their light lists and records.
pub fn illuminate<B: Backend + Resource<Mutability = Mutable>>(
    objects: ShownObjects,
    lights: Res<Lights>,
    values: Res<FrameValues>,
    mut backend: ResMut<B>,
    mut lit: ResMut<LitPatches>,
    mut report: ResMut<FrameReport>,
) {
    lit.begin(&lights);
    let view = &objects.view;
    let (Some(camera), Some(values)) = (&view.camera, values.0) else { return };
    let shared = Shared { lights: &lights, view, encoding: values.encoding(), eye: camera.eye() };
    lit.add_all(&objects, values.share(), shared, &mut *backend, &mut report);
    report.materials = lit.table.materials_in_use();
    report.lights_assigned = lit.lists.assigned;
    report.light_pairs = lit.lists.pairs;
    report.left_out = lit.lists.left_out;
}

impl LitPatches {
    fn begin(&mut self, lights: &Lights) {
        self.runs.clear();
        self.instances.clear();
        self.records.clear();
        self.lists.begin(lights);
        self.table.begin(lights.ambient);
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
        let mut without_environment = 0;
        for object in shown.iter(backend.lights_images_by_environments()) {
            without_environment += usize::from(object.lacks_environment);
            match self.lit_object(&object, shown, share, shared) {
                Ok(Some(lit)) => self.add(&lit, shared, backend, report),
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

    /// An object that is to be lit; `None` while its mesh is not laid out.
    fn lit_object<'a>(
        &mut self,
        object: &'a ShownObject<'a>,
        shown: &'a ShownObjects,
        share: f64,
        shared: Shared,
    ) -> Result<Option<LitObject<'a>>, InvalidValue> {
        let &ShownObject { reflecting, paint, terms, model_view, mut tolerance, .. } = object;
        if let Some(wrong) = &object.wrong_paint {
            return Err(wrong.clone());
        }
        let Some(geometry) = object.geometry(&shown.geometries) else { return Ok(None) };
        log_ignored(&reflecting.maps, terms, paint.surrounded);
        let look = self.table.look(&reflecting);
        if let Some(invalid) = &look.invalid {
            return Err(invalid.clone());
        }
        tolerance.validate()?;
        tolerance.steps *= share as f32;
        let circumstances = Circumstances {
            terms,
            blend: paint.blend,
            mirrored: model_view.mirrored,
            opposite_normals: geometry.opposite_normals,
        };
        let key = reflecting.key(look, circumstances, shared);
        let material = look.material;
        let sphere = geometry.patches.whole.sphere(model_view);
        Ok(Some(LitObject {
            shown: object,
            key,
            material,
            depth: -sphere.0.z,
            twins_before: if paint.blend { 0 } else { self.table.twins_before(sphere) },
            maps: object.maps().map_or(0, |maps| self.table.maps(&maps)),
            form: object.form(),
            geometry,
            tolerance,
        }))
    }

    /// Adds the patches of an object that may show. Neighbours with equal light lists are joined.
    fn add(&mut self, object: &LitObject, shared: Shared, backend: &mut impl Backend, report: &mut FrameReport) {
        let patches = &object.geometry.patches;
        report.triangles_in += object.geometry.source.triangle_count() as u64;
        self.instances.push(InstanceRecord::new(
            &object.shown.model_view.eye_from_model,
            object.shown.normal_matrix.0,
            object.shown.reflecting.faces,
            shared.view.unit() as f32,
        ));
        let mut seen = std::mem::take(&mut self.seen);
        let sight = Sight::new(object.shown.model_view, shared.view, object.shown.reflecting.faces, &patches.whole);
        let demand = DetailDemand {
            pixels: if shades_pixels_alone(object.shown.terms) { object.tolerance.pixels } else { 0.0 },
            lit: object.key.is_lit() || object.key.surrounded,
            has_images: object.key.is_mapped(),
        };
        let culled_from = patches.see(&sight, demand, &mut seen) as u32;
        report.patches += culled_from;
        report.patches_culled += culled_from.saturating_sub(seen.len() as u32);
        let key = backend.admit(object.key);
        if key.lists == Lists::Listed {
            self.add_listed(object, &key, &seen, shared);
        } else if !seen.is_empty() {
            let record = self.table.number(&mut self.records, object.material, self.lists.few);
            self.add_runs(object, &key, seen.iter().map(|&patch| (patch, record)));
        }
        self.seen = seen;
    }

    /// Adds patches, each with the lists of its lights.
    fn add_listed(&mut self, object: &LitObject, key: &DrawKey, seen: &[u32], shared: Shared) {
        let Shared { lights, encoding, eye, .. } = shared;
        let reflector = object.shown.reflecting.reflector(object.key.terms);
        // A color may be black: then there is no ambient light that could hide what is left out. None is above 1.
        let ambient = if object.key.is_painted() { Vec3::ZERO } else { lights.ambient };
        let steps = f64::from(object.tolerance.steps);
        let listing = reflector.listing(ambient, eye, encoding, steps);
        let mut records = Vec::with_capacity(seen.len());
        for patch in seen {
            let patch = object.in_eye_space(object.geometry.patches.shape(*patch));
            let listed = self.lists.list(lights, &patch, &listing);
            records.push(self.table.number(&mut self.records, object.material, listed));
        }
        self.add_runs(object, key, seen.iter().copied().zip(records));
    }

    /// Adds patches, each with the number of its record.
    fn add_runs(&mut self, object: &LitObject, key: &DrawKey, patches: impl Iterator<Item = (u32, u32)>) {
        let most_between = most_between(object.geometry.patches.has_levels());
        let mut run: Option<OpenRun> = None;
        for (patch, record) in patches {
            let next = OpenRun { record, indices: object.geometry.patches.indices(patch) };
            match &mut run {
                Some(run) if run.goes_on_with(&next, most_between) => run.indices.end = next.indices.end,
                _ => {
                    if let Some(run) = run.replace(next) {
                        self.add_run(object, key, run);
                    }
                }
            }
        }
        if let Some(run) = run {
            self.add_run(object, key, run);
        }
    }

    fn add_run(&mut self, object: &LitObject, key: &DrawKey, OpenRun { record, indices }: OpenRun) {
        let LitObject { depth, twins_before, maps, .. } = *object;
        for (pass, key) in (0..).zip(key.passes()) {
            let call = self.table.call((key, object.shown.mesh, object.form, if key.is_mapped() { maps } else { 0 }));
            let indices = (indices.start, indices.end);
            let instance = self.instances.len() as u32 - 1;
            let blend = key.blend;
            self.runs.push(LitRun { blend, call, pass, twins_before, indices, record, depth, instance });
        }
    }
}

impl LitObject<'_> {
    /// A patch of it in eye space.
    fn in_eye_space(&self, shape: &PatchShape) -> Patch<f32> {
        let normals = if self.form.flat { PatchNormals::Faces } else { PatchNormals::Vertices };
        let patch =
            shape.in_eye_space(self.shown.model_view, self.shown.normal_matrix, self.shown.reflecting.faces, normals);
        // Images may turn normals anywhere.
        if self.shown.paint.has_relief() && !self.form.flat {
            Patch { normals: None, half_thickness: f32::INFINITY, ..patch }
        } else {
            patch
        }
    }
}
