//! Chooses the lights that the patches of an object need: on all threads, since no patch has to do with another.

use crate::batch::lit_object::{LitObject, SeenPatch};
use crate::batch::object::Shared;
use crate::batch::painted::{PaintedObject, PatchPaint};
use crate::device::costs::VertexPrices;
use crate::geometry::patches::{MeshPatch, Sight};
use crate::lights::gains::Extent;
use crate::lights::lists::{LightLists, Listing, Reflector};
use crate::lights::memory::ChoiceMemory;
use crate::lights::patch_lights::KeptLights;
use crate::lights::places::{ShadedAt, Spending};
use crate::lights::selector::Selector;
use bevy_math::Vec3;
use halfway_lighting::equations;
use halfway_raster::Threads;
use std::sync::OnceLock;

/// What chooses for the patches of one object.
pub(super) struct Chooser<'a> {
    pub(super) object: &'a LitObject<'a>,
    pub(super) shared: Shared<'a>,
    pub(super) sight: &'a Sight<'a>,
    pub(super) reflector: &'a Reflector,
    /// How far a channel may be off for light, in steps.
    pub(super) steps: f64,
    /// How many lights are compiled in for a patch without lists; `None` where each has some.
    pub(super) compiled_in: Option<usize>,
    /// How terms are placed light by light; `None` where all terms of a patch are in one place.
    pub(super) placing: Option<Listing>,
    /// How they are selected where they are in one place: lights that are left out may then take all of the tolerance.
    pub(super) staying: OnceLock<Listing>,
}

impl Chooser<'_> {
    /// What lists are made by at these prices.
    pub(super) fn listing(&self, prices: VertexPrices) -> Listing {
        let &Self { object, shared, steps, compiled_in, .. } = self;
        let eye = equations::Eye::in_eye_space(shared.viewer);
        let spending = Spending { encoding: shared.encoding, steps, prices, compiled_in };
        // A color may be black: then there is no ambient light that could hide what is left out. None is above 1.
        let ambient = if object.key.is_painted() { Vec3::ZERO } else { shared.lights.ambient };
        self.reflector.listing(object.reflecting.faces, ambient, eye, spending)
    }

    /// What the lists of a patch are made by whose terms are there.
    fn listing_at(&self, place: ShadedAt) -> &Listing {
        match &self.placing {
            Some(placing) if place == ShadedAt::Either => placing,
            _ => self.staying.get_or_init(|| self.listing(VertexPrices::NEVER)),
        }
    }

    /// Where the terms of a patch may be shaded, and how much of it there is to shade.
    pub(super) fn place(&self, patch: &MeshPatch, memory: &ChoiceMemory) -> (ShadedAt, Extent) {
        let prices = if self.placing.is_some() { &self.shared.prices } else { &VertexPrices::NEVER };
        self.object.place(patch, self.sight, (prices, self.compiled_in), memory)
    }

    /// Has the lights near some patches looked for, for whichever of them comes next.
    pub(super) fn look_around(&self, selector: &mut Selector, patches: &[SeenPatch], place: ShadedAt) {
        // With the smaller tolerance of both.
        let listing = self.placing.as_ref().unwrap_or_else(|| self.listing_at(place));
        selector.look_around(listing, patches.iter().map(|(patch, _)| patch.sphere(self.object.model_view)));
    }

    /// Has the lights of a patch selected, one of those last looked around; what is saved.
    pub(super) fn select(
        &self,
        selector: &mut Selector,
        (patch, place): (&MeshPatch, (ShadedAt, Extent)),
        paint: Option<&PatchPaint>,
        lists: &LightLists,
    ) -> f32 {
        let listing = self.listing_at(place.0);
        self.object.placed(patch, place, paint, |placed| {
            selector.select(self.shared.lights, lists, placed, listing, self.object.key.terms)
        })
    }

    /// Chooses for neighbouring patches; nothing for those that may need no list.
    fn choose(
        &self,
        selector: &mut Selector,
        patches: &[SeenPatch],
        lists: &LightLists,
        painted: Option<&PaintedObject>,
        chosen: &mut ChosenGroup,
    ) {
        chosen.patches.clear();
        chosen.lights.clear();
        let mut has_looked_around = false;
        for &(patch, _) in patches {
            let place = self.place(patch, &lists.memory);
            let mut of = ChosenPatch { place, gain: 0.0, lights: None, paint: None };
            if !self.object.may_be_unlisted(place.0, self.shared.lights) {
                if !has_looked_around {
                    self.look_around(selector, patches, place.0);
                    has_looked_around = true;
                }
                of.paint = painted.map(|painted| painted.of(self.object.geometry, patch));
                of.gain = self.select(selector, (patch, place), of.paint.as_ref(), lists);
                of.lights = Some(chosen.lights.keep(&selector.lights()));
            }
            chosen.patches.push(of);
        }
    }
}

