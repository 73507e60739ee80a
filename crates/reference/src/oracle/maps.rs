//! The images on an object, and what they have where it is seen.

use bevy_math::{DAffine3, DMat3, DVec3, DVec4};
use halfway_lighting::equations::{bumped_normal, mapped_normal};
use halfway_mesh::Mesh;
use halfway_texture::{Channel, MapKind, Pyramid, Sampling, SurfaceMap, UvTransform, lookup};

use super::gather::OracleScene;
use super::raster::Hit;
use super::solid::{Color, Solid};

/// What the scene says of an image on an object.
#[derive(Clone, Debug)]
pub(super) struct MapLooks {
    pub(super) pyramid: Pyramid,
    pub(super) map: SurfaceMap,
}

/// The images of an object, each in the slot of its kind.
pub(super) type MapSlots<T> = [Option<T>; MapKind::COUNT];

/// An image on an object.
#[derive(Debug)]
struct SolidMap {
    pyramid: Pyramid,
    sampling: Sampling,
    /// Where the vertices lie on it.
    uvs: Vec<[f64; 2]>,
    channel: Channel,
    amount: f64,
}

/// All of them, and what turns normals.
#[derive(Debug)]
pub(super) struct SolidMaps {
    slots: MapSlots<SolidMap>,
    /// Where there is a normal map: the tangents of the vertices in eye space, and w.
    tangents: Vec<DVec4>,
    /// Where there is a height map: what becomes of a unit length along the vertices' normals.
    rises: Vec<DVec3>,
}

/// The mesh with what its images take besides coordinates: tangents, where there is a normal map and it has none.
pub(super) fn prepared(mesh: Mesh, looks: &MapSlots<MapLooks>) -> Mesh {
    match &looks[MapKind::Normal as usize] {
        Some(MapLooks { map, .. }) if mesh.tangents().is_none() => {
            mesh.clone().with_tangents_of(map.uv_set as usize).unwrap_or(mesh)
        }
        _ => mesh,
    }
}

