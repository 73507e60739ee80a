//! Triangles that reach far beyond a tile, or behind the eye. They are few, so they are clipped one by one, in 64 bits.

use crate::pixels::cover::EdgeFunctions;
use crate::triangles::planes::{CutCorner, DepthPlane, Gradient, Planes};
use crate::triangles::samples::sample_offsets;
use crate::triangles::setup::Covering;
use crate::vertices::placed::TILE;
use crate::vertices::screen::Screen;
use crate::vertices::transform::{CLIPPED, GRID, SCREEN_HIGH, SCREEN_LOW, TOO_NEAR, Vertices};
use halfway_lighting::record::Cull;

/// A corner on the picture.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Corner {
    screen: [f32; 2],
    grid: [i32; 2],
    inverse_w: f32,
    /// The leading numbers by side, as in [`Vertices::lead`].
    lead: [[f32; 4]; 2],
    second: [[f32; 4]; 2],
    paint: [f32; 4],
    /// Its weights in the triangle's corners.
    weights: [f64; 3],
}

/// A triangle with its edges and planes.
pub(crate) struct Ready {
    pub(crate) edges: EdgeFunctions,
    pub(crate) planes: Planes,
    /// Whether it shows its back.
    pub(crate) back: bool,
    pub(crate) gradient: Gradient,
    pub(crate) corners: [CutCorner; 3],
}

/// The weights of the triangle's own corners.
const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A polygon gets a corner more from each plane that cuts it.
const MOST_CORNERS: usize = 3 + 5;

/// Calls a function with each part of a clipped triangle.
pub(crate) fn each_part(
    vertices: &Vertices,
    triangle: [u8; 3],
    screen: &Screen,
    (tile, covering): ([u32; 2], &Covering),
    mut draw: impl FnMut(Ready),
) {
    let numbers = triangle.map(usize::from);
    let code = numbers.iter().fold(0, |code, &v| code | vertices.codes[v]);
    if code & CLIPPED == 0 {
        if let Some(ready) =
            set_up(&[0, 1, 2].map(|k| Corner::at_vertex(vertices, numbers[k], UNITS[k])), tile, covering)
        {
            draw(ready);
        }
        return;
    }
    let mut polygon = Polygon::new();
    polygon.clip(vertices, numbers, screen, code);
    let corners = &polygon.corners[..polygon.count];
    let mut placed = [Corner::default(); MOST_CORNERS];
    for (corner, weights) in placed.iter_mut().zip(corners) {
        *corner = Corner::between(vertices, numbers, *weights, screen);
    }
    for k in 2..polygon.count {
        if let Some(ready) = set_up(&[placed[0], placed[k - 1], placed[k]], tile, covering) {
            draw(ready);
        }
    }
}

impl Corner {
    fn at_vertex(vertices: &Vertices, v: usize, weights: [f64; 3]) -> Self {
        Self {
            weights,
            inverse_w: vertices.inverse_w[v],
            screen: [vertices.screen[0][v], vertices.screen[1][v]],
            grid: [vertices.grid[0][v], vertices.grid[1][v]],
            lead: [vertices.lead[0][v], vertices.lead[usize::from(vertices.sides_lead)][v]],
            second: [vertices.second[0][v], vertices.second[1][v]],
            paint: vertices.paint[v],
        }
    }

