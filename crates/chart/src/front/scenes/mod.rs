//! The scenes of the project's own charts; the command adds those that are its own, and the user's.

mod moving;
mod scan;
mod surfaces;

pub use moving::moving_lights;
pub use scan::{scan, stone_mesh};
pub use surfaces::{machine_part, sphere, sphere_by_phong, teapot, teapot_by_phong, terrain, terrain_mesh};

use super::ChartedScene;

/// All of them.
pub fn all() -> Vec<ChartedScene> {
    vec![sphere(), sphere_by_phong(), teapot(), teapot_by_phong(), machine_part(), terrain(), scan(), moving_lights()]
}

/// The k-th random number of the i-th thing, in [0, 1): the PCG hash of O'Neill 2014, so that every run draws the same.
fn random(i: u32, k: u32) -> f32 {
    let state = (i.wrapping_mul(8).wrapping_add(k)).wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (((word >> 22) ^ word) >> 8) as f32 / (1 << 24) as f32
}

#[cfg(test)]
mod tests {
    use halfway::prelude::*;

    use super::super::Still;
    use super::*;

    #[test]
    fn scenes_have_names_of_their_own_and_details() {
        let mut names: Vec<String> = all().iter().map(|scene| scene.name.clone()).collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), all().len());
        assert!(all().iter().all(|scene| !scene.details.is_empty() && scene.size.min_element() > 0));
    }

    #[test]
    fn finer_details_have_more_triangles_and_a_scan_has_many() {
        for scene in all() {
            let triangles = |detail| {
                let mut app = App::new();
                app.add_plugins(HalfwayPlugins::reference()).insert_resource(Still);
                (scene.build)(&mut app, detail).unwrap();
                app.finish();
                app.update();
                let world = app.world();
                let meshes = world.resource::<Assets<Mesh>>();
                let mut objects = world.try_query::<&Mesh3d>().unwrap();
                objects.iter(world).map(|mesh| meshes.get(&mesh.0).unwrap().triangle_count()).sum::<usize>()
            };
            let all: Vec<usize> = scene.details.iter().map(|detail| triangles(*detail)).collect();
            assert!(all[0] > 0 && all.is_sorted(), "{}: {all:?}", scene.name);
            if scene.name == "scan" {
                assert!(all[0] >= 100_000);
            } else {
                assert!(scene.name == "moving-lights" || all.windows(2).all(|pair| pair[0] < pair[1]), "{all:?}");
            }
        }
    }
}
