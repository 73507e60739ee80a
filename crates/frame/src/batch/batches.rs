//! Batch: runs of patches become sorted, instanced draws.

use crate::batch::backend::Backend;
use crate::batch::draws::{DrawState, Draws};
use crate::batch::key::DrawKey;
use crate::batch::lit_patches::LitPatches;
use crate::batch::lit_runs::LitRun;
use crate::report::FrameReport;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use halfway_lighting::record::InstanceRecord;

/// The frame's draws. Holds after [`RenderSet::Batch`](crate::sets::RenderSet::Batch).
#[derive(Resource, Debug, Default)]
pub struct Batches {
    /// In the order of the draws.
    pub instances: Vec<InstanceRecord>,
    /// The draws, in the order in which they are drawn.
    pub draws: Draws,
}

/// Sorts the lit patches into draws.
pub fn batch<B: Backend + Resource<Mutability = Mutable>>(
    mut backend: ResMut<B>,
    mut lit: ResMut<LitPatches>,
    mut batches: ResMut<Batches>,
    mut report: ResMut<FrameReport>,
) {
    batches.instances.clear();
    batches.draws.clear();
    batches.emit(&mut lit, &mut *backend);
    report.draws = batches.draws.count() as u32;
    report.triangles = batches.draws.triangles();
}

impl Batches {
    /// Sorts, and joins neighbours that differ only in their instance or record.
    fn emit(&mut self, seen: &mut LitPatches, backend: &mut impl Backend) {
        let mut runs = std::mem::take(&mut seen.runs);
        // Instances are numbered in spawn order, which equal ones keep.
        runs.sort_unstable_by(|a, b| {
            a.blend.cmp(&b.blend).then_with(|| if a.blend { a.by_depth(b) } else { a.by_state(b) })
        });
        for same in runs.chunk_by_mut(LitRun::differs_in_record_alone) {
            self.emit_alike(same, seen, backend);
        }
        seen.runs = runs;
    }

    /// Draws runs that differ in nothing but their record and instance: at once where records are looked up.
    fn emit_alike(&mut self, runs: &mut [LitRun], seen: &LitPatches, backend: &mut impl Backend) {
        let LitRun { blend, call, .. } = runs[0];
        let (key, ..) = seen.table.called[call as usize];
        let have_one_record = runs.windows(2).all(|pair| pair[0].record == pair[1].record);
        let per_instance = !have_one_record && backend.looks_up(key);
        for same in runs.chunk_by_mut(|a, b| per_instance || a.record == b.record) {
            if per_instance && !blend {
                same.sort_unstable_by(LitRun::by_nearness);
            }
            self.emit_draw(same, seen, per_instance);
        }
    }

    fn emit_draw(&mut self, runs: &[LitRun], seen: &LitPatches, per_instance: bool) {
        let start = self.instances.len() as u32;
        for run in runs {
            self.instances.push(InstanceRecord { surface: run.record, ..seen.instances[run.instance as usize] });
        }
        let LitRun { call, indices: (first, end), record, .. } = runs[0];
        let (key, mesh, form, maps) = seen.table.called[call as usize];
        let key = DrawKey { per_instance, ..key };
        let record = if per_instance { 0 } else { record };
        self.draws.push(DrawState { key, mesh, form, record, maps }, first..end, start..self.instances.len() as u32);
    }
}
