//! What puts images onto a surface.

use bevy_app::{App, Plugin};
use bevy_ecs::component::Component;
use halfway_asset::{Handle, add_assets};

use crate::decode::TexelMeaning;
use crate::environment::EnvironmentMap;
use crate::normals::FarNormals;
use crate::pyramid::Pyramid;
use crate::sampling::{Channel, Sampling};
use crate::texels::TexelImage;
use crate::uv::UvTransform;

/// An image with its pyramid, as an asset. Its clones share their texels.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture(pub Pyramid);

impl Texture {
    /// What stands for an image that is missing or broken: [`Pyramid::missing`].
    pub fn missing() -> Self {
        Self(Pyramid::missing())
    }
}

impl From<TexelImage> for Texture {
    fn from(image: TexelImage) -> Self {
        Self(Pyramid::new(image))
    }
}

/// What an image on an object says of its surface.
///
/// t is what the filter makes of the texels, taken into 0 to 1, of [`SurfaceMap::channel`] where it is one number.
/// Where something is multiplied, it is by 1 + a·(t − 1), a being [`SurfaceMap::amount`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapKind {
    /// Its color multiplies the ambient and the diffuse reflectance, and its alpha the opacity, unless there is an
    /// [`Opacity`](Self::Opacity).
    Color,
    /// Its color multiplies the specular reflectance.
    Specular,
    /// Its color multiplies the emission.
    Emission,
    /// Its number multiplies the opacity.
    Opacity,
    /// Its number multiplies the exponent of highlights, a matched one after it is matched: those of lights where they
    /// are shaded at the fragments, and what an environment mirrors everywhere.
    Shininess,
    /// Its number multiplies the ambient terms: baked ambient occlusion.
    Occlusion,
    /// Its colors are normals in the space of the mesh's tangents, (2t − 1)·(a, a, 1), where light is shaded at the
    /// fragments; elsewhere it does nothing.
    Normal,
    /// Its numbers, as they are, are heights above the surface in a lengths of the mesh, by which normals are turned
    /// (Blinn
    /// 1978), where light is shaded at the fragments; elsewhere it does nothing. Beside a [`Normal`](Self::Normal) it
    /// does nothing either.
    Height,
}

impl MapKind {
    /// All kinds, in the order of their slots.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Color,
        Self::Specular,
        Self::Emission,
        Self::Opacity,
        Self::Shininess,
        Self::Occlusion,
        Self::Normal,
        Self::Height,
    ];
    /// How many there are.
    pub const COUNT: usize = 8;

    /// What the numbers of its files mean.
    pub fn meaning(self) -> TexelMeaning {
        match self {
            Self::Color | Self::Specular | Self::Emission => TexelMeaning::Color,
            Self::Opacity | Self::Shininess | Self::Occlusion | Self::Normal | Self::Height => TexelMeaning::Data,
        }
    }

    /// Its name in scene files and in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Specular => "specular",
            Self::Emission => "emission",
            Self::Opacity => "opacity",
            Self::Shininess => "shininess",
            Self::Occlusion => "occlusion",
            Self::Normal => "normal",
            Self::Height => "height",
        }
    }

    /// Whether it turns normals, and does not multiply.
    pub fn is_relief(self) -> bool {
        matches!(self, Self::Normal | Self::Height)
    }
}

/// Which of a mesh's two sets of texture coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum UvSet {
    /// The first.
    #[default]
    First,
    /// The second.
    Second,
}

/// An image on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceMap {
    /// The image. While it is not there, [`Pyramid::missing`] is drawn.
    pub texture: Handle<Texture>,
    /// How it is looked up.
    pub sampling: Sampling,
    /// The coordinates of the mesh that it takes. A mesh that does not have them is drawn without it.
    pub uv_set: UvSet,
    /// Where on it they lie.
    pub transform: UvTransform,
    /// The number that counts where one does.
    pub channel: Channel,
    /// a: how much it counts, as [`MapKind`] says. 0 to 1 where it multiplies, any finite number where it turns
    /// normals. Default 1.
    pub amount: f32,
    /// What highlights take of a [`Normal`](MapKind::Normal) beside where it points. Of other kinds it does nothing.
    pub far_normals: FarNormals,
}

