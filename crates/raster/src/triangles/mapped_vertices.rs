//! The vertices of draws with images or a mask.

use crate::input::attributes::{
    AMBIENT_OF_VERTICES, COLOR, FRAME, MIRROR_NORMAL, NORMAL, OF_VERTICES, PARTS, PLACE, UVS,
};
use crate::input::pass::Pass;
use crate::input::pieces::{Piece, Pieces};
use crate::lighting::state::{Stage, State};
use crate::lighting::{Points, ambient_part, diffuse_part, specular_part, to_viewer};
use crate::simd::lanes::{F, Simd, V3, each, load, load3, neg, safe_normalize, splat, store_fours};
use crate::triangles::mapped::parts_of;
use crate::vertices::transform::{Vertices, places_of, turned};
use halfway_lighting::record::InstanceRecord;
use halfway_texture::MapKind;

impl Vertices {
    /// Fills the mapped numbers of some groups of a piece's transformed vertices.
    #[inline(never)]
    pub(crate) fn fill_mapped<S: Simd>(
        &mut self,
        simd: S,
        (mesh, piece): (&Pieces, &Piece),
        instance: &InstanceRecord,
        (pass, state): (&Pass, &State),
        groups: u32,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                self.mapped.prepare();
                for at in places_of::<S>(groups) {
                    self.fill_some(simd, at, (mesh, piece.first_vertex as usize + at), instance, (pass, state));
                }
            },
        );
    }

    #[inline(always)]
    fn fill_some<S: Simd>(
        &mut self,
        simd: S,
        at: usize,
        (mesh, first): (&Pieces, usize),
        instance: &InstanceRecord,
        (pass, state): (&Pass, &State),
    ) {
        let i = load(simd, &self.inverse_w, at);
        let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
        let four = |lists: &[Vec<f32>; 4], otherwise| {
            if lists[0].is_empty() { [otherwise; 4] } else { each!(k in 4 => load(simd, &lists[k], first)) }
        };
        let uvs = four(&mesh.uvs, zero);
        let color = if state.colored { four(&mesh.colors, one) } else { [one; 4] };
        let put = |group: &mut [[f32; 4]], numbers: [F<S>; 4]| {
            store_fours::<S>(each!(k in 4 => numbers[k] * i), group, at);
        };
        put(self.mapped.group(false, UVS), uvs);
        put(self.mapped.group(false, COLOR), color);
        let Some(maps) = &state.maps else { return };
        if maps.solid.is_some() {
            let [x, y, z] = load3(simd, &mesh.positions, first);
            put(self.mapped.group(false, PLACE), [x, y, z, zero]);
        }
        if state.stage == Stage::Flat || state.stage == Stage::Unlit && !maps.surrounded {
            return;
        }
        let model_n = load3(simd, &mesh.normals, first);
        let n = safe_normalize(simd, turned(simd, &instance.normal, model_n));
        if maps.surrounded && matches!(state.stage, Stage::Unlit | Stage::Vertex) {
            put(self.mapped.group(false, MIRROR_NORMAL), [n[0], n[1], n[2], zero]);
        }
        if matches!(state.stage, Stage::Fragment | Stage::Mixed) {
            put(self.mapped.group(false, NORMAL), [n[0], n[1], n[2], zero]);
            let direction = |v: V3<S>| {
                each!(axis in 3 => {
                    let [a, b, c] = each!(k in 3 => splat(simd, instance.eye_from_model[axis][k]));
                    a * v[0] + b * v[1] + c * v[2]
                })
            };
            if maps.has(MapKind::Normal) {
                let [x, y, z, w] = four(&mesh.tangents, zero);
                let t = safe_normalize(simd, direction([x, y, z]));
                let sign = |negative: bool| splat(simd, if negative { -1.0 } else { 1.0 });
                let [tangent, bitangent] = [maps.inside_out, state.clockwise].map(sign);
                let frame = [t[0] * tangent, t[1] * tangent, t[2] * tangent, w * bitangent];
                put(self.mapped.group(false, FRAME), frame);
            } else if maps.has(MapKind::Height) {
                let m = direction(model_n);
                put(self.mapped.group(false, FRAME), [m[0], m[1], m[2], zero]);
            }
        }
        if matches!(state.stage, Stage::Fragment | Stage::Unlit) {
            return;
        }
        let p = load3(simd, &self.eye, at);
        for back in [false, true] {
            if back && !state.backs {
                break;
            }
            let n = if back { neg::<S>(n) } else { n };
            let points = Points::new(simd, p, n, to_viewer(simd, p, n, pass.local_viewer));
            let terms = state.vertex_terms(simd, pass, &points, back);
            let (side, own) = (state.side(pass, back), [color[0], color[1], color[2]]);
            let mut put_part =
                |group, part: V3<S>| put(self.mapped.group(back, group), [part[0], part[1], part[2], zero]);
            if state.stage == Stage::Vertex {
                for (number, part) in parts_of(simd, &terms, side, own).into_iter().enumerate() {
                    put_part(PARTS + number, part);
                }
            } else if state.vertex.diffuse {
                put_part(OF_VERTICES, diffuse_part(simd, &terms, side, own));
                put_part(AMBIENT_OF_VERTICES, ambient_part(simd, &terms, side, own, false));
            } else {
                put_part(OF_VERTICES, specular_part(simd, &terms, side));
            }
        }
    }
}
