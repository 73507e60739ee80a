#![doc = include_str!("../README.md")]

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
