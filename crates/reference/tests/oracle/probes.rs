//! Probes of points of the picture.

use bevy_math::DVec3;
use bevy_transform::components::GlobalTransform;
use halfway_lighting::Faces;

use crate::scene::{Stage, glow, panel, ray, scaled, wall};

#[test]
fn the_nearest_thing_has_its_name_side_and_place() {
    let eye = DVec3::new(1.0, 2.0, 0.5);
    let mut stage = Stage::new();
    stage.world.entity_mut(stage.camera).insert(GlobalTransform::from_translation(eye.as_vec3()));
    let far = stage.add(wall(19.0, 5.0), glow(1.0, 0.0, 0.0));
    // Mirrored in depth, it stands 3 before the origin with its front turned away.
    let looks = (glow(0.0, 1.0, 0.0), Faces::Both);
    let near = stage.add_at(panel(-9.0, 1.0, -9.0, 9.0, -3.0), scaled(1.0, 1.0, -1.0), looks);
    let oracle = stage.oracle(8, 8);
    for (x, y, object, front, depth) in [(1, 2, near, false, 3.5), (6, 2, far, true, 5.5)] {
        let centre = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let nearest = oracle.probe(centre.0, centre.1).nearest.expect("a wall");
        assert_eq!((nearest.object, nearest.front), (object, front));
        assert!((nearest.depth - depth).abs() < 1e-12);
        assert!(nearest.position.distance(eye + depth * ray(x, y, 8, 8)) < 1e-12);
        let (back_x, back_y) = oracle.project(nearest.position).expect("before the eye");
        assert!((back_x - centre.0).abs() < 1e-12 && (back_y - centre.1).abs() < 1e-12);
    }
    assert_eq!(oracle.project(eye - 0.05 * DVec3::Z), None, "before the near plane");
}
