//! The colours that lights with a direction share, and what they make of them where they arrive.

use crate::LinearRgba;

use crate::Reflectance;
use crate::equations::vector::{dot, scale};
use crate::equations::{
    Coefficients, Eye, Incidence, Irradiance, Real, ShadedPoint, diffuse_term, rgb, specular_term, view_vector,
};
use crate::falloff::number;

/// The meaning of each field of a light, for its documentation and for the schema of scene files.
macro_rules! meaning {
    (ambient) => {
        "La, linear RGB: added wherever the surface faces."
    };
    (diffuse) => {
        "Ld, linear RGB: received by the diffuse term."
    };
    (specular) => {
        "Ls, linear RGB: received by the specular term."
    };
    (attenuation) => {
        "[a, b, c] of 1/(a + b·d + c·d²), d the distance. One of them above 0."
    };
    (range) => {
        "Where the light ends: multiplies by clamp(1 − (d/range)⁴, 0, 1)². null: it does not end."
    };
    (attenuate_ambient) => {
        "Whether distance and cone weaken the ambient color too, as in OpenGL."
    };
}
pub(super) use meaning;

/// The colours of a light that shines along l, linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colors<T> {
    /// La, ambient.
    pub la: [T; 3],
    /// Ld, diffuse.
    pub ld: [T; 3],
    /// Ls, specular.
    pub ls: [T; 3],
}

impl<T: Real> Colors<T> {
    pub(super) fn new(ambient: LinearRgba, diffuse: LinearRgba, specular: LinearRgba) -> Self {
        Self { la: rgb(ambient), ld: rgb(diffuse), ls: rgb(specular) }
    }

    pub(super) fn cast<U: Real>(&self) -> Colors<U> {
        Colors { la: self.la.map(number), ld: self.ld.map(number), ls: self.ls.map(number) }
    }

    // ANCHOR: arriving
    /// The light that arrives at a point from this incidence, `ambient` times the ambient colour.
    pub(super) fn arriving(
        &self,
        incident: &Incidence<T>,
        ambient: T,
        (surface, view): (&ShadedPoint<T>, &Eye<T>),
        (reflectance, material): (Reflectance, &Coefficients<T>),
    ) -> Irradiance<T> {
        let n = surface.normal;
        let v = view_vector(surface, view);
        let Incidence { l, grazing, weight } = *incident;
        let weight = if dot(n, l) > grazing { weight } else { T::zero() };
        Irradiance {
            ambient: scale(self.la, ambient),
            diffuse: scale(self.ld, weight * diffuse_term(n, l)),
            specular: scale(self.ls, weight * specular_term(reflectance, n, l, v, material)),
        }
    }
    // ANCHOR_END: arriving
}

impl Colors<f64> {
    pub(super) fn has_highlights(&self) -> bool {
        is_bright(self.ls)
    }

    #[expect(clippy::float_cmp, reason = "a shared color is a copy")]
    pub(super) fn are_shared(&self) -> bool {
        self.ls == self.ld
    }
}

/// Whether any channel is above 0.
pub(super) fn is_bright(color: [f64; 3]) -> bool {
    color.iter().any(|&channel| channel > 0.0)
}
