//! The key of a draw: the features that it is specialised for.

use crate::lights::slots::Lists;
use crate::lights::terms::by_fragment_shader;
use halfway_lighting::lights::{Kind, KindSet};
use halfway_lighting::record::Cull;
use halfway_lighting::{Frequency, Terms};
use halfway_texture::{Channel, FarNormals, LevelFilter, MapKind, Sampling, SolidKind, SurfaceMap, UvSet};
use std::fmt;

/// The properties of a draw that its pipeline is specialised for. Its shader has only the code that the draw uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent switch of the shader")]
pub struct DrawKey {
    /// Whether it is blended over the picture.
    pub blend: bool,
    /// The way its lights reach the shader.
    pub lists: Lists,
    /// The frequency of each term; `Never` if it would add nothing.
    pub terms: Terms,
    /// Each instance names its record.
    pub per_instance: bool,
    /// Whether highlights are those of Blinn–Phong; else Phong.
    pub blinn_phong: bool,
    /// Whether v points toward the eye; else it is constant.
    pub local_viewer: bool,
    /// Whether a light attenuates its ambient color.
    pub attenuated_ambient: bool,
    /// Every light's specular color is its diffuse color.
    pub shared_color: bool,
    /// Some light has a range.
    pub ranged: bool,
    /// The exponent is 2 to this power on both sides.
    pub squarings: Option<u8>,
    /// Whether interpolated normals may vanish, so that the geometric one stands in.
    pub geometric_fallback: bool,
    /// The front only in the first pass of a blended two-sided object, which draws the far side.
    pub cull: Cull,
    /// Front faces wind clockwise: the transform mirrors, or only back faces are shown.
    pub clockwise: bool,
    /// The mesh's colors multiply the ambient and diffuse reflectance, and the opacity.
    pub colored: bool,
    /// The lookups of the images.
    pub maps: MapLooks,
    /// A mask cuts away low opacity.
    pub masked: bool,
    /// The surface is lit inside out; known only where tangents count.
    pub inside_out: bool,
    /// The pattern of the solid that it is cut from.
    pub solid: Option<SolidKind>,
    /// An environment lights it.
    pub surrounded: bool,
}

/// The lookup of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MapLook {
    /// The filter.
    pub sampling: Sampling,
    /// The set of texture coordinates.
    pub uv_set: UvSet,
    /// The channel of images of one number.
    pub channel: Channel,
    /// The treatment of minified normal maps.
    pub far_normals: FarNormals,
}

impl MapLook {
    /// Of an image of this kind. Slopes of heights go by D, whatever the filter.
    fn new(kind: MapKind, map: &SurfaceMap) -> Self {
        let SurfaceMap { sampling, uv_set, channel, far_normals, .. } = *map;
        let sampling = Sampling { levels: levels_taken(kind, sampling.levels), ..sampling };
        Self { sampling, uv_set, channel, far_normals }
    }

    /// As maps.wgsl and `by_shape.wgsl` take it; never all of sixteen bits.
    pub fn bits(self) -> u32 {
        let Sampling { wrap: [u, v], magnify, minify, levels } = self.sampling;
        let [by_level, last_by_level] = [levels.by_level(), LevelFilter::Linear].map(|levels| levels as u32);
        let fields = [magnify as u32, minify as u32, by_level, u as u32, v as u32, self.channel as u32];
        let fields = fields.into_iter().enumerate();
        let shape = (levels as u32).saturating_sub(last_by_level);
        let first = (self.uv_set as u32) << 12 | shape << 13;
        fields.fold(first, |bits, (place, field)| bits | field << (2 * place))
    }
}

/// The treatment of a minified image of this kind.
pub(crate) fn levels_taken(kind: MapKind, levels: LevelFilter) -> LevelFilter {
    if kind == MapKind::Height { levels.by_level() } else { levels }
}

/// The lookups of the images of a draw, each in the slot of its kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct MapLooks(pub [Option<MapLook>; MapKind::COUNT]);

impl MapLooks {
    /// Of the images of each kind.
    pub(crate) fn new(maps: &[Option<&SurfaceMap>; MapKind::COUNT]) -> Self {
        Self(std::array::from_fn(|slot| maps[slot].map(|map| MapLook::new(MapKind::ALL[slot], map))))
    }

