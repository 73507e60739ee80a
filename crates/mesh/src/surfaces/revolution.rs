//! Surfaces of revolution about the Y axis.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::parameter::{turn, uv_at};
use super::{Disc, Parameter, ParametricSurface, Quadric, SurfaceError, SurfacePiece, SurfacePoint, check_lengths};

/// A point of the profile of a surface of revolution: at the distance r from the Y axis, at the height y.
struct Profile {
    /// (r, y).
    point: DVec2,
    /// Its derivative by u.
    slope: DVec2,
    /// Its outward unit normal: the slope (dr, dy) turned to (−dy, dr).
    normal: DVec2,
}

impl Profile {
    /// The point after a rotation by v of a turn about the Y axis, from +X toward +Z.
    fn revolved(self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (sin, cos) = turn(v);
        let about = |p: DVec2| DVec3::new(p.x * cos, p.y, p.x * sin);
        SurfacePoint {
            position: about(self.point),
            du: about(self.slope),
            dv: TAU * self.point.x * DVec3::new(-sin, 0.0, cos),
            normal: about(self.normal),
            uv: uv_at(u, v),
        }
    }

    /// The normal from the slope.
    fn new(point: DVec2, slope: DVec2) -> Self {
        Self { point, slope, normal: slope.perp().normalize() }
    }
}

/// The part of q·(x² + z²) + a·y² + b·y + c = 0 with x and z from −`radius` to `radius` and y from `low` to `high`; the
/// left side is negative inside.
fn quadric([q, a, b, c]: [f64; 4], radius: f64, [low, high]: [f64; 2]) -> SurfacePiece {
    let mut matrix = DMat4::from_diagonal(DVec4::new(q, a, q, c));
    matrix.y_axis.w = 0.5 * b;
    matrix.w_axis.y = 0.5 * b;
    let (min, max) = (DVec3::new(-radius, low, -radius), DVec3::new(radius, high, radius));
    SurfacePiece::Quadric(Quadric::within(matrix, min, max))
}

/// A circular cylinder about the Y axis: x² + z² = `radius`², |y| ≤ `height` / 2.
///
/// u runs down, v around from +X toward +Z.
///
/// ```
/// use halfway_mesh::{Cylinder, ParametricSurface, Tessellation};
///
/// let tin = Cylinder { radius: 1.0, height: 2.0, capped: true }.mesh(Tessellation::ChordError(0.001))?;
/// let report = tin.report();
/// assert_eq!(report.closed, 1);
/// assert!((report.volume - 2.0 * std::f64::consts::PI).abs() < 0.02);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// The radius, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis, 1e-30 … 1e30.
    pub height: f32,
    /// Whether discs close both ends.
    pub capped: bool,
}

impl ParametricSurface for Cylinder {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, height) = (f64::from(self.radius), f64::from(self.height));
        let point = DVec2::new(radius, height * u.before_middle());
        Profile { point, slope: DVec2::new(0.0, -height), normal: DVec2::X }.revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Cylinder", &[("radius", self.radius), ("height", self.height)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [1, 3]
    }

    fn caps(&self) -> Vec<Disc> {
        let (radius, half) = (f64::from(self.radius), 0.5 * f64::from(self.height));
        let ends = if self.capped { &[DVec3::Y, DVec3::NEG_Y][..] } else { &[] };
        ends.iter().map(|&n| Disc::at(half * n, n, radius)).collect()
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, half) = (f64::from(self.radius), 0.5 * f64::from(self.height));
        Some(vec![quadric([1.0, 0.0, 0.0, -radius * radius], radius, [-half, half])])
    }
}

/// A circular cone about the Y axis: its tip is at y = `height` / 2, its base at y = −`height` / 2.
///
/// u runs from the tip down, v around from +X toward +Z. At the tip each v has the normal of the line that it begins.
///
/// ```
/// use halfway_mesh::{Cone, ParametricSurface, Tessellation};
///
/// let open = Cone { radius: 1.0, height: 2.0, capped: false }.mesh(Tessellation::Count { rows: 1, columns: 32 })?;
/// assert_eq!((open.triangle_count(), open.report().problems.open_edges), (32, 32));
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The radius of the base, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis, 1e-30 … 1e30.
    pub height: f32,
    /// Whether a disc closes the base.
    pub capped: bool,
}

impl ParametricSurface for Cone {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, height) = (f64::from(self.radius), f64::from(self.height));
        let point = DVec2::new(radius * u.value(), height * u.before_middle());
        Profile::new(point, DVec2::new(radius, -height)).revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Cone", &[("radius", self.radius), ("height", self.height)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [1, 3]
    }

    fn caps(&self) -> Vec<Disc> {
        let (radius, half) = (f64::from(self.radius), 0.5 * f64::from(self.height));
        let base = Disc::at(-half * DVec3::Y, DVec3::NEG_Y, radius);
        self.capped.then_some(base).into_iter().collect()
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, height) = (f64::from(self.radius), f64::from(self.height));
        // x² + z² = (r/h)² (y − h/2)².
        let slope2 = (radius / height).powi(2);
        let coefficients = [1.0, -slope2, slope2 * height, -0.25 * radius * radius];
        Some(vec![quadric(coefficients, radius, [-0.5 * height, 0.5 * height])])
    }
}

