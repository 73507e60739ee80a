//! The images on objects of a scene file.

use std::path::PathBuf;

use halfway_asset::Handle;
use halfway_lighting::Range;
use halfway_texture::{
    Channel, FarNormals, LevelFilter, MapKind, Sampling, SurfaceMap, TexelFilter, Texture, UvSet, UvTransform, Wrap,
};

use crate::check::{Check, KeyProblem, Within, in_range};
use crate::keys::{Object, keys, words};

keys! {
    /// `maps`: the images on an object, one of each kind. null: none of that kind.
    #[derive(Clone, Debug, PartialEq)]
    pub struct MapsEntry {
        [optional]
        /// Its color multiplies ambient and diffuse light, and its alpha the opacity, unless there is an `opacity`.
        color: Option<MapEntry> = None,
        /// Its color multiplies highlights.
        specular: Option<MapEntry> = None,
        /// Its color multiplies the emission.
        emission: Option<MapEntry> = None,
        /// Its number multiplies the opacity.
        opacity: Option<MapEntry> = None,
        /// Its number multiplies the shininess, where highlights are shaded at the pixels.
        shininess: Option<MapEntry> = None,
        /// Its number multiplies ambient light.
        occlusion: Option<MapEntry> = None,
        /// Its colors are normals in the space of the mesh's tangents, where light is shaded at the pixels.
        normal: Option<MapEntry> = None,
        /// Its numbers are heights that turn the normals, where light is shaded at the pixels. Not beside a `normal`.
        height: Option<MapEntry> = None,
    }
}

impl Object for MapsEntry {
    const EXPECTED: &'static str = "an object such as {\"color\": {\"path\": \"image.png\"}}";

    fn check_whole(&self) -> Check {
        if self.normal.is_some() && self.height.is_some() {
            return Err(KeyProblem::new("height", "stands beside `normal`; expected one of them"));
        }
        // A relief may have any amount.
        let mut shares = self.iter().filter(|(kind, _)| !kind.perturbs_normals());
        shares.try_for_each(|(kind, entry)| in_range("amount", entry.amount, Range::UNIT).within(kind.name()))
    }
}

impl MapsEntry {
    /// All kinds, each with its image.
    pub fn each(&self) -> [(MapKind, Option<&MapEntry>); MapKind::COUNT] {
        let Self { color, specular, emission, opacity, shininess, occlusion, normal, height } = self;
        let entries = [color, specular, emission, opacity, shininess, occlusion, normal, height];
        std::array::from_fn(|slot| (MapKind::ALL[slot], entries[slot].as_ref()))
    }

    /// Those that are there.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (MapKind, &MapEntry)> {
        self.each().into_iter().filter_map(|(kind, entry)| Some((kind, entry?)))
    }
}

keys! {
    /// An image on an object.
    #[derive(Clone, Debug, PartialEq)]
    pub struct MapEntry {
        [required]
        /// An image file, as a PNG, JPEG, WebP or EXR, relative to the scene file. Required.
        path: PathBuf,
        [optional]
        /// The continuation of the image along u.
        wrap_u: Wrap = Wrap::default(),
        /// The continuation of the image along v.
        wrap_v: Wrap = Wrap::default(),
        /// The filter where a texel is larger than a pixel.
        magnify: TexelFilter = TexelFilter::default(),
        /// The filter within each level where a texel is smaller than a pixel.
        minify: TexelFilter = TexelFilter::default(),
        /// The filter where a texel is smaller than a pixel. Slopes of a `height` take levels alone.
        levels: LevelFilter = LevelFilter::default(),
        /// The mesh's coordinates are moved by this, in widths and heights of the image.
        offset: [f32; 2] = [0.0; 2],
        /// Before that they are turned by this angle in degrees, counter-clockwise as the image is seen.
        rotation_deg: f32 = 0.0,
        /// And first they are stretched by this.
        scale: [f32; 2] = [1.0; 2],
        /// Which of the mesh's coordinates are taken.
        uv_set: UvSet = UvSet::default(),
        /// Which number of the image is taken where one is.
        channel: Channel = Channel::default(),
        /// How much the image counts: 0 not at all, 1 in full; of normals what their slopes are multiplied by; of
        /// heights how high a 1 is, in lengths of the mesh.
        amount: f32 = 1.0,
        /// The treatment of highlights where texels of a `normal` image are smaller than a pixel.
        far_normals: FarNormals = FarNormals::default(),
    }
}

