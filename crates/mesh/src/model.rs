//! The contents of a model file, in the file's own terms.

use std::sync::Arc;

use glam::{DVec3, Mat4};

use crate::{Animations, Bounds, Lines, Mesh, SourceMap};

/// The content of a model file: meshes placed in the world, and the materials and lights that the file describes.
///
/// Materials and lights keep the file's own terms; `halfway_scene` turns them into components.
///
/// ```
/// use halfway_mesh::{Format, load_bytes};
///
/// let text = b"o roof\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no wall\nf 3 2 1\n";
/// let model = load_bytes(Format::Obj, text)?;
/// let names: Vec<&str> = model.parts.iter().map(|part| part.name.as_str()).collect();
/// assert_eq!(names, ["roof", "wall"]);
/// assert_eq!(model.bounds().expect("two parts").size().x, 1.0);
/// # Ok::<(), halfway_mesh::LoadError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The point from which all places are counted: those of parts, lines, lights and cameras are in the world less
    /// this. It is 0 but for models far away beside their size ([`origin_of_box`](crate::origin_of_box)), such as those
    /// at map coordinates, whose positions `f32` would round.
    pub origin: DVec3,
    /// The meshes. A model that came from [`load`](crate::load) has at least one here or in `lines`.
    pub parts: Vec<Part>,
    /// The lines and points.
    pub lines: Vec<LinePart>,
    /// The materials; [`Part::material`] and [`LinePart::material`] index them.
    pub materials: Vec<SourceMaterial>,
    /// The lights.
    pub lights: Vec<SourceLight>,
    /// The cameras.
    pub cameras: Vec<SourceCamera>,
    /// Numbers beside the meshes, such as temperatures.
    pub properties: Arc<[Property]>,
    /// How the model moves, where its file says so (glTF). Parts, lines, lights and cameras here are in the pose of the
    /// file.
    pub animations: Option<Arc<Animations>>,
    /// Sentences about everything that was skipped or corrected.
    pub warnings: Vec<String>,
}

impl Model {
    /// The box around all meshes, lines and points, counted from [`origin`](Self::origin), or `None` where there are
    /// none.
    pub fn bounds(&self) -> Option<Bounds> {
        let meshes = self.parts.iter().map(|part| part.mesh.bounds().transformed(&part.world_from_part));
        let lines = self.lines.iter().map(|part| part.lines.bounds().transformed(&part.world_from_part));
        meshes.chain(lines).reduce(|all, part| all.union(&part))
    }

    /// Whether there is neither a mesh nor a line nor a point.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty() && self.lines.is_empty()
    }

    /// How many straight lines there are.
    pub fn line_count(&self) -> usize {
        self.lines.iter().map(|part| part.lines.segments().len()).sum()
    }

    /// How many points there are.
    pub fn point_count(&self) -> usize {
        self.lines.iter().map(|part| part.lines.points().len()).sum()
    }

    /// How many triangles the parts have together.
    pub fn triangle_count(&self) -> usize {
        self.parts.iter().map(|part| part.mesh.triangle_count()).sum()
    }
}

/// A mesh of a model, with one material and a transform.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The name of the object, group or node in the file; empty where it has none.
    pub name: String,
    /// The mesh. Parts that show the same mesh of the file share its data.
    pub mesh: Mesh,
    /// The index of its material in [`Model::materials`].
    pub material: Option<usize>,
    /// The transform of the part; may mirror, but is always finite and affine.
    pub world_from_part: Mat4,
}

/// Numbers that a file has beside what a mesh is made of: of PLY, the properties of vertices and faces that are no
/// positions, normals, colours or texture coordinates.
///
/// ```
/// use halfway_mesh::{Format, ScalarValues, load_bytes};
///
/// let text = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
///     property float heat\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
///     0 0 0 20\n1 0 0 25\n0 1 0 30\n3 0 1 2\n";
/// let model = load_bytes(Format::Ply, text)?;
/// assert_eq!(model.properties[0].name, "heat");
/// assert_eq!(model.properties[0].values, ScalarValues::Vertices(vec![20.0, 25.0, 30.0]));
/// # Ok::<(), halfway_mesh::LoadError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Property {
    /// Its name in the file.
    pub name: String,
    /// The index of its part in [`Model::parts`].
    pub part: usize,
    /// The numbers for the part's mesh as it was read. All triangles of a polygon have the number of that.
    pub values: ScalarValues,
}

