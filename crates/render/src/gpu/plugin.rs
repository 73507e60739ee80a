//! The systems that draw a frame with wgpu.

use crate::adapter::cpu_draws;
use crate::cpu;
use crate::gpu::attachments::{self, Target};
use crate::gpu::device::Gpu;
use crate::gpu::draw::meshes::{self as mesh_buffers, MeshBuffers};
use crate::gpu::draw::upload::{self, Buffers};
use crate::gpu::passes::encode;
use crate::gpu::passes::over;
use crate::gpu::pipelines::cache::{self, Pipelines};
use crate::gpu::shared_window;
use crate::gpu::surface::SurfaceTarget;
use crate::gpu::texture;
use crate::headless;
use crate::replaced;
use crate::views::{self, Views};
use crate::window_picture::{self, Present};
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::InternedScheduleLabel;
use halfway_frame::batch::lit_patches;
use halfway_frame::sets::RenderSet::{Deliver, Draw, Illuminate, Upload, View};
use halfway_frame::{ReadCamera, add_backend};

/// Adds the resources and the systems.
pub(crate) fn add(app: &mut App, schedule: InternedScheduleLabel) {
    app.init_resource::<Target>()
        .init_resource::<MeshBuffers>()
        .init_resource::<Buffers>()
        .init_resource::<Pipelines>();
    add_stages(app, schedule);
    app.add_systems(
        schedule,
        (
            attachments::measure.in_set(View).after(headless::measure).before(views::begin),
            (
                shared_window::present
                    .run_if(Views::are_there.or_else(window_picture::is_asked))
                    .run_if(resource_exists::<SurfaceTarget>),
                encode::present,
            )
                .chain()
                .in_set(Deliver)
                .in_set(Present)
                .after(views::draw_further)
                .run_if(gpu_draws),
            texture::refuse_on_cpu.in_set(View).after(cpu::draw::prepare).run_if(cpu_draws),
            over::refuse_on_cpu.in_set(Draw).run_if(cpu_draws).run_if(over::is_any),
        ),
    );
}

/// Adds the systems of a camera's frame.
pub(crate) fn add_stages(app: &mut App, schedule: InternedScheduleLabel) {
    add_backend::<Pipelines, _>(app, schedule, gpu_draws);
    let systems = (
        attachments::prepare.in_set(View).after(ReadCamera).after(replaced::forget).after(window_picture::ask),
        cache::begin.in_set(Illuminate).before(lit_patches::illuminate::<Pipelines>),
        (
            mesh_buffers::upload,
            upload::build_pipelines,
            upload::upload,
            upload::upload_maps,
            upload::upload_surroundings,
            over::prepare.run_if(over::is_any),
        )
            .chain()
            .in_set(Upload),
        encode::draw.in_set(Draw),
    );
    app.add_systems(schedule, systems.run_if(gpu_draws));
}

/// Whether a device draws.
pub(crate) fn gpu_draws(gpu: Option<Res<Gpu>>) -> bool {
    gpu.is_some_and(|gpu| !gpu.is_lost())
}
