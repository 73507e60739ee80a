//! The shapes that a scene names: surfaces made, model files loaded, their materials and lights translated.

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use bevy_math::{Mat4, Vec3};
use bevy_transform::components::Transform;
use halfway_lighting::conversion::{
    self, MetallicRoughnessNumbers, MtlNumbers, PunctualKind, PunctualLight, PunctualNumbers, RADIANCE_SCALE,
    from_metallic_roughness, from_mtl, from_punctual,
};
use halfway_lighting::{Faces, Material, rotation_along};
use halfway_mesh::{
    AlphaMode, Cuboid, Mesh, Model, NormalReport, Normals, Plane, SourceLight, SourceLightKind, SourceMaterial, Teapot,
    UvSphere,
};

use super::SceneError;
use super::mesh::{MeshEntry, NormalsEntry};
use super::object::ObjectEntry;

/// What an object shows.
pub(super) struct Shape {
    pub(super) parts: Vec<ShapePart>,
    pub(super) lights: Vec<ShapeLight>,
}

/// One mesh of a shape, where it stands inside the object.
pub(super) struct ShapePart {
    pub(super) name: String,
    pub(super) mesh: Mesh,
    pub(super) object_from_part: Mat4,
    /// The model's own material.
    pub(super) own: Option<OwnMaterial>,
}

/// A material that came with a model, and how it wants to be drawn.
#[derive(Clone, Copy)]
pub(super) struct OwnMaterial {
    pub(super) material: Material,
    pub(super) faces: Faces,
    pub(super) blend: bool,
}

/// A light that came with a model, where it stands inside the object.
pub(super) struct ShapeLight {
    pub(super) name: String,
    pub(super) light: PunctualLight,
    pub(super) object_from_light: Transform,
}

/// The shapes of a scene, each loaded once however often it is used.
pub(super) struct Shapes<'a> {
    base_dir: &'a Path,
    loaded: HashMap<(String, NormalsEntry), Rc<Shape>>,
    pub(super) warnings: Vec<String>,
}

impl<'a> Shapes<'a> {
    pub(super) fn new(base_dir: &'a Path) -> Self {
        Self { base_dir, loaded: HashMap::new(), warnings: Vec::new() }
    }

    /// The shape of object `index`.
    pub(super) fn of(&mut self, object: &ObjectEntry, index: usize) -> Result<Rc<Shape>, SceneError> {
        let key = match &object.mesh {
            // Written out for one object; comparing it with others would cost more than it saves.
            MeshEntry::Inline(_) => None,
            MeshEntry::Path(path) => Some(format!("path {}", path.display())),
            surface => Some(format!("{surface:?}")),
        };
        let key = key.map(|key| (key, object.normals));
        if let Some(shape) = key.as_ref().and_then(|key| self.loaded.get(key)) {
            return Ok(Rc::clone(shape));
        }
        let shape = Rc::new(self.load(object, index)?);
        if let Some(key) = key {
            self.loaded.insert(key, Rc::clone(&shape));
        }
        Ok(shape)
    }

    fn load(&mut self, object: &ObjectEntry, index: usize) -> Result<Shape, SceneError> {
        let mesh = match &object.mesh {
            MeshEntry::Path(path) => {
                let path = self.base_dir.join(path);
                let key = format!("objects[{index}].mesh.path");
                let model = halfway_mesh::load(&path).map_err(|source| SceneError::Model { key, source })?;
                return self.model(model, &path, object.normals.into(), index);
            }
            MeshEntry::UvSphere(sphere) => Mesh::from(UvSphere::from(*sphere)),
            MeshEntry::Plane(plane) => Mesh::from(Plane::from(*plane)),
            MeshEntry::Box(cuboid) => Mesh::from(Cuboid::from(*cuboid)),
            MeshEntry::Teapot(teapot) => Mesh::from(Teapot::from(*teapot)),
            MeshEntry::Inline(mesh) => mesh
                .mesh()
                .map_err(|source| SceneError::Mesh { key: format!("objects[{index}].mesh.inline"), source })?,
        };
        let (mesh, report) = mesh.with_normals(object.normals.into());
        self.warn_of_normals(&format!("objects[{index}]"), report);
        let part = ShapePart { name: String::new(), mesh, object_from_part: Mat4::IDENTITY, own: None };
        Ok(Shape { parts: vec![part], lights: Vec::new() })
    }

