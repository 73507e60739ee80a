//! The cost and the saving of treating lights and viewers as infinitely far away: error and time over the number of
//! lights and the distance of one.

use std::f32::consts::TAU;

use halfway::prelude::*;

use super::{ChartedAdapter, ChartedScene, FrontFilter, FrontPlan, FrontPoint, Method};
use crate::error::ChartError;
use crate::page::{PageTable, Section};
use crate::progress::Progress;

/// The quantity that varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// The number of point lights near a sphere, with a constant total of light.
    Lights,
    /// The distance of a point light from the middle of a sphere, in its radii.
    Distance,
}

/// A family of scenes, measured.
#[derive(Clone, Debug)]
pub struct MeasuredOver {
    /// The quantity.
    pub over: Over,
    /// Its values, with a point for each of [`Over::methods`].
    pub steps: Vec<(f64, Vec<FrontPoint>)>,
}

impl Over {
    /// All.
    pub const ALL: [Self; 2] = [Self::Lights, Self::Distance];

    /// Its name in charts.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lights => "number of point lights",
            Self::Distance => "distance of a point light (radii)",
        }
    }

    /// The values measured; in a quick run every other, and few lights.
    fn steps(self, quick: bool) -> Vec<f64> {
        let all: &[f64] = match self {
            Self::Lights if quick => &[1.0, 4.0, 16.0, 64.0],
            Self::Lights => &[1.0, 4.0, 16.0, 64.0, 256.0],
            Self::Distance if quick => &[1.5, 10.0, 100.0, 1000.0],
            Self::Distance => &[1.5, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0],
        };
        all.to_vec()
    }

    /// The compared methods: Phong shading, with the viewer, the lights or both infinitely far away.
    pub fn methods() -> [Method; 4] {
        let phong = Method::PHONG;
        let far_viewer = Method { infinite_viewer: true, ..phong };
        [phong, far_viewer, Method { far_lights: true, ..phong }, Method { far_lights: true, ..far_viewer }]
    }

    /// A sphere of 64 meridians under the varied light; without attenuation, so that only the direction depends on the
    /// distance.
    fn scene(self, step: f64) -> ChartedScene {
        ChartedScene::from_surfaces(&format!("{}, {step}", self.name()), self.name(), [32], move |world, bands| {
            world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.15, 0.15, 0.15)));
            world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 2.9)));
            let grey = Material { shininess: 32.0, ..Material::matte(LinearRgba::gray(0.5)) };
            let grey = Material { specular: LinearRgba::gray(0.35), ..grey };
            let mesh = world.resource_mut::<Assets<Mesh>>().add(Mesh::from(UvSphere::new(1.0, 2 * bands, bands)));
            world.spawn((Mesh3d(mesh), grey));
            let (count, around, distance) = match self {
                Self::Lights => (step as u32, 1.5, 2.5),
                Self::Distance => (1, 0.0, step as f32),
            };
            let color = LinearRgba::gray(1.0 / count as f32);
            for i in 0..count {
                let (sin, cos) = (TAU * i as f32 / count as f32).sin_cos();
                let toward = Vec3::new(0.5 + around * cos, 0.7 + around * sin, 1.5).normalize();
                let light = PointLight { attenuation: Attenuation::NONE, ..PointLight::new(color) };
                world.spawn((light, Transform::from_translation(distance * toward)));
            }
        })
    }
}

impl MeasuredOver {
    /// The units of [`Progress`] that [`all`](Self::all) reports.
    pub fn units(plan: &FrontPlan, adapters: usize) -> u64 {
        let each = |over: Over| over.steps(!plan.all_methods).len() * (1 + adapters.min(1) * Over::methods().len());
        Over::ALL.into_iter().map(|over| each(over) as u64).sum()
    }

    /// Measures all, on the first adapter.
    ///
    /// # Errors
    /// The first picture that could not be drawn.
    pub fn all(
        plan: &FrontPlan,
        adapters: &[ChartedAdapter],
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Self>, ChartError> {
        let adapters = adapters.get(..1).unwrap_or_default();
        let measured = |over: Over| {
            let methods = Over::methods().map(Method::id).into();
            let plan = FrontPlan { only: FrontFilter { methods, detail: None }, ..plan.clone() };
            let steps = over.steps(!plan.all_methods);
            let scenes: Vec<ChartedScene> = steps.iter().map(|step| over.scene(*step)).collect();
            let found = super::sweep(&plan, &scenes, adapters, progress)?;
            Ok(Self { over, steps: steps.into_iter().zip(found.into_iter().map(|scene| scene.points)).collect() })
        };
        Over::ALL.into_iter().map(measured).collect()
    }

    /// The chapter of the page.
    pub fn section(all: &[Self]) -> Section {
        Section {
            title: "Far lights and far viewers".to_owned(),
            text: vec![
                "A sphere of 64 meridians under point lights. Far lights are drawn as if they were infinitely far away: the \
                 direction toward the light is one for the whole object, as it is toward an infinite viewer. The truth has \
                 every light and the viewer at its place. Times are those of a frame over the same sphere in a constant \
                 colour."
                    .to_owned(),
            ],
            tables: all.iter().map(Self::table).collect(),
            ..Section::default()
        }
    }

    /// A row for each step, with error and time of each method.
    fn table(&self) -> PageTable {
        let name = self.over.name();
        let header = std::iter::once(name.to_owned()).chain(Over::methods().map(Method::words));
        let rows = self.steps.iter().map(|(step, points)| {
            let cell =
                |point: &FrontPoint| format!("{:.2}; {:.2} ×", point.errors.covered.steps.rms, point.ratio.median);
            std::iter::once(step.to_string()).chain(points.iter().map(cell)).collect()
        });
        PageTable {
            caption: format!("RMS error in steps of 1/255, and time, over the {name}"),
            names: 1,
            header: header.collect(),
            rows: rows.collect(),
        }
    }
}