impl SolidMaps {
    /// `None` where the mesh shows none.
    pub(super) fn new(
        mesh: &Mesh,
        looks: &MapSlots<MapLooks>,
        eye_from_model: &DAffine3,
        mirrored: bool,
    ) -> Option<Self> {
        if looks.iter().all(Option::is_none) {
            return None;
        }
        let slot = |MapLooks { pyramid, map }: &MapLooks| {
            let rows = map.transform.rows();
            let uvs = mesh.uv_set(map.uv_set as usize).unwrap_or_default().iter();
            SolidMap {
                pyramid: pyramid.clone(),
                sampling: map.sampling,
                uvs: uvs.map(|uv| UvTransform::apply(&rows, uv.to_array().map(f64::from))).collect(),
                channel: map.channel,
                amount: map.amount.into(),
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
    pub(super) fn has(&self, kind: MapKind) -> bool {
        self.slots[kind as usize].is_some()
    }
}

/// Where on an image a hit lies: u and v, and by how much they change from a pixel to the next, along x and along y.
struct PointOnMap {
    uv: [f64; 2],
    footprint: [[f64; 2]; 2],
}

impl OracleScene {
    /// What the image of a kind multiplies by, channel by channel and, of the color, the opacity: 1 where there is none.
    pub(super) fn factor(&self, hit: &Hit, kind: MapKind) -> [f64; 4] {
        let Some((map, place)) = self.looked_up(hit, kind) else { return [1.0; 4] };
        let texel = lookup::filtered(&map.pyramid, &map.sampling, place.uv, place.footprint);
        texel.map(|number| 1.0 + map.amount * (number.clamp(0.0, 1.0) - 1.0))
    }

    /// The same of a kind of which one number counts.
    pub(super) fn factor_of_one(&self, hit: &Hit, kind: MapKind) -> f64 {
        let channel = self.solids[hit.solid].maps.as_ref().and_then(|maps| maps.slots[kind as usize].as_ref());
        channel.map_or(1.0, |map| self.factor(hit, kind)[map.channel as usize])
    }

    /// What images multiply the opacity by.
    pub(super) fn mapped_opacity(&self, hit: &Hit) -> f64 {
        let maps = self.solids[hit.solid].maps.as_ref();
        match maps.map(|maps| maps.slots[MapKind::Opacity as usize].is_some()) {
            Some(true) => self.factor_of_one(hit, MapKind::Opacity),
            _ => self.factor(hit, MapKind::Color)[3],
        }
    }

    /// The normal of the front as the images turn it: from the interpolated one, and what stands for it where it vanishes or
    /// nothing turns it.
    pub(super) fn relief(&self, hit: &Hit, n: Color, otherwise: Color) -> Color {
        let solid = &self.solids[hit.solid];
        let (Some(maps), Some((triangle, weights))) = (&solid.maps, hit.on_triangle()) else { return otherwise };
        let vertices = solid.vertices(triangle);
        if let Some((map, place)) = self.looked_up(hit, MapKind::Normal) {
            let texel = lookup::filtered(&map.pyramid, &map.sampling, place.uv, place.footprint);
            let [r, g, b, _] = texel.map(|number| number.clamp(0.0, 1.0));
            let t: DVec4 = (0..3).map(|i| maps.tangents[vertices[i]] * weights[i]).sum();
            return mapped_normal(n, t.truncate().to_array(), t.w, [r, g, b], map.amount, otherwise);
        }
        let Some((map, place)) = self.looked_up(hit, MapKind::Height) else { return otherwise };
        let d = lookup::level(map.pyramid.size(), place.footprint);
        let [along_u, along_v] = lookup::gradient(&map.pyramid, &map.sampling, place.uv, d, map.channel);
        let [a, b, c] = solid.triangle(triangle);
        let uvs = vertices.map(|number| map.uvs[number]);
        let rise = |k: usize| map.amount * (along_u * (uvs[k][0] - uvs[0][0]) + along_v * (uvs[k][1] - uvs[0][1]));
        let m: DVec3 = (0..3).map(|i| maps.rises[vertices[i]] * weights[i]).sum();
        bumped_normal(n, m.to_array(), [(b - a).to_array(), (c - a).to_array()], [rise(1), rise(2)], otherwise)
    }

    /// The image of a kind, and where on it a hit lies.
    fn looked_up(&self, hit: &Hit, kind: MapKind) -> Option<(&SolidMap, PointOnMap)> {
        let solid = &self.solids[hit.solid];
        let map = solid.maps.as_ref()?.slots[kind as usize].as_ref()?;
        let (triangle, weights) = hit.on_triangle()?;
        Some((map, self.place(solid, map, triangle, weights, hit.depth)))
    }

    /// The footprint is a pixel's. On a triangle u = Σ uᵢVᵢ/Σ Vᵢ, Vᵢ the volume of the ray with the edge opposite to a corner,
    /// which is linear over the picture: the derivative follows by the rule of quotients.
    fn place(&self, solid: &Solid, map: &SolidMap, triangle: u32, weights: [f64; 3], depth: f64) -> PointOnMap {
        let [a, b, c] = solid.triangle(triangle);
        let uvs = solid.vertices(triangle).map(|number| map.uvs[number]);
        let uv = [0, 1].map(|k| (0..3).map(|i| weights[i] * uvs[i][k]).sum::<f64>());
        let [u, v, w] = weights;
        let ray = (a * u + b * v + c * w) / depth;
        let normals = [b.cross(c), c.cross(a), a.cross(b)];
        let sum: f64 = normals.iter().map(|n| n.dot(ray)).sum();
        let first = self.view.ray(0.0, 0.0);
        let footprint = [self.view.ray(1.0, 0.0), self.view.ray(0.0, 1.0)].map(|next| {
            let grown = normals.map(|n| n.dot(next - first));
            [0, 1].map(|k| (0..3).map(|i| (uvs[i][k] - uv[k]) * grown[i]).sum::<f64>() / sum)
        });
        PointOnMap { uv, footprint }
    }
}
