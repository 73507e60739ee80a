//! Nets of control points, and their subdivision.

use std::ops::{Add, Mul};

/// Control points of a Bézier patch, row by row, in space or as a ray sees them.
#[derive(Clone, Debug)]
pub(super) struct Net<P> {
    pub(super) columns: usize,
    pub(super) points: Vec<P>,
}

impl<P: Copy + Add<Output = P> + Mul<f64, Output = P>> Net<P> {
    fn rows(&self) -> usize {
        self.points.len() / self.columns
    }

    /// The halves between rows where `axis` is 0, between columns where it is 1.
    pub(super) fn split(&self, axis: usize) -> [Self; 2] {
        let (rows, columns) = (self.rows(), self.columns);
        if axis == 0 {
            self.split_curves((0..columns).map(|column| (column, columns)), rows)
        } else {
            self.split_curves((0..rows).map(|row| (row * columns, 1)), columns)
        }
    }

    /// Cuts each of the curves that begin at an index and continue by a step in the middle, by de Casteljau's
    /// algorithm.
    fn split_curves(&self, curves: impl Iterator<Item = (usize, usize)>, count: usize) -> [Self; 2] {
        let (mut first, mut second) = (self.clone(), self.clone());
        for (start, step) in curves {
            let at = |i: usize| start + i * step;
            // `second` shrinks to its last point from the left; the points that it loses first are `first`.
            for end in 1..count {
                for i in 0..count - end {
                    second.points[at(i)] = (second.points[at(i)] + second.points[at(i + 1)]) * 0.5;
                }
                first.points[at(end)] = second.points[at(0)];
            }
        }
        [first, second]
    }

    /// The same net of other points.
    pub(super) fn mapped<Q>(&self, map: impl Fn(P) -> Q) -> Net<Q> {
        Net { columns: self.columns, points: self.points.iter().map(|&p| map(p)).collect() }
    }

    /// The four corners: the ends of the first row, then of the last.
    pub(super) fn corners(&self) -> [P; 4] {
        let (last, end) = (self.columns - 1, self.points.len() - 1);
        [0, last, end - last, end].map(|i| self.points[i])
    }
}

/// The longest path along the control points, from row to row and along a row.
pub(super) fn spans<P: Copy>(net: &Net<P>, distance: impl Fn(P, P) -> f64) -> [f64; 2] {
    let (columns, last_row) = (net.columns, net.points.len() - net.columns);
    let way = |start: usize, step: usize, end: usize| -> f64 {
        (start..end).step_by(step).map(|i| distance(net.points[i], net.points[i + step])).sum()
    };
    let down = (0..columns).map(|column| way(column, columns, last_row + column)).fold(0.0, f64::max);
    let across = (0..net.points.len()).step_by(columns).map(|i| way(i, 1, i + columns - 1)).fold(0.0, f64::max);
    [down, across]
}
