//! The lights, materials, normals and frequencies of a scene under mistakes.

use std::borrow::Cow;
use std::sync::OnceLock;

use bevy_math::{DMat3, DVec3};
use halfway_lighting::equations::vector::{add, normalize, scale, sub};
use halfway_lighting::equations::{Coefficients, Eye, Light, Point, Transcendental};
use halfway_lighting::lights::LightSource;
use halfway_lighting::{Faces, Frequency, Reflectance, Terms};
use halfway_texture::MapKind;

use crate::mistakes::{Mistake, Mistakes};
use crate::oracle::scene::OracleScene;
use crate::oracle::solid::{Color, Solid, TermSums};

/// Default coefficients of the attenuation, for a student who attenuates directional lights where no other light has
/// any.
const DEFAULT_ATTENUATION: [f64; 3] = [1.0, 0.09, 0.032];

/// A scene as somebody shades it who makes mistakes.
pub(super) struct Student<'a> {
    pub(super) scene: &'a OracleScene,
    pub(super) mistakes: Mistakes,
    pub(super) viewer: Eye<f64>,
    pub(super) lights: Vec<Light<f64>>,
    /// Ambient light that is multiplied by ka.
    pub(super) ambient: Color,
    /// Ambient light that is added as it is.
    pub(super) bare_ambient: Color,
    pub(super) solids: Vec<StudentSolid<'a>>,
    /// The coefficients by which directional lights are attenuated.
    pub(super) attenuation: [f64; 3],
}

/// An object as the student shades it.
pub(super) struct StudentSolid<'a> {
    pub(super) normals: Cow<'a, [DVec3]>,
    pub(super) terms: Terms,
    pub(super) reflectance: Reflectance,
    /// The coefficients of front and back.
    pub(super) sides: [Coefficients<f64>; 2],
    /// Cached shading of the vertices or of the triangles of either side.
    pub(super) shaded: [Vec<OnceLock<TermSums>>; 2],
}

impl<'a> Student<'a> {
    pub(super) fn new(scene: &'a OracleScene, mistakes: Mistakes) -> Self {
        let lights: Vec<Light<f64>> =
            kept(scene, mistakes).into_iter().map(|light| mistaken_light(scene, light, mistakes)).collect();
        let (ambient, bare_ambient) = ambient(scene, &lights, mistakes);
        let positional = scene.lights.iter().find_map(|light| point(light).map(|point| point.attenuation));
        Self {
            scene,
            mistakes,
            viewer: viewer(scene, mistakes),
            lights,
            ambient,
            bare_ambient,
            solids: scene.solids.iter().map(|solid| StudentSolid::new(scene, solid, mistakes)).collect(),
            attenuation: positional.unwrap_or(DEFAULT_ATTENUATION),
        }
    }

    pub(super) fn makes(&self, mistake: Mistake) -> bool {
        self.mistakes.has(mistake)
    }
}

fn point<T: Copy>(light: &Light<T>) -> Option<&Point<T>> {
    match light {
        Light::Point(point) => Some(point),
        Light::Spot(spot) => Some(&spot.point),
        Light::Directional(_) | Light::Hemisphere(_) => None,
    }
}

/// The lights that the student counts. First and last are those of the scene file, whose entities are spawned in its
/// order.
fn kept(scene: &OracleScene, mistakes: Mistakes) -> Vec<Light<f64>> {
    let all = || scene.light_names.iter().map(|(entity, _)| entity).zip(&scene.lights);
    let only = if mistakes.has(Mistake::FirstLightOnly) {
        all().min_by_key(|(entity, _)| entity.index())
    } else if mistakes.has(Mistake::LastLightOnly) {
        all().max_by_key(|(entity, _)| entity.index())
    } else {
        return scene.lights.clone();
    };
    only.into_iter().map(|(_, light)| *light).collect()
}

