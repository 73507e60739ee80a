//! What a scene is timed in.

use halfway::prelude::*;

/// How everything in a scene is shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TimedLook {
    /// In the colour of its material alone: what drawing costs without lighting.
    Constant,
    /// Lit.
    Shaded(Shading),
}

impl TimedLook {
    /// A material of this ambient and diffuse color with a white highlight of shininess 32; without a light to show for
    /// it where the look is constant.
    pub fn material(self, color: LinearRgba) -> Material {
        let lit = Material { specular: LinearRgba::WHITE, shininess: 32.0, ..Material::matte(color) };
        match self {
            Self::Constant => Material { diffuse: LinearRgba::BLACK, specular: LinearRgba::BLACK, ..lit },
            Self::Shaded(_) => lit,
        }
    }

    /// The shading of objects; of no consequence where the look is constant.
    pub fn shading(self) -> Shading {
        match self {
            Self::Constant => Shading::default(),
            Self::Shaded(shading) => shading,
        }
    }
}
