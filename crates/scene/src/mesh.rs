//! The meshes of a scene file.

use std::ops::Bound::Included;
use std::path::PathBuf;
use std::sync::Arc;

use bevy_math::{Vec2, Vec3, Vec4};
use halfway_lighting::{Material, Range};
use halfway_mesh::{
    Cuboid, Format, Icosphere, Mesh, MeshError, Model, NormalWeighting, Normals, Plane, Teapot, UvSphere,
};

use crate::check::{Check, KeyProblem, Limits, Within};
use crate::keys::{Fill, Key, Keys, Object, Presence, Visit, Words, keys, words};
use crate::surface::{LENGTH, SURFACES, SurfaceEntry};

/// The shape of an object: an object with exactly one of these keys.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshEntry {
    /// A model file, relative to the scene file: smf, obj, gltf, glb, ply, stl, off or 3mf.
    Path(PathBuf),
    /// A sphere about the origin.
    UvSphere(UvSphere),
    /// A square in the xz plane about the origin, facing +Y; 2 wide, where the file does not say how wide.
    Plane(Plane),
    /// A box about the origin.
    Box(Cuboid),
    /// The Utah teapot.
    Teapot(Teapot),
    /// A sphere about the origin, of triangles of nearly equal size.
    Icosphere(Icosphere),
    /// A surface by formula.
    Surface(SurfaceEntry),
    /// Vertices and triangles, written out.
    Inline(InlineMesh),
    /// A model that was loaded already; in a file it is written as its path.
    Model(LoadedModel),
}

/// A model in memory that nothing is known of but what its file says. Unlike a model by its path, an open mesh without
/// a material of its own is seen from both sides, unless [`ObjectEntry::faces`](crate::ObjectEntry) says otherwise.
///
/// ```
/// use std::sync::Arc;
/// use halfway_lighting::Material;
/// use halfway_mesh::{Format, load_bytes};
/// use halfway_scene::{LoadedModel, MeshEntry, ObjectEntry, SceneFile};
///
/// let model = load_bytes(Format::Obj, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
/// let model = LoadedModel { path: "leaf.obj".into(), model: Arc::new(model), material: Material::default() };
/// let scene = SceneFile { objects: vec![ObjectEntry::new(MeshEntry::Model(model))], ..SceneFile::default() };
/// scene.validate().unwrap();
/// # Ok::<(), halfway_mesh::LoadError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedModel {
    /// The file it came from, by which messages name it.
    pub path: PathBuf,
    /// The model.
    pub model: Arc<Model>,
    /// The material of parts that have none of their own. [`unknown_material`](crate::options::unknown_material) is white
    /// where they have colours at their vertices.
    pub material: Material,
}

const PATH: Key =
    Key::required("path", "A model file, relative to the scene file: smf, obj, gltf, glb, ply, stl, off or 3mf.");
const UV_SPHERE: Key = Key::required("uv_sphere", "A sphere about the origin.");
const PLANE: Key = Key::required("plane", "A square in the xz plane about the origin, facing +Y.");
const BOX: Key = Key::required("box", "A box about the origin.");
const TEAPOT: Key = Key::required("teapot", "The Utah teapot.");
const ICOSPHERE: Key = Key::required("icosphere", "A sphere about the origin, of triangles of nearly equal size.");
const INLINE: Key = Key::required("inline", "Vertices and triangles, written out.");

/// A path without a name, which no model has.
impl Default for MeshEntry {
    fn default() -> Self {
        Self::Path(PathBuf::new())
    }
}

impl Keys for MeshEntry {
    const NAME: &'static str = "MeshEntry";
    const MEANING: &'static str = "The shape of an object: an object with exactly one of these keys.";

