//! Light from all directions, as images.

mod diffuse;
mod directions;
mod drawn;
mod light;

use std::f64::consts::PI;

use rayon::prelude::*;

pub use self::diffuse::Harmonics;
pub use self::directions::{
    EnvironmentShape, from_cube, from_equirectangular, from_mirror_ball, on_cube, on_equirectangular, on_mirror_ball,
};
use self::directions::{FACES, unit};
pub use self::drawn::{EnvironmentLevel, EnvironmentMap, MOST_FACE_TEXELS, SurroundingsData};
pub use self::light::{EnvironmentLight, WrongEnvironment};
use crate::error::TextureError;
use crate::lookup::{Number, between, in_level, mean_of_four, wrapped_index};
use crate::pyramid::Pyramid;
use crate::sampling::{TexelFilter, Wrap};
use crate::texels::TexelImage;

/// An image of all directions, with its pyramid: one image, or the six of a cube map.
///
/// Its levels are filtered bilinearly, without seams except the mirror ball's: an equirectangular image continues at
/// its other side, and across a pole on the opposite side, half a texel off if its width is odd; a cube map continues
/// on the neighbouring face, and in its corners, where only three texels meet, the mean of the three stands for the
/// fourth.
///
/// ```
/// use halfway_texture::environment::{Environment, EnvironmentShape};
///
/// // A red half space in front of the viewer, on a mirror ball; the same light as a cube map.
/// let red = |[_, _, z]: [f64; 3]| if z < 0.0 { [1.0, 0.0, 0.0, 1.0] } else { [0.0, 0.0, 0.0, 1.0] };
/// let ball = Environment::from_fn(EnvironmentShape::MirrorBall, 64, red)?;
/// let cube = ball.to_shape(EnvironmentShape::Cube, 16)?;
/// assert_eq!(cube.images().len(), 6);
/// assert!(cube.at([0.3_f64, 0.1, -1.0], 0.0)[0] > 0.9);
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    shape: EnvironmentShape,
    images: Vec<Pyramid>,
}

impl Environment {
    /// From one image, or from six of one size. Negative values, which filters leave in some files, are clamped to 0.
    ///
    /// # Errors
    /// The wrong number of images; images of a cube that are not square, or of several sizes; a mirror ball that is not
    /// square.
    pub fn new(shape: EnvironmentShape, images: Vec<TexelImage>) -> Result<Self, TextureError> {
        let count = if shape == EnvironmentShape::Cube { FACES } else { 1 };
        let [width, height] = images.first().map_or([0; 2], TexelImage::size);
        let square = shape == EnvironmentShape::Equirectangular || width == height;
        if images.len() != count || !square || images.iter().any(|image| image.size() != [width, height]) {
            let sizes = images.iter().map(|image| format!("{} × {}", image.size()[0], image.size()[1]));
            let found = sizes.collect::<Vec<_>>().join(", ");
            return Err(TextureError::Environment { expected: shape.expected(), found });
        }
        Ok(Self { shape, images: images.into_iter().map(|image| Pyramid::new(image.not_below_zero())).collect() })
    }

    /// An environment whose texel in each direction, of length 1, is `color` of it, evaluated at the texel's centre.
    /// `size` is the height of an equirectangular image, or the side of the others, in texels.
    ///
    /// # Errors
    /// See [`TexelImage::new`].
    pub fn from_fn(
        shape: EnvironmentShape,
        size: u32,
        color: impl Fn([f64; 3]) -> [f32; 4] + Sync,
    ) -> Result<Self, TextureError> {
        let (width, count) = match shape {
            EnvironmentShape::Equirectangular => (size.saturating_mul(2), 1),
            EnvironmentShape::MirrorBall => (size, 1),
            EnvironmentShape::Cube => (size, FACES),
        };
        crate::texels::check_size("the environment", width, size)?;
        let image = |face: usize| {
            let texel = |at: usize| {
                let [x, y] = [at % width as usize, at / width as usize].map(|at| at as f64 + 0.5);
                color(unit(direction(shape, face, [x / f64::from(width), y / f64::from(size)])))
            };
            let texels = (0..width as usize * size as usize).into_par_iter().map(texel).collect();
            TexelImage::new(width, size, texels)
        };
        Self::new(shape, (0..count).map(image).collect::<Result<_, _>>()?)
    }

    /// The same light in another shape or size: sampled at each new texel's centre, from the level whose texels have
    /// the new ones' solid angle.
    ///
    /// # Errors
    /// See [`TexelImage::new`].
    pub fn to_shape(&self, shape: EnvironmentShape, size: u32) -> Result<Self, TextureError> {
        let level = (texel_angle(shape, size) / self.angle()).binary_logarithm().max(0.0);
        Self::from_fn(shape, size, |direction| self.at(direction, level).map(|number| number as f32))
    }

    /// Its shape.
    pub fn shape(&self) -> EnvironmentShape {
        self.shape
    }

    /// Its image, or the six of a cube map, with their pyramids.
    pub fn images(&self) -> &[Pyramid] {
        &self.images
    }

    /// Columns and rows of its image, or of each.
    pub fn size(&self) -> [u32; 2] {
        self.images[0].size()
    }

    /// The side of a square with the mean solid angle of its texels, in radians.
    pub fn angle(&self) -> f64 {
        texel_angle(self.shape, self.size()[1])
    }

