//! Materials and images that repeat among objects, numbered.

use crate::batch::key::{DrawKey, levels_taken};
use crate::batch::object::{Appearance, Reflecting, ReflectingBits};
use crate::geometry::meshes::Form;
use bevy_math::Vec3;
use bevy_platform::collections::HashMap;
use halfway_asset::{AssetId, Assets};
use halfway_lighting::record::{SurfaceLights, SurfaceRecord};
use halfway_mesh::Mesh;
use halfway_texture::{
    FarNormals, ImageForm, MapKind, Pyramid, SolidKind, SolidTexture, SurfaceMap, Texture, UvTransform,
};
use std::sync::OnceLock;

/// Materials and images that repeat among objects, numbered, so that objects compare by small integers.
#[derive(Debug, Default)]
pub struct ObjectTable {
    /// Kept from frame to frame, for lights with this ambient.
    looks: HashMap<ReflectingBits, Appearance>,
    /// How often the frame has asked for one.
    asked: usize,
    ambient: Vec3,
    /// The records without lights, each once.
    materials: Vec<SurfaceRecord>,
    material_numbers: HashMap<[u32; size_of::<SurfaceRecord>() / 4], u32>,
    /// Of each material that the frame has, its newest lights, and the number of the record with them.
    last_lights: Vec<Option<(SurfaceLights, u32)>>,
    numbers: HashMap<(u32, [u32; size_of::<SurfaceLights>() / 4]), u32>,
    calls: HashMap<Call, u32>,
    pub(crate) called: Vec<Call>,
    state_numbers: HashMap<RunState, u32>,
    /// The states of runs, each once.
    pub(crate) states: Vec<RunState>,
    map_numbers: HashMap<MapsBits, u32>,
    /// The sets of images on objects of the frame, each once.
    pub maps: Vec<MapsUse>,
}

/// An image, where on it a mesh's coordinates lie, and how much it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapUse {
    /// The image.
    pub texture: AssetId<Texture>,
    /// The part of the image that its filter reads.
    pub form: ImageForm,
    /// Whether its moments are read, and not the image itself.
    pub moments: bool,
    transform: UvTransform,
    /// Its strength.
    pub amount: f32,
}

impl MapUse {
    /// The rows of the transform of texture coordinates.
    pub fn rows(&self) -> [[f32; 3]; 2] {
        self.transform.rows().map(|row| row.map(|number| number as f32))
    }

    /// The image, or what stands for it while it is not there.
    pub fn pyramid(&self, textures: &Assets<Texture>) -> Pyramid {
        textures.get(self.texture).map_or_else(missing, |texture| texture.0.clone())
    }
}

/// The images of an object, each in the slot of its kind, the opacity below which it is not there, and what it is cut
/// from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapsUse {
    /// The images by kind.
    pub slots: [Option<MapUse>; MapKind::COUNT],
    /// The opacity below which the mask leaves nothing.
    pub cutoff: f32,
    /// The solid that the object is cut from.
    pub solid: Option<SolidTexture>,
}

/// The same as a key.
pub(crate) type MapsBits =
    ([Option<(AssetId<Texture>, ImageForm, bool, [u32; 6], u32)>; MapKind::COUNT], u32, Option<SolidBits>);
pub(crate) type SolidBits = (SolidKind, u32, [[u32; 4]; 3], [[u32; 3]; 2]);

impl MapsUse {
    pub(crate) fn new(maps: &[Option<&SurfaceMap>; MapKind::COUNT], cutoff: f32, solid: Option<SolidTexture>) -> Self {
        let of = |slot: usize, map: &SurfaceMap| MapUse {
            texture: map.texture.id(),
            form: levels_taken(MapKind::ALL[slot], map.sampling.levels).form(),
            moments: MapKind::ALL[slot] == MapKind::Normal && map.far_normals == FarNormals::Lean,
            transform: map.transform,
            amount: map.amount,
        };
        Self { slots: std::array::from_fn(|slot| maps[slot].map(|map| of(slot, map))), cutoff, solid }
    }

    pub(crate) fn bits(&self) -> MapsBits {
        let bits = |of: MapUse| (of.texture, of.form, of.moments, bytemuck::cast(of.rows()), of.amount.to_bits());
        let of_solid = |SolidTexture { kind, octaves, solid_from_object, colors }: SolidTexture| {
            let rows = solid_from_object.map(|row| row.map(f32::to_bits));
            (kind, octaves, rows, colors.map(|color| color.map(f32::to_bits)))
        };
        (self.slots.map(|slot| slot.map(bits)), self.cutoff.to_bits(), self.solid.map(of_solid))
    }
}