fn mistaken_light(scene: &OracleScene, light: Light<f64>, mistakes: Mistakes) -> Light<f64> {
    let makes = |mistake| mistakes.has(mistake);
    let world_from_eye = scene.view.world_from_eye();
    let in_world = |direction: Color| (world_from_eye * DVec3::from_array(direction)).to_array();
    let mut light = light;
    let colors = match &mut light {
        Light::Directional(it) => Some(&mut it.colors),
        Light::Point(it) => Some(&mut it.colors),
        Light::Spot(it) => Some(&mut it.point.colors),
        Light::Hemisphere(_) => None,
    };
    if let Some(colors) = colors {
        if makes(Mistake::LightAmbientMissing) || makes(Mistake::AmbientMissing) {
            colors.la = [0.0; 3];
        }
        if makes(Mistake::HighlightInDiffuseLight) {
            colors.ls = colors.ld;
        }
    }
    match &mut light {
        Light::Directional(it) => {
            let toward = it.toward;
            if makes(Mistake::LightDirectionReversed) {
                it.toward = toward.map(|x| -x);
            }
            if makes(Mistake::LightDirectionInWorldSpace) {
                it.toward = in_world(it.toward);
            }
            if makes(Mistake::DirectionAsPosition) {
                return Light::Point(Point {
                    position: as_position(scene, it.toward),
                    colors: it.colors,
                    attenuation: [1.0, 0.0, 0.0],
                    range: None,
                    attenuate_ambient: false,
                });
            }
        }
        Light::Point(point) => mistake_point(scene, point, mistakes),
        Light::Spot(spot) => {
            mistake_point(scene, &mut spot.point, mistakes);
            let cone = &mut spot.cone;
            let mut turn = |of: &dyn Fn(f64) -> f64| {
                cone.cos_cutoff = of(angle(cone.cos_cutoff)).cosine();
                cone.cos_inner = cone.cos_inner.map(|cos_inner| of(angle(cos_inner)).cosine());
            };
            if makes(Mistake::CutoffAsFullAngle) {
                turn(&|cutoff| 0.5 * cutoff);
            }
            if makes(Mistake::CutoffDoubled) {
                turn(&|cutoff| 2.0 * cutoff);
            }
            if makes(Mistake::CutoffInDegrees) {
                turn(&f64::to_degrees);
            }
            if makes(Mistake::SpotInnerIgnored) || makes(Mistake::CutoffIgnored) {
                cone.cos_inner = None;
            }
            if makes(Mistake::CutoffIgnored) {
                cone.cos_cutoff = f64::NEG_INFINITY;
            }
            if makes(Mistake::SpotExponentIgnored) {
                cone.exponent = 0.0;
            }
            if makes(Mistake::SpotReversed) {
                cone.direction = cone.direction.map(|x| -x);
            }
            if makes(Mistake::SpotDirectionInWorldSpace) {
                cone.direction = in_world(cone.direction);
            }
        }
        Light::Hemisphere(_) => {}
    }
    light
}

fn mistake_point(scene: &OracleScene, point: &mut Point<f64>, mistakes: Mistakes) {
    let makes = |mistake| mistakes.has(mistake);
    if makes(Mistake::LightPositionInWorldSpace) {
        point.position = scene.view.world_from_point(point.position.into()).to_array();
    }
    if makes(Mistake::AttenuationSwapped) {
        point.attenuation.swap(1, 2);
    }
    if makes(Mistake::AttenuationInverseSquare) {
        point.attenuation = [0.0, 0.0, 1.0];
    }
    if makes(Mistake::AttenuationMissing) {
        point.attenuation = [1.0, 0.0, 0.0];
    }
    if makes(Mistake::RangeIgnored) {
        point.range = None;
    }
    if makes(Mistake::AmbientAttenuated) {
        point.attenuate_ambient = true;
    }
    if makes(Mistake::AmbientNotAttenuated) {
        point.attenuate_ambient = false;
    }
}

