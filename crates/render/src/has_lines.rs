//! Whether a world has lines over its pictures.

use bevy_ecs::prelude::*;
use halfway_lighting::{Edges, Show};
use halfway_mesh::Lines3d;

/// Whether this world has lines: [`Edges`], [`Lines3d`] or [`Show`].
pub fn has_lines(world: &World) -> bool {
    fn any<T: Component>(world: &World) -> bool {
        world.try_query::<&T>().is_some_and(|mut all| all.iter(world).next().is_some())
    }
    let shows = world.try_query::<&Show>().is_some_and(|mut all| all.iter(world).any(Show::any));
    shows || any::<Edges>(world) || any::<Lines3d>(world)
}
