//! The elliptical weighted average.
//!
//! P. Heckbert, *Fundamentals of Texture Mapping and Image Warping*, 1989, §3.5: the footprint of a round pixel is an
//! ellipse, and its texels are weighted by a Gaussian of the distance r² from its middle, which is 1 at its edge. As in
//! the pyramids of Pharr et al., *Physically Based Rendering*, the weight is e^(−2r²) − e^(−2), which is continuous at
//! the edge.

use super::footprint::FootprintShape;
use super::{Number, finite, mixed, wrapped_index};
use crate::halves::Level;
use crate::pyramid::Pyramid;
use crate::sampling::Wrap;

/// The largest ratio of the semiaxes; beyond it the short one is lengthened.
const MOST_ECCENTRIC: f64 = 16.0;

/// The farthest texel of a level along an axis. Only an image much longer than wide, in levels that are one texel wide,
/// would need more.
const FARTHEST: f64 = 64.0;

/// The mean over the ellipse.
pub(super) fn mean<T: Number>(pyramid: &Pyramid, wrap: [Wrap; 2], uv: [T; 2], footprint: &FootprintShape<T>) -> [T; 4] {
    let short = footprint.short.max(footprint.long / T::from_f64(MOST_ECCENTRIC)).max(T::one());
    let last = pyramid.levels().len() - 1;
    let d = short.binary_logarithm().max(T::zero());
    let finer = d.floor().to_usize().unwrap_or(last);
    if finer >= last {
        return pyramid.level(last)[0].map(|number| T::from_f64(number.into()));
    }
    let part = d - d.floor();
    let of = |level: usize| in_level(pyramid, level, wrap, uv, footprint, short);
    let a = of(finer);
    if part == T::zero() { a } else { mixed(a, of(finer + 1), part) }
}

/// The texels of a level in the ellipse, whose short semiaxis is `short` texels of the image, and at least one of the
/// level.
fn in_level<T: Number>(
    pyramid: &Pyramid,
    level: usize,
    wrap: [Wrap; 2],
    uv: [T; 2],
    footprint: &FootprintShape<T>,
    short: T,
) -> [T; 4] {
    let Level { width, height, .. } = pyramid.levels()[level];
    let texels = pyramid.level(level);
    let [full_width, full_height] = pyramid.size().map(|side| T::from_f64(side.into()));
    let scale = [T::from_f64(width.into()) / full_width, T::from_f64(height.into()) / full_height];
    let Some(ellipse) = Ellipse::new(footprint, short, scale) else {
        return super::in_level(pyramid, level, wrap, crate::sampling::TexelFilter::Bilinear, uv);
    };
    let reach = ellipse.reach();
    let middle = [
        within(wrap[0], uv[0], T::from_f64(width.into()), reach[0]),
        within(wrap[1], uv[1], T::from_f64(height.into()), reach[1]),
    ];
    let half = T::from_f64(0.5);
    let whole = |x: T| x.to_i64().unwrap_or(0);
    let (low, high) = ((middle[1] - reach[1] - half).ceil(), (middle[1] + reach[1] - half).floor());
    let (mut sum, mut weights) = ([T::zero(); 4], T::zero());
    for row in whole(low)..=whole(high) {
        let y = T::from_f64(row as f64) + half - middle[1];
        let Some([left, right]) = ellipse.span(y) else { continue };
        let row = wrapped_index(wrap[1], row, height) * width as usize;
        let (low, high) = ((middle[0] + left - half).ceil(), (middle[0] + right - half).floor());
        for column in whole(low)..=whole(high) {
            let x = T::from_f64(column as f64) + half - middle[0];
            let weight = weight(ellipse.distance(x, y));
            weights = weights + weight;
            let texel = texels[row + wrapped_index(wrap[0], column, width)];
            for (sum, number) in sum.iter_mut().zip(texel) {
                *sum = *sum + weight * T::from_f64(number.into());
            }
        }
    }
    if weights > T::zero() {
        return sum.map(|sum| sum / weights);
    }
    super::in_level(pyramid, level, wrap, crate::sampling::TexelFilter::Bilinear, uv)
}

/// r² = a·x² + 2b·xy + c·y², with the determinant to find where it is 1.
struct Ellipse<T> {
    a: T,
    b: T,
    c: T,
    /// ac − b².
    determinant: T,
}

