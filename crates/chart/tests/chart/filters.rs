//! The filters' charts, at a size that takes seconds: properties that hold on every machine.

use std::sync::OnceLock;

use halfway_chart::Progress;
use halfway_chart::filters::{BILINEAR, FILTERS, FilterPlan, FilterView, Filters, MeasuredFilters};

const PLAN: FilterPlan = FilterPlan { size: [32, 24], frames: 3, rounds: 2, tolerance: 1e-4 };

fn found() -> &'static Filters {
    static FOUND: OnceLock<Filters> = OnceLock::new();
    FOUND.get_or_init(|| {
        let mut units = 0;
        let mut tell = |done: u64, _: &str| units = done;
        let found = Filters::measure(PLAN, &mut Progress::new(&mut tell)).expect("filters can be measured");
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
fn filters_by_shape_err_less_toward_the_horizon() {
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
    let page = found().page();
    let files = page.files();
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["filters.html", "filters-rms.svg", "filters-shimmer.svg", "filters-flip.svg"]);
    let images = found().images.len();
    // A picture of each filter and of the truth.
    assert_eq!(files[0].1.matches("data:image/jpeg;base64,").count(), images * (FILTERS.len() + 1));
    let markdown = page.markdown();
    for filter in FILTERS {
        assert_eq!(markdown.matches(&format!("\n| {} |", filter.name)).count(), 2 * images, "{}", filter.name);
    }
    // Pictures are text, too, which may spell anything.
    assert!(!files[1..].iter().any(|(_, text)| text.contains("NaN")));
}

#[test]
fn the_bilinear_filter_takes_its_own_time() {
    let page = found().page();
    // Of RMS errors.
    let panels = &page.sections[0].figures[0].panels;
    assert_eq!(panels.len(), found().images.len());
    for (image, panel) in found().images.iter().zip(panels) {
        assert!((image.figures[BILINEAR].ratio.median - 1.0).abs() < 1e-12);
        let on_front = |name: &str| {
            let series = panel.series.iter().find(|series| series.name == name).expect("every filter is charted");
            !series.points[0].faded
        };
        assert!(FILTERS.iter().any(|filter| on_front(filter.name)));
        for (filter, a) in FILTERS.iter().zip(&image.figures) {
            let beaten = image.figures.iter().any(|b| b.ratio.median < a.ratio.median && b.rms < a.rms);
            assert!(!(beaten && on_front(filter.name)), "{}", filter.name);
        }
    }
}
