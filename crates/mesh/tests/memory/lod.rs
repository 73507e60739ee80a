//! The largest amount of memory that making levels of detail takes.

use std::sync::atomic::AtomicBool;

use glam::Vec3;
use halfway_mesh::{Mesh, UvSphere};

use crate::{ALLOCATOR, alone};

/// A ball with hills, so that no part is like another.
fn stone() -> Mesh {
    let ball = Mesh::from(UvSphere::new(1.0, 400, 200));
    let hill = |i: usize| {
        let Vec3 { x, y, z } = ball.positions()[i];
        0.05 * ((7.0 * x).sin() * (9.0 * y).cos() + (23.0 * z + 5.0 * x).sin() * 0.3)
    };
    ball.displaced(hill).expect("finite heights").0
}

/// The same with a ball within, so that it is of two pieces.
fn stone_with_core() -> Mesh {
    let (stone, core) = (stone(), Mesh::from(UvSphere::new(0.5, 200, 100)));
    let first = stone.positions().len() as u32;
    let both = |of: fn(&Mesh) -> &[Vec3]| [of(&stone), of(&core)].concat();
    let indices = stone.indices().iter().copied().chain(core.indices().iter().map(|i| first + i)).collect();
    Mesh::from_parts(both(Mesh::positions), Some(both(Mesh::normals)), None, indices).expect("two whole meshes")
}

#[test]
fn levels_take_at_most_three_times_the_memory_of_the_mesh() {
    let _alone = alone();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for (name, mesh) in [("one piece", stone()), ("two pieces", stone_with_core())] {
        let own = size_of_val(mesh.positions()) + size_of_val(mesh.normals()) + size_of_val(mesh.indices());
        let levels = || one.install(|| mesh.lod_hierarchy(&AtomicBool::new(false))).expect("nothing stops it");
        // The threads of other tests may begin or end meanwhile; what is left of the levels would be left each time.
        let leaves_nothing = (0..3).any(|_| {
            let before = ALLOCATOR.now();
            let (levels, most) = ALLOCATOR.peak_of(levels);
            assert!(levels.groups.len() > 200, "{name}: {} groups", levels.groups.len());
            assert!(most <= 3 * own, "{name}: {most} bytes, of the mesh {own}");
            drop(levels);
            ALLOCATOR.now() == before
        });
        assert!(leaves_nothing, "{name}");
    }
}
