//! The shape of a footprint.

use super::Number;

/// The ellipse a·x + b·y with x² + y² ≤ 1, in texels: M = a·aᵀ + b·bᵀ, whose eigenvalues are the squares of the
/// semiaxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct FootprintShape<T> {
    /// M, as (uu, uv, vv).
    pub(super) moments: [T; 3],
    /// The long semiaxis, σ₁.
    pub(super) long: T,
    /// The short semiaxis, σ₂.
    pub(super) short: T,
}

impl<T: Number> FootprintShape<T> {
    // ANCHOR: footprint
    /// From the derivatives of (u, v) along x and along y of the picture.
    pub(super) fn new(size: [u32; 2], footprint: [[T; 2]; 2]) -> Self {
        let [width, height] = size.map(|side| T::from_f64(side.into()));
        let [a, b] = footprint.map(|[u, v]| [u * width, v * height]);
        let [uu, uv, vv] = [(0, 0), (0, 1), (1, 1)].map(|(i, j)| a[i] * a[j] + b[i] * b[j]);
        let half = T::from_f64(0.5);
        let (middle, apart) = (half * (uu + vv), half * (uu - vv));
        let long = (middle + (apart * apart + uv * uv).sqrt()).sqrt();
        // det(a b) = σ₁σ₂, which loses less precision than the difference of the eigenvalues.
        let area = (a[0] * b[1] - a[1] * b[0]).abs();
        let short = if long > T::zero() { (area / long).min(long) } else { T::zero() };
        Self { moments: [uu, uv, vv], long, short }
    }
    // ANCHOR_END: footprint

    /// Whether it is finite and covers at most 10⁹ texels, unlike near a horizon. A footprint of that size can be
    /// squared in single precision.
    pub(super) fn is_bounded(&self) -> bool {
        self.moments[0] + self.moments[2] <= T::from_f64(1e18)
    }

    /// The direction of the long axis, of length 1.
    pub(super) fn direction(&self) -> [T; 2] {
        let [uu, uv, vv] = self.moments;
        let apart = T::from_f64(0.5) * (uu - vv);
        let radius = (apart * apart + uv * uv).sqrt();
        // An eigenvector of the larger eigenvalue, in that of its two forms that does not cancel.
        let [u, v] = if apart >= T::zero() { [apart + radius, uv] } else { [uv, radius - apart] };
        let length = (u * u + v * v).sqrt();
        if length > T::zero() { [u / length, v / length] } else { [T::one(), T::zero()] }
    }

    /// The sides along u and v of a rectangle with the variances of the footprint: √uu and √vv.
    ///
    /// The footprint is the parallelogram of a and b; a point that is evenly distributed over it has the covariance
    /// M/12, and one over a rectangle of these sides the variances uu/12 and vv/12.
    pub(super) fn sides(&self) -> [T; 2] {
        [self.moments[0].sqrt(), self.moments[2].sqrt()]
    }
}
