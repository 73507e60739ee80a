#![doc = include_str!("../README.md")]
//!
//! # Features
//! All are on by default.
//! - `ecs`: [`Mesh3d`], [`Lines3d`], [`MeshPlugin`] and [`SpawnOrder`]. Without it the crate has no ECS below it.
//! - `formats`: reading and writing of model files: [`load`], [`write`](write()), [`Model`] and its parts.
//! - `threemf`: 3MF among them, for which 15 more crates are built.

#[cfg(feature = "formats")]
mod animation;
mod bounds;
mod buckets;
mod classes;
#[cfg(feature = "ecs")]
mod component;
mod displace;
mod edges;
#[cfg(feature = "formats")]
mod files;
mod lines;
mod mesh;
mod mesh_edges;
#[cfg(feature = "formats")]
mod model;
mod normals;
mod numbering;
mod occlusion;
mod origin;
mod prepare;
mod problems;
#[cfg(feature = "formats")]
mod source_map;
mod subdivide;
mod surfaces;
mod tangents;
mod triangle_tree;

#[cfg(feature = "formats")]
pub use animation::{Animations, Clip, Pose, PosedPart};
pub use bounds::Bounds;
#[cfg(feature = "ecs")]
pub use component::{Lines3d, Mesh3d, MeshPlugin, SpawnOrder};
#[cfg(feature = "formats")]
pub use files::{
    Format, LoadError, LoadOptions, LoadProgress, MOST_PIPED, WriteError, load, load_bytes, load_stream, load_with,
    write, write_ascii, write_quantised,
};
pub use lines::Lines;
pub use mesh::{Mesh, MeshError};
pub use mesh_edges::MeshEdge;
#[cfg(feature = "formats")]
pub use model::{
    AlphaMode, GltfMaps, LinePart, MetallicRoughness, Model, MtlMaps, MtlMaterial, Part, Property, ScalarValues,
    SourceCamera, SourceLight, SourceLightKind, SourceMaterial, SourceProjection, SpecularGlossiness,
};
pub use normals::{NormalReport, NormalWeighting, Normals, face_normal};
pub use occlusion::{OcclusionBake, OcclusionError, OcclusionImage};
pub use origin::origin_of_box;
pub use prepare::{
    DistanceBounds, LodCluster, LodGroup, LodHierarchy, MeshReport, RepairReport, SimplifiedMesh, Weld, WeldReport,
};
pub use problems::Problems;
#[cfg(feature = "formats")]
pub use source_map::{SourceChannel, SourceLevels, SourceMap, SourceWrap};
pub use subdivide::Subdivision;
pub use surfaces::{
    BezierPatch, Capsule, Cone, Cuboid, Cylinder, Disc, Ellipsoid, HeightField, Hyperboloid, HyperboloidSheet,
    Icosphere, Paraboloid, Parameter, ParametricSurface, Plane, Quadric, Surface, SurfaceError, SurfacePiece,
    SurfacePoint, Teapot, Tessellation, Torus, UvSphere, tessellate,
};
