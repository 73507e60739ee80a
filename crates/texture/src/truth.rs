//! Ground truth for the filters: the mean of an image over a pixel's footprint, integrated.
//!
//! Texels are squares of constant value, as the area means of a [`Pyramid`] take them. A pixel is a square of the
//! picture with uniform weight. Straight lines of the picture are straight on the image, so that the footprint is
//! exactly a quadrilateral; the projection changes the fraction of the pixel that each texel fills.

use crate::pyramid::Pyramid;
use crate::sampling::Wrap;
use crate::sums::inside;

/// A projective map from points of a picture, in pixels, to (u, v): with (p, q, w) = R·(x, y, 1), u = p/w and v = q/w.
///
/// ```
/// use halfway_texture::PictureMap;
///
/// // A floor: the horizon is at y = 0, and v grows toward it.
/// let floor = PictureMap { rows: [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]] };
/// assert_eq!((floor.at([2.0, 4.0]), floor.at([2.0, -1.0])), (Some([0.5, 0.25]), None));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureMap {
    /// The rows of R. Points with w > 0 are in front of the viewer; the others map to nothing.
    pub rows: [[f64; 3]; 3],
}

impl PictureMap {
    /// (p, q, w) at a point.
    fn homogeneous(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        self.rows.map(|[a, b, c]| a * x + b * y + c)
    }

    /// (u, v) at a point; `None` where w ≤ 0.
    pub fn at(&self, place: [f64; 2]) -> Option<[f64; 2]> {
        let [p, q, w] = self.homogeneous(place);
        (w > 0.0).then(|| [p / w, q / w])
    }

    /// The derivatives of (u, v) along x and along y of the picture, as the filters take them.
    pub fn footprint(&self, place: [f64; 2]) -> [[f64; 2]; 2] {
        let [p, q, w] = self.homogeneous(place);
        [0, 1].map(|axis| {
            let [p_grows, q_grows, w_grows] = [0, 1, 2].map(|row| self.rows[row][axis]);
            [(p_grows - p / w * w_grows) / w, (q_grows - q / w * w_grows) / w]
        })
    }
}

/// An image prepared for integration: 32 bytes a texel.
///
/// ```
/// use halfway_texture::{FootprintTruth, PictureMap, Pyramid, TexelImage, Wrap};
///
/// let checker = Pyramid::new(TexelImage::from_fn(2, 2, |x, y| [((x + y) % 2) as f32; 4])?);
/// let truth = FootprintTruth::new(&checker);
/// // A pixel as large as the image.
/// let whole = PictureMap { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
/// let [gray, ..] = truth.mean([Wrap::Repeat; 2], &whole, [0.3, 0.2], 1e-9).expect("in front of the viewer");
/// assert!((gray - 0.5).abs() < 1e-9);
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FootprintTruth {
    size: [usize; 2],
    mean: [f64; 4],
    /// For each row, at each of its width + 1 corners, the sum of the texels to the left, minus that many times the
    /// mean.
    sums: Vec<[f64; 4]>,
}

/// The most times that a cell of a pixel is halved.
const DEEPEST: u32 = 24;

impl FootprintTruth {
    /// From the first level of a pyramid.
    pub fn new(pyramid: &Pyramid) -> Self {
        let size = pyramid.size().map(|side| side as usize);
        let texels = pyramid.level(0);
        let mut mean = [0.0; 4];
        for texel in texels {
            (0..4).for_each(|k| mean[k] += f64::from(texel[k]));
        }
        let mean = mean.map(|sum| sum / texels.len() as f64);
        let mut sums = Vec::with_capacity((size[0] + 1) * size[1]);
        for row in texels.chunks_exact(size[0]) {
            let mut sum = [0.0; 4];
            sums.push(sum);
            for texel in row {
                (0..4).for_each(|k| sum[k] += f64::from(texel[k]) - mean[k]);
                sums.push(sum);
            }
        }
        Self { size, mean, sums }
    }