/// The point of eye space whose coordinates in the world are the direction toward a light.
pub(super) fn as_position(scene: &OracleScene, toward: Color) -> Color {
    scene.view.eye_from_point(scene.view.world_from_eye() * DVec3::from_array(toward)).to_array()
}

/// The angle from 0 to π that has this cosine.
fn angle(cosine: f64) -> f64 {
    // tan(φ/2)² = (1 − cos φ)/(1 + cos φ).
    2.0 * ((1.0 - cosine).max(0.0) / (1.0 + cosine).max(f64::MIN_POSITIVE)).sqrt().arc_tangent()
}

/// The ambient light that is multiplied by ka, and the ambient light that is not.
fn ambient(scene: &OracleScene, lights: &[Light<f64>], mistakes: Mistakes) -> (Color, Color) {
    let steady = |lights: &[Light<f64>]| lights.iter().fold([0.0; 3], |sum, light| add(sum, light.steady_ambient()));
    let global = || sub(scene.ambient, steady(&scene.lights));
    if mistakes.has(Mistake::AmbientMissing) {
        return ([0.0; 3], [0.0; 3]);
    }
    let of_lights = steady(lights);
    let changed = of_lights.map(f64::to_bits) != steady(&scene.lights).map(f64::to_bits);
    let times = if mistakes.has(Mistake::AmbientForEachLight) { lights.len() as f64 } else { 1.0 };
    if mistakes.has(Mistake::AmbientNotTimesKa) {
        return (of_lights, scale(global(), times));
    }
    // Without a change it is the scene's own to the bit.
    let ambient = if changed || times > 1.0 { add(scale(global(), times), of_lights) } else { scene.ambient };
    (ambient, [0.0; 3])
}

fn viewer(scene: &OracleScene, mistakes: Mistakes) -> Eye<f64> {
    if mistakes.has(Mistake::ViewerAtWorldOrigin) {
        return Eye::Local(scene.view.eye_from_point(DVec3::ZERO).to_array());
    }
    match scene.viewer {
        Eye::Local(_) if mistakes.has(Mistake::ViewerAtInfinity) => Eye::Infinite([0.0, 0.0, 1.0]),
        Eye::Infinite(_) if mistakes.has(Mistake::ViewerLocal) => Eye::Local([0.0; 3]),
        viewer => viewer,
    }
}

impl<'a> StudentSolid<'a> {
    fn new(scene: &OracleScene, solid: &'a Solid, mistakes: Mistakes) -> Self {
        let sides = solid.sides.each_ref().map(|side| coefficients(solid, side.coefficients, mistakes));
        let terms = if solid.lit { solid.terms.map(|at| frequency(at, mistakes)) } else { solid.terms };
        let evaluations = match (terms.has(Frequency::Triangle), terms.has(Frequency::Vertex)) {
            (true, _) => solid.mesh.triangle_count(),
            (false, true) => solid.corners.len(),
            (false, false) => 0,
        };
        Self {
            normals: normals(scene, solid, mistakes),
            terms,
            reflectance: reflectance(solid.reflectance, mistakes),
            sides: if mistakes.has(Mistake::BackMaterialIgnored) { [sides[0]; 2] } else { sides },
            shaded: [0, 1].map(|_| (0..evaluations).map(|_| OnceLock::new()).collect()),
        }
    }
}

fn coefficients(solid: &Solid, given: Coefficients<f64>, mistakes: Mistakes) -> Coefficients<f64> {
    let mut material = given;
    if !solid.lit {
        return material;
    }
    let makes = |mistake| mistakes.has(mistake);
    if makes(Mistake::SpecularSwapped) {
        (material.kd, material.ks) = (material.ks, material.kd);
    }
    if makes(Mistake::AmbientByKd) {
        material.ka = given.kd;
    }
    if makes(Mistake::HighlightInSurfaceColor) {
        material.ks = given.kd;
    }
    if makes(Mistake::DiffuseMissing) {
        material.kd = [0.0; 3];
    }
    if makes(Mistake::HighlightMissing) {
        material.ks = [0.0; 3];
    }
    if makes(Mistake::EmissionMissing) {
        material.ke = [0.0; 3];
    }
    if makes(Mistake::ShininessIgnored) {
        material.shininess = 1.0;
    }
    material
}

