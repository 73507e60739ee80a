//! The light from all directions.

use bevy_asset::Assets;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemState;
use bevy_math::{DMat3, DVec3};
use halfway_lighting::equations::vector::scale;
use halfway_lighting::equations::{
    Coefficients, ShadedPoint, interpolated_normal, lobe_angle, lobe_exponent, mirrored, side_normal,
    specular_exponent, surroundings, view_vector,
};
use halfway_lighting::{Fields, Frequency, InvalidValue, Shown};
use halfway_texture::MapKind;
use halfway_texture::environment::{EnvironmentLight, EnvironmentMap};

use super::error::OracleError;
use super::gather::{ALWAYS, OracleScene, label};
use super::raster::{Hit, HitPoint};
use super::solid::{Color, Solid};
use super::view::PictureView;

/// The environment, in eye space.
#[derive(Debug)]
pub(super) struct Surroundings {
    map: EnvironmentMap,
    strength: f64,
    environment_from_eye: DMat3,
    /// The level that is seen behind everything, where it is.
    sky: Option<f64>,
}

impl Surroundings {
    /// That of the first entity, where there is one.
    pub(super) fn gather(world: &mut World, view: &PictureView) -> Result<Option<Self>, OracleError> {
        let mut query = world.query::<(Entity, &EnvironmentLight, Option<&Name>)>();
        let mut shown = SystemState::<Shown>::new(world);
        let shown = shown.get(world).expect(ALWAYS);
        let is_shown = shown.by_entity();
        let first = query.iter(world).filter(|(entity, ..)| is_shown(*entity)).min_by_key(|(entity, ..)| *entity);
        let Some((entity, light, name)) = first else { return Ok(None) };
        check(light).map_err(|source| OracleError::Invalid { entity: label(entity, name), source })?;
        let maps = world.get_resource::<Assets<EnvironmentMap>>();
        let map = maps.and_then(|maps| maps.get(&light.map)).cloned().unwrap_or_else(EnvironmentMap::missing);
        let rows = DMat3::from_cols_array_2d(&light.environment_from_world()).transpose();
        let level = map.level_of(view.pixel_angle()).max(0.0);
        Ok(Some(Self {
            strength: light.strength.into(),
            environment_from_eye: rows * view.world_from_eye(),
            sky: light.sky.then_some(level),
            map,
        }))
    }

    /// From a direction of eye space.
    fn at(&self, direction: DVec3, level: f64) -> Color {
        self.map.at((self.environment_from_eye * direction).to_array(), level)
    }

    /// E of a normal of eye space.
    fn mean_light(&self, n: Color) -> Color {
        let [r, g, b, _] =
            self.map.harmonics().mean_light((self.environment_from_eye * DVec3::from_array(n)).to_array());
        [r, g, b].map(|channel| channel.max(0.0))
    }
}

fn check(light: &EnvironmentLight) -> Result<(), InvalidValue> {
    light
        .wrong()
        .map_or(Ok(()), |wrong| Fields::of("EnvironmentLight").number(wrong.field, wrong.value, false, wrong.expected))
}

impl OracleScene {
    /// What is seen along a ray where nothing is drawn.
    pub(super) fn behind(&self, ray: DVec3) -> Color {
        let sky = self.surroundings.as_ref().and_then(|around| Some((around, around.sky?)));
        sky.map_or(self.background, |(around, level)| scale(around.at(ray, level), around.strength))
    }

    /// What the environment adds to the ambient and to the specular terms at a hit, whose material there is given.
    pub(super) fn surrounded(&self, hit: &Hit, material: &Coefficients<f64>) -> [Color; 2] {
        let Some(around) = &self.surroundings else { return [[0.0; 3]; 2] };
        let solid = &self.solids[hit.solid];
        let (p, n) = self.point(solid, hit);
        let surface = ShadedPoint { position: p.to_array(), normal: side_normal(n, hit.front) };
        let r = mirrored(surface.normal, view_vector(&surface, &self.viewer));
        let exponent = specular_exponent(solid.reflectance, material.shininess);
        let alpha = lobe_exponent(solid.reflectance, exponent * self.factor_of_one(hit, MapKind::Shininess));
        let level = around.map.level_of(lobe_angle(alpha));
        let arriving = [around.mean_light(surface.normal), around.at(DVec3::from_array(r), level)];
        surroundings([material.kd, material.ks], around.strength, arriving)
    }

    /// Where a hit lies, and the normal of the front there: that of the triangle under flat shading, and one that images turn only where
    /// light is shaded at the fragments.
    fn point(&self, solid: &Solid, hit: &Hit) -> (DVec3, Color) {
        let (triangle, [u, v, w]) = match hit.place {
            HitPoint::Triangle(triangle, weights) => (triangle, weights),
            HitPoint::Surface { p, n } => return (p, n.to_array()),
        };
        let [a, b, c] = solid.triangle(triangle);
        let p = a * u + b * v + c * w;
        let geometric = solid.face(triangle).unwrap_or(DVec3::ZERO).to_array();
        if solid.terms.has(Frequency::Triangle) {
            return (p, geometric);
        }
        let [a, b, c] = solid.vertices(triangle).map(|number| solid.normals[number]);
        let n = (a * u + b * v + c * w).to_array();
        let smooth = interpolated_normal(n, geometric);
        let turns = solid.terms.has(Frequency::Fragment);
        (p, if turns { self.relief(hit, n, smooth) } else { smooth })
    }
}