    fn model(&mut self, model: Model, path: &Path, normals: Normals, index: usize) -> Result<Shape, SceneError> {
        let file = path.display();
        self.warnings.extend(model.warnings.iter().map(|warning| format!("{file}: {warning}")));
        let mut materials = Vec::with_capacity(model.materials.len());
        for material in &model.materials {
            let at = format!("{file}: material {:?}", material.name());
            materials.push(self.material(material, at, index)?);
        }
        let mut lights = Vec::with_capacity(model.lights.len());
        for light in &model.lights {
            lights.push(place_light(light, &format!("{file}: light {:?}", light.name), index)?);
        }
        let mut parts = Vec::with_capacity(model.parts.len());
        for part in model.parts {
            let (mesh, report) = part.mesh.with_normals(normals);
            self.warn_of_normals(&format!("{file}: part {:?}", part.name), report);
            parts.push(ShapePart {
                name: part.name,
                mesh,
                object_from_part: part.world_from_part,
                own: part.material.and_then(|material| materials.get(material).copied()),
            });
        }
        Ok(Shape { parts, lights })
    }

    fn material(&mut self, source: &SourceMaterial, at: String, index: usize) -> Result<OwnMaterial, SceneError> {
        let translated = match source {
            SourceMaterial::Mtl(mtl) => {
                let numbers = MtlNumbers {
                    ka: mtl.ka,
                    kd: mtl.kd,
                    ks: mtl.ks,
                    ke: mtl.ke,
                    ns: mtl.ns,
                    d: mtl.d,
                    tr: mtl.tr,
                    illum: mtl.illum,
                };
                from_mtl(&numbers).map(|(material, warnings)| {
                    self.warnings.extend(warnings.iter().map(|warning| format!("{at}: {warning}")));
                    // An MTL file cannot say whether a surface is to be blended; the scene has to.
                    OwnMaterial { material, faces: Faces::Front, blend: false }
                })
            }
            SourceMaterial::MetallicRoughness(gltf) => {
                let alpha = match gltf.alpha {
                    AlphaMode::Opaque => conversion::AlphaMode::Opaque,
                    AlphaMode::Mask { cutoff } => conversion::AlphaMode::Mask { cutoff },
                    AlphaMode::Blend => conversion::AlphaMode::Blend,
                };
                let numbers = MetallicRoughnessNumbers {
                    base_color: gltf.base_color,
                    metallic: gltf.metallic,
                    roughness: gltf.roughness,
                    emissive: gltf.emissive,
                    alpha,
                };
                from_metallic_roughness(&numbers).map(|material| OwnMaterial {
                    material,
                    faces: if gltf.double_sided { Faces::Both } else { Faces::Front },
                    // What a mask cuts away has opacity 0, which shows only where it is blended.
                    blend: gltf.alpha == AlphaMode::Blend || material.opacity == 0.0,
                })
            }
        };
        translated.map_err(|source| SceneError::ModelValue { key: mesh_path(index), at, source })
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

fn mesh_path(index: usize) -> String {
    format!("objects[{index}].mesh.path")
}

/// A light of a model. Its frame may scale, which has no meaning for a light: position and direction are taken from it.
fn place_light(light: &SourceLight, at: &str, index: usize) -> Result<ShapeLight, SceneError> {
    let numbers = PunctualNumbers {
        kind: match light.kind {
            SourceLightKind::Directional => PunctualKind::Directional,
            SourceLightKind::Point => PunctualKind::Point,
            SourceLightKind::Spot { inner, outer } => PunctualKind::Spot { inner, outer },
        },
        color: light.color,
        intensity: light.intensity,
        range: light.range,
    };
    let refused = |source| SceneError::ModelValue { key: mesh_path(index), at: at.to_owned(), source };
    let component = from_punctual(&numbers, RADIANCE_SCALE).map_err(refused)?;
    let mut place = Transform::from_translation(light.world_from_light.w_axis.truncate());
    // A point light has no direction that could be wrong.
    if light.kind != SourceLightKind::Point {
        let along = light.world_from_light.transform_vector3(Vec3::NEG_Z);
        place.rotation = rotation_along(along).map_err(refused)?;
    }
    Ok(ShapeLight { name: light.name.clone(), light: component, object_from_light: place })
}
