//! The filters' charts, at a size that takes seconds: what must hold whatever the machine.

use halfway::texture::FarNormals;
use halfway_chart::Filters;
use halfway_chart::filters::{
    BILINEAR, FILTERS, FilterPlan, FilterView, MeasuredFilters, RoughSurface, far_normals_name,
};
use halfway_chart::measure::MeasureProgress;
use std::sync::OnceLock;

const PLAN: FilterPlan = FilterPlan { size: [48, 36], frames: 3, rounds: 2, tolerance: 1e-4 };

fn found() -> &'static Filters {
    static FOUND: OnceLock<Filters> = OnceLock::new();
    FOUND.get_or_init(|| {
        let mut units = 0;
        let mut tell = |done: u64, _: &str| units = done;
        let found = Filters::measure(PLAN, &mut MeasureProgress::new(&mut tell)).expect("filters can be measured");
        assert_eq!(units, PLAN.units());
        found
    })
}

fn rms(image: &MeasuredFilters, filter: &str, view: usize) -> f64 {
    let place = FILTERS.iter().position(|of| of.name == filter).expect("a filter of this name");
    image.figures[place].rms_by_view[view]
}

#[test]
fn summed_areas_are_exact_where_the_footprint_is_upright() {
    for image in &found().images {
        assert_eq!(FilterView::ALL[0], FilterView { tilt: 0.0, turn: 0.0 });
        // The truth is exact there, too.
        let error = rms(image, "summed areas", 0);
        assert!(error < 1e-6 && rms(image, "trilinear", 0) > error, "{:?}: {error}", image.image);
    }
}

#[test]
fn who_knows_the_footprints_shape_errs_less_toward_the_horizon() {
    for image in &found().images {
        for view in [6, 7] {
            let [none, linear, probes, ellipse] =
                ["bilinear", "trilinear", "16 probes", "elliptical mean"].map(|filter| rms(image, filter, view));
            assert!(
                probes < linear && ellipse < linear && linear < none,
                "{:?}: {none} {linear} {probes} {ellipse}",
                image.image
            );
        }
        // Along the axes a rectangle has the footprint's shape; turned, it has not.
        assert!(rms(image, "ripmap", 6) < rms(image, "trilinear", 6), "{:?}", image.image);
    }
}

#[test]
fn levels_keep_the_moving_picture_steady() {
    for image in &found().images {
        let shimmer =
            |filter: &str| image.figures[FILTERS.iter().position(|of| of.name == filter).expect("it")].shimmer;
        assert!(shimmer("trilinear") < 0.5 * shimmer("bilinear"), "{:?}", image.image);
        assert!(shimmer("bilinear") <= 1.1 * shimmer("nearest"), "{:?}", image.image);
    }
}

#[test]
fn the_page_and_the_tables_have_every_filter() {
    let files = found().files().expect("files can be made");
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    let of_filters = ["filters-rms.svg", "filters-shimmer.svg", "filters-flip.svg"];
    let of_highlights = ["highlights-rms.svg", "highlights-shimmer.svg"];
    let expected = [&["filters.html", "filters.csv", "highlights.csv"][..], &of_filters, &of_highlights].concat();
    assert_eq!(names, expected);
    let images = found().images.len();
    assert_eq!(files[1].1.lines().count(), 1 + images * FILTERS.len());
    let surfaces = found().highlights.len();
    assert_eq!(files[2].1.lines().count(), 1 + surfaces * FarNormals::ALL.len() * FilterPlan::TEXELS.len());
    // A picture of each filter and of the truth, and so of highlights.
    let pictures = images * (FILTERS.len() + 1) + surfaces * (FarNormals::ALL.len() + 1);
    assert_eq!(files[0].1.matches("data:image/jpeg;base64,").count(), pictures);
    let markdown = found().markdown();
    for filter in FILTERS {
        assert_eq!(markdown.matches(&format!("\n| {} |", filter.name)).count(), 2 * images, "{}", filter.name);
    }
    // Pictures are text, too, which may spell anything.
    assert!(!files[1..].iter().any(|(_, text)| text.contains("NaN")));
}

#[test]
fn highlights_from_afar_are_nearer_and_steadier_by_toksvig_and_lean() {
    for surface in &found().highlights {
        let name = surface.surface.name();
        let [mean, toksvig, lean] = &surface.figures;
        let far = FilterPlan::TEXELS.len() - 1;
        for other in [toksvig, lean] {
            assert!(other.rms[far] < 0.5 * mean.rms[far], "{name}: {:?}, {:?} by the mean", other.rms, mean.rms);
            assert!(other.ratio.median > 0.0, "{name}: {:?}", other.ratio);
        }
        if surface.surface == RoughSurface::Furrows {
            assert!(lean.rms[far] < 0.6 * toksvig.rms[far], "{name}: {:?}, {:?} by Toksvig", lean.rms, toksvig.rms);
        }
        assert!((mean.ratio.median - 1.0).abs() < 1e-12);
        for (far, figures) in FarNormals::ALL.into_iter().zip(&surface.figures) {
            println!("{name}, {}: RMS {:.4?}, shimmer {:.4?}", far_normals_name(far), figures.rms, figures.shimmer);
        }
    }
}

#[test]
fn the_bilinear_filter_takes_its_own_time() {
    for image in &found().images {
        assert!((image.figures[BILINEAR].ratio.median - 1.0).abs() < 1e-12);
        let front = image.front(|figures| figures.rms);
        assert!(!front.is_empty());
        for (i, a) in image.figures.iter().enumerate() {
            let beaten = image.figures.iter().any(|b| b.ratio.median < a.ratio.median && b.rms < a.rms);
            assert!(!(beaten && front.contains(&i)), "{}", FILTERS[i].name);
        }
    }
}
