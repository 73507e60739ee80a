//! glTF 2.0, binary or as text with files beside it.

mod moving;

use std::collections::HashMap;
use std::io::Write as _;
use std::path::Path;

use glam::{DMat4, DVec3, Mat4, Vec2, Vec3, Vec4};
use serde_json::{Map, Value, json};

use super::file::{WriteError, replace};
use super::images::{ImageFiles, ending};
use super::quantise::{Grid, signed, unsigned};
use crate::animation::Shape;
use crate::files::Format;
use crate::{
    AlphaMode, Bounds, GltfMaps, LinePart, Mesh, MetallicRoughness, Model, MtlMaterial, Part, SourceCamera,
    SourceLevels, SourceLight, SourceLightKind, SourceMap, SourceMaterial, SourceProjection, SourceWrap,
};

const FLOAT: u32 = 5126;
const SHORT: u32 = 5122;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
/// Modes of primitives.
const POINTS: u32 = 0;
const LINES: u32 = 1;

/// Writes a node for each part, group of lines, light and camera, or those of the model's animations; parts that share a
/// mesh and a material share it in the file. Returns also how far a position moved at most.
pub(super) fn write(path: &Path, model: &Model, quantised: bool) -> Result<(f64, Vec<String>), WriteError> {
    let in_text = Format::from_path(path) == Some(Format::Gltf);
    let mut file = Document { quantised, in_text, ..Document::default() };
    let mut maps = Maps::new(path);
    let mut lost = Vec::new();
    match &model.animations {
        Some(animations) if moving::fits(animations, model) => file.moving(animations, model),
        animations => {
            lost.extend(animations.as_ref().map(|animations| {
                let count = animations.clips.len();
                format!("{count} animations, which no longer fit the model; it is written as it stands")
            }));
            file.still(model);
        }
    }
    let materials = model.materials.iter().map(|source| maps.material(source, &mut file)).collect();
    let mut json = file.json(materials, &maps);
    maps.files.write()?;
    let mtl = model.materials.iter().filter(|source| matches!(source, SourceMaterial::Mtl(_))).count();
    if mtl > 0 {
        lost.push(format!("{mtl} MTL materials lose Ka, Ks, illum and what is above 1; Ns becomes a roughness"));
    }
    lost.extend(maps.files.into_lost());
    if in_text {
        let buffer = path.with_extension("bin");
        replace(&buffer, |out| out.write_all(&file.data))?;
        json["buffers"][0]["uri"] = json!(uri(&buffer.file_name().unwrap_or_default().to_string_lossy()));
        replace(path, |out| out.write_all(json.to_string().as_bytes()))?;
        return Ok((file.moved, lost));
    }
    // Chunks are padded to four bytes, the JSON with spaces.
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + file.data.len();
    let Ok(whole) = u32::try_from(length) else {
        return Err(WriteError::TooLarge { path: path.to_owned(), what: format!("{length} bytes") });
    };
    replace(path, |out| {
        out.write_all(b"glTF")?;
        out.write_all(&2_u32.to_le_bytes())?;
        out.write_all(&whole.to_le_bytes())?;
        out.write_all(&(text.len() as u32).to_le_bytes())?;
        out.write_all(b"JSON")?;
        out.write_all(&text)?;
        out.write_all(&(file.data.len() as u32).to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        out.write_all(&file.data)
    })?;
    Ok((file.moved, lost))
}

/// A file's name as a URI (RFC 3986).
fn uri(name: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~".contains(&byte);
    let encode = |byte: u8| if is_plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    name.bytes().map(encode).collect()
}

#[derive(Default)]
struct Document {
    /// Whether vertices are integers of 16 bits.
    quantised: bool,
    /// Whether the buffer and the images are files beside this one.
    in_text: bool,
    /// The binary chunk; every array in it starts at a multiple of four bytes.
    data: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    /// The nodes without a parent.
    roots: Vec<usize>,
    lights: Vec<Value>,
    cameras: Vec<Value>,
    skins: Vec<Value>,
    animations: Vec<Value>,
    /// The meshes already written, by the address of their data and by material.
    written: HashMap<(*const Vec3, Option<usize>), usize>,
    /// How far a position moved at most.
    moved: f64,
}

impl Document {
    /// A model that does not move.
    fn still(&mut self, model: &Model) {
        for part in &model.parts {
            let (mesh, part_from_mesh) = self.mesh(part, None);
            let world_from_mesh = match part_from_mesh {
                Some(part_from_mesh) => (part.world_from_part.as_dmat4() * part_from_mesh).as_mat4(),
                None => part.world_from_part,
            };
            self.root(&part.name, world_from_mesh, "mesh", mesh);
        }
        for part in &model.lines {
            let mesh = self.lines(part);
            self.root(&part.name, part.world_from_part, "mesh", mesh);
        }
        for light in &model.lights {
            let extensions = self.light(light);
            self.root("", light.world_from_light, "extensions", extensions);
        }
        for camera in &model.cameras {
            let index = self.camera(camera);
            self.root("", camera.world_from_camera, "camera", index);
        }
        if model.origin != DVec3::ZERO {
            // Numbers of JSON have 64 bits, those of accessors 32.
            self.nodes.push(json!({ "translation": model.origin.to_array(), "children": self.roots }));
            self.roots = vec![self.nodes.len() - 1];
        }
    }

    fn root(&mut self, name: &str, world_from_node: Mat4, key: &str, value: Value) {
        let node = self.node(name, world_from_node.as_dmat4(), key, value);
        self.roots.push(node);
    }

    /// The number of a part's mesh, and the transform that its integers take, if they are such. A mesh whose vertices
    /// move is written as it is before anything moves it, in floats, since displacements and skins count from it.
    fn mesh(&mut self, part: &Part, shape: Option<&Shape>) -> (Value, Option<DMat4>) {
        let base = shape.map_or(&part.mesh, |shape| &shape.mesh);
        let key = (base.positions().as_ptr(), part.material);
        let mesh = if let Some(&mesh) = self.written.get(&key) {
            mesh
        } else {
            let mesh = self.new_mesh(part, shape);
            self.written.insert(key, mesh);
            mesh
        };
        let is_in_steps = self.quantised && shape.is_none();
        (json!(mesh), is_in_steps.then(|| Grid::for_mesh(base).mesh_from_steps()))
    }

    fn new_mesh(&mut self, part: &Part, shape: Option<&Shape>) -> usize {
        let mesh = shape.map_or(&part.mesh, |shape| &shape.mesh);
        let attributes = match shape {
            Some(shape) => self.attributes_of(shape),
            None if self.quantised => self.integers_of(mesh),
            None => self.floats_of(mesh, true),
        };
        let indices = self.indices(mesh.indices(), mesh.positions().len());
        let mut primitive = json!({ "attributes": attributes, "indices": indices });
        if let Some(shape) = shape.filter(|shape| !shape.targets.is_empty()) {
            primitive["targets"] = self.targets(shape);
        }
        if let Some(material) = part.material {
            primitive["material"] = json!(material);
        }
        self.meshes.push(json!({ "primitives": [primitive] }));
        self.meshes.len() - 1
    }

    /// The number of the mesh of lines and points.
    fn lines(&mut self, part: &LinePart) -> Value {
        let key = (part.lines.address(), part.material);
        let mesh = if let Some(&mesh) = self.written.get(&key) {
            mesh
        } else {
            let mesh = self.line_mesh(part);
            self.written.insert(key, mesh);
            mesh
        };
        json!(mesh)
    }

    /// A primitive of lines and one of points, as far as there are any.
    fn line_mesh(&mut self, part: &LinePart) -> usize {
        let lines = &part.lines;
        let mut attributes = Map::new();
        attributes.insert("POSITION".to_owned(), json!(self.positions(lines.positions())));
        if let Some(normals) = lines.normals() {
            attributes.insert("NORMAL".to_owned(), json!(self.floats("VEC3", normals.iter().map(Vec3::to_array))));
        }
        if let Some(colors) = lines.colors() {
            attributes.insert("COLOR_0".to_owned(), json!(self.floats("VEC4", colors.iter().map(Vec4::to_array))));
        }
        let mut primitives = Vec::new();
        for (mode, indices) in [(LINES, lines.segments().as_flattened()), (POINTS, lines.points())] {
            if !indices.is_empty() {
                let indices = self.indices(indices, lines.positions().len());
                let mut primitive = json!({ "mode": mode, "attributes": attributes, "indices": indices });
                if let Some(material) = part.material {
                    primitive["material"] = json!(material);
                }
                primitives.push(primitive);
            }
        }
        self.meshes.push(json!({ "primitives": primitives }));
        self.meshes.len() - 1
    }

    /// The attributes of a mesh; without its normals where those are made anew when it is read.
    fn floats_of(&mut self, mesh: &Mesh, has_normals: bool) -> Map<String, Value> {
        let mut attributes = Map::new();
        attributes.insert("POSITION".to_owned(), json!(self.positions(mesh.positions())));
        if has_normals {
            let normals = self.floats("VEC3", mesh.normals().iter().map(Vec3::to_array));
            attributes.insert("NORMAL".to_owned(), json!(normals));
        }
        for (set, uvs) in (0..2).filter_map(|set| Some((set, mesh.uv_set(set)?))) {
            attributes.insert(format!("TEXCOORD_{set}"), json!(self.floats("VEC2", uvs.iter().map(Vec2::to_array))));
        }
        if let Some(colors) = mesh.colors() {
            attributes.insert("COLOR_0".to_owned(), json!(self.floats("VEC4", colors.iter().map(Vec4::to_array))));
        }
        if let Some(tangents) = mesh.tangents() {
            attributes.insert("TANGENT".to_owned(), json!(self.floats("VEC4", tangents.iter().map(Vec4::to_array))));
        }
        attributes
    }

    /// Positions with the least and the greatest of all, used or not, as the format asks.
    fn positions(&mut self, positions: &[Vec3]) -> usize {
        let accessor = self.floats("VEC3", positions.iter().map(Vec3::to_array));
        if let Some(bounds) = Bounds::from_points(positions.iter().copied()) {
            self.accessors[accessor]["min"] = json!(bounds.min.to_array());
            self.accessors[accessor]["max"] = json!(bounds.max.to_array());
        }
        accessor
    }

    fn integers_of(&mut self, mesh: &Mesh) -> Map<String, Value> {
        let grid = Grid::for_mesh(mesh);
        self.moved = self.moved.max(grid.largest_error());
        let steps: Vec<[u16; 3]> = mesh.positions().iter().map(|p| grid.round(p.as_dvec3())).collect();
        let bound = |pick: fn(u16, u16) -> u16| {
            steps.iter().copied().reduce(|a, b| [0, 1, 2].map(|axis| pick(a[axis], b[axis]))).unwrap_or_default()
        };
        let (min, max) = (bound(u16::min), bound(u16::max));
        let positions = self.shorts(UNSIGNED_SHORT, "VEC3", steps.iter().map(|[x, y, z]| [*x, *y, *z, 0]), false);
        self.accessors[positions]["min"] = json!(min);
        self.accessors[positions]["max"] = json!(max);
        let mut attributes = Map::new();
        attributes.insert("POSITION".to_owned(), json!(positions));
        // The bits of a SHORT are written as those of an UNSIGNED_SHORT.
        let direction = |n: [f32; 3], w: i16| [signed(n[0]), signed(n[1]), signed(n[2]), w].map(|x| x as u16);
        let normals = mesh.normals().iter().map(|n| direction(n.to_array(), 0));
        attributes.insert("NORMAL".to_owned(), json!(self.shorts(SHORT, "VEC3", normals, true)));
        if let Some(tangents) = mesh.tangents() {
            let tangents = tangents.iter().map(|t| direction(t.truncate().to_array(), signed(t.w)));
            attributes.insert("TANGENT".to_owned(), json!(self.shorts(SHORT, "VEC4", tangents, true)));
        }
        for (set, uvs) in (0..2).filter_map(|set| Some((set, mesh.uv_set(set)?))) {
            let unit = uvs.iter().all(|uv| uv.min_element() >= 0.0 && uv.max_element() <= 1.0);
            let coordinates = if unit {
                self.shorts(UNSIGNED_SHORT, "VEC2", uvs.iter().map(|uv| uv.to_array().map(unsigned)), true)
            } else {
                self.floats("VEC2", uvs.iter().map(Vec2::to_array))
            };
            attributes.insert(format!("TEXCOORD_{set}"), json!(coordinates));
        }
        if let Some(colors) = mesh.colors() {
            let unit = colors.iter().all(|c| c.min_element() >= 0.0 && c.max_element() <= 1.0);
            let colors = if unit {
                self.shorts(UNSIGNED_SHORT, "VEC4", colors.iter().map(|c| c.to_array().map(unsigned)), true)
            } else {
                self.floats("VEC4", colors.iter().map(Vec4::to_array))
            };
            attributes.insert("COLOR_0".to_owned(), json!(colors));
        }
        attributes
    }

    /// Integers of 16 bits, rows of which start at multiples of four bytes as glTF has it.
    fn shorts<const N: usize>(
        &mut self,
        component: u32,
        shape: &str,
        items: impl ExactSizeIterator<Item = [u16; N]>,
        normalized: bool,
    ) -> usize {
        let count = items.len();
        let bytes = items.flatten().flat_map(u16::to_le_bytes);
        let accessor = self.accessor(bytes, Some(ARRAY_BUFFER), component, shape, count);
        if normalized {
            self.accessors[accessor]["normalized"] = json!(true);
        }
        if let Some(view) = self.views.last_mut() {
            view["byteStride"] = json!(2 * N);
        }
        accessor
    }

    /// The corners of triangles, in 16 bits if that is asked for and suffices.
    fn indices(&mut self, indices: &[u32], vertices: usize) -> usize {
        let (target, count) = (Some(ELEMENT_ARRAY_BUFFER), indices.len());
        if !self.quantised || vertices > usize::from(u16::MAX) {
            let bytes = indices.iter().flat_map(|index| index.to_le_bytes());
            return self.accessor(bytes, target, UNSIGNED_INT, "SCALAR", count);
        }
        let bytes = indices.iter().flat_map(|&index| (index as u16).to_le_bytes());
        let accessor = self.accessor(bytes, target, UNSIGNED_SHORT, "SCALAR", count);
        // The next array starts at a multiple of four bytes.
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        accessor
    }

    fn floats<const N: usize>(&mut self, shape: &str, items: impl ExactSizeIterator<Item = [f32; N]>) -> usize {
        let count = items.len();
        let bytes = items.flatten().flat_map(f32::to_le_bytes);
        self.accessor(bytes, Some(ARRAY_BUFFER), FLOAT, shape, count)
    }

    /// Adds an accessor with a view of its own; `target` is what the GPU uses the view for.
    fn accessor(
        &mut self,
        bytes: impl Iterator<Item = u8>,
        target: Option<u32>,
        component: u32,
        shape: &str,
        count: usize,
    ) -> usize {
        let start = self.data.len();
        self.data.extend(bytes);
        let length = self.data.len() - start;
        let mut view = json!({ "buffer": 0, "byteOffset": start, "byteLength": length });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        let view = self.views.len() - 1;
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "type": shape, "count": count }));
        self.accessors.len() - 1
    }

    /// Adds a node; returns its number.
    fn node(&mut self, name: &str, parent_from_node: DMat4, key: &str, value: Value) -> usize {
        let mut node = Map::new();
        if !name.is_empty() {
            node.insert("name".to_owned(), json!(name));
        }
        if parent_from_node != DMat4::IDENTITY {
            node.insert("matrix".to_owned(), json!(parent_from_node.to_cols_array()));
        }
        node.insert(key.to_owned(), value);
        self.nodes.push(Value::Object(node));
        self.nodes.len() - 1
    }

    /// Adds a light; returns the extensions of its node.
    fn light(&mut self, light: &SourceLight) -> Value {
        let mut described = json!({ "color": light.color, "intensity": light.intensity });
        if !light.name.is_empty() {
            described["name"] = json!(light.name);
        }
        if let Some(range) = light.range {
            described["range"] = json!(range);
        }
        described["type"] = json!(match light.kind {
            SourceLightKind::Directional => "directional",
            SourceLightKind::Point => "point",
            SourceLightKind::Spot { inner, outer } => {
                described["spot"] = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
                "spot"
            }
        });
        self.lights.push(described);
        json!({ "KHR_lights_punctual": { "light": self.lights.len() - 1 } })
    }

    /// Adds a camera; returns its number.
    fn camera(&mut self, camera: &SourceCamera) -> Value {
        let mut described = match camera.projection {
            SourceProjection::Perspective { yfov, aspect, near, far } => {
                let mut perspective = json!({ "yfov": yfov, "znear": near });
                if let Some(aspect) = aspect {
                    perspective["aspectRatio"] = json!(aspect);
                }
                if let Some(far) = far {
                    perspective["zfar"] = json!(far);
                }
                json!({ "type": "perspective", "perspective": perspective })
            }
            SourceProjection::Orthographic { half_width, half_height, near, far } => json!({
                "type": "orthographic",
                "orthographic": { "xmag": half_width, "ymag": half_height, "znear": near, "zfar": far },
            }),
        };
        if !camera.name.is_empty() {
            described["name"] = json!(camera.name);
        }
        self.cameras.push(described);
        json!(self.cameras.len() - 1)
    }

    fn json(&self, materials: Vec<Value>, maps: &Maps) -> Value {
        let mut root = json!({
            "asset": { "version": "2.0", "generator": concat!("halfway ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": self.roots }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.data.len() }],
        });
        let has_unlit = materials.iter().any(|material| material.get("extensions").is_some());
        if !materials.is_empty() {
            root["materials"] = json!(materials);
        }
        for (key, values) in [("cameras", &self.cameras), ("skins", &self.skins), ("animations", &self.animations)] {
            if !values.is_empty() {
                root[key] = json!(values);
            }
        }
        let mut used = Vec::new();
        if self.quantised {
            used.push("KHR_mesh_quantization");
            root["extensionsRequired"] = json!(used);
        }
        if !self.lights.is_empty() {
            used.push("KHR_lights_punctual");
            root["extensions"] = json!({ "KHR_lights_punctual": { "lights": self.lights } });
        }
        if has_unlit {
            used.push("KHR_materials_unlit");
        }
        for (key, values) in [("images", &maps.images), ("textures", &maps.textures), ("samplers", &maps.samplers)] {
            if !values.is_empty() {
                root[key] = json!(values);
            }
        }
        if maps.has_transforms {
            used.push("KHR_texture_transform");
        }
        if maps.has_webp {
            used.push("EXT_texture_webp");
        }
        if !used.is_empty() {
            root["extensionsUsed"] = json!(used);
        }
        root
    }
}