    fn blank() -> Self {
        Self::default()
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        match self {
            Self::Path(path) | Self::Model(LoadedModel { path, .. }) => visitor.key(&PATH, Some(path)),
            Self::UvSphere(sphere) => visitor.key(&UV_SPHERE, Some(sphere)),
            Self::Plane(plane) => visitor.key(&PLANE, Some(plane)),
            Self::Box(cuboid) => visitor.key(&BOX, Some(cuboid)),
            Self::Teapot(teapot) => visitor.key(&TEAPOT, Some(teapot)),
            Self::Icosphere(sphere) => visitor.key(&ICOSPHERE, Some(sphere)),
            Self::Surface(surface) => surface.visit(visitor),
            Self::Inline(mesh) => visitor.key(&INLINE, Some(mesh)),
        }
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        from.key(&PATH, |path| *self = Self::Path(path))?;
        from.key(&UV_SPHERE, |sphere| *self = Self::UvSphere(sphere))?;
        from.key(&PLANE, |plane| *self = Self::Plane(plane))?;
        from.key(&BOX, |cuboid| *self = Self::Box(cuboid))?;
        from.key(&TEAPOT, |teapot| *self = Self::Teapot(teapot))?;
        from.key(&ICOSPHERE, |sphere| *self = Self::Icosphere(sphere))?;
        SurfaceEntry::fill(from, |surface| *self = Self::Surface(surface))?;
        from.key(&INLINE, |mesh| *self = Self::Inline(mesh))
    }
}

impl Object for MeshEntry {
    const ONE_KEY: bool = true;
    fn expected() -> String {
        let surfaces = SURFACES.join(", ");
        format!("an object with one of the keys path, uv_sphere, plane, box, teapot, icosphere, {surfaces} or inline")
    }

    fn check_whole(&self) -> Check {
        match self {
            Self::Path(path) if Format::from_path(path).is_none() => {
                let way = Format::converter(path).map_or_else(String::new, |way| format!(" ({way})"));
                Err(KeyProblem::new("path", format!("is {}; {KNOWN_MODELS}{way}", path.display())))
            }
            Self::Surface(surface) => surface.check(),
            _ => Ok(()),
        }
    }
}

const KNOWN_MODELS: &str = "expected a file that ends in .smf, .obj, .gltf, .glb, .ply, .stl, .off or .3mf";

keys! {
    /// The value of `{"uv_sphere": …}`.
    impl UvSphere {
        [optional]
        /// 1e-30 to 1e30.
        radius: f32 = 1.0 => LENGTH,
        /// Meridians: 3 to 4096.
        segments: u32 = 32 => Limits::Counts(3, UvSphere::MAX_SEGMENTS),
        /// Bands from pole to pole: 2 to 2048.
        rings: u32 = 16 => Limits::Counts(2, UvSphere::MAX_RINGS),
    }
}

impl Object for UvSphere {
    const EXPECTED: &'static str = "an object such as {\"radius\": 1}";
}

keys! {
    /// The value of `{"plane": …}`.
    impl Plane {
        [optional]
        /// The length of an edge: 1e-30 to 1e30.
        size: f32 = 2.0 => LENGTH,
        /// How many squares an edge is cut into: 1 to 2048.
        divisions: u32 = 1 => Limits::Counts(1, Plane::MAX_DIVISIONS),
    }
}

impl Object for Plane {
    const EXPECTED: &'static str = "an object such as {\"size\": 2}";
}

keys! {
    /// The value of `{"box": …}`.
    impl Cuboid {
        [optional]
        /// The lengths of the edges along x, y and z: 1e-30 to 1e30.
        size: Vec3 = Vec3::ONE => LENGTH,
    }
}

impl Object for Cuboid {
    const EXPECTED: &'static str = "an object such as {\"size\": [1, 1, 1]}";
}

keys! {
    /// The value of `{"teapot": …}`.
    impl Teapot {
        [optional]
        /// How many cells an edge of each of the 32 patches is cut into: 1 to 256.
        divisions: u32 = 8 => Limits::Counts(1, Teapot::MAX_DIVISIONS),
    }
}

impl Object for Teapot {
    const EXPECTED: &'static str = "an object such as {\"divisions\": 8}";
}

keys! {
    /// The value of `{"inline": …}`.
    #[derive(Clone, Debug, PartialEq)]
    pub struct InlineMesh {
        [required]
        /// x, y, z of every vertex, one after the other.
        positions: Vec<f32>,
        /// The vertices of every triangle, counted from 0, counter-clockwise seen from the front.
        indices: Vec<u32>,
        [optional]
        /// x, y, z of every vertex's normal, of any length above 0; null: by the default weighting.
        normals: Option<Vec<f32>> = None,
        /// u, v of every vertex, (0, 0) being the top left of the image; null: none.
        uvs: Option<Vec<f32>> = None,
        /// Red, green, blue and opacity of every vertex, linear, drawn as if taken into 0 to 1; null: none.
        colors: Option<Vec<f32>> = None,
    }
}

