//! Looks: objects whose components are equal are drawn alike wherever they are, so that what follows from the components
//! is found once for all of them. The number of a look is kept with each object while nothing of it changes.

use bevy_ecs::change_detection::{ContiguousRef, Tick};
use bevy_ecs::prelude::*;
use bevy_platform::collections::HashMap;
use halfway_asset::AssetId;
use halfway_lighting::{AlphaMode, BackMaterial, Faces, Material, Reflectance, Shading, Tolerance, VertexColors};
use halfway_mesh::{Mesh, Mesh3d};
use halfway_texture::{Maps, SolidTexture};
use std::ops::Range;

/// The number of an object's look; none where it is not known.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Look {
    number: u32,
    /// The number of times that all looks had been forgotten; 0 of none.
    generation: u32,
    /// The components that it was made from, each a bit.
    components: u32,
}

/// The components that make a look, as bits: all of an object that matters beside its place, unless it has images or is
/// cut from a solid. Such objects have no number.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct LookBits {
    mesh: AssetId<Mesh>,
    materials: [Option<[u32; size_of::<Material>() / 4]>; 2],
    shading: Option<Shading>,
    reflectance: Option<Reflectance>,
    faces: Option<Faces>,
    colors: Option<VertexColors>,
    cutoff: Option<u32>,
    blends: bool,
    tolerance: Option<[u32; 2]>,
}

/// The components that make the look of an object without images that is not cut from a solid.
#[derive(Clone, Copy)]
pub(crate) struct Surface<'a> {
    pub(crate) mesh: &'a Mesh3d,
    pub(crate) material: Option<&'a Material>,
    pub(crate) back: Option<&'a BackMaterial>,
    pub(crate) shading: Option<&'a Shading>,
    pub(crate) reflectance: Option<&'a Reflectance>,
    pub(crate) faces: Option<&'a Faces>,
    pub(crate) colors: Option<&'a VertexColors>,
    pub(crate) alpha: Option<&'a AlphaMode>,
    pub(crate) tolerance: Option<&'a Tolerance>,
}

impl LookBits {
    pub(crate) fn new(surface: Surface) -> Self {
        let Surface { mesh, material, back, shading, reflectance, faces, colors, alpha, tolerance } = surface;
        let alpha = alpha.copied().unwrap_or_default();
        Self {
            mesh: mesh.0.id(),
            materials: [material, back.map(|back| &back.0)].map(|side| side.map(|side| bytemuck::cast(*side))),
            shading: shading.copied(),
            reflectance: reflectance.copied(),
            faces: faces.copied(),
            colors: colors.copied(),
            cutoff: alpha.cutoff().map(f32::to_bits),
            blends: alpha.blends(),
            tolerance: tolerance.map(|of| [of.steps, of.pixels].map(f32::to_bits)),
        }
    }
}

/// The numbers of looks.
#[derive(Resource, Debug)]
pub struct Looks {
    numbers: HashMap<LookBits, u32>,
    generation: u32,
    /// How many different ones the frame has.
    pub(crate) used: usize,
    /// How often a look has been found or forgotten.
    pub(crate) changes: u64,
}

impl Default for Looks {
    fn default() -> Self {
        Self { numbers: HashMap::default(), generation: 1, used: 0, changes: 0 }
    }
}

impl Looks {
    /// Up to this many are remembered, however few there are in a frame.
    const REMEMBERED: usize = 512;

    /// The number of a look, where it is known.
    pub(crate) fn known(&self, look: Look) -> Option<u32> {
        (look.generation == self.generation).then_some(look.number)
    }

    /// The number of the look with these bits. The object's `look` is then known.
    pub(crate) fn number(&mut self, look: &mut Look, bits: LookBits) -> u32 {
        let next = self.numbers.len() as u32;
        let number = *self.numbers.entry(bits).or_insert(next);
        let found = Look { number, generation: self.generation, ..*look };
        self.changes += u64::from(*look != found);
        *look = found;
        number
    }

    /// Forgets all, where materials that change in every frame have piled up.
    fn begin(&mut self) {
        if self.numbers.len() > Self::REMEMBERED.max(2 * self.used) {
            self.changes += 1;
            self.numbers.clear();
            self.generation = self.generation.wrapping_add(1).max(1);
        }
    }
}

/// The components of which looks are made.
type Components = (
    Ref<'static, Mesh3d>,
    Option<Ref<'static, Material>>,
    Option<Ref<'static, BackMaterial>>,
    Option<Ref<'static, Shading>>,
    Option<Ref<'static, Reflectance>>,
    Option<Ref<'static, Faces>>,
    Option<Ref<'static, VertexColors>>,
    Option<Ref<'static, Maps>>,
    Option<Ref<'static, AlphaMode>>,
    Option<Ref<'static, SolidTexture>>,
    Option<Ref<'static, Tolerance>>,
);

/// The changes of a component of objects in a row; `None` where they have none.
type Changes<'a> = Option<(&'a [Tick], [Tick; 2])>;

fn changes<T>(of: ContiguousRef<'_, T>) -> (&[Tick], [Tick; 2]) {
    (of.changed_ticks_slice(), [of.last_run_tick(), of.this_run_tick()])
}

/// So many objects are looked at together.
const ROW: usize = 256;

