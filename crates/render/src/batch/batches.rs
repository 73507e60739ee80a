//! Batch: visible objects become sorted, instanced draws.

use crate::batch::draws::{DrawState, Draws};
use crate::batch::object::{Drawn, Reflecting, Shared};
use crate::batch::table::Table;
use crate::batch::terms::Chosen;
use crate::device::gpu::Gpu;
use crate::error::{RenderError, label};
use crate::frame::report::FrameReport;
use crate::geometry::detail::{Demand, LevelsOfDetail};
use crate::geometry::meshes::{Form, Geometries, Geometry};
use crate::geometry::patches::Patch;
use crate::lights::gather::Lights;
use crate::lights::lists::LightLists;
use crate::pipelines::cache::Pipelines;
use crate::pipelines::key::PipelineKey;
use crate::shaders::light_slots::Lists;
use crate::shaders::records::{DrawRecord, InstanceRecord, RecordLists};
use crate::target::frame::Target;
use crate::view::camera::View;
use crate::view::matrices::{ModelView, NormalMatrix, Visible};
use bevy_asset::AssetId;
use bevy_ecs::prelude::*;
use halfway_lighting::{BackMaterial, Blend, Faces, Material, Reflectance, equations};
use halfway_mesh::{Mesh, Mesh3d};
use std::ops::Range;

/// The frame's draws. Holds after [`RenderSet::Batch`](crate::RenderSet::Batch).
#[derive(Resource, Debug, Default)]
pub(crate) struct Batches {
    pub(crate) instances: Vec<InstanceRecord>,
    pub(crate) records: Vec<DrawRecord>,
    pub(crate) lists: LightLists,
    pub(crate) draws: Draws,
    items: Vec<Item>,
    /// The instances of the items, before sorting.
    unsorted: Vec<InstanceRecord>,
    table: Table,
}

/// One object's draw, or one patch's, before sorting.
#[derive(Clone, Copy, Debug)]
struct Item {
    blend: bool,
    call: u32,
    indices: (u32, u32),
    lights: u32,
    record: u32,
    /// Distance of the centre along the view; nearer opaque objects first, farther blended ones first.
    depth: f32,
    /// Among the unsorted ones.
    instance: u32,
}

type Objects<'w, 's> = Query<
    'w,
    's,
    (
        &'static Mesh3d,
        Option<&'static Material>,
        Option<&'static BackMaterial>,
        Option<&'static Reflectance>,
        Option<&'static Faces>,
        Has<Blend>,
        &'static ModelView,
        &'static NormalMatrix,
        &'static Chosen,
        Option<&'static Name>,
    ),
>;

#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn batch(
    gpu: Res<Gpu>,
    objects: Objects,
    geometries: Res<Geometries>,
    visible: Res<Visible>,
    view: Res<View>,
    lights: Res<Lights>,
    allowed: Res<LevelsOfDetail>,
    target: Res<Target>,
    mut pipelines: ResMut<Pipelines>,
    mut batches: ResMut<Batches>,
    mut report: ResMut<FrameReport>,
) {
    let batches = &mut *batches;
    batches.begin(&lights, gpu.multi_draw());
    let (Some(camera), Some(frame)) = (&view.camera, &target.frame) else { return };
    let shared =
        Shared { lights: &lights, allowed: &allowed, frame, viewer: camera.viewer, software: gpu.is_software() };
    for &entity in &visible.0 {
        let Ok((mesh, material, back, reflectance, faces, blend, model_view, normal_matrix, chosen, name)) =
            objects.get(entity)
        else {
            continue;
        };
        let form = Form::new(*chosen, blend);
        let Some(geometry) = geometries.get(mesh.0.id(), form) else { continue };
        let material = material.unwrap_or(&Material::DEFAULT);
        let reflecting = Reflecting {
            front: material,
            back: back.map_or(material, |back| &back.0),
            reflectance: reflectance.copied().unwrap_or(view.reflectance),
            faces: faces.copied().unwrap_or_default(),
        };
        let look = batches.table.look(&reflecting);
        if let Some(source) = &look.invalid {
            report.errors.push(RenderError::Invalid { entity: label(entity, name), source: source.clone() });
            continue;
        }
        let drawn = Drawn {
            chosen: *chosen,
            blend,
            mirrored: model_view.mirrored,
            opposite_normals: geometry.opposite_normals,
        };
        let key = reflecting.key(look, drawn, shared);
        let (material, exponent) = (look.material, look.exponent);
        let object = Object {
            reflecting,
            key,
            material,
            exponent,
            mesh: mesh.0.id(),
            form,
            geometry,
            model_view,
            normal_matrix,
        };
        batches.add(&object, &view, shared, &mut pipelines, &mut report);
    }
    report.materials = batches.table.materials_in_use();
    report.lights_assigned = batches.lists.assigned;
    report.terms_shaded = batches.lists.shaded;
    report.left_out = batches.lists.left_out;
    batches.emit(records_of_one_command(shared.software), &mut pipelines);
    report.draws = batches.draws.command_count() as u32;
}

