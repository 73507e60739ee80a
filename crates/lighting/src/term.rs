//! The terms of the equation, each of which can be drawn alone.

use crate::choices::{Choice, Choices};
use crate::{LinearRgba, Material};

/// A term of the equation. The four add up to the intensity.
///
/// ```
/// use halfway_lighting::{Choices, LinearRgba, Material, Term};
///
/// let brass = Term::Specular.of_material(Material::BRASS);
/// assert_eq!((brass.diffuse, brass.specular), (LinearRgba::BLACK, Material::BRASS.specular));
/// assert_eq!(Term::from_key("diffuse"), Some(Term::Diffuse));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Term {
    /// ka·Ga and ka·La of all lights; with it goes what a matt surface receives of an environment, kd·E(n), and the base
    /// color of unlit objects.
    Ambient,
    /// kd·Ld·max(n·l, 0) of all lights, and kd times a hemisphere's light.
    Diffuse,
    /// ks·Ls·S of all lights; with it goes what an environment mirrors, ks·L(r).
    Specular,
    /// ke; with it goes the background, which shines by itself, too.
    Emission,
}

impl Term {
    /// A lit material that reflects or emits no more than this term may need. The diffuse reflectance stays for the
    /// ambient term, too, since an environment takes part in that by kd.
    #[must_use]
    pub fn of_material(self, material: Material) -> Material {
        let black = LinearRgba::BLACK;
        let only = Material { ambient: black, diffuse: black, specular: black, emission: black, ..material };
        match self {
            Self::Ambient => Material { ambient: material.ambient, diffuse: material.diffuse, ..only },
            Self::Diffuse => Material { diffuse: material.diffuse, ..only },
            Self::Specular => Material { specular: material.specular, ..only },
            Self::Emission => Material { emission: material.emission, ..only },
        }
    }
}

impl Choices for Term {
    const CHOICES: &'static [Choice<Self>] = &[
        Choice {
            value: Self::Ambient,
            key: "ambient",
            name: "ambient",
            meaning: "Ambient light, of the scene, the lights and an environment; and unlit objects.",
        },
        Choice { value: Self::Diffuse, key: "diffuse", name: "diffuse", meaning: "The diffuse term of the lights." },
        Choice {
            value: Self::Specular,
            key: "specular",
            name: "specular",
            meaning: "The highlights of the lights, and what an environment mirrors.",
        },
        Choice {
            value: Self::Emission,
            key: "emission",
            name: "emission",
            meaning: "What shines by itself: emission and the background.",
        },
    ];
}