    /// Whether some filter goes by the footprint's shape.
    pub fn by_shape(&self) -> bool {
        self.0.iter().flatten().any(|look| look.sampling.levels != look.sampling.levels.by_level())
    }

    /// Whether there is an image of this kind.
    pub fn has(&self, kind: MapKind) -> bool {
        self.0[kind as usize].is_some()
    }

    /// Whether highlights take how long the mean of normals is.
    pub fn take_lengths(&self) -> bool {
        self.far_normals() == FarNormals::Toksvig
    }

    /// Whether highlights take how far the slopes of normals lie apart.
    pub fn take_moments(&self) -> bool {
        self.far_normals() == FarNormals::Lean
    }

    fn far_normals(&self) -> FarNormals {
        self.0[MapKind::Normal as usize].map_or(FarNormals::Mean, |look| look.far_normals)
    }

    /// Whether they change the exponent of highlights.
    pub(crate) fn change_exponents(&self) -> bool {
        self.has(MapKind::Shininess) || self.far_normals() != FarNormals::Mean
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }
}

/// Each kind with its bits, as in `maps=Color:1,Normal:21`.
impl fmt::Display for MapLooks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let looks = MapKind::ALL.iter().zip(&self.0).filter_map(|(kind, look)| Some((kind.name(), (*look)?.bits())));
        let each: Vec<String> = looks.map(|(name, bits)| format!("{name}:{bits}")).collect();
        write!(f, "maps={}", each.join(","))
    }
}

impl fmt::Display for DrawKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Terms { diffuse, specular } = self.terms;
        let reflectance = if self.blinn_phong { "blinn_phong" } else { "phong" };
        write!(f, "diffuse={diffuse:?} specular={specular:?} {:?} {reflectance} {:?}", self.lists, self.cull)?;
        for (on, name) in [
            (self.per_instance, "per_instance"),
            (self.local_viewer, "local_viewer"),
            (self.attenuated_ambient, "attenuated_ambient"),
            (self.shared_color, "shared_color"),
            (self.ranged, "ranged"),
            (self.geometric_fallback, "geometric_fallback"),
            (self.clockwise, "clockwise"),
            (self.blend, "blend"),
            (self.colored, "colored"),
            (self.masked, "masked"),
            (self.inside_out, "inside_out"),
            (self.surrounded, "surrounded"),
            (self.maps.take_lengths(), "toksvig"),
            (self.maps.take_moments(), "lean"),
        ] {
            if on {
                write!(f, " {name}")?;
            }
        }
        if !self.maps.is_empty() {
            write!(f, " {}", self.maps)?;
        }
        if let Some(solid) = self.solid {
            write!(f, " solid={solid:?}")?;
        }
        self.squarings.map_or(Ok(()), |squarings| write!(f, " squarings={squarings}"))
    }
}

impl DrawKey {
    /// The plainest draw that is lit: one point light, both terms once a fragment, neither images nor blending.
    pub fn plain() -> Self {
        Self {
            blend: false,
            lists: Lists::Counted(1, KindSet::EMPTY.with(Kind::Point)),
            terms: Terms::both(Frequency::Fragment),
            per_instance: false,
            blinn_phong: true,
            local_viewer: true,
            attenuated_ambient: false,
            shared_color: false,
            ranged: false,
            squarings: None,
            geometric_fallback: false,
            cull: Cull::Back,
            clockwise: false,
            colored: false,
            maps: MapLooks::default(),
            masked: false,
            inside_out: false,
            solid: None,
            surrounded: false,
        }
    }

    /// Whether it has terms of lights at all.
    pub fn is_lit(&self) -> bool {
        self.terms != Terms::NONE
    }

    /// Whether its vertices have more than positions.
    pub fn reads_attributes(&self) -> bool {
        self.is_lit() || self.is_painted()
    }

    /// Whether anything but the material says what ambient and diffuse light it gives back.
    pub fn is_painted(&self) -> bool {
        self.colored || self.is_mapped()
    }

    /// Whether images, a mask, a solid or an environment have part in its fragments.
    pub fn is_mapped(&self) -> bool {
        self.surrounded || self.solid.is_some() || self.masked || !self.maps.is_empty()
    }

    /// Whether fragments take the normal that is interpolated.
    fn interpolates_normals(&self, terms: Terms) -> bool {
        by_fragment_shader(terms).contains(&true) || self.surrounded && !terms.has(Frequency::Triangle)
    }

