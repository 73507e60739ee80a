//! The shapes that a scene names: surfaces made, model files loaded, their materials and lights translated.

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use bevy_color::LinearRgba;
use bevy_math::{DVec3, Mat4};
use bevy_transform::components::Transform;
use halfway_asset::Handle;
use halfway_mesh::{
    Animations, Lines, Mesh, Model, NormalReport, Normals, Property, SourceCamera, SourceMap, SourceMaterial,
};
use halfway_texture::{FarNormals, MapKind, Pyramid, SurfaceMap, TexelImage, TexelMeaning, Texture, UvSet};

use crate::error::SceneError;
use crate::import::{ModelMaterial, channel, maps, model_light, sampling, transform};
use crate::mesh::{LoadedModel, MeshEntry};
use crate::model_animation::Chosen;
use crate::named::NameOrIndex;
use crate::object::ObjectEntry;
use crate::options::{finish, unknown_material};
use crate::scalars::{ColorMap, Scalars};
use halfway_lighting::{AlphaMode, Faces, LightComponent, Material, VertexColors};

/// The mesh of an object.
pub(crate) struct ObjectShape {
    pub(crate) parts: Vec<ShapePart>,
    pub(crate) lines: Vec<ShapeLines>,
    pub(crate) lights: Vec<ShapeLight>,
    /// The model's cameras.
    pub(crate) cameras: Vec<SourceCamera>,
    /// The point of the object from which the places of all of them are counted.
    pub(crate) origin: DVec3,
    /// How the model moves, and the number of the animation that is played.
    pub(crate) animations: Option<(Arc<Animations>, usize)>,
}

/// One mesh of a shape, where it stands inside the object.
pub(crate) struct ShapePart {
    pub(crate) name: String,
    pub(crate) mesh: Mesh,
    pub(crate) object_from_part: Mat4,
    /// The model's own material.
    pub(crate) own: Option<ModelMaterial>,
    /// The images of the model's own material that its mesh can show; of numbers the image of their colours.
    pub(crate) maps: Vec<ModelMap>,
    /// The numbers that it shows.
    pub(crate) scalars: Option<ShownScalars>,
}

/// The colours of numbers.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct ShownScalars {
    pub(crate) map: ColorMap,
    /// The numbers at its ends; `None` where all are infinite or missing.
    pub(crate) range: Option<[f32; 2]>,
}

/// Lines and points of a shape, where they stand inside the object.
pub(crate) struct ShapeLines {
    pub(crate) name: String,
    pub(crate) lines: Lines,
    pub(crate) object_from_part: Mat4,
    /// The model's own material.
    pub(crate) own: Option<ModelMaterial>,
}

/// An image of a model's material, decoded, and the map that it is for, still without its handle.
#[derive(Clone)]
pub(crate) struct ModelMap {
    pub(crate) kind: MapKind,
    pub(crate) texture: Texture,
    pub(crate) map: SurfaceMap,
}

/// A light that came with a model, where it stands inside the object.
pub(crate) struct ShapeLight {
    pub(crate) name: String,
    pub(crate) light: LightComponent,
    pub(crate) object_from_light: Transform,
}

/// The material of a part that has none of its own: white under colours of vertices that nobody gave another, so that they
/// are seen as they are.
fn under(has_colors: bool, object: &ObjectEntry, given: Material) -> Material {
    let are_shown = has_colors && object.vertex_colors == VertexColors::Multiply;
    if are_shown && given == unknown_material() { finish(LinearRgba::WHITE) } else { given }
}

/// The shapes of a scene, each loaded once however often it is used.
pub(crate) struct Shapes<'a> {
    base_dir: &'a Path,
    loaded: HashMap<String, Rc<ObjectShape>>,
    pub(crate) warnings: Vec<String>,
    /// Warnings about models whose cameras are not used.
    pub(crate) unused_cameras: Vec<String>,
    pub(crate) chosen: Chosen<'a>,
}

