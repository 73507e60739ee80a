//! The angles between computed and true vertex normals: the four weightings on five surfaces, at four tessellations,
//! on regular and on jittered meshes. Prints a table in Markdown, or with the argument `csv` one in CSV.
//!
//! Jittered meshes have their vertices moved on the surface, and their cells cut along either diagonal: by up to 0.35
//! of the shorter side of their cell, or, to make slivers, by 0.35 of the cell along each parameter. Vertices on
//! borders and creases are left out: no weighting can know what lies beyond.

use std::collections::{HashMap, HashSet};
use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use halfway_mesh::{BezierPatch, Mesh, NormalWeighting, Normals, Parameter, SurfacePiece, Teapot};

const WEIGHTINGS: [NormalWeighting; 4] =
    [NormalWeighting::Uniform, NormalWeighting::Area, NormalWeighting::Angle, NormalWeighting::Max];

/// A point of a surface and its unit normal, or `None` where it has none.
type PointAndNormal = (DVec3, Option<DVec3>);

/// A piece of a surface over the unit square.
struct ParameterPiece {
    at: Box<dyn Fn(f64, f64) -> PointAndNormal>,
    /// Whether u and v end where they begin.
    closed: [bool; 2],
    /// Cells along u for one along v.
    aspect: usize,
}

struct TestSurface {
    name: &'static str,
    pieces: Vec<ParameterPiece>,
    /// Cells along v.
    cells: [usize; 4],
}

/// A number from 0 to 1 for each key, always the same (`SplitMix64`).
fn random(key: u64) -> f64 {
    let mut z = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as f64 / 2.0_f64.powi(64)
}

fn ellipsoid(name: &'static str, axes: DVec3) -> TestSurface {
    let at = move |u: f64, v: f64| {
        let ((sin_phi, cos_phi), (sin_theta, cos_theta)) = ((TAU * u).sin_cos(), (PI * v).sin_cos());
        // A parallel of no radius is one point.
        let sin_theta = if v <= 0.0 || v >= 1.0 { 0.0 } else { sin_theta };
        let n = DVec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi);
        (n * axes, Some((n / axes).normalize()))
    };
    TestSurface {
        name,
        pieces: vec![ParameterPiece { at: Box::new(at), closed: [true, false], aspect: 2 }],
        cells: [8, 16, 32, 64],
    }
}

fn torus() -> TestSurface {
    let at = |u: f64, v: f64| {
        let ((sin_u, cos_u), (sin_v, cos_v)) = ((TAU * u).sin_cos(), (TAU * v).sin_cos());
        let n = DVec3::new(cos_v * cos_u, sin_v, cos_v * sin_u);
        (DVec3::new(cos_u, 0.0, sin_u) + n * 0.4, Some(n))
    };
    let piece = ParameterPiece { at: Box::new(at), closed: [true, true], aspect: 2 };
    TestSurface { name: "torus", pieces: vec![piece], cells: [8, 16, 32, 64] }
}

fn patch(patch: BezierPatch) -> ParameterPiece {
    let at = move |u: f64, v: f64| {
        let (u, v) = (Parameter::from(u), Parameter::from(v));
        (patch.position(u, v), patch.normal(u, v))
    };
    ParameterPiece { at: Box::new(at), closed: [false; 2], aspect: 1 }
}

/// Heights drawn at random over a square of 3 × 3.
fn cubic() -> TestSurface {
    let point = |i: u64| DVec3::new((i / 4) as f64, 2.5 * random(i), -((i % 4) as f64));
    let points = (0..16).map(point).collect();
    let patch = patch(BezierPatch::new(4, points).expect("four rows of four finite points"));
    TestSurface { name: "random cubic", pieces: vec![patch], cells: [8, 16, 32, 64] }
}

fn teapot() -> TestSurface {
    let mesh = Mesh::from(Teapot::new(1));
    let pieces = mesh.surface().into_iter().flat_map(|surface| surface.pieces().to_vec());
    let pieces = pieces.filter_map(|piece| match piece {
        SurfacePiece::Patch(piece) => Some(patch(piece)),
        _ => None,
    });
    TestSurface { name: "teapot", pieces: pieces.collect(), cells: [4, 8, 16, 32] }
}

