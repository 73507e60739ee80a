//! Looks of a frame: all that follows from the components of its objects, found once for those that are equal.

use crate::batch::backend::Backend;
use crate::batch::ignored::log_ignored;
use crate::batch::key::DrawKey;
use crate::batch::object::{Circumstances, Shared};
use crate::batch::shown_objects::{ShownObject, ShownObjects};
use crate::batch::table::{ObjectTable, RunState};
use crate::geometry::meshes::{Form, shades_pixels_alone};
use crate::geometry::patches::{DetailDemand, Patches};
use crate::geometry::shape::PatchNormals;
use crate::lights::lists::{Listing, Reflector};
use crate::view::matrices::{ModelView, NormalMatrix};
use bevy_math::Vec3;
use halfway_asset::AssetId;
use halfway_lighting::bounds::Patch;
use halfway_lighting::{Faces, InvalidValue};
use halfway_mesh::Mesh;
use std::sync::Arc;

/// Everything that objects with the same components share in a frame.
#[derive(Debug)]
pub(crate) struct LitLook {
    /// Of an object that is not mirrored, before the backend has admitted it.
    pub(super) key: DrawKey,
    /// How such an object is drawn, and how a mirrored one is, once there are some.
    ways: [Option<Way>; 2],
    pub(super) material: u32,
    /// The number of its set of images, from 1 on; 0 for none.
    pub(super) maps: u32,
    pub(super) mesh: AssetId<Mesh>,
    pub(super) form: Form,
    pub(super) patches: Arc<Patches>,
    /// The number of the mesh's triangles, as modelled.
    pub(super) triangles: u64,
    pub(super) faces: Faces,
    pub(super) demand: DetailDemand,
    reflector: Reflector,
    /// The steps by which lights may be left out.
    steps: f64,
    /// How its lights are selected, once there are lists.
    listing: Option<Listing>,
    /// Images may turn its normals anywhere.
    has_relief: bool,
}

/// How objects with a look are drawn where their transforms mirror, or where they do not.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// As the backend has admitted it.
    key: DrawKey,
    /// The numbers of the calls of its passes, once there is one.
    calls: Option<[u32; 2]>,
    /// The newest run's indices, and the numbers of its states. Objects of one patch all have the same.
    newest: Option<((u32, u32), [u32; 2])>,
}

impl LitLook {
    /// `None` while the mesh is not laid out.
    pub(super) fn new(
        object: &ShownObject,
        shown: &ShownObjects,
        shared: Shared,
        table: &mut ObjectTable,
    ) -> Result<Option<Self>, InvalidValue> {
        let &ShownObject { reflecting, paint, terms, mut tolerance, .. } = object;
        if let Some(wrong) = &object.wrong_paint {
            return Err(wrong.clone());
        }
        let Some(geometry) = object.geometry(&shown.geometries) else { return Ok(None) };
        log_ignored(&reflecting.maps, terms, paint.surrounded);
        let look = table.look(&reflecting);
        if let Some(invalid) = &look.invalid {
            return Err(invalid.clone());
        }
        tolerance.validate()?;
        tolerance.steps *= shared.share as f32;
        let circumstances =
            Circumstances { terms, blend: paint.blend, mirrored: false, opposite_normals: geometry.opposite_normals };
        let key = reflecting.key(look, circumstances, shared);
        let form = object.form();
        Ok(Some(Self {
            key,
            ways: [None; 2],
            material: look.material,
            maps: object.maps().map_or(0, |maps| table.maps(&maps)),
            mesh: object.mesh,
            form,
            patches: Arc::clone(&geometry.patches),
            triangles: geometry.source.triangle_count() as u64,
            faces: reflecting.faces,
            demand: DetailDemand {
                pixels: if shades_pixels_alone(terms) { tolerance.pixels } else { 0.0 },
                lit: key.is_lit() || key.surrounded,
                has_images: key.is_mapped(),
            },
            reflector: reflecting.reflector(key.terms),
            steps: f64::from(tolerance.steps),
            listing: None,
            has_relief: paint.has_relief() && !form.flat,
        }))
    }

    /// The key of an object with this look, as the backend has admitted it.
    pub(super) fn admitted(&mut self, mirrored: bool, backend: &mut impl Backend) -> DrawKey {
        let key = DrawKey { clockwise: self.key.clockwise != mirrored, ..self.key };
        let way = || Way { key: backend.admit(key), calls: None, newest: None };
        self.ways[usize::from(mirrored)].get_or_insert_with(way).key
    }

    /// The numbers of the states of a run with these indices, one for each pass, of an object that has been admitted.
    pub(super) fn states(&mut self, mirrored: bool, indices: (u32, u32), table: &mut ObjectTable) -> &[u32] {
        let Some(way) = &mut self.ways[usize::from(mirrored)] else { return &[] };
        let passes = way.key.passes();
        if way.newest.is_none_or(|(of, _)| of != indices) {
            let calls = way.calls.get_or_insert_with(|| {
                let mut calls = [0; 2];
                for (call, key) in calls.iter_mut().zip(way.key.passes()) {
                    let maps = if key.is_mapped() { self.maps } else { 0 };
                    *call = table.call((key, self.mesh, self.form, maps));
                }
                calls
            });
            let states = calls.map(|call| table.state(RunState { twins_before: 0, call, indices }));
            way.newest = Some((indices, states));
        }
        way.newest.as_ref().and_then(|(_, states)| states.get(..passes.count())).unwrap_or_default()
    }

    /// How its lights are selected.
    pub(super) fn listing(&mut self, shared: Shared) -> &Listing {
        let Self { key, reflector, steps, .. } = self;
        self.listing.get_or_insert_with(|| {
            // A color may be black: then there is no ambient light that could hide what is left out. None is above 1.
            let ambient = if key.is_painted() { Vec3::ZERO } else { shared.lights.ambient };
            reflector.listing(ambient, shared.eye, shared.encoding, *steps)
        })
    }

    /// A patch in eye space.
    pub(super) fn in_eye_space(&self, patch: u32, model_view: &ModelView, normal_matrix: &NormalMatrix) -> Patch<f32> {
        let normals = if self.form.flat { PatchNormals::Faces } else { PatchNormals::Vertices };
        let patch = self.patches.shape(patch).in_eye_space(model_view, normal_matrix, self.faces, normals);
        if self.has_relief { Patch { normals: None, half_thickness: f32::INFINITY, ..patch } } else { patch }
    }
}

/// The looks of a frame.
#[derive(Debug, Default)]
pub(crate) struct LitLooks {
    looks: Vec<LitLook>,
    /// By the number of the look, where it is among them; [`NONE`] if it is not there.
    places: Vec<u32>,
    /// The numbers of those that are there.
    numbers: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl LitLooks {
    pub(super) fn clear(&mut self) {
        self.looks.clear();
        for number in self.numbers.drain(..) {
            self.places[number as usize] = NONE;
        }
    }

    pub(super) fn len(&self) -> usize {
        self.looks.len()
    }

    /// The look of this number, if the frame has it.
    pub(super) fn of_number(&mut self, number: u32) -> Option<&mut LitLook> {
        let place = *self.places.get(number as usize)?;
        self.looks.get_mut(place as usize)
    }

    /// Adds the look of this number.
    pub(super) fn add(&mut self, number: u32, look: LitLook) {
        if self.places.len() <= number as usize {
            self.places.resize(number as usize + 1, NONE);
        }
        self.places[number as usize] = self.looks.len() as u32;
        self.numbers.push(number);
        self.looks.push(look);
    }
}