/// The images of materials, and how they are looked up.
struct Maps {
    files: ImageFiles,
    images: Vec<Value>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    /// The images already written, by the address of their bytes.
    written: HashMap<*const u8, usize>,
    has_transforms: bool,
    has_webp: bool,
}

impl Maps {
    fn new(path: &Path) -> Self {
        Self {
            files: ImageFiles::new(path),
            images: Vec::new(),
            textures: Vec::new(),
            samplers: Vec::new(),
            written: HashMap::new(),
            has_transforms: false,
            has_webp: false,
        }
    }

    fn material(&mut self, source: &SourceMaterial, file: &mut Document) -> Value {
        let of_mtl;
        let pbr = match source {
            SourceMaterial::MetallicRoughness(pbr) => pbr,
            SourceMaterial::Mtl(mtl) => {
                let others = [&mtl.maps.ks, &mtl.maps.d, &mtl.maps.ns, &mtl.maps.bump];
                for _ in others.into_iter().flatten() {
                    self.files.lose("images of highlights, opacity or height, which glTF has in other forms");
                }
                of_mtl = metallic_roughness(mtl);
                &of_mtl
            }
        };
        let mut described = material(pbr);
        if let Some(map) = pbr.maps.base_color.as_ref().and_then(|map| self.texture(map, file)) {
            described["pbrMetallicRoughness"]["baseColorTexture"] = map;
        }
        for (key, map, amount) in [
            ("emissiveTexture", &pbr.maps.emissive, None),
            ("occlusionTexture", &pbr.maps.occlusion, Some("strength")),
            ("normalTexture", &pbr.maps.normal, Some("scale")),
        ] {
            let Some(map) = map else { continue };
            let Some(mut texture) = self.texture(map, file) else { continue };
            if let Some(amount) = amount {
                texture[amount] = json!(map.amount);
            }
            described[key] = texture;
        }
        described
    }