/// A cylinder about the Y axis with hemispherical ends: the points at the distance `radius` from a line of `length`
/// along the axis, centred on the origin.
///
/// u runs from top to bottom in proportion to the arc length, v around from +X toward +Z.
///
/// ```
/// use halfway_mesh::{Capsule, ParametricSurface, Tessellation};
///
/// let pill = Capsule { radius: 0.5, length: 1.0 }.mesh(Tessellation::ChordError(0.01))?;
/// assert_eq!(pill.bounds().size().y, 2.0);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// The radius, 1e-30 … 1e30.
    pub radius: f32,
    /// The length of the line, 1e-30 … 1e30.
    pub length: f32,
}

impl ParametricSurface for Capsule {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, length) = (f64::from(self.radius), f64::from(self.length));
        let way = PI * radius + length;
        // From the nearer end, so that both ends are alike.
        let up = if u.before_middle() < 0.0 { -1.0 } else { 1.0 };
        let angle = u.value().min(u.complement()) * way / radius;
        let (point, normal) = if angle < FRAC_PI_2 {
            let (sin, cos) = angle.sin_cos();
            (DVec2::new(radius * sin, up * (0.5 * length + radius * cos)), DVec2::new(sin, up * cos))
        } else {
            (DVec2::new(radius, way * u.before_middle()), DVec2::X)
        };
        Profile { point, slope: -way * normal.perp(), normal }.revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Capsule", &[("radius", self.radius), ("length", self.length)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [3, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, half) = (f64::from(self.radius), 0.5 * f64::from(self.length));
        // x² + (y − c)² + z² = r².
        let ball = |c: f64, ends| quadric([1.0, 1.0, -2.0 * c, c * c - radius * radius], radius, ends);
        Some(vec![
            ball(half, [half, half + radius]),
            quadric([1.0, 0.0, 0.0, -radius * radius], radius, [-half, half]),
            ball(-half, [-half - radius, -half]),
        ])
    }
}

/// A ring about the Y axis: a tube around a circle in the plane y = 0.
///
/// u runs around the tube from its inside up, v around the ring from +X toward +Z. Being of fourth degree, it has no
/// exact [`Surface`](super::Surface).
///
/// ```
/// use halfway_mesh::{ParametricSurface, Tessellation, Torus};
///
/// let ring = Torus { radius: 2.0, tube: 0.5 }.mesh(Tessellation::Count { rows: 16, columns: 32 })?;
/// assert_eq!((ring.triangle_count(), ring.report().problems.open_edges), (1024, 0));
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// The radius of the circle, 1e-30 … 1e30.
    pub radius: f32,
    /// The radius of the tube, less than that of the circle, 1e-30 … 1e30.
    pub tube: f32,
}

impl ParametricSurface for Torus {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, tube) = (f64::from(self.radius), f64::from(self.tube));
        let (sin, cos) = turn(u);
        let normal = DVec2::new(-cos, sin);
        let point = DVec2::new(radius, 0.0) + tube * normal;
        Profile { point, slope: TAU * tube * DVec2::new(sin, cos), normal }.revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Torus", &[("radius", self.radius), ("tube", self.tube)])?;
        if self.tube < self.radius {
            return Ok(());
        }
        Err(SurfaceError {
            surface: "Torus",
            field: "tube",
            value: f64::from(self.tube),
            expected: format!("less than the radius, {}, is expected", self.radius),
        })
    }

    fn least_counts(&self) -> [u32; 2] {
        [3, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        None
    }
}

/// A circular paraboloid about the Y axis, open below: its top is at y = `height` / 2, its rim at y = −`height` / 2.
///
/// u runs from the top in proportion to the distance from the axis, v around from +X toward +Z.
///
/// ```
/// use halfway_mesh::{Paraboloid, ParametricSurface, Tessellation};
///
/// let dome = Paraboloid { radius: 2.0, height: 1.0 }.mesh(Tessellation::ChordError(0.01))?;
/// assert_eq!(dome.bounds().max.y, 0.5);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid {
    /// The radius of the rim, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis, 1e-30 … 1e30.
    pub height: f32,
}

impl ParametricSurface for Paraboloid {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, height, t) = (f64::from(self.radius), f64::from(self.height), u.value());
        let point = DVec2::new(radius * t, height * (0.5 - t * t));
        Profile::new(point, DVec2::new(radius, -2.0 * height * t)).revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Paraboloid", &[("radius", self.radius), ("height", self.height)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [1, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, height) = (f64::from(self.radius), f64::from(self.height));
        // (x² + z²)/r² + y/h − 1/2 = 0.
        let across = (radius * radius).recip();
        Some(vec![quadric([across, 0.0, height.recip(), -0.5], radius, [-0.5 * height, 0.5 * height])])
    }
}

