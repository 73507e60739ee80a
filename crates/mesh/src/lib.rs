//! What halfway lights: triangle meshes, their normals, parametric surfaces and file formats.
//!
//! - [`Mesh`] is a validated list of vertices and triangles, an asset of `bevy_asset`; [`Mesh3d`] puts one on an entity.
//! - [`Normals`] says how a mesh gets its normals: the file's, one a face, or a weighted mean of the faces around a vertex.
//! - [`Plane`], [`Cuboid`], [`UvSphere`] and [`Teapot`] turn into meshes with analytic normals.
//! - [`load`] reads SMF, Wavefront OBJ with MTL, and glTF 2.0 (text and binary) into a [`Model`].
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
mod component;
mod files;
mod mesh;
mod model;
mod normals;
mod problems;
mod surfaces;

pub use bounds::Bounds;
pub use component::{Mesh3d, MeshPlugin, SpawnOrder};
pub use files::{LoadError, load};
pub use mesh::{Mesh, MeshError};
pub use model::{AlphaMode, MetallicRoughness, Model, MtlMaterial, Part, SourceLight, SourceLightKind, SourceMaterial};
pub use normals::{NormalReport, NormalWeighting, Normals, face_normal};
pub use problems::Problems;
pub use surfaces::{Cuboid, Plane, SurfaceError, Teapot, UvSphere};