    /// The light from a direction, of any length, interpolated between the two levels around `level`.
    pub fn at<T: Number>(&self, direction: [T; 3], level: T) -> [T; 4] {
        let direction = unit(direction);
        between(self.images[0].levels().len(), level, |level| self.in_level(direction, level))
    }

    fn in_level<T: Number>(&self, direction: [T; 3], level: usize) -> [T; 4] {
        match self.shape {
            EnvironmentShape::Cube => self.in_cube_level(direction, level),
            EnvironmentShape::Equirectangular => self.in_equirectangular_level(direction, level),
            EnvironmentShape::MirrorBall => {
                in_level(&self.images[0], level, [Wrap::Clamp; 2], TexelFilter::Bilinear, on_mirror_ball(direction))
            }
        }
    }

    fn in_equirectangular_level<T: Number>(&self, direction: [T; 3], level: usize) -> [T; 4] {
        let pyramid = &self.images[0];
        let at = pyramid.levels()[level];
        let texels = pyramid.level(level);
        bilinear(on_equirectangular(direction), [at.width, at.height], |[x, y]| {
            let height = i64::from(at.height);
            // Beyond a pole lies its other side, half a turn on.
            let beyond = y < 0 || y >= height;
            let row = wrapped_index(Wrap::Mirror, y, at.height);
            let column = wrapped_index(Wrap::Repeat, if beyond { x + i64::from(at.width / 2) } else { x }, at.width);
            texels[row * at.width as usize + column].map(|number| T::from_f64(number.into()))
        })
    }

    fn in_cube_level<T: Number>(&self, direction: [T; 3], level: usize) -> [T; 4] {
        let (face, uv) = on_cube(direction);
        let side = self.images[0].levels()[level].width;
        bilinear(uv, [side; 2], |at| self.cube_texel(level, face, at).map(|number| T::from_f64(number.into())))
    }

    /// A texel of a cube map's level, on a face or at most one beyond its edge: there, that of the next face.
    fn cube_texel(&self, level: usize, face: usize, [x, y]: [i64; 2]) -> [f32; 4] {
        let side = self.images[0].levels()[level].width;
        let inside = |at: i64| (0..i64::from(side)).contains(&at);
        let texel =
            |face: usize, [x, y]: [i64; 2]| self.images[face].level(level)[y as usize * side as usize + x as usize];
        // Beyond an edge lies the texel of the next face through which this texel's centre, on this face's plane, is
        // seen: that on the other side of the edge, for any size.
        let across = |[x, y]: [i64; 2]| {
            let middle = [x, y].map(|at| (at as f64 + 0.5) / f64::from(side));
            let (face, uv) = on_cube(from_cube(face, middle));
            texel(face, uv.map(|u| ((u * f64::from(side)) as i64).clamp(0, i64::from(side) - 1)))
        };
        match (inside(x), inside(y)) {
            (true, true) => texel(face, [x, y]),
            (true, false) | (false, true) => across([x, y]),
            (false, false) => {
                let [i, j] = [x, y].map(|at| at.clamp(0, i64::from(side) - 1));
                let three = [texel(face, [i, j]), across([x, j]), across([i, y])];
                std::array::from_fn(|k| (three[0][k] + three[1][k] + three[2][k]) / 3.0)
            }
        }
    }
}

/// The bilinear mean of four texels.
fn bilinear<T: Number>(uv: [T; 2], size: [u32; 2], texel: impl Fn([i64; 2]) -> [T; 4]) -> [T; 4] {
    let [x, y] = [0, 1].map(|axis| uv[axis] * T::from_f64(size[axis].into()) - T::from_f64(0.5));
    let ([i, j], [f, g]) = ([x, y].map(|x| x.floor().to_i64().unwrap_or(0)), [x - x.floor(), y - y.floor()]);
    mean_of_four([f, g], |[x, y]| texel([i + x as i64, j + y as i64]))
}

/// The direction of a point, not normalized on a cube.
fn direction(shape: EnvironmentShape, face: usize, uv: [f64; 2]) -> [f64; 3] {
    match shape {
        EnvironmentShape::Equirectangular => from_equirectangular(uv),
        EnvironmentShape::MirrorBall => from_mirror_ball(uv),
        EnvironmentShape::Cube => from_cube(face, uv),
    }
}

/// The solid angle at a texel's centre, in steradians per unit of u·v.
fn density(shape: EnvironmentShape, [u, v]: [f64; 2]) -> f64 {
    let [s, t] = [2.0 * u - 1.0, 2.0 * v - 1.0];
    match shape {
        EnvironmentShape::Equirectangular => 2.0 * PI * PI * libm::sin(PI * v),
        EnvironmentShape::MirrorBall => 16.0 * f64::from(u8::from(s * s + t * t < 1.0)),
        EnvironmentShape::Cube => {
            let r = (1.0 + s * s + t * t).sqrt();
            4.0 / (r * r * r)
        }
    }
}

/// The side of a square with the mean solid angle of the texels of an environment that is `size` texels high.
fn texel_angle(shape: EnvironmentShape, size: u32) -> f64 {
    let size = f64::from(size);
    let texels = match shape {
        EnvironmentShape::Equirectangular => 2.0 * size * size,
        EnvironmentShape::MirrorBall => 0.25 * PI * size * size,
        EnvironmentShape::Cube => 6.0 * size * size,
    };
    (4.0 * PI / texels).sqrt()
}
