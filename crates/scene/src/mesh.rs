//! The meshes of a scene file.

use std::fmt;
use std::path::{Path, PathBuf};

use bevy_math::{Vec2, Vec3, Vec4};
use halfway_mesh::{Cuboid, Format, Mesh, MeshError, NormalWeighting, Normals, Plane, SurfaceError, Teapot, UvSphere};
use schemars::JsonSchema;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem, Within, finite};
use crate::read::{ComponentWord, Given, JsonObject, Word, no_more};

/// The shape of an object: an object with exactly one of these keys.
#[derive(Serialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum MeshEntry {
    /// A model file, relative to the scene file: smf, obj, gltf, glb, ply or stl.
    Path(PathBuf),
    /// A sphere about the origin.
    UvSphere(UvSphereEntry),
    /// A square in the xz plane about the origin, facing +Y.
    Plane(PlaneEntry),
    /// A box about the origin.
    Box(BoxEntry),
    /// The Utah teapot.
    Teapot(TeapotEntry),
    /// Vertices and triangles, written out.
    Inline(InlineMesh),
}

/// The value of `{"uv_sphere": …}`.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct UvSphereEntry {
    /// 1e-30 to 1e30.
    #[schemars(range(min = 1e-30, max = 1e30))]
    pub radius: f32,
    /// Meridians: 3 to 4096.
    #[schemars(range(min = 3, max = UvSphere::MAX_SEGMENTS))]
    pub segments: u32,
    /// Bands from pole to pole: 2 to 2048.
    #[schemars(range(min = 2, max = UvSphere::MAX_RINGS))]
    pub rings: u32,
}

impl Default for UvSphereEntry {
    fn default() -> Self {
        Self { radius: 1.0, segments: 32, rings: 16 }
    }
}

/// The value of `{"plane": …}`.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct PlaneEntry {
    /// The length of an edge: 1e-30 to 1e30.
    #[schemars(range(min = 1e-30, max = 1e30))]
    pub size: f32,
    /// How many squares an edge is cut into: 1 to 2048.
    #[schemars(range(min = 1, max = Plane::MAX_DIVISIONS))]
    pub divisions: u32,
}

impl Default for PlaneEntry {
    fn default() -> Self {
        Self { size: 2.0, divisions: 1 }
    }
}

/// The value of `{"box": …}`.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct BoxEntry {
    /// The lengths of the edges along x, y and z: 1e-30 to 1e30.
    #[schemars(inner(range(min = 1e-30, max = 1e30)))]
    pub size: [f32; 3],
}

impl Default for BoxEntry {
    fn default() -> Self {
        Self { size: [1.0; 3] }
    }
}

/// The value of `{"teapot": …}`.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Copy, Debug, PartialEq, Eq)]
#[serde(default, deny_unknown_fields)]
pub struct TeapotEntry {
    /// How many cells an edge of each of the 32 patches is cut into: 1 to 256.
    #[schemars(range(min = 1, max = Teapot::MAX_DIVISIONS))]
    pub divisions: u32,
}

impl Default for TeapotEntry {
    fn default() -> Self {
        Self { divisions: 8 }
    }
}

/// The value of `{"inline": …}`.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct InlineMesh {
    /// x, y, z of every vertex, one after the other.
    pub positions: Vec<f32>,
    /// x, y, z of every vertex's normal, of any length above 0; null: by the default weighting.
    #[serde(default)]
    pub normals: Option<Vec<f32>>,
    /// u, v of every vertex, (0, 0) being the top left of the image; null: none.
    #[serde(default)]
    pub uvs: Option<Vec<f32>>,
    /// Red, green, blue and opacity of every vertex, linear, drawn as if taken into 0 to 1; null: none.
    #[serde(default)]
    pub colors: Option<Vec<f32>>,
    /// The vertices of every triangle, counted from 0, counter-clockwise seen from the front.
    pub indices: Vec<u32>,
}

impl Word for Normals {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("keep", Self::Keep),
        ("face", Self::Face),
        ("uniform", Self::Weighted(NormalWeighting::Uniform)),
        ("area", Self::Weighted(NormalWeighting::Area)),
        ("angle", Self::Weighted(NormalWeighting::Angle)),
        ("max", Self::Weighted(NormalWeighting::Max)),
    ];
}

impl ComponentWord for Normals {
    const NAME: &'static str = "NormalsEntry";
    const MEANING: &'static str = "`normals`: how a mesh gets its normals.";
    const MEANINGS: &'static [&'static str] = &[
        "The file's or the surface's own, else by the default weighting, which is `max`.",
        "One normal a triangle.",
        "The mean of the faces around a vertex, all alike.",
        "The mean weighted by the faces' areas.",
        "The mean weighted by the faces' angles at the vertex.",
        "The mean with the weights of Max 1999.",
    ];
}

impl From<UvSphereEntry> for UvSphere {
    fn from(UvSphereEntry { radius, segments, rings }: UvSphereEntry) -> Self {
        Self { radius, segments, rings }
    }
}

impl From<PlaneEntry> for Plane {
    fn from(PlaneEntry { size, divisions }: PlaneEntry) -> Self {
        Self { size, divisions }
    }
}

impl From<BoxEntry> for Cuboid {
    fn from(BoxEntry { size }: BoxEntry) -> Self {
        Self { size: size.into() }
    }
}

impl From<TeapotEntry> for Teapot {
    fn from(TeapotEntry { divisions }: TeapotEntry) -> Self {
        Self { divisions }
    }
}

