//! The images on an object.

use bevy_math::{DAffine3, DMat3, DVec3, DVec4};
use halfway_mesh::Mesh;
use halfway_texture::{Channel, FarNormals, MapKind, Pyramid, Sampling, SurfaceMap, UvTransform};

/// What the scene says of an image on an object.
#[derive(Clone, Debug)]
pub(super) struct ReadMap {
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
    /// Where the vertices lie on it.
    pub(super) uvs: Vec<[f64; 2]>,
    pub(super) channel: Channel,
    pub(super) amount: f64,
    pub(super) far_normals: FarNormals,
}

/// All of them, and what turns normals.
#[derive(Clone, Debug)]
pub(super) struct SolidMaps {
    pub(super) slots: MapSlots<SolidMap>,
    /// Where there is a normal map: the tangents of the vertices in eye space, and w.
    pub(super) tangents: Vec<DVec4>,
    /// Where there is a height map: what becomes of a unit length along the vertices' normals.
    pub(super) rises: Vec<DVec3>,
}

/// The mesh with what its images take besides coordinates: tangents, where there is a normal map and it has none.
pub(super) fn prepared(mesh: Mesh, looks: &MapSlots<ReadMap>) -> Mesh {
    match &looks[MapKind::Normal as usize] {
        Some(ReadMap { map, .. }) if mesh.tangents().is_none() => {
            mesh.clone().with_tangents_of(map.uv_set as usize).unwrap_or(mesh)
        }
        _ => mesh,
    }
}

impl SolidMaps {
    /// `None` where the mesh shows none.
    pub(super) fn new(
        mesh: &Mesh,
        looks: &MapSlots<ReadMap>,
        eye_from_model: &DAffine3,
        mirrored: bool,
    ) -> Option<Self> {
        if looks.iter().all(Option::is_none) {
            return None;
        }
        let slot = |ReadMap { pyramid, map }: &ReadMap| {
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
        let slots = looks.each_ref().map(|looks| looks.as_ref().map(slot));
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

    /// What highlights take of its normals beside where they point.
    pub(super) fn far_normals(&self) -> FarNormals {
        self.slots[MapKind::Normal as usize].as_ref().map_or(FarNormals::Mean, |map| map.far_normals)
    }
}
