//! Numbers on a mesh, shown by a colour map.

use bevy_color::LinearRgba;
use bevy_math::Vec2;
use halfway_asset::Handle;
use halfway_lighting::{Choice, Choices};
use halfway_mesh::{Mesh, MeshError, ScalarValues};
use halfway_texture::{LevelFilter, MapKind, Maps, Sampling, SurfaceMap, TexelImage, Texture, TextureError, Wrap};
use thiserror::Error;

/// Numbers at the vertices or on the faces of a mesh, and how they become colours.
///
/// Numbers are interpolated over triangles, and colours are looked up for each pixel, so that a pixel has the colour of
/// its number however large the triangle is. The colours are an image on the surface, lit, or as they are
/// where the object is unlit.
///
/// ```
/// use bevy_app::App;
/// use halfway_asset::Assets;
/// use halfway_lighting::{Material, LinearRgba};
/// use halfway_mesh::{Mesh, Mesh3d, MeshPlugin, UvSphere};
/// use halfway_scene::Scalars;
/// use halfway_texture::{MapKind, Texture, TexturePlugin};
///
/// let mut app = App::new();
/// app.add_plugins((MeshPlugin, TexturePlugin));
/// let world = app.world_mut();
/// let sphere = Mesh::from(UvSphere::default());
/// // The height of each vertex, from blue to yellow, with nine lines of equal height.
/// let heights = Scalars::at_vertices(sphere.positions().iter().map(|p| p.y).collect());
/// let heights = Scalars { isolines: 9, ..heights };
/// let (mesh, colors) = heights.on(&sphere)?;
/// let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
/// let colors = world.resource_mut::<Assets<Texture>>().add(colors);
/// world.spawn((Mesh3d(mesh), Material::matte(LinearRgba::WHITE), Scalars::maps(MapKind::Color, colors)));
/// # Ok::<(), halfway_scene::ScalarsError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scalars {
    /// The numbers. Those that are not finite have the colour `missing`.
    pub values: ScalarValues,
    /// The numbers that the map begins and ends with; numbers beyond have the colours of its ends. Default: the least
    /// and the greatest of the values.
    pub range: Option<[f32; 2]>,
    /// The colours. Default [`ColorMap::Viridis`].
    pub map: ColorMap,
    /// The colour of numbers that are not finite, linear RGB. Default a light grey.
    pub missing: LinearRgba,
    /// How many lines of equal numbers are drawn, evenly between the ends of the range, each as wide as a 125th of it.
    /// At most 100. Default 0.
    pub isolines: u32,
}

/// A perceptual colour map: equal differences of numbers look alike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColorMap {
    /// Blue, green, yellow.
    #[default]
    Viridis,
    /// Blue, magenta, yellow.
    Plasma,
    /// Black, red, yellow.
    Inferno,
    /// Black, magenta, white.
    Magma,
    /// Blue, grey, yellow: alike for most colour-blind people.
    Cividis,
    /// Blue, white, red, for numbers on both sides of a middle.
    BlueRed,
}

impl Choices for ColorMap {
    const CHOICES: &'static [Choice<Self>] = &[
        Choice { value: Self::Viridis, key: "viridis", name: "viridis", meaning: "Blue, green, yellow." },
        Choice { value: Self::Plasma, key: "plasma", name: "plasma", meaning: "Blue, magenta, yellow." },
        Choice { value: Self::Inferno, key: "inferno", name: "inferno", meaning: "Black, red, yellow." },
        Choice { value: Self::Magma, key: "magma", name: "magma", meaning: "Black, magenta, white." },
        Choice { value: Self::Cividis, key: "cividis", name: "cividis", meaning: "Blue, grey, yellow." },
        Choice { value: Self::BlueRed, key: "blue_red", name: "blue to red", meaning: "Blue, white, red." },
    ];
}

impl ColorMap {
    /// The colour at a share of the map, from 0 at its beginning to 1 at its end, in bytes of sRGB.
    pub fn at(self, share: f64) -> [u8; 3] {
        let share = share.clamp(0.0, 1.0);
        let (gradient, share) = match self {
            Self::Viridis => (colorous::VIRIDIS, share),
            Self::Plasma => (colorous::PLASMA, share),
            Self::Inferno => (colorous::INFERNO, share),
            Self::Magma => (colorous::MAGMA, share),
            Self::Cividis => (colorous::CIVIDIS, share),
            Self::BlueRed => (colorous::RED_BLUE, 1.0 - share),
        };
        gradient.eval_continuous(share).as_array()
    }