/// Numbers on a mesh. They may be infinite or NaN.
#[derive(Clone, Debug, PartialEq)]
pub enum ScalarValues {
    /// One a vertex.
    Vertices(Vec<f32>),
    /// One a triangle.
    Faces(Vec<f32>),
}

impl ScalarValues {
    /// The least and the greatest of the finite ones; `None` where there are none.
    pub fn range(&self) -> Option<[f32; 2]> {
        let (Self::Vertices(values) | Self::Faces(values)) = self;
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        Some([finite().reduce(f32::min)?, finite().reduce(f32::max)?])
    }
}

/// Lines and points of a model, with one material and a transform.
#[derive(Clone, Debug, PartialEq)]
pub struct LinePart {
    /// The name of the object, group or node in the file; empty where it has none.
    pub name: String,
    /// The lines and points. Parts that show the same ones of the file share their data.
    pub lines: Lines,
    /// The index of their material in [`Model::materials`].
    pub material: Option<usize>,
    /// The transform of the part; may mirror, but is always finite and affine.
    pub world_from_part: Mat4,
}

/// A material in the terms of its file.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a model has few materials, each read once")]
pub enum SourceMaterial {
    /// From a Wavefront MTL file.
    Mtl(MtlMaterial),
    /// From glTF.
    MetallicRoughness(MetallicRoughness),
}

impl SourceMaterial {
    /// Whether it refers to images.
    pub fn has_maps(&self) -> bool {
        match self {
            Self::Mtl(mtl) => mtl.maps != MtlMaps::default(),
            Self::MetallicRoughness(gltf) => {
                let has_specular = gltf.specular_glossiness.as_ref().is_some_and(|specular| specular.map.is_some());
                has_specular || gltf.maps != GltfMaps::default()
            }
        }
    }

    /// The material's name in the file; empty where it has none.
    pub fn name(&self) -> &str {
        match self {
            Self::Mtl(material) => &material.name,
            Self::MetallicRoughness(material) => &material.name,
        }
    }
}

/// A material of a Wavefront MTL file: the statements as they stand, not limited to their usual ranges, but finite and
/// not negative. `None` where the file has no such statement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlMaterial {
    /// `newmtl`.
    pub name: String,
    /// `Ka`, ambient reflectance.
    pub ka: Option<[f32; 3]>,
    /// `Kd`, diffuse reflectance.
    pub kd: Option<[f32; 3]>,
    /// `Ks`, specular reflectance.
    pub ks: Option<[f32; 3]>,
    /// `Ke`, emission.
    pub ke: Option<[f32; 3]>,
    /// `Ns`, specular exponent.
    pub ns: Option<f32>,
    /// `d`, dissolve: 1 is opaque.
    pub d: Option<f32>,
    /// `Tr`, transparency: 0 is opaque.
    pub tr: Option<f32>,
    /// `illum`, the number of the illumination model.
    pub illum: Option<u8>,
    /// `Pr`, roughness as in glTF, from 0 to 1: an extension for physically based materials.
    pub pr: Option<f32>,
    /// `Pm`, metallic as in glTF, from 0 to 1: of the same extension.
    pub pm: Option<f32>,
    /// The images.
    pub maps: MtlMaps,
}

/// The images of an [`MtlMaterial`]. `None` where the file has no such statement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlMaps {
    /// `map_Kd`: its color multiplies `Kd`.
    pub kd: Option<SourceMap>,
    /// `map_Ks`: its color multiplies `Ks`.
    pub ks: Option<SourceMap>,
    /// `map_Ke`: its color multiplies `Ke`.
    pub ke: Option<SourceMap>,
    /// `map_d`: its value multiplies the opacity.
    pub d: Option<SourceMap>,
    /// `map_Ns`: its value multiplies `Ns`.
    pub ns: Option<SourceMap>,
    /// `norm`: its colors are normals in tangent space.
    pub norm: Option<SourceMap>,
    /// `map_Bump`: its values are heights.
    pub bump: Option<SourceMap>,
}