    /// A weighted mean of a triangle's corners.
    fn between(vertices: &Vertices, numbers: [usize; 3], weights: [f64; 3], screen: &Screen) -> Self {
        if let Some(only) = weights.iter().position(|&weight| weight >= 1.0) {
            return Self::at_vertex(vertices, numbers[only], UNITS[only]);
        }
        let mean = |list: &[f32]| -> f64 { (0..3).map(|k| weights[k] * f64::from(list[numbers[k]])).sum() };
        let [x, y, z] = [0, 1, 2].map(|axis| mean(&vertices.eye[axis]));
        let lens = screen.lens.cast::<f64>();
        let inverse_w = 1.0 / lens.w(-z);
        let nearness = lens.nearness(-z) as f32;
        let pixels = |axis: usize, v: f64| {
            let at = v * inverse_w * f64::from(screen.scale[axis]) + f64::from(screen.center[axis]);
            at.clamp(f64::from(SCREEN_LOW), f64::from(SCREEN_HIGH)) as f32
        };
        let on_screen = [pixels(0, x), pixels(1, y)];
        let four = |first: usize| {
            let [a, b, c] = [0, 1, 2].map(|k| (mean(&vertices.raw[first + k]) * inverse_w) as f32);
            [nearness, a, b, c]
        };
        let of_normal = four(0);
        let of_colors = [four(3), four(6)];
        Self {
            inverse_w: inverse_w as f32,
            screen: on_screen,
            grid: on_screen.map(|v| (v * GRID as f32).round_ties_even() as i32),
            lead: if vertices.sides_lead { of_colors } else { [of_normal; 2] },
            second: of_colors,
            weights,
            paint: [0, 1, 2, 3].map(|k| (mean(&vertices.raw[9 + k]) * inverse_w) as f32),
        }
    }
}

/// Corners as weights of the triangle's.
struct Polygon {
    corners: [[f64; 3]; MOST_CORNERS],
    count: usize,
}

impl Polygon {
    fn new() -> Self {
        let mut corners = [[0.0; 3]; MOST_CORNERS];
        for (k, corner) in corners[..3].iter_mut().enumerate() {
            corner[k] = 1.0;
        }
        Self { corners, count: 3 }
    }

    /// Clips at the planes that some corner is beyond (Sutherland, Hodgman 1974).
    fn clip(&mut self, vertices: &Vertices, numbers: [usize; 3], screen: &Screen, code: i32) {
        let eye = numbers.map(|v| [0, 1, 2].map(|axis| f64::from(vertices.eye[axis][v])));
        let lens = screen.lens.cast::<f64>();
        let near = lens.near;
        if code & TOO_NEAR != 0 {
            self.cut(|weights| {
                weights[0] * (-eye[0][2] - near) + weights[1] * (-eye[1][2] - near) + weights[2] * (-eye[2][2] - near)
            });
        }
        // Behind the eye a corner's side of the other planes is unknown.
        for axis in 0..2 {
            let scale = f64::from(screen.scale[axis]);
            let center = f64::from(screen.center[axis]);
            for (end, sign) in [(SCREEN_LOW + 1.0, 1.0), (SCREEN_HIGH - 1.0, -1.0)] {
                let inside = eye.map(|p| sign * (p[axis] * scale + lens.w(-p[2]) * (center - f64::from(end))));
                self.cut(|weights| weights[0] * inside[0] + weights[1] * inside[1] + weights[2] * inside[2]);
            }
        }
    }

    fn cut(&mut self, inside: impl Fn([f64; 3]) -> f64) {
        let before = self.corners;
        let count = std::mem::take(&mut self.count);
        for k in 0..count {
            let (this, next) = (before[k], before[(k + 1) % count]);
            let (a, b) = (inside(this), inside(next));
            if a >= 0.0 {
                self.push(this);
            }
            if (a >= 0.0) != (b >= 0.0) {
                // Always from inside to outside, so that the triangle beyond the edge gets the same corner.
                let (from, to, d, e) = if a >= 0.0 { (this, next, a, b) } else { (next, this, b, a) };
                let t = d / (d - e);
                self.push([0, 1, 2].map(|axis| from[axis] + t * (to[axis] - from[axis])));
            }
        }
    }

    fn push(&mut self, corner: [f64; 3]) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }
}