fn reflectance(given: Reflectance, mistakes: Mistakes) -> Reflectance {
    let makes = |mistake| mistakes.has(mistake);
    match given {
        Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched if makes(Mistake::PhongForBlinn) => Reflectance::Phong,
        Reflectance::Phong if makes(Mistake::BlinnForPhong) => Reflectance::BlinnPhong,
        Reflectance::BlinnPhongMatched if makes(Mistake::ExponentNotMatched) || makes(Mistake::ShininessIgnored) => {
            Reflectance::BlinnPhong
        }
        given => given,
    }
}

fn frequency(at: Frequency, mistakes: Mistakes) -> Frequency {
    let makes = |mistake| mistakes.has(mistake);
    match at {
        Frequency::Fragment if makes(Mistake::GouraudForPhong) => Frequency::Vertex,
        Frequency::Vertex if makes(Mistake::PhongForGouraud) => Frequency::Fragment,
        Frequency::Fragment | Frequency::Vertex if makes(Mistake::FlatForSmooth) => Frequency::Triangle,
        Frequency::Triangle if makes(Mistake::GouraudForFlat) => Frequency::Vertex,
        Frequency::Triangle if makes(Mistake::PhongForFlat) => Frequency::Fragment,
        at => at,
    }
}

/// Whether normals are transformed otherwise than by the inverse transpose.
pub(super) fn turns_normals(mistakes: Mistakes) -> bool {
    use Mistake as M;
    let all = [M::NormalsByModelMatrix, M::NormalsInModelSpace, M::NormalsInWorldSpace, M::NormalsReversed];
    all.into_iter().any(|mistake| mistakes.has(mistake))
}

/// A unit normal as the student transforms it, given in the space of the model.
pub(super) fn turned(scene: &OracleScene, solid: &Solid, n: DVec3, mistakes: Mistakes) -> DVec3 {
    let makes = |mistake| mistakes.has(mistake);
    let unit = |n: DVec3| normalize(n.to_array()).map_or(DVec3::ZERO, DVec3::from_array);
    let turned = if makes(Mistake::NormalsInModelSpace) {
        unit(n)
    } else if makes(Mistake::NormalsByModelMatrix) {
        unit(solid.eye_from_model.matrix3 * n)
    } else {
        solid.turned(n)
    };
    let turned = if makes(Mistake::NormalsInWorldSpace) { scene.view.world_from_eye() * turned } else { turned };
    if makes(Mistake::NormalsReversed) { -turned } else { turned }
}

fn normals<'a>(scene: &OracleScene, solid: &'a Solid, mistakes: Mistakes) -> Cow<'a, [DVec3]> {
    if !turns_normals(mistakes) {
        return Cow::Borrowed(&solid.normals);
    }
    solid.mesh.normals().iter().map(|n| turned(scene, solid, n.as_dvec3(), mistakes)).collect()
}

