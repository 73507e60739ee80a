//! Groups of draws that share their state, for opaque and blended objects.

use crate::gpu::passes::ScenePasses;
use halfway_frame::batch::draws::DrawGroup;
use halfway_frame::passes::{self, Phase};

/// Draws the groups of `phase` whose resources all exist, and returns the number of omitted draws.
pub(crate) fn record(pass: &mut wgpu::RenderPass<'_>, scene: &ScenePasses<'_>, phase: Phase) -> u32 {
    let ScenePasses { batches, meshes, pipelines, buffers, .. } = scene;
    let groups = passes::groups(batches, phase);
    let count =
        |groups: &[DrawGroup]| groups.iter().map(|group| batches.draws.in_group(group).len()).sum::<usize>() as u32;
    let Some(instances) = buffers.instances() else { return count(groups) };
    pass.set_vertex_buffer(0, instances.slice(..));
    let (mut last, mut left_out) = (None, 0);
    for group in groups {
        let state = &group.state;
        // Counted as omitted until it is drawn.
        left_out += count(std::slice::from_ref(group));
        let (Some(pipeline), Some(mesh), Some((bindings, offset))) =
            (pipelines.get(state.key), meshes.get(state.mesh, state.form), buffers.bindings(state))
        else {
            continue;
        };
        if last != Some(state.key) {
            pass.set_pipeline(pipeline);
            last = Some(state.key);
        }
        pass.set_bind_group(0, bindings, &[offset]);
        pass.set_vertex_buffer(1, mesh.positions.slice(..));
        if state.key.reads_attributes() {
            pass.set_vertex_buffer(2, mesh.attributes.slice(..));
        }
        if let Some(colors) = mesh.colors.as_ref().filter(|_| state.key.is_painted()) {
            pass.set_vertex_buffer(3, colors.slice(..));
        }
        if state.key.is_mapped() {
            let (Some(uvs), Some(maps)) = (&mesh.uvs, buffers.maps.group(state.maps)) else { continue };
            pass.set_vertex_buffer(4, uvs.slice(..));
            // Without tangents any buffer will do, since no shader reads it.
            pass.set_vertex_buffer(5, mesh.tangents.as_ref().unwrap_or(uvs).slice(..));
            pass.set_bind_group(1, maps, &[]);
        }
        if state.key.surrounded {
            let Some(surroundings) = buffers.surroundings.group() else { continue };
            pass.set_bind_group(2, surroundings, &[]);
        }
        pass.set_index_buffer(mesh.indices.slice(..), mesh.index_format);
        for draw in batches.draws.in_group(group) {
            pass.draw_indexed(draw.indices.clone(), 0, draw.instances.clone());
        }
        left_out -= count(std::slice::from_ref(group));
    }
    left_out
}