    /// The reference to an image; `None` for one that the format cannot hold.
    fn texture(&mut self, map: &SourceMap, file: &mut Document) -> Option<Value> {
        let kind = match ending(&map.bytes) {
            Some("png") => "image/png",
            Some("jpg") => "image/jpeg",
            Some("webp") => "image/webp",
            None => {
                self.files.lose("images that could not be read");
                return None;
            }
            Some(_) => {
                self.files.lose("images that are neither PNG nor JPEG nor WebP");
                return None;
            }
        };
        let image = if let Some(&image) = self.written.get(&map.bytes.as_ptr()) {
            image
        } else {
            let image = self.image(map, kind, file)?;
            self.images.push(image);
            self.written.insert(map.bytes.as_ptr(), self.images.len() - 1);
            self.images.len() - 1
        };
        let mut texture = json!({ "sampler": place_in(&mut self.samplers, sampler(map)) });
        if kind == "image/webp" {
            self.has_webp = true;
            texture["extensions"] = json!({ "EXT_texture_webp": { "source": image } });
        } else {
            texture["source"] = json!(image);
        }
        let mut reference = json!({ "index": place_in(&mut self.textures, texture) });
        if map.uv_set != 0 {
            reference["texCoord"] = json!(map.uv_set);
        }
        let SourceMap { offset, rotation, scale, .. } = map;
        let plain = SourceMap::new(String::new(), std::sync::Arc::from([]));
        if (*offset, *rotation, *scale) != (plain.offset, plain.rotation, plain.scale) {
            self.has_transforms = true;
            reference["extensions"] =
                json!({ "KHR_texture_transform": { "offset": offset, "rotation": rotation, "scale": scale } });
        }
        Some(reference)
    }

