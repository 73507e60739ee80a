//! Scenes with values that JSON can hold and the format cannot.

use super::bad::Bad;

/// The text, the place and the message of every case.
pub(super) const OUT_OF_RANGE: &[Bad] = &[
    (r#"{"schema_version": 2}"#, (1, 20), "`schema_version`: is 2; this version reads 1 only"),
    (r#"{"schema_version": 0}"#, (1, 20), "`schema_version`: is 0; this version reads 1 only"),
    (r#"{"size": [0, 720]}"#, (1, 11), "`size[0]`: is 0; expected 1 to 16384"),
    (r#"{"size": [1280, 16385]}"#, (1, 17), "`size[1]`: is 16385; expected 1 to 16384"),
    (r#"{"background": [0, -0.5, 0]}"#, (1, 20), "`background[1]`: is -0.5; expected a number from 0 to 1e12"),
    (r#"{"ambient": [0, 0, 1e39]}"#, (1, 20), "`ambient[2]`: is too large; expected a number of at most 3.4e38"),
    (r#"{"samples": 2}"#, (1, 13), "`samples`: is 2; expected 1, 4, 16 or 64"),
    (
        r#"{"intensity": {"reinhard": {"white": 0.5}}}"#,
        (1, 38),
        "`intensity.reinhard.white`: is 0.5; expected a finite number, 1 or more",
    ),
    (
        r#"{"intensity": {"renormalise": {"smoothing": 1}}}"#,
        (1, 45),
        "`intensity.renormalise.smoothing`: is 1; expected a number from 0 to below 1",
    ),
    (
        r#"{"shading": {"auto": {"tolerance": -1}}}"#,
        (1, 36),
        "`shading.auto.tolerance`: is -1; expected a finite number, 0 or more",
    ),
    (r#"{"tolerance": {"steps": -1}}"#, (1, 25), "`tolerance.steps`: is -1; expected a finite number, 0 or more"),
    (r#"{"tolerance": {"pixels": -0.5}}"#, (1, 26), "`tolerance.pixels`: is -0.5; expected a finite number, 0 or more"),
    (
        r#"{"environment": {"paths": ["a.hdr"], "strength": -1}}"#,
        (1, 50),
        "`environment.strength`: is -1; expected a number from 0 to 1000000",
    ),
    (
        r#"{"environment": {"paths": ["a.hdr"], "rotation_deg": 1e39}}"#,
        (1, 54),
        "`environment.rotation_deg`: is too large; expected a number of at most 3.4e38",
    ),
    (r#"{"environment": {"paths": []}}"#, (1, 27), "`environment.paths`: has 0 files; expected 1 for this shape"),
    (
        r#"{"environment": {"paths": ["a.hdr"], "shape": "cube"}}"#,
        (1, 27),
        "`environment.paths`: has 1 files; expected 6 for this shape",
    ),
    (r#"{"camera": {"fov_y_deg": 0}}"#, (1, 26), "`camera.fov_y_deg`: is 0; expected degrees above 0 and below 180"),
    (
        r#"{"camera": {"fov_y_deg": 180}}"#,
        (1, 26),
        "`camera.fov_y_deg`: is 180; expected degrees above 0 and below 180",
    ),
    (r#"{"camera": {"near": 0}}"#, (1, 21), "`camera.near`: is 0; expected a finite number above 0"),
    (
        r#"{"camera": {"up": [0, 0, 0]}}"#,
        (1, 19),
        "`camera.up`: is [0, 0, 0]; expected a direction, of any length above 0",
    ),
    (
        r#"{"camera": {"up": [0, 0, -2]}}"#,
        (1, 19),
        "`camera.up`: is along the line of sight; expected another direction",
    ),
    (
        r#"{"camera": {"position": [1e39, 0, 0]}}"#,
        (1, 26),
        "`camera.position[0]`: is inf; expected a finite number of at most 3.4e38",
    ),
    // The value at fault has its default: the error is where it could have been given.
    (
        r#"{"camera": {"position": [0, 0, 0]}}"#,
        (1, 12),
        "`camera.target`: is where the camera stands; expected another point",
    ),
    (
        r#"{"objects": [{"name": "a", "mesh": {"box": {}}}, {"name": "a", "mesh": {"box": {}}}]}"#,
        (1, 59),
        "`objects[1].name`: is \"a\", as of `objects[0]`; expected a name of its own",
    ),
    (
        r#"{"objects": [{"name": "a", "mesh": {"box": {}}}], "lights": [{"kind": "point"}, {"kind": "point", "name": "a"}]}"#,
        (1, 23),
        "`objects[0].name`: is \"a\", as of `lights[1]`; expected a name of its own",
    ),
    (
        r#"{"camera": {"name": "a"}, "cameras": [{}, {"name": "a"}]}"#,
        (1, 52),
        "`cameras[1].name`: is \"a\", as of `camera`; expected a name of its own",
    ),
    (
        r#"{"camera": {"height": 3, "fov_y_deg": 30}}"#,
        (1, 39),
        "`camera.fov_y_deg`: cannot stand beside `height`, which makes the camera orthographic",
    ),
    (r#"{"camera": {"far": 3}}"#, (1, 20), "`camera.far`: is of an orthographic camera; expected a `height` beside it"),
    (
        r#"{"camera": {"height": 3, "near": 4, "far": 3}}"#,
        (1, 44),
        "`camera.far`: is 3; expected more than `near`, which is 4",
    ),
    (r#"{"camera": {"height": 0}}"#, (1, 23), "`camera.height`: is 0; expected a finite number above 0"),
    (
        r#"{"cameras": [{"shift": [0, -101]}]}"#,
        (1, 28),
        "`cameras[0].shift[1]`: is -101; expected a number from -100 to 100",
    ),
    (
        r#"{"camera": {"shift": [0, 1], "intrinsics": {"focal": [1, 1], "center": [1, 1], "size": [2, 2]}}}"#,
        (1, 22),
        "`camera.shift`: cannot stand beside `intrinsics`, which say it all",
    ),
    (
        r#"{"camera": {"intrinsics": {"focal": [1, 0], "center": [1, 1], "size": [2, 2]}}}"#,
        (1, 41),
        "`camera.intrinsics.focal[1]`: is 0; expected a finite number above 0",
    ),
    (
        r#"{"camera": {"intrinsics": {"focal": [1, 1e30], "center": [1, 1], "size": [2, 2]}}}"#,
        (1, 27),
        "`camera.intrinsics`: come to nothing: Projection.film.aspect: the value is",
    ),
    (
        r#"{"camera": {"animation": [{"of": "scale", "keys": [[0, [1, 1, 1]]]}]}}"#,
        (1, 34),
        "`camera.animation[0].of`: is \"scale\"; expected a key of this camera: position, target, up or fov_y_deg",
    ),
    (
        r#"{"camera": {"animation": [{"of": "up", "keys": []}]}}"#,
        (1, 48),
        "`camera.animation[0].keys`: is empty; expected at least one pair [time, value]",
    ),
    (
        r#"{"camera": {"animation": [{"of": "up", "keys": [[1, [0, 1, 0]], [1, [1, 0, 0]]]}]}}"#,
        (1, 66),
        "`camera.animation[0].keys[1][0]`: is 1; expected a time after 1, that of the pair before",
    ),
    (
        r#"{"camera": {"animation": [{"of": "up", "keys": [[1, [0, 1]]]}]}}"#,
        (1, 53),
        "`camera.animation[0].keys[0][1]`: has 2 numbers; expected 3 numbers, as `up` has",
    ),
    (
        r#"{"camera": {"animation": [{"of": "up", "keys": [[1]]}]}}"#,
        (1, 49),
        "`camera.animation[0].keys[0]`: is [1]; expected [time, value], such as [0.5, [1, 0, 0]]",
    ),
    (
        r#"{"camera": {"animation": [{"of": "fov_y_deg", "keys": [[-1, 30]]}]}}"#,
        (1, 57),
        "`camera.animation[0].keys[0][0]`: is -1; expected a finite number, 0 or more",
    ),
    (
        r#"{"camera": {"animation": [{"of": "fov_y_deg", "keys": [[1, 180]]}]}}"#,
        (1, 60),
        "`camera.animation[0].keys[0][1]`: has 180; expected of `fov_y_deg` degrees above 0 and below 180",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "animation": [{"of": "rotation", "keys": [[0, [0, 0, 0, 2]]]}]}]}"#,
        (1, 82),
        "`objects[0].animation[0].keys[0][1]`: has the length 2.000; expected a quaternion",
    ),
];
