//! Solid textures: patterns that fill space, of which surfaces show a cut (Peachey, "Solid Texturing of Complex
//! Surfaces", and Perlin, "An Image Synthesizer", both 1985). They need no texture coordinates.
//!
//! *Position.* A point p of an object lies in the solid at q = M·(p, 1), in cells, M being
//! [`SolidTexture::solid_from_object`].
//!
//! *Footprint.* a and b are the derivatives of q along x and along y of the picture. Over a triangle p/w and 1/w are
//! linear on the picture, w the distance along the view, so that ∂p = w·(∂(p/w) − p·∂(1/w)) by the quotient rule, and
//! ∂q = M₃·∂p with M₃ the first three columns of M. From them follow
//!
//! - the width of [`Marble`](SolidKind::Marble), [`Wood`](SolidKind::Wood) and [`Noise`](SolidKind::Noise):
//!   max(|a|, |b|), the longer side of the footprint, as [`lookup::level`](crate::lookup::level) takes it of images;
//! - the box of [`Checker`](SolidKind::Checker): along each axis k √(aₖ² + bₖ²), the box whose variance along the axis
//!   is that of the parallelogram of a and b.
//!
//! *Value.* t, from 0 to 1, by [`noise`](crate::noise): `checker(q + ½)`, `marble(q)`, `wood(q)`, or ½ +
//! ½·`fractal(q)` clamped to 0 … 1. Detail finer than the footprint fades to its mean.
//!
//! *Color.* c₀ + t·(c₁ − c₀), which multiplies the ambient and the diffuse reflectance at each fragment, whatever the
//! shading, as [`MapKind::Color`](crate::MapKind::Color) does; both multiply if both are there.

use bevy_ecs::component::Component;

use crate::lookup::Number;
use crate::noise::{MOST_OCTAVES, checker, fractal, marble, wood};

/// The pattern of a [`SolidTexture`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SolidKind {
    /// Cubes of side 1 around whole numbers, in the first color where the sum of the three is even, else in the second:
    /// [`checker`].
    #[default]
    Checker,
    /// Veins across x, one a unit, bent by noise: [`marble`].
    Marble,
    /// Rings around the y axis, one a unit, made uneven by noise: [`wood`].
    Wood,
    /// A fractal sum of noise, about its mean: [`fractal`].
    Noise,
}

impl SolidKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Checker, Self::Marble, Self::Wood, Self::Noise];
}

/// Cuts an object from a solid pattern; used beside its material, on both sides. The [module](crate::solid) has the
/// formulas.
///
/// Renderers transform points into it in single precision: at 500 units from the solid's origin to 3·10⁻⁵ of a unit.
/// So place several objects in one solid some units apart rather than some thousands.
///
/// ```
/// use halfway_texture::{SolidKind, SolidTexture};
///
/// let oak = SolidTexture::new(SolidKind::Wood, [[0.35, 0.2, 0.1], [0.6, 0.4, 0.2]]).scaled(12.0);
/// assert_eq!(oak.wrong(), None);
/// let [red, _, blue] = oak.color_at([0.1_f64, 0.0, 0.2], [[0.0; 3]; 2]);
/// assert!((0.34..0.61).contains(&red) && blue < red);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct SolidTexture {
    /// The pattern. Default a checker.
    pub kind: SolidKind,
    /// The octaves of marble and noise: 1 to [`MOST_OCTAVES`]. Default 5.
    pub octaves: u32,
    /// M: the rows of the affine map from the object's space to the solid's, in cells. Finite. Default the identity: a
    /// cell is as long as a unit of the mesh.
    pub solid_from_object: [[f32; 4]; 3],
    /// c₀ and c₁: the factors for t = 0 and t = 1, linear RGB, each channel 0 to 1. Default black and white.
    pub colors: [[f32; 3]; 2],
}