    /// The mean over the footprint of the pixel whose middle is `pixel`; `None` if a part of it lies behind the viewer.
    ///
    /// A cell of the pixel, at first the whole of it, has the mean over its quadrilateral, by Green's theorem exact to
    /// rounding except that its texels have uniform weight. It is halved across the direction along which w changes
    /// more. Where the mean of the halves differs from the cell's by more than `tolerance` in any channel, each is
    /// halved again, up to 24 times. Under affine maps the first is exact. To exclude accidental agreement, texels of a
    /// cell that is not halved again differ in size by a tenth at most, and its quarters agree with it, too. The result
    /// may be off by hundreds of times `tolerance`.
    pub fn mean(&self, wrap: [Wrap; 2], map: &PictureMap, pixel: [f64; 2], tolerance: f64) -> Option<[f64; 4]> {
        let [x, y] = pixel;
        let cell = Cell { low: [x - 0.5, y - 0.5], sides: [1.0; 2] };
        if cell.corners().iter().any(|corner| map.at(*corner).is_none()) {
            return None;
        }
        let whole = self.of_cell(wrap, map, &cell);
        let found = self.refined(wrap, map, &cell, whole, tolerance, DEEPEST);
        Some(std::array::from_fn(|k| self.mean[k] + found[k]))
    }

    fn refined(
        &self,
        wrap: [Wrap; 2],
        map: &PictureMap,
        cell: &Cell,
        whole: [f64; 4],
        tolerance: f64,
        depth: u32,
    ) -> [f64; 4] {
        let halves = cell.halves(map);
        let found = halves.map(|half| self.of_cell(wrap, map, &half));
        let mean = |[a, b]: [[f64; 4]; 2]| -> [f64; 4] { std::array::from_fn(|k| 0.5 * (a[k] + b[k])) };
        let together = mean(found);
        let agree = |other: [f64; 4]| (0..4).all(|k| (other[k] - whole[k]).abs() <= tolerance);
        let of_quarters =
            || mean(halves.each_ref().map(|half| mean(half.halves(map).map(|it| self.of_cell(wrap, map, &it)))));
        if depth == 0 || agree(together) && cell.is_even(map) && agree(of_quarters()) {
            return together;
        }
        let [a, b] = [0, 1].map(|k| self.refined(wrap, map, &halves[k], found[k], tolerance, depth - 1));
        mean([a, b])
    }

    /// The mean over a cell's quadrilateral, minus the image's: ∮ F dv over the area ∮ u dv, F the integral of a row
    /// from 0 to u.
    fn of_cell(&self, wrap: [Wrap; 2], map: &PictureMap, cell: &Cell) -> [f64; 4] {
        let [width, height] = self.size.map(|side| side as f64);
        let corners = cell.corners().map(|corner| {
            let [u, v] = map.at(corner).unwrap_or_default();
            [u * width, v * height]
        });
        // Numbers near the origin are more precise: shifted by whole periods, which change nothing.
        let period = |axis: usize| match wrap[axis] {
            Wrap::Repeat => self.size[axis] as f64,
            Wrap::Mirror => 2.0 * self.size[axis] as f64,
            Wrap::Clamp => f64::INFINITY,
        };
        let shift = [0, 1].map(|axis| {
            let period = period(axis);
            if period.is_finite() { (corners[0][axis] / period).floor() * period } else { 0.0 }
        });
        let corners = corners.map(|[u, v]| [u - shift[0], v - shift[1]]);
        let (mut sum, mut area) = ([0.0; 4], 0.0);
        for (k, &from) in corners.iter().enumerate() {
            self.along(wrap, from, corners[(k + 1) % 4], &mut sum);
        }
        for k in 0..4 {
            let [a, b] = [corners[k], corners[(k + 1) % 4]].map(|[u, v]| [u - corners[0][0], v - corners[0][1]]);
            area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
        }
        let perimeter: f64 = (0..4)
            .map(|k| (corners[k][0] - corners[(k + 1) % 4][0]).abs() + (corners[k][1] - corners[(k + 1) % 4][1]).abs())
            .sum();
        if area.abs() <= 1e-12 * perimeter * perimeter || area == 0.0 {
            // Seen edge-on it is a line, represented by its middle.
            let middle: [f64; 2] = std::array::from_fn(|axis| corners.iter().map(|c| c[axis]).sum::<f64>() / 4.0);
            return self.value(wrap, middle);
        }
        sum.map(|sum| sum / area)
    }