impl<'a> Shapes<'a> {
    /// None yet; models play the wanted animation.
    pub(crate) fn new(base_dir: &'a Path, wanted: Option<&'a NameOrIndex>) -> Self {
        let chosen = Chosen::new(wanted);
        Self { base_dir, loaded: HashMap::new(), warnings: Vec::new(), unused_cameras: Vec::new(), chosen }
    }

    /// The shape of object `index`; equal ones are loaded once.
    pub(crate) fn load_once(&mut self, object: &ObjectEntry, index: usize) -> Result<Rc<ObjectShape>, SceneError> {
        let key = match &object.mesh {
            // Written out for one object; comparing it with others would cost more than it saves.
            MeshEntry::Inline(_) => None,
            MeshEntry::Path(path) => Some(format!("path {}", path.display())),
            // Its open parts are looked for only where nobody chose its faces.
            MeshEntry::Model(loaded) => {
                Some(format!("model {:?} {}", Arc::as_ptr(&loaded.model), object.faces.is_none()))
            }
            surface => Some(format!("{surface:?}")),
        };
        // Their values are not compared, as those of meshes.
        let key = key
            .filter(|_| object.scalars.is_none())
            .map(|key| format!("{key} {:?} {:?}", object.normals, object.displacement));
        let shape = if let Some(shape) = key.as_ref().and_then(|key| self.loaded.get(key)) {
            Rc::clone(shape)
        } else {
            let mut shape = self.load(object, index)?;
            shape.parts.iter_mut().for_each(ShapePart::whiten_under_scalars);
            Rc::new(shape)
        };
        if let Some(key) = key {
            self.loaded.insert(key, Rc::clone(&shape));
        }
        self.warn_of_opacity(object, &shape, index);
        Ok(shape)
    }

    /// An MTL file gives an opacity but cannot ask for blending.
    fn warn_of_opacity(&mut self, object: &ObjectEntry, shape: &ObjectShape, index: usize) {
        if object.material.is_some() || object.blend.is_some() {
            return;
        }
        let of_lines = shape.lines.iter().filter_map(|lines| lines.own.as_ref());
        let own = shape.parts.iter().filter_map(|part| part.own.as_ref()).chain(of_lines);
        let is_hidden = |own: &&ModelMaterial| own.material.opacity < 1.0 && own.alpha == AlphaMode::Opaque;
        let count = own.filter(is_hidden).count();
        if count > 0 {
            self.warnings.push(format!(
                "objects[{index}]: {count} parts have an opacity below 1, which is not shown without \"blend\": true"
            ));
        }
    }

    fn load(&mut self, object: &ObjectEntry, index: usize) -> Result<ObjectShape, SceneError> {
        let mesh = match &object.mesh {
            MeshEntry::Path(path) => {
                let path = self.base_dir.join(path);
                let model =
                    halfway_mesh::load(&path).map_err(|source| SceneError::Model { key: mesh_path(index), source })?;
                return self.model(model, &path, object, index);
            }
            MeshEntry::Model(LoadedModel { path, model, material }) => {
                let mut shape = self.model(Model::clone(model), path, object, index)?;
                for part in shape.parts.iter_mut().filter(|part| part.own.is_none()) {
                    let is_open = object.faces.is_none() && part.mesh.is_open();
                    let faces = if is_open { Faces::Both } else { Faces::default() };
                    let material = under(part.mesh.colors().is_some(), object, *material);
                    let alpha = AlphaMode::default();
                    part.own = Some(ModelMaterial { material, faces, shading: None, alpha });
                }
                for lines in shape.lines.iter_mut().filter(|lines| lines.own.is_none()) {
                    let material = under(lines.lines.colors().is_some(), object, *material);
                    let (faces, alpha) = (Faces::default(), AlphaMode::default());
                    lines.own = Some(ModelMaterial { material, faces, alpha, shading: None });
                }
                return Ok(shape);
            }
            MeshEntry::UvSphere(sphere) => Mesh::from(*sphere),
            MeshEntry::Plane(plane) => Mesh::from(*plane),
            MeshEntry::Box(cuboid) => Mesh::from(*cuboid),
            MeshEntry::Teapot(teapot) => Mesh::from(*teapot),
            MeshEntry::Icosphere(sphere) => Mesh::from(*sphere),
            MeshEntry::Surface(surface) => surface.mesh(self.base_dir).map_err(|message| SceneError::Value {
                key: format!("objects[{index}].mesh.{}", surface.name()),
                message,
            })?,
            MeshEntry::Inline(mesh) => mesh.mesh().map_err(|error| SceneError::Value {
                key: format!("objects[{index}].mesh.inline"),
                message: error.to_string(),
            })?,
        };
        let at = format!("objects[{index}]");
        let image = self.displacement(object, index);
        let (mesh, scalars, maps) = painted(object, index, mesh, (&[], 0))?;
        let (mesh, report) = self.displaced(object, mesh, image.as_ref(), &at).with_normals(object.normals);
        self.warn_of_normals(&at, report);
        let (name, object_from_part) = (String::new(), Mat4::IDENTITY);
        let part = ShapePart { name, mesh, object_from_part, own: None, maps, scalars };
        let (lines, lights, cameras) = (Vec::new(), Vec::new(), Vec::new());
        Ok(ObjectShape { parts: vec![part], lines, lights, cameras, animations: None, origin: DVec3::ZERO })
    }