/// An object on its way into the draws.
struct Object<'a> {
    reflecting: Reflecting<'a>,
    /// The pipeline that fits best.
    key: PipelineKey,
    material: u32,
    exponent: f32,
    mesh: AssetId<Mesh>,
    form: Form,
    geometry: &'a Geometry,
    model_view: &'a ModelView,
    normal_matrix: &'a NormalMatrix,
}

impl Batches {
    fn begin(&mut self, lights: &Lights, multi_draw: Option<u32>) {
        self.instances.clear();
        self.records.clear();
        self.lists.begin(lights);
        self.draws.begin(multi_draw);
        self.items.clear();
        self.unsorted.clear();
        self.table.begin(lights.ambient);
    }

    /// Adds what is seen of an object: its patches, neighbours with equal light lists joined.
    fn add(
        &mut self,
        object: &Object,
        view: &View,
        shared: Shared,
        pipelines: &mut Pipelines,
        report: &mut FrameReport,
    ) {
        let Object { reflecting, key, geometry, model_view, normal_matrix, .. } = object;
        let demand = Demand { allowed: shared.allowed, key, exponent: object.exponent, lights: shared.lights };
        let patches = geometry.detail.patches(model_view, view, demand);
        report.triangles_in += geometry.source.triangle_count() as u64;
        self.unsorted.push(InstanceRecord::new(model_view, normal_matrix, reflecting.faces, view.unit() as f32));
        // The object as a whole has been found to be seen.
        let whole = patches.len() == 1;
        let mut run: Option<Run> = None;
        for patch in patches {
            if !whole {
                report.patches += 1;
                if !patch.is_seen(model_view, normal_matrix, view, reflecting.faces) {
                    report.patches_culled += 1;
                    continue;
                }
            }
            let (key, lights, lists) = self.lit(object, patch, shared, pipelines);
            let record = self.table.number(&mut self.records, object.material, lists);
            let next = Run { key, lights, record, indices: patch.indices.clone() };
            match &mut run {
                Some(run) if run.goes_on_with(&next) => run.indices.end = next.indices.end,
                _ => {
                    if let Some(run) = run.replace(next) {
                        self.add_run(object, run);
                    }
                }
            }
        }
        if let Some(run) = run {
            self.add_run(object, run);
        }
    }

    /// The pipeline that draws a patch, the lights that are bound for it, and its lists.
    fn lit(
        &mut self,
        object: &Object,
        patch: &Patch,
        shared: Shared,
        pipelines: &mut Pipelines,
    ) -> (PipelineKey, u32, RecordLists) {
        let Object { reflecting, key, model_view, normal_matrix, .. } = object;
        let counted = key.lists != Lists::Listed;
        if counted {
            let admitted = pipelines.admit(*key);
            if admitted.lists != Lists::Listed {
                return (admitted, 0, RecordLists::default());
            }
        }
        let patch = patch.in_eye_space(model_view, normal_matrix, reflecting.faces);
        let eye = equations::View::in_eye_space(shared.viewer);
        let surface = reflecting.surface(key);
        self.lists.select(shared.lights, &patch, &surface, &eye, shared.frame.encoding());
        let key = if shared.software
            && !counted
            && let Some(bound) = self.lists.bind(shared.lights, key.takes_powers())
        {
            let counted = PipelineKey { lists: bound.lists(), ..*key };
            if pipelines.admit(counted) == counted {
                self.lists.count_bound(bound, &surface);
                return (counted, bound.start, RecordLists::default());
            }
            // One with lists that is not generic either would take up room and time of those that are to draw.
            key.generic()
        } else {
            pipelines.admit(*key)
        };
        (key, 0, self.lists.list(shared.lights, &surface))
    }

