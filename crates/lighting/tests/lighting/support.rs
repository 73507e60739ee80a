//! Vectors, scenes and random numbers for the tests.

use bevy_color::LinearRgba;
use halfway_lighting::equations::{Coefficients, Eye, Light, Real, ShadedPoint, shade};
use halfway_lighting::{Material, Reflectance};

pub(crate) const ALL_REFLECTANCES: [Reflectance; 3] =
    [Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched];

/// A unit vector in the xz plane, `angle` away from +Z toward +X.
pub(crate) fn in_plane(angle: f64) -> [f64; 3] {
    [angle.sin(), 0.0, angle.cos()]
}

pub(crate) fn close(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance, "{what}: {a:e} against {b:e}, tolerance {tolerance:e}");
}

pub(crate) fn close3(a: [f64; 3], b: [f64; 3], tolerance: f64, what: &str) {
    for i in 0..3 {
        close(a[i], b[i], tolerance, &format!("{what}, component {i}"));
    }
}

pub(crate) fn to_f32(a: [f64; 3]) -> [f32; 3] {
    a.map(|x| x as f32)
}

pub(crate) fn to_f64(a: [f32; 3]) -> [f64; 3] {
    a.map(f64::from)
}

pub(crate) fn gray(value: f32) -> LinearRgba {
    LinearRgba::rgb(value, value, value)
}

/// Coefficients of this shininess.
pub(crate) fn glossy(shininess: f64) -> Coefficients<f64> {
    Coefficients { shininess, ..Coefficients::black() }
}

/// A material with no two coefficients alike, so that a mix-up shows.
pub(crate) fn distinct_material(shininess: f32) -> Material {
    Material {
        ambient: LinearRgba::rgb(0.125, 0.25, 0.375),
        diffuse: LinearRgba::rgb(0.5, 0.625, 0.75),
        specular: LinearRgba::rgb(0.875, 1.0, 0.0625),
        emission: LinearRgba::rgb(0.03125, 0.0, 0.015_625),
        shininess,
        ..Material::DEFAULT
    }
}

/// [`shade`] without global ambient, for lights and materials already evaluated.
pub(crate) fn shade_dark<T: Real>(
    surface: &ShadedPoint<T>,
    material: &Material,
    lights: &[Light<T>],
    view: &Eye<T>,
    reflectance: Reflectance,
) -> [T; 3] {
    shade(surface, &Coefficients::from(material), lights, [T::zero(); 3], view, reflectance)
}

/// PCG-XSH-RR 32 (O'Neill 2014): seeded, so that a failure repeats.
pub(crate) struct Pcg(u64);

impl Pcg {
    pub(crate) fn new(seed: u64) -> Self {
        let mut pcg = Self(seed.wrapping_add(1_442_695_040_888_963_407));
        pcg.next();
        pcg
    }

    fn next(&mut self) -> u32 {
        let state = self.0;
        self.0 = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let word = (((state >> 18) ^ state) >> 27) as u32;
        word.rotate_right((state >> 59) as u32)
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        f64::from(self.next()) / 4_294_967_296.0
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform on the unit sphere.
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        let z = self.between(-1.0, 1.0);
        let angle = self.between(0.0, core::f64::consts::TAU);
        let r = (1.0 - z * z).sqrt();
        [r * angle.cos(), r * angle.sin(), z]
    }
}
