//! Bézier patches of any degree, and polynomial ones.

use glam::DVec3;

use super::{Parameter, SurfaceError, check_coordinates};

/// A Bézier patch: rows of control points; u runs from row to row, v along a row, both from 0 to 1.
///
/// The surface is Σᵢ Σⱼ Bᵢ(u) Bⱼ(v) pᵢⱼ with Bernstein's polynomials of degree one less than there are rows and
/// columns. Its outward side is that of ∂p/∂v × ∂p/∂u: seen from there with the rows running right, the first row is on
/// top.
///
/// ```
/// use glam::DVec3;
/// use halfway_mesh::{BezierPatch, ParametricSurface, Tessellation};
///
/// // Two rows of three points: a sheet that is bent upward in the middle.
/// let rows = [0.0, 1.0].map(|z| [1.0, 0.5, 0.0].map(|x| DVec3::new(x, if x == 0.5 { 1.0 } else { 0.0 }, z)));
/// let patch = BezierPatch::new(3, rows.concat())?;
/// assert_eq!(patch.position(0.5.into(), 0.5.into()), DVec3::new(0.5, 0.5, 0.5));
/// let mesh = patch.mesh(Tessellation::Count { rows: 1, columns: 16 })?;
/// assert_eq!(mesh.triangle_count(), 32);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct BezierPatch {
    columns: usize,
    points: Vec<DVec3>,
}

/// One weight for each row, or each column; those beyond the last are not used.
type BasisValues = [f64; BezierPatch::MAX_DEGREE + 1];

/// Below this fraction of the largest product of tangents, their cross product counts as 0. The coordinates of a patch
/// are rounded to 2⁻⁵³, a hundred of which are allowed for.
const VANISHED: f64 = 1e-14;

impl BezierPatch {
    /// The highest degree. Far beyond it, Bernstein's polynomials can no longer be told from 0 in the middle.
    pub const MAX_DEGREE: usize = 32;

    /// A patch of control points that lie row by row, `columns` in each.
    ///
    /// # Errors
    /// Fewer than two or more than [`MAX_DEGREE`](Self::MAX_DEGREE) + 1 columns or rows, a row that is not full, or a
    /// coordinate that is not from −1e30 to 1e30.
    pub fn new(columns: usize, points: Vec<DVec3>) -> Result<Self, SurfaceError> {
        let counts = 2..=Self::MAX_DEGREE + 1;
        let error = |field, value, expected: String| SurfaceError { surface: "BezierPatch", field, value, expected };
        if !counts.contains(&columns) {
            let expected = format!("a number from 2 to {} is expected", counts.end());
            return Err(error("columns", columns as f64, expected));
        }
        if !points.len().is_multiple_of(columns) || !counts.contains(&(points.len() / columns)) {
            let expected = format!("2 to {} full rows of {columns} points are expected", counts.end());
            return Err(error("points", points.len() as f64, expected));
        }
        check_coordinates("BezierPatch", "points", points.iter().copied())?;
        Ok(Self { columns, points })
    }

    /// The patch p(u, v) = Σᵢ Σⱼ cᵢⱼ uⁱ vʲ, of coefficients that lie row by row, `columns` in each: i counts rows, j
    /// columns.
    ///
    /// Of a monomial xⁱ the control values of degree n are C(k, i) / C(n, i), k = 0 … n.
    ///
    /// # Errors
    /// As [`new`](Self::new), with coefficients for points.
    pub fn from_polynomial(columns: usize, coefficients: Vec<DVec3>) -> Result<Self, SurfaceError> {
        let mut patch = Self::new(columns, coefficients)?;
        for row in patch.points.chunks_mut(columns) {
            let controls = controls_of(row);
            row.copy_from_slice(&controls);
        }
        for column in 0..columns {
            let down: Vec<DVec3> = patch.points.iter().skip(column).step_by(columns).copied().collect();
            for (row, control) in controls_of(&down).into_iter().enumerate() {
                patch.points[row * columns + column] = control;
            }
        }
        Self::new(columns, patch.points)
    }

    /// The control points, row by row.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// How many rows of control points there are: one more than the degree in u.
    pub fn rows(&self) -> usize {
        self.points.len() / self.columns
    }

    /// How many control points a row has: one more than the degree in v.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The patch with its control points moved. For an affine map it is this patch, moved.
    #[must_use]
    pub fn mapped(&self, to_from: impl Fn(DVec3) -> DVec3) -> Self {
        Self { columns: self.columns, points: self.points.iter().map(|&p| to_from(p)).collect() }
    }

    /// p(u, v).
    pub fn position(&self, u: Parameter, v: Parameter) -> DVec3 {
        self.blend(&bernstein(self.rows() - 1, u), &bernstein(self.columns - 1, v))
    }

    /// p(u, v), ∂p/∂u and ∂p/∂v.
    pub fn jet(&self, u: Parameter, v: Parameter) -> [DVec3; 3] {
        let (m, n) = (self.rows() - 1, self.columns - 1);
        let (at_u, at_v) = (bernstein(m, u), bernstein(n, v));
        [self.blend(&at_u, &at_v), self.blend(&slopes(m, u), &at_v), self.blend(&at_u, &slopes(n, v))]
    }

