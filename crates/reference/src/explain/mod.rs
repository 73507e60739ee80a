//! How a pixel came to its colour: every sample, surface, light and term.
//!
//! [`Oracle::explain`](crate::Oracle::explain) makes an [`Explanation`]; `text`, `latex` and `json` write it.

mod json;
mod latex;
mod numbers;
mod text;

use bevy_ecs::entity::Entity;
use halfway_lighting::equations::{Coefficients, Colors};
use halfway_lighting::lights::Kind;
use halfway_lighting::{Encoding, Frequency, Intensity, Reflectance, Terms};

/// How a pixel of the [`Oracle`](crate::Oracle) came to its colour.
///
/// Positions, normals and directions are in eye space: right-handed, the camera at the origin, looking along −Z; lengths
/// are world units, and directions have length 1. Colours are linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The column and the row of the pixel, from the top left, counted from 0.
    pub pixel: [u32; 2],
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Ga, the global ambient light.
    pub global_ambient: [f64; 3],
    /// The samples of the pixel, row by row.
    pub samples: Vec<ExplainedSample>,
    /// Whether each surface is clamped to 1 before it is blended.
    pub clamps_surfaces: bool,
    /// The mean of the samples.
    pub mean: [f64; 3],
    /// The camera's policy for intensities above 1.
    pub policy: Intensity,
    /// The number that the whole picture is divided by, under [`Intensity::Renormalize`].
    pub divisor: Option<f64>,
    /// The mean under the policy: the pixel of [`Oracle::draw`](crate::Oracle::draw).
    pub color: [f64; 3],
    /// The encoding of 8-bit pictures.
    pub encoding: Encoding,
    /// The colour, clamped to [0, 1] and encoded.
    pub encoded: [f64; 3],
    /// The bytes of an 8-bit picture.
    pub bytes: [u8; 3],
}

/// A sample of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedSample {
    /// Where its ray goes through the picture, in pixels from the top left corner.
    pub at: [f64; 2],
    /// The colour behind all surfaces: the background or the sky.
    pub background: [f64; 3],
    /// The visible surfaces in the order of drawing: the opaque one, then the blended ones before it.
    pub layers: Vec<ExplainedLayer>,
    /// The colour of the sample.
    pub color: [f64; 3],
}

/// A surface that a sample shows.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedLayer {
    /// The object.
    pub object: Entity,
    /// Its name, after the name of the one that it is a part of: `teapot/lid`.
    pub name: String,
    /// Its triangle; `None` where the surface that the mesh stands for is drawn.
    pub triangle: Option<ExplainedTriangle>,
    /// Whether the front is visible.
    pub front: bool,
    /// Distance along the view.
    pub depth: f64,
    /// p, the visible point.
    pub position: [f64; 3],
    /// n at the visible point, of the side that is seen: of the triangle under flat shading, else interpolated, and
    /// turned by images where a term is shaded there.
    pub normal: [f64; 3],
    /// Whether light has part in it; else it shows its base colour, as ka.
    pub lit: bool,
    /// How often its terms are shaded.
    pub terms: Terms,
    /// How it reflects.
    pub reflectance: Reflectance,
    /// The material at the visible point, with the vertex colours there, before images.
    pub material: Coefficients<f64>,
    /// The points at which the terms of the lights are evaluated: the centroid of the triangle, its three corners, the
    /// visible point, as `terms` has it.
    pub points: Vec<ExplainedPoint>,
    /// ka·(Ga + Σ La), La of the lights that do not attenuate it.
    pub steady_ambient: [f64; 3],
    /// The sums of the lights' terms: of corners, interpolated.
    pub lights: TermColors,
    /// The terms of the environment; black without one.
    pub environment: TermColors,
    /// The factors of images.
    pub factors: ImageFactors,
    /// The sums of all terms times the factors. With the emission they add up to the intensity.
    pub sums: TermColors,
    /// ke times its factor.
    pub emission: [f64; 3],
    /// I.
    pub intensity: [f64; 3],
    /// The opacity; 1 of what is not blended.
    pub opacity: f64,
    /// The colour behind it.
    pub behind: [f64; 3],
    /// The colour with it: opacity·I + (1 − opacity)·behind, I clamped where surfaces are.
    pub blended: [f64; 3],
}

/// The triangle of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExplainedTriangle {
    /// Its number in the mesh, from 0.
    pub number: u32,
    /// The numbers of its corners among the mesh's vertices.
    pub vertices: [u32; 3],
    /// The weights of the corners at the visible point.
    pub weights: [f64; 3],
}

/// A point at which terms of the lights are evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedPoint {
    /// The place that it stands for.
    pub at: Frequency,
    /// The number of the vertex, and its weight at the visible point.
    pub corner: Option<(u32, f64)>,
    /// p.
    pub position: [f64; 3],
    /// n, of the side that is seen.
    pub normal: [f64; 3],
    /// v, toward the viewer.
    pub view: [f64; 3],
    /// The material, with the vertex colours there, and its exponent under images.
    pub material: Coefficients<f64>,
    /// The lights in the order of their entities.
    pub lights: Vec<ExplainedLight>,
    /// The sum of the terms that are evaluated here.
    pub sums: TermColors,
}