    /// The image that displaces an object; of one that cannot be read there is a warning.
    fn displacement(&mut self, object: &ObjectEntry, index: usize) -> Option<Pyramid> {
        let mut warn = |what: String| self.warnings.push(format!("objects[{index}].displacement: {what}"));
        let entry = object.displacement.as_ref()?;
        let image = entry.load(self.base_dir).map_err(|error| warn(format!("{error}; nothing is displaced"))).ok()?;
        if let Some(what) = image.reduction() {
            warn(format!("{} {what}", entry.path.display()));
        }
        Some(Pyramid::new(image))
    }

    /// The mesh, displaced where it can be.
    fn displaced(&mut self, object: &ObjectEntry, mesh: Mesh, image: Option<&Pyramid>, at: &str) -> Mesh {
        let (Some(entry), Some(image)) = (&object.displacement, image) else { return mesh };
        entry.displaced(&mesh, image).unwrap_or_else(|error| {
            self.warnings.push(format!("{at}: {error}"));
            mesh
        })
    }

    fn model(
        &mut self,
        mut model: Model,
        path: &Path,
        object: &ObjectEntry,
        index: usize,
    ) -> Result<ObjectShape, SceneError> {
        let image = self.displacement(object, index);
        let file = path.display();
        self.warnings.extend(model.warnings.iter().map(|warning| format!("{file}: {warning}")));
        if !model.cameras.is_empty() {
            self.unused_cameras
                .push(format!("{file}: {} cameras are not used; a scene has its own", model.cameras.len()));
        }
        let maps = self.all_maps(&model, &file.to_string(), object.mark_missing_images);
        let materials = model.materials.iter().zip(&maps).map(|(material, maps)| {
            let at = format!("{file}: material {:?}", material.name());
            self.material(&with_images_shown(material, maps), at, index)
        });
        let materials = materials.collect::<Result<Vec<_>, _>>()?;
        let lights = model.lights.iter().map(|light| {
            let at = format!("{file}: light {:?}", light.name);
            let (component, object_from_light) =
                model_light(light).map_err(|source| SceneError::ModelValue { key: mesh_path(index), at, source })?;
            Ok(ShapeLight { name: light.name.clone(), light: component, object_from_light })
        });
        let lights = lights.collect::<Result<Vec<_>, SceneError>>()?;
        // Numbers are those of the vertices of the file, which normals may split.
        let properties = std::mem::take(&mut model.properties);
        let mut scalars = Vec::with_capacity(model.parts.len());
        for (number, part) in model.parts.iter_mut().enumerate() {
            let (mesh, shown, colors) = painted(object, index, part.mesh.clone(), (&properties, number))?;
            part.mesh = mesh;
            scalars.push((shown, colors));
        }
        if object.normals == Normals::Auto {
            model.make_auto_normals();
        }
        let mut parts = Vec::with_capacity(model.parts.len());
        for (part, (scalars, colors)) in model.parts.into_iter().zip(scalars) {
            let at = format!("{file}: part {:?}", part.name);
            let (mesh, report) = self.displaced(object, part.mesh, image.as_ref(), &at).with_normals(object.normals);
            self.warn_of_normals(&at, report);
            let own = part.material.and_then(|material| materials.get(material).copied());
            let maps = part.material.and_then(|material| maps.get(material)).cloned().unwrap_or_default();
            let maps = if scalars.is_some() { colors } else { maps };
            let (shown, hidden): (Vec<_>, Vec<_>) =
                maps.into_iter().partition(|image| mesh.uv_set(image.map.uv_set as usize).is_some());
            if !hidden.is_empty() {
                let names: Vec<_> = hidden.iter().map(|map| map.kind.name()).collect();
                let (name, maps) = (&part.name, names.join(", "));
                self.warnings.push(format!("{file}: part {name:?} has no texture coordinates for its images: {maps}"));
            }
            let object_from_part = part.world_from_part;
            parts.push(ShapePart { name: part.name, mesh, object_from_part, own, maps: shown, scalars });
        }
        let lines = model.lines.into_iter().map(|part| ShapeLines {
            name: part.name,
            lines: part.lines,
            object_from_part: part.world_from_part,
            own: part.material.and_then(|material| materials.get(material)).copied(),
        });
        let animations = model.animations.map(|animations| {
            let (clip, said) = self.chosen.clip(&animations, &file.to_string());
            self.warnings.extend(said);
            (animations, clip)
        });
        let moves_vertices = animations.as_ref().is_some_and(|(animations, _)| animations.moves_vertices());
        if moves_vertices && (object.displacement.is_some() || object.scalars.is_some()) {
            let because = "since they are displaced or show numbers";
            self.warnings.push(format!("{file}: vertices keep the pose of the file, {because}"));
        }
        let (lines, cameras) = (lines.collect(), model.cameras);
        Ok(ObjectShape { parts, lines, lights, cameras, animations, origin: model.origin })
    }

