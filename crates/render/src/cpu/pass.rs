//! The set Upload: builds the rasterizer's pass for opaque and blended objects. It also draws the sky, tile by tile.

use crate::cpu::meshes::MeshPieces;
use bevy_ecs::prelude::*;
use halfway_asset::{AssetId, Assets};
use halfway_frame::batch::batches::Batches;
use halfway_frame::batch::draws::{DrawState, IndexedDraw};
use halfway_frame::batch::key::{DrawKey, MapLook};
use halfway_frame::batch::lit_patches::LitPatches;
use halfway_frame::batch::table::{MapUse, MapsUse};
use halfway_frame::geometry::meshes::Form;
use halfway_frame::passes::{Passes, groups};
use halfway_lighting::Reflectance;
use halfway_mesh::Mesh;
use halfway_raster::{DrawCall, DrawMaps, MapCall, MapData};
use halfway_texture::Texture;

/// The lists that only the rasterizer's pass has. Their memory is kept from frame to frame.
#[derive(Resource, Default)]
pub(crate) struct PassLists {
    pub(crate) meshes: Vec<(AssetId<Mesh>, Form)>,
    pub(crate) draws: Vec<DrawCall>,
    pub(crate) maps: Vec<MapData>,
    /// The index of each set's first image.
    firsts: Vec<u32>,
}

pub(crate) fn fill(
    lit: Res<LitPatches>,
    passes: Res<Passes>,
    batches: Res<Batches>,
    meshes: Res<MeshPieces>,
    textures: Res<Assets<Texture>>,
    mut pass: ResMut<PassLists>,
) {
    pass.fill_maps(&lit.table.maps, &textures);
    pass.fill_draws(&lit, (&passes, &batches), &meshes);
}

impl PassLists {
    /// Collects the images of all sets, one after the other, and the index of each set's first.
    fn fill_maps(&mut self, sets: &[MapsUse], textures: &Assets<Texture>) {
        self.maps.clear();
        self.firsts.clear();
        for set in sets {
            self.firsts.push(self.maps.len() as u32);
            let data = |of: &MapUse| MapData { pyramid: of.pyramid(textures), rows: of.rows(), amount: of.amount };
            self.maps.extend(set.slots.iter().flatten().map(data));
        }
    }

    /// The images that a draw uses of a set, in the order of their kinds.
    fn draw_maps(&self, key: &DrawKey, of: &MapsUse, number: u32) -> DrawMaps {
        let mut next = self.firsts[number as usize - 1];
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
        let mask = key.masked.then_some(of.cutoff);
        DrawMaps { calls, mask, solid: of.solid, inside_out: key.inside_out, surrounded: key.surrounded }
    }

    fn fill_draws(&mut self, lit: &LitPatches, (passes, batches): (&Passes, &Batches), meshes: &MeshPieces) {
        self.meshes.clear();
        self.draws.clear();
        for group in passes.iter().flat_map(|pass| groups(batches, pass.phase)) {
            let DrawState { key, mesh, form, maps, .. } = group.state;
            if meshes.get(mesh, form).is_none() {
                continue;
            }
            if self.meshes.last() != Some(&(mesh, form)) {
                self.meshes.push((mesh, form));
            }
            let of_set = lit.table.maps.get((maps as usize).wrapping_sub(1)).filter(|_| key.is_mapped());
            let maps = of_set.map(|of| self.draw_maps(&key, of, maps));
            let call = DrawCall { mesh: self.meshes.len() as u32 - 1, maps, ..call(&key) };
            for draw in batches.draws.in_group(group) {
                let IndexedDraw { indices, instances } = draw.clone();
                self.draws.push(DrawCall { indices, instances, ..call.clone() });
            }
        }
    }
}

fn call(key: &DrawKey) -> DrawCall {
    DrawCall {
        terms: key.terms,
        reflectance: if key.blinn_phong { Reflectance::BlinnPhong } else { Reflectance::Phong },
        cull: key.cull,
        clockwise: key.clockwise,
        opposite_normals: key.geometric_fallback,
        colored: key.colored,
        blend: key.blend,
        ..DrawCall::default()
    }
}
