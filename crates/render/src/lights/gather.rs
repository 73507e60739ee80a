//! Illuminate: the lights in eye space.

use crate::error::{RenderError, label};
use crate::frame::report::FrameReport;
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
    Attenuation, DirectionalLight, GlobalAmbient, InvalidValue, PointLight, Shown, SpotLight, light_direction,
    light_position,
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
    /// The same lights, in the same order, as the shaders read them, but for where they are.
    unplaced: Vec<LightRecord>,
    /// And where they are in the world.
    places: Vec<WorldPlace>,
    /// How the view sees the world, and its unit of length.
    eye_from_world: DAffine3,
    unit: f64,
    /// Whether all fall off as they do in the world, in units of length as long.
    is_unscaled: bool,
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
    pub(super) made_of: Option<MadeOf>,
}

impl Default for Lights {
    fn default() -> Self {
        Self {
            ambient: Vec3::ZERO,
            sources: Vec::new(),
            tree: LightTree::default(),
            unplaced: Vec::new(),
            places: Vec::new(),
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

/// What a frame's lights were made of. Where the next finds the same, and no light has changed, they are as they were.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MadeOf {
    /// How many entities have a light of each kind. One that goes makes them fewer, and one that comes has changed.
    entities: [usize; 3],
    ambient: LinearRgba,
    /// The view's, and its unit of length.
    view: (u64, i32),
}

/// The numbers of a light that depend on where it is looked at from and in which unit of length, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WorldPlace {
    /// Of a point or spot.
    position: Vec3,
    /// The way that a directional or spot light travels.
    direction: Vec3,
    attenuation: [f32; 3],
    range: Option<f32>,
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
        // What is hidden is looked at in each frame, and often nothing has changed.
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
                if made.source.cone.is_some() {
                    with_cones.push(made);
                } else {
                    now.add(made);
                }
                Ok(())
            });
            for made in with_cones {
                now.add(made);
            }
            // What is refused is told in each frame anew, and what is hidden is looked at in each.
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

/// A light as it is, still in world space.
struct Made {
    place: WorldPlace,
    source: Light<f64>,
}

fn directional_light(light: &DirectionalLight, at: &GlobalTransform) -> Result<Made, InvalidValue> {
    light.validate()?;
    let direction = light_direction(at)?;
    let source = light.along(direction.as_dvec3().to_array())?;
    Ok(Made {
        place: WorldPlace { position: Vec3::ZERO, direction, attenuation: [1.0, 0.0, 0.0], range: None },
        source,
    })
}

fn point_light(light: &PointLight, at: &GlobalTransform) -> Result<Made, InvalidValue> {
    light.validate()?;
    let position = light_position(at)?;
    let source = light.at(position.as_dvec3().to_array());
    Ok(Made { place: WorldPlace::new(light, position, Vec3::ZERO), source })
}

fn spot_light(spot: &SpotLight, at: &GlobalTransform) -> Result<Made, InvalidValue> {
    spot.validate()?;
    let position = light_position(at)?;
    let direction = if spot.cone.is_none() { Vec3::NEG_Z } else { light_direction(at)? };
    let source = spot.at(position.as_dvec3().to_array(), direction.as_dvec3().to_array())?;
    Ok(Made { place: WorldPlace::new(&spot.light, position, direction), source })
}

impl WorldPlace {
    fn new(light: &PointLight, position: Vec3, direction: Vec3) -> Self {
        let Attenuation { constant, linear, quadratic } = light.attenuation;
        Self { position, direction, attenuation: [constant, linear, quadratic], range: light.range }
    }
}

impl Lights {
    /// Forgets all lights.
    fn begin(&mut self, ambient: Vec3) {
        self.ambient = ambient;
        self.unplaced.clear();
        self.sources.clear();
        self.places.clear();
        self.counts = [0; 3];
    }

    fn add(&mut self, Made { place, source }: Made) {
        if !source.attenuate_ambient {
            self.ambient += Vec3::from_array(source.la.map(|channel| channel as f32));
        }
        let kind = match (source.place, source.cone) {
            (Place::Directional(_), _) => 0,
            (Place::Point(_), None) => 1,
            (Place::Point(_), Some(_)) => 2,
        };
        self.counts[kind] += 1;
        self.unplaced.push(LightRecord::from(&source));
        self.sources.push(source.cast());
        self.places.push(place);
    }

