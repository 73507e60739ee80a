//! The hidden entities, by their own visibility and by that of their ancestors.

use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use halfway_lighting::{Shown, Visibility};

use Visibility::{Hidden, Inherited, Visible};

fn is_shown(world: &mut World, entity: Entity) -> bool {
    let both = move |shown: Shown| [shown.is_shown(entity), shown.by_entity()(entity)];
    let [one, among_many] = world.run_system_once(both).expect("a system of queries runs anywhere");
    assert_eq!(one, among_many, "{entity}");
    one
}

/// A chain of entities, each the child of the one before; returns them all.
fn chain(world: &mut World, choices: &[Option<Visibility>]) -> Vec<Entity> {
    let mut entities: Vec<Entity> = Vec::new();
    for choice in choices {
        let mut entity = world.spawn_empty();
        if let Some(choice) = choice {
            entity.insert(*choice);
        }
        if let Some(parent) = entities.last() {
            entity.insert(ChildOf(*parent));
        }
        entities.push(entity.id());
    }
    entities
}

#[test]
fn the_nearest_choice_above_decides() {
    let rows: [(&[Option<Visibility>], bool); 13] = [
        (&[None], true),
        (&[Some(Inherited)], true),
        (&[Some(Visible)], true),
        (&[Some(Hidden)], false),
        (&[Some(Hidden), None], false),
        (&[Some(Hidden), Some(Inherited)], false),
        (&[Some(Hidden), Some(Visible)], true),
        (&[Some(Visible), Some(Hidden)], false),
        (&[Some(Hidden), None, None, Some(Inherited), None], false),
        (&[Some(Hidden), Some(Visible), None], true),
        (&[Some(Visible), Some(Hidden), None], false),
        (&[Some(Hidden), Some(Visible), Some(Hidden)], false),
        (&[None, Some(Inherited), None], true),
    ];
    let mut world = World::new();
    for (choices, expected) in rows {
        let entities = chain(&mut world, choices);
        let last = *entities.last().expect("no chain is empty");
        assert_eq!(is_shown(&mut world, last), expected, "{choices:?}");
    }
}

#[test]
fn changes_count_at_once() {
    let mut world = World::new();
    let entities = chain(&mut world, &[None, None]);
    assert!(is_shown(&mut world, entities[1]), "nothing is hidden anywhere");
    world.entity_mut(entities[0]).insert(Hidden);
    assert!(!is_shown(&mut world, entities[1]));
    world.entity_mut(entities[1]).remove::<ChildOf>();
    assert!(is_shown(&mut world, entities[1]), "it hangs on nothing now");
    assert!(!is_shown(&mut world, entities[0]));
    world.entity_mut(entities[0]).remove::<Visibility>();
    assert!(is_shown(&mut world, entities[0]));
}

#[test]
fn a_hierarchy_that_runs_in_a_circle_comes_to_an_end() {
    let mut world = World::new();
    let entities = chain(&mut world, &[None, None, None]);
    world.entity_mut(entities[0]).insert(ChildOf(entities[2]));
    assert!(is_shown(&mut world, entities[1]));
    // Some entity has a choice, so that the hierarchy is looked at.
    world.spawn(Hidden);
    assert!(is_shown(&mut world, entities[1]));
    world.entity_mut(entities[0]).insert(Hidden);
    assert!(!is_shown(&mut world, entities[1]));
}