impl MeshEntry {
    pub(crate) fn check(&self) -> Check {
        match self {
            Self::Path(path) => check_path(path).within("path"),
            Self::UvSphere(sphere) => surface(UvSphere::from(*sphere).validate()).within("uv_sphere"),
            Self::Plane(plane) => surface(Plane::from(*plane).validate()).within("plane"),
            Self::Box(cuboid) => surface(Cuboid::from(*cuboid).validate()).within("box"),
            Self::Teapot(teapot) => surface(Teapot::from(*teapot).validate()).within("teapot"),
            Self::Inline(mesh) => mesh.check().within("inline"),
        }
    }
}

impl InlineMesh {
    fn check(&self) -> Check {
        let vertices = self.positions.len() / 3;
        multiple_of_three("positions", self.positions.len())?;
        multiple_of_three("indices", self.indices.len())?;
        if self.indices.is_empty() {
            return Err(KeyProblem::new("indices", "is empty; expected at least one triangle"));
        }
        finite("positions", &self.positions)?;
        for (key, values, each) in [("normals", &self.normals, 3), ("uvs", &self.uvs, 2), ("colors", &self.colors, 4)] {
            let Some(values) = values else { continue };
            if values.len() != each * vertices {
                let message =
                    format!("has {} numbers; expected {each} for each of the {vertices} vertices", values.len());
                return Err(KeyProblem::new(key, message));
            }
            finite(key, values)?;
        }
        let outside = self.indices.iter().position(|&index| index as usize >= vertices);
        outside.map_or(Ok(()), |i| {
            let message = format!("is {}; expected less than {vertices}, the number of vertices", self.indices[i]);
            Err(KeyProblem::new("", message)).within_item("indices", i)
        })
    }

    /// The mesh.
    pub(crate) fn mesh(&self) -> Result<Mesh, MeshError> {
        let triples = |values: &[f32]| values.as_chunks().0.iter().map(|&v| Vec3::from_array(v)).collect();
        let pairs = |values: &[f32]| values.as_chunks().0.iter().map(|&v| Vec2::from_array(v)).collect();
        let mesh = Mesh::from_parts(
            triples(&self.positions),
            self.normals.as_deref().map(triples),
            self.uvs.as_deref().map(pairs),
            self.indices.clone(),
        )?;
        let colors = |values: &Vec<f32>| values.as_chunks().0.iter().map(|&v| Vec4::from_array(v)).collect();
        self.colors.as_ref().map(colors).map_or(Ok(mesh.clone()), |colors| mesh.with_colors(colors))
    }
}

fn check_path(path: &Path) -> Check {
    match Format::of(path) {
        Some(_) => Ok(()),
        None => Err(KeyProblem::new("", format!("is {}; {KNOWN_MODELS}", path.display()))),
    }
}

const KNOWN_MODELS: &str = "expected a file that ends in .smf, .obj, .gltf, .glb, .ply or .stl";

fn multiple_of_three(key: &str, length: usize) -> Check {
    if length.is_multiple_of(3) {
        return Ok(());
    }
    Err(KeyProblem::new(key, format!("has {length} numbers; expected a multiple of 3")))
}

fn surface(result: Result<(), SurfaceError>) -> Check {
    result.map_err(|SurfaceError { field, value, expected, .. }| {
        // The axes of a box are elements of a list in the file.
        let key = field.replace(".x", "[0]").replace(".y", "[1]").replace(".z", "[2]");
        KeyProblem::new(key, format!("is {value}; {expected}"))
    })
}

const SHAPES: &str = "path, uv_sphere, plane, box, teapot or inline";

impl<'de> Deserialize<'de> for MeshEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(OneShape)
    }
}

impl JsonObject for UvSphereEntry {
    const EXPECTED: &'static str = "an object such as {\"radius\": 1}";
}

impl JsonObject for PlaneEntry {
    const EXPECTED: &'static str = "an object such as {\"size\": 2}";
}

impl JsonObject for BoxEntry {
    const EXPECTED: &'static str = "an object such as {\"size\": [1, 1, 1]}";
}

impl JsonObject for TeapotEntry {
    const EXPECTED: &'static str = "an object such as {\"divisions\": 8}";
}

impl JsonObject for InlineMesh {
    const EXPECTED: &'static str = "an object with positions and indices";
}

struct OneShape;

impl<'de> Visitor<'de> for OneShape {
    type Value = MeshEntry;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "an object with one of the keys {SHAPES}")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<MeshEntry, A::Error> {
        let Some(key) = map.next_key::<String>()? else {
            return Err(A::Error::custom(format_args!("is empty; expected one of the keys {SHAPES}")));
        };
        let mesh = match key.as_str() {
            "path" => MeshEntry::Path(map.next_value()?),
            "uv_sphere" => map.next_value().map(|Given(shape)| MeshEntry::UvSphere(shape))?,
            "plane" => map.next_value().map(|Given(shape)| MeshEntry::Plane(shape))?,
            "box" => map.next_value().map(|Given(shape)| MeshEntry::Box(shape))?,
            "teapot" => map.next_value().map(|Given(shape)| MeshEntry::Teapot(shape))?,
            "inline" => map.next_value().map(|Given(shape)| MeshEntry::Inline(shape))?,
            _ => {
                return Err(A::Error::custom(format_args!("unknown field `{key}`, expected {SHAPES}")));
            }
        };
        no_more(&mut map, SHAPES)?;
        Ok(mesh)
    }
}
