//! Whole pictures against a slow renderer in f64: rays, exact triangles, and `halfway_lighting::equations`.

use crate::common::{Scene, Shading, at, draw, lens, pieces};
use halfway_lighting::equations::{
    Coefficients, Colors, ConeTerms, Directional, Eye, Light, Point, ShadedPoint, Spot, normal_matrix, shade,
    transform_normal, vector,
};
use halfway_lighting::lights::Kind;
use halfway_lighting::record::{
    Cull, InstanceRecord, LightRange, LightRecord, MaterialRecord, SurfaceLights, SurfaceRecord,
};
use halfway_lighting::{Frequency, Lens, Reflectance, Samples, Terms};
use halfway_mesh::{Mesh, UvSphere};
use halfway_raster::{ClearTiles, Output, Pieces, PixelFormat, RasterOptions, Rasterizer, TriangleOrder, VertexLists};

type V = [f64; 3];

/// The slow renderer's data besides the pass.
struct Case {
    scene: Scene,
    mesh: Mesh,
    local_viewer: bool,
    /// The columns of the upper 3 × 3 of `eye_from_model`.
    linear: [[f64; 3]; 3],
    place: V,
}

fn f(v: [f32; 3]) -> V {
    v.map(f64::from)
}

fn lights() -> Vec<LightRecord> {
    let plain = LightRecord { diffuse: [0.5, 0.4, 0.3], specular: [0.5, 0.6, 0.7], ..LightRecord::default() };
    let c = 1.0 / 3.0_f32.sqrt();
    vec![
        LightRecord { position: [c, c, c], ..plain },
        LightRecord {
            kind: Kind::Point as u32,
            position: [-1.5, 1.0, -1.0],
            constant: 0.4,
            linear: 0.1,
            quadratic: 0.2,
            inverse_range: 0.2,
            ambient: [0.1, 0.05, 0.0],
            ..plain
        },
        LightRecord {
            kind: Kind::Spot as u32,
            position: [0.3, -0.4, -0.4],
            direction: [-0.1, 0.124_89, -0.987_12],
            cos_cutoff: 0.85,
            exponent: 3.0,
            inner_scale: 1.0 / 0.1,
            inner_offset: -8.5,
            ..plain
        },
    ]
}

fn case(shading: Shading, reflectance: Reflectance) -> Case {
    let mesh = Mesh::from(UvSphere { radius: 1.0, segments: 24, rings: 12 });
    let ready = pieces(&mesh, TriangleOrder::Clustered).expect("a sound mesh");
    let side = |red: f32| MaterialRecord {
        base: [0.05, 0.02, 0.1],
        diffuse: [red, 0.5, 0.3],
        specular: [0.6, 0.7, 0.8],
        ambient: [0.5, 0.4, 0.3],
        shininess: 20.0,
        opacity: 1.0,
        ..MaterialRecord::default()
    };
    let both = LightRange { start: 0, count: 3 };
    let mut call = draw(&ready, 1, shading);
    call.reflectance = reflectance;
    let scene = Scene {
        size: [96, 72],
        samples: Samples::One,
        pixels: PixelFormat::Floats,
        clear: [0.0; 3],
        lens: lens([96, 72], 45.0),
        lights: lights(),
        lists: vec![0, 1, 2],
        surfaces: vec![SurfaceRecord {
            front: side(0.8),
            back: side(0.2),
            lights: SurfaceLights { both, ..SurfaceLights::default() },
            ..SurfaceRecord::default()
        }],
        instances: vec![at([0.1, -0.05, -3.2], 0)],
        draws: vec![call],
        meshes: vec![ready],
    };
    Case {
        scene,
        mesh,
        local_viewer: true,
        linear: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        place: [0.1, -0.05, -3.2].map(|x: f32| f64::from(x)),
    }
}

impl Case {
    /// The mesh under another matrix, given as columns.
    fn with(mut self, linear: [[f64; 3]; 3]) -> Self {
        let row = |axis: usize| [linear[0][axis], linear[1][axis], linear[2][axis], self.place[axis]].map(|x| x as f32);
        let normal = normal_matrix(linear).map(|column| column.map(|x| x as f32));
        self.scene.instances = vec![InstanceRecord { eye_from_model: [row(0), row(1), row(2)], normal, surface: 0 }];
        let det = vector::dot(linear[0], vector::cross(linear[1], linear[2]));
        self.scene.draws[0].clockwise = det < 0.0;
        self.linear = linear;
        self
    }