impl Default for SolidTexture {
    fn default() -> Self {
        Self {
            kind: SolidKind::default(),
            octaves: 5,
            solid_from_object: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
            colors: [[0.0; 3], [1.0; 3]],
        }
    }
}

/// An invalid field of a [`SolidTexture`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrongSolid {
    /// Its field.
    pub field: &'static str,
    /// Its value.
    pub value: f32,
    /// The valid values, in words.
    pub expected: &'static str,
}

impl SolidTexture {
    /// A solid of this kind in these colors.
    pub fn new(kind: SolidKind, colors: [[f32; 3]; 2]) -> Self {
        Self { kind, colors, ..Self::default() }
    }

    /// The same with `cells` times as many cells along each axis: larger numbers make finer patterns.
    #[must_use]
    pub fn scaled(mut self, cells: f32) -> Self {
        for number in self.solid_from_object.iter_mut().flatten() {
            *number *= cells;
        }
        self
    }

    /// The same with another map from the object's space to the solid's: the columns of a matrix whose last row is 0,
    /// 0, 0, 1, as given by `Mat4::to_cols_array_2d`.
    #[must_use]
    pub fn placed(self, columns: [[f32; 4]; 4]) -> Self {
        Self { solid_from_object: [0, 1, 2].map(|row| columns.map(|column| column[row])), ..self }
    }

    /// The same with another number of octaves.
    #[must_use]
    pub fn with_octaves(self, octaves: u32) -> Self {
        Self { octaves, ..self }
    }

    /// The first invalid field.
    pub fn wrong(&self) -> Option<WrongSolid> {
        if !(1..=MOST_OCTAVES).contains(&self.octaves) {
            return Some(WrongSolid { field: "octaves", value: self.octaves as f32, expected: "1 to 16" });
        }
        let mut numbers = self.solid_from_object.into_iter().flatten();
        if let Some(value) = numbers.find(|number| !number.is_finite()) {
            return Some(WrongSolid { field: "solid_from_object", value, expected: "finite numbers" });
        }
        let value = self.colors.into_iter().flatten().find(|channel| !(0.0..=1.0).contains(channel))?;
        Some(WrongSolid { field: "colors", value, expected: "0 to 1" })
    }

    /// The factor of the ambient and the diffuse reflectance at a point of the object; `ways` are its derivatives along
    /// x and along y of the picture.
    pub fn color_at<T: Number>(&self, p: [T; 3], ways: [[T; 3]; 2]) -> [T; 3] {
        let rows = self.solid_from_object.map(|row| row.map(|number| T::from_f64(number.into())));
        let turned = |v: [T; 3]| rows.map(|[a, b, c, _]| a * v[0] + b * v[1] + c * v[2]);
        let moved = turned(p);
        let q = [0, 1, 2].map(|axis| moved[axis] + rows[axis][3]);
        let t = solid_value(self.kind, self.octaves, q, ways.map(turned));
        let [first, second] = self.colors.map(|color| color.map(|channel| T::from_f64(channel.into())));
        [0, 1, 2].map(|c| first[c] + t * (second[c] - first[c]))
    }
}

/// t at a point of a solid with these derivatives along x and along y of the picture; see the [module](crate::solid).
pub fn solid_value<T: Number>(kind: SolidKind, octaves: u32, q: [T; 3], [x, y]: [[T; 3]; 2]) -> T {
    let half = T::from_f64(0.5);
    let squared = |v: [T; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let width = squared(x).max(squared(y)).sqrt();
    match kind {
        SolidKind::Checker => {
            checker(q.map(|x| x + half), [0, 1, 2].map(|axis| (x[axis] * x[axis] + y[axis] * y[axis]).sqrt()))
        }
        SolidKind::Marble => marble(q, octaves, width),
        SolidKind::Wood => wood(q, width),
        SolidKind::Noise => (half + half * fractal(q, octaves, width)).max(T::zero()).min(T::one()),
    }
}
