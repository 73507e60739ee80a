//! What is drawn: plain data, borrowed for one picture.

use crate::Pieces;
use halfway_texture::environment::EnvironmentMap;
use halfway_texture::{Channel, FarNormals, MapKind, Pyramid, Sampling, SolidTexture, UvSet};
use std::ops::Range;

/// All of a picture. Eye space is right-handed, the eye at the origin looking along −z; colors are linear RGB.
#[derive(Clone, Copy, Debug)]
pub struct Pass<'a> {
    /// Pixels in a row, and rows: 1 to [`LARGEST_SIDE`](crate::LARGEST_SIDE) each.
    pub size: [u32; 2],
    /// How many points a pixel takes.
    pub samples: SampleCount,
    /// What is written of a pixel.
    pub pixels: PixelFormat,
    /// The color where nothing is drawn.
    pub clear: [f32; 3],
    /// How eye space falls onto the picture.
    pub lens: Lens,
    /// Whether highlights are seen from the eye; else from (0, 0, 1) in every point.
    pub local_viewer: bool,
    /// The lights, in any order.
    pub lights: &'a [LightData],
    /// Numbers of lights, one list after the other; see [`LightRange`].
    pub lists: &'a [u32],
    /// What surfaces are made of, and how they are lit.
    pub surfaces: &'a [SurfaceData],
    /// Where meshes stand.
    pub instances: &'a [InstanceData],
    /// The meshes.
    pub meshes: &'a [&'a Pieces],
    /// The images on surfaces.
    pub maps: &'a [MapData],
    /// The environment.
    pub surroundings: Option<&'a SurroundingsData>,
    /// What is drawn, first to last. Of opaque fragments in equal depth the first drawn stays. Blended ones are drawn
    /// over all opaque ones, in this order.
    pub draws: &'a [DrawCall],
}

impl Pass<'_> {
    /// Whether the environment is seen where nothing is drawn.
    pub(crate) fn shows_sky(&self) -> bool {
        self.surroundings.is_some_and(|around| around.sky.is_some())
    }
}

/// How many points a pixel takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SampleCount {
    /// Its center.
    #[default]
    One,
    /// Four, at the places that graphics interfaces have agreed on; a triangle is shaded once for those that it covers.
    Four,
}

impl SampleCount {
    /// 1 or 4.
    pub fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Four => 4,
        }
    }
}

/// What is written of a pixel: red, green, blue, and 1 or 255 as alpha.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PixelFormat {
    /// Bytes, clamped and encoded as sRGB.
    #[default]
    SrgbBytes,
    /// Bytes, clamped intensities.
    RawBytes,
    /// `f32`, intensities as they are.
    Floats,
}

impl PixelFormat {
    /// Whether it is written as bytes.
    pub(crate) fn is_bytes(self) -> bool {
        self != Self::Floats
    }
}

/// A perspective with reversed depth and an infinite far plane: clip = (`scale`·xy, `near`, −z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// cot(fov/2)/aspect and cot(fov/2), above 0.
    pub scale: [f32; 2],
    /// Distance of the near plane, above 0. What is nearer is cut off.
    pub near: f32,
}

/// A light in eye space. Of a directional light only `position` and the colors count, of a point light no cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightData {
    /// Where it is; of a directional light the unit vector toward it.
    pub position: [f32; 3],
    /// 1/R, or 0 for no end.
    pub inverse_range: f32,
    /// `[a, b, c]` of 1/(a + b·d + c·d²).
    pub attenuation: [f32; 3],
    /// The way a spot shines, unit length.
    pub direction: [f32; 3],
    /// cos(cutoff).
    pub cos_cutoff: f32,
    /// e of cosᵉ φ.
    pub exponent: f32,
    /// Scale and offset of the inner cone's fade s = clamp(cos φ·scale + offset, 0, 1); 0 and 1 without an inner cone.
    pub inner_fade: [f32; 2],
    /// La, where it is attenuated; else black, and the color is part of [`SideData::base`].
    pub ambient: [f32; 3],
    /// Ld.
    pub diffuse: [f32; 3],
    /// Ls.
    pub specular: [f32; 3],
}