/// One for all images that are missing.
fn missing() -> Pyramid {
    static MISSING: OnceLock<Pyramid> = OnceLock::new();
    MISSING.get_or_init(Pyramid::missing).clone()
}

/// Everything but its record that a run may share with others, by which runs are sorted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct RunState {
    /// How many opaque objects that were spawned before have its bounding sphere; such may coincide, and the first is
    /// to win. 0 for blended ones.
    pub(crate) twins_before: u32,
    /// The number of its key, mesh and form.
    pub(crate) call: u32,
    /// The first of its indices, and the first behind them.
    pub(crate) indices: (u32, u32),
}

/// A pipeline key, a mesh with its form, and the number of the set of images, from 1 on; 0 for none.
pub(crate) type Call = (DrawKey, AssetId<Mesh>, Form, u32);

impl ObjectTable {
    /// Up to this many looks are remembered however few are asked for.
    const REMEMBERED: usize = 512;

    pub(crate) fn begin(&mut self, ambient: Vec3) {
        // Materials that change every frame must not pile up, and those of a scene of many must not be made anew.
        if self.ambient != ambient || self.looks.len() > Self::REMEMBERED.max(2 * self.asked) {
            self.looks.clear();
            self.materials.clear();
            self.material_numbers.clear();
            self.ambient = ambient;
        }
        self.asked = 0;
        self.last_lights.clear();
        self.last_lights.resize(self.materials.len(), None);
        self.numbers.clear();
        self.calls.clear();
        self.called.clear();
        self.state_numbers.clear();
        self.states.clear();
        self.map_numbers.clear();
        self.maps.clear();
    }

    /// The appearance of an object, remembered by its components' values.
    pub(crate) fn look(&mut self, reflecting: &Reflecting) -> &Appearance {
        self.asked += 1;
        let Self { looks, materials, material_numbers, last_lights, ambient, .. } = self;
        looks.entry(reflecting.bits()).or_insert_with(|| {
            reflecting.look(*ambient, |record| {
                *material_numbers.entry(bytemuck::cast(record)).or_insert_with(|| {
                    materials.push(record);
                    last_lights.push(None);
                    materials.len() as u32 - 1
                })
            })
        })
    }

    /// The number of the frame's record with this material and these lights. Neighbours often have the same lights, and
    /// to compare is cheaper than to look up.
    pub(crate) fn number(&mut self, records: &mut Vec<SurfaceRecord>, material: u32, lights: SurfaceLights) -> u32 {
        let last = &mut self.last_lights[material as usize];
        if let Some((_, number)) = last.filter(|(there, _)| *there == lights) {
            return number;
        }
        let number = *self.numbers.entry((material, bytemuck::cast(lights))).or_insert_with(|| {
            records.push(SurfaceRecord { lights, ..self.materials[material as usize] });
            records.len() as u32 - 1
        });
        *last = Some((lights, number));
        number
    }

    pub(crate) fn materials_in_use(&self) -> u32 {
        self.last_lights.iter().flatten().count() as u32
    }

    /// The number of a set of images, from 1 on.
    pub fn maps(&mut self, of: &MapsUse) -> u32 {
        *self.map_numbers.entry(of.bits()).or_insert_with(|| {
            self.maps.push(*of);
            self.maps.len() as u32
        })
    }

    /// The number of a call. Neighbours often have the same, and to compare is cheaper than to look up.
    pub(crate) fn call(&mut self, call: Call) -> u32 {
        if self.called.last() == Some(&call) {
            return self.called.len() as u32 - 1;
        }
        *self.calls.entry(call).or_insert_with(|| {
            self.called.push(call);
            self.called.len() as u32 - 1
        })
    }

    /// The number of a state. Neighbours often have the same, and to compare is cheaper than to look up.
    pub(crate) fn state(&mut self, state: RunState) -> u32 {
        if self.states.last() == Some(&state) {
            return self.states.len() as u32 - 1;
        }
        *self.state_numbers.entry(state).or_insert_with(|| {
            self.states.push(state);
            self.states.len() as u32 - 1
        })
    }
}
