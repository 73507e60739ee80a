//! Seeded random numbers, the same on every machine.

use fastrand::Rng;

pub(crate) fn between(random: &mut Rng, low: f32, high: f32) -> f32 {
    low + (high - low) * random.f32()
}