    /// What is known of all that were added, which are still in world space.
    fn sum_up(&mut self) {
        self.specular = self.unplaced.iter().any(LightRecord::is_specular);
        self.attenuated_ambient = self.unplaced.iter().any(LightRecord::attenuates_ambient);
        self.shared_color = self.unplaced.iter().all(LightRecord::shares_color);
        self.ranged = self.unplaced.iter().any(LightRecord::is_ranged);
        self.is_unscaled = true;
    }

    /// Puts every light where the view sees it.
    fn place(&mut self, view: &View) {
        (self.eye_from_world, self.unit) = (view.eye_from_world, view.unit());
        let was_unscaled = self.is_unscaled;
        self.is_unscaled = true;
        for (source, place) in self.sources.iter_mut().zip(&self.places) {
            if let Place::Directional(_) = source.place {
                source.place = Place::Directional(toward(&view.eye_from_world, place.direction).map(|x| -x));
                continue;
            }
            let position = view.eye_from_world.transform_point3(place.position.as_dvec3());
            if position.length_squared() <= FAR * FAR && was_unscaled {
                source.place = Place::Point(position.to_array().map(|x| x as f32));
            } else {
                // In the unit of the world, or a longer one.
                let near = place.brought_near(position, FAR, 1.0);
                self.is_unscaled &= near.unit <= 1.0;
                source.place = Place::Point(near.position.map(|x| x as f32));
                source.attenuation = near.attenuation.map(|x| x as f32);
                source.range = near.range.map(|x| x as f32);
            }
            if let Some(cone) = &mut source.cone {
                cone.direction = toward(&view.eye_from_world, place.direction);
            }
        }
        self.tree.rebuild(&self.sources);
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.sources.len()
    }

    /// One of them as the shaders read it.
    pub(crate) fn record(&self, number: u32) -> LightRecord {
        let number = number as usize;
        let (mut record, place) = (self.unplaced[number], &self.places[number]);
        let source = &self.sources[number];
        if let Place::Directional(from) = source.place {
            record.position = from;
            return record;
        }
        let position = self.eye_from_world.transform_point3(place.position.as_dvec3());
        // In the shaders' unit, or a longer one.
        let near = place.brought_near(position, FARTHEST, self.unit.recip());
        record.place(near.position, near.attenuation, near.range);
        if let Some(cone) = &source.cone {
            record.direction = cone.direction;
        }
        record
    }
}

/// A direction of the world, in eye space.
fn toward(eye_from_world: &DAffine3, direction: Vec3) -> [f32; 3] {
    let direction = (eye_from_world.matrix3 * direction.as_dvec3()).to_array();
    normalize_or_zero(direction).map(|x| x as f32)
}

/// The distance beyond which a light's square would not fit into f32.
const FARTHEST: f64 = 9e18;

/// The distance beyond which bounds, which take no squares of it, could leave f32.
const FAR: f64 = 1e37;

/// Where a point or spot light is seen, and how it falls off, in a unit of length.
struct Near {
    /// In world units.
    unit: f64,
    position: [f64; 3],
    attenuation: [f64; 3],
    range: Option<f64>,
}

impl WorldPlace {
    /// At a position in eye space, the lengths measured in a unit of `least` world units, or in a longer one where it
    /// would be farther than `farthest` of them. The direction is kept, so that near the eye, where what it lights is
    /// seen, it lights the same.
    #[expect(clippy::float_cmp, reason = "a unit that nothing was done to is 1 exactly")]
    fn brought_near(&self, position: DVec3, farthest: f64, least: f64) -> Near {
        // Which is so of nearly all, and takes no division.
        if least == 1.0 && position.length_squared() <= farthest * farthest {
            let (attenuation, range) = (self.attenuation.map(f64::from), self.range.map(f64::from));
            return Near { unit: 1.0, position: position.to_array(), attenuation, range };
        }
        let unit = (position.length() / farthest).max(least);
        let [constant, linear, quadratic] = self.attenuation.map(f64::from);
        Near {
            unit,
            position: (position / unit).to_array(),
            attenuation: [constant, linear * unit, quadratic * unit * unit].map(|value| value.min(f64::from(f32::MAX))),
            range: self.range.map(|range| f64::from(range) / unit),
        }
    }
}

/// A color without its alpha.
pub(crate) fn rgb(color: LinearRgba) -> Vec3 {
    Vec3::from_array(equations::rgb(color))
}