    fn material(&mut self, source: &SourceMaterial, at: String, index: usize) -> Result<ModelMaterial, SceneError> {
        match ModelMaterial::from_source(source) {
            Ok((material, warnings)) => {
                self.warnings.extend(warnings.iter().map(|warning| format!("{at}: {warning}")));
                Ok(material)
            }
            Err(source) => Err(SceneError::ModelValue { key: mesh_path(index), at, source }),
        }
    }

    /// The images of each material; `mark` says whether a checker takes the place of one that is missing or broken.
    fn all_maps(&mut self, model: &Model, file: &str, mark: bool) -> Vec<Vec<ModelMap>> {
        let mut images = HashMap::new();
        let mut of = |source: &SourceMaterial| {
            let maps = maps(source);
            let has = |kind| maps.iter().any(|(other, _)| *other == kind);
            let is_black = match source {
                SourceMaterial::Mtl(mtl) => mtl.ke == Some([0.0; 3]),
                SourceMaterial::MetallicRoughness(gltf) => gltf.emissive.iter().all(|channel| *channel == 0.0),
            };
            let mut warn = |what: &str| self.warnings.push(format!("{file}: material {:?}: {what}", source.name()));
            if has(MapKind::Emission) && is_black {
                warn("its emission is black, and so the image of its emission shows nothing");
            }
            if has(MapKind::Normal) && has(MapKind::Height) {
                warn("of its normal map and its bump map only the normal map is shown");
            }
            maps.into_iter().filter_map(|(kind, map)| self.map(kind, map, file, mark, &mut images)).collect()
        };
        model.materials.iter().map(&mut of).collect()
    }

