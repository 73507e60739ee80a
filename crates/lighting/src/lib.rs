#![doc = include_str!("../README.md")]
//!
//! # The equation
//! ```text
//! I = ke + ka·Ga + Σ_i  ka·La_i·(att_i·spot_i if the light attenuates its ambient, else 1)
//!                     + att_i·spot_i·[ kd·Ld_i·max(n·l_i, 0) + ks·Ls_i·S_i ]
//! ```
//!
//! | symbol | meaning | range / unit | here |
//! |---|---|---|---|
//! | ke, ka, kd, ks | emission, ambient, diffuse, specular colour of the material | ≥ 0 (reflectances normally ≤ 1) | [`Material`] |
//! | α, β | shininess of Phong, of Blinn–Phong | ≥ 0; 5–10 plastic, 100–200 metal (Phong) | [`Material::shininess`] |
//! | Ga | global ambient | ≥ 0 | [`GlobalAmbient`] |
//! | La, Ld, Ls | a light's ambient, diffuse, specular colour | ≥ 0 | [`PointLight`], [`SpotLight`], [`DirectionalLight`] |
//! | att | 1/(a + b·d + c·d²), d = distance in world units, at most 10⁶; 1 for a directional light; where a range R is given, times clamp(1 − (d/R)⁴, 0, 1)² | a, b, c ≥ 0, not all 0; R > 0 | [`Attenuation`] |
//! | spot | max(cos φ, 0)^e if cos φ ≥ cos(cutoff) else 0; φ between −l and the spot direction; an inner cone fades smoothly to the cutoff | cutoff in [0, π/2], or π = no cone; e ≥ 0 | [`Cone`] |
//! | S (Phong) | max(r·v, 0)^α, r = 2(n·l)n − l | gate: 0 unless n·l > 0 | [`Reflectance::Phong`] |
//! | S (Blinn–Phong) | max(n·h, 0)^β, h = (l + v)/‖l + v‖ | gate: 0 unless n·l > 0 | [`Reflectance::BlinnPhong`] |
//! | sky, ground | colours of a light from all around, which adds kd·lerp(ground, sky, (1 + n·d)/2), d toward the sky | ≥ 0 | [`HemisphereLight`] |
//! | v | local viewer: toward the eye; infinite viewer: (0, 0, 1) in eye space; orthographic camera: v = +Z in eye space at every point | | [`Viewer`], [`Projection`] |
//!
//! Under [`Shading::Unlit`] I = kd, whatever shines: neither lights nor ambient light, environments or emission count.
//!
//! All vectors have unit length, all colours are linear RGB (a [`LinearRgba`] whose alpha is
//! ignored), angles are in radians. Sources: Phong 1975 and Blinn 1977 for S, OpenGL 2.1 §2.14.1 for the sum, the
//! falloff and the cone, `KHR_lights_punctual` for range and inner cone. Shading is local: no shadows, no
//! interreflection.
//!
//! # What is here
//! - Components: the lights, [`Material`] (with [presets](Material::PRESETS)) and [`BackMaterial`], [`Shading`],
//!   [`Reflectance`], [`Faces`], [`AlphaMode`], [`Visibility`], [`Tolerance`], [`VertexColors`]; the resources
//!   [`GlobalAmbient`] and [`ViewTolerance`]; [`LightingPlugin`]. A light stands where
//!   its entity's `GlobalTransform` puts it and shines along the local −Z axis. Every value has a `validate()` whose
//!   [`InvalidValue`] names type, field, value and what was expected.
//! - [`lights`]: the kinds of light, a file each: component, maths, bound, record, WGSL and fields.
//! - [`Camera`] and its [`Projection`], perspective or orthographic; [`Lens`], the projection on a picture, answers what
//!   depends on it: clip space, rays, the frustum, the size of a pixel.
//! - [`equations`]: the equation and its parts as pure functions, in `f32` or `f64`, defined at every edge.
//! - [`bounds`]: what a light can add to a patch of surface at most, and which lights a patch needs.
//! - [`record`]: lights, materials and instances as whatever draws reads them.
//! - [`Viewport`] and [`Layers`]: several cameras in one picture, and what each sees.
//! - [`Choices`]: the names of shadings, reflectances and intensity policies, listed once.
//! - [`Edges`], [`LineStyle`] and [`Show`]: lines over the finished picture.
//! - [`matched_shininess`]: the Blinn–Phong exponent for a Phong highlight.
//! - [`Shown`], [`Cameras`], [`propagation`]: what is shown; which camera draws; whether transforms are propagated.
//! - [`Origin`]: what is far from the origin of the world, such as at map coordinates.
//! - [`homogeneous`]: light positions as four coordinates.
//!
//! No GPU, no window, no file is touched.
//!
//! # Features
//! `ecs`, on by default, makes components and resources of these types and adds what reads a world: [`LightingPlugin`],
//! [`lights::LightQueries`], [`Shown`], [`propagation`], and places by `GlobalTransform`. Without it they are plain types
//! and functions, [`LinearRgba`] is a plain struct of the same fields, and the crate depends on nothing of bevy's.
//!
//! # A shaded point
//! ```
//! use halfway_lighting::equations::{Coefficients, Eye, ShadedPoint, shade};
//! use halfway_lighting::{GlobalAmbient, Material, PointLight, Reflectance, Viewer};
//!
//! let surface = ShadedPoint { position: [0.0, 0.0, -5.0], normal: [0.0, 0.0, 1.0] };
//! let lights = [PointLight::white().at([1.0, 2.0, 0.0])];
//! let view = Eye::in_eye_space(Viewer::Local);
//! let ambient = GlobalAmbient::default().ga();
//! let color: [f64; 3] =
//!     shade(&surface, &Coefficients::from(&Material::BRASS), &lights, ambient, &view, Reflectance::BlinnPhong);
//! assert!(color[0] > color[1] && color[1] > color[2]);
//! ```

