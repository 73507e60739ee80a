//! Batch: runs of patches become sorted, instanced draws.

use crate::batch::backend::Backend;
use crate::batch::draws::{DrawState, Draws};
use crate::batch::key::DrawKey;
use crate::batch::lit_patches::LitPatches;
use crate::batch::lit_runs::LitRun;
use crate::batch::table::RunState;
use crate::report::FrameReport;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use halfway_lighting::record::InstanceRecord;
use std::cmp::Reverse;

/// The frame's draws. Holds after [`RenderSet::Batch`](crate::sets::RenderSet::Batch).
#[derive(Resource, Debug, Default)]
pub struct Batches {
    /// In the order of the draws.
    pub instances: Vec<InstanceRecord>,
    /// The draws, in the order in which they are drawn.
    pub draws: Draws,
    /// The order of the runs at hand, and that of the states. Their memory is kept.
    order: Vec<Place>,
    states: Vec<u32>,
    ranks: Vec<u32>,
    /// The number of the frame that they are of.
    made_of: u64,
}

/// The place of a run in the order of opaque ones: the rank of its state, its depth, and its own number, so that equally
/// deep ones are in spawn order.
type Place = (u32, u32, u32);

/// Sorts the lit patches into draws.
pub fn batch<B: Backend + Resource<Mutability = Mutable>>(
    mut backend: ResMut<B>,
    lit: Res<LitPatches>,
    mut batches: ResMut<Batches>,
    mut report: ResMut<FrameReport>,
) {
    if !(lit.stands && batches.made_of == lit.frame.wrapping_sub(1)) {
        batches.instances.clear();
        batches.draws.clear();
        batches.emit_opaque(&lit, &mut *backend);
        batches.emit_blended(&lit, &mut *backend);
    }
    batches.made_of = lit.frame;
    report.draws = batches.draws.count() as u32;
    report.triangles = batches.draws.triangles();
}

impl Batches {
    /// Sorts opaque runs by state and then by nearness, and joins neighbours that differ only in their instance or record.
    fn emit_opaque(&mut self, lit: &LitPatches, backend: &mut impl Backend) {
        let states = &lit.table.states;
        let mut order = std::mem::take(&mut self.order);
        self.states.clear();
        self.states.extend(0..states.len() as u32);
        self.states.sort_unstable_by_key(|&state| states[state as usize]);
        self.ranks.resize(states.len(), 0);
        for (rank, &state) in (0..).zip(&self.states) {
            self.ranks[state as usize] = rank;
        }
        order.clear();
        let place = |(number, run): (u32, &LitRun)| (self.ranks[run.state as usize], run.nearness(), number);
        order.extend((0..).zip(&lit.opaque).map(place));
        order.sort_unstable();
        let run = |&(.., number): &Place| &lit.opaque[number as usize];
        let drawn = |place: &Place| {
            let RunState { call, indices, .. } = states[run(place).state as usize];
            (call, indices)
        };
        for same in order.chunk_by_mut(|a, b| a.0 == b.0 || drawn(a) == drawn(b)) {
            let first = run(&same[0]);
            let have_one_record = same.iter().all(|place| run(place).record == first.record);
            let per_instance = !have_one_record && backend.looks_up(key_of(first, lit));
            if per_instance && same[0].0 != same[same.len() - 1].0 {
                // Twins among them come after the others by their numbers alone.
                same.sort_unstable_by_key(|&(_, nearness, number)| (nearness, number));
            } else if !have_one_record && !per_instance {
                let twins = |run: &LitRun| states[run.state as usize].twins_before;
                same.sort_unstable_by_key(|place| (twins(run(place)), run(place).record, place.1, place.2));
            }
            for alike in same.chunk_by(|a, b| per_instance || run(a).record == run(b).record) {
                self.emit_draw(alike.iter().map(run), lit, per_instance);
            }
        }
        self.order = order;
    }

    /// Draws blended runs from far to near; of one instance the far side first, and then by triangle.
    fn emit_blended(&mut self, lit: &LitPatches, backend: &mut impl Backend) {
        let mut order = std::mem::take(&mut self.order);
        let indices = |run: &LitRun| lit.table.states[run.state as usize].indices;
        order.clear();
        order.extend((0..).zip(&lit.blended).map(|(number, run)| (0, run.nearness(), number)));
        let run = |&(.., number): &Place| &lit.blended[number as usize];
        order.sort_unstable_by_key(|place| {
            let run = run(place);
            (Reverse(place.1), run.instance, run.pass, indices(run))
        });
        for same in order.chunk_by(|a, b| run(a).state == run(b).state) {
            let first = run(&same[0]);
            let have_one_record = same.iter().all(|place| run(place).record == first.record);
            let per_instance = !have_one_record && backend.looks_up(key_of(first, lit));
            for alike in same.chunk_by(|a, b| per_instance || run(a).record == run(b).record) {
                self.emit_draw(alike.iter().map(run), lit, per_instance);
            }
        }
        self.order = order;
    }

    /// Draws runs that differ in nothing but their instance, and in their record only where instances look it up.
    fn emit_draw<'a>(&mut self, runs: impl Iterator<Item = &'a LitRun> + Clone, lit: &LitPatches, per_instance: bool) {
        let Some(first) = runs.clone().next() else { return };
        let start = self.instances.len() as u32;
        self.instances
            .extend(runs.map(|run| InstanceRecord { surface: run.record, ..lit.instances[run.instance as usize] }));
        let RunState { call, indices: (from, to), .. } = lit.table.states[first.state as usize];
        let (key, mesh, form, maps) = lit.table.called[call as usize];
        let key = DrawKey { per_instance, ..key };
        let record = if per_instance { 0 } else { first.record };
        self.draws.push(DrawState { key, mesh, form, record, maps }, from..to, start..self.instances.len() as u32);
    }
}

/// The key of a run.
fn key_of(run: &LitRun, lit: &LitPatches) -> DrawKey {
    let RunState { call, .. } = lit.table.states[run.state as usize];
    lit.table.called[call as usize].0
}
