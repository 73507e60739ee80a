//! Passes: the list of a view's passes, which every drawer follows in order.

use crate::batch::batches::Batches;
use crate::batch::draws::DrawGroup;
use crate::lights::surroundings::Surroundings;
pub use crate::phases::{Pass, PassCounts, Phase};
use crate::report::FrameReport;
use bevy_ecs::prelude::*;

/// The passes of the frame, in the order in which they are drawn. A pass that draws nothing is not among them, so that
/// no drawer spends anything on it. Holds after [`RenderSet::Upload`](crate::sets::RenderSet::Upload); all but
/// [`Phase::Over`] is there after [`RenderSet::Batch`](crate::sets::RenderSet::Batch).
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct Passes(Vec<Pass>);

impl Passes {
    /// The passes, in order.
    pub fn iter(&self) -> impl Iterator<Item = &Pass> {
        self.0.iter()
    }

    /// Whether the frame has a pass in `phase`.
    pub fn has(&self, phase: Phase) -> bool {
        self.0.iter().any(|pass| pass.phase == phase)
    }

    /// Removes all passes.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds what a pass draws in `phase`, after what is there of the same phase; nothing where it draws nothing.
    ///
    /// ```
    /// use halfway_frame::passes::{PassCounts, Passes, Phase};
    ///
    /// let mut passes = Passes::default();
    /// passes.add(Phase::Policy, PassCounts { draws: 1, triangles: 0 });
    /// passes.add(Phase::Opaque, PassCounts { draws: 2, triangles: 24 });
    /// passes.add(Phase::Blended, PassCounts::default());
    /// assert!(passes.iter().map(|pass| pass.phase).eq([Phase::Opaque, Phase::Policy]));
    /// ```
    pub fn add(&mut self, phase: Phase, counts: PassCounts) {
        if counts.draws > 0 {
            let end = self.0.partition_point(|pass| pass.phase <= phase);
            self.0.insert(end, Pass { phase, counts });
        }
    }

    /// Writes the list into the report.
    pub fn report(&self, report: &mut FrameReport) {
        report.passes.clone_from(&self.0);
    }
}

/// The groups of draws of a phase: blended ones follow opaque ones, and other phases have none.
pub fn groups(batches: &Batches, phase: Phase) -> &[DrawGroup] {
    let groups = batches.draws.groups();
    let (opaque, blended) = groups.split_at(groups.partition_point(|group| !group.state.key.blend));
    match phase {
        Phase::Opaque => opaque,
        Phase::Blended => blended,
        Phase::Sky | Phase::Over | Phase::Policy => &[],
    }
}

/// Lists the passes of the frame.
pub(crate) fn list(
    batches: Res<Batches>,
    surroundings: Res<Surroundings>,
    mut passes: ResMut<Passes>,
    mut report: ResMut<FrameReport>,
) {
    passes.clear();
    let shows_sky = surroundings.0.as_ref().is_some_and(|placed| placed.sky.is_some());
    passes.add(Phase::Sky, PassCounts { draws: u32::from(shows_sky), triangles: 0 });
    for phase in [Phase::Opaque, Phase::Blended] {
        passes.add(phase, batches.draws.counts(groups(&batches, phase)));
    }
    passes.add(Phase::Policy, PassCounts { draws: report.picture_passes, triangles: 0 });
    passes.report(&mut report);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_are_in_the_order_of_their_phases() {
        let mut passes = Passes::default();
        let counts = |draws| PassCounts { draws, triangles: 0 };
        for phase in Phase::ALL.into_iter().rev() {
            passes.add(phase, counts(1));
            passes.add(phase, counts(0));
        }
        passes.add(Phase::Over, counts(2));
        let over = [1, 2].map(|draws| Pass { phase: Phase::Over, counts: counts(draws) });
        assert!(passes.iter().filter(|pass| pass.phase == Phase::Over).eq(&over));
        assert!(passes.iter().is_sorted_by_key(|pass| pass.phase) && passes.iter().count() == 6);
    }
}