/// What was chosen for a patch.
#[derive(Debug)]
pub(super) struct ChosenPatch {
    pub(super) place: (ShadedAt, Extent),
    /// What it saves to have terms at the vertices.
    pub(super) gain: f32,
    /// The number of its lights; `None` where they have not been selected, since it may need no list.
    pub(super) lights: Option<usize>,
    /// What images do to it, where that was asked.
    pub(super) paint: Option<PatchPaint>,
}

/// What was chosen for neighbouring patches.
#[derive(Debug, Default)]
pub(super) struct ChosenGroup {
    pub(super) patches: Vec<ChosenPatch>,
    pub(super) lights: KeptLights,
}

/// Those who choose, one a thread, and what they chose. Their memory is kept.
#[derive(Debug)]
pub(crate) struct Choosers {
    /// `None` until there is enough to do.
    threads: Option<Threads>,
    /// One at least.
    selectors: Vec<Selector>,
    groups: Vec<ChosenGroup>,
}

/// The number of neighbouring patches that look for their lights together, and for which one thread chooses.
pub(super) const TOGETHER: usize = 32;

/// A second thread is woken for no fewer groups than this: what it takes over is to be worth more than waking it.
const WORTH_A_THREAD: usize = 4;

impl Default for Choosers {
    fn default() -> Self {
        Self { threads: None, selectors: vec![Selector::default()], groups: Vec::new() }
    }
}

impl Choosers {
    /// Starts a frame.
    pub(super) fn begin(&mut self) {
        self.selectors.iter_mut().for_each(Selector::begin);
    }

    /// One of those who choose.
    pub(super) fn first(&mut self) -> &mut Selector {
        &mut self.selectors[0]
    }

    /// How many pairs of a patch and a light have been looked at since this was last asked.
    pub(super) fn take_pairs(&mut self) -> u64 {
        self.selectors.iter_mut().map(Selector::take_pairs).sum()
    }

    /// Chooses for what is seen of an object. Returns that, [`TOGETHER`] by [`TOGETHER`], and one who can choose again.
    ///
    /// Each choice is what it is whoever makes it, so that nothing depends on how many threads there are.
    pub(super) fn choose(
        &mut self,
        chooser: &Chooser,
        seen: &[SeenPatch],
        lists: &LightLists,
        painted: Option<&PaintedObject>,
    ) -> (&[ChosenGroup], &mut Selector) {
        let count = seen.len().div_ceil(TOGETHER);
        if self.groups.len() < count {
            self.groups.resize_with(count, ChosenGroup::default);
        }
        let threads = if count < WORTH_A_THREAD { &Threads::ALONE } else { self.threads.get_or_insert_with(started) };
        let most = threads.count().min(count / 2).max(1);
        if self.selectors.len() < most {
            self.selectors.resize_with(most, Selector::default);
        }
        let parts = seen.chunks(TOGETHER).zip(&mut self.groups);
        threads.share(&mut self.selectors[..most], parts, |selector, (patches, chosen)| {
            chooser.choose(selector, patches, lists, painted, chosen);
        });
        (&self.groups[..count], &mut self.selectors[0])
    }
}

