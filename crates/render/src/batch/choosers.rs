//! Chooses the lights that the patches of an object need: on all threads, since no patch has to do with another.

use crate::batch::clusters::{Cluster, Clustering};
use crate::batch::lit_object::LitObject;
use crate::batch::object::Shared;
use crate::batch::painted::{PaintedObject, PatchPaint};
use crate::device::costs::VertexPrices;
use crate::geometry::seen::SeenPatch;
use crate::geometry::shape::PatchShape;
use crate::lights::lists::{LightLists, Listing, Reflector};
use crate::lights::memory::ChoiceMemory;
use crate::lights::patch_lights::KeptLights;
use crate::lights::places::{ShadedAt, Spending};
use crate::lights::selector::Selector;
use bevy_math::Vec3;
use halfway_lighting::equations;
use halfway_raster::Threads;
use std::ops::Range;
use std::sync::OnceLock;

/// What chooses for the patches of one object.
pub(super) struct Chooser<'a> {
    pub(super) object: &'a LitObject<'a>,
    pub(super) shared: Shared<'a>,
    pub(super) reflector: &'a Reflector,
    pub(super) clustering: Clustering<'a, 'a>,
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

    /// Where the terms of a cluster may be shaded.
    pub(super) fn place(&self, cluster: &Cluster, memory: &ChoiceMemory) -> ShadedAt {
        let prices = if self.placing.is_some() { &self.shared.prices } else { &VertexPrices::NEVER };
        self.object.place(cluster, (prices, self.compiled_in), memory)
    }

    /// Has the lights near some pieces looked for, for whichever part of them comes next.
    pub(super) fn look_around<'s>(&self, selector: &mut Selector, shapes: impl Iterator<Item = &'s PatchShape>) {
        // With the smaller tolerance of both.
        let listing = self.placing.as_ref().unwrap_or_else(|| self.listing_at(ShadedAt::Fragments));
        selector.look_around(listing, shapes.map(|shape| shape.sphere(self.object.model_view)));
    }

    /// Has the lights near patches looked for, and joins those to clusters that have no light among them.
    pub(super) fn cluster(
        &self,
        selector: &mut Selector,
        seen: &[SeenPatch],
        members: Range<usize>,
        lists: &LightLists,
        clusters: &mut Vec<Cluster>,
    ) {
        self.look_around(
            selector,
            seen[members.clone()].iter().map(|seen| &self.clustering.detail.patch(seen.number).shape),
        );
        let mut is_among =
            |shape: &PatchShape| selector.is_among(self.shared.lights, shape.sphere(self.object.model_view));
        self.clustering.fill((seen, members), &mut is_among, &lists.memory, clusters);
    }

    /// Has the lights of a cluster selected, one of those last looked around; what is saved.
    pub(super) fn select(
        &self,
        selector: &mut Selector,
        (cluster, place): (&Cluster, ShadedAt),
        paint: Option<&PatchPaint>,
        lists: &LightLists,
    ) -> f32 {
        let listing = self.listing_at(place);
        self.object.placed(cluster, place, paint, |placed| {
            selector.select(self.shared.lights, lists, placed, listing, self.object.key.terms)
        })
    }

    /// Chooses for neighbouring patches; nothing for those that may need no list.
    fn choose(
        &self,
        selector: &mut Selector,
        (seen, members): (&[SeenPatch], Range<usize>),
        lists: &LightLists,
        painted: Option<&PaintedObject>,
        chosen: &mut ChosenGroup,
    ) {
        chosen.choices.clear();
        chosen.lights.clear();
        self.cluster(selector, seen, members, lists, &mut chosen.clusters);
        for cluster in &chosen.clusters {
            let place = self.place(cluster, &lists.memory);
            let mut of = ClusterChoice { place, gain: 0.0, lights: None, paint: None };
            if !self.object.may_be_unlisted(place, self.shared.lights) {
                let first = seen[cluster.members.start].number;
                of.paint = painted.map(|painted| painted.of(self.object.geometry, first));
                of.gain = self.select(selector, (cluster, place), of.paint.as_ref(), lists);
                of.lights = Some(chosen.lights.keep(&selector.lights()));
            }
            chosen.choices.push(of);
        }
    }
}

/// What was chosen for a cluster.
#[derive(Debug)]
pub(super) struct ClusterChoice {
    pub(super) place: ShadedAt,
    /// What it saves to have terms at the vertices.
    pub(super) gain: f32,
    /// The number of its lights; `None` where they have not been selected, since it may need no list.
    pub(super) lights: Option<usize>,
    /// What images do to it, where that was asked.
    pub(super) paint: Option<PatchPaint>,
}

/// Neighbouring clusters, and what was chosen for each.
#[derive(Debug, Default)]
pub(super) struct ChosenGroup {
    pub(super) clusters: Vec<Cluster>,
    pub(super) choices: Vec<ClusterChoice>,
    pub(super) lights: KeptLights,
}

/// Those who choose, one a thread, and what they chose. Their memory is kept.
#[derive(Debug)]
pub(crate) struct Choosers {
    /// `None` until there is enough to do.
    threads: Option<Threads>,
    /// One at least.
    selectors: Vec<Selector>,
    /// The patches that each group has, of those that are seen of an object.
    parts: Vec<Range<usize>>,
    groups: Vec<ChosenGroup>,
}

/// At most so many neighbouring patches look for their lights together, and one thread chooses for them.
const TOGETHER: usize = 32;

/// A second thread is woken for no fewer groups than this: what it takes over is to be worth more than waking it.
const WORTH_A_THREAD: usize = 4;

