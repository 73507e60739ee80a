//! What the pages of failures say, page by page.

use std::sync::OnceLock;

use halfway::prelude::{Reflectance, Shading};
use halfway::render::{Adapter, AdapterChoice};
use halfway_chart::failures::blend_order::{wrong_by, wrong_order};
use halfway_chart::failures::depth::{DepthStored, parted};
use halfway_chart::failures::distances::{self, Distant};
use halfway_chart::failures::near_light::{LampAbove, below_by_formula, near_light};
use halfway_chart::failures::noise::{expected, roughness};
use halfway_chart::failures::outlines::{back_light, brightest_corner, most};
use halfway_chart::failures::provoking::{FlatNormal, errors};
use halfway_chart::failures::rims::{first_met, rim_error, spot_light};
use halfway_chart::failures::slivers::{lantern_error, stretched, turned, turned_by};
use halfway_chart::failures::transforms::{NormalBy, by_the_points, by_the_points_formula, mirrored, when_scaled};
use halfway_chart::failures::{PAGES, all, drawers, edge_on, exponents, layers};
use halfway_chart::front::ChartedAdapter;
use halfway_chart::measure::Line;

/// What draws in these tests, and always the CPU without a driver.
fn all_drawers() -> &'static [ChartedAdapter] {
    static DRAWERS: OnceLock<Vec<ChartedAdapter>> = OnceLock::new();
    DRAWERS.get_or_init(|| {
        let adapter = AdapterChoice::default().open().expect("an adapter");
        drawers(&[ChartedAdapter { name: "the adapter".to_owned(), adapter }]).expect("the CPU draws")
    })
}

/// The slope of the logarithms.
fn slope(points: &[(f64, f64)]) -> f64 {
    Line::order(points, points.len()).expect("two points")
}

fn is_near(what: &str, found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() <= part, "{what}: {found} for {expected}");
}

#[test]
fn every_page_names_a_test_that_there_is() {
    let mut told = 0;
    let pages = all(all_drawers(), |_| told += 1).expect("every page can be made");
    assert_eq!((pages.len() as u64, told), (PAGES, PAGES));
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/failures");
    let files = std::fs::read_dir(folder).expect("the folder is there");
    let mut text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/failures.rs")).expect("this file");
    text.extend(files.map(|file| std::fs::read_to_string(file.expect("an entry").path()).expect("a file")));
    for page in &pages {
        let test = format!("#[test]\nfn {}() {{", page.test);
        let inner = format!("    #[test]\n    fn {}() {{", page.test);
        assert!(text.contains(&test) || text.contains(&inner), "{}: {}", page.id, page.test);
        assert!(!page.pictures.is_empty() && !page.figures.is_empty(), "{}", page.id);
        for (name, figure) in &page.figures {
            assert!(figure.shown().count() > 3, "{}: {name}", page.id);
            assert!(page.figures.len() == 1 || !name.is_empty(), "{}: one of several figures has no name", page.id);
        }
    }
    for names in [pages.iter().map(|page| page.id).collect::<Vec<_>>(), pages.iter().map(|page| page.title).collect()] {
        let mut once = names.clone();
        once.sort_unstable();
        once.dedup();
        assert_eq!(once.len(), names.len(), "{names:?}");
    }
}

/// Light over a triangle is linear in the limit. Over a triangle with corners at vᵢ from its centroid the mean of its
/// square is Σ (g·vᵢ)²/12 about the centroid, and (g·vⱼ)² more about a corner: five times as much in the mean over the
/// corners. The cells of a sphere are plane, so that both triangles of one have the normal of its middle: 3/2 as much
/// as about the centroids of rectangles' halves, where slopes along and across are independent.
#[test]
fn one_corner_is_worse_than_the_face_by_what_triangles_say() {
    let normals =
        [FlatNormal::Face, FlatNormal::Centroid, FlatNormal::Corner(0), FlatNormal::Corner(1), FlatNormal::Corner(2)];
    let [face, centroid, corners @ ..] = errors(32, normals).expect("spheres can be drawn");
    let corner = (corners.iter().map(|error| error * error).sum::<f64>() / 3.0).sqrt();
    // Cells are 7 pixels wide, and the outline bends what is linear in the limit.
    is_near("corner to centroid", corner / centroid, 5f64.sqrt(), 0.05);
    is_near("corner to face", corner / face, (10.0f64 / 3.0).sqrt(), 0.05);
    let points = [8, 16, 32].map(|level| {
        let [face, corner] = errors(level, [FlatNormal::Face, FlatNormal::Corner(0)]).expect("spheres can be drawn");
        (1.0 / f64::from(level), [face, corner])
    });
    for which in [0, 1] {
        let slope = slope(&points.map(|(edge, errors)| (edge, errors[which])));
        assert!((slope - 1.0).abs() < 0.1, "of the first order: {slope}");
    }
}

