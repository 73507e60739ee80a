//! A pass: plain data, borrowed for one picture.

use crate::Pieces;
use halfway_lighting::record::Cull;
use halfway_lighting::record::{InstanceRecord, LightRecord, SurfaceRecord};
use halfway_lighting::{Lens, Reflectance, Samples, Terms};
use halfway_texture::environment::SurroundingsData;
use halfway_texture::{Channel, FarNormals, MapKind, Pyramid, Sampling, SolidTexture, UvSet};
use std::ops::Range;

/// All of a picture. Eye space is right-handed, the eye at the origin looking along −z; colors are linear RGB.
#[derive(Clone, Copy, Debug)]
pub struct Pass<'a> {
    /// Pixels in a row, and rows: 1 to [`LARGEST_SIDE`](crate::LARGEST_SIDE) each.
    pub size: [u32; 2],
    /// The coverage samples a pixel.
    pub samples: Samples,
    /// The format of a pixel's values.
    pub pixels: PixelFormat,
    /// The color where nothing is drawn.
    pub clear: [f32; 3],
    /// How eye space falls onto the picture. Where its rays are parallel its far plane is finite.
    pub lens: Lens,
    /// Whether highlights are seen from the eye, at the origin; else from (0, 0, 1) in every point.
    pub local_viewer: bool,
    /// The lights, in any order.
    pub lights: &'a [LightRecord],
    /// Numbers of lights, one list after the other; see
    /// [`LightRange`](halfway_lighting::record::LightRange).
    pub lists: &'a [u32],
    /// The materials of surfaces, and their lights.
    pub surfaces: &'a [SurfaceRecord],
    /// The transforms of meshes, with their surfaces.
    pub instances: &'a [InstanceRecord],
    /// The meshes.
    pub meshes: &'a [&'a Pieces],
    /// The images on surfaces.
    pub maps: &'a [MapData],
    /// The environment.
    pub surroundings: Option<&'a SurroundingsData>,
    /// The draws, first to last. Of opaque fragments at equal depth the first drawn stays. Blended ones are drawn over
    /// all opaque ones, in this order.
    pub draws: &'a [DrawCall],
}

impl Pass<'_> {
    /// Whether the environment is drawn as the sky.
    pub(crate) fn shows_sky(&self) -> bool {
        self.surroundings.is_some_and(|around| around.sky.is_some())
    }
}

/// The values of a pixel: red, green, blue, and 1 or 255 as alpha.
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

/// An image, and its transform of texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct MapData {
    /// The image.
    pub pyramid: Pyramid,
    /// Coordinates on it are the products of these rows with (u, v, 1).
    pub rows: [[f32; 3]; 2],
    /// The strength; see [`SurfaceMap::amount`](halfway_texture::SurfaceMap::amount).
    pub amount: f32,
}

/// An image that a draw looks up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapCall {
    /// Its number among [`Pass::maps`].
    pub map: u32,
    /// The filters and the wrapping.
    pub sampling: Sampling,
    /// The set of texture coordinates.
    pub uv_set: UvSet,
    /// The channel, for images of single numbers.
    pub channel: Channel,
    /// The treatment of highlights under minified normals.
    pub far_normals: FarNormals,
}

/// The images, mask, solid and environment that a draw's fragments read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DrawMaps {
    /// Images, each in the slot of its kind.
    pub calls: [Option<MapCall>; MapKind::COUNT],
    /// Fragments of a lower opacity are discarded.
    pub mask: Option<f32>,
    /// The solid that the mesh is cut from: it multiplies base, diffuse and ambient at each pixel.
    pub solid: Option<SolidTexture>,
    /// The surface is lit inside out, which flips the tangents of a normal map.
    pub inside_out: bool,
    /// The environment lights it.
    pub surrounded: bool,
}

impl DrawMaps {
    pub(crate) fn has(&self, kind: MapKind) -> bool {
        self.calls[kind as usize].is_some()
    }

    /// Whether images change the exponent of highlights.
    pub(crate) fn changes_exponents(&self) -> bool {
        self.has(MapKind::Shininess) || self.far_normals() != FarNormals::Mean
    }

    /// How highlights widen with the normals of an image that are smaller than a pixel.
    pub(crate) fn far_normals(&self) -> FarNormals {
        self.calls[MapKind::Normal as usize].map_or(FarNormals::Mean, |call| call.far_normals)
    }
}

/// Some triangles of a mesh for some instances.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent fact about the draw")]
pub struct DrawCall {
    /// The number of the mesh.
    pub mesh: u32,
    /// The part of the mesh's index list; it begins and ends where the mesh was cut.
    pub indices: Range<u32>,
    /// The instances.
    pub instances: Range<u32>,
    /// The frequency of each term.
    pub terms: Terms,
    /// The formula of highlights. For matched highlights the material's exponent is already matched.
    pub reflectance: Reflectance,
    /// The culled side.
    pub cull: Cull,
    /// Fronts wind clockwise: the transform mirrors, or the surface is lit inside out.
    pub clockwise: bool,
    /// Interpolated normals may vanish, and are then replaced by the triangle's own.
    pub opposite_normals: bool,
    /// The mesh's colors multiply base, diffuse and ambient, and the opacity.
    pub colored: bool,
    /// Images, a mask, a solid and an environment.
    pub maps: Option<DrawMaps>,
    /// Fragments are blended by their opacity, and do not write depth.
    pub blend: bool,
}

impl Default for DrawCall {
    /// Nothing.
    fn default() -> Self {
        Self {
            mesh: 0,
            indices: 0..0,
            instances: 0..0,
            terms: Terms::NONE,
            reflectance: Reflectance::default(),
            cull: Cull::default(),
            clockwise: false,
            opposite_normals: false,
            colored: false,
            maps: None,
            blend: false,
        }
    }
}

/// The memory of the picture: 4 values a pixel, row by row from the top.
#[derive(Debug)]
pub enum Output<'a> {
    /// For the two formats of bytes.
    Bytes(&'a mut [u8]),
    /// For [`PixelFormat::Floats`].
    Floats(&'a mut [f32]),
}