impl From<Handle<Texture>> for SurfaceMap {
    fn from(texture: Handle<Texture>) -> Self {
        let (sampling, transform) = (Sampling::default(), UvTransform::default());
        let far_normals = FarNormals::Mean;
        Self { texture, sampling, uv_set: UvSet::First, transform, channel: Channel::Red, amount: 1.0, far_normals }
    }
}

impl SurfaceMap {
    /// The first of its numbers that cannot be used.
    fn wrong(&self, kind: MapKind) -> Option<WrongMap> {
        const NAMES: [&str; 3] = ["transform.offset", "transform.rotation", "transform.scale"];
        if let Some((name, value)) = self.transform.wrong() {
            let field = NAMES.into_iter().find(|full| full.ends_with(name)).unwrap_or(name);
            return Some(WrongMap { kind, field, value, expected: "finite numbers" });
        }
        let amount = self.amount;
        let (is_right, expected) = if kind.is_relief() {
            (amount.is_finite(), "a finite number")
        } else {
            ((0.0..=1.0).contains(&amount), "0 to 1")
        };
        (!is_right).then_some(WrongMap { kind, field: "amount", value: amount, expected })
    }
}

/// A number of [`Maps`] that cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrongMap {
    /// The map.
    pub kind: MapKind,
    /// The number's place in its [`SurfaceMap`].
    pub field: &'static str,
    /// The number.
    pub value: f32,
    /// Those that can be used, in words.
    pub expected: &'static str,
}

/// The images on an object, one of each [`MapKind`] at most; beside its material, on both sides.
///
/// Each counts at every fragment, whatever the shading: under Gouraud and flat shading the ambient, the diffuse and the
/// specular terms are interpolated apart, so that each is multiplied by its own. What belongs to the evaluation of
/// light (shininess, normals, heights) does nothing there, since it is the vertices and triangles that are lit; but for
/// what an environment mirrors, which takes the shininess at every fragment.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct Maps([Option<SurfaceMap>; MapKind::COUNT]);

impl Maps {
    /// One map.
    pub fn new(kind: MapKind, map: impl Into<SurfaceMap>) -> Self {
        Self::default().with(kind, map)
    }

    /// These, and one more, in the place of one of its kind.
    #[must_use]
    pub fn with(mut self, kind: MapKind, map: impl Into<SurfaceMap>) -> Self {
        self.set(kind, Some(map.into()));
        self
    }

    /// Sets or takes away a map.
    pub fn set(&mut self, kind: MapKind, map: Option<SurfaceMap>) {
        self.0[kind as usize] = map;
    }

    /// The map of a kind.
    pub fn get(&self, kind: MapKind) -> Option<&SurfaceMap> {
        self.0[kind as usize].as_ref()
    }

    /// Those that are there.
    pub fn iter(&self) -> impl Iterator<Item = (MapKind, &SurfaceMap)> {
        MapKind::ALL.into_iter().zip(&self.0).filter_map(|(kind, map)| Some((kind, map.as_ref()?)))
    }

    /// The first of their numbers that cannot be used.
    pub fn wrong(&self) -> Option<WrongMap> {
        self.iter().find_map(|(kind, map)| map.wrong(kind))
    }

    /// Those that a mesh with these sets of coordinates shows, each in its slot. Of a normal and a height the normal.
    pub fn shown(&self, has_uvs: [bool; 2]) -> [Option<&SurfaceMap>; MapKind::COUNT] {
        let mut shown = self.0.each_ref().map(|map| map.as_ref().filter(|map| has_uvs[map.uv_set as usize]));
        if shown[MapKind::Normal as usize].is_some() {
            shown[MapKind::Height as usize] = None;
        }
        shown
    }
}

/// Gives an app [`Assets`](halfway_asset::Assets) of [`Texture`] and [`EnvironmentMap`].
///
/// May be added late and more than once: textures that the app has already stay.
#[derive(Clone, Copy, Debug, Default)]
pub struct TexturePlugin;

impl Plugin for TexturePlugin {
    fn build(&self, app: &mut App) {
        add_assets::<Texture>(app);
        add_assets::<EnvironmentMap>(app);
    }

    fn is_unique(&self) -> bool {
        false
    }
}
