//! Batch: visible objects become sorted, instanced draws.

use crate::error::{RenderError, label};
use crate::lights::{LightList, Lights, rgb};
use crate::matrices::{ModelView, NormalMatrix, Visible};
use crate::pipeline::{Cull, Lists, PipelineKey, Stage};
use crate::records::{DrawRecord, InstanceRecord, MaterialRecord, exponent};
use crate::report::FrameReport;
use crate::target::Target;
use crate::terms::{Chosen, TermMask};
use crate::view::View;
use bevy_asset::{AssetId, Assets};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use halfway_lighting::{BackMaterial, Blend, Faces, InvalidValue, Material, Reflectance, Viewer};
use halfway_mesh::{Mesh, Mesh3d};
use std::cmp::Reverse;
use std::collections::HashMap;
use std::ops::Range;

/// A pair of light lists that some draw uses: the vertex list, then the fragment list.
pub(crate) type ListPair = (TermMask, TermMask);

/// One draw call.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DrawCall {
    pub(crate) key: PipelineKey,
    pub(crate) mesh: AssetId<Mesh>,
    pub(crate) flat: bool,
    pub(crate) record: u32,
    pub(crate) lists: u32,
    pub(crate) instances: Range<u32>,
}

/// The frame's draws. Holds after [`RenderSet::Batch`](crate::RenderSet::Batch).
#[derive(Resource, Debug, Default)]
pub(crate) struct Batches {
    pub(crate) instances: Vec<InstanceRecord>,
    pub(crate) records: Vec<DrawRecord>,
    pub(crate) lists: Vec<ListPair>,
    pub(crate) draws: Vec<DrawCall>,
    table: Table,
}

/// What repeats among objects, numbered, so that objects compare by small integers.
#[derive(Debug, Default)]
struct Table {
    records: HashMap<RecordBits, u32>,
    lists: HashMap<ListPair, u32>,
    keys: HashMap<Call, u32>,
    calls: Vec<Call>,
    checked: HashMap<MaterialBits, Option<InvalidValue>>,
}

/// Pipeline, mesh, and whether the mesh's flat geometry is drawn.
type Call = (PipelineKey, AssetId<Mesh>, bool);
type RecordBits = [u32; size_of::<DrawRecord>() / 4];
type MaterialBits = [u32; 14];

/// One object's draw before sorting.
#[derive(Clone, Copy)]
struct Item {
    blend: bool,
    call: u32,
    record: u32,
    lists: u32,
    /// Distance of the centre along the view; nearer opaque objects first, farther blended ones first.
    depth: f32,
    instance: InstanceRecord,
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

/// What every object's key takes from the frame.
struct Frame<'a> {
    view: &'a View,
    lights: &'a Lights,
    format: wgpu::TextureFormat,
    samples: u32,
    viewer: Viewer,
}

#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn batch(
    objects: Objects,
    meshes: Res<Assets<Mesh>>,
    geometries: Res<crate::geometry::Geometries>,
    visible: Res<Visible>,
    view: Res<View>,
    lights: Res<Lights>,
    target: Res<Target>,
    mut batches: ResMut<Batches>,
    mut report: ResMut<FrameReport>,
) {
    let batches = &mut *batches;
    batches.clear();
    let (Some(camera), Some(frame)) = (&view.camera, &target.frame) else { return };
    let frame = Frame {
        view: &view,
        lights: &lights,
        format: frame.format,
        samples: frame.samples.count(),
        viewer: camera.viewer,
    };
    let mut items = Vec::with_capacity(visible.0.len());
    for &entity in &visible.0 {
        let Ok((mesh3d, material, back, reflectance, faces, blend, model_view, normal_matrix, chosen, name)) =
            objects.get(entity)
        else {
            continue;
        };
        let id = mesh3d.0.id();
        let (Some(mesh), Some(geometry)) = (meshes.get(id), geometries.get(id, chosen.flat)) else { continue };
        let material = material.unwrap_or(&Material::DEFAULT);
        let back = back.map_or(material, |back| &back.0);
        let invalid = batches.table.check(material).or_else(|| {
            // A back side without a material of its own has been checked with the front.
            batches.table.check(back).map(|invalid| InvalidValue { owner: "BackMaterial", ..invalid })
        });
        if let Some(source) = invalid {
            report.errors.push(RenderError::Invalid { entity: label(entity, name), source });
            continue;
        }
        let object = Object {
            front: material,
            back,
            reflectance: reflectance.copied().unwrap_or(frame.view.reflectance),
            faces: faces.copied().unwrap_or_default(),
            blend,
            model_view,
            opposite_normals: geometry.opposite_normals,
        };
        let depth = -model_view.eye_from_model.transform_point3(mesh.bounds().center()).z;
        let instance = InstanceRecord::new(model_view, normal_matrix, object.faces);
        let (key, lists, counts) = object.key(&frame, *chosen);
        let record = batches.table.record(&mut batches.records, object.record(frame.lights.ambient, counts));
        let lists = batches.table.list(&mut batches.lists, lists);
        for key in Object::passes(key) {
            let call = batches.table.call((key, id, chosen.flat));
            items.push(Item { blend, call, record, lists, depth, instance });
        }
    }
    report.materials = batches.records.len() as u32;
    batches.emit(items);
    report.draws = batches.draws.len() as u32;
}