    /// The map in 256 steps, from its beginning to its end, in bytes of sRGB: for a legend.
    pub fn colors(self) -> Vec<[u8; 3]> {
        (0..=255_u8).map(|step| self.at(f64::from(step) / 255.0)).collect()
    }
}

/// Why numbers cannot be shown on a mesh.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ScalarsError {
    /// Not one number for each vertex or face.
    #[error("{found} numbers for {expected} {of}; expected one each")]
    Count {
        /// The numbers given.
        found: usize,
        /// The vertices or faces of the mesh.
        expected: usize,
        /// `"vertices"` or `"faces"`.
        of: &'static str,
    },
    /// The range is no range.
    #[error("the range {0:?}; expected two finite numbers, the lower first")]
    Range([f32; 2]),
    /// Too many lines.
    #[error("{0} isolines; expected at most {MOST_LINES}")]
    Lines(u32),
    /// The mesh with its new vertices could not be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The image of the colours could not be made.
    #[error(transparent)]
    Image(#[from] TextureError),
}

pub(crate) const MOST_LINES: u32 = 100;

/// Texels along the map.
const TEXELS: u32 = 1000;

impl Scalars {
    /// The default colour of missing numbers.
    pub(crate) const MISSING: [f32; 3] = [0.6; 3];

    /// One number a vertex, from the least to the greatest by [`ColorMap::Viridis`].
    pub fn at_vertices(values: Vec<f32>) -> Self {
        Self::new(ScalarValues::Vertices(values))
    }

    /// One number a triangle, in the same way.
    pub fn on_faces(values: Vec<f32>) -> Self {
        Self::new(ScalarValues::Faces(values))
    }

    fn new(values: ScalarValues) -> Self {
        let [red, green, blue] = Self::MISSING;
        let missing = LinearRgba::rgb(red, green, blue);
        Self { values, range: None, map: ColorMap::default(), missing, isolines: 0 }
    }

    /// The numbers that the map begins and ends with: `range`, or the least and the greatest of the finite values; `None`
    /// where no value is finite.
    pub fn shown_range(&self) -> Option<[f32; 2]> {
        self.range.or_else(|| self.values.range())
    }

    /// The mesh with texture coordinates by the numbers and without colours of its own, and the image of the colours that
    /// belongs to them. Numbers on faces give each triangle vertices of its own.
    ///
    /// # Errors
    /// [`ScalarsError`] for a wrong number of values, a range whose ends are not finite or not in order, and more than
    /// 100 isolines.
    pub fn on(&self, mesh: &Mesh) -> Result<(Mesh, TexelImage), ScalarsError> {
        if let Some(range) = self.range.filter(|[low, high]| !(low.is_finite() && high.is_finite() && low < high)) {
            return Err(ScalarsError::Range(range));
        }
        if self.isolines > MOST_LINES {
            return Err(ScalarsError::Lines(self.isolines));
        }
        let counted = |values: &[f32], expected: usize, of| match values.len() {
            found if found == expected => Ok(()),
            found => Err(ScalarsError::Count { found, expected, of }),
        };
        let range = self.shown_range().unwrap_or([0.0, 1.0]);
        let coordinate = |&value: &f32| coordinate(value, range);
        let (mesh, uvs) = match &self.values {
            ScalarValues::Vertices(values) => {
                counted(values, mesh.positions().len(), "vertices")?;
                (mesh.clone(), values.iter().map(coordinate).collect())
            }
            ScalarValues::Faces(values) => {
                counted(values, mesh.triangle_count(), "faces")?;
                (mesh.unshared(), values.iter().flat_map(|value| [coordinate(value); 3]).collect())
            }
        };
        let painted = mesh.with_uvs(uvs)?.without_colors();
        Ok((painted, self.image()?))
    }

    /// The image as the colour of a white surface ([`MapKind::Color`]), lit, or as it is under
    /// [`Shading::Unlit`](halfway_lighting::Shading::Unlit); or as its emission ([`MapKind::Emission`] beside
    /// `Material::emissive(LinearRgba::WHITE)`).
    pub fn maps(kind: MapKind, image: Handle<Texture>) -> Maps {
        Maps::new(kind, Self::surface_map(image))
    }