impl Default for Choosers {
    fn default() -> Self {
        Self { threads: None, selectors: vec![Selector::default()], parts: Vec::new(), groups: Vec::new() }
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

    /// Chooses for what is seen of an object. Returns that, and one who can choose again.
    ///
    /// Each choice is what it is whoever makes it, so that nothing depends on how many threads there are.
    pub(super) fn choose(
        &mut self,
        chooser: &Chooser,
        seen: &[SeenPatch],
        lists: &LightLists,
        painted: Option<&PaintedObject>,
    ) -> (&[ChosenGroup], &mut Selector) {
        chooser.clustering.cut(seen, TOGETHER, &mut self.parts);
        let count = self.parts.len();
        if self.groups.len() < count {
            self.groups.resize_with(count, ChosenGroup::default);
        }
        let threads = if count < WORTH_A_THREAD { &Threads::ALONE } else { self.threads.get_or_insert_with(started) };
        let most = threads.count().min(count / 2).max(1);
        if self.selectors.len() < most {
            self.selectors.resize_with(most, Selector::default);
        }
        let parts = self.parts.iter().cloned().zip(&mut self.groups);
        threads.share(&mut self.selectors[..most], parts, |selector, (members, chosen)| {
            chooser.choose(selector, (seen, members), lists, painted, chosen);
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
    use bevy_platform::collections::HashSet;
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
        let LightLists { numbers, sent, bound, .. } = lists;
        format!("{runs:?} {records:?} {numbers:?} {sent:?} {bound:?} {report:?}")
    }

    #[test]
    fn lists_are_the_same_by_any_number_of_threads() {
        let (free, never) = (VertexPrices::FREE, VertexPrices::NEVER);
        let rows = [
            (Shading::Auto, 3, free, 0.0),
            (Shading::Auto, 16, free, 0.0),
            (Shading::Auto, 16, never, 0.0),
            (Shading::Phong, 16, never, 0.0),
            (Shading::Phong, 16, never, 0.5),
        ];
        for (shading, lights, prices, pixels) in rows {
            let frames = [1, 2, 3].map(|threads| {
                let mut app = app(shading, lights);
                app.insert_resource(prices);
                app.insert_resource(ViewTolerance(Tolerance { steps: 1.0, pixels }));
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
                let groups = choosers.groups.iter().filter(|group| !group.clusters.is_empty()).count();
                assert!(groups > WORTH_A_THREAD && selectors == threads, "{groups} by {selectors}");
                frames
            });
            assert!(frames[0][0] != frames[0][1], "{shading:?}: the camera moves");
            assert!(frames[1..].iter().all(|other| *other == frames[0]), "{shading:?}, {lights} lights");
        }
    }

    /// Of a ball that covers few pixels, several patches have one list together, and all that is seen of them is drawn;
    /// where each covers many pixels, each has its own, and among lights most have.
    #[test]
    fn patches_of_few_pixels_are_chosen_for_together() {
        let chosen = |size: u32, away: f32| {
            let mut app = app(Shading::Phong, 16);
            app.insert_resource(Headless { size: UVec2::new(size, size), pixels: Pixels::Byte });
            let mut lights = app.world_mut().query_filtered::<&mut Transform, With<PointLight>>();
            lights.iter_mut(app.world_mut()).for_each(|mut light| light.translation *= away);
            app.update();
            let report = app.world().resource::<FrameReport>();
            assert_eq!(report.errors, []);
            let seen = report.patches - report.patches_culled;
            let lit = app.world().resource::<LitPatches>();
            let clusters = lit.choosers.groups.iter().map(|group| group.clusters.len()).sum::<usize>();
            let drawn: u32 = lit.runs.iter().map(|run| (run.indices.1 - run.indices.0) / 3).sum();
            assert!(drawn >= 64 * seen.saturating_sub(1), "{drawn} triangles of {seen} patches");
            (seen as usize, clusters, report.light_pairs as usize)
        };
        let (seen, clusters, pairs) = chosen(64, 5.0);
        assert!(5 * clusters < seen && pairs <= 16 * clusters, "{clusters} of {seen}, {pairs} pairs");
        let (seen, clusters, pairs) = chosen(2048, 5.0);
        assert!(5 * clusters > 4 * seen && pairs <= 16 * clusters, "{clusters} of {seen}, {pairs} pairs");
        let (seen, clusters, _) = chosen(64, 0.3);
        assert!(2 * clusters > seen, "{clusters} of {seen}");
    }

    /// Also where some patches of a family are coarser than the mesh and others are not, so that each has clusters.
    #[test]
    fn no_two_clusters_go_by_one_name() {
        let mut neighbours = 0;
        for away in [1.0, 2.0, 3.0, 5.0] {
            let mut app = app(Shading::Auto, 3);
            app.insert_resource(ViewTolerance(Tolerance { steps: 2.0, pixels: 0.5 }));
            app.insert_resource(VertexPrices::FREE);
            let mut cameras = app.world_mut().query_filtered::<&mut Transform, With<Camera>>();
            cameras.iter_mut(app.world_mut()).for_each(|mut camera| camera.translation *= away);
            // The second frame waits for what is coarser.
            app.update();
            app.world_mut().resource_mut::<LitPatches>().choosers.groups.clear();
            app.update();
            let choosers = &app.world().resource::<LitPatches>().choosers;
            let clusters = || choosers.groups.iter().flat_map(|group| &group.clusters);
            let names: HashSet<u32> = clusters().map(|cluster| cluster.name).collect();
            assert_eq!(names.len(), clusters().count(), "{away}");
            neighbours += clusters()
                .zip(clusters().skip(1))
                .filter(|(a, b)| a.corners.is_some() != b.corners.is_some() && a.count + b.count > 2)
                .count();
        }
        // There is what could go by one name: it does where coarser ones are not told apart.
        assert!(neighbours > 3, "{neighbours} joined clusters beside a coarser or finer one");
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
