//! Colours that a pixel may show.

/// All the colours between two, channel by channel. Linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorRange {
    /// The least of each channel.
    pub low: [f64; 3],
    /// The greatest of each channel.
    pub high: [f64; 3],
}

/// The colours that one pixel may show.
#[derive(Clone, Debug, PartialEq)]
pub struct Possible {
    /// One for each combination of triangles that may be visible.
    pub ranges: Vec<ColorRange>,
    /// Whether the pixel has more than one right colour: more than one combination of triangles may be visible, or a
    /// different one at each sample, or a triangle's own colour jumps, as at the edge of a spot's cone, or one of its
    /// corners may snap to either of two grid points. Otherwise only the colour at its centre is right.
    pub is_edge: bool,
    /// The most blended layers that may lie over one another at one sampling point.
    pub layers: usize,
}

impl ColorRange {
    pub(super) fn from_colors(colors: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let none = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        colors.into_iter().fold(none, |range, color| range.with(&Self { low: color, high: color }))
    }

    /// The least range that holds both.
    pub(super) fn with(&self, other: &Self) -> Self {
        let [low, high] = [0, 1].map(|end| {
            std::array::from_fn(|k| match end {
                0 => self.low[k].min(other.low[k]),
                _ => self.high[k].max(other.high[k]),
            })
        });
        Self { low, high }
    }

    /// Each end put through a function that grows with its channel.
    pub(crate) fn mapped(&self, grows: impl Fn(f64) -> f64) -> Self {
        Self { low: self.low.map(&grows), high: self.high.map(&grows) }
    }

    /// Combines the ends of two ranges by a function that is monotonic in both.
    pub(super) fn through(&self, other: &Self, grows: impl Fn(f64, f64) -> f64) -> Self {
        let ends = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| grows(a[k], b[k]));
        Self { low: ends(self.low, other.low), high: ends(self.high, other.high) }
    }
}

impl Possible {
    /// Each end put through a function that grows with its channel.
    pub(crate) fn mapped(mut self, grows: impl Fn(f64) -> f64) -> Self {
        self.ranges.iter_mut().for_each(|range| *range = range.mapped(&grows));
        self
    }
}
