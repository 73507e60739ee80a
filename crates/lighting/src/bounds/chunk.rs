//! Lights side by side, eight numbers of a kind together, as vectors take them.

use crate::equations::{Light, Place};

/// How many lights stand side by side.
pub(super) const CHUNK: usize = 8;

/// Up to eight lights. A lane without one has a directional light that is black.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chunk {
    /// Of a point the position; of a directional light the unit vector toward it.
    pub(super) place: [[f32; CHUNK]; 3],
    /// 1 of a point or spot, else 0.
    pub(super) is_point: [f32; CHUNK],
    /// ∞ where there is none.
    pub(super) range: [f32; CHUNK],
    pub(super) attenuation: [[f32; CHUNK]; 3],
    /// 1 where there is a cone, else 0.
    pub(super) has_cone: [f32; CHUNK],
    pub(super) direction: [[f32; CHUNK]; 3],
    pub(super) cos_cutoff: [f32; CHUNK],
    /// −2, below every cosine, where there is no inner cone.
    pub(super) cos_inner: [f32; CHUNK],
    pub(super) exponent: [f32; CHUNK],
    /// 0 unless it is attenuated.
    pub(super) la: [[f32; CHUNK]; 3],
    pub(super) ld: [[f32; CHUNK]; 3],
    pub(super) ls: [[f32; CHUNK]; 3],
    /// Whether any lane has a cone, and whether any has one with an exponent.
    pub(super) has_cones: bool,
    pub(super) has_exponents: bool,
}

impl Chunk {
    pub(super) const EMPTY: Self = Self {
        place: [[0.0; CHUNK]; 3],
        is_point: [0.0; CHUNK],
        range: [f32::INFINITY; CHUNK],
        attenuation: [[1.0; CHUNK], [0.0; CHUNK], [0.0; CHUNK]],
        has_cone: [0.0; CHUNK],
        direction: [[0.0; CHUNK]; 3],
        cos_cutoff: [-1.0; CHUNK],
        cos_inner: [-2.0; CHUNK],
        exponent: [0.0; CHUNK],
        la: [[0.0; CHUNK]; 3],
        ld: [[0.0; CHUNK]; 3],
        ls: [[0.0; CHUNK]; 3],
        has_cones: false,
        has_exponents: false,
    };

    /// Puts a light into an empty lane.
    pub(super) fn put(&mut self, lane: usize, light: &Light<f32>) {
        let three = |to: &mut [[f32; CHUNK]; 3], from: [f32; 3]| (0..3).for_each(|k| to[k][lane] = from[k]);
        let (Place::Point(place) | Place::Directional(place)) = light.place;
        three(&mut self.place, place);
        three(&mut self.ld, light.ld);
        three(&mut self.ls, light.ls);
        if light.attenuate_ambient {
            three(&mut self.la, light.la);
        }
        if let Place::Point(_) = light.place {
            self.is_point[lane] = 1.0;
            three(&mut self.attenuation, light.attenuation);
            self.range[lane] = light.range.unwrap_or(f32::INFINITY);
        }
        if let Some(cone) = &light.cone {
            self.has_cone[lane] = 1.0;
            three(&mut self.direction, cone.direction);
            self.cos_cutoff[lane] = cone.cos_cutoff;
            self.cos_inner[lane] = cone.cos_inner.unwrap_or(-2.0);
            self.exponent[lane] = cone.exponent;
            self.has_cones = true;
            self.has_exponents |= cone.exponent != 0.0;
        }
    }
}
