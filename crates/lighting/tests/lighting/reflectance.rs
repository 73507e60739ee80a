//! The diffuse and specular terms against closed forms in angles.

use halfway_lighting::equations::vector::{dot, length, normalize, scale};
use halfway_lighting::equations::{
    diffuse_term, face_forward, half_vector, interpolated_normal, power, reflect, side_normal, specular_blinn_phong,
    specular_exponent, specular_phong, specular_term,
};
use halfway_lighting::{Reflectance, matched_shininess};

use crate::support::{ALL_REFLECTANCES, Pcg, close, close3, glossy, in_plane};

const N: [f64; 3] = [0.0, 0.0, 1.0];

#[test]
fn power_at_its_edges() {
    let rows: [(&str, f64, f64, f64); 9] = [
        ("0^0", 0.0, 0.0, 1.0),
        ("negative^0", -0.5, 0.0, 1.0),
        ("0^e", 0.0, 3.0, 0.0),
        ("negative^e", -0.5, 2.0, 0.0),
        ("1^e", 1.0, 1e30, 1.0),
        ("x^1", 0.25, 1.0, 0.25),
        ("square root", 0.25, 0.5, 0.5),
        ("a rounded cosine does not grow", 1.000_000_2, 1e30, 1.0),
        ("underflow is 0", 0.5, 1e30, 0.0),
    ];
    for (name, x, e, expected) in rows {
        assert_eq!(power(x, e), expected, "{name}");
        assert_eq!(power(x as f32, e as f32), expected as f32, "{name} in f32");
    }
}

/// l and v in one plane with n, θl and θv away from it on opposite sides: every term is a cosine of known angles.
#[test]
fn terms_are_cosines_of_known_angles() {
    for l_deg in (-85..=85).step_by(5) {
        for v_deg in (-85..=85).step_by(5) {
            let (theta_l, theta_v) = (f64::from(l_deg).to_radians(), f64::from(v_deg).to_radians());
            let (l, v) = (in_plane(theta_l), in_plane(-theta_v));
            let name = format!("l at {l_deg}, v at {v_deg}");
            close(diffuse_term(N, l), theta_l.cos(), 1e-15, &name);
            close3(reflect(l, N), in_plane(-theta_l), 1e-15, &name);
            for exponent in [0.0, 1.0, 2.5, 60.0] {
                // r is at θl on v's side, so r·v = cos(θl − θv); h is at their mean, (θl − θv)/2 from n.
                let off = theta_l - theta_v;
                let phong = if exponent == 0.0 { 1.0 } else { off.cos().max(0.0).powf(exponent) };
                let blinn = (off / 2.0).cos().powf(exponent);
                // Cosines are right to about 2 ε, the power multiplies that by its exponent.
                close(specular_phong(N, l, v, exponent), phong, 3e-14, &name);
                close(specular_blinn_phong(N, l, v, exponent), blinn, 3e-14, &name);
            }
        }
    }
}

