//! Illuminate: the lights in eye space.

use crate::error::{RenderError, label};
use crate::frame::report::FrameReport;
use crate::shaders::records::LightRecord;
use crate::view::camera::View;
use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_lighting::equations::Light;
use halfway_lighting::{
    Attenuation, Cone, DirectionalLight, GlobalAmbient, InvalidValue, PointLight, Shown, SpotLight, light_direction,
    light_position,
};

/// The scene's lights, sorted by kind. Holds after [`RenderSet::Illuminate`](crate::RenderSet::Illuminate).
#[derive(Resource, Clone, Debug, Default, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent fact about the records")]
pub struct Lights {
    /// Ga + Σ La of the lights that do not attenuate their ambient.
    pub(crate) ambient: Vec3,
    pub(crate) records: Vec<LightRecord>,
    /// The same lights, in the same order, as the equations take them.
    pub(crate) sources: Vec<Light<f32>>,
    /// How many directional, point and spot lights, in this order.
    pub(crate) counts: [u32; 3],
    /// Whether any has a specular colour.
    pub(crate) specular: bool,
    /// Whether any attenuates its ambient colour.
    pub(crate) attenuated_ambient: bool,
    /// Whether every specular colour is the diffuse colour.
    pub(crate) shared_colour: bool,
    /// Whether any has a range.
    pub(crate) ranged: bool,
}

type LightQuery<'w, 's, L> = Query<'w, 's, (Entity, &'static L, &'static GlobalTransform, Option<&'static Name>)>;

#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn gather(
    directional: LightQuery<DirectionalLight>,
    points: LightQuery<PointLight>,
    spots: LightQuery<SpotLight>,
    shown: Shown,
    ambient: Res<GlobalAmbient>,
    view: Res<View>,
    mut lights: ResMut<Lights>,
    mut report: ResMut<FrameReport>,
) {
    let mut gathered =
        Gathered { view: &view, ambient: Vec3::ZERO, records: Default::default(), sources: Default::default() };
    let errors = &mut report.errors;
    match ambient.validate() {
        Ok(()) => gathered.ambient = rgb(ambient.0),
        Err(source) => errors.push(RenderError::Invalid { entity: "resource".into(), source }),
    }
    let is_shown = shown.by_entity();
    each(&directional, &is_shown, errors, |light, at| gathered.directional(light, at));
    each(&points, &is_shown, errors, |light, at| gathered.finite(light, None, at));
    each(&spots, &is_shown, errors, |spot, at| gathered.spot(spot, at));
    report.lights = gathered.records.iter().map(|of_kind| of_kind.len() as u32).sum();
    lights.set_if_neq(gathered.into_lights());
}

/// Visits lights that are shown in a fixed order, so that sums repeat, and reports those that are invalid.
fn each<L: Component>(
    query: &LightQuery<L>,
    is_shown: impl Fn(Entity) -> bool,
    errors: &mut Vec<RenderError>,
    mut add: impl FnMut(&L, &GlobalTransform) -> Result<(), InvalidValue>,
) {
    let mut all: Vec<_> = query.iter().filter(|(entity, ..)| is_shown(*entity)).collect();
    all.sort_unstable_by_key(|(entity, ..)| *entity);
    for (entity, light, transform, name) in all {
        if let Err(source) = add(light, transform) {
            errors.push(RenderError::Invalid { entity: label(entity, name), source });
        }
    }
}

struct Gathered<'a> {
    view: &'a View,
    ambient: Vec3,
    records: [Vec<LightRecord>; 3],
    sources: [Vec<Light<f32>>; 3],
}

