//! Projections: rays, clip space and the frustum say the same of a point.

use glam::Vec3;
use halfway_lighting::equations::{Eye, ShadedPoint, view_vector};
use halfway_lighting::{Camera, Film, Lens, Projection, Viewer};
use proptest::prelude::*;

const SIZE: [u32; 2] = [160, 90];

fn any_projection() -> impl Strategy<Value = Projection> {
    let perspective = (0.05_f32..3.0, 0.01_f32..2.0, any_film())
        .prop_map(|(fov_y, near, film)| Projection::Perspective { fov_y, near, film });
    let orthographic = (0.1_f32..20.0, -5.0_f32..5.0, prop::option::of(0.5_f32..20.0), any_film()).prop_map(
        |(height, near, span, film)| Projection::Orthographic { height, near, far: span.map(|span| near + span), film },
    );
    prop_oneof![perspective, orthographic]
}

fn any_film() -> impl Strategy<Value = Film> {
    let film = ([-2.0_f32..2.0, -2.0..2.0], prop::option::of(0.2_f32..5.0), 0.4_f32..2.5)
        .prop_map(|(shift, aspect, pixel_aspect)| Film { shift, aspect, pixel_aspect });
    prop_oneof![Just(Film::DEFAULT), film]
}

fn any_point() -> impl Strategy<Value = [f64; 3]> {
    [-20.0..20.0, -20.0..20.0, -30.0..10.0]
}

/// Whether the picture shows a point, by clip space.
fn is_shown(lens: &Lens<f64>, p: [f64; 3]) -> bool {
    let [x, y, _, w] = lens.clip_from_eye(p);
    w > 0.0 && x.abs() <= w && y.abs() <= w && lens.shows(-p[2])
}

proptest! {
    #[test]
    fn the_ray_through_a_point_leads_to_it(projection in any_projection(), p in any_point()) {
        let lens: Lens<f64> = projection.lens(SIZE);
        let depth = -p[2];
        prop_assume!(lens.shows(depth));
        let [x, y, _, w] = lens.fitted([depth - 1.0, depth + 1.0]).clip_from_eye(p);
        let ray = lens.ray([x / w, y / w]);
        for ((origin, direction), expected) in ray.origin.iter().zip(&ray.direction).zip(p) {
            let found = origin + depth * direction;
            prop_assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{found} for {expected}");
        }
    }

    #[test]
    fn depth_is_reversed_and_within_its_range(projection in any_projection(), p in any_point(), further in 0.01..5.0_f64) {
        let lens: Lens<f64> = projection.lens(SIZE);
        let [near, far] = [-p[2], -p[2] + further];
        prop_assume!(lens.shows(near) && lens.shows(far));
        let lens = lens.fitted([near, far]);
        let depth_of = |depth: f64| {
            let [_, _, z, w] = lens.clip_from_eye([p[0], p[1], -depth]);
            z / w
        };
        prop_assert!(depth_of(near) > depth_of(far) && depth_of(near) <= 1.0 + 1e-12 && depth_of(far) >= 0.0);
        prop_assert!(lens.nearness(near) > lens.nearness(far));
    }

    #[test]
    fn a_frustum_leaves_out_no_sphere_of_which_a_point_shows(
        projection in any_projection(),
        center in any_point(),
        radius in 0.0..4.0_f64,
        direction in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
        share in 0.0..1.0_f64,
    ) {
        let lens: Lens<f64> = projection.lens(SIZE);
        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        prop_assume!(length > 1e-3);
        let point = [0, 1, 2].map(|axis| center[axis] + share * radius * direction[axis] / length);
        prop_assert!(lens.sees(center, radius) || !is_shown(&lens, point));
        prop_assert!(!lens.holds(center, radius) || is_shown(&lens, point));
        let single: Lens = projection.lens(SIZE);
        prop_assert!(single.sees(center.map(|x| x as f32), radius as f32 + 1e-4) || !is_shown(&lens, point));
    }

    #[test]
    fn no_step_is_larger_on_the_picture_than_its_bound(
        projection in any_projection(),
        at in [-1.0..1.0_f64, -1.0..1.0],
        behind in 0.0..20.0_f64,
        radius in 0.0..2.0_f64,
        direction in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
        offset in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
    ) {
        let lens: Lens<f64> = projection.lens(SIZE);
        let within = offset.iter().map(|x| x * x).sum::<f64>().sqrt().max(1.0);
        let (ray, depth) = (lens.ray(at), lens.near + behind);
        prop_assume!(lens.shows(depth));
        let p = [0, 1, 2].map(|axis| ray.origin[axis] + depth * ray.direction[axis]);
        let center = [0, 1, 2].map(|axis| p[axis] - radius * offset[axis] / within);
        let step = [0, 1, 2].map(|axis| 1e-6 * direction[axis]);
        let pixel = |p: [f64; 3]| {
            let [x, y, _, w] = lens.clip_from_eye(p);
            [x / w * 80.0, y / w * 45.0]
        };
        let (a, b) = (pixel(p), pixel([0, 1, 2].map(|axis| p[axis] + step[axis])));
        let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
        let found = ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt();
        let most = lens.largest_step(lens.pixels_at_unit_w([160.0, 90.0]) * length, (center, radius));
        prop_assert!(found <= most * (1.0 + 1e-3) + 1e-9, "{found} of {most}");
    }
}

