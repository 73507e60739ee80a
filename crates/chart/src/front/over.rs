//! Error and time over something that a scene has more or less of.

use std::f32::consts::TAU;

use halfway::prelude::*;

use super::{ChartedAdapter, ChartedScene, FrontFilter, FrontPlan, FrontPoint, KeptResults, Method, Shade};
use crate::measure::{MeasureError, MeasureProgress};

/// What is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// The exponent of the highlight.
    Shininess,
    /// The number of point lights near a sphere, all of them of one light in all.
    NearLights,
    /// The same of directional lights.
    FarLights,
    /// How far a point light is from the middle of a sphere, in its radii.
    Distance,
}

/// A family of scenes, measured.
#[derive(Clone, Debug)]
pub struct MeasuredOver {
    /// What was changed.
    pub over: Over,
    /// How much of it there was, with a point for each of [`Over::methods`].
    pub steps: Vec<(f64, Vec<FrontPoint>)>,
}

impl Over {
    /// All.
    pub const ALL: [Self; 4] = [Self::Shininess, Self::NearLights, Self::FarLights, Self::Distance];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shininess => "shininess",
            Self::NearLights => "number of point lights",
            Self::FarLights => "number of directional lights",
            Self::Distance => "distance of a point light (radii)",
        }
    }

    fn id(self) -> &'static str {
        match self {
            Self::Shininess => "shininess",
            Self::NearLights => "near-lights",
            Self::FarLights => "far-lights",
            Self::Distance => "distance",
        }
    }

    /// What it is measured at; in a quick run every other, and few lights.
    fn steps(self, quick: bool) -> Vec<f64> {
        let all: &[f64] = match self {
            Self::Shininess => &[1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0],
            Self::NearLights | Self::FarLights => &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0],
            Self::Distance => &[1.5, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0],
        };
        let steps = all.iter().copied().step_by(if quick { 2 } else { 1 });
        let many = |lights: f64| quick && lights > 64.0 && matches!(self, Self::NearLights | Self::FarLights);
        steps.filter(|step| !many(*step)).collect()
    }

    /// The methods that are compared.
    pub fn methods(self) -> Vec<Method> {
        let [flat, gouraud, phong] =
            [Shading::Flat, Shading::Gouraud, Shading::Phong].map(|shading| Method::new(Shade::At(shading)));
        let highlights = Terms { diffuse: Frequency::Vertex, specular: Frequency::Fragment };
        match self {
            Self::Shininess => vec![flat, gouraud, Method::new(Shade::Mixed(highlights)), phong],
            Self::NearLights | Self::FarLights => {
                vec![flat, gouraud, phong, Method { infinite_viewer: true, ..phong }]
            }
            Self::Distance => {
                vec![gouraud, phong, Method { far_lights: true, ..gouraud }, Method { far_lights: true, ..phong }]
            }
        }
    }

    /// A sphere of 64 meridians under what is changed.
    fn scene(self, step: f64) -> ChartedScene {
        const LEVEL: u32 = 32;
        let name = format!("{}-{step}", self.id());
        ChartedScene::of_surfaces(&name, self.name(), [LEVEL], move |world, level| {
            world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.15, 0.15, 0.15)));
            world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 2.9)));
            let shininess = if self == Self::Shininess { step as f32 } else { 32.0 };
            let grey = Material { shininess, ..Material::matte(LinearRgba::gray(0.5)) };
            let grey = Material { specular: LinearRgba::gray(0.35), ..grey };
            let mesh = world.resource_mut::<Assets<Mesh>>().add(Mesh::from(UvSphere::new(1.0, 2 * level, level)));
            world.spawn((Mesh3d(mesh), grey));
            self.lights(world, step);
        })
    }

    fn lights(self, world: &mut World, step: f64) {
        let toward = Vec3::new(0.5, 0.7, 1.0).normalize();
        match self {
            Self::Shininess => far(world, toward, 1.0),
            Self::Distance => near(world, toward * step as f32, 1.0),
            Self::NearLights | Self::FarLights => {
                let count = step as u32;
                for i in 0..count {
                    let (sin, cos) = (TAU * i as f32 / count as f32).sin_cos();
                    let place = Vec3::new(1.5 * cos, 1.5 * sin, 2.0);
                    let light = if self == Self::NearLights { near } else { far };
                    light(world, place, 1.0 / count as f32);
                }
            }
        }
    }
}

fn far(world: &mut World, toward: Vec3, share: f32) {
    let light = DirectionalLight::from_color(LinearRgba::gray(share));
    world.spawn((light, Transform::default().looking_to(-toward, Vec3::Y)));
}

/// Without attenuation, so that nothing but the direction depends on the distance.
fn near(world: &mut World, place: Vec3, share: f32) {
    let light = PointLight { attenuation: Attenuation::NONE, ..PointLight::from_color(LinearRgba::gray(share)) };
    world.spawn((light, Transform::from_translation(place)));
}

impl MeasuredOver {
    /// The units of [`MeasureProgress`] that [`all`](Self::all) will report.
    pub fn units(plan: &FrontPlan, adapters: usize) -> u64 {
        let each = |over: Over| over.steps(!plan.all_methods).len() * (1 + adapters.min(1) * over.methods().len());
        Over::ALL.into_iter().map(|over| each(over) as u64).sum()
    }

    /// Measures all, on the first adapter.
    ///
    /// # Errors
    /// The first picture that could not be drawn.
    pub fn all(
        plan: &FrontPlan,
        adapters: &[ChartedAdapter],
        kept: &mut KeptResults,
        progress: &mut MeasureProgress<'_>,
    ) -> Result<Vec<Self>, MeasureError> {
        let adapters = adapters.get(..1).unwrap_or_default();
        let of = |over: Over| {
            let methods = over.methods().into_iter().map(Method::id).collect();
            let plan = FrontPlan { only: FrontFilter { methods, detail: None }, ..plan.clone() };
            let steps = over.steps(!plan.all_methods);
            let scenes: Vec<ChartedScene> = steps.iter().map(|step| over.scene(*step)).collect();
            let found = super::sweep(&plan, &scenes, adapters, kept, progress)?;
            let steps = steps.into_iter().zip(found.into_iter().map(|scene| scene.points)).collect();
            Ok(Self { over, steps })
        };
        Over::ALL.into_iter().map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::SceneDetail;
    use super::*;

    #[test]
    fn every_step_is_a_scene_of_its_own_with_all_methods() {
        for over in Over::ALL {
            let [all, quick] = [false, true].map(|quick| over.steps(quick));
            assert!(quick.len() < all.len() && all.is_sorted(), "{over:?}");
            let methods = over.methods().into_iter().map(Method::id).collect();
            let plan = FrontPlan {
                smaller: 1,
                details: 1,
                all_methods: false,
                rounds: 1,
                budget_ms: 1.0,
                samples: 1,
                only: FrontFilter { methods, detail: None },
            };
            let scene = over.scene(all[0]);
            assert_eq!(plan.methods_of(&scene), over.methods(), "{over:?}");
            assert_eq!(plan.details_of(&scene), [SceneDetail::Cells(32)]);
        }
    }
}
