//! Fragments that take the normal of the nearest corner.

use crate::common::{Scene, Shading, at, draw, lens};
use halfway_raster::{
    DrawCall, LightData, LightRange, Output, Pieces, PixelFormat, RasterOptions, Rasterizer, SampleCount, SideData,
    SurfaceData, TriangleOrder,
};

const SIZE: [u32; 2] = [70, 66];
const DEPTH: f64 = 2.0;
/// Where a point light is, so near that the way to it turns from pixel to pixel.
const LIGHT: [f64; 3] = [0.1, -0.1, 0.4 - DEPTH];

/// A place of the net, which lies across the view.
fn in_eye(place: [f64; 2]) -> [f64; 3] {
    let scale = lens(SIZE, 60.0).scale.map(f64::from);
    let [x, y] = [0, 1].map(|axis| (2.0 * place[axis] / f64::from(SIZE[axis]) - 1.0) * DEPTH / scale[axis]);
    [x, -y, -DEPTH]
}

fn normal(slope: f64) -> [f64; 3] {
    [slope, 0.0, (1.0 - slope * slope).sqrt()]
}

/// What a place with a normal of this slope shows.
fn grey(place: [f64; 2], slope: f64) -> f64 {
    let (p, n) = (in_eye(place), normal(slope));
    let way = [0, 1, 2].map(|axis| LIGHT[axis] - p[axis]);
    let [along, length2] = [n, way].map(|other| (0..3).map(|axis| way[axis] * other[axis]).sum::<f64>());
    (along / length2.sqrt()).max(0.0)
}

/// A net of triangles over the whole picture, seen from the front, of which each corner has a normal of its own.
struct Net {
    /// Corners in pixels.
    places: Vec<[f64; 2]>,
    slopes: Vec<f64>,
    triangles: Vec<[usize; 3]>,
}

impl Net {
    /// With corners about this many pixels apart.
    fn new(apart: f64) -> Self {
        let mut state = 5_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let [columns, rows] = SIZE.map(|side| (f64::from(side) / apart) as usize + 2);
        let mut net = Self { places: Vec::new(), slopes: Vec::new(), triangles: Vec::new() };
        for row in 0..rows {
            for column in 0..columns {
                let mut place = |step: usize| apart * (step as f64 + 0.5 * (random() - 0.5));
                net.places.push([place(column), place(row)]);
                net.slopes.push(1.2 * random() - 0.6);
            }
        }
        let corner = |column: usize, row: usize| row * columns + column;
        for row in 1..rows {
            for column in 1..columns {
                let [a, b, c, d] = [(1, 1), (0, 1), (0, 0), (1, 0)].map(|(left, up)| corner(column - left, row - up));
                net.triangles.extend([[a, d, b], [b, d, c]]);
            }
        }
        net
    }

    fn picture(&self, samples: SampleCount, change: impl Fn(&mut DrawCall)) -> Vec<[f32; 4]> {
        let lens = lens(SIZE, 60.0);
        let positions: Vec<_> = self.places.iter().map(|place| in_eye(*place).map(|x| x as f32)).collect();
        let normals: Vec<_> = self.slopes.iter().map(|slope| normal(*slope).map(|x| x as f32)).collect();
        let indices: Vec<u32> = self.triangles.as_flattened().iter().map(|&corner| corner as u32).collect();
        let mesh = Pieces::new(&positions, &normals, &indices, &[], TriangleOrder::Clustered).expect("a sound net");
        let mut call = DrawCall { nearest_corner: true, ..draw(&mesh, 1, Shading::Phong) };
        change(&mut call);
        let lights = LightRange { counts: [0, 1, 0], start: 0 };
        let front = SideData { diffuse: [1.0; 3], opacity: 1.0, ..SideData::default() };
        let scene = Scene {
            size: SIZE,
            samples,
            pixels: PixelFormat::Floats,
            clear: [0.0; 3],
            lens,
            lights: vec![LightData { position: LIGHT.map(|x| x as f32), diffuse: [1.0; 3], ..LightData::default() }],
            lists: vec![0],
            surfaces: vec![SurfaceData { front, fragment: lights, ..SurfaceData::default() }],
            instances: vec![at([0.0; 3], 0)],
            draws: vec![call],
            meshes: vec![mesh],
        };
        let mut floats = vec![f32::NAN; 4 * (SIZE[0] * SIZE[1]) as usize];
        let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
        scene.with_pass(|pass| rasterizer.draw(pass, Output::Floats(&mut floats))).expect("a sound pass");
        floats.as_chunks().0.to_vec()
    }

    /// The triangle whose sides are all farther than this from a place that it covers.
    fn around(&self, [x, y]: [f64; 2], margin: f64) -> Option<[usize; 3]> {
        self.triangles.iter().copied().find(|triangle| {
            (0..3).all(|k| {
                let [[ax, ay], [bx, by]] = [triangle[k], triangle[(k + 1) % 3]].map(|corner| self.places[corner]);
                let (dx, dy) = (bx - ax, by - ay);
                // Rows count downward, so that what winds counter-clockwise has its inside to the right.
                (dy * (x - ax) - dx * (y - ay)) / dx.hypot(dy) > margin
            })
        })
    }
}

#[test]
fn tiny_triangles_show_the_nearest_corner() {
    // With four samples what covers all of a pixel is shaded in its middle.
    for (samples, apart, margin) in [(SampleCount::One, 3.0, 0.02), (SampleCount::Four, 2.8, 0.72)] {
        let net = Net::new(apart);
        let picture = net.picture(samples, |_| {});
        let between = net.picture(samples, |call| call.nearest_corner = false);
        let (mut looked_at, mut others) = (0, 0);
        for (number, (pixel, between)) in (0..).zip(picture.iter().zip(&between)) {
            let place = [number % SIZE[0], number / SIZE[0]].map(|at| f64::from(at) + 0.5);
            let Some(triangle) = net.around(place, margin) else { continue };
            let far = |corner: usize| (net.places[corner][0] - place[0]).hypot(net.places[corner][1] - place[1]);
            let mut corners = triangle;
            corners.sort_unstable_by(|a, b| far(*a).total_cmp(&far(*b)));
            if far(corners[1]) - far(corners[0]) < 0.02 {
                continue;
            }
            looked_at += 1;
            let grey = grey(net.places[corners[0]], net.slopes[corners[0]]);
            assert!((f64::from(pixel[0]) - grey).abs() < 1e-4, "{place:?}, {samples:?}: {pixel:?} instead of {grey}");
            others += usize::from((f64::from(between[0]) - grey).abs() > 1e-2);
        }
        assert!(looked_at > 50 && 2 * others > looked_at, "{looked_at} pixels, {others} show others between");
    }
}

#[test]
fn what_blends_or_has_a_mask_shows_what_is_between() {
    type Change = fn(&mut DrawCall);
    let rows: [Change; 2] = [|call| call.blend = true, |call| call.mask = Some(0.5)];
    let net = Net::new(3.0);
    for (number, change) in rows.into_iter().enumerate() {
        for samples in [SampleCount::One, SampleCount::Four] {
            let [with, without] = [true, false].map(|nearest_corner| {
                net.picture(samples, |call| {
                    change(call);
                    call.nearest_corner = nearest_corner;
                })
            });
            assert!(with == without && with.iter().any(|pixel| pixel[0] > 0.3), "row {number}, {samples:?}");
        }
    }
}