struct Object<'a> {
    front: &'a Material,
    back: &'a Material,
    reflectance: Reflectance,
    faces: Faces,
    blend: bool,
    model_view: &'a ModelView,
    opposite_normals: bool,
}

impl Object<'_> {
    /// The pipeline, the lists and their counts. A term that the material or the lights leave black is
    /// in neither list.
    fn key(&self, frame: &Frame, chosen: Chosen) -> (PipelineKey, ListPair, [[u32; 3]; 2]) {
        let sides = [self.front, self.back];
        let any = |of: fn(&Material) -> Vec3| sides.into_iter().any(|material| of(material) != Vec3::ZERO);
        let all = frame.lights.list(TermMask { diffuse: true, specular: true });
        let ambient = all.ambient && any(|material| rgb(material.ambient));
        let diffuse = any(|material| rgb(material.diffuse)) || ambient;
        let specular = all.specular && any(|material| rgb(material.specular));
        let used = |mask: TermMask| -> (TermMask, &LightList) {
            let mask = TermMask { diffuse: mask.diffuse && diffuse, specular: mask.specular && specular };
            let list = frame.lights.list(mask);
            if list.records.is_empty() {
                (TermMask::default(), frame.lights.list(TermMask::default()))
            } else {
                (mask, list)
            }
        };
        let (vertex, vertex_list) = used(chosen.vertex);
        let (fragment, fragment_list) = used(chosen.fragment);
        let stage = match (vertex.is_empty(), fragment.is_empty()) {
            (true, true) => Stage::Unlit,
            (false, true) if chosen.flat => Stage::Flat,
            (false, true) => Stage::Vertex,
            (true, false) => Stage::Fragment,
            (false, false) => Stage::Mixed,
        };
        let key = PipelineKey {
            blend: self.blend,
            stage,
            lists: Lists::new(vertex_list.counts, fragment_list.counts),
            specular: specular && (vertex.specular || fragment.specular),
            blinn_phong: self.reflectance != Reflectance::Phong,
            local_viewer: frame.viewer == Viewer::Local,
            attenuated_ambient: ambient,
            shared_colour: [vertex_list, fragment_list]
                .iter()
                .all(|list| list.records.is_empty() || list.shared_colour),
            ranged: vertex_list.ranged || fragment_list.ranged,
            squarings: self.squarings(),
            geometric_fallback: self.opposite_normals && !fragment.is_empty(),
            cull: if self.faces == Faces::Both { Cull::None } else { Cull::Back },
            clockwise: self.model_view.mirrored != (self.faces == Faces::Back),
            samples: frame.samples,
            format: frame.format,
        };
        // Counts that are compiled in need not be read, and would only make equal records differ.
        let counts = match key.lists {
            Lists::Counted { .. } => [[0; 3]; 2],
            Lists::Uniform | Lists::Storage => [vertex_list.counts, fragment_list.counts],
        };
        (key.canonical(), (vertex, fragment), counts)
    }

    /// log₂ of the exponent where it is a power of two, the same on both sides.
    fn squarings(&self) -> Option<u8> {
        let exponent = exponent(self.front, self.reflectance);
        let both = exponent.to_bits() == self::exponent(self.back, self.reflectance).to_bits();
        let is_power_of_two =
            (1.0..=65536.0).contains(&exponent) && (exponent as u32).is_power_of_two() && exponent.fract() == 0.0;
        (both && is_power_of_two).then(|| (exponent as u32).trailing_zeros() as u8)
    }

    /// The passes that draw the object: two for a blended two-sided one, the far side first.
    fn passes(key: PipelineKey) -> impl Iterator<Item = PipelineKey> {
        let far_side = (key.blend && key.cull == Cull::None).then_some(PipelineKey { cull: Cull::Front, ..key });
        let near_side = if far_side.is_some() { PipelineKey { cull: Cull::Back, ..key } } else { key };
        far_side.into_iter().chain([near_side])
    }

    fn record(&self, ambient: Vec3, [vertex, fragment]: [[u32; 3]; 2]) -> DrawRecord {
        // Seen only from behind: the back is what the shader lights as front, see `InstanceRecord::new`.
        let (front, back) = if self.faces == Faces::Back { (self.back, self.back) } else { (self.front, self.back) };
        let back = if self.faces == Faces::Both { back } else { front };
        let counts = |[directional, point, spot]: [u32; 3]| [directional, point, spot, 0];
        DrawRecord {
            front: MaterialRecord::new(front, self.reflectance, ambient),
            back: MaterialRecord::new(back, self.reflectance, ambient),
            vertex_counts: counts(vertex),
            fragment_counts: counts(fragment),
        }
    }
}

