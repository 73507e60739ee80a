//! The kinds of light, a file each.
//!
//! The file of a kind holds its component, its maths, its bound, its record, its WGSL function and its fields in scene
//! files. One list names the kinds: from it come [`Light`], [`LightComponent`], [`Kind`], the WGSL that calls the function
//! of a light's kind, and `LightQueries`. Renderers use a light through the traits [`LightKind`] and [`LightSource`].

/// Names the kinds once, for each macro that makes something of them.
macro_rules! with_kinds {
    ($make:ident) => {
        $make! {
            /// Parallel rays.
            Directional directional: DirectionalLight Directional "DIRECTIONAL_LIGHTS";
            /// From a point, in all directions.
            Point point: PointLight Point "POINT_LIGHTS";
            /// From a point, into a cone.
            Spot spot: SpotLight Spot "SPOT_LIGHTS";
            /// From all around: one colour from the sky, another from the ground.
            Hemisphere hemisphere: HemisphereLight Hemisphere "HEMISPHERE_LIGHTS";
        }
    };
}

mod directional;
mod hemisphere;
mod point;
#[cfg(feature = "ecs")]
mod queries;
mod spot;

use std::fmt::Debug;
use std::sync::LazyLock;

use glam::{DAffine3, DVec3};

use crate::Reflectance;
use crate::bounds::{LitTerms, Receiver, TermBounds};
use crate::equations::vector::normalize_or_zero;
use crate::equations::{Arrival, Coefficients, Eye, Incidence, Irradiance, Real, ShadedPoint};
use crate::field::Described;
use crate::invalid::InvalidValue;
use crate::record::LightRecord;

pub use crate::falloff::{ATTENUATION_MAX, Attenuation, Cone, ConeTerms, attenuation, range_window, spot_factor};
pub use crate::light_colors::Colors;
pub use directional::{Directional, DirectionalLight};
pub use hemisphere::{Hemisphere, HemisphereLight};
pub use point::{Point, PointLight};
#[cfg(feature = "ecs")]
pub use queries::LightQueries;
pub use spot::{Spot, SpotLight};

/// A kind of light: the component, and how it becomes a light in an evaluation and in a record.
pub trait LightKind: Described + Debug + PartialEq {
    /// The name of the kind in scene files.
    const NAME: &'static str;
    /// The name of its function in [`WGSL`](Self::WGSL).
    const FUNCTION: &'static str;
    /// Its function in WGSL: the light of one light of the kind at a point. It takes the light, p, n, v, the material
    /// and the terms that are shaded, and gives an `Irradiance`.
    const WGSL: &'static str;

    /// A light of this kind in the number type and the space of an evaluation.
    type Source<T: Real>: LightSource<T>;

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is outside the range it documents.
    fn validate(&self) -> Result<(), InvalidValue>;

    /// The same light with its ambient colour alone.
    #[must_use]
    fn ambient_alone(&self) -> Self;

    /// The light at the transform of its entity.
    ///
    /// # Errors
    /// The entity has no position or no direction, where the kind needs it.
    fn placed(&self, frame: &impl LightFrame) -> Result<Light<f64>, InvalidValue>;

    /// The same light in another number type, each number rounded once.
    fn cast<T: Real, U: Real>(source: &Self::Source<T>) -> Self::Source<U>;

    /// A light in world space, transformed into a view.
    fn in_eye_space(source: &Self::Source<f64>, view: &LightView) -> Self::Source<f64>;

    /// Its demands on the shaders that evaluate it.
    fn needs(source: &Self::Source<f64>) -> LightNeeds;

    /// Its record; the number of its kind is filled in by the caller.
    fn record(source: &Self::Source<f64>) -> LightRecord;
}

/// A light of one kind, in the number type and the space of an evaluation: eye or world, as long as positions, normals
/// and the viewer are in the same one and lengths in it are world units.
pub trait LightSource<T: Real>: Copy + Debug + PartialEq {
    /// Its way to a point; `None` for light from all around.
    fn arrival(&self, surface: &ShadedPoint<T>) -> Option<Arrival<T>>;

    /// Its direction and strength at a point; `None` for light from all around.
    fn incidence(&self, surface: &ShadedPoint<T>) -> Option<Incidence<T>> {
        self.arrival(surface).map(|arrival| arrival.incidence())
    }

    /// Its colours; `None` for light from all around.
    fn colors(&self) -> Option<Colors<T>>;

    /// Its light at a point of this material, before the material's reflectances.
    fn irradiance(
        &self,
        surface: &ShadedPoint<T>,
        view: &Eye<T>,
        reflectance: Reflectance,
        material: &Coefficients<T>,
    ) -> Irradiance<T>;

    /// Its ambient colour, where that is the same at every point; else black.
    fn steady_ambient(&self) -> [T; 3];

    /// The terms that may be above 0 somewhere on a patch, by signs alone.
    fn lit_terms(&self, receiver: &Receiver<T>) -> LitTerms;

