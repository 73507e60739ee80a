//! Three ways to interpolate values at the corners of a polygon to a point within it, on the picture.
//!
//! The oracle and the renderer interpolate perspective-correctly. The others are the methods that were published first,
//! and that graphics hardware once used; they are here for comparison.

/// How values at corners are interpolated across a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// Linear on the surface in space: value/w and 1/w are linear on the picture, w the distance along the view (Blinn,
    /// "Hyperbolic Interpolation", 1992). Of a polygon, in the triangles of the fan about its first corner.
    Perspective,
    /// Linear on the picture, in the same triangles.
    Screen,
    /// Linear in y along the edges, then linear in x along the line between them (Gouraud 1971 for intensities, Phong
    /// 1975 for normals). The same as [`Screen`](Self::Screen) on triangles; on other polygons it depends on how they
    /// are turned.
    ScanLine,
}

/// A corner of a convex polygon on the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonCorner<const N: usize> {
    /// Its position on the picture, x then y.
    pub at: [f64; 2],
    /// Its distance along the view, above 0.
    pub w: f64,
    /// The values to interpolate.
    pub value: [f64; N],
}

impl Interpolation {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Perspective, Self::Screen, Self::ScanLine];

    /// The method's name for charts.
    pub fn name(self) -> &'static str {
        match self {
            Self::Perspective => "perspective-correct",
            Self::Screen => "linear on the picture",
            Self::ScanLine => "along edges, then along the line",
        }
    }

    // ANCHOR: at
    /// The value at a point of the picture; `None` outside of the polygon, which is convex, its corners in order round
    /// it.
    pub fn at<const N: usize>(self, corners: &[PolygonCorner<N>], point: [f64; 2]) -> Option<[f64; N]> {
        if self == Self::ScanLine {
            return scan_line(corners, point);
        }
        let [first, rest @ ..] = corners else { return None };
        rest.windows(2).find_map(|pair| {
            let triangle = [*first, pair[0], pair[1]];
            let weights = weights(triangle.map(|corner| corner.at), point)?;
            let weights = match self {
                Self::Perspective => {
                    let by_w = [0, 1, 2].map(|i| weights[i] / triangle[i].w);
                    let sum: f64 = by_w.iter().sum();
                    by_w.map(|weight| weight / sum)
                }
                _ => weights,
            };
            Some(std::array::from_fn(|k| (0..3).map(|i| weights[i] * triangle[i].value[k]).sum()))
        })
    }
    // ANCHOR_END: at
}

/// The barycentric coordinates of a point; `None` outside, and for a triangle without area.
fn weights([a, b, c]: [[f64; 2]; 3], point: [f64; 2]) -> Option<[f64; 3]> {
    let area = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let whole = area(a, b, c);
    let weights = [area(point, b, c), area(a, point, c), area(a, b, point)].map(|part| part / whole);
    // A hair of tolerance, so that no point on an edge between two triangles is in neither.
    (whole != 0.0 && weights.iter().all(|weight| *weight >= -1e-12)).then_some(weights)
}

fn scan_line<const N: usize>(corners: &[PolygonCorner<N>], [x, y]: [f64; 2]) -> Option<[f64; N]> {
    let mix = |a: [f64; N], b: [f64; N], t: f64| std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t);
    // Where the line meets edges: x, and the value there.
    let mut met: Vec<(f64, [f64; N])> = Vec::new();
    for (i, a) in corners.iter().enumerate() {
        let b = &corners[(i + 1) % corners.len()];
        let (low, high) = (a.at[1].min(b.at[1]), a.at[1].max(b.at[1]));
        if (low..=high).contains(&y) && low < high {
            let t = (y - a.at[1]) / (b.at[1] - a.at[1]);
            met.push((a.at[0] + (b.at[0] - a.at[0]) * t, mix(a.value, b.value, t)));
        }
    }
    let left = met.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let right = met.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    if x < left.0 - 1e-12 || x > right.0 + 1e-12 {
        return None;
    }
    let width = right.0 - left.0;
    Some(mix(left.1, right.1, if width > 0.0 { (x - left.0) / width } else { 0.0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f64, y: f64, w: f64, value: f64) -> PolygonCorner<1> {
        PolygonCorner { at: [x, y], w, value: [value] }
    }

    #[test]
    fn on_triangles_the_published_form_is_linear_on_the_picture() {
        // Triangles that turn, and points within them.
        for turn in 0..60 {
            let at = |i: f64| (0.1 * f64::from(turn) + i * std::f64::consts::TAU / 3.0).sin_cos();
            let corners = [0.0, 1.0, 2.0].map(|i| corner(3.0 * at(i).1, 2.0 * at(i).0, 1.0 + i, i * i));
            for point in [[0.0, 0.0], [0.3, -0.2], [-0.5, 0.1]] {
                let [screen, scan] =
                    [Interpolation::Screen, Interpolation::ScanLine].map(|how| how.at(&corners, point));
                let ([screen], [scan]) = (screen.unwrap(), scan.unwrap());
                assert!((screen - scan).abs() < 1e-12, "{turn}: {screen}, {scan}");
            }
        }
    }

    #[test]
    fn perspective_counts_where_depths_differ() {
        let line = |far: f64| [corner(0.0, 0.0, 1.0, 0.0), corner(1.0, 0.0, far, 1.0), corner(0.0, 1.0, 1.0, 0.0)];
        let at = |how: Interpolation, far: f64| how.at(&line(far), [0.5, 0.0]).unwrap()[0];
        assert!((at(Interpolation::Perspective, 1.0) - 0.5).abs() < 1e-15);
        // Halfway on the picture is (1/w₁)/(1/w₀ + 1/w₁) of the way in space: 1/(1 + 9).
        assert!((at(Interpolation::Perspective, 9.0) - 0.1).abs() < 1e-15);
        assert!((at(Interpolation::Screen, 9.0) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn outside_there_is_nothing() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| corner(x, y, 1.0, x));
        for how in Interpolation::ALL {
            assert!(how.at(&square, [0.5, 0.5]).is_some() && how.at(&square, [0.25, 0.75]).is_some(), "{how:?}");
            for outside in [[1.5, 0.5], [-0.1, 0.5], [0.5, 1.1], [0.5, -0.1]] {
                assert_eq!(how.at(&square, outside), None, "{how:?} {outside:?}");
            }
            assert_eq!(how.at::<1>(&[], [0.0, 0.0]), None);
        }
    }

    #[test]
    fn the_published_form_changes_as_a_square_turns() {
        // Bright, dark, bright, dark: at the middle the fan has the mean of two bright corners, or of two dark ones.
        let middle = |how: Interpolation, angle: f64| {
            let square = [0, 1, 2, 3].map(|i| {
                let (y, x) = (angle + f64::from(i) * std::f64::consts::FRAC_PI_2).sin_cos();
                corner(x, y, 1.0, f64::from((i + 1) % 2))
            });
            how.at(&square, [0.0, 0.0]).unwrap()[0]
        };
        let angles = || (0..=90).map(|degrees: i32| f64::from(degrees).to_radians());
        for how in [Interpolation::Perspective, Interpolation::Screen] {
            assert!(angles().all(|angle| (middle(how, angle) - 1.0).abs() < 1e-9), "{how:?}");
        }
        let values: Vec<f64> = angles().map(|angle| middle(Interpolation::ScanLine, angle)).collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(0.0, f64::max);
        // From the mean of bright corners, on one line with the middle, to that of dark ones.
        assert!(least < 0.05 && most > 0.95, "{least} … {most}");
    }
}
