//! Illuminate: the lights in eye space.

use crate::error::{RenderError, label};
use crate::report::FrameReport;
use crate::view::camera::View;
use bevy_color::LinearRgba;
use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::prelude::*;
use bevy_math::{DAffine3, DVec3, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_lighting::bounds::LightTree;
use halfway_lighting::equations::vector::normalize_or_zero;
use halfway_lighting::equations::{self, Light, Place};
use halfway_lighting::record::LightRecord;
use halfway_lighting::{
    DirectionalLight, GlobalAmbient, InvalidValue, PointLight, Shown, SpotLight, light_direction, light_position,
};

/// The scene's lights, sorted by kind. Holds after [`RenderSet::Illuminate`](crate::RenderSet::Illuminate).
#[derive(Resource, Clone, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent fact about the records")]
pub struct Lights {
    /// Ga + Σ La of the lights that do not attenuate their ambient.
    pub(crate) ambient: Vec3,
    /// As the equations take them.
    pub(crate) sources: Vec<Light<f32>>,
    /// The same, found by where they are.
    pub(super) tree: LightTree,
    /// The same lights, in the same order, in the world.
    world: Vec<Light<f64>>,
    /// How the view sees the world, and its unit of length.
    eye_from_world: DAffine3,
    unit: f64,
    /// Whether all fall off as they do in the world, in units of length as long.
    is_unscaled: bool,
    /// How many directional, point and spot lights, in this order.
    pub counts: [u32; 3],
    /// Whether any has a specular color.
    pub(crate) specular: bool,
    /// Whether any attenuates its ambient color.
    pub attenuated_ambient: bool,
    /// Whether every specular color is the diffuse color.
    pub shared_color: bool,
    /// Whether any has a range.
    pub ranged: bool,
    pub(super) made_of: Option<MadeOf>,
}

impl Default for Lights {
    fn default() -> Self {
        Self {
            ambient: Vec3::ZERO,
            sources: Vec::new(),
            tree: LightTree::default(),
            world: Vec::new(),
            eye_from_world: DAffine3::IDENTITY,
            unit: 1.0,
            is_unscaled: true,
            counts: [0; 3],
            specular: false,
            attenuated_ambient: false,
            shared_color: false,
            ranged: false,
            made_of: None,
        }
    }
}

#[cfg(test)]
impl Lights {
    /// White points along the x axis from the origin on, so far from each other and reaching so far, as an eye at the
    /// origin sees them.
    pub(crate) fn in_a_row(count: u16, apart: f32, range: f32) -> Self {
        let (mut lights, light) = (Self::default(), PointLight { range: Some(range), ..PointLight::default() });
        for number in 0..count {
            let at = GlobalTransform::from_xyz(apart * f32::from(number), 0.0, 0.0);
            lights.add(point_light(&light, &at).expect("a valid light"));
        }
        lights.sum_up();
        lights.place(&View::default());
        lights
    }

    /// So many of each kind, all at one place.
    pub(crate) fn of_kinds([directional, points, spots]: [u32; 3]) -> Self {
        let (mut lights, at) = (Self::default(), GlobalTransform::IDENTITY);
        let made = (0..directional).map(|_| directional_light(&DirectionalLight::default(), &at));
        let made = made.chain((0..points).map(|_| point_light(&PointLight::default(), &at)));
        for made in made.chain((0..spots).map(|_| spot_light(&SpotLight::default(), &at))) {
            lights.add(made.expect("what is there by default is valid"));
        }
        lights.sum_up();
        lights
    }
}

/// Inputs of a frame's lights. Where the next frame finds the same, and no light has changed, they are as they were.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MadeOf {
    /// How many entities have a light of each kind. One that goes makes them fewer, and one that comes has changed.
    entities: [usize; 3],
    ambient: LinearRgba,
    /// The view's, and its unit of length.
    view: (u64, i32),
}

