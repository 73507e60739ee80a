//! An animation under moving lights and a moving camera, each frame drawn by automatic shading and judged by the
//! oracle.

use std::f32::consts::TAU;
use std::time::Duration;

use halfway::mesh::{Tessellation, Torus, tessellate};
use halfway::prelude::*;
use halfway::reference::metrics::{Bars, Verdict, judge};
use halfway::reference::{Image, Oracle};
use halfway::render::{Adapter, Choosing, RenderError, VertexPrices};

use crate::judge::Finding;

/// One App from frame to frame: what is chosen steadily may depend on the frames before, and the tolerance may not.
/// Each frame is drawn within another of [`Animation::STEPS`] and judged by Phong shading of all lights and that
/// tolerance.
pub struct Animation {
    app: App,
    size: UVec2,
    /// How it is drawn; it is judged by Phong shading.
    drawn: Shading,
}

/// How a frame of an animation did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameFigures {
    /// The tolerance that it was drawn within, in steps of 1/255.
    pub steps: f32,
    /// The picture in floating point.
    pub verdict: Verdict,
    /// The largest sum of bounds, in steps.
    pub spent: f64,
    /// Terms of lights that were shaded at vertices.
    pub terms_at_vertices: u64,
    /// Patches of which a term has changed its place since the frame before.
    pub choices_changed: u32,
}

/// What goes round, along which ellipse and how often in [`Animation::FRAMES`].
#[derive(Component, Clone, Copy)]
struct GoesRound {
    center: Vec3,
    radii: Vec3,
    turns: f32,
    start: f32,
    /// What its −Z axis is turned to.
    target: Vec3,
}

impl GoesRound {
    fn at(&self, frame: u32) -> Transform {
        let angle = TAU * (self.start + self.turns * frame as f32 / Animation::FRAMES as f32);
        // Up and down twice a turn, so that no light only goes round.
        let way = Vec3::new(angle.sin(), (2.0 * angle).sin(), angle.cos());
        Transform::from_translation(self.center + self.radii * way).looking_at(self.target, Vec3::Y)
    }
}

impl Animation {
    /// How many frames it has; it goes on from the first.
    pub const FRAMES: u32 = 300;

    /// The tolerances of the frames, in rotation.
    pub const STEPS: [f32; 5] = [0.5, 1.0, 2.0, 4.0, 8.0];

    /// Drawn by this adapter, in pictures of this size.
    ///
    /// # Errors
    /// [`Finding::NoScene`] where a surface could not be cut into triangles.
    pub fn new(adapter: Adapter, size: UVec2) -> Result<Self, Finding> {
        let mut app = App::new();
        app.add_plugins(HalfwayPlugins::headless(size));
        adapter.insert_into(app.world_mut());
        app.insert_resource(Headless { size, pixels: Pixels::Float })
            .insert_resource(GlobalAmbient(LinearRgba::gray(0.1)))
            .insert_resource(bevy_time::TimeUpdateStrategy::ManualDuration(Duration::ZERO))
            // What is within the tolerance is tried whether it pays or not; and what was chosen before stays as it may.
            .insert_resource(VertexPrices::FREE)
            .insert_resource(Choosing::Steadily);
        app.finish();
        app.cleanup();
        let torus = Torus { radius: 0.75, tube: 0.25 };
        let ring = tessellate(&[&torus], Tessellation::Count { rows: 48, columns: 120 });
        let mut animation = Self { app, size, drawn: Shading::Auto };
        animation.spawn(ring.map_err(|error| Finding::NoScene(error.to_string()))?);
        Ok(animation)
    }

    /// Chooses in each frame anew, or steadily.
    #[must_use]
    pub fn choosing(mut self, choosing: Choosing) -> Self {
        self.app.insert_resource(choosing);
        self
    }

    /// Has something else drawn, to see that it is found.
    #[must_use]
    pub fn shaded(self, drawn: Shading) -> Self {
        Self { drawn, ..self }
    }

    fn shade(&mut self, shading: Shading) {
        let world = self.app.world_mut();
        for mut of_view in world.query_filtered::<&mut Shading, With<Camera>>().iter_mut(world) {
            *of_view = shading;
        }
    }