/// The vertices of the grid.
#[derive(Clone, Copy, PartialEq)]
enum MeshKind {
    Regular,
    Jittered,
    Slivers,
}

/// A mesh and the true normal of each vertex.
#[derive(Default)]
struct SampledMesh {
    positions: Vec<Vec3>,
    normals: Vec<Option<DVec3>>,
    indices: Vec<u32>,
}

impl SampledMesh {
    fn new(shape: &TestSurface, cells: usize, kind: MeshKind) -> Self {
        let mut sample = Self::default();
        for piece in &shape.pieces {
            sample.add(piece, [cells * piece.aspect, cells], kind);
        }
        sample
    }

    fn add(&mut self, piece: &ParameterPiece, cells: [usize; 2], kind: MeshKind) {
        let first = self.positions.len();
        for i in 0..=cells[0] {
            for j in 0..=cells[1] {
                let [u, v] = parameters(piece, cells, [i, j], kind);
                let (p, n) = (piece.at)(u, v);
                self.positions.push(p.as_vec3());
                self.normals.push(n);
            }
        }
        let begun = self.indices.len();
        for i in 0..cells[0] {
            for j in 0..cells[1] {
                let a = (first + i * (cells[1] + 1) + j) as u32;
                let (b, c) = (a + 1, a + cells[1] as u32 + 1);
                let d = c + 1;
                let other = kind != MeshKind::Regular && random(u64::from(a) ^ 0xd1a6) < 0.5;
                let two = if other { [[a, b, d], [a, d, c]] } else { [[a, b, c], [b, d, c]] };
                for triangle in two {
                    self.add_triangle(triangle);
                }
            }
        }
        self.turn_outward(begun);
    }

    fn add_triangle(&mut self, triangle: [u32; 3]) {
        let [a, b, c] = triangle.map(|i| self.positions[i as usize]);
        if a != b && b != c && c != a {
            self.indices.extend(triangle);
        }
    }

    /// Winds the triangles from `begun` on so that most of them agree with the true normals.
    fn turn_outward(&mut self, begun: usize) {
        let agreement = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| self.positions[i as usize].as_dvec3());
            let n = triangle.iter().filter_map(|&i| self.normals[i as usize]).sum::<DVec3>();
            (b - a).cross(c - a).dot(n)
        };
        if self.indices[begun..].as_chunks::<3>().0.iter().map(agreement).sum::<f64>() < 0.0 {
            self.indices[begun..].as_chunks_mut::<3>().0.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
    }

    /// The vertices that are measured: those inside the surface, where it is smooth, that some triangle uses.
    fn asked(&self) -> Vec<(usize, DVec3)> {
        let key = |i: u32| self.positions[i as usize].to_array().map(|x| (x + 0.0).to_bits());
        let mut sides = HashMap::new();
        for &[a, b, c] in self.indices.as_chunks::<3>().0 {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let (from, to) = (key(from), key(to));
                *sides.entry((from.min(to), from.max(to))).or_insert(0) += 1;
            }
        }
        let mut out: HashSet<[u32; 3]> =
            sides.iter().filter(|(_, n)| **n == 1).flat_map(|((a, b), _)| [*a, *b]).collect();
        let used: HashSet<u32> = self.indices.iter().copied().collect();
        let mut truth: HashMap<[u32; 3], DVec3> = HashMap::new();
        for &i in &used {
            let smooth = self.normals[i as usize].is_some_and(|n| truth.entry(key(i)).or_insert(n).dot(n) > 1.0 - 1e-6);
            if !smooth {
                out.insert(key(i));
            }
        }
        let mut asked: Vec<u32> = used.into_iter().filter(|&i| !out.contains(&key(i))).collect();
        asked.sort_unstable();
        asked.into_iter().filter_map(|i| Some((i as usize, self.normals[i as usize]?))).collect()
    }
}

