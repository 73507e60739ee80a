//! An object whose patches are being lit, and what bounds of lights take of a patch.

use crate::batch::clusters::{Cluster, Clustering};
use crate::batch::key::DrawKey;
use crate::batch::object::Reflecting;
use crate::batch::painted::{Lean, PatchPaint};
use crate::device::costs::VertexPrices;
use crate::geometry::corners::{CountedCorners, ShadedCorners};
use crate::geometry::meshes::{Form, Geometry};
use crate::geometry::outlines::Sight;
use crate::geometry::seen::SeenPatch;
use crate::geometry::shape::PatchNormals;
use crate::lights::gather::Lights;
use crate::lights::memory::{ChoiceMemory, NamedPatches};
use crate::lights::places::{PlacedPatch, ShadedAt};
use crate::shaders::light_slots::Lists;
use crate::view::matrices::{ModelView, NormalMatrix};
use bevy_asset::AssetId;
use bevy_ecs::prelude::*;
use halfway_lighting::{Frequency, Tolerance};
use halfway_mesh::Mesh;

/// An object whose patches are being lit.
pub(crate) struct LitObject<'a> {
    pub(crate) entity: Entity,
    /// Among the visible ones.
    pub(crate) number: u32,
    pub(crate) reflecting: Reflecting<'a>,
    /// The key that fits best.
    pub(crate) key: DrawKey,
    pub(crate) material: u32,
    pub(crate) depth: f32,
    pub(crate) twins_before: u32,
    pub(crate) maps: u32,
    /// Images turn its normals.
    pub(crate) has_relief: bool,
    pub(crate) mesh: AssetId<Mesh>,
    pub(crate) form: Form,
    pub(crate) geometry: &'a Geometry,
    pub(crate) model_view: &'a ModelView,
    pub(crate) normal_matrix: &'a NormalMatrix,
    pub(crate) tolerance: Tolerance,
    /// Where what is coarse is shaded at corners.
    pub(crate) corners: ShadedCorners,
}

impl<'a> LitObject<'a> {
    /// Whether a patch of it may be drawn under all lights of a scene with few, where its terms are there.
    pub(crate) fn may_be_unlisted(&self, place: ShadedAt, lights: &Lights) -> bool {
        place != ShadedAt::Either && self.key.terms.has(Frequency::Auto) && Lists::new(lights.counts) != Lists::Listed
    }

    /// Whether its terms are placed light by light, and any of what is seen of it may move at these prices.
    pub(crate) fn may_move(&self, seen: &[SeenPatch], prices: &VertexPrices) -> bool {
        let is_auto = self.key.terms.has(Frequency::Auto) && *prices != VertexPrices::NEVER;
        is_auto && seen.iter().any(|seen| self.geometry.detail.patch(seen.number).shape.has_normal_cone())
    }

    /// How its patches are joined to clusters.
    pub(crate) fn clustering<'s>(&self, sight: &'s Sight<'s>) -> Clustering<'s, 'a> {
        Clustering {
            object: self.entity,
            detail: &self.geometry.detail,
            sight,
            // What images do is known patch by patch.
            may_join: self.reflecting.maps.is_empty(),
            // Of a patch by itself nobody asks but who may move terms.
            asks_of_one: self.key.terms.has(Frequency::Auto),
        }
    }

    /// Where those terms of a cluster may be shaded that are placed light by light.
    pub(crate) fn place(
        &self,
        cluster: &Cluster,
        (prices, compiled_in): (&VertexPrices, Option<usize>),
        memory: &ChoiceMemory,
    ) -> ShadedAt {
        if !self.key.terms.has(Frequency::Auto) {
            return ShadedAt::Either;
        }
        let may_save = || prices.may_save(cluster.extent, memory.before(self.name(cluster).name), compiled_in);
        if let Some(counted) = cluster.corners {
            ShadedAt::Corners(counted)
        } else if *prices != VertexPrices::NEVER && cluster.shape.has_normal_cone() && may_save() {
            ShadedAt::Either
        } else {
            ShadedAt::Fragments
        }
    }

    /// Its key, for a patch whose terms are there.
    pub(crate) fn key_at(&self, place: ShadedAt) -> DrawKey {
        DrawKey { nearest_corner: place == ShadedAt::Corners(CountedCorners::Nearest), ..self.key }
    }

    pub(crate) fn name(&self, cluster: &Cluster) -> NamedPatches {
        let seen = cluster.members.len() as u32;
        NamedPatches { name: (self.entity, cluster.name), count: cluster.count, seen }
    }

    /// What bounds of lights take of a cluster, to which images do what `paint` says.
    pub(crate) fn placed<R>(
        &self,
        cluster: &Cluster,
        place: ShadedAt,
        paint: Option<&PatchPaint>,
        with: impl FnOnce(&PlacedPatch) -> R,
    ) -> R {
        let Self { model_view, normal_matrix, reflecting, form, .. } = self;
        let lean = paint.map_or(if self.has_relief { Lean::Any } else { Lean::Within(0.0) }, |paint| paint.lean);
        let normals = if form.flat { PatchNormals::Faces } else { PatchNormals::Vertices };
        let mut seen = cluster.shape.in_eye_space(model_view, normal_matrix, reflecting.faces, normals);
        if !form.flat && self.has_relief {
            seen.normals = seen.normals.and_then(|cone| lean.widened(cone));
            if seen.normals.is_none() {
                seen.half_thickness = f32::INFINITY;
            }
        }
        with(&PlacedPatch {
            name: self.name(cluster).name,
            patch: &seen,
            shares: paint.map(|paint| paint.shares),
            grain: cluster.shape.grain(model_view),
            place,
            extent: cluster.extent,
        })
    }
}