#[test]
fn planes_lie_at_both_ends_of_the_depth_buffer() {
    let lens: Lens<f64> =
        Projection::Orthographic { height: 2.0, near: -3.0, far: Some(5.0), film: Film::DEFAULT }.lens(SIZE);
    let depth_of = |lens: &Lens<f64>, depth: f64| {
        let [_, _, z, w] = lens.clip_from_eye([0.0, 0.0, -depth]);
        z / w
    };
    assert_eq!([-3.0, 1.0, 5.0].map(|depth| depth_of(&lens, depth)), [1.0, 0.5, 0.0]);
    let lens: Lens<f64> = Projection::perspective(1.0).with_near(0.5).lens(SIZE);
    assert_eq!([0.5, 1.0, 1e9].map(|depth| depth_of(&lens, depth)), [1.0, 0.5, 5e-10]);
}

#[test]
fn a_fitted_lens_spans_the_objects_and_cuts_where_it_cut() {
    let lens: Lens = Projection::orthographic(2.0).with_near(1.0).lens(SIZE);
    let fitted = lens.fitted([-4.0, 9.0]);
    assert!(fitted.near == 1.0 && fitted.far > 9.0 && fitted.far < 11.0, "{fitted:?}");
    let fitted = lens.fitted([100.0, 101.0]);
    assert!(fitted.near > 99.0 && fitted.near < 100.0, "{fitted:?}");
    for depths in [[f32::INFINITY, f32::NEG_INFINITY], [1.0, 1.0], [0.0, 0.0], [1e30, 1e30]] {
        let fitted = lens.fitted(depths);
        assert!(fitted.far > fitted.near && fitted.far.is_finite(), "{depths:?}: {fitted:?}");
    }
}

#[test]
fn an_orthographic_viewer_is_in_one_direction_everywhere() {
    for p in [[0.0, 0.0, -1.0], [3.0, -2.0, -5.0], [1.0, 1.0, 4.0]] {
        let surface = ShadedPoint { position: p, normal: [0.0, 0.0, 1.0] };
        for viewer in [Viewer::Local, Viewer::Infinite] {
            let camera = Camera { viewer, ..Camera::orthographic(3.0) };
            let eye: Eye<f64> = camera.eye();
            assert_eq!(view_vector(&surface, &eye), [0.0, 0.0, 1.0]);
        }
    }
    assert!(Camera::default().eye::<f32>().is_local());
}

#[test]
fn bad_projections_are_refused_and_named() {
    let of = |projection| Camera { projection, ..Camera::default() }.validate().expect_err("a bad one").to_string();
    let orthographic = |height, near, far| Projection::Orthographic { height, near, far, film: Film::DEFAULT };
    let film = |film| Projection::default().with_film(film);
    for (projection, expected) in [
        (Projection::perspective(4.0), "Camera.projection.fov_y: the value is 4.0"),
        (Projection::default().with_near(0.0), "Camera.projection.near: the value is 0.0"),
        (orthographic(0.0, 0.0, None), "Camera.projection.height: the value is 0.0"),
        (orthographic(1.0, f32::NAN, None), "Camera.projection.near: the value is NaN"),
        (film(Film { shift: [0.0, 1e9], ..Film::DEFAULT }), "Camera.projection.film.shift: the value is 1000000000.0"),
        (film(Film { aspect: Some(0.0), ..Film::DEFAULT }), "Camera.projection.film.aspect: the value is 0.0"),
        (film(Film { pixel_aspect: -1.0, ..Film::DEFAULT }), "Camera.projection.film.pixel_aspect: the value is -1.0"),
        (Projection::intrinsics([0.0; 2], [0.0; 2], [4, 4]), "Camera.projection.film.shift: the value is NaN"),
        (
            orthographic(1.0, 2.0, Some(2.0)),
            "Camera.projection.far: the value is 2.0; expected a finite number above near",
        ),
    ] {
        assert!(of(projection).starts_with(expected), "{}", of(projection));
    }
    assert!(orthographic(1.0, -2.0, Some(-1.0)).validate().is_ok());
}

