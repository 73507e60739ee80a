//! How often a surface is shaded, by which reflectance, and on which side.

use bevy_ecs::component::Component;

use crate::frequency::Frequency;
use crate::invalid::{Fields, InvalidValue, Problem};

/// The shading frequency: where the equation is evaluated.
///
/// On an object it wins over the one on the camera.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Shading {
    /// One colour a triangle, at its centroid and with its geometric normal turned to the side seen.
    Flat,
    /// At each vertex with the vertex normal; colours are interpolated over the triangle, perspective-correctly and
    /// unclamped.
    Gouraud,
    /// At each fragment with the interpolated, renormalised normal.
    #[default]
    Phong,
}

/// The frequency at which each term of an object's lights is evaluated, in place of its [`Shading`].
///
/// Flat is `Triangle` for both, Gouraud `Vertex`, Phong `Fragment` (`Terms::from(shading)`). The hybrid that keeps
/// highlights sharp and spares the rest is `Terms { diffuse: Vertex, specular: Fragment }`. Emission and ambient are
/// always there; an ambient colour that attenuates goes with the diffuse term.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Terms {
    /// Frequency of kd·Ld·max(n·l, 0).
    pub diffuse: Frequency,
    /// Frequency of ks·Ls·S.
    pub specular: Frequency,
}

impl Terms {
    /// Both terms left out: emission and ambient alone.
    pub const NONE: Self = Self::both(Frequency::Never);

    /// Both terms at one frequency.
    pub const fn both(frequency: Frequency) -> Self {
        Self { diffuse: frequency, specular: frequency }
    }

    /// Whether any term has this frequency.
    pub fn has(self, frequency: Frequency) -> bool {
        self.diffuse == frequency || self.specular == frequency
    }

    /// The same terms, each at the frequency that `of` gives for its own.
    #[must_use]
    pub fn map(self, of: impl Fn(Frequency) -> Frequency) -> Self {
        Self { diffuse: of(self.diffuse), specular: of(self.specular) }
    }

    /// Checks that the two frequencies can be drawn together.
    ///
    /// # Errors
    /// One term is evaluated once a triangle, and the other at the vertices or fragments.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let other = [Frequency::Vertex, Frequency::Fragment].into_iter().find(|&other| self.has(other));
        match other.filter(|_| self.has(Frequency::Triangle)) {
            None => Ok(()),
            Some(other) => {
                let field = if self.diffuse == Frequency::Triangle { "diffuse" } else { "specular" };
                Err(Fields::for_owner("Terms").error(field, Problem::TriangleBeside { other }))
            }
        }
    }
}

impl From<Shading> for Terms {
    fn from(shading: Shading) -> Self {
        Self::both(match shading {
            Shading::Flat => Frequency::Triangle,
            Shading::Gouraud => Frequency::Vertex,
            Shading::Phong => Frequency::Fragment,
        })
    }
}

/// The specular term: how a highlight falls off.
///
/// On an object it wins over the one on the camera.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Reflectance {
    /// Phong 1975: `max(r·v, 0)^α`, r the reflected light direction and α the material's shininess.
    Phong,
    /// Blinn 1977: `max(n·h, 0)^β`, h the halfway vector and β the material's shininess.
    #[default]
    BlinnPhong,
    /// Blinn–Phong with β matched to the material's shininess taken as Phong's α ([`crate::matched_shininess`]), so
    /// that a highlight has about the size it has under [`Reflectance::Phong`].
    BlinnPhongMatched,
}

/// The sides of a surface that are drawn. Front faces wind counter-clockwise, also under a mirroring transform.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Faces {
    /// Front faces; back faces are culled.
    #[default]
    Front,
    /// Back faces only, lit with the flipped normal and the [`crate::BackMaterial`], if any.
    Back,
    /// Both.
    Both,
}

impl Faces {
    /// Whether front faces are drawn.
    pub const fn shows_front(self) -> bool {
        matches!(self, Self::Front | Self::Both)
    }

    /// Whether back faces are drawn.
    pub const fn shows_back(self) -> bool {
        matches!(self, Self::Back | Self::Both)
    }
}

/// Marks a surface as blended: drawn after the opaque ones, sorted back to front, by its material's opacity.
///
/// Without it a surface is opaque whatever its opacity says.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Blend;

/// Marks a surface as cut out: it is not there where its opacity is below this number, and there as a whole elsewhere,
/// or blended where it has [`Blend`].
///
/// The opacity is the material's, times that of the vertices' colours and of images, where there are any. A finite
/// number, 0 or more; 0 cuts nothing away. The default is 0.5, as in glTF 2.0 (§3.9.4).
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Mask(pub f32);

impl Default for Mask {
    fn default() -> Self {
        Self(0.5)
    }
}

impl Mask {
    /// Expects a finite number, 0 or more.
    ///
    /// # Errors
    /// It is not so.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        Fields::for_owner("Mask").non_negative("0", self.0)
    }
}

/// The position of the viewer for the highlights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Viewer {
    /// v points from the surface to the eye; under an orthographic camera it is (0, 0, 1) in eye space everywhere.
    #[default]
    Local,
    /// v is (0, 0, 1) in eye space everywhere: cheaper, and right only for a far or orthographic camera.
    Infinite,
}