    fn image(&mut self, map: &SourceMap, kind: &str, file: &mut Document) -> Option<Value> {
        if file.in_text {
            return Some(json!({ "uri": uri(&self.files.name(map)?) }));
        }
        let start = file.data.len();
        file.data.extend_from_slice(&map.bytes);
        file.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": map.bytes.len() }));
        // The next view starts at a multiple of four bytes.
        file.data.resize(file.data.len().next_multiple_of(4), 0);
        Some(json!({ "bufferView": file.views.len() - 1, "mimeType": kind }))
    }
}

/// The index of a value in a list, which it is added to if it is not there.
fn place_in(values: &mut Vec<Value>, value: Value) -> usize {
    values.iter().position(|other| *other == value).unwrap_or_else(|| {
        values.push(value);
        values.len() - 1
    })
}

/// The filters and the wrapping of an image, by the numbers of OpenGL.
fn sampler(map: &SourceMap) -> Value {
    let wrap = map.wrap.map(|wrap| match wrap {
        SourceWrap::Repeat => 10497,
        SourceWrap::Mirror => 33648,
        SourceWrap::Clamp => 33071,
    });
    let minify = match (map.smooth_levels, map.levels) {
        (false, SourceLevels::None) => 9728,
        (true, SourceLevels::None) => 9729,
        (false, SourceLevels::Nearest) => 9984,
        (true, SourceLevels::Nearest) => 9985,
        (false, SourceLevels::Linear) => 9986,
        (true, SourceLevels::Linear) => 9987,
    };
    let magnify = if map.smooth { 9729 } else { 9728 };
    json!({ "magFilter": magnify, "minFilter": minify, "wrapS": wrap[0], "wrapT": wrap[1] })
}