impl Gathered<'_> {
    fn directional(&mut self, light: &DirectionalLight, transform: &GlobalTransform) -> Result<(), InvalidValue> {
        light.validate()?;
        let direction = self.eye_direction(light_direction(transform)?);
        self.sources[0].push(light.along(direction.to_array())?);
        self.ambient += rgb(light.ambient);
        self.records[0].push(LightRecord {
            position: (-direction).to_array(),
            diffuse: rgb(light.diffuse).to_array(),
            specular: rgb(light.specular).to_array(),
            constant: 1.0,
            ..LightRecord::default()
        });
        Ok(())
    }

    fn spot(&mut self, spot: &SpotLight, transform: &GlobalTransform) -> Result<(), InvalidValue> {
        spot.validate()?;
        let cone = (!spot.cone.is_none()).then_some(&spot.cone);
        self.finite(&spot.light, cone, transform)
    }

    fn finite(
        &mut self,
        light: &PointLight,
        cone: Option<&Cone>,
        transform: &GlobalTransform,
    ) -> Result<(), InvalidValue> {
        light.validate()?;
        let position = self.view.eye_from_world.transform_point3(light_position(transform)?.as_dvec3());
        // How long the record's unit is: the shaders', or longer. A light beyond the reach of squares in f32 is brought near
        // in its direction, and its distances shrink with it.
        let unit = (position.length() / FARTHEST).max(self.view.unit().recip());
        let in_units = |value: f64| value.min(f64::from(f32::MAX)) as f32;
        let Attenuation { constant, linear, quadratic } = light.attenuation;
        let mut record = LightRecord {
            position: (position / unit).as_vec3().to_array(),
            inverse_range: light.range.map_or(0.0, |range| in_units(unit / f64::from(range))),
            diffuse: rgb(light.diffuse).to_array(),
            specular: rgb(light.specular).to_array(),
            constant,
            linear: in_units(f64::from(linear) * unit),
            quadratic: in_units(f64::from(quadratic) * unit * unit),
            ..LightRecord::default()
        };
        let mut source = light.at(position.as_vec3().clamp(Vec3::splat(-FAR), Vec3::splat(FAR)).to_array());
        if let Some(cone) = cone {
            source.cone = cone.along(self.eye_direction(light_direction(transform)?).to_array());
            record.direction = self.eye_direction(light_direction(transform)?).to_array();
            record.cos_cutoff = f64::from(cone.cutoff).cos() as f32;
            record.exponent = cone.exponent;
            (record.inner_scale, record.inner_offset) = inner_fade(cone);
        }
        if light.attenuate_ambient {
            record.ambient = rgb(light.ambient).to_array();
        } else {
            self.ambient += rgb(light.ambient);
        }
        let kind = if cone.is_some() { 2 } else { 1 };
        self.records[kind].push(record);
        self.sources[kind].push(source);
        Ok(())
    }

    fn eye_direction(&self, world: Vec3) -> Vec3 {
        let world: DVec3 = world.as_dvec3();
        (self.view.eye_from_world.matrix3 * world).normalize_or_zero().as_vec3()
    }

    #[expect(clippy::float_cmp, reason = "a colour that is left out is exactly 0, and a shared colour is a copy")]
    fn into_lights(self) -> Lights {
        let counts = self.records.each_ref().map(|of_kind| of_kind.len() as u32);
        let records = self.records.concat();
        Lights {
            ambient: self.ambient,
            sources: self.sources.concat(),
            counts,
            specular: records.iter().any(|light| light.specular != [0.0; 3]),
            attenuated_ambient: records.iter().any(|light| light.ambient != [0.0; 3]),
            shared_colour: records.iter().all(|light| light.specular == light.diffuse),
            ranged: records.iter().any(|light| light.inverse_range > 0.0),
            records,
        }
    }
}

/// The distance beyond which a light's square would not fit into f32.
const FARTHEST: f64 = 9e18;

/// Where bounds have a light that is farther along an axis; there it only seems brighter.
const FAR: f32 = 1e37;

/// The inner cone's fade of `KHR_lights_punctual`, s = clamp((cos φ − cos cutoff)/(cos inner − cos cutoff), 0, 1), as scale
/// and offset of cos φ; 0 and 1, which is s = 1, where there is no inner cone or it is as wide as the cutoff.
fn inner_fade(cone: &Cone) -> (f32, f32) {
    let cos_cutoff = f64::from(cone.cutoff).cos();
    let width = cone.inner.map_or(0.0, |inner| f64::from(inner).cos() - cos_cutoff);
    if width > 0.0 { ((1.0 / width) as f32, (-cos_cutoff / width) as f32) } else { (0.0, 1.0) }
}

pub(crate) fn rgb(color: LinearRgba) -> Vec3 {
    Vec3::new(color.red, color.green, color.blue)
}
