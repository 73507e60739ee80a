//! The cost of each feature of lighting: one neutral scene, with one difference at a time.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, TAU};

use halfway::prelude::*;

/// The frequency of lighting, and the surface.
#[derive(Clone, Debug)]
pub(crate) struct FeatureStage {
    /// The size of the picture in pixels.
    pub(crate) size: UVec2,
    /// The number of evaluations of a light in a frame: once a vertex, or once a pixel.
    pub(crate) evaluations: u32,
    mesh: Mesh,
    place: Transform,
    /// Distance of the camera from the middle.
    distance: f32,
    shading: Shading,
}

impl FeatureStage {
    /// Gouraud shading of a plane of 360 × 360 cells in 32 × 32 pixels: hardly anything but vertices, and no patch is
    /// culled for facing away.
    pub(crate) fn vertex() -> Self {
        Self {
            size: UVec2::splat(32),
            evaluations: (CELLS + 1) * (CELLS + 1),
            mesh: Plane { size: 2.0, divisions: CELLS }.into(),
            // A plane faces up; here it faces the camera.
            place: Transform::from_rotation(Quat::from_rotation_x(FRAC_PI_2)),
            distance: 3.0,
            shading: Shading::Gouraud,
        }
    }

    /// Phong shading of a sphere of 64 × 32 cells, seen from so near that it covers all of 640 × 480 pixels.
    pub(crate) fn fragment() -> Self {
        let size = UVec2::new(640, 480);
        Self {
            size,
            evaluations: size.element_product(),
            mesh: UvSphere::new(1.0, 64, 32).into(),
            place: Transform::default(),
            // The unit sphere's half angle is asin(1/1.7) = 36.0°; the corners of the picture lie 34.6° off its middle.
            distance: 1.7,
            shading: Shading::Phong,
        }
    }
}

/// Along each side of the plane.
const CELLS: u32 = 360;

/// The lights of a [`Feature`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FeatureLights {
    /// Infinitely far away.
    Directional(u32),
    /// Points with this falloff and range.
    Points(u32, Attenuation, Option<f32>),
    /// Points that shine into this cone.
    Spots(u32, Cone),
}

impl FeatureLights {
    /// How many there are.
    pub(crate) fn count(self) -> u32 {
        match self {
            Self::Directional(count) | Self::Points(count, ..) | Self::Spots(count, _) => count,
        }
    }
}

/// The neutral scene with a difference, as a plugin; [`Feature::BASELINE`] has none, and [`Feature::all`] are those
/// worth comparing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Feature {
    /// The difference in words.
    pub(crate) name: &'static str,
    /// The lights, all in front of the surface.
    pub(crate) lights: FeatureLights,
    pub(crate) material: Material,
    /// The material of the back, if it differs.
    pub(crate) back: Option<Material>,
    pub(crate) reflectance: Reflectance,
    pub(crate) viewer: Viewer,
    pub(crate) faces: Faces,
    /// Whether the surface is blended, at half opacity.
    pub(crate) blend: bool,
    pub(crate) samples: Samples,
    pub(crate) encoding: Encoding,
}

impl Feature {
    /// One directional light, Blinn–Phong with an exponent of 32, local viewer, front faces, opaque, one sample, sRGB.
    pub(crate) const BASELINE: Self = Self {
        name: "one directional light (the baseline)",
        lights: FeatureLights::Directional(1),
        material: Material {
            ambient: COLOR,
            diffuse: COLOR,
            specular: LinearRgba::rgb(0.35, 0.35, 0.35),
            ..Material::DEFAULT
        },
        back: None,
        reflectance: Reflectance::BlinnPhong,
        viewer: Viewer::Local,
        faces: Faces::Front,
        blend: false,
        samples: Samples::One,
        encoding: Encoding::Srgb,
    };