#[test]
fn framing_shows_a_sphere_wholly_and_as_large_as_it_can() {
    let center = Vec3::new(3.0, -1.0, 7.0);
    let film = Film { shift: [0.7, -0.3], aspect: Some(1.6), pixel_aspect: 0.8 };
    let plain = [Camera::default(), Camera::perspective(2.0), Camera::orthographic(1.0).with_near(-3.0)];
    let shifted = plain.map(|camera| Camera { projection: camera.projection.with_film(film), ..camera });
    for camera in plain.into_iter().chain(shifted) {
        for direction in [Vec3::NEG_Z, Vec3::NEG_Y, Vec3::Y, Vec3::new(1.0, -2.0, 0.5), Vec3::ZERO] {
            for radius in [1e-3, 1.0, 1e4] {
                let (camera, place) = camera.framing((center, radius), direction);
                camera.validate().expect("a camera that can be used");
                let eye = place.rotation.inverse() * (center - place.translation);
                let lens: Lens = camera.projection.lens([100, 100]);
                let holds = |share: f32| lens.holds(eye.to_array(), share * radius);
                let error = 2e-5 * (eye.length() + center.length()) / radius;
                assert!(holds(0.999 - error), "{camera:?} {direction} {radius}");
                assert!(!holds(1.01 + error), "{camera:?} {direction} {radius}");
            }
        }
    }
}

/// Where a lens puts a point, in pixels from the upper left corner.
fn pixel(lens: &Lens<f64>, [columns, rows]: [u32; 2], p: [f64; 3]) -> [f64; 2] {
    let [x, y, _, w] = lens.clip_from_eye(p);
    [0.5 * f64::from(columns) * (1.0 + x / w), 0.5 * f64::from(rows) * (1.0 - y / w)]
}

#[test]
fn intrinsics_put_points_where_a_calibrated_camera_sees_them() {
    let (focal, center, size) = ([812.5_f32, 790.25], [301.5_f32, 255.75], [640_u32, 480]);
    let projection = Projection::intrinsics(focal, center, size);
    let lens = projection.lens(size);
    for p in [[0.0, 0.0, -1.0], [0.3, -0.2, -1.5], [-4.0, 2.0, -20.0]] {
        let expected = [
            f64::from(center[0]) + f64::from(focal[0]) * p[0] / -p[2],
            f64::from(center[1]) - f64::from(focal[1]) * p[1] / -p[2],
        ];
        let found = pixel(&lens, size, p);
        // The field of view is an f32.
        assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 2e-4), "{found:?} for {expected:?}");
        // Twice as large, and on a wider and a higher sheet, which has as much more on both sides.
        let twice = pixel(&projection.lens([1280, 960]), [1280, 960], p);
        let wide = pixel(&projection.lens([740, 480]), [740, 480], p);
        let high = pixel(&projection.lens([640, 600]), [640, 600], p);
        for axis in 0..2 {
            assert!((twice[axis] - 2.0 * found[axis]).abs() < 1e-9);
            let [aside, above] = [[50.0, 0.0], [0.0, 60.0]].map(|more| found[axis] + more[axis]);
            assert!((wide[axis] - aside).abs() < 1e-4, "{} for {aside}", wide[axis]);
            assert!((high[axis] - above).abs() < 1e-4, "{} for {above}", high[axis]);
        }
    }
    assert!((lens.pixels_at_unit_w([640.0, 480.0]) - 812.5).abs() < 1e-3);
}

#[test]
fn frusta_meet_their_corners() {
    let lens: Lens<f64> = Projection::frustum([-0.25, 1.0], [0.5, 1.0], 0.5).lens([250, 100]);
    for (p, expected) in [([-0.25, 0.5, -0.5], [-1.0, -1.0]), ([4.0, 4.0, -2.0], [1.0, 1.0])] {
        let [x, y, _, w] = lens.clip_from_eye(p);
        assert!((x / w - expected[0]).abs() < 1e-6 && (y / w - expected[1]).abs() < 1e-6, "{x} {y} {w}");
    }
    assert_eq!(lens.near, 0.5);
}

#[test]
fn an_orthographic_picture_shows_its_aspect_whatever_its_own() {
    // A camera of glTF with xmag 3 and ymag 1.
    let film = Film { aspect: Some(3.0), ..Film::DEFAULT };
    let projection = Projection::orthographic(2.0).with_film(film);
    for (size, [width, height]) in [([300, 100], [6.0, 2.0]), ([400, 100], [8.0, 2.0]), ([100, 100], [6.0, 6.0])] {
        let [x, y] = projection.half_extent(size);
        assert!((2.0 * x - width).abs() < 1e-12 && (2.0 * y - height).abs() < 1e-12, "{size:?}: {x} {y}");
    }
}

#[test]
fn the_matrix_is_the_map_to_clip_space() {
    let film = Film { shift: [0.3, -0.8], aspect: None, pixel_aspect: 1.5 };
    for projection in [Projection::default(), Projection::orthographic(3.0)] {
        let lens: Lens<f64> = projection.with_film(film).lens(SIZE).fitted([1.0, 9.0]);
        let (p, columns) = ([0.7, -0.4, -3.0], lens.matrix());
        let product = [0, 1, 2, 3]
            .map(|row| columns[0][row] * p[0] + columns[1][row] * p[1] + columns[2][row] * p[2] + columns[3][row]);
        for (found, expected) in product.iter().zip(lens.clip_from_eye(p)) {
            assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
        }
    }
}