    fn add_run(&mut self, object: &Object, Run { key, lights, record, indices }: Run) {
        let (center, _) = object.geometry.detail.whole.sphere(object.model_view);
        let depth = -center.z;
        for key in key.passes() {
            let call = self.table.call((key, object.mesh, object.form));
            let indices = (indices.start, indices.end);
            let instance = self.unsorted.len() as u32 - 1;
            self.items.push(Item { blend: key.blend, call, indices, lights, record, depth, instance });
        }
    }

    /// Sorts, and joins neighbours that differ only in their instance or record, and in one command in their indices.
    fn emit(&mut self, records_of_one_command: usize, pipelines: &mut Pipelines) {
        let mut items = std::mem::take(&mut self.items);
        // Instances are numbered in spawn order, which equal ones keep.
        items.sort_unstable_by(|a, b| {
            a.blend.cmp(&b.blend).then_with(|| if a.blend { a.by_depth(b) } else { a.by_state(b) })
        });
        for run in items.chunk_by_mut(Item::is_of_one_state) {
            let draws = || 1 + run.windows(2).filter(|pair| pair[0].indices != pair[1].indices).count();
            if self.draws.is_one_command(draws) {
                self.emit_command(run, records_of_one_command, pipelines);
            } else {
                for same in run.chunk_by_mut(|a, b| a.indices == b.indices) {
                    self.emit_command(same, records_of_one_command, pipelines);
                }
            }
        }
        self.items = items;
    }

    /// Draws what one command can draw, where records are looked up.
    fn emit_command(&mut self, items: &mut [Item], records_of_one_command: usize, pipelines: &mut Pipelines) {
        let Item { blend, call, lights, .. } = items[0];
        let (key, ..) = self.table.called[call as usize];
        let records = 1 + items.windows(2).filter(|pair| pair[0].record != pair[1].record).count();
        let are_looked_up = records > 1 && (blend || records >= records_of_one_command) && lights == 0;
        let per_instance = are_looked_up && pipelines.looks_up(key);
        for same in items.chunk_by_mut(|a, b| a.indices == b.indices && (per_instance || a.record == b.record)) {
            if per_instance && !blend {
                same.sort_unstable_by(Item::by_nearness);
            }
            self.emit_draw(same, per_instance);
        }
    }

    fn emit_draw(&mut self, items: &[Item], per_instance: bool) {
        let start = self.instances.len() as u32;
        for item in items {
            let record = if per_instance { item.record } else { 0 };
            self.instances.push(InstanceRecord { record, ..self.unsorted[item.instance as usize] });
        }
        let Item { call, indices: (first, end), lights, record, .. } = items[0];
        let (key, mesh, form) = self.table.called[call as usize];
        let key = PipelineKey { per_instance, ..key };
        let record = if per_instance { 0 } else { record };
        self.draws.push(DrawState { key, mesh, form, record, lights }, first..end, start..self.instances.len() as u32);
    }
}

/// From this many materials and light lists on, what a command draws looks them up by instance. A software adapter looks
/// up pixel by pixel, for which it could start many a draw.
fn records_of_one_command(software: bool) -> usize {
    if software { 512 } else { 2 }
}

/// Neighbouring patches of an object that are drawn alike.
struct Run {
    key: PipelineKey,
    lights: u32,
    record: u32,
    indices: Range<u32>,
}

/// Triangles between patches of a run that are not seen are drawn with it if they are no more than so many: that costs
/// less than another draw.
const JOINED: u32 = 128;

impl Run {
    fn goes_on_with(&self, next: &Self) -> bool {
        (self.key, self.lights, self.record) == (next.key, next.lights, next.record)
            && next.indices.start - self.indices.end <= 3 * JOINED
    }
}

impl Item {
    /// But for their records, which may be looked up.
    fn is_of_one_state(&self, other: &Self) -> bool {
        let state = |item: &Self| (item.blend, item.call, item.lights);
        state(self) == state(other)
    }

    fn by_state(&self, other: &Self) -> std::cmp::Ordering {
        let state = |item: &Self| (item.call, item.indices, item.lights, item.record);
        state(self).cmp(&state(other)).then_with(|| self.by_nearness(other))
    }

    fn by_nearness(&self, other: &Self) -> std::cmp::Ordering {
        self.depth.total_cmp(&other.depth).then_with(|| self.instance.cmp(&other.instance))
    }

    /// Far ones first; of one instance the far side first, which has been called first.
    fn by_depth(&self, other: &Self) -> std::cmp::Ordering {
        let order = |item: &Self| (item.instance, item.call, item.indices);
        other.depth.total_cmp(&self.depth).then_with(|| order(self).cmp(&order(other)))
    }
}
