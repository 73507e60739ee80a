//! The only module that calls functions whose results the standard library leaves to each platform.
//!
//! `+`, `−`, `·`, `/`, the square root and the fused product are rounded to the nearest number everywhere (IEEE 754).
//! Powers and the functions of angles are not: their last bits differ between systems. Here they are `libm`'s, whose
//! code is the same on all of them, so that what the equations say is the same to the bit wherever they run.

/// Powers and the functions of angles, equal to the bit on every machine. Angles are in radians.
pub trait Transcendental: Sized {
    /// `self` to the power of `exponent`.
    #[must_use]
    fn pow(self, exponent: Self) -> Self;
    /// The sine of an angle.
    #[must_use]
    fn sine(self) -> Self;
    /// The cosine of an angle.
    #[must_use]
    fn cosine(self) -> Self;
    /// The tangent of an angle.
    #[must_use]
    fn tangent(self) -> Self;
    /// The angle from −π/2 to π/2 that has this tangent.
    #[must_use]
    fn arc_tangent(self) -> Self;
    /// `√(self² + other²)`; the squares neither overflow nor underflow.
    #[must_use]
    fn hypotenuse(self, other: Self) -> Self;
}

impl Transcendental for f32 {
    fn pow(self, exponent: Self) -> Self {
        libm::powf(self, exponent)
    }

    fn sine(self) -> Self {
        libm::sinf(self)
    }

    fn cosine(self) -> Self {
        libm::cosf(self)
    }

    fn tangent(self) -> Self {
        libm::tanf(self)
    }

    fn arc_tangent(self) -> Self {
        libm::atanf(self)
    }

    fn hypotenuse(self, other: Self) -> Self {
        libm::hypotf(self, other)
    }
}

impl Transcendental for f64 {
    fn pow(self, exponent: Self) -> Self {
        libm::pow(self, exponent)
    }

    fn sine(self) -> Self {
        libm::sin(self)
    }

    fn cosine(self) -> Self {
        libm::cos(self)
    }

    fn tangent(self) -> Self {
        libm::tan(self)
    }

    fn arc_tangent(self) -> Self {
        libm::atan(self)
    }

    fn hypotenuse(self, other: Self) -> Self {
        libm::hypot(self, other)
    }
}
