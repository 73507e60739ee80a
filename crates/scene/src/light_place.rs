//! A light of a scene file as a component and a place.

use bevy_color::LinearRgba;
use bevy_math::{DVec3, DVec4, Quat, Vec3, Vec4};
use bevy_transform::components::Transform;
use halfway_lighting::equations::spot_factor;
use halfway_lighting::homogeneous::{LightPlace, from_homogeneous};
use halfway_lighting::{Cone, DirectionalLight, LightComponent, SpotLight, rotation_along};

use crate::light::{ConeEntry, LightEntry, LightKind};

/// The component of a light and its transform in the frame it is attached to, counted from an origin there. The light is
/// one that validation passed.
pub(crate) fn place(entry: &LightEntry, origin: DVec3) -> (LightComponent, Transform) {
    let direction = Vec3::from(entry.cone.direction);
    let place = match entry.kind {
        // Validation has refused directions of length 0. The sky is along +Y.
        LightKind::Hemisphere => {
            let up = Quat::from_rotation_arc(Vec3::Y, along(&entry.cone) * Vec3::NEG_Z);
            return (LightComponent::Hemisphere(entry.hemisphere), Transform::from_rotation(up));
        }
        LightKind::Directional => Ok(LightPlace::Directional(-direction)),
        _ => from_homogeneous(counted_from(origin, entry.position)),
    };
    match place {
        Ok(LightPlace::Directional(toward)) => far_light(entry, toward),
        Ok(LightPlace::Point(position)) => near_light(entry, Transform::from_translation(position)),
        // Refused by validation.
        Err(_) => near_light(entry, Transform::IDENTITY),
    }
}

/// A homogeneous position less an origin: a direction stays.
fn counted_from(origin: DVec3, position: [f64; 4]) -> Vec4 {
    let position = DVec4::from(position);
    (position - (origin * position.w).extend(0.0)).as_vec4()
}

/// A point light, or a spot light where there is a cone.
fn near_light(entry: &LightEntry, transform: Transform) -> (LightComponent, Transform) {
    let light = entry.light;
    if entry.cone.is_none() {
        return (LightComponent::Point(light), transform);
    }
    let component = LightComponent::Spot(SpotLight { light, cone: component(&entry.cone) });
    (component, transform.with_rotation(along(&entry.cone)))
}

/// A light at an infinite distance. The angle between its rays and the axis of its cone, if any, is the same
/// everywhere, so the cone's factor is a constant of its colors.
fn far_light(LightEntry { light, cone, .. }: &LightEntry, toward: Vec3) -> (LightComponent, Transform) {
    let axis = along(cone) * Vec3::NEG_Z;
    let cos_phi = f64::from((-toward).dot(axis)).clamp(-1.0, 1.0);
    let terms = component(cone).along(axis.to_array().map(f64::from));
    let factor = terms.map_or(1.0, |terms| spot_factor(cos_phi, &terms)) as f32;
    let scaled = |LinearRgba { red, green, blue, .. }| LinearRgba::rgb(red * factor, green * factor, blue * factor);
    let light = DirectionalLight {
        ambient: if light.attenuate_ambient { scaled(light.ambient) } else { light.ambient },
        diffuse: scaled(light.diffuse),
        specular: scaled(light.specular),
    };
    (LightComponent::Directional(light), LightPlace::Directional(toward).transform())
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

/// Validation has refused directions of length 0.
fn along(cone: &ConeEntry) -> Quat {
    rotation_along(Vec3::from(cone.direction)).unwrap_or_default()
}