/// The parameters of a vertex of the grid. Open ends stay at 0 and 1; closed ends coincide.
fn parameters(piece: &ParameterPiece, cells: [usize; 2], at: [usize; 2], kind: MeshKind) -> [f64; 2] {
    let place = [0, 1].map(|k| if piece.closed[k] { at[k] % cells[k] } else { at[k] });
    let inside = |k: usize| piece.closed[k] || (place[k] > 0 && place[k] < cells[k]);
    let [u, v] = [0, 1].map(|k| place[k] as f64 / cells[k] as f64);
    if kind == MeshKind::Regular || !inside(0) || !inside(1) {
        return [u, v];
    }
    let [du, dv] = cells.map(|count| 0.5 / count as f64);
    let sides = [
        (piece.at)(u - du, v).0.distance((piece.at)(u + du, v).0),
        (piece.at)(u, v - dv).0.distance((piece.at)(u, v + dv).0),
    ];
    let shorter = sides[0].min(sides[1]);
    let shift = |k: usize| {
        let part = if kind == MeshKind::Slivers { 1.0 } else { shorter / sides[k] };
        let key = (place[0] as u64) << 32 | (place[1] as u64) << 1 | k as u64;
        (0.7 * random(key ^ 0x0005_eed0) - 0.35) * part / cells[k] as f64
    };
    [u + shift(0), v + shift(1)]
}

/// Mean and worst angle in degrees.
fn errors(sample: &SampledMesh, weighting: NormalWeighting) -> [f64; 2] {
    let mesh = Mesh::new(sample.positions.clone(), sample.indices.clone()).expect("a mesh of finite numbers");
    let (mesh, _) = mesh.with_normals(Normals::Weighted(weighting));
    let asked = sample.asked();
    let angle = |&(vertex, truth): &(usize, DVec3)| {
        let n = mesh.normals()[vertex].as_dvec3();
        n.cross(truth).length().atan2(n.dot(truth)).to_degrees()
    };
    let (sum, worst) = asked.iter().map(angle).fold((0.0, 0.0_f64), |(sum, worst), a| (sum + a, worst.max(a)));
    [sum / asked.len() as f64, worst]
}

fn main() {
    let csv = std::env::args().nth(1).is_some_and(|argument| argument == "csv");
    if csv {
        println!("surface,mesh,triangles,weighting,mean_degrees,worst_degrees");
    } else {
        println!("| surface | mesh | triangles | uniform | area | angle | Max |\n|---|---|--:|--:|--:|--:|--:|");
    }
    let shapes = [
        ellipsoid("sphere", DVec3::ONE),
        torus(),
        ellipsoid("ellipsoid", DVec3::new(1.0, 0.6, 0.3)),
        teapot(),
        cubic(),
    ];
    let mut ratios: [[Vec<f64>; 2]; 4] = Default::default();
    for shape in &shapes {
        for (mesh, kind) in
            [("regular", MeshKind::Regular), ("jittered", MeshKind::Jittered), ("slivers", MeshKind::Slivers)]
        {
            for cells in shape.cells {
                let sample = SampledMesh::new(shape, cells, kind);
                let triangles = sample.indices.len() / 3;
                let found = WEIGHTINGS.map(|weighting| errors(&sample, weighting));
                for kind in 0..2 {
                    let best = found.iter().map(|errors| errors[kind]).fold(f64::INFINITY, f64::min);
                    found.iter().zip(&mut ratios).for_each(|(errors, ratios)| ratios[kind].push(errors[kind] / best));
                }
                if csv {
                    for (weighting, [mean, worst]) in WEIGHTINGS.iter().zip(found) {
                        println!("{},{mesh},{triangles},{weighting:?},{mean:.6},{worst:.6}", shape.name);
                    }
                } else {
                    let cells = found.map(|[mean, worst]| format!("{mean:.3} / {worst:.3}"));
                    println!("| {} | {mesh} | {triangles} | {} |", shape.name, cells.join(" | "));
                }
            }
        }
    }
    if !csv {
        println!("| how often best, mean / worst | | | {} |", ratios.each_ref().map(best).join(" | "));
        println!("| median ratio to the best | | | {} |", ratios.each_mut().map(median).join(" | "));
    }
}

fn best(ratios: &[Vec<f64>; 2]) -> String {
    let [mean, worst] = ratios.each_ref().map(|all| all.iter().filter(|ratio| **ratio <= 1.0).count());
    format!("{mean} / {worst}")
}

fn median(ratios: &mut [Vec<f64>; 2]) -> String {
    let [mean, worst] = ratios.each_mut().map(|all| {
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    });
    format!("{mean:.2} / {worst:.2}")
}