    /// A material's image, each decoded once. One that is broken or missing is a checker, or left out.
    fn map(
        &mut self,
        kind: MapKind,
        source: &SourceMap,
        file: &str,
        mark: bool,
        images: &mut HashMap<(*const u8, TexelMeaning), Option<Texture>>,
    ) -> Option<ModelMap> {
        let texture = images.entry((source.bytes.as_ptr(), kind.meaning())).or_insert_with(|| {
            // Of an image that could not be read the model has warned.
            if source.bytes.is_empty() {
                return mark.then(Texture::missing);
            }
            let decoded = halfway_texture::decode(&source.bytes, &source.name, kind.meaning());
            if let Some(what) = decoded.as_ref().ok().and_then(TexelImage::reduction) {
                self.warnings.push(format!("{file}: {} {what}", source.name));
            }
            decoded.map_or_else(
                |error| {
                    let shown = if mark { "a checker is shown" } else { "the material is shown without it" };
                    self.warnings.push(format!("{file}: {error}; {shown}"));
                    mark.then(Texture::missing)
                },
                |image| Some(Texture::from(image)),
            )
        });
        let texture = texture.as_ref()?;
        let transform = transform(source);
        if transform.wrong().is_some() {
            self.warnings.push(format!("{file}: {} is skipped, since it lies at no finite place", source.name));
            return None;
        }
        let map = SurfaceMap {
            texture: Handle::default(),
            sampling: sampling(source),
            uv_set: if source.uv_set == 0 { UvSet::First } else { UvSet::Second },
            transform,
            channel: channel(source, kind, texture),
            amount: if kind.perturbs_normals() { source.amount } else { source.amount.clamp(0.0, 1.0) },
            far_normals: FarNormals::Mean,
        };
        Some(ModelMap { kind, texture: texture.clone(), map })
    }

    fn warn_of_normals(&mut self, at: &str, report: NormalReport) {
        for (count, what) in [
            (report.degenerate_triangles, "degenerate triangles have no normal"),
            (report.cancelled, "vertices whose faces cancel out take the largest face's normal"),
            (report.without_face, "vertices of no triangle with a normal take +Y"),
            (report.replaced, "normals of zero length are replaced"),
        ] {
            if count > 0 {
                self.warnings.push(format!("{at}: {count} {what}"));
            }
        }
    }
}

/// The material without those images that are not shown, which an MTL material takes for white.
fn with_images_shown(source: &SourceMaterial, shown: &[ModelMap]) -> SourceMaterial {
    let mut source = source.clone();
    if let SourceMaterial::Mtl(mtl) = &mut source {
        let is_shown = |kind| shown.iter().any(|map| map.kind == kind);
        for (kind, map) in [
            (MapKind::Specular, &mut mtl.maps.ks),
            (MapKind::Emission, &mut mtl.maps.ke),
            (MapKind::Opacity, &mut mtl.maps.d),
        ] {
            map.take_if(|_| !is_shown(kind));
        }
    }
    source
}

impl ShapePart {
    /// Numbers are shown on white without highlights, unless the object has a material.
    fn whiten_under_scalars(&mut self) {
        if self.scalars.is_some() {
            let (material, alpha) = (Material::matte(LinearRgba::WHITE), AlphaMode::Opaque);
            let (faces, shading) = self.own.map_or_else(Default::default, |own| (own.faces, own.shading));
            self.own = Some(ModelMaterial { material, faces, shading, alpha });
        }
    }
}

/// The mesh of a part in the colours of its numbers, if the object shows any, and the image of the colours.
fn painted(
    object: &ObjectEntry,
    index: usize,
    mesh: Mesh,
    (properties, part): (&[Property], usize),
) -> Result<(Mesh, Option<ShownScalars>, Vec<ModelMap>), SceneError> {
    let Some(entry) = &object.scalars else { return Ok((mesh, None, Vec::new())) };
    let wrong = |message| SceneError::Value { key: format!("objects[{index}].scalars"), message };
    let Some(scalars) = entry.scalars(properties, part).map_err(wrong)? else { return Ok((mesh, None, Vec::new())) };
    let (mesh, image) = scalars.on(&mesh).map_err(|error| wrong(error.to_string()))?;
    let map = Scalars::surface_map(Handle::default());
    let image = ModelMap { kind: MapKind::Color, texture: Texture::from(image), map };
    Ok((mesh, Some(ShownScalars { map: scalars.map, range: scalars.shown_range() }), vec![image]))
}

fn mesh_path(index: usize) -> String {
    format!("objects[{index}].mesh.path")
}
