//! What was chosen for each patch in the frame before: so that terms do not flicker under a slow light, and to count
//! how many change their place.

use crate::lights::patch_lights::TermLights;
use crate::target::canvas::CanvasTarget;
use crate::target::surface::SurfaceTarget;
use crate::target::texture::TextureTarget;
use bevy_ecs::prelude::{Entity, ReflectResource, Res, Resource};
use bevy_platform::collections::{HashMap, HashSet};
use bevy_reflect::Reflect;

/// Whether under [`Shading::Auto`](halfway_lighting::Shading::Auto) it counts where the terms of a patch were shaded in
/// the frame before. While this resource is not there, the target decides: [`Choosing::Steadily`] for a window and an
/// engine's texture, [`Choosing::Anew`] for headless pictures.
///
/// Either keeps to the tolerance in every frame by the same bounds.
/// [`FrameReport::choices_changed`](crate::FrameReport::choices_changed) counts what changes.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[reflect(Resource, Clone, Debug, PartialEq, Hash)]
pub enum Choosing {
    /// Each frame chooses by itself: the same scene is the same picture to the byte, whatever was drawn before.
    Anew,
    /// A term stays where it was unless the other place is clearly better: it goes to the vertices where that saves a
    /// tenth of its pixels more than it costs and leaves a tenth of the tolerance, and comes back where it costs a
    /// tenth more than it saves, or where the bound of this frame does not allow it any more.
    Steadily,
}

/// The part of what is shaded at the pixels by which the other place has to be better.
pub(crate) const CLEARLY: f32 = 0.1;

/// The part of what is allowed that a term may fill up that comes to the vertices; one that stays there may fill all.
pub(super) const ROOM_TO_COME: f64 = 0.9;

/// What says whether choices are kept.
pub(crate) type ChosenBy<'w> = (
    Option<Res<'w, Choosing>>,
    Option<Res<'w, SurfaceTarget>>,
    Option<Res<'w, CanvasTarget>>,
    Option<Res<'w, TextureTarget>>,
);

/// How this frame chooses.
pub(crate) fn choosing((said, surface, canvas, texture): ChosenBy) -> Choosing {
    let is_watched = surface.is_some() || canvas.is_some() || texture.is_some();
    said.map_or(if is_watched { Choosing::Steadily } else { Choosing::Anew }, |said| *said)
}

/// Names a patch, or some that follow each other, as long as their object stands and its mesh is laid out the same: by
/// the first of their indices.
pub(crate) type PatchName = (Entity, u32);

/// Patches that are chosen for together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NamedPatches {
    pub(crate) name: PatchName,
    /// How many they are, and how many of them are seen.
    pub(crate) count: u32,
    pub(crate) seen: u32,
}

/// In the place of a patch: all of an object of which no patch is looked at.
const ALL: u32 = u32::MAX;

/// The lights that were placed for a patch: those of the vertex shader, and those of the fragment shader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct PlacedLights<'a> {
    vertex: TermLights<'a>,
    fragment: TermLights<'a>,
}

/// What was chosen in the frame before, and what is in this one.
#[derive(Debug, Default)]
pub(crate) struct ChoiceMemory {
    before: FrameChoices,
    now: FrameChoices,
    is_steady: bool,
    /// How many lights of each kind there are. With other numbers, a light's number means another.
    counts: [u32; 3],
    /// How many patches of this frame have a term in the other place than in the frame before.
    pub(crate) changed: u32,
}

#[derive(Debug, Default)]
struct FrameChoices {
    patches: HashMap<PatchName, PlacedLists>,
    /// The lists of one patch after the other.
    numbers: Vec<u32>,
    /// The objects of which any term is at the vertices.
    moved: HashSet<Entity>,
}

/// The lights of a patch: none where all is at the fragments unseen.
#[derive(Clone, Copy, Debug, Default)]
struct PlacedLists {
    start: usize,
    /// How many patches have them.
    patches: u32,
    /// Of the vertex shader's diffuse and specular terms, and of the fragment shader's.
    counts: [u32; 4],
}

/// What was chosen for a patch in the frame before, where that counts; of a patch that was not there, nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Before<'a>(Option<PlacedLights<'a>>);

impl Before<'_> {
    /// Whether these terms of a light were at the vertices, all that were anywhere; `None` where that does not count,
    /// and where none was.
    pub(crate) fn stays(self, light: u32, terms: [bool; 2]) -> Option<bool> {
        let PlacedLights { vertex, fragment } = self.0?;
        if vertex.is_empty() && fragment.is_empty() {
            // It was not looked at.
            return Some(false);
        }
        let has = |of: TermLights, term: usize| terms[term] && of.lists()[term].binary_search(&light).is_ok();
        let any = |of| [0, 1].iter().any(|&term| has(of, term));
        if any(fragment) { Some(false) } else { any(vertex).then_some(true) }
    }

    /// Whether anything was at the vertices; `None` where that does not count.
    pub(crate) fn is_moved(self) -> Option<bool> {
        Some(!self.0?.vertex.is_empty())
    }

    /// How much more than it costs moving terms has to save of a patch on which so much could be saved.
    pub(crate) fn least_gain(self, of: f32) -> f32 {
        let least = match self.is_moved() {
            None => 0.0,
            Some(true) => -CLEARLY * of,
            Some(false) => CLEARLY * of,
        };
        if least.is_finite() { least } else { 0.0 }
    }
}

