//! Meshes: how they are made, prepared, read and written.

mod bad_glb;
mod bad_gltf;
#[path = "../common/mod.rs"]
mod common;
mod displace;
mod files;
mod gltf;
mod gltf_animation;
mod gltf_legal;
mod lines;
mod lod;
mod mesh;
mod normals;
mod normals_creased;
mod normals_suited;
mod obj;
mod obj_by_tobj;
mod occlusion;
mod off;
mod ply;
mod prepare;
mod smf;
mod stl;
mod surfaces;
mod surfaces_common;
mod surfaces_parametric;
mod surfaces_patches;
mod tangents;
mod threemf;
mod write;
mod write_animations;
