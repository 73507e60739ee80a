//! How often a surface is shaded, by which reflectance, and on which sides.

use crate::choices::{Choice, Choices};
use crate::frequency::Frequency;
use crate::invalid::{Fields, InvalidValue, Problem};

/// The shading frequency: where the equation is evaluated.
///
/// On an object it wins over the one on the camera.
///
/// ```
/// use bevy_ecs::world::World;
/// use halfway_lighting::{Frequency, Material, Shading, Terms};
///
/// let mut world = World::new();
/// world.spawn((Material::BRASS, Shading::Gouraud));
/// // Highlights stay sharp, and the rest is spared.
/// let sharp = Terms { diffuse: Frequency::Vertex, specular: Frequency::Fragment };
/// world.spawn((Material::BRASS, Shading::Terms(sharp)));
/// assert_eq!(Terms::from(Shading::Gouraud), Terms::both(Frequency::Vertex));
/// // A label keeps its colours in the dark.
/// world.spawn((Material::BRASS, Shading::Unlit));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
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
    /// The base colour as it is, whatever the lights: I = kd × the color of the vertices × the color image × the solid.
    /// No light, no ambient light, no environment and no emission has part in it, nor do images other than those of the
    /// color and the opacity. Opacity, sides, lines and tone mapping are as ever. glTF's `KHR_materials_unlit` is this.
    Unlit,
    /// Each term of the lights at a frequency of its own.
    Terms(Terms),
}

impl Shading {
    /// The shadings with names that light has part in.
    pub const LIT: [Self; 3] = [Self::Flat, Self::Gouraud, Self::Phong];

    /// Its name for readers: "flat", "Gouraud", "Phong", "unlit"; "mixed terms" of [`Shading::Terms`], also where another name
    /// fits.
    pub fn name(self) -> &'static str {
        self.choice().map_or("mixed terms", |choice| choice.name)
    }

    /// Checks that the frequencies can be drawn together.
    ///
    /// # Errors
    /// Returns [`InvalidValue`] if one term is evaluated once a triangle, and the other at the vertices or fragments.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        Terms::from(*self).validate()
    }
}

impl Choices for Shading {
    const CHOICES: &'static [Choice<Self>] = &[
        Choice { value: Self::Flat, key: "flat", name: "flat", meaning: "One shade per triangle, at its centroid." },
        Choice {
            value: Self::Gouraud,
            key: "gouraud",
            name: "Gouraud",
            meaning: "At every vertex; colours are interpolated.",
        },
        Choice {
            value: Self::Phong,
            key: "phong",
            name: "Phong",
            meaning: "At every fragment; normals are interpolated.",
        },
        Choice { value: Self::Unlit, key: "unlit", name: "unlit", meaning: "The base color as it is, without lights." },
    ];
}

/// Where each term of an object's lights is evaluated: the value of [`Shading::Terms`], and what every shading comes to.
///
/// Flat is `Triangle` for both, Gouraud `Vertex`, Phong `Fragment`, and unlit `Never` (`Terms::from(shading)`). The hybrid that keeps
/// highlights sharp and spares the rest is `Terms { diffuse: Vertex, specular: Fragment }`. Emission and ambient are
/// always there; an ambient colour that attenuates goes with the diffuse term.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
                Err(Fields::for_owner("Shading").inside("Terms.").error(field, Problem::TriangleBeside { other }))
            }
        }
    }
}

impl From<Shading> for Terms {
    fn from(shading: Shading) -> Self {
        match shading {
            Shading::Flat => Self::both(Frequency::Triangle),
            Shading::Gouraud => Self::both(Frequency::Vertex),
            Shading::Phong => Self::both(Frequency::Fragment),
            Shading::Unlit => Self::NONE,
            Shading::Terms(terms) => terms,
        }
    }
}

/// The specular term: how a highlight falls off.
///
/// On an object it wins over the one on the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
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

impl Reflectance {
    /// Its name for readers: "Phong", "Blinn–Phong", "matched Blinn–Phong".
    pub fn name(self) -> &'static str {
        self.choice().map_or("", |choice| choice.name)
    }
}

impl Choices for Reflectance {
    const CHOICES: &'static [Choice<Self>] = &[
        Choice {
            value: Self::Phong,
            key: "phong",
            name: "Phong",
            meaning: "(r·v)^shininess, r the reflected light direction.",
        },
        Choice {
            value: Self::BlinnPhong,
            key: "blinn_phong",
            name: "Blinn–Phong",
            meaning: "(n·h)^shininess, h the halfway vector.",
        },
        Choice {
            value: Self::BlinnPhongMatched,
            key: "blinn_phong_matched",
            name: "matched Blinn–Phong",
            meaning: "(n·h)^β with β matched, so that highlights are about as large as under `phong`.",
        },
    ];
}

/// Which sides of a surface are drawn. Front faces wind counter-clockwise, also under a mirroring transform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
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

/// Where the viewer is for the highlights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Viewer {
    /// v points from the surface to the eye; under an orthographic camera it is (0, 0, 1) in eye space everywhere.
    #[default]
    Local,
    /// v is (0, 0, 1) in eye space everywhere: cheaper, and right only for a far or orthographic camera.
    Infinite,
}
