//! The objects of a scene file.

use halfway_lighting::{Faces, Range, Reflectance, Shading, Tolerance, VertexColors};
use halfway_mesh::Normals;

use crate::check::{Check, KeyProblem, Limits};
use crate::displacement::DisplacementEntry;
use crate::edges::EdgesEntry;
use crate::keys::{Object, keys};
use crate::lines::LineStyleEntry;
use crate::maps::MapsEntry;
use crate::material::MaterialEntry;
use crate::mesh::MeshEntry;
use crate::scalars_entry::ScalarsEntry;
use crate::solid::SolidEntry;
use crate::track::{Animate, TrackEntry};
use crate::transform::TransformEntry;
use crate::viewport::LAYERS;

keys! {
    /// A mesh somewhere in the scene, with a material.
    #[derive(Clone, Debug, PartialEq)]
    pub struct ObjectEntry {
        [required]
        /// The shape. Required.
        mesh: MeshEntry,
        [optional]
        /// Its name, by which lights are attached; no other camera, light or object has the same. null: none.
        name: Option<String> = None,
        /// How the mesh gets its normals.
        normals: Normals = Normals::default(),
        /// The image that moves the vertices, before they get their normals; null: none.
        displacement: Option<DisplacementEntry> = None,
        /// Where the mesh is in the world.
        transform: TransformEntry = TransformEntry::default(),
        /// The material; null: the model's own, or the default values where it has none.
        material: Option<MaterialEntry> = None,
        /// The material of back faces; null: the same as in front.
        back_material: Option<MaterialEntry> = None,
        /// The shading of this object; null: the scene's.
        shading: Option<Shading> = None,
        /// The tolerance of this object; null: the scene's.
        tolerance: Option<Tolerance> = None,
        /// The reflectance of this object; null: the scene's.
        reflectance: Option<Reflectance> = None,
        /// The use of the colors at the mesh's vertices, if it has any.
        vertex_colors: VertexColors = VertexColors::default(),
        /// The images on the object; null: the model's own where there is no `material`.
        maps: Option<MapsEntry> = None,
        /// The solid that the object is cut from, whose color multiplies ambient and diffuse light; null: nothing.
        solid: Option<SolidEntry> = None,
        /// Numbers on the mesh, as colours: they multiply those of `material`, and take the place of the colors, the
        /// material and the images of the model's own; null: none.
        scalars: Option<ScalarsEntry> = None,
        /// Whether a checker of magenta and black is shown where an image of the model's own is missing or broken; else
        /// its material is, without the image.
        mark_missing_images: bool = false,
        /// Lines along the edges of the mesh; null: the scene's.
        edges: Option<EdgesEntry> = None,
        /// The numbers of the layers that it belongs to, each 0 to 31: a camera sees the objects and lights that share a
        /// layer with it. null: 0.
        layers: Option<Vec<u32>> = None => LAYERS,
        /// The looks of the model's lines and points; null: the scene's.
        line_style: Option<LineStyleEntry> = None,
        /// How translation, rotation and scale change in time.
        animation: Vec<TrackEntry> = Vec::new(),
        [left out]
        /// Which sides are shown. Left out: `front`, or `both` for parts with a double-sided material of the model's
        /// own.
        faces: Faces,
        /// The object is not there where its opacity is below this number, 0 or more; 0 cuts nothing away. Left out:
        /// no, except for parts with a masked material of the model's own.
        mask: f32 => Limits::Numbers(Range::NON_NEGATIVE),
        /// Whether the material's opacity lets what is behind show through. Left out: no, except for parts with a
        /// blended material of the model's own.
        blend: bool,
    }
}

impl Object for ObjectEntry {
    const EXPECTED: &'static str = "an object with the keys of a scene's object";

    fn check_whole(&self) -> Check {
        if self.scalars.is_some() && (self.maps.is_some() || self.displacement.is_some()) {
            let other = if self.maps.is_some() { "maps" } else { "displacement" };
            let message = format!("cannot stand beside `{other}`, which takes texture coordinates, too");
            return Err(KeyProblem::new("scalars", message));
        }
        self.transform.check_tracks(&self.animation)
    }
}