// Powers and the functions of angles only by `equations::Transcendental`: see clippy.toml.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod alpha;
mod ambient;
pub mod bounds;
mod camera;
mod choices;
#[cfg(not(feature = "ecs"))]
mod color;
mod direction;
mod edges;
pub mod equations;
mod falloff;
mod field;
mod frequency;
mod hidden;
pub mod homogeneous;
mod intensity;
mod invalid;
mod layers;
mod legend;
mod light_colors;
mod light_tree;
pub mod lights;
mod line_style;
mod matched;
mod material;
#[cfg(feature = "ecs")]
mod origin;
#[cfg(feature = "ecs")]
mod place;
#[cfg(feature = "ecs")]
mod plugin;
mod presets;
mod projection;
#[cfg(feature = "ecs")]
mod propagation;
mod range;
pub mod record;
mod rig;
mod shade;
mod shading;
mod show;
#[cfg(feature = "ecs")]
mod shown;
mod term;
mod tolerance;
mod upright;
mod vertex_colors;
mod view;
mod viewport;
mod visibility;

pub use alpha::AlphaMode;
pub use ambient::GlobalAmbient;
#[cfg(feature = "ecs")]
pub use bevy_color::LinearRgba;
pub use camera::{Camera, Encoding, Samples};
pub use choices::{Choice, Choices};
#[cfg(not(feature = "ecs"))]
pub use color::LinearRgba;
pub use direction::rotation_along;
pub use edges::{Edges, WhichEdges};
pub use field::{Described, Field, FieldPlace, FieldValue};
pub use frequency::Frequency;
pub use hidden::HiddenEdges;
pub use intensity::Intensity;
pub use invalid::{Fields, InvalidValue, Problem};
pub use layers::Layers;
pub use legend::Legend;
pub use lights::{Attenuation, Cone, DirectionalLight, HemisphereLight, LightComponent, PointLight, SpotLight};
pub use line_style::{LineStyle, Width};
pub use matched::matched_shininess;
pub use material::{BackMaterial, Material};
#[cfg(feature = "ecs")]
pub use origin::{FrameOrigin, Origin, place_by_origins, world_place};
#[cfg(feature = "ecs")]
pub use place::{light_direction, light_position, light_up};
#[cfg(feature = "ecs")]
pub use plugin::LightingPlugin;
pub use projection::{DepthSpan, Film, Lens, LensTerms, Projection, ViewRay};
#[cfg(feature = "ecs")]
pub use propagation::{Propagation, propagation};
pub use range::{CHANNEL_MAX, Range};
pub use rig::LightRig;
pub use shading::{Faces, Reflectance, Shading, Terms, Viewer};
pub use show::Show;
#[cfg(feature = "ecs")]
pub use shown::Shown;
pub use term::Term;
pub use tolerance::{Tolerance, ViewTolerance};
pub use upright::Upright;
pub use vertex_colors::VertexColors;
pub use view::View;
#[cfg(feature = "ecs")]
pub use view::{Framing, TightFit};
#[cfg(feature = "ecs")]
pub use viewport::{CameraTurn, Cameras, SharedPart, SharingCameras, current_camera};
pub use viewport::{Load, Part, Viewport};
pub use visibility::Visibility;