type LightQuery<'w, 's, L> = Query<'w, 's, (Entity, &'static L, &'static GlobalTransform, Option<&'static Name>)>;
type AnyLight = Or<(With<DirectionalLight>, With<PointLight>, With<SpotLight>)>;
type AnyChange = Or<(Changed<DirectionalLight>, Changed<PointLight>, Changed<SpotLight>, Changed<GlobalTransform>)>;

#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn gather(
    directional: LightQuery<DirectionalLight>,
    points: LightQuery<PointLight>,
    spots: LightQuery<SpotLight>,
    changed: Query<(), (AnyLight, AnyChange)>,
    disabled: Query<(), (AnyLight, With<Disabled>, Added<Disabled>)>,
    shown: Shown,
    ambient: Res<GlobalAmbient>,
    view: Res<View>,
    mut lights: ResMut<Lights>,
    mut report: ResMut<FrameReport>,
) {
    let made_of = MadeOf {
        entities: [directional.iter().len(), points.iter().len(), spots.iter().len()],
        ambient: ambient.0,
        view: (view.epoch, view.unit_exponent),
    };
    // As many may have been enabled.
    let are_same = changed.is_empty() && disabled.is_empty();
    let keep = lights.made_of.filter(|_| are_same && !shown.hides_any());
    if keep != Some(made_of) {
        // Hidden lights are looked at in each frame, and often nothing has changed.
        let before = shown.hides_any().then(|| lights.clone());
        let now = lights.bypass_change_detection();
        if keep.map(|before| MadeOf { view: made_of.view, ..before }) != Some(made_of) {
            let refused = report.errors.len();
            now.begin(rgb(ambient.0));
            if let Err(source) = ambient.validate() {
                now.begin(Vec3::ZERO);
                report.errors.push(RenderError::Invalid { entity: "resource".into(), source });
            }
            let (is_shown, errors) = (shown.by_entity(), &mut report.errors);
            each(&directional, &is_shown, errors, |light, at| directional_light(light, at).map(|made| now.add(made)));
            each(&points, &is_shown, errors, |light, at| point_light(light, at).map(|made| now.add(made)));
            // Those without a cone are points.
            let mut with_cones = Vec::new();
            each(&spots, &is_shown, errors, |spot, at| {
                let made = spot_light(spot, at)?;
                if made.cone.is_some() {
                    with_cones.push(made);
                } else {
                    now.add(made);
                }
                Ok(())
            });
            for made in with_cones {
                now.add(made);
            }
            // Refused lights are reported in each frame anew, and hidden ones are looked at in each.
            let is_whole = report.errors.len() == refused && !shown.hides_any();
            now.made_of = is_whole.then_some(made_of);
            now.sum_up();
        }
        if let Some(before) = &mut now.made_of {
            *before = made_of;
        }
        now.place(&view);
        if before.as_ref() != Some(now) {
            lights.set_changed();
        }
    }
    report.lights = lights.counts.iter().sum();
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

fn directional_light(light: &DirectionalLight, at: &GlobalTransform) -> Result<Light<f64>, InvalidValue> {
    light.validate()?;
    light.along(light_direction(at)?.as_dvec3().to_array())
}

fn point_light(light: &PointLight, at: &GlobalTransform) -> Result<Light<f64>, InvalidValue> {
    light.validate()?;
    Ok(light.at(light_position(at)?.as_dvec3().to_array()))
}

fn spot_light(spot: &SpotLight, at: &GlobalTransform) -> Result<Light<f64>, InvalidValue> {
    spot.validate()?;
    let position = light_position(at)?;
    let direction = if spot.cone.is_none() { Vec3::NEG_Z } else { light_direction(at)? };
    spot.at(position.as_dvec3().to_array(), direction.as_dvec3().to_array())
}

impl Lights {
    /// Forgets all lights.
    fn begin(&mut self, ambient: Vec3) {
        self.ambient = ambient;
        self.sources.clear();
        self.world.clear();
        self.counts = [0; 3];
    }

    fn add(&mut self, source: Light<f64>) {
        if !source.attenuate_ambient {
            self.ambient += Vec3::from_array(source.la.map(|channel| channel as f32));
        }
        let kind = match (source.place, source.cone) {
            (Place::Directional(_), _) => 0,
            (Place::Point(_), None) => 1,
            (Place::Point(_), Some(_)) => 2,
        };
        self.counts[kind] += 1;
        self.sources.push(source.cast());
        self.world.push(source);
    }

    /// Sums up the lights that were added, which are still in world space.
    #[expect(clippy::float_cmp, reason = "a shared color is a copy")]
    fn sum_up(&mut self) {
        let is_bright = |color: [f64; 3]| color.iter().any(|&channel| channel > 0.0);
        let attenuates_ambient = |light: &Light<f64>| light.attenuate_ambient && is_bright(light.la);
        self.specular = self.world.iter().any(|light| is_bright(light.ls));
        self.attenuated_ambient = self.world.iter().any(attenuates_ambient);
        self.shared_color = self.world.iter().all(|light| light.ls == light.ld);
        self.ranged = self.world.iter().any(|light| light.range.is_some());
        self.is_unscaled = true;
    }

    /// Puts every light where the view sees it.
    fn place(&mut self, view: &View) {
        (self.eye_from_world, self.unit) = (view.eye_from_world, view.unit());
        let was_unscaled = self.is_unscaled;
        self.is_unscaled = true;
        for (source, world) in self.sources.iter_mut().zip(&self.world) {
            if let (Some(cone), Some(of_world)) = (&mut source.cone, &world.cone) {
                cone.direction = toward(&view.eye_from_world, of_world.direction).map(|x| x as f32);
            }
            let position = match world.place {
                Place::Directional(direction) => {
                    source.place = Place::Directional(toward(&view.eye_from_world, direction).map(|x| x as f32));
                    continue;
                }
                Place::Point(position) => view.eye_from_world.transform_point3(position.into()),
            };
            if position.length_squared() <= FAR * FAR && was_unscaled {
                source.place = Place::Point(position.to_array().map(|x| x as f32));
            } else {
                // In the unit of the world, or a longer one.
                let (near, unit) = brought_near(world, position, FAR, 1.0);
                self.is_unscaled &= unit <= 1.0;
                *source = Light { cone: source.cone, ..near.cast() };
            }
        }
        self.tree.rebuild(&self.sources);
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.sources.len()
    }

    /// One of them as the shaders read it.
    pub fn record(&self, number: u32) -> LightRecord {
        let mut light = self.world[number as usize];
        if let Some(cone) = &mut light.cone {
            cone.direction = toward(&self.eye_from_world, cone.direction);
        }
        LightRecord::from(&match light.place {
            Place::Directional(direction) => {
                Light { place: Place::Directional(toward(&self.eye_from_world, direction)), ..light }
            }
            // In the shaders' unit, or a longer one.
            Place::Point(position) => {
                let position = self.eye_from_world.transform_point3(position.into());
                brought_near(&light, position, FARTHEST, self.unit.recip()).0
            }
        })
    }
}

/// A direction of the world, in eye space.
fn toward(eye_from_world: &DAffine3, direction: [f64; 3]) -> [f64; 3] {
    normalize_or_zero((eye_from_world.matrix3 * DVec3::from_array(direction)).to_array())
}

/// The distance beyond which a light's square would not fit into f32.
const FARTHEST: f64 = 9e18;

/// The distance beyond which bounds, which take no squares of it, could leave f32.
const FAR: f64 = 1e37;

/// A point or spot light at a position in eye space, the lengths measured in a unit of `least` world units, or in a
/// longer one where it would be farther than `farthest` of them; and that unit. The direction is kept, so that near the
/// eye, where what it lights is seen, it lights the same.
#[expect(clippy::float_cmp, reason = "a unit that nothing was done to is 1 exactly")]
fn brought_near(light: &Light<f64>, position: DVec3, farthest: f64, least: f64) -> (Light<f64>, f64) {
    // Which is so of nearly all, and takes no division.
    if least == 1.0 && position.length_squared() <= farthest * farthest {
        return (Light { place: Place::Point(position.to_array()), ..*light }, 1.0);
    }
    let unit = (position.length() / farthest).max(least);
    let [constant, linear, quadratic] = light.attenuation;
    let near = Light {
        place: Place::Point((position / unit).to_array()),
        attenuation: [constant, linear * unit, quadratic * unit * unit].map(|value| value.min(f64::from(f32::MAX))),
        range: light.range.map(|range| range / unit),
        ..*light
    };
    (near, unit)
}

/// A color without its alpha.
pub(crate) fn rgb(color: LinearRgba) -> Vec3 {
    Vec3::from_array(equations::rgb(color))
}
