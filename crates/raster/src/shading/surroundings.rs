//! The environment: its light at a pixel, and the sky.

use crate::input::attributes::COLOR;
use crate::lighting::state::{Stage, State};
use crate::pixels::look::Look;
use crate::pixels::mapped_pixels::MappedPixel;
use crate::shading::encode::kept;
use crate::simd::lanes::{Simd, V3, each, lanes, splat3};
use crate::vertices::placed::TILE;
use crate::vertices::screen::Screen;
use halfway_lighting::equations::vector::normalize_or_zero;
use halfway_lighting::equations::{lobe_angle, lobe_exponent, mean_light, mirrored, surroundings};
use halfway_texture::environment::SurroundingsData;

/// The ray through a pixel of a tile: x and y where w is 1.
fn way(screen: &Screen, tile: [u32; 2], place: [f32; 2]) -> [f32; 2] {
    each!(axis in 2 => {
        let pixel = place[axis] + tile[axis] as f32 * TILE as f32;
        pixel * screen.way_step[axis] + screen.way_start[axis]
    })
}

impl MappedPixel<'_> {
    /// The light of the environment in the ambient and in the specular part.
    pub(crate) fn surrounded(
        &self,
        around: &SurroundingsData,
        look: &Look,
        state: &State,
        back: bool,
    ) -> [[f32; 3]; 2] {
        let way = way(look.screen, look.tile, self.place);
        let normals = self.normals(state);
        let front = self.normal(state, normals.as_ref(), way, look.screen.way_step);
        let n = if back { front.map(|x| -x) } else { front };
        let v = if look.pass.local_viewer { normalize_or_zero([-way[0], -way[1], 1.0]) } else { [0.0, 0.0, 1.0] };
        let side = state.side(look.pass, back);
        let alpha = lobe_exponent(state.reflectance, self.gloss(normals.as_ref(), side.shininess).exponent);
        let seen = around.map.at(around.direction(mirrored(n, v)), around.map.level_of(lobe_angle(alpha)));
        let mean = mean_light(&around.mean, around.direction(n));
        let color = match state.stage {
            _ if !state.colored => [1.0; 3],
            Stage::Flat => self.triangle.color,
            _ => self.three(COLOR).map(|x| x.clamp(0.0, 1.0)),
        };
        let kd = each!(c in 3 => color[c] * side.diffuse[c]);
        surroundings([kd, side.specular], around.strength, [mean, seen])
    }
}

/// The color where nothing is drawn, from the pixel `at` of the tile on: the sky in the target's range if there is one,
/// else the clear color `clear`.
#[inline(always)]
pub(crate) fn behind<S: Simd>(simd: S, look: &Look, at: usize, clear: V3<S>) -> V3<S> {
    match look.pass.surroundings {
        Some(around) if around.sky.is_some() => sky(simd, look, around, at),
        _ => clear,
    }
}

#[inline(never)]
fn sky<S: Simd>(simd: S, look: &Look, around: &SurroundingsData, at: usize) -> V3<S> {
    let mut colors = splat3(simd, [0.0; 3]);
    for lane in 0..lanes::<S>() {
        let place = [(at + lane) % TILE, (at + lane) / TILE].map(|pixels| pixels as f32);
        let [x, y] = way(look.screen, look.tile, place);
        let direction = around.direction(look.pass.lens.sight([x, y, -1.0]));
        let color = around.map.at(direction, around.sky.unwrap_or_default());
        for c in 0..3 {
            colors[c][lane] = around.strength * color[c];
        }
    }
    kept(simd, colors, look.pass.pixels)
}