    /// Upper bounds of its terms over a patch.
    fn bounds(&self, receiver: &Receiver<T>) -> TermBounds<T>;

    /// The sphere outside which it adds nothing; `None` for a light that reaches everything.
    fn reach(&self) -> Option<([T; 3], T)>;
}

/// The frame of a light's entity, in the space of the evaluation.
pub trait LightFrame {
    /// Its position.
    ///
    /// # Errors
    /// A coordinate is not finite.
    fn position(&self) -> Result<[f64; 3], InvalidValue>;

    /// Its −Z axis, unit length.
    ///
    /// # Errors
    /// The axis has length 0 or is not finite.
    fn forward(&self) -> Result<[f64; 3], InvalidValue>;

    /// Its +Y axis, unit length.
    ///
    /// # Errors
    /// The axis has length 0 or is not finite.
    fn up(&self) -> Result<[f64; 3], InvalidValue>;
}

/// The transform of lights from the world into a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightView {
    /// From the world into eye space.
    pub eye_from_world: DAffine3,
    /// The unit of lengths in eye space, in world units.
    pub unit: f64,
    /// The largest distance of a light from the eye, in that unit. One that is farther away is brought nearer, with its
    /// falloff, in the same direction.
    pub farthest: f64,
}

impl LightView {
    /// A direction of the world in eye space.
    pub fn direction(&self, world: [f64; 3]) -> [f64; 3] {
        normalize_or_zero((self.eye_from_world.matrix3 * DVec3::from_array(world)).to_array())
    }
}

/// The demands of lights on the shaders that evaluate them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent fact")]
pub struct LightNeeds {
    /// A highlight: a specular colour that is not black.
    pub highlights: bool,
    /// A specular colour other than the diffuse one.
    pub own_specular: bool,
    /// An ambient term that distance and cone weaken.
    pub attenuated_ambient: bool,
    /// A range.
    pub range: bool,
}

impl LightNeeds {
    /// The demands of both.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            highlights: self.highlights || other.highlights,
            own_specular: self.own_specular || other.own_specular,
            attenuated_ambient: self.attenuated_ambient || other.attenuated_ambient,
            range: self.range || other.range,
        }
    }
}

/// A set of kinds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct KindSet(u32);

impl KindSet {
    /// No kind.
    pub const EMPTY: Self = Self(0);
    /// Every kind.
    pub const ALL: Self = Self((1 << Kind::ALL.len()) - 1);

    /// The same with one more kind.
    #[must_use]
    pub const fn with(self, kind: Kind) -> Self {
        Self(self.0 | 1 << kind as u32)
    }

    /// Whether a kind is in the set.
    pub const fn has(self, kind: Kind) -> bool {
        self.0 & 1 << kind as u32 != 0
    }

    /// How many kinds.
    pub const fn len(self) -> u32 {
        self.0.count_ones()
    }

    /// Whether it is empty.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }
}

impl FromIterator<Kind> for KindSet {
    fn from_iter<I: IntoIterator<Item = Kind>>(kinds: I) -> Self {
        kinds.into_iter().fold(Self::EMPTY, Self::with)
    }
}

/// The WGSL of all kinds: the function of each, and `any_light`, which calls the one of a light's kind. It needs the
/// text of the equations in WGSL. A pipeline holds the functions of those kinds alone whose constants are on, by the
/// names of [`Kind::wgsl_constant`]; `MIXED_LIGHTS` says whether they are several.
pub fn wgsl() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(|| {
        let mut text = String::from("// Lights by their kind.\n\n");
        for kind in Kind::ALL {
            text.extend(["override ", kind.wgsl_constant(), ": bool = true;\n"]);
        }
        text.push_str("override MIXED_LIGHTS: bool = true;\n");
        for kind in Kind::ALL {
            text.push_str(kind.wgsl());
        }
        text.push_str(
            "
// A light of any kind.
fn any_light(light: Light, p: vec3f, n: vec3f, v: vec3f, material: Material, terms: Terms) -> Irradiance {
",
        );
        for kind in Kind::ALL {
            let (constant, function, number) = (kind.wgsl_constant(), kind.wgsl_function(), *kind as u32);
            text.extend([
                "    if ",
                constant,
                " {\n        if !MIXED_LIGHTS || light.kind == ",
                &number.to_string(),
                "u {\n",
            ]);
            text.extend(["            return ", function, "(light, p, n, v, material, terms);\n        }\n    }\n"]);
        }
        text.push_str("    return Irradiance();\n}\n");
        text
    });
    &TEXT
}