/// A light at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedLight {
    /// Its entity.
    pub light: Entity,
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: Kind,
    /// La, Ld and Ls; `None` of light from all around.
    pub colors: Option<Colors<f64>>,
    /// Its way to the point; `None` of light from all around.
    pub way: Option<LightWay>,
    /// Whether its ambient colour is the same everywhere, and counted in [`ExplainedLayer::steady_ambient`].
    pub is_steady: bool,
    /// Its terms at the point, each whether or not it is evaluated there.
    pub terms: TermColors,
    /// Those of its terms that are evaluated here and count.
    pub counted: TermColors,
}

/// The way of a light to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightWay {
    /// l, toward the light.
    pub l: [f64; 3],
    /// d; `None` of a directional light.
    pub distance: Option<f64>,
    /// `[a, b, c]` of 1/(a + b·d + c·d²); `None` of a directional light.
    pub constants: Option<[f64; 3]>,
    /// att, without the range.
    pub attenuation: f64,
    /// The factor of the range, 1 without one.
    pub window: f64,
    /// The cosine of the angle from the axis of the cone, where there is one.
    pub cos_phi: Option<f64>,
    /// spot, 1 without a cone.
    pub spot: f64,
    /// n·l.
    pub n_dot_l: f64,
    /// Whether n·l is so small that the light counts as behind the surface, and adds neither diffuse nor specular.
    pub is_behind: bool,
    /// h under Blinn–Phong, r under Phong; `None` where l and v are opposite.
    pub direction: Option<[f64; 3]>,
    /// n·h or r·v.
    pub cosine: f64,
    /// The exponent of the highlight.
    pub exponent: f64,
    /// S: the cosine to that power, 0 where n·l is not above 0.
    pub power: f64,
}

impl LightWay {
    /// The divisor of the attenuation with these symbols for d, d² and a product, without terms that are 0.
    fn divisor(&self, distance: &str, square: &str, dot: &str) -> String {
        let [a, b, c] = self.constants.unwrap_or([1.0, 0.0, 0.0]);
        let times = |factor: f64, symbol: &str| match factor {
            0.0 => None,
            1.0 => Some(symbol.to_owned()),
            _ => Some(format!("{}{dot}{symbol}", numbers::given(factor))),
        };
        let constant = (a != 0.0).then(|| numbers::given(a));
        let terms = [constant, times(b, distance), times(c, square)];
        terms.into_iter().flatten().collect::<Vec<_>>().join(" + ")
    }

    /// Whether a range weakens the light.
    fn has_range(&self) -> bool {
        self.window < 1.0
    }
}

/// A colour for each term that lights have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TermColors {
    /// Ambient.
    pub ambient: [f64; 3],
    /// Diffuse.
    pub diffuse: [f64; 3],
    /// Specular.
    pub specular: [f64; 3],
}

impl TermColors {
    /// Ambient, diffuse, specular.
    pub fn each(&self) -> [[f64; 3]; 3] {
        [self.ambient, self.diffuse, self.specular]
    }
}

/// The factors of images, 1 where there are none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageFactors {
    /// Of ambient and diffuse light, by the colour image.
    pub color: [f64; 3],
    /// Of ambient and diffuse light, by the solid.
    pub solid: [f64; 3],
    /// Of ambient light, by the occlusion image.
    pub occlusion: f64,
    /// Of highlights, by the specular image.
    pub specular: [f64; 3],
    /// Of the emission, by the emission image.
    pub emission: [f64; 3],
}

impl ImageFactors {
    /// Whether no image changes anything.
    #[expect(clippy::float_cmp, reason = "without images the factors are 1 exactly")]
    fn are_one(&self) -> bool {
        let Self { color, solid, occlusion, specular, emission } = self;
        [color, solid, specular, emission].into_iter().flatten().all(|factor| *factor == 1.0) && *occlusion == 1.0
    }
}

/// The most lights of a point that are listed though they add nothing to it.
const MOST_DARK: usize = 6;

impl ExplainedPoint {
    /// Whether a light of the point is listed for readers: one of many that add nothing is not.
    fn lists(&self, light: &ExplainedLight) -> bool {
        !light.is_dark() || self.lights.iter().filter(|light| light.is_dark()).count() <= MOST_DARK
    }
}

impl ExplainedLight {
    /// Whether it adds nothing to the point, wherever its terms are evaluated.
    fn is_dark(&self) -> bool {
        self.terms.each().into_iter().all(numbers::is_black)
    }
}

/// The name of a shading as readers know it, and what it means.
fn shading_name(layer: &ExplainedLayer) -> String {
    use Frequency::{Fragment, Never, Triangle, Vertex};
    if !layer.lit {
        return "unlit: its base colour, whatever shines".to_owned();
    }
    let often = |frequency| match frequency {
        Never => "never",
        Triangle => "once a triangle",
        Vertex => "once a vertex",
        Fragment => "at the visible point",
    };
    match layer.terms {
        Terms { diffuse: Triangle, specular: Triangle } => "flat shading: once a triangle, at its centroid".to_owned(),
        Terms { diffuse: Vertex, specular: Vertex } => "Gouraud shading: once a vertex, interpolated".to_owned(),
        Terms { diffuse: Fragment, specular: Fragment } => {
            "Phong shading: at the visible point, with the interpolated normal".to_owned()
        }
        Terms { diffuse, specular } => {
            format!("diffuse terms {}, specular terms {}", often(diffuse), often(specular))
        }
    }
}
