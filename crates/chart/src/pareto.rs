//! Pareto fronts of time and error.

use crate::figure::{Panel, Point, Series, Style};

// ANCHOR: front
/// The indices of the points (time, error) that no other point dominates, the fastest first. Of equal points the first
/// counts.
pub(crate) fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let ((time_a, error_a), (time_b, error_b)) = (points[a], points[b]);
        time_a.total_cmp(&time_b).then(error_a.total_cmp(&error_b))
    });
    let mut least = f64::INFINITY;
    order.retain(|&i| {
        let is_nearer = points[i].1 < least;
        least = least.min(points[i].1);
        is_nearer
    });
    order
}
// ANCHOR_END: front

/// A panel of time and error: dominated points are pale, and a line in steps joins the front, since each time allows
/// the least error of everything that takes no longer.
pub(crate) fn front_panel(title: impl Into<String>, mut series: Vec<Series>) -> Panel {
    series.retain(|series| !series.points.is_empty());
    let places: Vec<(usize, usize)> =
        series.iter().enumerate().flat_map(|(i, series)| (0..series.points.len()).map(move |k| (i, k))).collect();
    let points: Vec<(f64, f64)> = places.iter().map(|&(i, k)| (series[i].points[k].x, series[i].points[k].y)).collect();
    for point in series.iter_mut().flat_map(|series| &mut series.points) {
        point.faded = true;
    }
    let mut line: Vec<Point> = Vec::new();
    for (i, k) in front(&points).into_iter().map(|place| places[place]) {
        let point = &mut series[i].points[k];
        point.faded = false;
        let point = Point::new(point.x, point.y, String::new());
        let corner = line.last().map(|last| Point { x: point.x, ..last.clone() });
        line.extend(corner.into_iter().chain([point]));
    }
    // The front is drawn on top.
    for series in &mut series {
        series.points.sort_by_key(|point| !point.faded);
    }
    series.insert(0, Series { name: "front".to_owned(), style: Style::gray(0x55), points: line });
    Panel::new(title, series)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_not_dominated() {
        assert_eq!(front(&[(1.0, 5.0), (2.0, 6.0), (1.5, 2.0), (3.0, 0.4)]), [0, 2, 3]);
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0), (2.0, 1.0), (1.0, 2.0)]), [0], "of equal points one stays");
        assert!(front(&[]).is_empty());
    }

    #[test]
    fn panels_fade_dominated_points_and_join_the_front() {
        let points = |all: &[(f64, f64)]| Series {
            name: "some".to_owned(),
            style: Style::gray(0),
            points: all.iter().map(|&(x, y)| Point::new(x, y, String::new())).collect(),
        };
        let panel = front_panel("", vec![points(&[(1.0, 5.0), (2.0, 6.0)]), points(&[(1.5, 2.0)])]);
        let [line, some, others] = &panel.series[..] else { panic!("the front and two series") };
        let corners: Vec<_> = line.points.iter().map(|point| (point.x, point.y)).collect();
        assert_eq!(corners, [(1.0, 5.0), (1.5, 5.0), (1.5, 2.0)]);
        let faded: Vec<_> = some.points.iter().chain(&others.points).map(|point| (point.x, point.faded)).collect();
        assert_eq!(faded, [(2.0, true), (1.0, false), (1.5, false)]);
    }
}
