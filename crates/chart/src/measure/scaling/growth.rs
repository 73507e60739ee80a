//! What grows, and in which steps.

use halfway::prelude::Tolerance;

use super::ScalingPlan;

/// What there is more and more of, in a scene that stays as it is otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Growth {
    /// Triangles of one sphere, under one directional light; levels of detail are off.
    Triangles,
    /// Objects of 8 triangles each that fill the picture, under one directional light; nothing moves.
    Objects,
    /// The same, all of them turning.
    TurningObjects,
    /// Point lights over a ground of 400 tiles; the range of each ends after 1.5 of the ground's 100 units.
    Lights,
    /// Point lights without a range, all of which light one sphere.
    LightsOnOne,
    /// Pixels, all of them covered by one sphere of 3,968 triangles, under one directional light.
    Pixels,
}

/// The largest picture: 3840 × 2160.
pub(super) const PIXELS: f64 = 3840.0 * 2160.0;

impl Growth {
    /// All.
    pub const ALL: [Self; 6] =
        [Self::Triangles, Self::Objects, Self::TurningObjects, Self::Lights, Self::LightsOnOne, Self::Pixels];

    /// Its name, what is counted, the first count and the last.
    fn row(self) -> (&'static str, &'static str, f64, f64) {
        match self {
            Self::Triangles => ("triangles of one sphere", "triangles", 1e3, 1e6),
            Self::Objects => ("objects at rest", "objects", 1e1, 1e5),
            Self::TurningObjects => ("objects, all turning", "objects", 1e1, 1e5),
            Self::Lights => ("lights of short range", "lights", 1.0, 1e4),
            Self::LightsOnOne => ("lights on one sphere", "lights", 1.0, 256.0),
            Self::Pixels => ("pixels", "pixels", 64.0 * 64.0, PIXELS),
        }
    }

    /// In a few words, lower case.
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// What is counted.
    pub fn counted(self) -> &'static str {
        self.row().1
    }

    /// The first count.
    pub fn start(self) -> f64 {
        self.row().2
    }

    /// The last count.
    pub fn end(self) -> f64 {
        self.row().3
    }

    /// How coarse meshes may be drawn: by default, but where it is triangles that grow, as they are.
    pub fn tolerance(self) -> Tolerance {
        Tolerance::EXACT
    }

    /// The counts to measure at: the first, the powers of ten and the steps between them, the last. A mesh or a picture
    /// has about as many triangles or pixels.
    pub fn steps(self, plan: ScalingPlan) -> Vec<f64> {
        let per_decade = plan.per_decade.max(1);
        let (start, end) = (self.start(), self.end() / 10f64.powf(f64::from(plan.decades_less)));
        let first = (start.log10() * f64::from(per_decade)).floor() as i32;
        let powers = (first..).map(|step| 10f64.powf(f64::from(step) / f64::from(per_decade)).round());
        let between = powers.skip_while(|count| *count <= start).take_while(|count| *count < end);
        let mut steps: Vec<f64> = [start].into_iter().chain(between).collect();
        if end > start {
            steps.push(end.round());
        }
        steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_hold_both_ends_and_every_power_of_ten() {
        let plan = ScalingPlan { per_decade: 2, decades_less: 0, ..crate::ReportPlan::QUICK.scaling };
        assert_eq!(Growth::LightsOnOne.steps(plan), [1.0, 3.0, 10.0, 32.0, 100.0, 256.0]);
        assert_eq!(Growth::Triangles.steps(plan), [1e3, 3162.0, 1e4, 31623.0, 1e5, 316_228.0, 1e6]);
        let pixels = Growth::Pixels.steps(plan);
        assert_eq!((pixels[0], pixels[1], pixels[pixels.len() - 1]), (4096.0, 1e4, PIXELS));
        let plan = ScalingPlan { per_decade: 1, decades_less: 1, ..plan };
        assert_eq!(Growth::Objects.steps(plan), [10.0, 100.0, 1e3, 1e4]);
        assert_eq!(Growth::LightsOnOne.steps(plan), [1.0, 10.0, 26.0]);
    }
}