impl<T: Number> Ellipse<T> {
    /// In texels of a level; `None` if it is not finite.
    fn new(footprint: &FootprintShape<T>, short: T, scale: [T; 2]) -> Option<Self> {
        let [u, v] = footprint.direction();
        let [long, short] = [footprint.long.max(short), short];
        // M with the semiaxes as they are now: σ₂²·1 + (σ₁² − σ₂²)·d·dᵀ, scaled, and no thinner than a texel of the
        // level.
        let (round, more) = (short * short, (long - short) * (long + short));
        let [x, y] = scale;
        let [uu, uv, vv] = [(round + more * u * u) * x * x, more * u * v * x * y, (round + more * v * v) * y * y];
        let [less_u, less_v] = [uu, vv].map(|square| T::from_f64(FARTHEST) / square.sqrt().max(T::from_f64(FARTHEST)));
        let [uu, uv, vv] = widened([uu * less_u * less_u, uv * less_u * less_v, vv * less_v * less_v]);
        let determinant = uu * vv - uv * uv;
        let inverse = determinant.recip();
        let found = Self { a: vv * inverse, b: -uv * inverse, c: uu * inverse, determinant: inverse };
        (finite(inverse) > T::zero()).then_some(found)
    }

    /// Its extent along u and along v.
    fn reach(&self) -> [T; 2] {
        [(self.c / self.determinant).sqrt(), (self.a / self.determinant).sqrt()]
    }

    /// Its interval along u at a height over its middle.
    fn span(&self, y: T) -> Option<[T; 2]> {
        let root = self.a - self.determinant * y * y;
        if root < T::zero() {
            return None;
        }
        let root = root.sqrt();
        Some([(-self.b * y - root) / self.a, (-self.b * y + root) / self.a])
    }

    fn distance(&self, x: T, y: T) -> T {
        self.a * x * x + T::from_f64(2.0) * self.b * x * y + self.c * y * y
    }
}

/// Moments with both eigenvalues at least 1.
fn widened<T: Number>([uu, uv, vv]: [T; 3]) -> [T; 3] {
    let half = T::from_f64(0.5);
    let (middle, apart) = (half * (uu + vv), half * (uu - vv));
    let radius = (apart * apart + uv * uv).sqrt();
    let (large, small) = (middle + radius, middle - radius);
    if small >= T::one() {
        return [uu, uv, vv];
    }
    if large <= T::one() || radius <= T::zero() {
        return [T::one(), T::zero(), T::one()];
    }
    // M = small·1 + (large − small)·d·dᵀ.
    let share = (large - T::one()) / (large - small);
    [T::one() + (uu - small) * share, uv * share, T::one() + (vv - small) * share]
}

/// e^(−2r²) − e^(−2), but for a factor e: with x = 1 − 2r² it is e^x − e^(−1), e^x by Taylor's series up to x⁸, whose
/// error is 3·10⁻⁶ or less between −1 and 1.
fn weight<T: Number>(r2: T) -> T {
    const OVER_FACTORIALS: [f64; 9] =
        [1.0 / 40320.0, 1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];
    let x = T::one() - T::from_f64(2.0) * r2;
    let power = OVER_FACTORIALS.iter().fold(T::zero(), |sum, c| sum * x + T::from_f64(*c));
    (power - T::from_f64(std::f64::consts::E.recip())).max(T::zero())
}

/// A coordinate in texels, reduced to one period of the image, or clamped to within reach of it.
fn within<T: Number>(wrap: Wrap, u: T, side: T, reach: T) -> T {
    let two = T::from_f64(2.0);
    match wrap {
        Wrap::Repeat => (u - u.floor()) * side,
        Wrap::Mirror => (u - two * (u / two).floor()) * side,
        Wrap::Clamp => (u * side).max(-reach - two).min(side + reach + two),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_a_gaussian_to_the_series_error() {
        for step in 0..=1000 {
            let r2 = f64::from(step) / 1000.0;
            let exact = std::f64::consts::E * ((-2.0 * r2).exp() - (-2.0_f64).exp());
            assert!((weight(r2) - exact).abs() < 3.1e-6, "{r2}");
        }
    }
}
