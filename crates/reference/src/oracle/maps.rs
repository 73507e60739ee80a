//! The images on an object.

use bevy_math::{DAffine3, DMat3, DVec3, DVec4};
use halfway_mesh::Mesh;
use halfway_texture::{Channel, FarNormals, MapKind, Pyramid, Sampling, SurfaceMap, UvTransform};

/// An image on an object as the scene's components describe it.
#[derive(Clone, Debug)]
pub(super) struct MapSource {
    pub(super) pyramid: Pyramid,
    pub(super) map: SurfaceMap,
}

/// The images of an object, each in the slot of its kind.
pub(super) type MapSlots<T> = [Option<T>; MapKind::COUNT];

/// An image on an object.
#[derive(Clone, Debug)]
pub(super) struct SolidMap {
    pub(super) pyramid: Pyramid,
    pub(super) sampling: Sampling,
    /// The transformed texture coordinates of the vertices.
    pub(super) uvs: Vec<[f64; 2]>,
    pub(super) channel: Channel,
    pub(super) amount: f64,
    pub(super) far_normals: FarNormals,
}

/// The images of an object, and the vertex data of its normal and height maps.
#[derive(Clone, Debug)]
pub(super) struct SolidMaps {
    pub(super) slots: MapSlots<SolidMap>,
    /// With a normal map: the tangents of the vertices in eye space, and w.
    pub(super) tangents: Vec<DVec4>,
    /// With a height map: the vertices' model-space normals, transformed as directions into eye space.
    pub(super) rises: Vec<DVec3>,
}

/// The mesh, with tangents added if it has a normal map and no tangents.
pub(super) fn prepared(mesh: Mesh, sources: &MapSlots<MapSource>) -> Mesh {
    match &sources[MapKind::Normal as usize] {
        Some(MapSource { map, .. }) if mesh.tangents().is_none() => {
            mesh.clone().with_tangents_of(map.uv_set as usize).unwrap_or(mesh)
        }
        _ => mesh,
    }
}

impl SolidMaps {
    /// `None` if the mesh has no images.
    pub(super) fn new(
        mesh: &Mesh,
        sources: &MapSlots<MapSource>,
        eye_from_model: &DAffine3,
        mirrored: bool,
    ) -> Option<Self> {
        if sources.iter().all(Option::is_none) {
            return None;
        }
        let slot = |MapSource { pyramid, map }: &MapSource| {
            let rows = map.transform.rows();
            let uvs = mesh.uv_set(map.uv_set as usize).unwrap_or_default().iter();
            SolidMap {
                pyramid: pyramid.clone(),
                sampling: map.sampling,
                uvs: uvs.map(|uv| UvTransform::apply(&rows, uv.to_array().map(f64::from))).collect(),
                channel: map.channel,
                amount: map.amount.into(),
                far_normals: map.far_normals,
            }
        };
        let slots = sources.each_ref().map(|source| source.as_ref().map(slot));
        let m: DMat3 = eye_from_model.matrix3;
        let tangent = |t: &bevy_math::Vec4| {
            let turned = (m * t.truncate().as_dvec3()).normalize_or_zero();
            turned.extend(if mirrored { -f64::from(t.w) } else { t.w.into() })
        };
        let has = |kind: MapKind| slots[kind as usize].is_some();
        let tangents = mesh.tangents().filter(|_| has(MapKind::Normal)).unwrap_or_default();
        let normals = if has(MapKind::Height) { mesh.normals() } else { &[] };
        Some(Self {
            tangents: tangents.iter().map(tangent).collect(),
            rises: normals.iter().map(|n| m * n.as_dvec3()).collect(),
            slots,
        })
    }
}

impl SolidMaps {
    /// The tangent at a point of a triangle of these vertices, not of length 1, and w.
    pub(super) fn tangent(&self, vertices: [usize; 3], weights: [f64; 3]) -> ([f64; 3], f64) {
        let t: DVec4 = (0..3).map(|i| self.tangents[vertices[i]] * weights[i]).sum();
        (t.truncate().to_array(), t.w)
    }

    pub(super) fn has(&self, kind: MapKind) -> bool {
        self.slots[kind as usize].is_some()
    }

    /// How highlights use the filtered normals of a normal map.
    pub(super) fn far_normals(&self) -> FarNormals {
        self.slots[MapKind::Normal as usize].as_ref().map_or(FarNormals::Mean, |map| map.far_normals)
    }
}