impl FrameChoices {
    fn get(&self, name: PatchName) -> Option<PlacedLights<'_>> {
        let &PlacedLists { start, counts, .. } = self.patches.get(&name)?;
        let mut rest = &self.numbers[start..];
        let [a, b, c, d] = counts.map(|count| {
            let (list, after) = rest.split_at(count as usize);
            rest = after;
            list
        });
        let [vertex, fragment] = [[a, b], [c, d]].map(|[diffuse, specular]| TermLights { diffuse, specular });
        Some(PlacedLights { vertex, fragment })
    }

    fn insert(&mut self, of: NamedPatches, PlacedLights { vertex, fragment }: PlacedLights) {
        let [[a, b], [c, d]] = [vertex, fragment].map(TermLights::lists);
        let start = self.numbers.len();
        for list in [a, b, c, d] {
            self.numbers.extend_from_slice(list);
        }
        let counts = [a, b, c, d].map(|list| list.len() as u32);
        self.patches.insert(of.name, PlacedLists { start, patches: of.count, counts });
    }
}

impl ChoiceMemory {
    /// Begins a frame with `counts` lights of each kind.
    pub(crate) fn begin(&mut self, choosing: Choosing, counts: [u32; 3]) {
        std::mem::swap(&mut self.before, &mut self.now);
        self.now.patches.clear();
        self.now.numbers.clear();
        self.now.moved.clear();
        if self.counts != counts {
            self.counts = counts;
            self.before.patches.clear();
            self.before.moved.clear();
        }
        self.is_steady = choosing == Choosing::Steadily;
        self.changed = 0;
    }

    /// What was chosen for a patch before, if that counts.
    pub(crate) fn before(&self, (object, first): PatchName) -> Before<'_> {
        let of = |first| self.before.get((object, first));
        Before(if self.is_steady { of(first).or_else(|| of(ALL)) } else { None })
    }

    /// Whether any term of an object was at the vertices in the frame before.
    pub(crate) fn has_moved(&self, object: Entity) -> bool {
        self.before.moved.contains(&object)
    }

    /// Whether that counts, and any was.
    pub(crate) fn keeps_moved(&self, object: Entity) -> bool {
        self.is_steady && self.has_moved(object)
    }

    /// How many patches were chosen for together with the first of these, if that counts.
    pub(crate) fn joined_before(&self, name: PatchName) -> Option<u32> {
        if self.is_steady { self.before.patches.get(&name).map(|lists| lists.patches) } else { None }
    }

    /// Takes note of where the terms of patches are shaded: each list ascends.
    pub(crate) fn note(&mut self, of: NamedPatches, vertex: TermLights, fragment: TermLights) {
        let name = of.name;
        let now = PlacedLights { vertex, fragment };
        if !vertex.is_empty() {
            self.now.moved.insert(name.0);
        }
        if self.before.get(name).is_some_and(|before| is_changed(before, now)) {
            self.changed += of.seen;
        }
        self.now.insert(of, now);
    }

    /// Takes note of an object of which no patch is looked at: all its terms are at the fragments.
    pub(crate) fn note_object(&mut self, object: Entity) {
        self.now.patches.insert((object, ALL), PlacedLists::default());
    }

    /// Takes note of patches that are not looked at: their terms are all at the fragments, whatever their lights.
    pub(crate) fn note_at_fragments(&mut self, NamedPatches { name, count, seen }: NamedPatches) {
        if self.has_moved(name.0) && Before(self.before.get(name)).is_moved() == Some(true) {
            self.changed += seen;
        }
        if !self.now.patches.contains_key(&(name.0, ALL)) {
            self.now.patches.insert(name, PlacedLists { patches: count, ..PlacedLists::default() });
        }
    }
}

