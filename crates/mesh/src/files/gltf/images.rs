//! The images of textures.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use gltf::json::Root;
use gltf::json::buffer::View;
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::image::Image;
use gltf::json::validation::USize64;
use gltf::texture::{Info, MagFilter, MinFilter, WrappingMode};
use serde_json::Value;

use super::buffers::from_uri;
use super::extensions::{BASISU, WEBP};
use super::fault::Fault;
use crate::files::source::ModelFolder;
use crate::{SourceLevels, SourceMap, SourceWrap};

/// The extension that says where texture coordinates lie on an image.
pub(super) const TRANSFORM: &str = "KHR_texture_transform";

const NO_SUCH: &str = "its extension names an image that is not there";

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
    list: &'a [Image],
    views: &'a [View],
    buffers: &'a [Cow<'a, [u8]>],
    around: ModelFolder<'a>,
    read: HashMap<usize, Arc<[u8]>>,
    pub(super) warnings: Vec<String>,
    /// The textures that have been read, or warned of.
    pub(super) used: Vec<usize>,
}

impl<'a> Images<'a> {
    pub(super) fn new(json: &'a Root, buffers: &'a [Cow<'a, [u8]>], around: ModelFolder<'a>) -> Self {
        let (list, views) = (&json.images, &json.buffer_views);
        Self { list, views, buffers, around, read: HashMap::new(), warnings: Vec::new(), used: Vec::new() }
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
        let image = match self.source(texture) {
            Ok(image) => image,
            Err(reason) => {
                self.warnings.push(format!("materials[{material}]: the {field} texture is skipped, since {reason}"));
                return None;
            }
        };
        let name = match &self.list[image].uri {
            Some(uri) if !uri.starts_with("data:") => uri.clone(),
            _ => format!("images[{image}]"),
        };
        let bytes = match self.read.get(&image) {
            Some(bytes) => Arc::clone(bytes),
            None => self.bytes(&name, image),
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

    /// The image of a texture: that of an extension where it can be decoded, else the texture's own. Otherwise the reason.
    fn source(&mut self, texture: &gltf::Texture) -> Result<usize, String> {
        let of_extension = |extension| {
            let source = texture.extension_value(extension)?.get("source")?;
            Some(source.as_u64().and_then(|source| usize::try_from(source).ok()).unwrap_or(usize::MAX))
        };
        let (own, basis) = (texture.source().map(|image| image.index()), of_extension(BASISU));
        if let Some(image) = of_extension(WEBP) {
            return if image < self.list.len() { Ok(image) } else { own.ok_or_else(|| NO_SUCH.to_owned()) };
        }
        let index = texture.index();
        match (own, basis) {
            (Some(own), Some(_)) => {
                let instead = "the image for programs without Basis Universal";
                self.warnings.push(format!("textures[{index}]: {instead} is shown, since {BASISU} is not decoded"));
                Ok(own)
            }
            (Some(own), None) => Ok(own),
            (None, Some(_)) => Err(format!(
                "textures[{index}] is in Basis Universal ({BASISU}), which is not decoded; `ktx extract` gets a PNG out of it"
            )),
            (None, None) => Err(format!("textures[{index}] has no source")),
        }
    }

    fn bytes(&mut self, name: &str, index: usize) -> Arc<[u8]> {
        let image = &self.list[index];
        let read = match (&image.uri, image.buffer_view) {
            (_, Some(view)) => {
                let view = &self.views[view.value()];
                let whole = |size: USize64| usize::try_from(size.0).ok();
                let start = view.byte_offset.map_or(Some(0), whole);
                let range = start
                    .zip(whole(view.byte_length))
                    .and_then(|(start, length)| Some(start..start.checked_add(length)?));
                let part = range.and_then(|range| self.buffers.get(view.buffer.value())?.get(range));
                part.map(<[u8]>::to_vec).ok_or_else(|| "its buffer view reaches beyond its buffer".to_owned())
            }
            (Some(uri), None) => from_uri(name, uri, self.around).map_err(Fault::reason),
            (None, None) => Err("it has neither a uri nor a bufferView".to_owned()),
        };
        let bytes: Arc<[u8]> = read.map_or_else(
            |reason| {
                self.warnings.push(format!("{name}: the image cannot be read: {reason}"));
                Arc::from([])
            },
            Into::into,
        );
        self.read.insert(index, Arc::clone(&bytes));
        bytes
    }
}
