//! The formats of model files.

use std::path::Path;

/// A format of model files.
///
/// ```
/// use std::path::Path;
/// use halfway_mesh::Format;
///
/// assert_eq!(Format::from_path(Path::new("scans/bunny.PLY")), Some(Format::Ply));
/// assert_eq!(Format::from_path(Path::new("bunny.txt")), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Garland's SMF.
    Smf,
    /// Wavefront OBJ with its MTL files.
    Obj,
    /// glTF 2.0 in text.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
    /// PLY, in ASCII or binary.
    Ply,
    /// STL, in ASCII or binary.
    Stl,
    /// OFF, in text.
    Off,
    /// 3MF.
    ThreeMf,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 8] =
        [Self::Smf, Self::Obj, Self::Gltf, Self::Glb, Self::Ply, Self::Stl, Self::Off, Self::ThreeMf];

    /// The extension of its files, without the dot.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Smf => "smf",
            Self::Obj => "obj",
            Self::Gltf => "gltf",
            Self::Glb => "glb",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Off => "off",
            Self::ThreeMf => "3mf",
        }
    }

    /// How a file of a format that is not read is converted into one that is: a sentence that names a program, for the
    /// usual formats of CAD, films and simulations; `None` for others.
    ///
    /// ```
    /// use std::path::Path;
    /// use halfway_mesh::Format;
    ///
    /// let way = Format::converter(Path::new("bracket.STEP")).unwrap();
    /// assert_eq!(way, "FreeCAD or Gmsh converts it to stl");
    /// ```
    pub fn converter(path: &Path) -> Option<&'static str> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "step" | "stp" | "iges" | "igs" | "brep" | "fcstd" => Some("FreeCAD or Gmsh converts it to stl"),
            "usd" | "usda" | "usdc" | "usdz" | "abc" | "blend" => Some("Blender converts it to glb"),
            "fbx" | "dae" | "3ds" | "lwo" | "x" | "x3d" | "wrl" | "dxf" => {
                Some("Blender, or `assimp export` of Assimp, converts it to glb")
            }
            "vtk" | "vtu" | "vtp" | "msh" | "inp" | "xdmf" => Some("meshio or ParaView converts it to ply or stl"),
            _ => None,
        }
    }

    /// The format that a file's extension names, in upper or lower case.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?;
        Self::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }
}
