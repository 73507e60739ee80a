//! Environments prepared for rendering.

use std::sync::Arc;

use super::diffuse::Harmonics;
use super::directions::{FACES, on_cube};
use super::{Environment, EnvironmentShape, texel_angle};
use crate::error::TextureError;
use crate::lookup::{Number, between, mean_of_four};

/// The longest side of a rendered face. Larger cube maps, and other shapes that would need a larger one, are reduced.
pub const MOST_FACE_TEXELS: u32 = 1024;

/// An environment prepared for rendering, as an asset: a cube map with its levels, and nine harmonics. Clones share the
/// texels.
///
/// Each face has a border of one texel from its neighbours, so that a lookup reads four texels of one face, even at
/// seams.
///
/// ```
/// use halfway_texture::environment::{Environment, EnvironmentMap, EnvironmentShape};
///
/// // A sky that brightens toward the zenith.
/// let sky = |[_, y, _]: [f64; 3]| [y.max(0.0) as f32, y.max(0.0) as f32, 0.5, 1.0];
/// let environment = Environment::from_fn(EnvironmentShape::Equirectangular, 32, sky)?;
/// let map = EnvironmentMap::new(&environment)?;
/// let [up, down] = [1.0, -1.0].map(|y| map.at([0.0_f64, y, 0.0], 0.0)[0]);
/// assert!(up > 0.9 && down == 0.0);
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap {
    levels: Arc<[EnvironmentLevel]>,
    texels: Arc<[[f32; 4]]>,
    harmonics: Harmonics,
    angle: f64,
}

/// A level of an [`EnvironmentMap`]: six faces, one after the other, each row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EnvironmentLevel {
    /// Texels along a face, without the border.
    pub side: u32,
    /// The index of its first texel in [`EnvironmentMap::texels`].
    pub start: usize,
}

impl EnvironmentMap {
    /// Prepares an environment. A cube map keeps its size; the faces of an equirectangular image are half as wide as it
    /// is high, those of a mirror ball 1/√8 as wide: about the same angle a texel. No face is wider than
    /// [`MOST_FACE_TEXELS`].
    ///
    /// # Errors
    /// See [`TexelImage::new`](crate::TexelImage::new).
    pub fn new(environment: &Environment) -> Result<Self, TextureError> {
        let size = environment.size()[1];
        let side = match environment.shape() {
            EnvironmentShape::Cube => size,
            EnvironmentShape::Equirectangular => size.div_ceil(2),
            EnvironmentShape::MirrorBall => (f64::from(size) / 8.0_f64.sqrt()).ceil() as u32,
        };
        if environment.shape() == EnvironmentShape::Cube && side <= MOST_FACE_TEXELS {
            return Ok(Self::from_cube(environment));
        }
        Ok(Self::from_cube(&environment.to_shape(EnvironmentShape::Cube, side.clamp(1, MOST_FACE_TEXELS))?))
    }

    fn from_cube(cube: &Environment) -> Self {
        let (mut levels, mut texels) = (Vec::new(), Vec::new());
        for (number, level) in cube.images()[0].levels().iter().enumerate() {
            levels.push(EnvironmentLevel { side: level.width, start: texels.len() });
            let bordered = -1..=i64::from(level.width);
            for face in 0..FACES {
                let rows = bordered.clone().flat_map(|y| bordered.clone().map(move |x| [x, y]));
                texels.extend(rows.map(|at| cube.cube_texel(number, face, at)));
            }
        }
        let (harmonics, angle) = (cube.harmonics(), texel_angle(EnvironmentShape::Cube, cube.size()[1]));
        Self { levels: levels.into(), texels: texels.into(), harmonics, angle }
    }

    /// The placeholder for a missing or broken environment: squares of magenta and black.
    #[expect(clippy::missing_panics_doc, reason = "the image is small, and its numbers are finite")]
    pub fn missing() -> Self {
        let is_odd = |d: [f64; 3]| d.iter().fold(0, |sum, x| sum + (4.0 * (x + 1.0)) as u32) % 2 == 1;
        let color = |d: [f64; 3]| if is_odd(d) { [1.0, 0.0, 1.0, 1.0] } else { [0.0, 0.0, 0.0, 1.0] };
        let cube = Environment::from_fn(EnvironmentShape::Cube, 32, color);
        Self::from_cube(&cube.expect("a small image of finite numbers"))
    }

    /// The levels, the finest first, one texel a face last.
    pub fn levels(&self) -> &[EnvironmentLevel] {
        &self.levels
    }

    /// The texels of all levels with their borders, one after the other.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }

    /// Its diffuse light.
    pub fn harmonics(&self) -> &Harmonics {
        &self.harmonics
    }

    /// The side of a square with the mean solid angle of the first level's texels, in radians.
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// D: the level whose texels have this angle; below 0 if those of the first are wider.
    pub fn level_of<T: Number>(&self, angle: T) -> T {
        angle.binary_logarithm() - T::from_f64(libm::log2(self.angle))
    }

    /// Whether one is a clone of the other.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.texels, &other.texels)
    }

    /// The light from a direction, of any length, interpolated between the two levels around `level`.
    pub fn at<T: Number>(&self, direction: [T; 3], level: T) -> [T; 3] {
        let place = on_cube(direction);
        between(self.levels.len(), level, |level| self.in_level(place, level))
    }

    fn in_level<T: Number>(&self, (face, uv): (usize, [T; 2]), number: usize) -> [T; 3] {
        let EnvironmentLevel { side, start } = self.levels[number];
        let width = side as usize + 2;
        let first = start + face * width * width;
        // The border's texel has the number 0.
        let [x, y] = uv.map(|u| u * T::from_f64(side.into()) + T::from_f64(0.5));
        let [i, j] = [x, y].map(|x| x.floor().to_usize().unwrap_or_default().min(side as usize));
        let parts = [(x, i), (y, j)].map(|(x, i)| x - T::from_f64(i as f64));
        mean_of_four(parts, |[x, y]| {
            let [r, g, b, _] = self.texels[first + (j + y) * width + i + x];
            [r, g, b].map(|number| T::from_f64(number.into()))
        })
    }
}

/// An environment in the eye space of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct SurroundingsData {
    /// Its light.
    pub map: EnvironmentMap,
    /// Factor of all its light.
    pub strength: f32,
    /// The rows of the rotation from eye space to the environment.
    pub rows: [[f32; 3]; 3],
    /// The coefficients of `halfway_lighting::equations::mean_light`.
    pub mean: [[f32; 3]; 9],
    /// The level that is drawn as the sky, in place of the clear color; `None` without a sky.
    pub sky: Option<f32>,
}

impl SurroundingsData {
    /// Rotates a direction of eye space into the environment.
    pub fn direction(&self, d: [f32; 3]) -> [f32; 3] {
        self.rows.map(|[x, y, z]| x * d[0] + y * d[1] + z * d[2])
    }
}