#[test]
fn nothing_from_behind() {
    for degrees in [90.0001f64, 120.0, 180.0] {
        let l = in_plane(degrees.to_radians());
        assert_eq!(diffuse_term(N, l), 0.0);
        for reflectance in ALL_REFLECTANCES {
            for shininess in [0.0, 1.0, 50.0] {
                let s = specular_term(reflectance, N, l, in_plane(-1.5), &glossy(shininess));
                assert_eq!(s, 0.0, "{reflectance:?} {shininess} at {degrees}");
            }
        }
    }
    // Exactly grazing: the gate is n·l > 0, so the edge itself is dark.
    assert_eq!(specular_blinn_phong(N, [1.0, 0.0, 0.0], N, 0.0), 0.0);
    assert_eq!(specular_phong(N, [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 1.0), 0.0);
}

#[test]
fn opposite_light_and_view_have_no_halfway_vector() {
    let mut rng = Pcg::new(1);
    for _ in 0..2000 {
        let l = rng.direction();
        let v = scale(l, -1.0);
        assert_eq!(half_vector(l, v), None);
        assert_eq!(specular_blinn_phong(l, l, v, 0.0), 0.0);
        // In f32, opposite vectors that were rounded apart must not make a direction of their rounding errors.
        let [l32, nudged] = [l, v].map(|a| a.map(|x| x as f32));
        let nudged = normalize(nudged).expect("unit");
        assert_eq!(half_vector(l32, nudged), None, "{l32:?}");
    }
    assert!(half_vector(N, in_plane(3.1)).is_some(), "2.4 degrees short of opposite is not opposite");
}

#[test]
fn halfway_and_reflected_vectors_are_unit_and_symmetric() {
    let mut rng = Pcg::new(2);
    for _ in 0..2000 {
        let (n, l, v) = (rng.direction(), rng.direction(), rng.direction());
        let r = reflect(l, n);
        close(length(r), 1.0, 1e-14, "length of r");
        close(dot(r, n), dot(l, n), 1e-14, "r makes l's angle with n");
        close3(reflect(r, n), l, 1e-14, "reflected twice");
        if let Some(h) = half_vector(l, v) {
            close(dot(h, l), dot(h, v), 1e-8, "h makes equal angles");
            // The identity behind the match: mirroring l about h gives v.
            close3(reflect(l, h), v, 1e-8, "l mirrored about h");
        }
    }
}

#[test]
fn exponents_of_the_reflectances() {
    assert_eq!(specular_exponent(Reflectance::Phong, 20.0), 20.0);
    assert_eq!(specular_exponent(Reflectance::BlinnPhong, 20.0), 20.0);
    assert_eq!(specular_exponent(Reflectance::BlinnPhongMatched, 20.0), matched_shininess(20.0));
    let (l, v) = (in_plane(0.4), in_plane(-0.2));
    assert_eq!(specular_term(Reflectance::Phong, N, l, v, &glossy(9.0)), specular_phong(N, l, v, 9.0));
    assert_eq!(specular_term(Reflectance::BlinnPhong, N, l, v, &glossy(9.0)), specular_blinn_phong(N, l, v, 9.0));
    let matched = specular_blinn_phong(N, l, v, matched_shininess(9.0));
    assert_eq!(specular_term(Reflectance::BlinnPhongMatched, N, l, v, &glossy(9.0)), matched);
}

#[test]
fn interpolated_normals_are_unit_or_geometric() {
    let geometric = [0.0, 1.0, 0.0];
    let opposite = scale(in_plane(0.3), -1.0);
    let middle: [f64; 3] = core::array::from_fn(|i| 0.5 * in_plane(0.3)[i] + 0.5 * opposite[i]);
    assert_eq!(interpolated_normal(middle, geometric), geometric, "antipodal vertex normals");
    assert_eq!(interpolated_normal([0.0, 0.0, 1e-8], geometric), geometric, "all but cancelled");
    close3(interpolated_normal([0.0, 0.0, 1e-3], geometric), N, 1e-15, "short, but a direction");
    close3(interpolated_normal([3.0, 0.0, 4.0], geometric), [0.6, 0.0, 0.8], 1e-15, "long");
    assert_eq!(interpolated_normal([f32::NAN; 3], [0.0, 1.0, 0.0]), [0.0, 1.0, 0.0]);
}

#[test]
fn normals_are_turned_to_the_side_seen() {
    let n = in_plane(0.1);
    let back = scale(n, -1.0);
    assert_eq!(face_forward(n, N, N), n, "seen from the front");
    assert_eq!(face_forward(n, N, [0.0, 0.0, -1.0]), back, "seen from behind");
    assert_eq!(face_forward(n, N, [1.0, 0.0, 0.0]), n, "edge on");
    assert_eq!(side_normal(n, true), n);
    assert_eq!(side_normal(n, false), back);
}
