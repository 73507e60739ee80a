//! Upload: what the draws read, as the rasterizer takes it.

use crate::batch::batches::Batches;
use crate::batch::draws::{DrawState, IndexedDraw};
use crate::batch::key::{Cull, DrawKey, MapLook};
use crate::batch::lit_patches::LitPatches;
use crate::batch::table::{MapUse, MapsUse};
use crate::cpu::meshes::MeshPieces;
use crate::geometry::meshes::Form;
use crate::lights::gather::Lights;
use crate::lights::surroundings::{PlacedEnvironment, Surroundings};
use crate::lights::terms::{by_fragment_shader, by_vertex_shader};
use crate::shaders::light_slots::COUNTED_LIGHTS;
use crate::shaders::records::{DrawRecord, InstanceRecord, LightRecord, MaterialRecord, RecordLists};
use bevy_ecs::prelude::*;
use halfway_asset::{AssetId, Assets};
use halfway_lighting::Frequency;
use halfway_mesh::Mesh;
use halfway_raster::{
    DrawCall, Highlight, InstanceData, LeftOut, LightData, LightRange, MapCall, MapData, ShadedTerms, SideData,
    SurfaceData, SurroundingsData,
};
use halfway_texture::{MapKind, Texture};

/// The lists of a pass. Their memory is kept from frame to frame.
#[derive(Resource, Default)]
pub(crate) struct PassLists {
    pub(crate) lights: Vec<LightData>,
    pub(crate) lists: Vec<u32>,
    pub(crate) surfaces: Vec<SurfaceData>,
    pub(crate) instances: Vec<InstanceData>,
    pub(crate) meshes: Vec<(AssetId<Mesh>, Form)>,
    pub(crate) draws: Vec<DrawCall>,
    pub(crate) maps: Vec<MapData>,
    pub(crate) surroundings: Option<SurroundingsData>,
    /// Of each set of images the number of the first, and the cutoff.
    sets: Vec<(u32, f32)>,
}

pub(crate) fn fill(
    lights: Res<Lights>,
    lit: Res<LitPatches>,
    batches: Res<Batches>,
    meshes: Res<MeshPieces>,
    textures: Res<Assets<Texture>>,
    surroundings: Res<Surroundings>,
    mut pass: ResMut<PassLists>,
) {
    pass.surroundings = surroundings.0.as_ref().map(surroundings_data);
    pass.fill_maps(&lit.table.maps, &textures);
    pass.fill(&lights, &lit, &batches, &meshes);
}

impl PassLists {
    /// The images of all sets, one after the other, and where those of each begin.
    fn fill_maps(&mut self, sets: &[MapsUse], textures: &Assets<Texture>) {
        self.maps.clear();
        self.sets.clear();
        for set in sets {
            self.sets.push((self.maps.len() as u32, set.cutoff));
            let data = |of: &MapUse| MapData { pyramid: of.pyramid(textures), rows: of.rows(), amount: of.amount };
            self.maps.extend(set.slots.iter().flatten().map(data));
        }
    }

    /// How a draw looks its images up, whose numbers follow each other in the order of their kinds; and its mask.
    fn map_calls(&self, key: &DrawKey, of: &MapsUse, number: u32) -> ([Option<MapCall>; MapKind::COUNT], Option<f32>) {
        let Some((first, cutoff)) = (number as usize).checked_sub(1).and_then(|number| self.sets.get(number)) else {
            return Default::default();
        };
        let mut next = *first;
        let calls = std::array::from_fn(|slot| {
            of.slots[slot]?;
            let map = next;
            next += 1;
            let call = |MapLook { sampling, uv_set, channel, far_normals }| MapCall {
                map,
                sampling,
                uv_set,
                channel,
                far_normals,
            };
            key.maps.0[slot].map(call)
        });
        (calls, key.masked.then_some(*cutoff))
    }

