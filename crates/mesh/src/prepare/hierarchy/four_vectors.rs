//! Four vectors at once.

use std::ops::{Add, Mul, Sub};

use bevy_math::{Vec3, Vec4};

/// Four vectors, by their coordinates.
#[derive(Clone, Copy)]
pub(super) struct FourVectors {
    x: Vec4,
    y: Vec4,
    z: Vec4,
}

impl FourVectors {
    pub(super) fn new([a, b, c, d]: [Vec3; 4]) -> Self {
        let each = |of: fn(Vec3) -> f32| Vec4::new(of(a), of(b), of(c), of(d));
        Self { x: each(|v| v.x), y: each(|v| v.y), z: each(|v| v.z) }
    }

    /// The same four times.
    pub(super) fn splat(v: Vec3) -> Self {
        Self { x: Vec4::splat(v.x), y: Vec4::splat(v.y), z: Vec4::splat(v.z) }
    }

    pub(super) fn dot(self, other: Self) -> Vec4 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub(super) fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    pub(super) fn length_squared(self) -> Vec4 {
        self.dot(self)
    }
}

impl Add for FourVectors {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl Sub for FourVectors {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl Mul<f32> for FourVectors {
    type Output = Self;

    fn mul(self, by: f32) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
    }
}
