//! Ten colours on the line between two vertices, by Gouraud and by Phong, against the closed form.

use bevy_color::LinearRgba;
use halfway_lighting::equations::vector::normalize;
use halfway_lighting::equations::{Coefficients, Eye, ShadedPoint, interpolated_normal, shade};
use halfway_lighting::{DirectionalLight, Material, Reflectance};

const V1: [f64; 3] = [-80.0, 0.0, 58.0];
const V2: [f64; 3] = [-65.0, -47.0, 58.0];
const N1: [f64; 3] = [-0.80, -0.04, 0.60];
const N2: [f64; 3] = [-0.65, -0.50, 0.60];
/// Toward the light: both normals face it.
const L: [f64; 3] = [-0.30, -2.20, 2.80];

fn lerp(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    core::array::from_fn(|i| a[i] + t * (b[i] - a[i]))
}

/// The red channel of the ten points: Gouraud, Phong.
fn by_the_library() -> Vec<([f64; 3], [f64; 3])> {
    let light = DirectionalLight::new(LinearRgba::rgb(1.0, 0.5, 0.5)).along(L.map(|x| -x)).expect("a direction");
    let red = Coefficients::from(&Material::matte(LinearRgba::RED));
    let color = |position, normal| {
        let surface = ShadedPoint { position, normal };
        shade(&surface, &red, &[light], [0.0; 3], &Eye::Infinite([0.0, 0.0, 1.0]), Reflectance::Phong)
    };
    let [n1, n2] = [N1, N2].map(|n| normalize(n).expect("a normal"));
    let (c1, c2) = (color(V1, n1), color(V2, n2));
    (0..10)
        .map(|i| {
            let t = f64::from(i) / 9.0;
            (lerp(c1, c2, t), color(lerp(V1, V2, t), interpolated_normal(lerp(n1, n2, t), n1)))
        })
        .collect()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[test]
fn ten_colours_by_the_closed_form() {
    // With unit normals a and b at an angle ω and unit l, the normal at t is ((1 − t)a + tb)/√((1 − t)² + 2t(1 − t)cos
    // ω + t²), so that both shadings follow from three scalar products.
    let unit = |a: [f64; 3], b: [f64; 3]| dot(a, b) / (dot(a, a) * dot(b, b)).sqrt();
    let (al, bl, ab) = (unit(N1, L), unit(N2, L), unit(N1, N2));
    for (i, (gouraud, phong)) in by_the_library().into_iter().enumerate() {
        let t = i as f64 / 9.0;
        let numerator = (1.0 - t) * al + t * bl;
        let length = ((1.0 - t).powi(2) + 2.0 * t * (1.0 - t) * ab + t * t).sqrt();
        for (got, expected, name) in [(gouraud, numerator, "Gouraud"), (phong, numerator / length, "Phong")] {
            assert!((got[0] - expected).abs() < 1e-14, "{name} {i}: {} against {expected}", got[0]);
            assert_eq!([got[1], got[2]], [0.0, 0.0], "{name} {i}: a red surface gives back only red");
        }
    }
}

#[test]
fn ten_colours_as_printed() {
    let table = [
        ["0.5615", "0.5615"],
        ["0.5901", "0.5969"],
        ["0.6188", "0.6314"],
        ["0.6474", "0.6646"],
        ["0.6761", "0.6961"],
        ["0.7047", "0.7256"],
        ["0.7334", "0.7528"],
        ["0.7620", "0.7776"],
        ["0.7907", "0.7998"],
        ["0.8193", "0.8193"],
    ];
    let got = by_the_library();
    for (i, ((gouraud, phong), expected)) in got.iter().zip(table).enumerate() {
        assert_eq!([format!("{:.4}", gouraud[0]), format!("{:.4}", phong[0])], expected, "point {i}");
    }
}
