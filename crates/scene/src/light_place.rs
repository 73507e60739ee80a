//! A light of a scene file as a component and a place.

use bevy_color::{ColorToComponents, LinearRgba};
use bevy_math::{Quat, Vec3, Vec4};
use bevy_transform::components::Transform;
use halfway_lighting::equations::spot_factor;
use halfway_lighting::homogeneous::{LightPlace, from_homogeneous};
use halfway_lighting::{Attenuation, Cone, DirectionalLight, PointLight, SpotLight, rotation_along};

use crate::light::{ConeEntry, FalloffEntry, LightEntry, LightSource};
use crate::light_component::LightComponent;

/// The component of a light and its transform in the frame it is attached to. The light is one that validation passed.
pub(crate) fn place(entry: &LightEntry) -> (LightComponent, Transform) {
    match &entry.source {
        LightSource::Point { position, falloff } => {
            (LightComponent::Point(point_light(entry, falloff)), Transform::from_translation(Vec3::from(*position)))
        }
        LightSource::Spot { position, falloff, cone } => cone_light(entry, falloff, cone, Vec3::from(*position)),
        LightSource::Directional { direction } => (
            LightComponent::Directional(DirectionalLight {
                ambient: color(entry.ambient),
                diffuse: color(entry.diffuse),
                specular: color(entry.specular),
            }),
            Transform::from_rotation(along(Vec3::from(*direction))),
        ),
        LightSource::Homogeneous { position, falloff, cone } => {
            match from_homogeneous(Vec4::from(*position)) {
                Ok(LightPlace::Point(position)) => cone_light(entry, falloff, cone, position),
                Ok(LightPlace::Directional(toward)) => far_light(entry, falloff, cone, toward),
                // Refused by validation.
                Err(_) => (LightComponent::Point(point_light(entry, falloff)), Transform::IDENTITY),
            }
        }
    }
}

/// A point light, or a spot light where there is a cone.
fn cone_light(
    entry: &LightEntry,
    falloff: &FalloffEntry,
    cone: &ConeEntry,
    position: Vec3,
) -> (LightComponent, Transform) {
    let light = point_light(entry, falloff);
    let transform = Transform::from_translation(position);
    if cone.is_none() {
        return (LightComponent::Point(light), transform);
    }
    let component = LightComponent::Spot(SpotLight { light, cone: component(cone) });
    (component, transform.with_rotation(along(Vec3::from(cone.direction))))
}

/// A light at an infinite distance. The angle between its rays and the axis of its cone, if any, is the same everywhere,
/// so the cone's factor is a constant of its colours.
fn far_light(
    entry: &LightEntry,
    falloff: &FalloffEntry,
    cone: &ConeEntry,
    toward: Vec3,
) -> (LightComponent, Transform) {
    let axis = along(Vec3::from(cone.direction)) * Vec3::NEG_Z;
    let cos_phi = f64::from((-toward).dot(axis)).clamp(-1.0, 1.0);
    let terms = component(cone).along(axis.to_array().map(f64::from));
    let factor = terms.map_or(1.0, |terms| spot_factor(cos_phi, &terms)) as f32;
    let scaled = |rgb: [f32; 3]| color(rgb.map(|channel| channel * factor));
    let light = DirectionalLight {
        ambient: if falloff.attenuate_ambient { scaled(entry.ambient) } else { color(entry.ambient) },
        diffuse: scaled(entry.diffuse),
        specular: scaled(entry.specular),
    };
    (LightComponent::Directional(light), LightPlace::Directional(toward).transform())
}

fn point_light(entry: &LightEntry, falloff: &FalloffEntry) -> PointLight {
    let [constant, linear, quadratic] = falloff.attenuation;
    PointLight {
        ambient: color(entry.ambient),
        diffuse: color(entry.diffuse),
        specular: color(entry.specular),
        attenuation: Attenuation::new(constant, linear, quadratic),
        range: falloff.range,
        attenuate_ambient: falloff.attenuate_ambient,
    }
}

fn component(cone: &ConeEntry) -> Cone {
    let cutoff = cone.cutoff_deg.to_radians();
    Cone {
        cutoff,
        // Rounding may not put the inner cone outside.
        inner: cone.inner_deg.map(|inner| inner.to_radians().min(cutoff)),
        exponent: cone.exponent,
    }
}

fn color(rgb: [f32; 3]) -> LinearRgba {
    LinearRgba::from_f32_array_no_alpha(rgb)
}

/// Validation has refused directions of length 0.
fn along(direction: Vec3) -> Quat {
    rotation_along(direction).unwrap_or_default()
}