    /// The outward unit normal, that of ∂p/∂v × ∂p/∂u; `None` where it has no direction even in the limit.
    ///
    /// Where the cross product vanishes, as at the end of a patch whose row has shrunk to a point, the direction is
    /// the limit from inside the patch: that of the cross product's derivative along the inward u, else the inward v.
    pub fn normal(&self, u: Parameter, v: Parameter) -> Option<DVec3> {
        let (m, n) = (self.rows() - 1, self.columns - 1);
        let (at_u, at_v, slope_u, slope_v) = (bernstein(m, u), bernstein(n, v), slopes(m, u), slopes(n, v));
        let pu = self.blend(&slope_u, &at_v);
        let pv = self.blend(&at_u, &slope_v);
        let puv = self.blend(&slope_u, &slope_v);
        let puu = self.blend(&curvatures(m, u), &at_v);
        let pvv = self.blend(&at_u, &curvatures(n, v));
        let largest = [pu, pv, puv, puu, pvv].iter().fold(0.0_f64, |most, tangent| most.max(tangent.length_squared()));
        [pv.cross(pu), u.inward() * (puv.cross(pu) + pv.cross(puu)), v.inward() * (pvv.cross(pu) + pv.cross(puv))]
            .into_iter()
            .find(|n| n.length() > VANISHED * largest)
            .map(DVec3::normalize)
    }

    /// The sum of the control points, each weighted by its row's and its column's weight.
    fn blend(&self, rows: &BasisValues, columns: &BasisValues) -> DVec3 {
        let row = |i: usize| &self.points[i * self.columns..][..self.columns];
        let along = |i: usize| mirrored_sum(self.columns, |j| columns[j] * row(i)[j]);
        mirrored_sum(self.rows(), |i| rows[i] * along(i))
    }
}

/// The sum of `count` terms, two or more, in an order that does not change when they are reversed: from both ends to
/// the middle.
fn mirrored_sum(count: usize, term: impl Fn(usize) -> DVec3) -> DVec3 {
    let pair = |i: usize| term(i) + term(count - 1 - i);
    let sum = (1..count / 2).fold(pair(0), |sum, i| sum + pair(i));
    if count.is_multiple_of(2) { sum } else { sum + term(count / 2) }
}

/// The Bernstein polynomials of degree n: C(n, i) sⁿ⁻ⁱ tⁱ. Reversed to the bit where t and s are exchanged.
fn bernstein(n: usize, at: Parameter) -> BasisValues {
    let power = |x: f64| {
        let mut powers = [1.0; BezierPatch::MAX_DEGREE + 1];
        for i in 1..=n {
            powers[i] = powers[i - 1] * x;
        }
        powers
    };
    let (s, t) = (power(at.complement()), power(at.value()));
    let mut weights = [0.0; BezierPatch::MAX_DEGREE + 1];
    let mut choose = 1.0;
    for i in 0..=n / 2 {
        // The middle one of an even degree is its own mirror image.
        weights[i] = if 2 * i == n { choose * (s[i] * t[i]) } else { choose * s[n - i] * t[i] };
        weights[n - i] = if 2 * i == n { weights[i] } else { choose * t[n - i] * s[i] };
        choose = choose * (n - i) as f64 / (i + 1) as f64;
    }
    weights
}

/// Their derivatives: n (Bᵢ₋₁ − Bᵢ) of degree n − 1.
fn slopes(n: usize, at: Parameter) -> BasisValues {
    let lower = bernstein(n - 1, at);
    let degree = n as f64;
    let mut weights = [0.0; BezierPatch::MAX_DEGREE + 1];
    let lower_at = |i: usize| if (1..=n).contains(&i) { lower[i - 1] } else { 0.0 };
    for (i, weight) in weights.iter_mut().enumerate() {
        *weight = degree * (lower_at(i) - lower_at(i + 1));
    }
    weights
}

/// Their second derivatives: n (n − 1) (Bᵢ₋₂ − 2 Bᵢ₋₁ + Bᵢ) of degree n − 2.
fn curvatures(n: usize, at: Parameter) -> BasisValues {
    let mut weights = [0.0; BezierPatch::MAX_DEGREE + 1];
    if n < 2 {
        return weights;
    }
    let lower = bernstein(n - 2, at);
    let factor = (n * (n - 1)) as f64;
    let lower_at = |i: usize| if (2..=n).contains(&i) { lower[i - 2] } else { 0.0 };
    for (i, weight) in weights.iter_mut().enumerate() {
        *weight = factor * ((lower_at(i) + lower_at(i + 2)) - 2.0 * lower_at(i + 1));
    }
    weights
}

/// The control points of the curve Σ cᵢ xⁱ.
fn controls_of(coefficients: &[DVec3]) -> Vec<DVec3> {
    let degree = coefficients.len() - 1;
    let control = |k: usize| {
        // C(k, i) / C(n, i) from its predecessor; 0 from i = k + 1 on.
        let mut share = 1.0;
        coefficients
            .iter()
            .enumerate()
            .map(|(i, &c)| {
                let term = share * c;
                share *= k.saturating_sub(i) as f64 / (degree - i).max(1) as f64;
                term
            })
            .sum()
    };
    (0..=degree).map(control).collect()
}
