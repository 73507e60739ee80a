//! The equations as pure functions, in `f32` or `f64`.
//!
//! ```text
//! I = ke + ka·Ga + Σ_i  ka·La_i·(att_i·spot_i if the light attenuates its ambient, else 1)
//!                     + att_i·spot_i·[ kd·Ld_i·max(n·l_i, 0) + ks·Ls_i·S_i ]
//! ```
//!
//! [`shade`] is the whole sum, [`light_contribution`] one summand, [`light_terms`] its three terms, [`irradiance`]
//! those before the material; the other functions are the factors. [`surroundings`] are the terms of an environment.
//! All vectors have unit length unless said, all colours are linear RGB, angles are in radians. Components make the
//! arguments: `Coefficients::from(&material)`, [`PointLight::at`](crate::PointLight::at),
//! [`SpotLight::at`](crate::SpotLight::at), [`DirectionalLight::along`](crate::DirectionalLight::along),
//! [`Eye::in_eye_space`].
//!
//! # Edges
//! | where | what happens |
//! |---|---|
//! | 0⁰ (shininess 0 and cosine 0; exponent 0 at the edge of a cone) | 1: [`power`] |
//! | a cosine that rounding put above 1 | clamped to 1: [`power`] |
//! | l = −v, no halfway vector | S = 0: [`specular_blinn_phong`] |
//! | the light at the lit point ([`COINCIDENT`]) | l is n, d is 0; attenuation 1/a, at most [`ATTENUATION_MAX`] |
//! | a local eye at the lit point | v is n: [`view_vector`] |
//! | the light behind the surface (n·l ≤ 0), or in its plane ([`GRAZING`]) | neither diffuse nor specular |
//! | distances beyond the number range | the direction is kept, the distance is the largest finite number |
//! | an inner cone equal to the cutoff | a hard edge, no division by 0: [`spot_factor`] |
//! | an interpolated normal ≈ 0 | the geometric normal: [`interpolated_normal`] |
//! | a relief on a normal ≈ 0, or along ways that are one | no relief: [`mapped_normal`], [`bumped_normal`] |
//! | a singular or mirroring matrix | [`normal_matrix`] by cofactors, with the sign of the determinant |

mod arrival;
mod encoding;
mod environment;
mod normal;
mod reflectance;
mod relief;
mod scene;
mod tone;
mod transcendental;
pub mod vector;

pub use crate::lights::{
    ATTENUATION_MAX, Colors, ConeTerms, Directional, Hemisphere, Light, Point, Spot, attenuation, range_window,
    spot_factor,
};
pub use crate::shade::{LightTerms, incidence, irradiance, light_contribution, light_terms, reflected, shade};
pub use arrival::{Arrival, COINCIDENT, GRAZING, Incidence, Irradiance, view_vector};
pub use encoding::srgb_encoded;
pub use environment::{lobe_angle, lobe_exponent, mean_light, mirrored, surroundings};
pub use normal::{NORMAL_MIN, normal_matrix, transform_normal};
pub use reflectance::{
    HALFWAY_MIN, axial_exponent, diffuse_term, face_forward, half_vector, interpolated_normal, power, reflect,
    side_normal, specular_blinn_phong, specular_exponent, specular_phong, specular_term,
};
pub use relief::{bumped_normal, lobe_axes, mapped_normal};
pub(crate) use scene::unit;
pub use scene::{Coefficients, Eye, ShadedPoint, rgb};
pub use tone::{ACES_WHITE, aces, divisor, reinhard};
pub use transcendental::Transcendental;
pub use vector::Real;
