//! Illuminate: the lights in eye space.

use crate::error::{RenderError, label};
use crate::report::FrameReport;
use crate::view::camera::View;
use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{DAffine3, Vec3};
use halfway_lighting::GlobalAmbient;
use halfway_lighting::bounds::LightTree;
use halfway_lighting::equations;
use halfway_lighting::lights::{Kind, KindSet, Light, LightNeeds, LightQueries, LightSource, LightView};
use halfway_lighting::record::LightRecord;
#[cfg(test)]
use {
    bevy_transform::components::GlobalTransform,
    halfway_lighting::{LightComponent, PointLight},
};

/// The scene's lights, sorted by kind. Holds after [`RenderSet::Illuminate`](crate::sets::RenderSet::Illuminate).
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Lights {
    /// Ga + Σ La of the lights that do not attenuate their ambient.
    pub(crate) ambient: Vec3,
    /// As the equations take them.
    pub(crate) sources: Vec<Light<f32>>,
    /// The same, found by where they are.
    pub(super) tree: LightTree,
    /// The same lights, in the same order, in the world: sorted by kind.
    world: Vec<Light<f64>>,
    /// The view's transform, and its unit of length.
    eye_from_world: DAffine3,
    unit: f64,
    /// Their kinds.
    pub kinds: KindSet,
    /// Their demands on the shaders.
    pub needs: LightNeeds,
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
            kinds: KindSet::EMPTY,
            needs: LightNeeds::default(),
            made_of: None,
        }
    }
}

#[cfg(test)]
impl Lights {
    /// White points along the x axis from the origin on, so far from each other and reaching so far, as an eye at the
    /// origin sees them.
    pub(crate) fn in_a_row(count: u16, apart: f32, range: f32) -> Self {
        let (mut lights, light) = (Self::default(), PointLight::white().with_range(range));
        lights.world.extend((0..count).map(|number| light.at([f64::from(apart * f32::from(number)), 0.0, 0.0])));
        lights.sum_up();
        lights.place(&View::default());
        lights
    }

    /// These lights, all at one place.
    pub(crate) fn at_the_origin(components: &[LightComponent]) -> Self {
        let (mut lights, at) = (Self::default(), GlobalTransform::IDENTITY);
        lights.world.extend(components.iter().map(|light| light.placed(&at).expect("a valid light")));
        lights.sum_up();
        lights.place(&View::default());
        lights
    }
}

/// Inputs of a frame's lights. If the next frame has the same inputs and no light has changed, the lights are reused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MadeOf {
    /// The number of entities with a light of each kind. A removed light makes it smaller, and a new one counts as
    /// changed.
    entities: [usize; Kind::ALL.len()],
    ambient: LinearRgba,
    /// The view's, and its unit of length.
    view: (u64, i32),
}

pub(crate) fn gather(
    queries: LightQueries,
    ambient: Res<GlobalAmbient>,
    view: Res<View>,
    mut lights: ResMut<Lights>,
    mut report: ResMut<FrameReport>,
) {
    let made_of = MadeOf { entities: queries.counts(), ambient: ambient.0, view: (view.epoch, view.unit_exponent) };
    // As many may have been enabled.
    let are_same = !queries.have_changed();
    let may_be_hidden = queries.may_be_hidden();
    let keep = lights.made_of.filter(|_| are_same && !may_be_hidden);
    if keep != Some(made_of) {
        // Hidden lights are looked at in each frame, and often nothing has changed.
        let before = may_be_hidden.then(|| lights.clone());
        let now = lights.bypass_change_detection();
        if keep.map(|before| MadeOf { view: made_of.view, ..before }) != Some(made_of) {
            let refused = report.errors.len();
            now.begin(rgb(ambient.0));
            if let Err(source) = ambient.validate() {
                now.begin(Vec3::ZERO);
                report.errors.push(RenderError::Invalid { entity: "resource".into(), source });
            }
            queries.visit(|entity, name, light, at| match light.placed(at) {
                Ok(made) => now.world.push(made),
                Err(source) => report.errors.push(RenderError::Invalid { entity: label(entity, name), source }),
            });
            // Refused lights are reported in each frame anew, and hidden ones are looked at in each.
            let is_whole = report.errors.len() == refused && !may_be_hidden;
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
    report.lights = lights.len() as u32;
}

impl Lights {
    /// Forgets all lights.
    fn begin(&mut self, ambient: Vec3) {
        self.ambient = ambient;
        self.world.clear();
    }

    /// Sums up the lights that were added, which are in world space: those of a kind together.
    fn sum_up(&mut self) {
        // A spot without a cone is a point.
        self.world.sort_by_key(Light::kind);
        for light in &self.world {
            self.ambient += Vec3::from_array(light.steady_ambient().map(|channel| channel as f32));
        }
        self.kinds = self.world.iter().map(Light::kind).collect();
        self.needs = self.world.iter().map(Light::needs).fold(LightNeeds::default(), LightNeeds::or);
    }

    /// Puts every light where the view sees it.
    fn place(&mut self, view: &View) {
        (self.eye_from_world, self.unit) = (view.eye_from_world, view.unit());
        // Bounds measure in the unit of the world.
        let seen = LightView { eye_from_world: view.eye_from_world, unit: 1.0, farthest: FAR };
        self.sources.clear();
        self.sources.extend(self.world.iter().map(|light| light.in_eye_space(&seen).cast()));
        self.tree.rebuild(&self.sources);
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.sources.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One of them as the shaders read it.
    pub fn record(&self, number: u32) -> LightRecord {
        let Self { eye_from_world, unit, .. } = *self;
        let seen = LightView { eye_from_world, unit: unit.recip(), farthest: FARTHEST };
        LightRecord::from(&self.world[number as usize].in_eye_space(&seen))
    }
}

/// The distance beyond which a light's square would not fit into f32.
const FARTHEST: f64 = 9e18;

/// The distance beyond which bounds, which take no squares of it, could leave f32.
const FAR: f64 = 1e37;

/// A color without its alpha.
pub(crate) fn rgb(color: LinearRgba) -> Vec3 {
    Vec3::from_array(equations::rgb(color))
}