/// A metallic-roughness material of glTF 2.0 (§3.9.2): the factors as they stand, finite but not limited to their
/// usual ranges. The metallic-roughness texture is not read.
#[derive(Clone, Debug, PartialEq)]
pub struct MetallicRoughness {
    /// The material's name.
    pub name: String,
    /// `baseColorFactor`: linear RGB, and alpha.
    pub base_color: [f32; 4],
    /// `metallicFactor`: 0 dielectric … 1 metal.
    pub metallic: f32,
    /// `roughnessFactor`: 0 smooth … 1 rough.
    pub roughness: f32,
    /// `emissiveFactor`: linear RGB.
    pub emissive: [f32; 3],
    /// `doubleSided`: both faces are shown.
    pub double_sided: bool,
    /// `KHR_materials_unlit`: the base color is shown as it is.
    pub unlit: bool,
    /// `alphaMode` and `alphaCutoff`.
    pub alpha: AlphaMode,
    /// `KHR_materials_pbrSpecularGlossiness`, which replaces the metallic and the roughness factor: `base_color` and its
    /// image then are the diffuse ones, `metallic` is 0, and `roughness` is 1 less the glossiness.
    pub specular_glossiness: Option<SpecularGlossiness>,
    /// The images.
    pub maps: GltfMaps,
}

/// The highlight of a material of `KHR_materials_pbrSpecularGlossiness`.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecularGlossiness {
    /// `specularFactor`: linear RGB reflectance at normal incidence.
    pub specular: [f32; 3],
    /// `glossinessFactor`: 0 rough … 1 smooth.
    pub glossiness: f32,
    /// `specularGlossinessTexture`: its color multiplies `specular`. The glossiness in its alpha is not used.
    pub map: Option<SourceMap>,
}

/// The images of a [`MetallicRoughness`] material. `None` where the file names none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GltfMaps {
    /// `baseColorTexture`: its color multiplies the base color.
    pub base_color: Option<SourceMap>,
    /// `emissiveTexture`: its color multiplies the emission.
    pub emissive: Option<SourceMap>,
    /// `occlusionTexture`: its value multiplies ambient light.
    pub occlusion: Option<SourceMap>,
    /// `normalTexture`: its colors are normals in tangent space.
    pub normal: Option<SourceMap>,
}

/// The use of a glTF material's alpha.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Nothing: the surface is opaque.
    #[default]
    Opaque,
    /// Below the cutoff the surface is invisible, from it on opaque.
    Mask {
        /// `alphaCutoff`, 0.5 by default.
        cutoff: f32,
    },
    /// The surface is blended over the background by its alpha.
    Blend,
}

/// A light of `KHR_lights_punctual`. It stands at the origin of its frame and shines along −Z.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceLight {
    /// The name of the light, else of its node; empty where neither has one.
    pub name: String,
    /// Its kind.
    pub kind: SourceLightKind,
    /// Linear RGB.
    pub color: [f32; 3],
    /// Candela for point and spot lights, lux for directional lights.
    pub intensity: f32,
    /// The distance at which its light ends, in world units; `None` is unlimited.
    pub range: Option<f32>,
    /// The position and the direction of the light; may scale, which has no meaning for a light.
    pub world_from_light: Mat4,
}

/// The kinds of `KHR_lights_punctual`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SourceLightKind {
    /// Parallel rays.
    Directional,
    /// In all directions from a point.
    Point,
    /// A cone from a point; angles in radians from its axis.
    Spot {
        /// Where the light begins to fade.
        inner: f32,
        /// Where the light has faded to 0.
        outer: f32,
    },
}

/// A camera of glTF 2.0 (§3.10). It stands at the origin of its frame and looks along −Z, with +Y up.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceCamera {
    /// The name of the camera, else of its node; empty where neither has one.
    pub name: String,
    /// Its projection.
    pub projection: SourceProjection,
    /// The position and the direction of the camera; may scale, which has no meaning for a camera.
    pub world_from_camera: Mat4,
}

/// The projections of glTF; lengths in units of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SourceProjection {
    /// From a point.
    Perspective {
        /// The vertical angle of view in radians, above 0.
        yfov: f32,
        /// Width over height; `None` takes that of the picture.
        aspect: Option<f32>,
        /// The distance of the near plane, above 0.
        near: f32,
        /// The distance of the far plane, above `near`; `None` is infinitely far.
        far: Option<f32>,
    },
    /// By parallel rays.
    Orthographic {
        /// Half the width of the view (`xmag`), not 0.
        half_width: f32,
        /// Half the height of the view (`ymag`), not 0.
        half_height: f32,
        /// The distance of the near plane, not below 0.
        near: f32,
        /// The distance of the far plane, above `near`.
        far: f32,
    },
}