impl Object for MapEntry {
    const EXPECTED: &'static str = "an object such as {\"path\": \"image.png\"}";

    fn check_whole(&self) -> Check {
        if self.path.as_os_str().is_empty() {
            return Err(KeyProblem::new("path", "is empty; expected the path of a PNG or JPEG file"));
        }
        Ok(())
    }
}

impl MapEntry {
    /// The map with this image.
    pub(crate) fn with_texture(&self, texture: Handle<Texture>) -> SurfaceMap {
        let Self {
            wrap_u, wrap_v, magnify, minify, levels, offset, scale, uv_set, channel, amount, far_normals, ..
        } = *self;
        SurfaceMap {
            texture,
            sampling: Sampling { wrap: [wrap_u, wrap_v], magnify, minify, levels },
            uv_set,
            transform: UvTransform { offset, rotation: self.rotation_deg.to_radians(), scale },
            channel,
            amount,
            far_normals,
        }
    }
}

words! {
    /// The continuation of an image beyond its sides.
    Wrap {
        /// The image again.
        repeat = Self::Repeat,
        /// The image mirrored, and then again.
        mirror = Self::Mirror,
        /// Its outermost texels.
        clamp = Self::Clamp,
    }

    /// How texels become a value between them.
    TexelFilter {
        /// The texel that the point lies in.
        nearest = Self::Nearest,
        /// The mean of four, weighted by nearness along each axis.
        bilinear = Self::Bilinear,
        /// The cubic B-spline over sixteen: smooth, and softer than the texels.
        b_spline = Self::BSpline,
        /// The cubic of Catmull and Rom through the texels, over sixteen: sharper; it overshoots.
        catmull_rom = Self::CatmullRom,
    }

    /// The filter of an image that is minified.
    LevelFilter {
        /// The image itself, whose texels are then skipped.
        none = Self::None,
        /// The nearest in size.
        nearest = Self::Nearest,
        /// The two nearest in size, weighted by nearness.
        linear = Self::Linear,
        /// Images halved along each axis apart: the four nearest to the pixel's width and height on the image.
        ripmap = Self::Ripmap,
        /// The mean of a rectangle as wide and as high as the pixel.
        summed_areas = Self::SummedArea,
        /// Up to 2 lookups along the pixel's longer axis, of levels by its shorter one.
        anisotropic_2 = Self::Anisotropic2,
        /// Up to 4 lookups.
        anisotropic_4 = Self::Anisotropic4,
        /// Up to 8 lookups.
        anisotropic_8 = Self::Anisotropic8,
        /// Up to 16 lookups.
        anisotropic_16 = Self::Anisotropic16,
        /// All texels in the ellipse that a round pixel covers, weighted by a Gaussian.
        elliptical = Self::Elliptical,
    }

    /// The treatment of highlights under minified normals.
    FarNormals {
        /// Where their mean points.
        mean = Self::Mean,
        /// And how long it is: rough surfaces have wider and fainter highlights from afar.
        toksvig = Self::Toksvig,
        /// How far their slopes lie apart along each axis, by two more images: highlights need not be round.
        lean = Self::Lean,
    }

    /// Which of a mesh's coordinates on images.
    UvSet {
        /// The first.
        first = Self::First,
        /// The second, which glTF calls TEXCOORD_1.
        second = Self::Second,
    }

    /// One of the four numbers of a texel.
    Channel {
        /// The first; of a grey image any of three.
        red = Self::Red,
        /// The second.
        green = Self::Green,
        /// The third.
        blue = Self::Blue,
        /// The fourth.
        alpha = Self::Alpha,
    }
}