/// Edges and planes of a triangle of any size; `None` if it is invisible.
fn set_up(corners: &[Corner; 3], tile: [u32; 2], covering: &Covering) -> Option<Ready> {
    let first = tile.map(|place| i64::from(place) * (TILE as i64 * i64::from(GRID)) + i64::from(GRID / 2));
    let x = corners.each_ref().map(|corner| i64::from(corner.grid[0]) - first[0]);
    let y = corners.each_ref().map(|corner| i64::from(corner.grid[1]) - first[1]);
    let area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    let front = (area > 0) == covering.clockwise;
    let shown = match covering.cull {
        Cull::Back => front,
        Cull::Front => !front,
        Cull::None => true,
    };
    if area == 0 || !shown {
        return None;
    }
    let order = if area > 0 { [0, 1, 2] } else { [0, 2, 1] };
    let edges = edges(order.map(|k| x[k]), order.map(|k| y[k]), covering)?;
    let (planes, gradient) = planes(corners, first, (x, y), area > 0, front);
    let of_corners = corners.each_ref().map(|corner| (corner.inverse_w, corner.weights));
    Some(Ready { edges, planes, back: !front, gradient, corners: of_corners })
}

fn edges(x: [i64; 3], y: [i64; 3], covering: &Covering) -> Option<EdgeFunctions> {
    let reach = i64::from(covering.reach());
    let mut edges = EdgeFunctions::default();
    for (axis, v) in [x, y].into_iter().enumerate() {
        let (low, high) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        let first = ((low - reach + i64::from(GRID) - 1) >> 8).max(0);
        let last = ((high + reach) >> 8).min(i64::from(covering.last[axis]));
        if first > last {
            return None;
        }
        edges.bounds[2 * axis] = first as i32;
        edges.bounds[2 * axis + 1] = last as i32;
    }
    for k in 0..3 {
        let next = (k + 1) % 3;
        let (across, down) = (y[k] - y[next], x[next] - x[k]);
        let bias = if across > 0 || across == 0 && down > 0 { 0 } else { -1 };
        let at_first = bias - across * x[k] - down * y[k];
        for (value, [dx, dy]) in edges.at[k].iter_mut().zip(sample_offsets(covering.samples)) {
            let at = (at_first + across * i64::from(dx) + down * i64::from(dy)) >> 8;
            // Beyond this no pixel of the tile changes the sign, and no sum overflows 32 bits.
            *value = at.clamp(-LARGEST_EDGE, LARGEST_EDGE) as i32;
        }
        edges.center[k] = (at_first >> 8).clamp(-LARGEST_EDGE, LARGEST_EDGE) as i32;
        (edges.across[k], edges.down[k]) = (across as i32, down as i32);
        // The pixel of the box where the edge function is greatest.
        let corner = |step: i64, ends: [i32; 2]| step * i64::from(if step > 0 { ends[1] } else { ends[0] });
        let [left, right, top, bottom] = edges.bounds;
        let most = edges.at[k].into_iter().max().map_or(0, i64::from);
        if most + corner(across, [left, right]) + corner(down, [top, bottom]) < 0 {
            return None;
        }
    }
    Some(edges)
}

const LARGEST_EDGE: i64 = (1 << 30) - 1;

fn planes(
    corners: &[Corner; 3],
    first: [i64; 2],
    (x, y): ([i64; 3], [i64; 3]),
    positive: bool,
    front: bool,
) -> (Planes, Gradient) {
    let side = usize::from(!front);
    let exact =
        |axis: usize| corners.map(|corner| f64::from(corner.screen[axis]) - first[axis] as f64 / f64::from(GRID));
    let on_grid = |v: [i64; 3]| v.map(|v| v as f64 / f64::from(GRID));
    let gradient = Gradient::new(exact(0), exact(1), (on_grid(x), on_grid(y)), positive);
    let lead = [0, 1, 2].map(|k| &corners[k].lead[side]);
    let nearness = lead.map(|lead| lead[0]);
    let lead = gradient.slopes(lead);
    let planes = Planes {
        depth: DepthPlane::new(&lead, [0; 2]),
        lead,
        second: gradient.slopes([0, 1, 2].map(|k| &corners[k].second[side])),
        paint: gradient.slopes([0, 1, 2].map(|k| &corners[k].paint)),
        face: [0.0; 3],
        range: [nearness.into_iter().fold(f32::INFINITY, f32::min), nearness.into_iter().fold(0.0, f32::max)],
    };
    (planes, gradient)
}