#[test]
fn light_from_behind_shrinks_with_the_cells() {
    let corners = [8, 16, 32, 64, 128].map(|level| (1.0 / f64::from(level), brightest_corner(level)));
    for (edge, corner) in corners {
        let most = most((1.0 / edge).round() as u32);
        // Some triangle of each outline lies nearly as badly as one may, and none worse.
        assert!(corner > 0.6 * most && corner < most, "{edge}: {corner} of {most}");
    }
    let slope_of_corners = slope(&corners);
    assert!((slope_of_corners - 1.0).abs() < 0.15, "of the first order: {slope_of_corners}");
    let seen = |level, shading| back_light(level, shading).expect("a sphere can be drawn");
    for shading in [Shading::Gouraud, Shading::Phong] {
        for level in [4, 8] {
            let found = seen(level, Some(shading)).brightest;
            assert!(found > 0.5 * brightest_corner(level) && found < brightest_corner(level), "{level}: {found}");
        }
    }
    let lit = [4, 8, 16].map(|level| (1.0 / f64::from(level), seen(level, Some(Shading::Gouraud)).lit));
    assert!((slope(&lit) - 2.0).abs() < 0.4, "the rim narrows by the square: {lit:?}");
    for shading in [Some(Shading::Flat), None] {
        let dark = seen(8, shading);
        assert!(dark.brightest <= 0.0, "{shading:?}: {dark:?}");
    }
}

#[test]
fn flat_shading_is_rougher_by_what_means_save() {
    for sigma in [0.002, 0.01] {
        for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
            let found = roughness(sigma, shading).expect("a sheet can be drawn");
            // Some four thousand vertices, of which neighbours count together: 3 % at twice the standard deviation.
            is_near(&format!("{sigma}, {shading:?}"), found, expected(sigma, shading), 0.06);
        }
    }
}

#[test]
fn thin_triangles_err_by_their_length_and_lanterns_by_their_angles() {
    let found = [16, 8, 4].map(|rows: u32| (1.0 / f64::from(rows), stretched(rows).expect("a square can be drawn")));
    let slope = slope(&found);
    assert!((slope - 2.0).abs() < 0.2, "by the square of the length: {slope}, {found:?}");
    for bands in [2, 16, 128] {
        is_near("the faces of a lantern", turned(bands), turned_by(bands), 1e-3);
    }
    let error = |bands, shading| lantern_error(bands, shading).expect("a lantern can be drawn");
    let [few, many] = [8, 128].map(|bands| error(bands, Shading::Flat));
    assert!(many > 2.0 * few, "finer and worse: {few}, {many}");
    let [few, many] = [8, 128].map(|bands| error(bands, Shading::Phong));
    assert!(many < 0.1 && many < 1.5 * few, "normals of the cylinder: {few}, {many}");
}

