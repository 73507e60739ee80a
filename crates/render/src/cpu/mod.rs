//! Draws batches on the CPU: cuts meshes into pieces, turns the frame's records into a pass, and draws the pass.

pub(crate) mod canvas;
pub(crate) mod device;
pub(crate) mod draw;
mod error;
pub(crate) mod meshes;
pub(crate) mod pass;
mod policy;

use crate::adapter::cpu_draws;
use crate::cpu::canvas::Canvas;
use crate::cpu::device::Cpu;
use crate::cpu::meshes::MeshPieces;
use crate::cpu::pass::PassLists;
use crate::replaced;
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::InternedScheduleLabel;
use halfway_frame::sets::RenderSet::{Draw, Upload, View};
use halfway_frame::{ReadCamera, add_backend};

/// Adds the resources and the systems.
pub(crate) fn add(app: &mut App, schedule: InternedScheduleLabel) {
    app.init_resource::<Canvas>().init_resource::<MeshPieces>().init_resource::<PassLists>();
    add_stages(app, schedule);
}

/// Adds the systems of a camera's frame.
pub(crate) fn add_stages(app: &mut App, schedule: InternedScheduleLabel) {
    add_backend::<Cpu, _>(app, schedule, cpu_draws);
    let systems = (
        draw::prepare.in_set(View).after(ReadCamera).after(replaced::forget),
        (meshes::make_ready, pass::fill).chain().in_set(Upload),
        draw::draw.in_set(Draw),
    );
    app.add_systems(schedule, systems.run_if(cpu_draws));
}