impl PipelineKey {
    /// Switches that make no difference are set one way, so that they make no variants.
    fn canonical(self) -> Self {
        let lit = self.stage != Stage::Unlit;
        Self {
            blinn_phong: self.blinn_phong || !self.specular,
            local_viewer: self.local_viewer && self.specular,
            attenuated_ambient: self.attenuated_ambient && lit,
            shared_colour: self.shared_colour && self.specular,
            squarings: self.squarings.filter(|_| self.specular),
            ..self
        }
    }
}

/// A material's numbers, for use as a key.
fn bits(material: &Material) -> MaterialBits {
    let Material { ambient, diffuse, specular, emission, shininess, opacity } = material;
    let mut bits = [0; 14];
    for (colour, out) in [ambient, diffuse, specular, emission].into_iter().zip(bits.chunks_exact_mut(3)) {
        out.copy_from_slice(&rgb(*colour).to_array().map(f32::to_bits));
    }
    (bits[12], bits[13]) = (shininess.to_bits(), opacity.to_bits());
    bits
}

impl Table {
    /// How many materials are remembered as checked.
    const CHECKED: usize = 4096;

    /// What is wrong with a material, remembered by its value.
    fn check(&mut self, material: &Material) -> Option<InvalidValue> {
        self.checked.entry(bits(material)).or_insert_with(|| material.validate().err()).clone()
    }

    fn record(&mut self, records: &mut Vec<DrawRecord>, record: DrawRecord) -> u32 {
        *self.records.entry(bytemuck::cast(record)).or_insert_with(|| {
            records.push(record);
            records.len() as u32 - 1
        })
    }

    fn list(&mut self, lists: &mut Vec<ListPair>, pair: ListPair) -> u32 {
        *self.lists.entry(pair).or_insert_with(|| {
            lists.push(pair);
            lists.len() as u32 - 1
        })
    }

    fn call(&mut self, call: Call) -> u32 {
        *self.keys.entry(call).or_insert_with(|| {
            self.calls.push(call);
            self.calls.len() as u32 - 1
        })
    }
}

impl Batches {
    fn clear(&mut self) {
        self.instances.clear();
        self.records.clear();
        self.lists.clear();
        self.draws.clear();
        self.table.records.clear();
        self.table.lists.clear();
        self.table.keys.clear();
        self.table.calls.clear();
        // Materials that change every frame must not pile up; those still in use are checked once more.
        if self.table.checked.len() > Table::CHECKED {
            self.table.checked.clear();
        }
    }

    /// Sorts, and joins neighbours that differ only in their instance. The sort is stable: equal
    /// depths stay in spawn order.
    fn emit(&mut self, mut items: Vec<Item>) {
        items.sort_by(|a, b| {
            let state = |item: &Item| (item.call, item.record, item.lists);
            a.blend.cmp(&b.blend).then_with(|| {
                if a.blend {
                    Reverse(Depth(a.depth)).cmp(&Reverse(Depth(b.depth)))
                } else {
                    state(a).cmp(&state(b)).then_with(|| Depth(a.depth).cmp(&Depth(b.depth)))
                }
            })
        });
        let mut last = None;
        for item in items {
            let state = (item.call, item.record, item.lists);
            let index = self.instances.len() as u32;
            self.instances.push(item.instance);
            if let Some(draw) = self.draws.last_mut().filter(|_| last == Some(state)) {
                draw.instances.end = index + 1;
            } else {
                let (key, mesh, flat) = self.table.calls[item.call as usize];
                let Item { record, lists, .. } = item;
                self.draws.push(DrawCall { key, mesh, flat, record, lists, instances: index..index + 1 });
            }
            last = Some(state);
        }
    }
}

/// A depth in its total order.
#[derive(PartialEq)]
struct Depth(f32);

impl Eq for Depth {}

impl PartialOrd for Depth {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Depth {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