#[test]
fn normals_go_by_cofactors_with_the_sign() {
    for stretch in [0.1, 0.5, 1.5, 2.0, 10.0] {
        is_near("stretched", by_the_points(stretch), by_the_points_formula(stretch), 1e-5);
    }
    assert!(by_the_points(1.0) < 1e-9);
    for power in -30..=30 {
        let scale = 10f32.powi(power);
        // A few roundings of f32, in degrees.
        let own = when_scaled(scale, NormalBy::Cofactors);
        assert!(own < 1e-4, "10^{power}: {own}");
        let inverse = when_scaled(scale, NormalBy::Inverse);
        // The determinant is the third power, and f32 ends at 10³⁸.
        assert!(if power.abs() <= 12 { inverse < 1e-4 } else { inverse >= 90.0 }, "10^{power}: {inverse}");
    }
    let [own, unsigned] = mirrored().expect("spheres can be drawn");
    let covered = own.covered().expect("the oracle knows").iter().filter(|here| **here).count();
    let pixels = || own.pixels().iter().zip(unsigned.pixels());
    let lit = pixels().filter(|(own, _)| own[0] > 0.0).count();
    assert!(2 * lit > covered, "{lit} of {covered}");
    assert!(
        pixels().all(|(own, unsigned)| own[0] * unsigned[0] <= 0.0),
        "what is lit is dark, and the other way round"
    );
}

#[test]
fn a_light_near_a_cell_keeps_what_the_formula_says() {
    for height in [0.2, 0.5, 1.0, 3.0] {
        let found = near_light(height, LampAbove::Cell).expect("a square can be drawn");
        // The height is rounded to f32.
        is_near(&format!("{height}"), found.below, below_by_formula(height), 1e-6);
        let found = near_light(height, LampAbove::Vertex).expect("a square can be drawn");
        is_near("a vertex", found.below, 1.0, 1e-6);
    }
    let [cell, vertex] =
        [LampAbove::Cell, LampAbove::Vertex].map(|above| near_light(0.2, above).expect("a square can be drawn").total);
    assert!(cell < 0.7 && vertex > 2.0, "it flickers: {cell}, {vertex}");
    let far = near_light(5.0, LampAbove::Cell).expect("a square can be drawn").total;
    // By a twelfth of the curvature over the light: −6/(12·25).
    is_near("a light that is far enough", far, 1.0, 0.03);
}

#[test]
fn spots_between_vertices_are_lost_and_rims_fall_by_the_root() {
    for cells in [9, 17, 33] {
        let light = |cutoff: f64| spot_light(cells, cutoff).expect("a square can be drawn");
        assert!(light(0.99 * first_met(cells)) <= 0.0, "{cells}: the cone meets no corner");
        assert!(light(1.01 * first_met(cells)) > 0.5, "{cells}: the cone meets four corners");
    }
    let found = [9, 17, 33, 65].map(|cells| (1.0 / f64::from(cells), rim_error(cells).expect("a square can be drawn")));
    let slope = slope(&found);
    assert!((slope - 0.5).abs() < 0.15, "by the root: {slope}, {found:?}");
}

#[test]
fn errors_grow_with_the_exponent_and_keep_to_its_bound() {
    for ChartedAdapter { name, adapter } in all_drawers() {
        for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong] {
            let found =
                exponents::errors(adapter, reflectance, &exponents::EXPONENTS).expect("highlights can be drawn");
            for (exponent, error) in &found {
                assert!(
                    *error <= exponents::bound(reflectance, *exponent),
                    "{name}, {reflectance:?}, {exponent}: {error}"
                );
            }
            let slope = slope(&found[4..]);
            assert!((slope - 1.0).abs() < 0.35, "{name}, {reflectance:?}: {slope}, {found:?}");
        }
    }
}

#[test]
fn far_viewers_and_near_lights_lose_what_rounding_takes() {
    for ChartedAdapter { name, adapter } in all_drawers() {
        let near = distances::errors(adapter, Distant::Light).expect("a lamp can be drawn");
        // A few roundings of the viewer's distance, 3, over that of the lamp; and of what is computed.
        for (distance, error) in &near {
            let bound = f64::from(f32::EPSILON) * (8.0 + 12.0 / distance);
            assert!(*error < bound, "{name}, light at {distance}: {error}");
        }
        assert!(near[0].1 > 30.0 * near[6].1, "{name}: {near:?}");
        let far = distances::errors(adapter, Distant::Viewer).expect("a lamp can be drawn");
        for (distance, error) in &far {
            // And where the lamp is about to count as being on the surface, it may do so in one and not in the other.
            let bound = f64::from(f32::EPSILON) * (16.0 + 8.0 * distance);
            assert!(*error < bound, "{name}, viewer at {distance}: {error}");
        }
        // From 10 to 100,000 units.
        let slope = slope(&far[4..9]);
        assert!((slope - 1.0).abs() < 0.3, "{name}: {slope}, {far:?}");
    }
    let by_definition = |distance| distances::by_definition(distance).expect("a lamp can be drawn");
    // The angle of view is rounded to f32; farther than that the lamp counts as being on the surface, where light is
    // full.
    assert!(by_definition(4e5) < 1e-5 && by_definition(4e6) > 0.5, "{} {}", by_definition(4e5), by_definition(4e6));
}