fn material(pbr: &MetallicRoughness) -> Value {
    let mut described = json!({
        "pbrMetallicRoughness": {
            "baseColorFactor": pbr.base_color,
            "metallicFactor": pbr.metallic,
            "roughnessFactor": pbr.roughness,
        },
        "emissiveFactor": pbr.emissive,
        "doubleSided": pbr.double_sided,
    });
    if !pbr.name.is_empty() {
        described["name"] = json!(pbr.name);
    }
    if pbr.unlit {
        described["extensions"] = json!({ "KHR_materials_unlit": {} });
    }
    match pbr.alpha {
        AlphaMode::Opaque => {}
        AlphaMode::Mask { cutoff } => {
            described["alphaMode"] = json!("MASK");
            described["alphaCutoff"] = json!(cutoff);
        }
        AlphaMode::Blend => described["alphaMode"] = json!("BLEND"),
    }
    described
}

/// The nearest glTF material: with `Pr` and `Pm` where it has them, else no metal, with the roughness r for which the exponent 2/r⁴ − 2 of a Blinn–Phong lobe is
/// the material's (Walter et al. 2007, "Microfacet models for refraction", α = r²).
fn metallic_roughness(mtl: &MtlMaterial) -> MetallicRoughness {
    let [r, g, b] = mtl.kd.unwrap_or([0.8; 3]).map(|x| x.clamp(0.0, 1.0));
    let opacity = mtl.d.or(mtl.tr.map(|tr| 1.0 - tr)).unwrap_or(1.0).clamp(0.0, 1.0);
    let of_highlight = |ns: f32| (2.0 / (ns.max(0.0) + 2.0)).powf(0.25);
    MetallicRoughness {
        name: mtl.name.clone(),
        base_color: [r, g, b, opacity],
        metallic: mtl.pm.unwrap_or(0.0),
        roughness: mtl.pr.or(mtl.ns.map(of_highlight)).unwrap_or(1.0),
        // An image without a factor is to be seen.
        emissive: mtl.ke.unwrap_or(if mtl.maps.ke.is_some() { [1.0; 3] } else { [0.0; 3] }).map(|x| x.clamp(0.0, 1.0)),
        double_sided: false,
        unlit: false,
        alpha: if opacity < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque },
        specular_glossiness: None,
        maps: GltfMaps {
            base_color: mtl.maps.kd.clone(),
            emissive: mtl.maps.ke.clone(),
            normal: mtl.maps.norm.clone(),
            ..GltfMaps::default()
        },
    }
}