impl Object for InlineMesh {
    const EXPECTED: &'static str = "an object with positions and indices";

    fn check_whole(&self) -> Check {
        let vertices = self.positions.len() / 3;
        for (key, length) in [("positions", self.positions.len()), ("indices", self.indices.len())] {
            if !length.is_multiple_of(3) {
                return Err(KeyProblem::new(key, format!("has {length} numbers; expected a multiple of 3")));
            }
        }
        if self.indices.is_empty() {
            return Err(KeyProblem::new("indices", "is empty; expected at least one triangle"));
        }
        for (key, values, each) in [("normals", &self.normals, 3), ("uvs", &self.uvs, 2), ("colors", &self.colors, 4)] {
            if let Some(values) = values
                && values.len() != each * vertices
            {
                let message =
                    format!("has {} numbers; expected {each} for each of the {vertices} vertices", values.len());
                return Err(KeyProblem::new(key, message));
            }
        }
        let outside = self.indices.iter().position(|&index| index as usize >= vertices);
        outside.map_or(Ok(()), |i| {
            let message = format!("is {}; expected less than {vertices}, the number of vertices", self.indices[i]);
            Err(KeyProblem::new("", message)).within_item(i).within("indices")
        })
    }
}

impl InlineMesh {
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

impl Keys for Normals {
    const NAME: &'static str = "Normals";
    const MEANING: &'static str = "`normals`: how a mesh gets its normals.";
    const WORDS: Words<Self> = &[
        ("keep", Self::Keep, "The file's or the surface's own, else by the default weighting, which is `max`."),
        ("face", Self::Face, "One normal a triangle."),
        ("uniform", Self::Weighted(NormalWeighting::Uniform), "The mean of the faces around a vertex, all alike."),
        ("area", Self::Weighted(NormalWeighting::Area), "The mean weighted by the faces' areas."),
        ("angle", Self::Weighted(NormalWeighting::Angle), "The mean weighted by the faces' angles at the vertex."),
        ("max", Self::Weighted(NormalWeighting::Max), "The mean with the weights of Max 1999."),
        ("auto", Self::Auto, "The file's own, else creased at the sharp edges of a made part and smooth on all else."),
    ];

    fn blank() -> Self {
        Self::Keep
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        let Self::Creased { angle, weighting } = *self else { return Ok(()) };
        visitor.key(&CREASED, Some(&CreasedEntry { angle_deg: degrees(angle), weighting }))
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        from.key(&CREASED, |CreasedEntry { angle_deg, weighting }| {
            *self = Self::Creased { angle: angle_deg.to_radians(), weighting };
        })
    }
}

impl Object for Normals {
    const ONE_KEY: bool = true;
    const EXAMPLES: &'static [&'static str] = &["{\"creased\": {\"angle_deg\": 30}}"];
}

const CREASED: Key = Key {
    presence: Presence::Required,
    ..Key::required("creased", "The mean over the faces around a vertex that no crease separates.")
};

keys! {
    /// The value of `{"creased": …}`.
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct CreasedEntry {
        [optional]
        /// An edge is a crease where the normals of its faces differ by more than this angle, in degrees from 0 to 180.
        angle_deg: f32 = 30.0 => Limits::Numbers(Range::new(Included(0.0), Included(180.0), "degrees from 0 to 180")),
        /// The weight of a face in the mean.
        weighting: NormalWeighting = NormalWeighting::default(),
    }
}

impl Object for CreasedEntry {
    const EXPECTED: &'static str = "an object such as {\"angle_deg\": 30}";
}

/// The degrees that come to this angle in radians, to the bit where there are any: a file says degrees.
fn degrees(angle: f32) -> f32 {
    let near = angle.to_degrees();
    let beside = [near, near.next_up(), near.next_down(), near.next_up().next_up(), near.next_down().next_down()];
    beside.into_iter().find(|degrees| degrees.to_radians().to_bits() == angle.to_bits()).unwrap_or(near)
}

words! {
    /// `weighting`: the weight of a face in the mean of the normals around a vertex.
    NormalWeighting {
        /// All alike.
        uniform = Self::Uniform,
        /// Its area.
        area = Self::Area,
        /// Its angle at the vertex.
        angle = Self::Angle,
        /// The weights of Max 1999.
        max = Self::Max,
    }
}
