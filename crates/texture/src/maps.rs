//! The components that put images onto a surface.

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

/// An image with its pyramid, as an asset. Clones share the texels.
///
/// ```
/// use bevy_app::App;
/// use halfway_asset::Assets;
/// use halfway_texture::{TexelImage, Texture, TexturePlugin};
///
/// let mut app = App::new();
/// app.add_plugins(TexturePlugin);
/// let stripes = TexelImage::from_fn(8, 8, |x, _| if x % 2 == 0 { [1.0; 4] } else { [0.0, 0.0, 0.0, 1.0] })?;
/// let handle = app.world_mut().resource_mut::<Assets<Texture>>().add(stripes);
/// assert_eq!(app.world().resource::<Assets<Texture>>().get(&handle).unwrap().0.size(), [8, 8]);
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Texture(pub Pyramid);

impl Texture {
    /// The placeholder for a missing or broken image: [`Pyramid::missing`].
    pub fn missing() -> Self {
        Self(Pyramid::missing())
    }
}

impl From<TexelImage> for Texture {
    fn from(image: TexelImage) -> Self {
        Self(Pyramid::new(image))
    }
}

/// The kind of an image on a surface: the property that it modulates.
///
/// t is the filtered value of the texels, clamped to 0 … 1; where it is one number, of [`SurfaceMap::channel`]. Images
/// that multiply do so by 1 + a·(t − 1), a being [`SurfaceMap::amount`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapKind {
    /// Its color multiplies the ambient and the diffuse reflectance, and its alpha the opacity, unless there is an
    /// [`Opacity`](Self::Opacity).
    Color,
    /// Its color multiplies the specular reflectance.
    Specular,
    /// Its color multiplies the emission.
    Emission,
    /// Its value multiplies the opacity.
    Opacity,
    /// Its value multiplies the exponent of highlights, a matched one after it is matched: those of lights shaded at
    /// fragments, and the reflection of an environment everywhere.
    Shininess,
    /// Its value multiplies the ambient terms: baked ambient occlusion.
    Occlusion,
    /// Its colors are normals in tangent space, (2t − 1)·(a, a, 1). Used where light is shaded at the fragments,
    /// ignored elsewhere.
    Normal,
    /// Its values, not clamped, are heights above the surface in units of a lengths of the mesh, by which normals are
    /// perturbed (Blinn 1978). Used where light is shaded at the fragments, ignored elsewhere and beside a
    /// [`Normal`](Self::Normal).
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
    /// The number of kinds.
    pub const COUNT: usize = 8;

    /// The meaning of its files' values.
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

    /// Whether it is a part of the base color, which an unlit object shows, or of the opacity.
    pub fn is_of_base_color(self) -> bool {
        matches!(self, Self::Color | Self::Opacity)
    }

    /// Whether it perturbs normals instead of multiplying a property.
    pub fn perturbs_normals(self) -> bool {
        matches!(self, Self::Normal | Self::Height)
    }
}

/// One of a mesh's two sets of texture coordinates.
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
    /// The image. Until the asset exists, [`Pyramid::missing`] is drawn.
    pub texture: Handle<Texture>,
    /// Its filters and its wrapping.
    pub sampling: Sampling,
    /// The set of texture coordinates. A mesh without it is drawn without the map.
    pub uv_set: UvSet,
    /// The transform of the coordinates.
    pub transform: UvTransform,
    /// The channel, for maps that use one.
    pub channel: Channel,
    /// a: its strength, see [`MapKind`]. 0 to 1 for images that multiply, any finite number for those that perturb
    /// normals. Default 1.
    pub amount: f32,
    /// The use of a [`Normal`](MapKind::Normal) map by highlights at a distance. Ignored for other kinds.
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
    /// The first invalid field.
    fn wrong(&self, kind: MapKind) -> Option<WrongMap> {
        const NAMES: [&str; 3] = ["transform.offset", "transform.rotation", "transform.scale"];
        if let Some((name, value)) = self.transform.wrong() {
            let field = NAMES.into_iter().find(|full| full.ends_with(name)).unwrap_or(name);
            return Some(WrongMap { kind, field, value, expected: "finite numbers" });
        }
        let amount = self.amount;
        let (is_right, expected) = if kind.perturbs_normals() {
            (amount.is_finite(), "a finite number")
        } else {
            ((0.0..=1.0).contains(&amount), "0 to 1")
        };
        (!is_right).then_some(WrongMap { kind, field: "amount", value: amount, expected })
    }
}

