//! Illuminate: the lights in eye space.

use crate::error::{RenderError, label};
use crate::frame::report::FrameReport;
use crate::shaders::records::LightRecord;
use crate::view::camera::View;
use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_lighting::equations::{self, Light, Place};
use halfway_lighting::{
    DirectionalLight, GlobalAmbient, InvalidValue, PointLight, Shown, SpotLight, light_direction, light_position,
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
    /// Whether any has a specular color.
    pub(crate) specular: bool,
    /// Whether any attenuates its ambient color.
    pub(crate) attenuated_ambient: bool,
    /// Whether every specular color is the diffuse color.
    pub(crate) shared_color: bool,
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
    let mut gathered = Gathered { view: &view, ambient: Vec3::ZERO, lights: Default::default() };
    let errors = &mut report.errors;
    match ambient.validate() {
        Ok(()) => gathered.ambient = rgb(ambient.0),
        Err(source) => errors.push(RenderError::Invalid { entity: "resource".into(), source }),
    }
    let is_shown = shown.by_entity();
    each(&directional, &is_shown, errors, |light, at| gathered.directional(light, at));
    each(&points, &is_shown, errors, |light, at| gathered.point(light, at));
    each(&spots, &is_shown, errors, |spot, at| gathered.spot(spot, at));
    report.lights = gathered.lights.iter().map(|of_kind| of_kind.len() as u32).sum();
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
    /// Directional, point and spot lights.
    lights: [Vec<Light<f64>>; 3],
}

impl Gathered<'_> {
    fn directional(&mut self, light: &DirectionalLight, at: &GlobalTransform) -> Result<(), InvalidValue> {
        light.validate()?;
        self.add(light.along(self.direction(at)?)?);
        Ok(())
    }

    fn point(&mut self, light: &PointLight, at: &GlobalTransform) -> Result<(), InvalidValue> {
        light.validate()?;
        self.add(light.at(self.position(at)?));
        Ok(())
    }

    fn spot(&mut self, spot: &SpotLight, at: &GlobalTransform) -> Result<(), InvalidValue> {
        spot.validate()?;
        let position = self.position(at)?;
        self.add(if spot.cone.is_none() { spot.light.at(position) } else { spot.at(position, self.direction(at)?)? });
        Ok(())
    }

    fn add(&mut self, light: Light<f64>) {
        if !light.attenuate_ambient {
            self.ambient += Vec3::from_array(light.la.map(|channel| channel as f32));
        }
        let kind = match (light.place, light.cone) {
            (Place::Directional(_), _) => 0,
            (Place::Point(_), None) => 1,
            (Place::Point(_), Some(_)) => 2,
        };
        self.lights[kind].push(light);
    }

    fn position(&self, at: &GlobalTransform) -> Result<[f64; 3], InvalidValue> {
        let world = light_position(at)?.as_dvec3();
        Ok(self.view.eye_from_world.transform_point3(world).to_array())
    }

    fn direction(&self, at: &GlobalTransform) -> Result<[f64; 3], InvalidValue> {
        let world: DVec3 = light_direction(at)?.as_dvec3();
        Ok((self.view.eye_from_world.matrix3 * world).to_array())
    }

    fn into_lights(self) -> Lights {
        let counts = self.lights.each_ref().map(|of_kind| of_kind.len() as u32);
        let lights = self.lights.concat();
        // The shaders' unit, or a longer one.
        let unit = self.view.unit().recip();
        let near = |light| LightRecord::from(&brought_near(light, FARTHEST, unit));
        let records: Vec<_> = lights.iter().map(near).collect();
        Lights {
            ambient: self.ambient,
            sources: lights.iter().map(|light| brought_near(light, FAR, 1.0).cast()).collect(),
            counts,
            specular: records.iter().any(LightRecord::is_specular),
            attenuated_ambient: records.iter().any(LightRecord::attenuates_ambient),
            shared_color: records.iter().all(LightRecord::shares_color),
            ranged: records.iter().any(LightRecord::is_ranged),
            records,
        }
    }
}

/// The distance beyond which a light's square would not fit into f32.
const FARTHEST: f64 = 9e18;

/// The distance beyond which bounds, which take no squares of it, could leave f32.
const FAR: f64 = 1e37;

/// The same light, its lengths measured in a unit of `least` world units, or in a longer one where it would be farther than
/// `farthest` of them. The direction is kept, so that near the eye, where what it lights is seen, it lights the same.
fn brought_near(light: &Light<f64>, farthest: f64, least: f64) -> Light<f64> {
    let Place::Point(position) = light.place else { return *light };
    let position = DVec3::from_array(position);
    let unit = (position.length() / farthest).max(least);
    let [constant, linear, quadratic] = light.attenuation;
    Light {
        place: Place::Point((position / unit).to_array()),
        attenuation: [constant, linear * unit, quadratic * unit * unit].map(|value| value.min(f64::from(f32::MAX))),
        range: light.range.map(|range| range / unit),
        ..*light
    }
}

/// A color without its alpha.
pub(crate) fn rgb(color: LinearRgba) -> Vec3 {
    Vec3::from_array(equations::rgb(color))
}
