//! The coverage of two pictures, and the pixels that are counted.

use super::bands::Band;

/// The numbers of finite pixels that show an object and the background, if the coverage of both pictures is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coverage {
    /// Covered in both.
    pub both: usize,
    /// Background in both.
    pub neither: usize,
    /// Covered in the actual picture, background in the expected one.
    pub only_actual: usize,
    /// Background in the actual picture, covered in the expected one.
    pub only_expected: usize,
    /// The first pixel, row by row, that exactly one of them covers: column and row.
    pub first_difference: Option<(u32, u32)>,
}

impl Coverage {
    /// Counts a pixel at a place, after those in the rows above and to the left.
    pub(super) fn count(&mut self, kind: Kind, at: (u32, u32)) {
        match kind {
            Kind::Counted => self.both += 1,
            Kind::Background => self.neither += 1,
            Kind::OnlyActual => self.only_actual += 1,
            Kind::OnlyExpected => self.only_expected += 1,
            Kind::NotFinite => {}
        }
        if matches!(kind, Kind::OnlyActual | Kind::OnlyExpected) {
            self.first_difference.get_or_insert(at);
        }
    }

    /// Pixels that exactly one of the pictures covers.
    pub fn different(&self) -> usize {
        self.only_actual + self.only_expected
    }
}

/// The class of a pixel in a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Both pictures cover it, or coverage is unknown: its error counts.
    Counted,
    /// Neither covers it.
    Background,
    /// Only the actual picture covers it.
    OnlyActual,
    /// Only the expected picture covers it.
    OnlyExpected,
    /// A channel of either picture is NaN or infinite.
    NotFinite,
}

impl Kind {
    /// Whether the pictures have the same coverage there, so that a difference picture shows its error.
    pub(super) fn is_on_scale(self) -> bool {
        matches!(self, Self::Counted | Self::Background)
    }
}

/// A pixel of two pictures of one size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// Column and row of the whole picture.
    pub(super) at: (u32, u32),
    pub(super) actual: [f64; 3],
    pub(super) expected: [f64; 3],
    pub(super) kind: Kind,
}

/// The pixels of a band, row by row.
pub(super) fn pairs(band: &Band) -> impl Iterator<Item = Pair> {
    let Band { first, actual, expected } = band;
    let width = actual.dimensions().0.max(1) as usize;
    let covered = actual.covered().zip(expected.covered());
    actual.pixels().iter().zip(expected.pixels()).enumerate().map(move |(i, (&actual, &expected))| {
        let finite = actual.iter().chain(&expected).all(|channel| channel.is_finite());
        let kind = match covered.map(|(a, b)| (a[i], b[i])) {
            _ if !finite => Kind::NotFinite,
            None | Some((true, true)) => Kind::Counted,
            Some((false, false)) => Kind::Background,
            Some((true, false)) => Kind::OnlyActual,
            Some((false, true)) => Kind::OnlyExpected,
        };
        Pair { at: ((i % width) as u32, first + (i / width) as u32), actual, expected, kind }
    })
}