    /// The baseline, then everything that is compared with it.
    pub(crate) fn all() -> Vec<Self> {
        use FeatureLights::{Directional, Points, Spots};
        let it = Self::BASELINE;
        let lit = |name, lights| Self { name, lights, ..it };
        let shiny = |shininess| Material { shininess, ..it.material };
        let falloff = Attenuation::new(1.0, 0.09, 0.032);
        let hard = Cone::new(FRAC_PI_4);
        let soft = Cone { inner: Some(FRAC_PI_6), exponent: 4.0, ..hard };
        vec![
            it,
            lit("no lights", Directional(0)),
            Self { name: "no highlight", material: Material::matte(COLOR), ..it },
            lit("two directional lights", Directional(2)),
            lit("five directional lights", Directional(5)),
            lit("eight directional lights", Directional(8)),
            // One more than the renderer unrolls its loops for.
            lit("nine directional lights", Directional(9)),
            lit("sixteen directional lights", Directional(16)),
            lit("one point light", Points(1, falloff, None)),
            lit("five point lights", Points(5, falloff, None)),
            lit("five point lights, no attenuation", Points(5, Attenuation::NONE, None)),
            lit("five point lights, with a range", Points(5, falloff, Some(20.0))),
            lit("one spot light", Spots(1, hard)),
            lit("five spot lights", Spots(5, hard)),
            lit("five spot lights, soft edge, exponent 4", Spots(5, soft)),
            Self { name: "infinite viewer", viewer: Viewer::Infinite, ..it },
            Self { viewer: Viewer::Infinite, ..lit("five directional lights, infinite viewer", Directional(5)) },
            Self { viewer: Viewer::Infinite, ..lit("five point lights, infinite viewer", Points(5, falloff, None)) },
            Self { name: "Phong reflectance", reflectance: Reflectance::Phong, ..it },
            Self {
                reflectance: Reflectance::Phong,
                ..lit("five directional lights, Phong reflectance", Directional(5))
            },
            Self { name: "exponent 33", material: shiny(33.0), ..it },
            Self { name: "exponent 32.5", material: shiny(32.5), ..it },
            Self { material: shiny(33.0), ..lit("five directional lights, exponent 33", Directional(5)) },
            Self { name: "both sides", faces: Faces::Both, ..it },
            Self { name: "both sides, another material behind", faces: Faces::Both, back: Some(shiny(8.0)), ..it },
            Self { name: "blended", blend: true, ..it },
            Self { name: "four samples", samples: Samples::Four, ..it },
            Self { name: "raw bytes", encoding: Encoding::Raw, ..it },
        ]
    }

    /// Whether all of its cost beyond no lights is that of its lights, all else being as in the baseline.
    pub(crate) fn is_about_lights(&self) -> bool {
        let it = Self::BASELINE;
        self.lights.count() > 0
            && (self.faces, self.blend, self.samples, self.encoding) == (it.faces, it.blend, it.samples, it.encoding)
    }
}

/// A [`Feature`] in a [`FeatureStage`] that shows its cost, as a plugin. Nothing moves.
#[derive(Clone, Debug)]
pub(crate) struct FeatureScene {
    pub(crate) feature: Feature,
    pub(crate) stage: FeatureStage,
}

impl Plugin for FeatureScene {
    fn build(&self, app: &mut App) {
        let scene = self.clone();
        app.insert_resource(GlobalAmbient(LinearRgba::rgb(0.1, 0.1, 0.1))).add_systems(
            Startup,
            move |mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>| {
                scene.spawn(&mut commands, meshes.add(scene.stage.mesh.clone()));
            },
        );
    }
}

impl FeatureScene {
    fn spawn(&self, commands: &mut Commands, mesh: Handle<Mesh>) {
        let Self { feature, stage } = self;
        let Feature { viewer, samples, encoding, .. } = *feature;
        let camera = Camera { viewer, samples, encoding, ..Camera::default() };
        commands.spawn((camera, Transform::from_xyz(0.0, 0.0, stage.distance)));
        for i in 0..feature.lights.count() {
            feature.light(commands, i);
        }
        let material = Material { opacity: 0.5, ..feature.material };
        let look = (material, stage.shading, feature.reflectance, feature.faces);
        let mut surface = commands.spawn((Mesh3d(mesh), look, stage.place));
        if let Some(back) = feature.back {
            surface.insert(BackMaterial(back));
        }
        if feature.blend {
            surface.insert(AlphaMode::Blend);
        }
    }
}

impl Feature {
    /// The `i`-th light, on a circle between the camera and the surface, so that all light most of the visible part.
    fn light(&self, commands: &mut Commands, i: u32) {
        let (sin, cos) = (TAU * i as f32 / self.lights.count() as f32).sin_cos();
        let at = Transform::from_xyz(1.2 * cos, 1.2 * sin, 2.5).looking_at(Vec3::ZERO, Vec3::Y);
        let color = LinearRgba::rgb(0.05, 0.05, 0.05);
        match self.lights {
            FeatureLights::Directional(_) => commands.spawn((DirectionalLight::new(color), at)),
            FeatureLights::Points(_, attenuation, range) => {
                commands.spawn((PointLight { attenuation, range, ..PointLight::new(color) }, at))
            }
            FeatureLights::Spots(_, cone) => commands.spawn((SpotLight { light: PointLight::new(color), cone }, at)),
        };
    }
}

const COLOR: LinearRgba = LinearRgba::rgb(0.55, 0.42, 0.30);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_have_distinct_names_and_values() {
        let all = Feature::all();
        assert_eq!(all[0], Feature::BASELINE);
        for (i, one) in all.iter().enumerate() {
            for other in &all[..i] {
                assert_ne!(one.name, other.name);
                assert_ne!(Feature { name: "", ..*one }, Feature { name: "", ..*other }, "{}", one.name);
            }
        }
    }
}