impl Default for LightData {
    /// A black one.
    fn default() -> Self {
        Self {
            position: [0.0, 0.0, 1.0],
            inverse_range: 0.0,
            attenuation: [1.0, 0.0, 0.0],
            direction: [0.0, 0.0, -1.0],
            cos_cutoff: 0.0,
            exponent: 0.0,
            inner_fade: [0.0, 1.0],
            ambient: [0.0; 3],
            diffuse: [0.0; 3],
            specular: [0.0; 3],
        }
    }
}

/// Some of [`Pass::lists`]: `counts` directional, point and spot lights, in this order, from `start` on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightRange {
    /// How many directional, point and spot lights.
    pub counts: [u32; 3],
    /// The first number's place in the lists.
    pub start: u32,
}

impl LightRange {
    /// How many lights.
    pub fn len(&self) -> u64 {
        self.counts.iter().map(|&count| u64::from(count)).sum()
    }

    /// Whether it names none.
    pub fn is_empty(&self) -> bool {
        self.counts == [0; 3]
    }
}

/// What one side of a surface is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SideData {
    /// ke + ka·(Ga + Σ La) of the lights that do not attenuate their ambient.
    pub base: [f32; 3],
    /// kd.
    pub diffuse: [f32; 3],
    /// ks.
    pub specular: [f32; 3],
    /// ke of draws that are `colored` or have `maps`, a `mask` or a `solid`, apart from what colors multiply; of others
    /// it is part of the base, and this 0.
    pub emission: [f32; 3],
    /// ka, for the lights that attenuate their ambient.
    pub ambient: [f32; 3],
    /// The exponent of the highlight.
    pub exponent: f32,
    /// 0 to 1; counts where the draw blends.
    pub opacity: f32,
}

/// Both sides of a surface, and the lights that reach it by where and by which terms they are shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceData {
    /// The side whose corners are seen counter-clockwise, unless the draw says `clockwise`.
    pub front: SideData,
    /// The other side.
    pub back: SideData,
    /// Lights of the draw's vertex terms.
    pub vertex: LightRange,
    /// More of them, whose highlights are left out.
    pub vertex_diffuse: LightRange,
    /// More of them, of which nothing but their highlights is shaded.
    pub vertex_specular: LightRange,
    /// Lights of the draw's fragment terms.
    pub fragment: LightRange,
    /// More of them, whose highlights are left out.
    pub fragment_diffuse: LightRange,
    /// More of them, of which nothing but their highlights is shaded.
    pub fragment_specular: LightRange,
}

impl SurfaceData {
    /// The lights of the vertex terms: with all, with the diffuse alone, with the highlight alone.
    pub(crate) fn vertex_ranges(&self) -> [LightRange; 3] {
        [self.vertex, self.vertex_diffuse, self.vertex_specular]
    }

    /// The same of the fragment terms.
    pub(crate) fn fragment_ranges(&self) -> [LightRange; 3] {
        [self.fragment, self.fragment_diffuse, self.fragment_specular]
    }
}

/// An image, and where on it texture coordinates lie.
#[derive(Clone, Debug, PartialEq)]
pub struct MapData {
    /// The image.
    pub pyramid: Pyramid,
    /// Coordinates on it are the products of these rows with (u, v, 1).
    pub rows: [[f32; 3]; 2],
    /// How much it counts; see [`SurfaceMap::amount`](halfway_texture::SurfaceMap::amount).
    pub amount: f32,
}

/// An environment, as it lies around the eye.
#[derive(Clone, Debug, PartialEq)]
pub struct SurroundingsData {
    /// Its light.
    pub map: EnvironmentMap,
    /// What multiplies it.
    pub strength: f32,
    /// The rows of the rotation from eye space to the environment.
    pub rows: [[f32; 3]; 3],
    /// The polynomial of [`mean_light`](halfway_lighting::equations::mean_light).
    pub mean: [[f32; 3]; 9],
    /// The level that is seen where nothing is drawn, in place of the clear color.
    pub sky: Option<f32>,
}