/// Whether a mistake could change this scene.
pub(super) fn could_show(scene: &OracleScene, mistake: Mistake) -> bool {
    use Mistake as M;
    let lit = || scene.solids.iter().filter(|solid| solid.lit);
    let at = |frequency: Frequency| lit().any(|solid| solid.terms.has(frequency));
    let reflects = |reflectance: Reflectance| lit().any(|solid| solid.reflectance == reflectance);
    let points = || scene.lights.iter().filter_map(point);
    let spots =
        || scene.lights.iter().filter_map(|light| if let Light::Spot(spot) = light { Some(spot) } else { None });
    let directional = || scene.lights.iter().any(|light| matches!(light, Light::Directional(_)));
    let faces = |faces: Faces| scene.solids.iter().any(|solid| solid.faces == faces);
    match mistake {
        M::NormalsNotRenormalised | M::FaceNormals | M::GouraudForPhong => at(Frequency::Fragment),
        M::NormalsByModelMatrix => lit().any(|solid| scales_unevenly(&solid.eye_from_model.matrix3)),
        M::NormalsNotFlipped => faces(Faces::Both) || faces(Faces::Back),
        M::PhongForGouraud => at(Frequency::Vertex),
        M::FlatForSmooth => at(Frequency::Vertex) || at(Frequency::Fragment),
        M::GouraudForFlat | M::PhongForFlat | M::FlatFromFirstVertex | M::FlatFromLastVertex => at(Frequency::Triangle),
        M::PhongForBlinn | M::HalfwayNotUnit => {
            reflects(Reflectance::BlinnPhong) || reflects(Reflectance::BlinnPhongMatched)
        }
        M::BlinnForPhong | M::ReflectionReversed => reflects(Reflectance::Phong),
        M::ExponentNotMatched => reflects(Reflectance::BlinnPhongMatched),
        M::ViewNotUnit | M::ViewerAtInfinity => matches!(scene.viewer, Eye::Local(_)),
        M::ViewerLocal => matches!(scene.viewer, Eye::Infinite(_)),
        M::FirstLightOnly | M::LastLightOnly | M::AmbientForEachLight => scene.lights.len() > 1,
        M::LightNotUnit
        | M::AttenuationMissing
        | M::AttenuationInverseSquare
        | M::AttenuationOfDiffuseOnly
        | M::AttenuationByEyeDistance
        | M::LightPositionInWorldSpace => points().next().is_some(),
        #[expect(clippy::float_cmp, reason = "coefficients are given, and equal ones are equal to the bit")]
        M::AttenuationSwapped => points().any(|point| point.attenuation[1] != point.attenuation[2]),
        M::AmbientAttenuated => points().any(|point| !point.attenuate_ambient),
        M::AmbientNotAttenuated => points().any(|point| point.attenuate_ambient),
        M::RangeIgnored => points().any(|point| point.range.is_some()),
        M::AttenuationOfDirectional
        | M::LightDirectionInWorldSpace
        | M::LightDirectionReversed
        | M::DirectionAsPosition => directional(),
        M::CutoffAsFullAngle
        | M::CutoffDoubled
        | M::CutoffInDegrees
        | M::CutoffIgnored
        | M::SpotReversed
        | M::SpotDirectionInWorldSpace => spots().next().is_some(),
        M::SpotExponentIgnored => spots().any(|spot| spot.cone.exponent > 0.0),
        M::SpotInnerIgnored => spots().any(|spot| spot.cone.cos_inner.is_some()),
        M::BackFacesNotCulled => faces(Faces::Front) || faces(Faces::Back),
        M::BackFacesCulled => faces(Faces::Both),
        M::BackMaterialIgnored => {
            scene.solids.iter().any(|solid| solid.sides[0].coefficients != solid.sides[1].coefficients)
        }
        M::VertexColorsIgnored => scene.solids.iter().any(|solid| solid.colors.is_some()),
        M::TexturesIgnored => scene
            .solids
            .iter()
            .any(|solid| solid.cut_from.is_some() || solid.maps.as_ref().is_some_and(|maps| maps.has(MapKind::Color))),
        M::OpacityIgnored => scene.solids.iter().any(|solid| solid.blend),
        M::ToneMappingMissing => scene.intensity.acts_on_pictures(),
        _ => true,
    }
}

/// Whether M takes a sphere to an ellipsoid.
fn scales_unevenly(m: &DMat3) -> bool {
    let gram = m.transpose() * *m;
    let even = gram.x_axis.x;
    let off = gram - DMat3::from_diagonal(DVec3::splat(even));
    off.to_cols_array().into_iter().any(|entry| entry.abs() > 1e-6 * even)
}