/// A thread for each core, or the calling one alone where the system refuses others.
fn started() -> Threads {
    Threads::new("lights", None).unwrap_or_else(|error| {
        log::warn!("lights are chosen on one thread: {error}");
        Threads::ALONE
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::lit_patches::LitPatches;
    use crate::device::adapter::Adapter;
    use crate::device::cpu::Cpu;
    use crate::frame::report::FrameReport;
    use crate::plugin::RenderPlugin;
    use crate::target::format::Pixels;
    use crate::target::frame::Headless;
    use bevy_app::App;
    use bevy_asset::Assets;
    use bevy_ecs::prelude::With;
    use bevy_math::{UVec2, Vec3};
    use bevy_transform::TransformPlugin;
    use bevy_transform::components::Transform;
    use halfway_lighting::{Camera, DirectionalLight, PointLight, Shading, Tolerance, ViewTolerance};
    use halfway_mesh::{Mesh, Mesh3d, UvSphere};

    /// A ball of many patches under many lights, and a camera that turns about it.
    fn app(shading: Shading, lights: u16) -> App {
        let mut app = App::new();
        app.add_plugins((TransformPlugin, RenderPlugin::default()));
        app.insert_resource(Headless { size: UVec2::new(320, 240), pixels: Pixels::Byte });
        app.insert_resource(ViewTolerance(Tolerance { steps: 1.0, pixels: 0.0 }));
        Adapter::Cpu(Cpu::open().expect("threads")).insert_into(app.world_mut());
        let world = app.world_mut();
        let mesh = Mesh::from(UvSphere::new(1.0, 256, 128));
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        world.spawn((Mesh3d(mesh), shading, Transform::default()));
        world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 3.0).looking_at(Vec3::ZERO, Vec3::Y)));
        for number in 0..lights {
            let turn = f32::from(number);
            let at = Transform::from_xyz(4.0 * turn.sin(), turn - 6.0, 4.0 * turn.cos());
            if number % 4 == 0 {
                world.spawn((DirectionalLight::default(), at.looking_at(Vec3::ZERO, Vec3::Y)));
            } else {
                world.spawn((PointLight::default(), at));
            }
        }
        app.finish();
        app.cleanup();
        app
    }

    /// All that a frame makes of what was chosen, as text.
    fn made(app: &App) -> String {
        let lit = app.world().resource::<LitPatches>();
        let report = app.world().resource::<FrameReport>();
        assert_eq!(report.errors, []);
        let LitPatches { runs, records, lists, .. } = lit;
        format!("{runs:?} {records:?} {:?} {:?} {report:?}", lists.numbers, lists.bound)
    }

    #[test]
    fn lists_are_the_same_by_any_number_of_threads() {
        let (free, never) = (VertexPrices::FREE, VertexPrices::NEVER);
        let rows = [
            (Shading::Auto, 3, free),
            (Shading::Auto, 16, free),
            (Shading::Auto, 16, never),
            (Shading::Phong, 16, never),
        ];
        for (shading, lights, prices) in rows {
            let frames = [1, 2, 3].map(|threads| {
                let mut app = app(shading, lights);
                app.insert_resource(prices);
                let started = Threads::new("test", Some(threads)).expect("a few threads");
                app.world_mut().resource_mut::<LitPatches>().choosers.threads = Some(started);
                let frames = [0, 1, 2].map(|_| {
                    app.update();
                    let mut cameras = app.world_mut().query_filtered::<&mut Transform, With<Camera>>();
                    for mut camera in cameras.iter_mut(app.world_mut()) {
                        camera.translation.x += 0.05;
                    }
                    made(&app)
                });
                let choosers = &app.world().resource::<LitPatches>().choosers;
                let selectors = choosers.selectors.len();
                let chosen = choosers.groups.iter().map(|group| group.patches.len()).sum::<usize>();
                assert!(chosen > WORTH_A_THREAD * TOGETHER && selectors == threads, "{chosen} by {selectors}");
                frames
            });
            assert!(frames[0][0] != frames[0][1], "{shading:?}: the camera moves");
            assert!(frames[1..].iter().all(|other| *other == frames[0]), "{shading:?}, {lights} lights");
        }
    }

    /// By prices at which no patch can save anything no patch is chosen for, and all is as at prices that say so at
    /// once.
    #[test]
    fn where_no_patch_may_save_none_is_chosen_for() {
        let drawn = |prices: VertexPrices| {
            let mut app = app(Shading::Auto, 6);
            app.insert_resource(prices);
            let frames = [0, 1].map(|_| {
                app.update();
                let mut cameras = app.world_mut().query_filtered::<&mut Transform, With<Camera>>();
                cameras.iter_mut(app.world_mut()).for_each(|mut camera| camera.translation.x += 0.05);
                made(&app)
            });
            let choosers = &app.world().resource::<LitPatches>().choosers;
            assert!(choosers.threads.is_none() && choosers.groups.is_empty(), "{prices:?}");
            let report = app.world().resource::<FrameReport>();
            assert!(
                report.patches > 500 && report.terms_at_fragments > 0 && report.terms_at_vertices == 0,
                "{report:?}"
            );
            frames
        };
        let dear = VertexPrices { look: 1e9, ..VertexPrices::FREE };
        assert_eq!(drawn(dear), drawn(VertexPrices::NEVER));
    }
}
