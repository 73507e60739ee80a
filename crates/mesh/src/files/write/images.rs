//! The images of materials, as files beside the model.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::file::{WriteError, replace};
use crate::{AlphaMode, SourceChannel, SourceMap, SourceMaterial, SourceWrap};

/// The ending of an image's file by its first bytes; `None` for one that is no image or is not there.
pub(super) fn ending(bytes: &[u8]) -> Option<&'static str> {
    const MARKS: [(&[u8], &str); 9] = [
        (b"\x89PNG", "png"),
        (b"\xFF\xD8\xFF", "jpg"),
        (b"BM", "bmp"),
        (b"GIF8", "gif"),
        (b"II*\0", "tif"),
        (b"MM\0*", "tif"),
        (b"#?", "hdr"),
        (b"\x76\x2F\x31\x01", "exr"),
        (b"\xABKTX 20", "ktx2"),
    ];
    if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
        return Some("webp");
    }
    let marked = MARKS.iter().find(|(mark, _)| bytes.starts_with(mark)).map(|(_, ending)| *ending);
    // TGA has no mark at its beginning.
    marked.or((!bytes.is_empty()).then_some("tga"))
}

/// Images beside a file, under names of its own with numbers, which are safe and unique whatever the images were called.
pub(super) struct ImageFiles {
    path: PathBuf,
    images: Vec<(String, Arc<[u8]>)>,
    lost: BTreeMap<&'static str, usize>,
}

impl ImageFiles {
    pub(super) fn new(path: &Path) -> Self {
        Self { path: path.to_owned(), images: Vec::new(), lost: BTreeMap::new() }
    }

    /// The name of the file for an image, each of which is written once; `None` where there are no bytes.
    pub(super) fn name(&mut self, map: &SourceMap) -> Option<String> {
        if let Some((name, _)) = self.images.iter().find(|(_, bytes)| Arc::ptr_eq(bytes, &map.bytes)) {
            return Some(name.clone());
        }
        let Some(ending) = ending(&map.bytes) else {
            self.lose("images that could not be read");
            return None;
        };
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let mut number = self.images.len();
        let name = loop {
            let name = format!("{stem}_{number}.{ending}");
            // Somebody else's image keeps its name.
            let is_ours = self.images.iter().any(|(other, _)| *other == name);
            let is_free =
                std::fs::read(self.path.with_file_name(&name)).map_or(true, |bytes| bytes[..] == map.bytes[..]);
            if is_free && !is_ours {
                break name;
            }
            number += 1;
        };
        self.images.push((name.clone(), Arc::clone(&map.bytes)));
        Some(name)
    }

    /// Counts something that is not written.
    pub(super) fn lose(&mut self, what: &'static str) {
        *self.lost.entry(what).or_default() += 1;
    }

    /// Writes the files.
    pub(super) fn write(&self) -> Result<(), WriteError> {
        for (name, bytes) in &self.images {
            replace(&self.path.with_file_name(name), |file| std::io::Write::write_all(file, bytes))?;
        }
        Ok(())
    }

    pub(super) fn into_lost(self) -> impl Iterator<Item = String> {
        self.lost.into_iter().map(|(what, count)| format!("{count} {what}"))
    }

    /// The statements of an MTL file for a material's images.
    pub(super) fn statements(&mut self, source: &SourceMaterial) -> Vec<String> {
        let mut all = Vec::new();
        match source {
            SourceMaterial::Mtl(mtl) => {
                let maps = &mtl.maps;
                for (keyword, map) in [
                    ("map_Kd", &maps.kd),
                    ("map_Ks", &maps.ks),
                    ("map_Ke", &maps.ke),
                    ("map_d", &maps.d),
                    ("map_Ns", &maps.ns),
                    ("norm", &maps.norm),
                    ("map_Bump", &maps.bump),
                ] {
                    all.extend(map.as_ref().and_then(|map| self.statement(keyword, map)));
                }
            }
            SourceMaterial::MetallicRoughness(gltf) => {
                let maps = &gltf.maps;
                for (keyword, map) in [("map_Kd", &maps.base_color), ("map_Ke", &maps.emissive), ("norm", &maps.normal)]
                {
                    all.extend(map.as_ref().and_then(|map| self.statement(keyword, map)));
                }
                if let Some(map) = maps.base_color.as_ref().filter(|_| gltf.alpha != AlphaMode::Opaque) {
                    let alpha = SourceMap { channel: Some(SourceChannel::Alpha), ..map.clone() };
                    all.extend(self.statement("map_d", &alpha));
                }
                if maps.occlusion.is_some() {
                    self.lose("occlusion images");
                }
            }
        }
        all
    }

    fn statement(&mut self, keyword: &str, map: &SourceMap) -> Option<String> {
        let name = self.name(map)?;
        let SourceMap { wrap, offset, scale, .. } = map;
        let mut text = keyword.to_owned();
        if scale.iter().any(|s| s.to_bits() != 1.0_f32.to_bits()) {
            let _ = write!(text, " -s {} {} 1", scale[0], scale[1]);
        }
        // v runs upward there: 1 − (s·(1 − v) + o).
        let upward = 1.0 - scale[1] - offset[1];
        if offset[0] != 0.0 || upward != 0.0 {
            let _ = write!(text, " -o {} {upward} 0", offset[0]);
        }
        if wrap.contains(&SourceWrap::Clamp) {
            text += " -clamp on";
        }
        if map.rotation != 0.0 {
            self.lose("rotations of images");
        }
        if wrap[0] != wrap[1] || wrap.contains(&SourceWrap::Mirror) {
            self.lose("images that are mirrored, or end along one axis alone");
        }
        if map.uv_set != 0 {
            self.lose("images by the second texture coordinates, which take the first");
        }
        if keyword == "map_Bump" && map.amount.to_bits() != 1.0_f32.to_bits() {
            let _ = write!(text, " -bm {}", map.amount);
        }
        if let Some(channel) = map.channel {
            let letter = match channel {
                SourceChannel::Red => "r",
                SourceChannel::Green => "g",
                SourceChannel::Blue => "b",
                SourceChannel::Alpha => "m",
            };
            let _ = write!(text, " -imfchan {letter}");
        }
        Some(format!("{text} {name}"))
    }
}