macro_rules! light_kinds {
    ($($(#[$meaning:meta])* $kind:ident $name:ident: $component:ident $source:ident $constant:literal;)*) => {
        /// The kinds of light, in the order in which their lights are summed. The numbers are those of records.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        pub enum Kind {
            $($(#[$meaning])* $kind),*
        }

        impl Kind {
            /// All of them, by their numbers.
            pub const ALL: &'static [Self] = &[$(Self::$kind),*];

            /// The kind of a number in a record.
            pub fn from_number(number: u32) -> Option<Self> {
                Self::ALL.get(number as usize).copied()
            }

            /// Its name in scene files.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$kind => $component::NAME),*
                }
            }

            /// The constant in WGSL that says whether a pipeline draws it.
            pub const fn wgsl_constant(self) -> &'static str {
                match self {
                    $(Self::$kind => $constant),*
                }
            }

            const fn wgsl_function(self) -> &'static str {
                match self {
                    $(Self::$kind => $component::FUNCTION),*
                }
            }

            const fn wgsl(self) -> &'static str {
                match self {
                    $(Self::$kind => $component::WGSL),*
                }
            }

            /// The names of the fields of its component in scene files.
            pub fn fields(self) -> impl Iterator<Item = &'static str> {
                let names: Vec<_> = match self {
                    $(Self::$kind => <$component as Described>::FIELDS.iter().map(|field| field.name).collect()),*
                };
                names.into_iter()
            }
        }

        /// A light of any kind, in the number type and the space of an evaluation.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Light<T> {
            $($(#[$meaning])* $kind($source<T>)),*
        }

        impl<T: Real> Light<T> {
            /// Its kind.
            #[inline]
            pub fn kind(&self) -> Kind {
                match self {
                    $(Self::$kind(_) => Kind::$kind),*
                }
            }

            /// The same light in another number type, each number rounded once. Lengths have to fit into it.
            #[must_use]
            pub fn cast<U: Real>(&self) -> Light<U> {
                match self {
                    $(Self::$kind(source) => Light::$kind(<$component as LightKind>::cast(source))),*
                }
            }
        }

        impl<T: Real> LightSource<T> for Light<T> {
            fn arrival(&self, surface: &ShadedPoint<T>) -> Option<Arrival<T>> {
                match self {
                    $(Self::$kind(source) => source.arrival(surface)),*
                }
            }

            fn colors(&self) -> Option<Colors<T>> {
                match self {
                    $(Self::$kind(source) => source.colors()),*
                }
            }

            fn irradiance(
                &self,
                surface: &ShadedPoint<T>,
                view: &Eye<T>,
                reflectance: Reflectance,
                material: &Coefficients<T>,
            ) -> Irradiance<T> {
                match self {
                    $(Self::$kind(source) => source.irradiance(surface, view, reflectance, material)),*
                }
            }

            fn steady_ambient(&self) -> [T; 3] {
                match self {
                    $(Self::$kind(source) => source.steady_ambient()),*
                }
            }

            #[inline]
            fn lit_terms(&self, receiver: &Receiver<T>) -> LitTerms {
                match self {
                    $(Self::$kind(source) => source.lit_terms(receiver)),*
                }
            }

            #[inline]
            fn bounds(&self, receiver: &Receiver<T>) -> TermBounds<T> {
                match self {
                    $(Self::$kind(source) => source.bounds(receiver)),*
                }
            }

            #[inline]
            fn reach(&self) -> Option<([T; 3], T)> {
                match self {
                    $(Self::$kind(source) => source.reach()),*
                }
            }
        }

        impl Light<f64> {
            /// A light in world space, transformed into a view.
            #[must_use]
            pub fn in_eye_space(&self, view: &LightView) -> Self {
                match self {
                    $(Self::$kind(source) => Self::$kind($component::in_eye_space(source, view))),*
                }
            }

            /// Its demands on the shaders that evaluate it.
            pub fn needs(&self) -> LightNeeds {
                match self {
                    $(Self::$kind(source) => <$component as LightKind>::needs(source)),*
                }
            }

            pub(crate) fn record(&self) -> LightRecord {
                let record = match self {
                    $(Self::$kind(source) => <$component as LightKind>::record(source)),*
                };
                LightRecord { kind: self.kind() as u32, ..record }
            }
        }

        /// A light component of any kind, where a file decides which.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum LightComponent {
            $($(#[$meaning])* $kind($component)),*
        }

        $(
            impl From<$component> for LightComponent {
                fn from(light: $component) -> Self {
                    Self::$kind(light)
                }
            }
        )*

        impl LightComponent {
            /// The same light with its ambient colour alone: what it adds to the ambient term.
            #[must_use]
            pub fn ambient_alone(&self) -> Self {
                match self {
                    $(Self::$kind(light) => Self::$kind(light.ambient_alone())),*
                }
            }

            /// The light where its entity stands.
            ///
            /// # Errors
            /// A field is outside the range it documents, or the entity has no position or no direction, where the kind
            /// needs it.
            pub fn placed(&self, frame: &impl LightFrame) -> Result<Light<f64>, InvalidValue> {
                match self {
                    $(Self::$kind(light) => light.validate().and_then(|()| light.placed(frame))),*
                }
            }
        }
    };
}

with_kinds!(light_kinds);
