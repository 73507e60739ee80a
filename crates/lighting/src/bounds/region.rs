//! Where patches lie that look for their lights together.

/// A sphere that holds patches, and what they do with light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// The middle of the sphere, in the space of the evaluation.
    pub center: [f32; 3],
    /// Its radius.
    pub radius: f32,
    /// The largest coefficient of any patch in it: ambient, diffuse or specular, of any channel.
    pub brightest: f32,
    /// The least tolerance of any patch in it, in any channel.
    pub tolerance: f64,
}

impl Region {
    pub(super) const EMPTY: Self = Self { center: [0.0; 3], radius: 0.0, brightest: 0.0, tolerance: 0.0 };
}