/// Whether a term that both have is in the other place.
fn is_changed(before: PlacedLights, now: PlacedLights) -> bool {
    // Which is so of most patches, and found sooner.
    if before == now {
        return false;
    }
    let went = |from: TermLights, to: TermLights| {
        from.lists()
            .into_iter()
            .zip(to.lists())
            .any(|(from, to)| from.iter().any(|light| to.binary_search(light).is_ok()))
    };
    went(before.vertex, now.fragment) || went(before.fragment, now.vertex)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_ecs::world::World;

    const COUNTS: [u32; 3] = [1, 2, 0];

    fn names() -> [PatchName; 2] {
        let mut world = World::new();
        [(world.spawn_empty().id(), 0), (world.spawn_empty().id(), 96)]
    }

    /// All of which are seen.
    fn patches(name: PatchName, count: u32) -> NamedPatches {
        NamedPatches { name, count, seen: count }
    }

    fn lights([diffuse, specular]: [&[u32]; 2]) -> TermLights<'_> {
        TermLights { diffuse, specular }
    }

    #[test]
    fn a_term_in_the_other_place_is_counted_once_a_patch() {
        let [name, other] = names();
        let mut memory = ChoiceMemory::default();
        memory.begin(Choosing::Anew, COUNTS);
        memory.note(patches(name, 3), lights([&[0, 2], &[0]]), lights([&[1], &[1, 2]]));
        memory.note(patches(other, 1), lights([&[], &[]]), lights([&[0], &[]]));
        assert_eq!(memory.changed, 0, "what was not there has not changed");
        let mut changed = |counts, vertices: [&[u32]; 2], fragments: [&[u32]; 2]| {
            memory.begin(Choosing::Anew, counts);
            memory.note(patches(name, 3), lights(vertices), lights(fragments));
            memory.note(patches(other, 1), lights([&[], &[]]), lights([&[0], &[]]));
            memory.changed
        };
        assert_eq!(changed(COUNTS, [&[0, 2], &[0]], [&[1], &[1, 2]]), 0, "the same");
        assert_eq!(changed(COUNTS, [&[0], &[0]], [&[1], &[]]), 0, "what is left out is in no place");
        assert_eq!(changed(COUNTS, [&[], &[]], [&[0, 1], &[0]]), 3, "two terms of three patches");
        assert_eq!(changed(COUNTS, [&[0, 1], &[0]], [&[], &[]]), 3, "and back");
        assert_eq!(changed([0, 3, 0], [&[], &[]], [&[0, 1], &[0]]), 0, "other lights");
    }

    #[test]
    fn what_is_not_looked_at_is_at_the_fragments() {
        let [name, other] = names();
        let mut memory = ChoiceMemory::default();
        memory.begin(Choosing::Steadily, COUNTS);
        assert_eq!(memory.before(name).is_moved(), None, "nothing is known of the first frame");
        memory.note(patches(name, 4), lights([&[1], &[]]), lights([&[], &[1]]));
        assert_eq!(memory.joined_before(name), None);
        memory.note_at_fragments(patches(other, 2));
        memory.begin(Choosing::Steadily, COUNTS);
        assert_eq!([name, other].map(|name| memory.joined_before(name)), [Some(4), Some(2)]);
        let before = memory.before(name);
        assert_eq!(before.is_moved(), Some(true));
        let stays = [[true, false], [false, true], [true, true]].map(|terms| before.stays(1, terms));
        assert_eq!(stays, [Some(true), Some(false), Some(false)]);
        assert_eq!([0, 2].map(|light| before.stays(light, [true, true])), [None; 2], "they were left out");
        let before = memory.before(other);
        assert_eq!((before.is_moved(), before.stays(1, [true, true])), (Some(false), Some(false)), "not looked at");
        assert_eq!([name.0, other.0].map(|object| memory.has_moved(object)), [true, false]);
        memory.note_object(name.0);
        memory.note_at_fragments(patches(name, 2));
        assert_eq!(memory.changed, 2);
        memory.begin(Choosing::Steadily, COUNTS);
        assert_eq!(memory.before((name.0, 7)).is_moved(), Some(false), "any patch of it");
        assert_eq!(memory.before(other).is_moved(), None, "it was not there");
        memory.begin(Choosing::Anew, COUNTS);
        assert_eq!((memory.before(name).is_moved(), memory.joined_before(name)), (None, None), "it does not count");
    }

    #[test]
    fn choices_are_kept_where_somebody_watches() {
        let choosing = |world: &mut World| world.run_system_cached(|by: ChosenBy| choosing(by)).expect("it runs");
        let mut world = World::new();
        assert_eq!(choosing(&mut world), Choosing::Anew);
        world.insert_resource(CanvasTarget { size: bevy_math::UVec2::ONE });
        assert_eq!(choosing(&mut world), Choosing::Steadily);
        world.insert_resource(Choosing::Anew);
        assert_eq!(choosing(&mut world), Choosing::Anew);
        world.remove_resource::<CanvasTarget>();
        world.insert_resource(Choosing::Steadily);
        assert_eq!(choosing(&mut world), Choosing::Steadily);
    }

    #[test]
    fn what_was_moved_stays_for_less() {
        let moved = PlacedLights { vertex: lights([&[], &[0]]), ..PlacedLights::default() };
        let left = PlacedLights { fragment: lights([&[], &[0]]), ..PlacedLights::default() };
        let [none, moved, left] = [None, Some(moved), Some(left)].map(Before);
        let close = |a: f32, b: f32| assert!((a - b).abs() < 1e-6, "{a} {b}");
        close(none.least_gain(50.0), 0.0);
        close(moved.least_gain(50.0), -5.0);
        close(left.least_gain(50.0), 5.0);
        close(left.least_gain(f32::INFINITY), 0.0);
    }
}
