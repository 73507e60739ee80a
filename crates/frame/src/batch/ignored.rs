//! Images that do nothing, since they change how light is evaluated and light is evaluated before the fragments.

use crate::batch::key::MapLooks;
use halfway_lighting::{Frequency, Terms};
use halfway_texture::MapKind;
use std::sync::Once;

/// The kinds of these images that do nothing where light is evaluated as these terms say. An environment takes the
/// exponent everywhere.
fn ignored(maps: &MapLooks, terms: Terms, surrounded: bool) -> impl Iterator<Item = MapKind> {
    let is_early = |term: Frequency| matches!(term, Frequency::Triangle | Frequency::Vertex);
    let no_normals = [terms.diffuse, terms.specular].into_iter().any(is_early) && !terms.has(Frequency::Fragment);
    let no_exponents = is_early(terms.specular) && !surrounded;
    let each = [(MapKind::Normal, no_normals), (MapKind::Height, no_normals), (MapKind::Shininess, no_exponents)];
    each.into_iter().filter(|(kind, nothing)| *nothing && maps.has(*kind)).map(|(kind, _)| kind)
}

/// Logs the images that are ignored, once for each kind.
pub(crate) fn log_ignored(maps: &MapLooks, terms: Terms, surrounded: bool) {
    static LOGGED: [Once; MapKind::COUNT] = [const { Once::new() }; MapKind::COUNT];
    for kind in ignored(maps, terms, surrounded) {
        let name = kind.name();
        LOGGED[kind as usize].call_once(|| {
            log::warn!(
                "an object's {name} image does nothing, since flat and Gouraud shading light triangles and vertices; under Phong \
                 shading it counts"
            );
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::key::MapLook;
    use Frequency::{Fragment, Never, Triangle, Vertex};
    use MapKind::{Height, Normal, Shininess};
    use halfway_texture::{Channel, FarNormals, Sampling, UvSet};

    #[test]
    fn normal_maps_are_ignored_without_fragment_terms() {
        let (uv_set, channel, far_normals) = (UvSet::First, Channel::Red, FarNormals::Mean);
        let look = MapLook { sampling: Sampling::default(), uv_set, channel, far_normals };
        let all = MapLooks([Some(look); MapKind::COUNT]);
        let found = |terms, surrounded| ignored(&all, terms, surrounded).collect::<Vec<_>>();
        for early in [Triangle, Vertex] {
            assert_eq!(found(Terms::both(early), false), [Normal, Height, Shininess]);
            assert_eq!(found(Terms::both(early), true), [Normal, Height]);
            // Highlights turn, but nothing else; or the other way round.
            assert_eq!(found(Terms { diffuse: early, specular: Fragment }, false), []);
            assert_eq!(found(Terms { diffuse: Fragment, specular: early }, false), [Shininess]);
            assert_eq!(found(Terms { diffuse: early, specular: Never }, false), [Normal, Height]);
        }
        assert_eq!(found(Terms::both(Fragment), false), []);
        // Who wants no light at all has not forgotten anything.
        assert_eq!(found(Terms::NONE, false), []);
        let color = MapLooks(std::array::from_fn(|slot| (slot == MapKind::Color as usize).then_some(look)));
        assert_eq!(ignored(&color, Terms::both(Vertex), false).count(), 0);
    }
}
