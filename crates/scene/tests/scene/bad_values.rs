//! Scenes with values that JSON can hold and the format cannot.

use super::bad::Bad;

/// The text, the place and the message of every case.
pub(super) const OUT_OF_RANGE: &[Bad] = &[
    (r#"{"schema_version": 2}"#, (1, 20), "`schema_version`: is 2; this version reads 1 only"),
    (r#"{"schema_version": 0}"#, (1, 20), "`schema_version`: is 0; this version reads 1 only"),
    (r#"{"size": [0, 720]}"#, (1, 11), "`size[0]`: is 0; expected 1 to 16384"),
    (r#"{"size": [1280, 16385]}"#, (1, 17), "`size[1]`: is 16385; expected 1 to 16384"),
    (r#"{"background": [0, -0.5, 0]}"#, (1, 20), "`background[1]`: is -0.5; expected a number from 0 to 1e12"),
    (r#"{"ambient": [0, 0, 1e39]}"#, (1, 20), "`ambient[2]`: is inf; expected a number from 0 to 1e12"),
    (r#"{"samples": 2}"#, (1, 13), "`samples`: is 2; expected 1 or 4"),
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
        "`environment.rotation_deg`: is inf; expected a finite number",
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
        "`objects[1].name`: is \"a\", as of an object before; expected a name of its own",
    ),
];