/// An image that a draw looks up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapCall {
    /// Its number among [`Pass::maps`].
    pub map: u32,
    /// How it is looked up.
    pub sampling: Sampling,
    /// By which coordinates.
    pub uv_set: UvSet,
    /// The number that counts where one does.
    pub channel: Channel,
    /// What highlights take of normals beside where they point.
    pub far_normals: FarNormals,
}

/// Where a mesh stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceData {
    /// The rows of `eye_from_model`.
    pub eye_from_model: [[f32; 4]; 3],
    /// The columns of the normal matrix, sign(det M)·cof(M) up to a positive factor; negative where the surface is lit
    /// inside out.
    pub normal: [[f32; 3]; 3],
    /// The number of its surface.
    pub surface: u32,
}

/// Which terms are shaded; ambient that is attenuated goes with diffuse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadedTerms {
    /// ka·La where it is attenuated, and kd·Ld.
    pub diffuse: bool,
    /// ks·Ls.
    pub specular: bool,
}

impl ShadedTerms {
    /// All.
    pub const BOTH: Self = Self { diffuse: true, specular: true };

    /// Whether it is none.
    pub fn is_empty(self) -> bool {
        self == Self::default()
    }
}

/// The formula of highlights. A matched exponent is in [`SideData::exponent`] already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Highlight {
    /// max(r·v, 0)^α.
    Phong,
    /// max(n·h, 0)^β.
    #[default]
    BlinnPhong,
}

/// Which side of triangles is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LeftOut {
    /// The back: what is seen clockwise.
    #[default]
    Back,
    /// The front.
    Front,
    /// None.
    Neither,
}

/// Some triangles of a mesh for some instances.
#[derive(Clone, Debug, Default, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent fact about the draw")]
pub struct DrawCall {
    /// The number of the mesh.
    pub mesh: u32,
    /// The part of the mesh's index list; it begins and ends where the mesh was cut.
    pub indices: Range<u32>,
    /// The instances.
    pub instances: Range<u32>,
    /// The terms that are shaded at the vertices, or once a triangle.
    pub vertex: ShadedTerms,
    /// The terms that are shaded at the fragments.
    pub fragment: ShadedTerms,
    /// The vertex terms are shaded at the triangle's centroid with its own normal instead.
    pub flat: bool,
    /// The formula of highlights.
    pub highlight: Highlight,
    /// The side that is left out.
    pub left_out: LeftOut,
    /// Fronts wind clockwise: the transform mirrors, or the surface is lit inside out.
    pub clockwise: bool,
    /// Interpolated normals may vanish; where they do the triangle's own takes their place.
    pub opposite_normals: bool,
    /// The mesh's colors multiply base, diffuse and ambient, and the opacity.
    pub colored: bool,
    /// Images, each in the slot of its kind. Of the draw's two terms none is shaded both at the vertices and at the
    /// fragments then; nor where there is a `mask`.
    pub maps: [Option<MapCall>; MapKind::COUNT],
    /// Fragments of a lower opacity are not there.
    pub mask: Option<f32>,
    /// What the mesh is cut from, which multiplies base, diffuse and ambient at each pixel. As with `maps`, none of the
    /// draw's two terms is shaded both at the vertices and at the fragments then.
    pub solid: Option<SolidTexture>,
    /// The surface is lit inside out, which turns the tangents of a normal map.
    pub inside_out: bool,
    /// The environment lights it. Of the draw's two terms none is shaded both at the vertices and at the fragments
    /// then.
    pub surrounded: bool,
    /// Fragments are laid over what is there by their opacity, and leave the depth as it is.
    pub blend: bool,
}

impl DrawCall {
    /// Whether it has images, a mask, a solid or an environment.
    pub(crate) fn is_mapped(&self) -> bool {
        self.surrounded || self.solid.is_some() || self.mask.is_some() || self.maps.iter().any(Option::is_some)
    }
}

/// Where the picture goes: 4 values a pixel, row by row from the top.
#[derive(Debug)]
pub enum Output<'a> {
    /// For the two formats of bytes.
    Bytes(&'a mut [u8]),
    /// For [`PixelFormat::Floats`].
    Floats(&'a mut [f32]),
}