/// An invalid field of [`Maps`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrongMap {
    /// The map.
    pub kind: MapKind,
    /// The field of its [`SurfaceMap`].
    pub field: &'static str,
    /// Its value.
    pub value: f32,
    /// The valid values, in words.
    pub expected: &'static str,
}

/// The images on an object, one of each [`MapKind`] at most, used beside its material, on both sides.
///
/// Each is looked up at every fragment, whatever the shading: under Gouraud and flat shading the ambient, the diffuse
/// and the specular terms are interpolated separately, so that each is multiplied by its own. Maps that change the
/// evaluation of light (shininess, normals, heights) are ignored there, since vertices and triangles are lit; except
/// that the reflection of an environment uses the shininess at every fragment.
///
/// ```
/// use bevy_app::App;
/// use halfway_asset::Assets;
/// use halfway_texture::{MapKind, Maps, SurfaceMap, TexelImage, Texture, TexturePlugin, UvTransform};
///
/// let mut app = App::new();
/// app.add_plugins(TexturePlugin);
/// let mut images = app.world_mut().resource_mut::<Assets<Texture>>();
/// let color = images.add(TexelImage::from_fn(2, 2, |x, y| [x as f32, y as f32, 0.5, 1.0])?);
/// let gloss = images.add(TexelImage::from_fn(2, 2, |x, _| [x as f32; 4])?);
///
/// // The color repeats four times along each axis; the gloss map has half its effect.
/// let tiled = UvTransform { scale: [4.0, 4.0], ..UvTransform::default() };
/// let maps = Maps::new(MapKind::Color, SurfaceMap { transform: tiled, ..SurfaceMap::from(color) })
///     .with(MapKind::Specular, SurfaceMap { amount: 0.5, ..SurfaceMap::from(gloss) });
/// assert_eq!((maps.iter().count(), maps.wrong()), (2, None));
/// app.world_mut().spawn(maps);
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct Maps([Option<SurfaceMap>; MapKind::COUNT]);

impl Maps {
    /// One map.
    pub fn new(kind: MapKind, map: impl Into<SurfaceMap>) -> Self {
        Self::default().with(kind, map)
    }

    /// Adds a map, replacing one of its kind.
    #[must_use]
    pub fn with(mut self, kind: MapKind, map: impl Into<SurfaceMap>) -> Self {
        self.set(kind, Some(map.into()));
        self
    }

    /// Sets or removes a map.
    pub fn set(&mut self, kind: MapKind, map: Option<SurfaceMap>) {
        self.0[kind as usize] = map;
    }

    /// The map of a kind.
    pub fn get(&self, kind: MapKind) -> Option<&SurfaceMap> {
        self.0[kind as usize].as_ref()
    }

    /// All maps, in the order of their slots.
    pub fn iter(&self) -> impl Iterator<Item = (MapKind, &SurfaceMap)> {
        MapKind::ALL.into_iter().zip(&self.0).filter_map(|(kind, map)| Some((kind, map.as_ref()?)))
    }

    /// The first invalid field.
    pub fn wrong(&self) -> Option<WrongMap> {
        self.iter().find_map(|(kind, map)| map.wrong(kind))
    }

    /// The maps that a mesh with these sets of coordinates shows, each in its slot; a normal map hides a height map.
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
