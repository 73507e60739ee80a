//! The images of textures.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use gltf::image::Source;
use gltf::json::extensions::texture::TextureTransform;
use gltf::texture::{Info, MagFilter, MinFilter, WrappingMode};
use serde_json::Value;

use super::buffers::from_uri;
use super::fault::Fault;
use crate::files::source::ModelFolder;
use crate::{SourceLevels, SourceMap, SourceWrap};

/// The extension that says where texture coordinates lie on an image.
pub(super) const TRANSFORM: &str = "KHR_texture_transform";

/// The lookup of an image by a material.
pub(super) struct Lookup {
    pub(super) set: u32,
    pub(super) transform: Option<TexturePlace>,
    pub(super) amount: f32,
}

/// The transform of texture coordinates, and the set of coordinates if the extension names one.
pub(super) struct TexturePlace {
    offset: [f32; 2],
    rotation: f32,
    scale: [f32; 2],
    set: Option<u32>,
}

impl TexturePlace {
    pub(super) fn of_info(info: &Info) -> Option<Self> {
        let of = info.texture_transform()?;
        Some(Self { offset: of.offset(), rotation: of.rotation(), scale: of.scale(), set: of.tex_coord() })
    }

    /// From the extension of textures whose transform the `gltf` crate does not read.
    pub(super) fn of_value(value: &Value) -> Option<Self> {
        let TextureTransform { offset, rotation, scale, tex_coord, .. } = serde_json::from_value(value.clone()).ok()?;
        Some(Self { offset: offset.0, rotation: rotation.0, scale: scale.0, set: tex_coord })
    }
}

/// Reads each image once, when a material first refers to it; an unreadable image is a warning.
pub(super) struct Images<'a> {
    buffers: &'a [Cow<'a, [u8]>],
    around: ModelFolder<'a>,
    read: HashMap<usize, Arc<[u8]>>,
    pub(super) warnings: Vec<String>,
    /// The textures that have been read, or warned of.
    pub(super) used: Vec<usize>,
}

impl<'a> Images<'a> {
    pub(super) fn new(buffers: &'a [Cow<'a, [u8]>], around: ModelFolder<'a>) -> Self {
        Self { buffers, around, read: HashMap::new(), warnings: Vec::new(), used: Vec::new() }
    }

    /// Warns of a texture of a material that is not read, and of the consequence.
    pub(super) fn skip(&mut self, (material, field): (usize, &str), texture: &gltf::Texture, then: &str) {
        self.used.push(texture.index());
        self.warnings.push(format!("materials[{material}]: the {field} texture is skipped; {then}"));
    }

    /// A texture of a material, and its role there.
    pub(super) fn map(
        &mut self,
        (material, field): (usize, &str),
        texture: &gltf::Texture,
        Lookup { set, transform, amount }: &Lookup,
    ) -> Option<SourceMap> {
        let set = transform.as_ref().and_then(|placed| placed.set).unwrap_or(*set);
        if set > 1 {
            self.warnings.push(format!(
                "materials[{material}]: the {field} texture is skipped, since it takes the texture coordinates {set}"
            ));
            return None;
        }
        self.used.push(texture.index());
        let image = texture.source();
        let name = match image.source() {
            Source::Uri { uri, .. } if !uri.starts_with("data:") => uri.to_owned(),
            _ => format!("images[{}]", image.index()),
        };
        let bytes = match self.read.get(&image.index()) {
            Some(bytes) => Arc::clone(bytes),
            None => self.bytes(&name, &image),
        };
        let sampler = texture.sampler();
        let wrap = |mode| match mode {
            WrappingMode::Repeat => SourceWrap::Repeat,
            WrappingMode::MirroredRepeat => SourceWrap::Mirror,
            WrappingMode::ClampToEdge => SourceWrap::Clamp,
        };
        let (smooth_levels, levels) = match sampler.min_filter() {
            Some(MinFilter::Nearest) => (false, SourceLevels::None),
            Some(MinFilter::Linear) => (true, SourceLevels::None),
            Some(MinFilter::NearestMipmapNearest) => (false, SourceLevels::Nearest),
            Some(MinFilter::LinearMipmapNearest) => (true, SourceLevels::Nearest),
            Some(MinFilter::NearestMipmapLinear) => (false, SourceLevels::Linear),
            Some(MinFilter::LinearMipmapLinear) | None => (true, SourceLevels::Linear),
        };
        let mut map = SourceMap {
            wrap: [wrap(sampler.wrap_s()), wrap(sampler.wrap_t())],
            smooth: sampler.mag_filter() != Some(MagFilter::Nearest),
            smooth_levels,
            levels,
            uv_set: set as usize,
            amount: *amount,
            ..SourceMap::new(name, bytes)
        };
        if let Some(TexturePlace { offset, rotation, scale, .. }) = *transform {
            (map.offset, map.rotation, map.scale) = (offset, rotation, scale);
        }
        Some(map)
    }

    fn bytes(&mut self, name: &str, image: &gltf::Image) -> Arc<[u8]> {
        let read = match image.source() {
            Source::View { view, .. } => {
                let bytes = self.buffers.get(view.buffer().index());
                let end = view.offset().checked_add(view.length());
                let part = bytes.zip(end).and_then(|(bytes, end)| bytes.get(view.offset()..end));
                part.map(<[u8]>::to_vec).ok_or_else(|| "its buffer view reaches beyond its buffer".to_owned())
            }
            Source::Uri { uri, .. } => from_uri(name, uri, self.around).map_err(Fault::reason),
        };
        let bytes: Arc<[u8]> = read.map_or_else(
            |reason| {
                self.warnings.push(format!("{name}: the image cannot be read: {reason}"));
                Arc::from([])
            },
            Into::into,
        );
        self.read.insert(image.index(), Arc::clone(&bytes));
        bytes
    }
}
