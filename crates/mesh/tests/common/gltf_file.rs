//! glTF files of tests, made of lists of numbers.

use halfway_mesh::{Format, LoadError, Model, load_bytes};

use super::glb;

/// The data of a file, and its accessors, each with a view of its own.
#[derive(Default)]
pub(crate) struct GltfFile {
    data: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl GltfFile {
    /// Adds an accessor of `f32`s; returns its number.
    pub(crate) fn floats(&mut self, shape: &str, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.list(shape, 5126, &bytes, 4)
    }

    /// Adds an accessor of bytes; returns its number.
    pub(crate) fn bytes(&mut self, shape: &str, numbers: &[u8]) -> usize {
        self.list(shape, 5121, numbers, 1)
    }

    /// Adds an accessor without a view; returns its number.
    pub(crate) fn zeros(&mut self, shape: &str, count: usize) -> usize {
        self.accessors.push(format!(r#"{{"componentType":5126,"type":"{shape}","count":{count}}}"#));
        self.accessors.len() - 1
    }

    fn list(&mut self, shape: &str, component: u32, bytes: &[u8], size: usize) -> usize {
        let width = match shape {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let (offset, length, view) = (self.data.len(), bytes.len(), self.views.len());
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#));
        self.data.extend(bytes);
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        let (count, bounds) = (length / (size * width), r#","min":[0,0,0],"max":[1,1,1]"#);
        let bounds = if shape == "VEC3" { bounds } else { "" };
        self.accessors.push(format!(
            r#"{{"bufferView":{view},"componentType":{component},"type":"{shape}","count":{count}{bounds}}}"#
        ));
        self.accessors.len() - 1
    }

    /// The JSON, with these members besides.
    pub(crate) fn json(&self, members: &str) -> String {
        let (views, accessors, length) = (self.views.join(","), self.accessors.join(","), self.data.len());
        format!(
            r#"{{"asset":{{"version":"2.0"}},{members},"accessors":[{accessors}],"bufferViews":[{views}],"buffers":[{{"byteLength":{length}}}]}}"#
        )
    }

    /// The binary file.
    pub(crate) fn glb(&self, members: &str) -> Vec<u8> {
        glb(&self.json(members), &self.data)
    }

    pub(crate) fn load(&self, members: &str) -> Result<Model, LoadError> {
        load_bytes(Format::Glb, &self.glb(members))
    }
}