    fn picture(&self) -> Vec<f32> {
        let [width, height] = self.scene.size;
        let mut floats = vec![0.0; 4 * (width * height) as usize];
        let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
        self.scene
            .with_pass(|pass| {
                let pass = halfway_raster::Pass { local_viewer: self.local_viewer, ..*pass };
                rasterizer.draw(&pass, Output::Floats(&mut floats), &mut ClearTiles::default())
            })
            .expect("a sound pass");
        floats
    }

    fn in_eye(&self, p: V) -> V {
        [0, 1, 2].map(|axis| (0..3).map(|k| self.linear[k][axis] * p[k]).sum::<f64>() + self.place[axis])
    }

    fn turned(&self, n: V) -> V {
        transform_normal(normal_matrix(self.linear), n).unwrap_or([0.0; 3])
    }

    fn sources(&self) -> Vec<Light<f64>> {
        let source = |(number, light): (usize, &LightRecord)| {
            let [fade, offset] = [light.inner_scale, light.inner_offset].map(f64::from);
            let colors = Colors { la: f(light.ambient), ld: f(light.diffuse), ls: f(light.specular) };
            let point = Point {
                position: f(light.position),
                colors,
                attenuation: f([light.constant, light.linear, light.quadratic]),
                range: (light.inverse_range > 0.0).then(|| 1.0 / f64::from(light.inverse_range)),
                attenuate_ambient: true,
            };
            let cone = ConeTerms {
                direction: f(light.direction),
                cos_cutoff: f64::from(light.cos_cutoff),
                cos_inner: (fade > 0.0).then(|| (1.0 - offset) / fade),
                exponent: f64::from(light.exponent),
            };
            match number {
                0 => Light::Directional(Directional { toward: f(light.position), colors }),
                1 => Light::Point(point),
                _ => Light::Spot(Spot { point, cone }),
            }
        };
        self.scene.lights.iter().enumerate().map(source).collect()
    }

    /// I at a point of a side, of the terms of one frequency and with or without the base.
    fn shade(&self, position: V, normal: V, back: bool, frequency: Frequency, base: bool) -> V {
        let terms = self.scene.draws[0].terms;
        let surface = &self.scene.surfaces[0];
        let side = if back { &surface.back } else { &surface.front };
        let kept = |on: bool, color: [f32; 3]| if on { f(color) } else { [0.0; 3] };
        let material = Coefficients {
            ka: kept(terms.diffuse == frequency, side.ambient),
            kd: kept(terms.diffuse == frequency, side.diffuse),
            ks: kept(terms.specular == frequency, side.specular),
            ke: kept(base, side.base),
            shininess: f64::from(side.shininess),
            ..Coefficients::black()
        };
        let view = if self.local_viewer { Eye::Local([0.0; 3]) } else { Eye::Infinite([0.0, 0.0, 1.0]) };
        let reflectance = self.scene.draws[0].reflectance;
        let normal = if back { vector::neg(normal) } else { normal };
        shade(&ShadedPoint { position, normal }, &material, &self.sources(), [0.0; 3], &view, reflectance)
    }

    /// All of them in eye space.
    fn triangles(&self) -> Vec<[V; 3]> {
        let corner = |i: u32| self.in_eye(f(self.mesh.positions()[i as usize].to_array()));
        self.mesh.triangles().map(|triangle| triangle.map(corner)).collect()
    }

    /// The nearest triangle along the ray through a point of the picture, as its number, weights and side.
    fn hit(&self, triangles: &[[V; 3]], x: f64, y: f64) -> Option<(usize, V, bool)> {
        let [width, height] = self.scene.size.map(f64::from);
        let [sx, sy] = self.scene.lens.scale.map(f64::from);
        let way = [(2.0 * x / width - 1.0) / sx, (1.0 - 2.0 * y / height) / sy, -1.0];
        let call = &self.scene.draws[0];
        let mut nearest: Option<(f64, usize, V, bool)> = None;
        for (number, &[a, b, c]) in triangles.iter().enumerate() {
            // way·t = a·u + b·v + c·w: volumes of the eye, the way and two corners.
            let volumes = [[b, c], [c, a], [a, b]].map(|[p, q]| vector::dot(way, vector::cross(p, q)));
            let sum: f64 = volumes.iter().sum();
            if sum == 0.0 || volumes.iter().any(|volume| volume / sum < 0.0) {
                continue;
            }
            let weights = volumes.map(|volume| volume / sum);
            let depth = -(0..3).map(|k| weights[k] * [a, b, c][k][2]).sum::<f64>();
            // The sum is below 0 where the corners are seen counter-clockwise.
            let back = (sum > 0.0) != call.clockwise;
            let culled = match call.cull {
                Cull::Back => back,
                Cull::Front => !back,
                Cull::None => false,
            };
            let in_front = depth >= f64::from(self.scene.lens.near);
            if !culled && in_front && nearest.is_none_or(|(least, ..)| depth < least) {
                nearest = Some((depth, number, weights, back));
            }
        }
        nearest.map(|(_, number, weights, back)| (number, weights, back))
    }