    fn spawn(&mut self, ring: Mesh) {
        let world = self.app.world_mut();
        let mut add = |mesh: Mesh| Mesh3d(world.resource_mut::<Assets<Mesh>>().add(mesh));
        let [ball, small] = [UvSphere::new(0.9, 160, 80), UvSphere::new(0.4, 80, 40)].map(|sphere| add(sphere.into()));
        let [ring, floor] = [ring, Mesh::from(Plane { size: 7.0, divisions: 72 })].map(add);
        let shiny = |red, green, blue, shininess| Material {
            specular: LinearRgba::gray(0.6),
            shininess,
            ..Material::matte(LinearRgba::rgb(red, green, blue))
        };
        world.spawn((ball, shiny(0.7, 0.4, 0.3, 19.5), Transform::from_xyz(-1.0, 0.2, 0.0)));
        let turned = Transform::from_xyz(1.1, 0.1, -0.2).with_rotation(Quat::from_euler(EulerRot::XYZ, 0.9, 0.4, 0.2));
        let back = BackMaterial(shiny(0.2, 0.6, 0.7, 6.0));
        world.spawn((ring, shiny(0.3, 0.5, 0.8, 8.0), back, Faces::Both, turned));
        world.spawn((floor, shiny(0.5, 0.5, 0.45, 3.0), Transform::from_xyz(0.0, -0.9, 0.0)));
        let around = |turns, start| GoesRound {
            center: Vec3::new(0.0, 1.2, 0.0),
            radii: Vec3::new(2.2, 0.5, 2.2),
            turns,
            start,
            target: Vec3::ZERO,
        };
        let moving = world.spawn((small, shiny(0.8, 0.8, 0.3, 32.0), Reflectance::Phong, around(1.0, 0.3))).id();
        let white = |intensity| PointLight::from_color(LinearRgba::gray(intensity));
        // One goes with the small ball, above it.
        let over = Transform::from_xyz(0.0, 0.9, 0.3);
        world.spawn((white(0.5), over, ChildOf(moving)));
        world.spawn((PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..white(2.0) }, around(-2.0, 0.1)));
        world.spawn((PointLight { range: Some(3.0), ..white(0.6) }, around(3.0, 0.7)));
        let cone = Cone { cutoff: 0.6, inner: Some(0.3), exponent: 2.0 };
        let from_above = GoesRound { center: Vec3::new(0.0, 3.5, 0.0), ..around(-1.0, 0.5) };
        world.spawn((SpotLight { light: white(0.9), cone }, from_above));
        let sun = DirectionalLight::from_color(LinearRgba::rgb(0.35, 0.33, 0.3));
        world.spawn((sun, GoesRound { center: Vec3::new(0.0, 4.0, 1.0), ..around(0.5, 0.0) }));
        let far = GoesRound { center: Vec3::new(0.0, 2.0, 0.0), radii: Vec3::new(4.2, 0.8, 4.2), ..around(1.0, 0.1) };
        world.spawn((Camera::default(), Shading::Auto, far));
        let orbits: Vec<Entity> = world.query_filtered::<Entity, With<GoesRound>>().iter(world).collect();
        for entity in orbits {
            world.entity_mut(entity).insert_if_new(Transform::default());
        }
    }

    /// Moves everything to where it is in a frame, draws that within its tolerance and judges it.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn judge_frame(&mut self, frame: u32) -> Result<FrameFigures, Finding> {
        let steps = Self::STEPS[frame as usize % Self::STEPS.len()];
        self.app.insert_resource(ViewTolerance(Tolerance::steps(steps)));
        let world = self.app.world_mut();
        for (orbit, mut at) in world.query::<(&GoesRound, &mut Transform)>().iter_mut(world) {
            *at = orbit.at(frame);
        }
        let refused = |error: &dyn std::fmt::Display| Finding::Refused(error.to_string());
        self.shade(self.drawn);
        let picture = render_picture(&mut self.app).map_err(|error: RenderError| refused(&error))?;
        let Picture::Float(picture) = picture else {
            return Err(Finding::Refused("the picture is not in floating point".into()));
        };
        self.shade(Shading::Phong);
        let oracle = Oracle::new(self.app.world_mut(), self.size).map_err(|error| refused(&error))?;
        let bars = Bars::FLOAT.within(steps.into());
        let verdict = judge(&oracle, &oracle.draw(), &Image::from_float(&picture), bars);
        let verdict = verdict.map_err(|error| refused(&error))?;
        if !verdict.is_within() {
            return Err(Finding::Float(Box::new(verdict)));
        }
        let report = self.app.world().resource::<FrameReport>();
        let FrameReport { steps_spent: spent, terms_at_vertices, choices_changed, .. } = *report;
        Ok(FrameFigures { steps, verdict, spent, terms_at_vertices, choices_changed })
    }
}