#[test]
fn errors_grow_with_one_over_the_angle() {
    for ChartedAdapter { name, adapter } in all_drawers() {
        let found = edge_on::errors(adapter).expect("a square can be drawn");
        for (degrees, error) in &found {
            let bound = 8.0 * edge_on::slip(*degrees) + 16.0 * f64::from(f32::EPSILON);
            assert!(*error < bound, "{name}, {degrees}°: {error}");
        }
        let slope = slope(&found[4..]);
        assert!((slope + 1.0).abs() < 0.5, "{name}: {slope}, {found:?}");
    }
}

#[test]
fn reversed_depth_parts_what_standard_depth_does_not() {
    let distances: Vec<f64> = (1..=17).map(|power| 2f64.powi(power)).collect();
    for ChartedAdapter { name, adapter } in all_drawers() {
        for (distance, gap) in parted(adapter, &distances).expect("squares can be drawn") {
            // What f32 tells apart, and a few roundings on the way to the depth.
            assert!(gap.is_some_and(|gap| gap <= 2f64.powi(-21)), "{name} at {distance}: {gap:?}");
        }
    }
    for distance in distances {
        let gap = DepthStored::Fixed24.gap(distance);
        // d·2⁻²⁴ to the next power of two, and by half a step of rounding more or less.
        let expected = distance * 2f64.powi(-24);
        assert!(gap >= 0.5 * expected && gap <= 4.0 * expected, "{distance}: {gap}");
        assert!(DepthStored::ReversedFloat.gap(distance) <= 2f64.powi(-23));
    }
    assert!(DepthStored::Float.gap(1e5) > 1000.0 * DepthStored::ReversedFloat.gap(1e5));
}

#[test]
fn crossing_objects_are_wrong_by_the_square_of_their_opacity() {
    for opacity in [0.2f32, 0.5, 0.8] {
        let found = wrong_order(opacity).expect("squares can be drawn");
        // Rounded to f32 is the opacity, and nothing else.
        is_near("by how much", found.most, wrong_by(opacity.into()), 1e-6);
        assert!((found.share - 0.5).abs() < 0.02, "half of the pixels: {}", found.share);
    }
}

#[test]
fn thin_layers_stop_short_by_what_roundings_add_up_to() {
    for opacity in [0.5f32, 0.05, 0.005] {
        let o = f64::from(opacity);
        for ChartedAdapter { name, adapter } in all_drawers() {
            // A step a layer at most, and half a step of the last one; on the CPU nothing but the last.
            let bound = if matches!(adapter, Adapter::Cpu(_)) { 0.0 } else { layers::most(o, 1.0) };
            for (count, error) in layers::drawn(adapter, opacity).expect("layers can be drawn") {
                assert!(error <= bound + 0.51, "{name}, {opacity}, {count} layers: {error}");
            }
        }
        for (count, error) in layers::rounded(opacity) {
            assert!(error <= layers::most(o, 0.5), "{opacity}, {count} layers: {error}");
        }
    }
    // Blue of 0.3 at 0.005 is 0.38 of a step, and is never seen; 64 layers should come to 21.
    let lost = 255.0 * layers::exact(layers::LAYERS, 0.005)[2];
    let found = layers::rounded(0.005).last().expect("64 layers").1;
    assert!(lost > 20.0 && found >= lost - 1e-9, "{lost}: {found}");
}
