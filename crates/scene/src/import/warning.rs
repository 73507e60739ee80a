//! Changes made during the import.

use thiserror::Error;

/// Something in a file's numbers that was changed or may not be meant.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Warning {
    /// An illumination model of ray tracers: its reflection and refraction are left out.
    #[error("illum {illum} asks for ray-traced reflection or refraction; taken as illum 2")]
    IllumNeedsRays {
        /// The number given, 3 to 10.
        illum: u8,
    },
    /// An illumination model that the format does not have.
    #[error("illum {illum} is not defined (expected 0 to 10); taken as illum 2")]
    IllumUnknown {
        /// The number given.
        illum: u8,
    },
    /// `d` and `Tr` contradict each other.
    #[error("d {d:?} and Tr {tr:?} disagree (expected d = 1 - Tr); d is used")]
    OpacityDisagrees {
        /// The dissolve factor: 1 is opaque.
        d: f32,
        /// The transparency: 0 is opaque.
        tr: f32,
    },
    /// An opacity above 1.
    #[error("{key} {value:?} is above 1; taken as 1")]
    OpacityClamped {
        /// `d` or `Tr`.
        key: &'static str,
        /// The number given.
        value: f32,
    },
    /// A material that would not be seen where it is blended.
    #[error("{key} {value:?} makes the material fully transparent")]
    FullyTransparent {
        /// `d` or `Tr`.
        key: &'static str,
        /// The number given.
        value: f32,
    },
    /// A physically based material.
    #[error(
        "Pr and Pm, roughness and metallic, become the nearest diffuse color and highlight; Ka, Ks and Ns are not used"
    )]
    PhysicallyBased,
    /// A highlight without an exponent.
    #[error("Ks is given without Ns; shininess {shininess:?} is used")]
    NoShininess {
        /// The shininess that was taken.
        shininess: f32,
    },
}