    /// The same with these terms, in place of more. Switches that then make no difference are set one way, so that they
    /// make no variants.
    #[must_use]
    pub(crate) fn with_terms(self, terms: Terms) -> Self {
        // Light from an environment takes the normal and the exponent as lights would have them.
        let terms = if self.surrounded { self.terms } else { terms };
        // The color of a flat triangle is of one point, whatever light there is.
        let terms = match self.terms {
            Terms { diffuse: Frequency::Triangle, .. } if self.is_painted() => {
                Terms { diffuse: Frequency::Triangle, ..terms }
            }
            Terms { specular: Frequency::Triangle, .. } if self.is_painted() => {
                Terms { specular: Frequency::Triangle, ..terms }
            }
            _ => terms,
        };
        let (lit, specular) = (terms != Terms::NONE, terms.specular != Frequency::Never);
        Self {
            terms,
            lists: if lit { self.lists } else { Lists::NONE },
            blinn_phong: self.blinn_phong || !(specular || self.surrounded),
            local_viewer: self.local_viewer && (specular || self.surrounded),
            attenuated_ambient: self.attenuated_ambient && terms.diffuse != Frequency::Never,
            shared_color: self.shared_color && specular,
            ranged: self.ranged && lit,
            squarings: self.squarings.filter(|_| specular && !self.maps.change_exponents()),
            geometric_fallback: self.geometric_fallback && self.interpolates_normals(terms),
            inside_out: self.inside_out && self.maps.has(MapKind::Normal),
            ..self
        }
    }

    /// The key that draws the same without knowing the lights, the colors, the exponent and the mesh.
    #[must_use]
    pub fn generic(self) -> Self {
        Self {
            lists: if self.is_lit() { Lists::Listed } else { self.lists },
            shared_color: false,
            attenuated_ambient: self.terms.diffuse != Frequency::Never,
            ranged: self.is_lit(),
            squarings: None,
            geometric_fallback: self.interpolates_normals(self.terms),
            ..self
        }
    }

    /// Whether it knows anything that its generic one does not.
    pub fn is_special(self) -> bool {
        self != self.generic()
    }

    /// The generic keys that draw the same object under every shading and reflectance, this one's own among them.
    pub fn relatives(self) -> impl Iterator<Item = Self> {
        let shadings = [Frequency::Triangle, Frequency::Vertex, Frequency::Fragment].into_iter();
        let has_highlights = self.terms.specular != Frequency::Never;
        let lit = shadings.filter(move |_| self.is_lit()).flat_map(move |at| {
            let terms = self.terms.map(|term| if term == Frequency::Never { term } else { at });
            [self.blinn_phong, self.blinn_phong ^ has_highlights].map(|blinn_phong| Self { terms, blinn_phong, ..self })
        });
        std::iter::once(self).chain(lit).map(Self::generic)
    }

    /// The same key for a draw whose instances look up their records.
    #[must_use]
    pub fn looking_up(self) -> Self {
        Self { per_instance: true, ..self }
    }

    /// The passes that draw an object: two for a blended two-sided one, the far side first.
    pub fn passes(self) -> impl Iterator<Item = Self> {
        let far_side = (self.blend && self.cull == Cull::None).then_some(Self { cull: Cull::Front, ..self });
        let near_side = if far_side.is_some() { Self { cull: Cull::Back, ..self } } else { self };
        far_side.into_iter().chain([near_side])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn generic_keys_cover_every_shading() {
        let relatives: HashSet<_> = DrawKey::plain().relatives().collect();
        assert_eq!(relatives.len(), 6, "three shadings by two reflectances");
        assert!(relatives.contains(&DrawKey::plain().generic()) && !relatives.contains(&DrawKey::plain()));
        assert!(relatives.iter().all(|relative| !relative.is_special()));
        let diffuse =
            DrawKey { terms: Terms { specular: Frequency::Never, ..DrawKey::plain().terms }, ..DrawKey::plain() };
        assert_eq!(diffuse.relatives().collect::<HashSet<_>>().len(), 3);
        let unlit = DrawKey { terms: Terms::NONE, ..DrawKey::plain() };
        assert!(unlit.relatives().eq([unlit.generic()]));
    }
}