    fn color(&self, (number, weights, back): (usize, V, bool)) -> V {
        let call = &self.scene.draws[0];
        let triangle: [u32; 3] = self.mesh.triangles().nth(number).expect("it was hit");
        let corners = triangle.map(|i| self.in_eye(f(self.mesh.positions()[i as usize].to_array())));
        let normals = triangle.map(|i| self.turned(f(self.mesh.normals()[i as usize].to_array())));
        let mean = |of: [V; 3]| [0, 1, 2].map(|axis| (0..3).map(|k| weights[k] * of[k][axis]).sum::<f64>());
        if call.terms.has(Frequency::Triangle) {
            let [a, b, c] = triangle.map(|i| f(self.mesh.positions()[i as usize].to_array()));
            let n =
                self.turned(vector::normalize(vector::cross(vector::sub(b, a), vector::sub(c, a))).expect("a face"));
            let middle = vector::scale(vector::add(corners[0], vector::add(corners[1], corners[2])), 1.0 / 3.0);
            return self.shade(middle, n, back, Frequency::Triangle, true);
        }
        let of_vertices = mean([0, 1, 2].map(|k| self.shade(corners[k], normals[k], back, Frequency::Vertex, true)));
        if !call.terms.has(Frequency::Fragment) {
            return of_vertices;
        }
        let n = vector::normalize(mean(normals)).expect("normals that do not vanish");
        vector::add(of_vertices, self.shade(mean(corners), n, back, Frequency::Fragment, false))
    }

    fn check(&self, name: &str) {
        self.judge(name, &self.picture());
    }

    /// Compares all pixels that do not lie on an edge; their share of the picture must be sound.
    fn judge(&self, name: &str, found: &[f32]) {
        let triangles = self.triangles();
        let [width, height] = self.scene.size;
        let (mut errors, mut edges, mut range) = (Vec::new(), 0, 0.0_f64);
        for y in 0..height {
            for x in 0..width {
                let at = |dx: f64, dy: f64| self.hit(&triangles, f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy);
                let place = 4 * (y * width + x) as usize;
                let found = [0, 1, 2].map(|c| f64::from(found[place + c]));
                let centers = at(0.0, 0.0);
                // The rasteriser's grid may give it to either of two triangles.
                let around = [(-0.004, 0.0), (0.004, 0.0), (0.0, -0.004), (0.0, 0.004)].map(|(dx, dy)| at(dx, dy));
                let number = |hit: &Option<(usize, V, bool)>| hit.map(|(number, ..)| number);
                if around.iter().any(|near| number(near) != number(&centers)) {
                    edges += 1;
                    continue;
                }
                let expected = centers.map_or([0.0; 3], |hit| self.color(hit));
                range = expected.into_iter().fold(range, f64::max);
                for c in 0..3 {
                    errors.push(((found[c] - expected[c]).abs(), x, y, found[c], expected[c]));
                }
            }
        }
        assert!(edges * 20 < width * height, "{name}: {edges} pixels lie on edges");
        errors.sort_by(|a, b| a.0.total_cmp(&b.0));
        let worst = errors[errors.len() - 1];
        let most = errors[errors.len() * 999 / 1000];
        // The project's bars of conformance; docs/accuracy.md.
        assert!(
            worst.0 <= 2e-3 * range && most.0 <= 2e-4 * range,
            "{name}: worst {worst:?}, 99.9 % {most:?} of {range}"
        );
    }
}

#[test]
fn every_shading_and_highlight_is_that_of_the_equations() {
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong] {
            let mut case = case(shading, reflectance);
            case.check(&format!("{shading:?} {reflectance:?}"));
            case.local_viewer = false;
            case.check(&format!("{shading:?} {reflectance:?}, infinite viewer"));
        }
    }
}

#[test]
fn terms_are_shaded_where_the_draw_says() {
    use Frequency::{Fragment, Never, Vertex};
    for (diffuse, specular) in [(Vertex, Fragment), (Fragment, Vertex), (Vertex, Never)] {
        let mut case = case(Shading::Phong, Reflectance::BlinnPhong);
        case.scene.draws[0].terms = Terms { diffuse, specular };
        case.check(&format!("diffuse {diffuse:?}, specular {specular:?}"));
    }
}