/// Forgets the looks of objects of which a component has changed, come or gone, and of those that were not there before:
/// while an object is disabled nothing looks at its components.
pub(crate) fn forget_changed(
    mut objects: Query<(Entity, &mut Look, Components)>,
    mut looks: ResMut<Looks>,
    mut entities_before: Local<Vec<Vec<Entity>>>,
) {
    looks.begin();
    // All of the components are kept in tables.
    let Ok(tables) = objects.contiguous_iter_mut() else { return };
    for (number, (entities, mut of_objects, components)) in tables.enumerate() {
        if entities_before.len() == number {
            entities_before.push(Vec::new());
        }
        let before = &mut entities_before[number];
        let of_objects = of_objects.bypass_change_detection();
        let (mesh, material, back, shading, reflectance, faces, colors, maps, alpha, solid, tolerance) = components;
        let changes: [Changes; 11] = [
            Some(changes(mesh)),
            material.map(changes),
            back.map(changes),
            shading.map(changes),
            reflectance.map(changes),
            faces.map(changes),
            colors.map(changes),
            maps.map(changes),
            alpha.map(changes),
            solid.map(changes),
            tolerance.map(changes),
        ];
        let there = changes.iter().rev().fold(0, |bits, change| bits << 1 | u32::from(change.is_some()));
        let count = of_objects.len();
        let has_changed = |row: Range<usize>, of_objects: &[Look]| {
            before.get(row.clone()) != entities.get(row.clone())
                || of_objects[row.clone()].iter().any(|look| look.components != there)
                || changes.iter().flatten().any(|&(ticks, [last, now])| any_newer(&ticks[row.clone()], last, now))
        };
        let changes_before = looks.changes;
        for start in (0..count).step_by(ROW) {
            let row = start..count.min(start + ROW);
            if has_changed(row.clone(), of_objects) {
                looks.changes += 1;
                for at in row {
                    if has_changed(at..at + 1, of_objects) {
                        of_objects[at] = Look { components: there, ..Look::default() };
                    }
                }
            }
        }
        if looks.changes != changes_before || before.len() != count {
            before.clear();
            before.extend_from_slice(entities);
        }
    }
}

/// Whether any tick is newer than the `last` frame, where it is `now`. All are compared, many at once: seldom is any
/// newer.
pub(crate) fn any_newer(ticks: &[Tick], last: Tick, now: Tick) -> bool {
    ticks.iter().fold(false, |any, tick| any | tick.is_newer_than(last, now))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_color::LinearRgba;
    use bevy_transform::components::Transform;

    /// An object with at most a material.
    fn plain<'a>(mesh: &'a Mesh3d, material: Option<&'a Material>) -> Surface<'a> {
        Surface {
            mesh,
            material,
            back: None,
            shading: None,
            reflectance: None,
            faces: None,
            colors: None,
            alpha: None,
            tolerance: None,
        }
    }

    /// Gives an object a component, changes it, and takes it away.
    type Steps = [fn(&mut EntityWorldMut); 3];

    #[test]
    fn a_look_is_forgotten_where_a_component_comes_changes_or_goes() {
        let rows: [(&str, Steps); 10] = [
            ("Material", steps::<Material>()),
            ("BackMaterial", steps::<BackMaterial>()),
            ("Shading", steps::<Shading>()),
            ("Reflectance", steps::<Reflectance>()),
            ("Faces", steps::<Faces>()),
            ("VertexColors", steps::<VertexColors>()),
            ("Maps", steps::<Maps>()),
            ("AlphaMode", steps::<AlphaMode>()),
            ("SolidTexture", steps::<SolidTexture>()),
            ("Tolerance", steps::<Tolerance>()),
        ];
        let mut world = World::new();
        world.init_resource::<Looks>();
        let mut frame = Schedule::default();
        frame.add_systems(forget_changed);
        let mut object = || world.spawn((Mesh3d::default(), Look::default())).id();
        let (other, changing) = (object(), object());
        let known = |world: &mut World, of: Entity| {
            let look = *world.get::<Look>(of).expect("an object");
            world.resource::<Looks>().known(look).is_some()
        };
        let learn = |world: &mut World, of: Entity| {
            let mesh = world.get::<Mesh3d>(of).expect("an object").clone();
            let bits = LookBits::new(plain(&mesh, None));
            let mut look = *world.get::<Look>(of).expect("an object");
            world.resource_mut::<Looks>().number(&mut look, bits);
            world.entity_mut(of).insert(look);
        };
        frame.run(&mut world);
        learn(&mut world, other);
        for (name, steps) in rows {
            for (step, what) in steps.into_iter().zip(["comes", "changes", "goes"]) {
                learn(&mut world, changing);
                world.entity_mut(changing).insert(Transform::from_xyz(1.0, 2.0, 3.0));
                frame.run(&mut world);
                assert!(known(&mut world, changing), "{name}: a transform is no part of it");
                step(&mut world.entity_mut(changing));
                frame.run(&mut world);
                assert!(!known(&mut world, changing), "{name} {what}");
                assert!(known(&mut world, other), "{name} {what} elsewhere");
            }
        }
    }

    fn steps<C: Component<Mutability = bevy_ecs::component::Mutable> + Default>() -> Steps {
        [
            |object| {
                object.insert(C::default());
            },
            |object| {
                object.get_mut::<C>().expect("it was inserted").set_changed();
            },
            |object| {
                object.remove::<C>();
            },
        ]
    }

    #[test]
    fn looks_that_pile_up_are_forgotten() {
        let mut looks = Looks::default();
        let mut look = Look::default();
        assert_eq!(looks.known(look), None);
        for frame in 0..2 * Looks::REMEMBERED {
            looks.begin();
            let red = frame as f32 / 4096.0;
            let material = Material { diffuse: LinearRgba::rgb(red, 0.0, 0.0), ..Material::DEFAULT };
            let bits = LookBits::new(plain(&Mesh3d::default(), Some(&material)));
            let number = looks.number(&mut look, bits);
            assert_eq!(looks.known(look), Some(number));
            assert!(number as usize <= Looks::REMEMBERED, "{number}");
        }
        assert_eq!(looks.known(Look::default()), None);
    }
}
