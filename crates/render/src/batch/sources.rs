//! What the draws of a frame are made of. Where the next frame finds the same, they are drawn again.

use crate::batch::key::MapLooks;
use crate::batch::object::ReflectingBits;
use crate::batch::shown_objects::{ShownObject, ShownObjects};
use crate::batch::table::{MapUse, MapsBits, MapsUse};
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
#[derive(Clone, Debug)]
pub(crate) struct Sources {
    of_frame: FrameSources,
    objects: Vec<ObjectSources>,
    /// The images, those of one object after those of the other.
    images: Vec<Pyramid>,
}

/// What is the same for all objects.
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq)]
struct ObjectSources {
    entity: Entity,
    mesh: AssetId<Mesh>,
    reflecting: ReflectingBits,
    colored: bool,
    surrounded: bool,
    looks: MapLooks,
    maps: Option<MapsBits>,
    blend: bool,
    terms: Terms,
    tolerance: Tolerance,
}

impl Sources {
    pub(crate) fn new(of_frame: FrameSources, shown: &ShownObjects) -> Self {
        let (mut objects, mut images) = (Vec::new(), Vec::new());
        for object in shown.iter(of_frame.costs) {
            let maps = object.maps();
            let slots = maps.iter().flat_map(|maps| maps.slots.iter().flatten());
            images.extend(slots.map(|of: &MapUse| of.pyramid(&shown.textures)));
            objects.push(ObjectSources::new(&object, maps.as_ref()));
        }
        Self { of_frame, objects, images }
    }

    /// Whether draws that are made of these are those that were made of the others.
    pub(crate) fn are(&self, others: &Self) -> bool {
        let of_frame = &self.of_frame;
        let images = || self.images.iter().zip(&others.images);
        of_frame.answers.is_some()
            && *of_frame == others.of_frame
            && self.objects == others.objects
            && self.images.len() == others.images.len()
            && images().all(|(a, b)| a.is_same(b))
    }

    /// The same, where what draws would give these answers now.
    pub(crate) fn answered(mut self, answers: Option<u64>) -> Self {
        self.of_frame.answers = answers;
        self
    }
}

impl ObjectSources {
    fn new(object: &ShownObject, maps: Option<&MapsUse>) -> Self {
        let ShownObject { entity, mesh, ref reflecting, blend, terms, tolerance, .. } = *object;
        Self {
            entity,
            mesh,
            reflecting: reflecting.bits(),
            colored: reflecting.colored,
            surrounded: reflecting.surrounded,
            looks: reflecting.maps,
            maps: maps.map(MapsUse::bits),
            blend,
            terms,
            tolerance,
        }
    }
}
