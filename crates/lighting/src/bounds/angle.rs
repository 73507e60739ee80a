//! Angles as cosine and sine, so that they are added and compared without a trigonometric function, and cones of
//! directions.

use crate::equations::vector::{add, cross, dot, scale, sub, toward};
use crate::equations::{Eye, Real};

/// 32 ε: every cosine is raised by it, and radii are widened and distances shortened by this share.
///
/// The longest computation of a cosine from the scene's numbers, Phong's with four angles added, has some thirty
/// roundings of ε/2 each: half of this.
pub(crate) fn slack<T: Real>() -> T {
    T::epsilon() * T::from_f64(32.0)
}

/// An angle in [0, π]. Carrying the sine too keeps small angles: their cosine alone has lost them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Angle<T> {
    pub(crate) cos: T,
    pub(crate) sin: T,
}

impl<T: Real> Angle<T> {
    pub(crate) fn zero() -> Self {
        Self { cos: T::one(), sin: T::zero() }
    }

    /// π.
    pub(crate) fn straight() -> Self {
        Self { cos: -T::one(), sin: T::zero() }
    }

    /// `radians`, at least 0 and at most π; π where it is not a number.
    pub(crate) fn from_radians(radians: T) -> Self {
        if radians < T::from_f64(core::f64::consts::PI) {
            let radians = radians.max(T::zero());
            Self { cos: radians.cosine(), sin: radians.sine() }
        } else {
            Self::straight()
        }
    }

    /// The acute angle whose sine is opposite/hypotenuse, widened by the slack; π where the quotient is not below 1. So
    /// π stands for "any direction": the sphere or the ball of vectors contains the viewing point.
    pub(crate) fn subtended(opposite: T, hypotenuse: T) -> Self {
        let widened = opposite * (T::one() + slack());
        if widened < hypotenuse {
            let sin = widened / hypotenuse;
            Self { cos: ((T::one() - sin) * (T::one() + sin)).sqrt(), sin }
        } else {
            Self::straight()
        }
    }

    /// The angle of a cosine above −1 and below 1.
    pub(crate) fn from_cos(cos: T) -> Self {
        Self { cos, sin: ((T::one() - cos) * (T::one() + cos)).max(T::zero()).sqrt() }
    }

    /// Between two unit vectors.
    pub(crate) fn between(a: [T; 3], b: [T; 3]) -> Self {
        let across = cross(a, b);
        Self { cos: dot(a, b), sin: dot(across, across).sqrt() }
    }

    /// The smaller of this angle and π minus it: from a direction to a line instead.
    pub(crate) fn to_line(self) -> Self {
        Self { cos: self.cos.abs(), sin: self.sin }
    }

    /// The sum, at most π.
    pub(crate) fn plus(self, other: Self) -> Self {
        // a + b ≥ π where cos a ≤ cos(π − b).
        if self.cos + other.cos <= T::zero() {
            return Self::straight();
        }
        Self {
            cos: self.cos * other.cos - self.sin * other.sin,
            sin: (self.sin * other.cos + self.cos * other.sin).max(T::zero()),
        }
    }

    /// The cosine of the difference, of 0 where `other` is larger, raised by the slack: the largest cosine to a
    /// direction at this angle from an axis that any direction within `other` of the axis has.
    pub(crate) fn cos_within(self, other: Self) -> T {
        if self.cos >= other.cos { T::one() } else { self.cos * other.cos + self.sin * other.sin + slack() }
    }

    /// 2 sin(a/2): how far apart two unit vectors at this angle are.
    pub(crate) fn chord(self) -> T {
        // For a small angle 1 − cos a has lost its digits; sin a / cos(a/2) has not.
        if self.cos > T::zero() {
            self.sin / ((T::one() + self.cos) * T::from_f64(0.5)).sqrt()
        } else {
            ((T::one() - self.cos) * T::from_f64(2.0)).sqrt()
        }
    }
}

/// All directions within an angle of an axis of unit length. With the angle π the axis may be anything.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cap<T> {
    pub(crate) axis: [T; 3],
    pub(crate) spread: Angle<T>,
}

impl<T: Real> Cap<T> {
    pub(crate) fn single(direction: [T; 3]) -> Self {
        Self { axis: direction, spread: Angle::zero() }
    }

    pub(crate) fn everything() -> Self {
        Self { axis: [T::zero(); 3], spread: Angle::straight() }
    }

    /// The directions from the points of a sphere toward `target`, where `offset` is `target` − `center` and `square`
    /// its square, and the distance of `target` from the centre. All directions where `target` lies inside.
    pub(crate) fn toward(center: [T; 3], radius: T, target: [T; 3], offset: [T; 3], square: T) -> (Self, T) {
        let safe = square > T::min_positive_value() / T::epsilon() && square < T::max_value();
        let (axis, distance) = if safe {
            let distance = square.sqrt();
            (scale(offset, distance.recip()), distance)
        } else {
            // The squares left the number range.
            match toward(center, target) {
                (Some(axis), distance) => (axis, distance),
                (None, _) => return (Self::everything(), T::zero()),
            }
        };
        (Self { axis, spread: Angle::subtended(radius, distance) }, distance)
    }

    /// The v of the points of a sphere.
    pub(crate) fn toward_eye(center: [T; 3], radius: T, view: &Eye<T>) -> Self {
        match *view {
            Eye::Infinite(v) => Self::single(v),
            Eye::Local(eye) => {
                let offset = sub(eye, center);
                Self::toward(center, radius, eye, offset, dot(offset, offset)).0
            }
        }
    }

    /// The halfway vectors between the directions of two caps; `chord` is the chord of `other`'s spread.
    pub(crate) fn halfway(&self, other: &Self, chord: T) -> Self {
        let sum = add(self.axis, other.axis);
        let length = dot(sum, sum).sqrt();
        // The slack stands for the rounding of the sum, which opposite directions blow up.
        let moved = self.spread.chord() + chord + slack();
        let spread = Angle::subtended(moved, length);
        // Where the spread is π the length may be 0, and the axis is not used.
        Self { axis: scale(sum, length.max(slack()).recip()), spread }
    }
}