#[test]
fn transforms_may_skew_mirror_and_flatten() {
    for (name, linear) in [
        ("skewed", [[1.0, 0.3, 0.0], [-0.4, 0.7, 0.2], [0.1, 0.0, 1.2]]),
        ("mirrored", [[-1.0, 0.3, 0.0], [0.4, 0.7, 0.2], [-0.1, 0.0, 1.2]]),
        ("nearly flat", [[1.0, 0.0, 0.1], [0.0, 1.0, 0.1], [0.0, 0.0, 0.01]]),
    ] {
        for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
            case(shading, Reflectance::BlinnPhong).with(linear).check(&format!("{name} {shading:?}"));
        }
    }
}

#[test]
fn a_sphere_cut_by_the_near_plane_shows_its_back() {
    for shading in Shading::ALL {
        let mut case = case(shading, Reflectance::Phong);
        case.place = [0.1, -0.05, -1.2].map(|x: f32| f64::from(x));
        case.scene.lens.near = 0.5;
        case.scene.draws[0].cull = Cull::None;
        case.with([[1.0, 0.2, 0.0], [-0.2, 1.0, 0.0], [0.0, 0.0, 1.0]]).check(&format!("{shading:?} cut open"));
    }
}

#[test]
fn from_inside_the_far_side_is_seen_from_behind() {
    for cull in [Cull::Front, Cull::None] {
        let mut case = case(Shading::Phong, Reflectance::BlinnPhong);
        case.place = [0.0, 0.1, 0.2].map(|x: f32| f64::from(x));
        case.scene.draws[0].cull = cull;
        case.with([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).check(&format!("{cull:?} is culled"));
    }
}

#[test]
#[should_panic(expected = "an exponent of 20.2")]
fn the_check_finds_an_exponent_that_is_one_percent_off() {
    let mut case = case(Shading::Phong, Reflectance::Phong);
    case.scene.surfaces[0].front.shininess = 20.2;
    let picture = case.picture();
    case.scene.surfaces[0].front.shininess = 20.0;
    case.judge("an exponent of 20.2", &picture);
}

#[test]
#[should_panic(expected = "without a light")]
fn the_check_finds_a_light_that_is_left_out() {
    let mut case = case(Shading::Gouraud, Reflectance::Phong);
    case.scene.surfaces[0].lights.both.count = 2;
    let picture = case.picture();
    case.judge("without a light", &picture);
}

#[test]
fn a_sliver_has_the_colors_of_its_corners_and_not_of_the_grids() {
    // A 64th of a pixel high, its corners nearly half a step of the grid away from it; eye space with z = −1.
    let (side, rows) = (64.0, [20.494_2, 20.509_7, 20.494_2]);
    let eye = |[x, y]: [f64; 2]| [(x / 32.0 - 1.0) as f32, (1.0 - y / 32.0) as f32, -1.0];
    let positions = [eye([4.1, rows[0]]), eye([32.3, rows[1]]), eye([59.7, rows[2]])];
    let colors = [0.0, 1.0, 0.0].map(|grey: f32| [grey, grey, grey, 1.0]);
    let lists = VertexLists { colors: &colors, ..VertexLists::default() };
    let mesh = Pieces::new(&positions, lists, &[0, 1, 2], &[], TriangleOrder::Clustered).expect("a sound mesh");
    let mut call = draw(&mesh, 1, Shading::Constant);
    (call.colored, call.cull) = (true, Cull::None);
    let mut scene = case(Shading::Constant, Reflectance::Phong).scene;
    (scene.size, scene.lens) = ([side as u32; 2], Lens::perspective([1.0; 2], 0.1));
    let white = MaterialRecord { base: [1.0; 3], opacity: 1.0, ..MaterialRecord::default() };
    (scene.surfaces[0].front, scene.surfaces[0].back) = (white, white);
    (scene.instances, scene.draws, scene.meshes) = (vec![at([0.0; 3], 0)], vec![call], vec![mesh]);
    let mut floats = vec![0.0; 4 * 64 * 64];
    let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
    scene
        .with_pass(|pass| rasterizer.draw(pass, Output::Floats(&mut floats), &mut ClearTiles::default()))
        .expect("a sound pass");

    // How far a pixel's middle is from one side of the long edge to the corner opposite of it.
    let [a, b, c] = positions.map(f);
    let height = |p: V| (c[0] - a[0]) * (p[1] - a[1]) - (c[1] - a[1]) * (p[0] - a[0]);
    for column in 20..45 {
        let expected = height(f(eye([f64::from(column) + 0.5, 20.5]))) / height(b);
        let found = f64::from(floats[4 * (20 * 64 + column as usize)]);
        // Positions are stored to 2⁻¹⁶ of a pixel: a thousandth of the height.
        assert!((found - expected).abs() < 2e-3, "column {column}: {found} for {expected}");
    }
}