    fn fill(&mut self, lights: &Lights, lit: &LitPatches, batches: &Batches, meshes: &MeshPieces) {
        self.lights.clear();
        self.lights.extend(lit.lists.sent.records.iter().map(light));
        self.lists.clear();
        self.lists.extend(&lit.lists.numbers);
        // Draws without lists shade all of so few.
        let all = (lights.len() <= COUNTED_LIGHTS as usize).then(|| {
            let start = self.lists.len() as u32;
            self.lists.extend(0..lights.len() as u32);
            LightRange { counts: lights.counts, start }
        });
        self.surfaces.clear();
        self.surfaces.extend(lit.records.iter().map(|record| surface(record, all)));
        self.instances.clear();
        self.instances.extend(batches.instances.iter().map(instance));
        self.meshes.clear();
        self.draws.clear();
        for group in batches.draws.groups() {
            let DrawState { key, mesh, form, record, maps, .. } = group.state;
            if meshes.get(mesh, form).is_none() {
                continue;
            }
            if self.meshes.last() != Some(&(mesh, form)) {
                self.meshes.push((mesh, form));
            }
            let call = DrawCall { mesh: self.meshes.len() as u32 - 1, ..call(&key) };
            let call = match lit.table.maps.get((maps as usize).wrapping_sub(1)) {
                Some(of) if key.is_mapped() => {
                    let (maps, mask) = self.map_calls(&key, of, maps);
                    let (solid, inside_out) = (of.solid, key.inside_out);
                    DrawCall { maps, mask, solid, inside_out, surrounded: key.surrounded, ..call }
                }
                _ => call,
            };
            for draw in batches.draws.of(group) {
                let IndexedDraw { indices, instances } = draw.clone();
                if !key.per_instance {
                    for instance in &mut self.instances[instances.start as usize..instances.end as usize] {
                        instance.surface = record;
                    }
                }
                self.draws.push(DrawCall { indices, instances, ..call.clone() });
            }
        }
    }
}

fn call(key: &DrawKey) -> DrawCall {
    let terms = |[diffuse, specular]: [bool; 2]| ShadedTerms { diffuse, specular };
    DrawCall {
        vertex: terms(by_vertex_shader(key.terms)),
        fragment: terms(by_fragment_shader(key.terms)),
        flat: key.terms.has(Frequency::Triangle),
        highlight: if key.blinn_phong { Highlight::BlinnPhong } else { Highlight::Phong },
        left_out: match key.cull {
            Cull::Back => LeftOut::Back,
            Cull::Front => LeftOut::Front,
            Cull::None => LeftOut::Neither,
        },
        clockwise: key.clockwise,
        opposite_normals: key.geometric_fallback,
        colored: key.colored,
        blend: key.blend,
        ..DrawCall::default()
    }
}

/// The largest number of f32 in the place of a larger one, which the rasterizer refuses.
fn finite(value: f32) -> f32 {
    value.clamp(f32::MIN, f32::MAX)
}

/// A matrix that leaves f32 shows nothing.
fn instance(record: &InstanceRecord) -> InstanceData {
    let InstanceRecord { rows, normal, record } = *record;
    let is_finite = rows.iter().flatten().chain(normal.iter().flatten()).all(|value| value.is_finite());
    let (eye_from_model, normal) = if is_finite { (rows, normal) } else { ([[0.0; 4]; 3], [[0.0; 3]; 3]) };
    InstanceData { eye_from_model, normal, surface: record }
}

fn surface(record: &DrawRecord, all: Option<LightRange>) -> SurfaceData {
    let front = side(&record.front, record.front_emission);
    let back = side(&record.back, record.back_emission);
    if let Some(all) = all.filter(|_| record.lists == RecordLists::default()) {
        return SurfaceData { front, back, vertex: all, fragment: all, ..SurfaceData::default() };
    }
    let range =
        |[directional, points, spots, start]: [u32; 4]| LightRange { counts: [directional, points, spots], start };
    SurfaceData {
        front,
        back,
        vertex: range(record.lists.vertex),
        vertex_diffuse: range(record.lists.vertex_diffuse),
        vertex_specular: range(record.lists.vertex_specular),
        fragment: range(record.lists.fragment),
        fragment_diffuse: range(record.lists.fragment_diffuse),
        fragment_specular: range(record.lists.fragment_specular),
    }
}

fn side(record: &MaterialRecord, emission: [f32; 3]) -> SideData {
    SideData {
        base: record.base.map(finite),
        diffuse: record.diffuse,
        specular: record.specular,
        emission,
        ambient: record.ambient,
        exponent: finite(record.shininess),
        opacity: record.opacity,
    }
}

fn surroundings_data(placed: &PlacedEnvironment) -> SurroundingsData {
    let PlacedEnvironment { map, strength, rows, mean, sky } = placed;
    SurroundingsData { map: map.clone(), strength: *strength, rows: *rows, mean: *mean, sky: *sky }
}

fn light(record: &LightRecord) -> LightData {
    LightData {
        position: record.position,
        inverse_range: finite(record.inverse_range),
        attenuation: [record.constant, record.linear, record.quadratic],
        direction: record.direction,
        cos_cutoff: record.cos_cutoff,
        exponent: record.exponent,
        inner_fade: [record.inner_scale, record.inner_offset].map(finite),
        ambient: record.ambient.map(finite),
        diffuse: record.diffuse.map(finite),
        specular: record.specular.map(finite),
    }
}
