//! A part of a scene's light alone: one term, one light, or both.

use bevy_ecs::prelude::*;
use halfway_lighting::{
    BackMaterial, Camera, GlobalAmbient, LightComponent, LinearRgba, Material, Shading, Term, Visibility,
};
use halfway_texture::environment::EnvironmentLight;

/// A part of a scene's light. The parts of all terms, or of no light and of each light, add up to the whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PartOfLight {
    /// The only term; `None`: all of them.
    pub term: Option<Term>,
    /// Where the light comes from.
    pub source: LightSource,
}

/// Where light comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSource {
    /// From everywhere.
    #[default]
    Anywhere,
    /// From the light at this place in [`Spawned::lights`](crate::Spawned::lights) alone: without the global ambient light, an environment,
    /// emission, unlit objects and the background.
    Light(usize),
    /// From everything but the lights.
    NoLight,
}

impl PartOfLight {
    /// Whether what shines without a light takes part.
    fn has_surroundings(self) -> bool {
        !matches!(self.source, LightSource::Light(_))
    }

    /// Whether the background is seen; else it is black.
    fn has_background(self) -> bool {
        self.has_surroundings() && matches!(self.term, None | Some(Term::Emission))
    }

    fn material(self, material: Material, lit: bool) -> Material {
        let black = LinearRgba::BLACK;
        if !lit {
            let is_there = self.has_surroundings() && matches!(self.term, None | Some(Term::Ambient));
            return if is_there { material } else { Material { diffuse: black, ..material } };
        }
        let of_term = self.term.map_or(material, |term| term.of_material(material));
        if self.has_surroundings() { of_term } else { Material { emission: black, ..of_term } }
    }
}

/// A light of which the ambient colour alone shines.
#[derive(Component, Clone, Copy, Debug)]
struct AmbientAlone;

/// Gives a light its component, or its ambient colour alone while that alone is shown.
pub(crate) fn insert_light(light: LightComponent, entity: &mut EntityWorldMut) {
    let light = if entity.contains::<AmbientAlone>() { light.ambient_alone() } else { light };
    light.insert_into(entity);
}

/// The components and resources of the whole light.
#[derive(Resource, Clone, Debug, Default)]
struct WholeLight {
    materials: Vec<(Entity, Material, Option<BackMaterial>)>,
    lights: Vec<(Entity, LightComponent, Option<Visibility>)>,
    environments: Vec<(Entity, EnvironmentLight, Option<Visibility>)>,
    cameras: Vec<(Entity, Camera)>,
    ambient: GlobalAmbient,
}

impl WholeLight {
    fn from_world(of: LitEntities, world: &mut World) -> Self {
        let mut below = of.objects.to_vec();
        let mut materials = Vec::new();
        while let Some(entity) = below.pop() {
            below.extend(world.get::<Children>(entity).iter().flat_map(|children| children.iter()));
            if let Some(&material) = world.get::<Material>(entity) {
                materials.push((entity, material, world.get::<BackMaterial>(entity).copied()));
            }
        }
        let light = |&entity: &Entity| {
            let light = LightComponent::from_entity(world.get_entity(entity).ok()?)?;
            Some((entity, light, world.get::<Visibility>(entity).copied()))
        };
        let lights = of.lights.iter().filter_map(light).collect();
        let camera = |&entity: &Entity| Some((entity, *world.get::<Camera>(entity)?));
        let cameras = of.cameras.iter().filter_map(camera).collect();
        let ambient = world.get_resource::<GlobalAmbient>().copied().unwrap_or_default();
        let mut environments = world.query::<(Entity, &EnvironmentLight, Option<&Visibility>)>();
        let environments = environments.iter(world);
        let environments = environments.map(|(entity, it, visibility)| (entity, it.clone(), visibility.copied()));
        Self { materials, lights, environments: environments.collect(), cameras, ambient }
    }

    /// Whether it is of this scene, and not of one that was in the world before.
    fn is_of(&self, of: LitEntities) -> bool {
        self.cameras.iter().map(|(camera, _)| camera).eq(of.cameras)
    }

    fn show(&self, part: PartOfLight, of: LitEntities, world: &mut World) {
        let shading = of.cameras.first().and_then(|camera| world.get::<Shading>(*camera)).copied().unwrap_or_default();
        for &(entity, material, back) in &self.materials {
            let lit = world.get::<Shading>(entity).copied().unwrap_or(shading) != Shading::Unlit;
            let Ok(mut entity) = world.get_entity_mut(entity) else { continue };
            entity.insert(part.material(material, lit));
            if let Some(BackMaterial(back)) = back {
                entity.insert(BackMaterial(part.material(back, lit)));
            }
        }
        for &(entity, light, visibility) in &self.lights {
            let shines = match part.source {
                LightSource::Anywhere => true,
                LightSource::Light(place) => of.lights.get(place) == Some(&entity),
                LightSource::NoLight => false,
            };
            let Ok(mut entity) = world.get_entity_mut(entity) else { continue };
            if part.term == Some(Term::Ambient) {
                entity.insert(AmbientAlone);
            } else {
                entity.remove::<AmbientAlone>();
            }
            insert_light(light, &mut entity);
            set_visible(&mut entity, visibility, shines);
        }
        for &(entity, ref environment, visibility) in &self.environments {
            let shines = part.has_surroundings() && part.term != Some(Term::Diffuse);
            let Ok(mut entity) = world.get_entity_mut(entity) else { continue };
            entity.insert(EnvironmentLight { sky: environment.sky && part.has_background(), ..environment.clone() });
            set_visible(&mut entity, visibility, shines);
        }
        for &(entity, camera) in &self.cameras {
            let (background, background_below) = (LinearRgba::BLACK, None);
            let dark = Camera { background, background_below, ..camera };
            if let Some(mut there) = world.get_mut::<Camera>(entity) {
                let background = if part.has_background() { camera } else { dark };
                (there.background, there.background_below) = (background.background, background.background_below);
            }
        }
        world.insert_resource(if part.has_surroundings() { self.ambient } else { GlobalAmbient(LinearRgba::BLACK) });
    }
}

fn set_visible(entity: &mut EntityWorldMut, before: Option<Visibility>, shines: bool) {
    match before {
        _ if !shines => entity.insert(Visibility::Hidden),
        Some(before) => entity.insert(before),
        None => entity.remove::<Visibility>(),
    };
}

/// The entities of a scene whose light is shown in parts.
#[derive(Clone, Copy)]
pub(crate) struct LitEntities<'a> {
    pub(crate) cameras: &'a [Entity],
    pub(crate) objects: &'a [Entity],
    pub(crate) lights: &'a [Entity],
}

/// Shows a part of the light; see [`Spawned::show_light`](crate::Spawned::show_light).
pub(crate) fn show(part: PartOfLight, of: LitEntities, world: &mut World) {
    let whole = match world.remove_resource::<WholeLight>().filter(|whole| whole.is_of(of)) {
        Some(whole) => whole,
        None if part == PartOfLight::default() => return,
        None => WholeLight::from_world(of, world),
    };
    whole.show(part, of, world);
    world.insert_resource(whole);
}
