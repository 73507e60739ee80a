//! What halfway lights: triangle meshes, their normals, parametric surfaces and file formats.
//!
//! - [`Mesh`] is a validated list of vertices and triangles, an asset of `bevy_asset`; [`Mesh3d`] puts one on an
//!   entity.
//! - [`Normals`] says how a mesh gets its normals: the file's, one a face, or a weighted mean of the faces around a
//!   vertex, creased or not; [`Mesh::with_tangents`] adds tangents.
//! - [`Mesh::report`] looks a mesh over; [`Mesh::welded`] and [`Mesh::repaired`] mend it; [`Mesh::subdivided`] and
//!   [`Mesh::displaced`] give it detail, [`Mesh::simplified`] and [`Mesh::lod_hierarchy`] take it away;
//!   [`Mesh::baked_occlusion`] bakes how much light from all sides arrives at it.
//! - [`Plane`], [`Cuboid`], [`UvSphere`], [`Icosphere`] and [`Teapot`] turn into meshes with analytic normals; so do
//!   the quadrics, the torus, [`BezierPatch`] and the other [`ParametricSurface`]s, by count or by chord error.
//! - [`Mesh::surface`] is the smooth surface that a mesh stands for, where it is known by formula.
//! - [`load`] reads SMF, Wavefront OBJ with MTL, glTF 2.0 (text and binary), PLY and STL into a [`Model`]; [`write()`]
//!   writes one as SMF, OBJ or binary glTF.
//!
//! The crate knows nothing of lights, GPUs or windows. Everything is right-handed with Y up, front faces wind
//! counter-clockwise, and texture coordinates have their origin at the top left of the image.
//!
//! ```
//! use halfway_mesh::{Mesh, NormalWeighting, Normals, Teapot};
//!
//! let teapot = Mesh::from(Teapot::new(8));
//! assert_eq!(teapot.normals().len(), teapot.positions().len());
//! let (_flat, report) = teapot.with_normals(Normals::Face);
//! assert_eq!(report.degenerate_triangles, 0);
//! ```

mod bounds;
mod classes;
mod component;
mod displace;
mod edges;
mod files;
mod mesh;
mod model;
mod normals;
mod numbering;
mod occlusion;
mod prepare;
mod problems;
mod source_map;
mod subdivide;
mod surfaces;
mod tangents;
mod triangle_tree;

pub use bounds::Bounds;
pub use component::{Mesh3d, MeshPlugin, SpawnOrder};
pub use files::{
    Format, LoadError, LoadOptions, LoadProgress, WriteError, load, load_bytes, load_with, write, write_quantised,
};
pub use mesh::{Mesh, MeshError};
pub use model::{
    AlphaMode, GltfMaps, MetallicRoughness, Model, MtlMaps, MtlMaterial, Part, SourceCamera, SourceLight,
    SourceLightKind, SourceMaterial, SourceProjection,
};
pub use normals::{NormalReport, NormalWeighting, Normals, face_normal};
pub use occlusion::{OcclusionBake, OcclusionError, OcclusionImage};
pub use prepare::{
    DistanceBounds, LodCluster, LodGroup, LodHierarchy, MeshReport, RepairReport, SimplifiedMesh, Weld, WeldReport,
};
pub use problems::Problems;
pub use source_map::{SourceChannel, SourceLevels, SourceMap, SourceWrap};
pub use subdivide::Subdivision;
pub use surfaces::{
    BezierPatch, Capsule, Cone, Cuboid, Cylinder, Disc, Ellipsoid, HeightField, Hyperboloid, HyperboloidSheet,
    Icosphere, Paraboloid, Parameter, ParametricSurface, Plane, Quadric, Surface, SurfaceError, SurfacePiece,
    SurfacePoint, Teapot, Tessellation, Torus, UvSphere, tessellate,
};