/// A circular hyperboloid of one sheet about the Y axis, open at both ends: (x² + z²)/`waist`² − y²/c² = 1, |y| ≤
/// `height` / 2, c such that the rims have the `radius`.
///
/// u runs down, v around from +X toward +Z.
///
/// ```
/// use halfway_mesh::{Hyperboloid, ParametricSurface, Tessellation};
///
/// let tower = Hyperboloid { waist: 0.5, radius: 1.0, height: 3.0 };
/// assert!(tower.mesh(Tessellation::ChordError(0.01))?.surface().is_some());
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hyperboloid {
    /// The radius at y = 0, 1e-30 … 1e30.
    pub waist: f32,
    /// The radius of the rims, greater than the waist, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis, 1e-30 … 1e30.
    pub height: f32,
}

impl Hyperboloid {
    /// c².
    fn c2(self) -> f64 {
        let (half, ratio) = (0.5 * f64::from(self.height), f64::from(self.radius) / f64::from(self.waist));
        half * half / (ratio * ratio - 1.0)
    }
}

impl ParametricSurface for Hyperboloid {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (waist, height, c2) = (f64::from(self.waist), f64::from(self.height), self.c2());
        let y = height * u.before_middle();
        let r = waist * (1.0 + y * y / c2).sqrt();
        let dr_by_dy = waist * waist * y / (c2 * r);
        Profile::new(DVec2::new(r, y), -height * DVec2::new(dr_by_dy, 1.0)).revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Hyperboloid", &[("waist", self.waist), ("radius", self.radius), ("height", self.height)])?;
        if self.waist < self.radius {
            return Ok(());
        }
        Err(SurfaceError {
            surface: "Hyperboloid",
            field: "radius",
            value: f64::from(self.radius),
            expected: format!("more than the waist, {}, is expected", self.waist),
        })
    }

    fn least_counts(&self) -> [u32; 2] {
        [2, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (waist, radius, half) = (f64::from(self.waist), f64::from(self.radius), 0.5 * f64::from(self.height));
        let across = (waist * waist).recip();
        Some(vec![quadric([across, -self.c2().recip(), 0.0, -1.0], radius, [-half, half])])
    }
}

/// One of the two sheets of a circular hyperboloid about the Y axis: y²/a² − (x² + z²)/b² = 1, a half the `gap`, b such
/// that the rim has the `radius`.
///
/// Its outward side is the one toward the other sheet. u runs from the tip to the rim in proportion to the distance
/// from the axis; v around from +X, toward +Z on the lower sheet and toward −Z on the upper one.
///
/// ```
/// use halfway_mesh::{HyperboloidSheet, Tessellation, tessellate};
///
/// let sheet = |upper| HyperboloidSheet { gap: 1.0, radius: 1.0, height: 1.0, upper };
/// let both = tessellate(&[&sheet(false), &sheet(true)], Tessellation::ChordError(0.01))?;
/// assert_eq!(both.report().pieces, 2);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HyperboloidSheet {
    /// The distance between the tips of both sheets, 1e-30 … 1e30.
    pub gap: f32,
    /// The radius of the rim, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis from the tip to the rim, 1e-30 … 1e30.
    pub height: f32,
    /// Whether it is the sheet with positive y, which opens upward.
    pub upper: bool,
}

impl HyperboloidSheet {
    /// a and (radius/b)².
    fn shape(self) -> (f64, f64) {
        let a = 0.5 * f64::from(self.gap);
        let height = f64::from(self.height) / a;
        (a, height * (2.0 + height))
    }
}

impl ParametricSurface for HyperboloidSheet {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, t, (a, steepness)) = (f64::from(self.radius), u.value(), self.shape());
        let y = a * (1.0 + steepness * t * t).sqrt();
        let dy = a * a * steepness * t / y;
        let lower = Profile::new(DVec2::new(radius * t, -y), DVec2::new(radius, -dy)).revolved(u, v);
        if !self.upper {
            return lower;
        }
        // Half a turn about the X axis, so that inside stays inside.
        let turned = |p: DVec3| DVec3::new(p.x, -p.y, -p.z);
        SurfacePoint {
            position: turned(lower.position),
            du: turned(lower.du),
            dv: turned(lower.dv),
            normal: turned(lower.normal),
            uv: lower.uv,
        }
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("HyperboloidSheet", &[("gap", self.gap), ("radius", self.radius), ("height", self.height)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [1, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, height, (a, steepness)) = (f64::from(self.radius), f64::from(self.height), self.shape());
        let across = steepness / (radius * radius);
        let ends = if self.upper { [a, a + height] } else { [-a - height, -a] };
        Some(vec![quadric([across, -(a * a).recip(), 0.0, 1.0], radius, ends)])
    }
}