    pub(crate) fn surface_map(image: Handle<Texture>) -> SurfaceMap {
        let sampling = Sampling { wrap: [Wrap::Clamp; 2], levels: LevelFilter::None, ..Sampling::default() };
        SurfaceMap { sampling, ..SurfaceMap::from(image) }
    }

    /// The map from the left to the right above, and the colour of missing numbers below.
    fn image(&self) -> Result<TexelImage, TextureError> {
        let missing = [self.missing.red, self.missing.green, self.missing.blue, 1.0];
        let texel = |x: u32, y: u32| {
            if y == 1 {
                return missing;
            }
            let share = f64::from(x) / f64::from(TEXELS - 1);
            // Lines lie at whole numbers, and are four texels to each side of them.
            let line = share * f64::from(self.isolines + 1);
            let from_line = (line - line.round()).abs() / f64::from(self.isolines + 1) * f64::from(TEXELS - 1);
            let is_line =
                self.isolines > 0 && from_line <= 4.0 && (0.5..f64::from(self.isolines) + 0.5).contains(&line);
            let [red, green, blue] = self.map.at(share);
            let LinearRgba { red, green, blue, .. } = bevy_color::Srgba::rgb_u8(red, green, blue).into();
            let dim = if is_line { 0.15 } else { 1.0 };
            [dim * red, dim * green, dim * blue, 1.0]
        };
        TexelImage::from_fn(TEXELS, 2, texel)
    }
}

/// The texture coordinates of a number: the middles of texels.
fn coordinate(value: f32, [low, high]: [f32; 2]) -> Vec2 {
    if !value.is_finite() {
        return Vec2::new(0.5, 0.75);
    }
    let span = f64::from(high) - f64::from(low);
    let share = if span > 0.0 { (f64::from(value) - f64::from(low)) / span } else { 0.5 };
    // Beyond the range the image continues with its outermost texels; far beyond, coordinates would lose their digits.
    let share = share.clamp(-10.0, 11.0);
    Vec2::new(((share * f64::from(TEXELS - 1) + 0.5) / f64::from(TEXELS)) as f32, 0.25)
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_mesh::Plane;

    fn plane() -> Mesh {
        Mesh::from(Plane { size: 2.0, divisions: 1 })
    }

    #[test]
    fn coordinates_are_the_middles_of_texels() {
        let texel = |value| coordinate(value, [-1.0, 3.0]).x * TEXELS as f32 - 0.5;
        for (value, expected) in [(-1.0, 0.0), (1.0, 499.5), (3.0, 999.0)] {
            assert!((texel(value) - expected).abs() < 1e-3, "{value}: {}", texel(value));
        }
        assert!(coordinate(f32::NAN, [0.0, 1.0]).y > 0.5);
        // One number alone is in the middle.
        assert!((coordinate(7.0, [7.0, 7.0]).x - 0.5).abs() < 1e-3);
    }

    #[test]
    fn faces_have_vertices_of_their_own() {
        let (painted, _) = Scalars::on_faces(vec![0.0, f32::NAN]).on(&plane()).expect("two numbers");
        let uvs = painted.uvs().expect("coordinates");
        assert_eq!((painted.triangle_count(), uvs.len()), (2, 6));
        assert!(uvs[..3].iter().all(|uv| uv.y < 0.5) && uvs[3..].iter().all(|uv| uv.y > 0.5));
    }

    #[test]
    fn what_cannot_be_shown_is_said() {
        let error = |scalars: Scalars| scalars.on(&plane()).expect_err("refused").to_string();
        assert_eq!(error(Scalars::at_vertices(vec![1.0])), "1 numbers for 4 vertices; expected one each");
        assert_eq!(error(Scalars::on_faces(vec![1.0; 4])), "4 numbers for 2 faces; expected one each");
        let four = Scalars::at_vertices(vec![1.0; 4]);
        assert!(error(Scalars { range: Some([1.0, 1.0]), ..four.clone() }).contains("the lower first"));
        assert!(error(Scalars { isolines: 101, ..four }).contains("at most 100"));
    }

    #[test]
    fn ranges_are_of_the_finite_values() {
        let values = Scalars::at_vertices(vec![2.0, f32::INFINITY, -1.0, f32::NAN]);
        assert_eq!(values.shown_range(), Some([-1.0, 2.0]));
        assert_eq!(Scalars::at_vertices(vec![f32::NAN]).shown_range(), None);
    }
}
