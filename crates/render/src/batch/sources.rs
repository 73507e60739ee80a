//! What the draws of a frame are made of. Where the next frame finds the same, they are drawn again.

use crate::batch::key::MapLooks;
use crate::batch::object::ReflectingBits;
use crate::batch::shown_objects::{ShownObject, ShownObjects};
use crate::batch::table::MapsBits;
use crate::device::costs::{Costs, VertexPrices};
use crate::lights::memory::Choosing;
use crate::target::format::PixelValues;
use crate::view::camera::View;
use bevy_asset::AssetId;
use bevy_ecs::prelude::Entity;
use halfway_lighting::{Terms, Tolerance};
use halfway_mesh::Mesh;
use halfway_texture::Pyramid;

/// What the draws of a frame are made of, besides where objects and lights are.
#[derive(Debug, Default)]
pub(crate) struct Sources {
    /// Whether they are those of the frame before.
    are_known: bool,
    of_frame: Option<FrameSources>,
    objects: Known<ObjectSources>,
    /// How the images of objects that have any are looked up, and the images.
    maps: Known<MapsBits>,
    images: Known<Pyramid>,
}

/// A list that is compared with what it was while it is made.
#[derive(Debug)]
struct Known<T> {
    all: Vec<T>,
    count: usize,
    are_same: bool,
}

impl<T> Default for Known<T> {
    fn default() -> Self {
        Self { all: Vec::new(), count: 0, are_same: false }
    }
}

impl<T> Known<T> {
    fn begin(&mut self) {
        (self.count, self.are_same) = (0, true);
    }

    fn add(&mut self, now: T, is_same: impl FnOnce(&T, &T) -> bool) {
        match self.all.get_mut(self.count) {
            Some(before) if is_same(before, &now) => {}
            Some(before) => (*before, self.are_same) = (now, false),
            None => {
                self.all.push(now);
                self.are_same = false;
            }
        }
        self.count += 1;
    }

    /// Whether all is as it was.
    fn end(&mut self) -> bool {
        self.are_same &= self.count == self.all.len();
        self.all.truncate(self.count);
        self.are_same
    }
}

/// What is the same for all objects.
#[derive(Debug, PartialEq)]
pub(crate) struct FrameSources {
    pub(crate) view: View,
    pub(crate) values: PixelValues,
    pub(crate) costs: Costs,
    pub(crate) prices: VertexPrices,
    pub(crate) choosing: Choosing,
    pub(crate) false_colors: bool,
    /// How often a mesh was laid out or forgotten.
    pub(crate) geometries: u64,
    /// See [`Backend::answers`](crate::batch::backend::Backend::answers).
    pub(crate) answers: Option<u64>,
}

/// An object.
#[derive(Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent fact")]
struct ObjectSources {
    entity: Entity,
    mesh: AssetId<Mesh>,
    reflecting: ReflectingBits,
    colored: bool,
    surrounded: bool,
    looks: MapLooks,
    has_maps: bool,
    blend: bool,
    terms: Terms,
    tolerance: Tolerance,
}

impl Sources {
    /// Takes what the frame's draws are to be made of. Returns whether that is what the last ones were made of.
    pub(crate) fn are_again(&mut self, of_frame: FrameSources, shown: &ShownObjects) -> bool {
        let of_frame_is_same = of_frame.answers.is_some() && self.of_frame.as_ref() == Some(&of_frame);
        self.objects.begin();
        self.maps.begin();
        self.images.begin();
        for object in shown.iter(of_frame.costs) {
            let maps = object.maps();
            self.objects.add(ObjectSources::new(&object, maps.is_some()), |a, b| a == b);
            let Some(maps) = maps else { continue };
            self.maps.add(maps.bits(), |a, b| a == b);
            for of in maps.slots.iter().flatten() {
                self.images.add(of.pyramid(&shown.textures), Pyramid::is_same);
            }
        }
        self.of_frame = Some(of_frame);
        let lists_are_same = [self.objects.end(), self.maps.end(), self.images.end()] == [true; 3];
        std::mem::replace(&mut self.are_known, true) && of_frame_is_same && lists_are_same
    }

    /// Nothing is known of the draws, or they are not to be drawn again.
    pub(crate) fn forget(&mut self) {
        self.are_known = false;
        // They may be large, and nobody else may hold them.
        self.images.all.clear();
    }

    pub(crate) fn are_known(&self) -> bool {
        self.are_known
    }

    /// What draws would give these answers now.
    pub(crate) fn answered(&mut self, answers: Option<u64>) {
        if let Some(of_frame) = &mut self.of_frame {
            of_frame.answers = answers;
        }
    }
}

impl ObjectSources {
    fn new(object: &ShownObject, has_maps: bool) -> Self {
        let ShownObject { entity, mesh, ref reflecting, blend, terms, tolerance, .. } = *object;
        Self {
            entity,
            mesh,
            reflecting: reflecting.bits(),
            colored: reflecting.colored,
            surrounded: reflecting.surrounded,
            looks: reflecting.maps,
            has_maps,
            blend,
            terms,
            tolerance,
        }
    }
}