    /// Adds ∫ F dv along an edge. Between two lines of the grid F is linear along it, so that its middle times dv is
    /// exact.
    fn along(&self, wrap: [Wrap; 2], from: [f64; 2], to: [f64; 2], sum: &mut [f64; 4]) {
        let change = [to[0] - from[0], to[1] - from[1]];
        if change[1] == 0.0 {
            return;
        }
        // The fraction of the edge at which the next line of each axis is crossed.
        let next = |axis: usize, line: f64| if change[axis] == 0.0 { 2.0 } else { (line - from[axis]) / change[axis] };
        let mut lines: [f64; 2] =
            std::array::from_fn(
                |axis| if change[axis] > 0.0 { from[axis].floor() + 1.0 } else { from[axis].ceil() - 1.0 },
            );
        let mut t = 0.0;
        while t < 1.0 {
            let crossed = [next(0, lines[0]), next(1, lines[1])];
            let end = crossed[0].min(crossed[1]).clamp(t, 1.0);
            if end > t {
                let middle = 0.5 * (t + end);
                let [u, v] = [0, 1].map(|axis| from[axis] + middle * change[axis]);
                let f = self.to_left(wrap, u, v.floor() as i64);
                let dv = (end - t) * change[1];
                (0..4).for_each(|k| sum[k] += dv * f[k]);
            }
            for axis in 0..2 {
                if crossed[axis] <= end {
                    lines[axis] += change[axis].signum();
                }
            }
            t = end;
        }
    }

    /// The integral of a row from 0 to u, which may lie beyond the image.
    fn to_left(&self, wrap: [Wrap; 2], u: f64, row: i64) -> [f64; 4] {
        let [width, height] = self.size;
        let row = crate::lookup::wrapped_index(wrap[1], row, height as u32);
        let sums = &self.sums[row * (width + 1)..][..=width];
        let mut found = [0.0; 4];
        for (at, factor) in inside(wrap[0], u, width as f64) {
            let column = (at as usize).min(width - 1);
            let part = at - column as f64;
            for k in 0..4 {
                found[k] += factor * (sums[column][k] + part * (sums[column + 1][k] - sums[column][k]));
            }
        }
        found
    }

    /// The texel at a point, minus the mean.
    fn value(&self, wrap: [Wrap; 2], [u, v]: [f64; 2]) -> [f64; 4] {
        let [width, height] = self.size;
        let row = crate::lookup::wrapped_index(wrap[1], v.floor() as i64, height as u32);
        let column = crate::lookup::wrapped_index(wrap[0], u.floor() as i64, width as u32);
        let at = row * (width + 1) + column;
        std::array::from_fn(|k| self.sums[at + 1][k] - self.sums[at][k])
    }
}

/// A rectangular part of a pixel.
#[derive(Clone, Copy)]
struct Cell {
    low: [f64; 2],
    sides: [f64; 2],
}

impl Cell {
    fn corners(&self) -> [[f64; 2]; 4] {
        let ([x, y], [width, height]) = (self.low, self.sides);
        [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]
    }

    /// Whether the texels in it are about equally large; their size goes as 1/w³.
    fn is_even(&self, map: &PictureMap) -> bool {
        let w = self.corners().map(|corner| map.homogeneous(corner)[2]);
        let [low, high] = [w.iter().copied().fold(f64::INFINITY, f64::min), w.iter().copied().fold(0.0, f64::max)];
        high <= 1.03 * low
    }

    fn halves(&self, map: &PictureMap) -> [Self; 2] {
        let changes = [0, 1].map(|axis| (map.rows[2][axis] * self.sides[axis]).abs());
        let axis = usize::from(changes[1] > changes[0]);
        let (mut low, mut sides) = (self.low, self.sides);
        sides[axis] *= 0.5;
        low[axis] += sides[axis];
        [Self { low: self.low, sides }, Self { low, sides }]
    }
}
