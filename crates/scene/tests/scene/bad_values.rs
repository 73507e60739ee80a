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
        r#"{"lights": [{"kind": "point", "attenuation": [0, 0, 0]}]}"#,
        (1, 46),
        "`lights[0].attenuation`: is [0, 0, 0]; expected at least one number above 0",
    ),
    (
        r#"{"lights": [{"kind": "point", "attenuation": [1, -1, 0]}]}"#,
        (1, 50),
        "`lights[0].attenuation[1]`: is -1; expected a finite number, 0 or more",
    ),
    (
        r#"{"lights": [{"kind": "point", "range": 0}]}"#,
        (1, 40),
        "`lights[0].range`: is 0; expected a finite number above 0",
    ),
    (
        r#"{"lights": [{"kind": "point", "diffuse": [1, 1, 2e12]}]}"#,
        (1, 49),
        "`lights[0].diffuse[2]`: is 2000000000000; expected a number from 0 to 1e12",
    ),
    (
        r#"{"lights": [{"kind": "directional", "direction": [0, 0, 0]}]}"#,
        (1, 50),
        "`lights[0].direction`: is [0, 0, 0]; expected a direction",
    ),
    (
        r#"{"lights": [{"kind": "spot", "direction": [0, 0, 0]}]}"#,
        (1, 43),
        "`lights[0].direction`: is [0, 0, 0]; expected a direction",
    ),
    (
        r#"{"lights": [{"kind": "spot", "cutoff_deg": 91}]}"#,
        (1, 44),
        "`lights[0].cutoff_deg`: is 91; expected degrees from 0 to 90, or 180 for no cone",
    ),
    (
        r#"{"lights": [{"kind": "spot", "cutoff_deg": -1}]}"#,
        (1, 44),
        "`lights[0].cutoff_deg`: is -1; expected degrees from 0 to 90",
    ),
    (
        r#"{"lights": [{"kind": "spot", "inner_deg": 31}]}"#,
        (1, 43),
        "`lights[0].inner_deg`: is 31; expected degrees from 0 to cutoff_deg, which is 30",
    ),
    (
        r#"{"lights": [{"kind": "spot", "exponent": -0.1}]}"#,
        (1, 42),
        "`lights[0].exponent`: is -0.1; expected a finite number, 0 or more",
    ),
    (
        r#"{"lights": [{"kind": "homogeneous", "position": [0, 0, 0, 0]}]}"#,
        (1, 49),
        "`lights[0].position`: is [0, 0, 0, 0]; expected a point (w not 0) or a direction (w = 0)",
    ),
    (
        r#"{"lights": [{"kind": "homogeneous", "position": [1, 0, 0, 1e-39]}]}"#,
        (1, 49),
        "`lights[0].position`: is [1.0, 0.0, 0.0, 1e-39]; expected xyz/w to be finite, or w = 0",
    ),
    (
        r#"{"lights": [{"kind": "point", "attach": {"object": "pot"}}]}"#,
        (1, 52),
        "`lights[0].attach.object`: is \"pot\"; no object of the scene has that name",
    ),
    (
        r#"{"objects": [{"name": "a", "mesh": {"box": {}}}, {"name": "a", "mesh": {"box": {}}}]}"#,
        (1, 59),
        "`objects[1].name`: is \"a\", as of an object before; expected a name of its own",
    ),
    (
        r#"{"objects": [{"mesh": {"path": "a.fbx"}}]}"#,
        (1, 32),
        "`objects[0].mesh.path`: is a.fbx; expected a file that ends in .smf, .obj, .gltf, .glb, .ply or .stl",
    ),
    (r#"{"objects": [{"mesh": {"path": ""}}]}"#, (1, 32), "`objects[0].mesh.path`: is ; expected a file that ends in"),
    (
        r#"{"objects": [{"mesh": {"uv_sphere": {"segments": 4000000000}}}]}"#,
        (1, 50),
        "`objects[0].mesh.uv_sphere.segments`: is 4000000000; expected 3 to 4096",
    ),
    (
        r#"{"objects": [{"mesh": {"uv_sphere": {"rings": 1}}}]}"#,
        (1, 47),
        "`objects[0].mesh.uv_sphere.rings`: is 1; expected 2 to 2048",
    ),
    (
        r#"{"objects": [{"mesh": {"uv_sphere": {"radius": 0}}}]}"#,
        (1, 48),
        "`objects[0].mesh.uv_sphere.radius`: is 0; expected a length from 1e-30 to 1e30",
    ),
    (
        r#"{"objects": [{"mesh": {"plane": {"divisions": 4294967295}}}]}"#,
        (1, 47),
        "`objects[0].mesh.plane.divisions`: is 4294967295; expected 1 to 2048",
    ),
    (
        r#"{"objects": [{"mesh": {"plane": {"size": -2}}}]}"#,
        (1, 42),
        "`objects[0].mesh.plane.size`: is -2; expected a length from",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {"size": [1, 0, 1]}}}]}"#,
        (1, 44),
        "`objects[0].mesh.box.size[1]`: is 0; expected a length from",
    ),
    (
        r#"{"objects": [{"mesh": {"teapot": {"divisions": 257}}}]}"#,
        (1, 48),
        "`objects[0].mesh.teapot.divisions`: is 257; expected 1 to 256",
    ),
    (
        r#"{"objects": [{"mesh": {"inline": {"positions": [0, 0], "indices": [0, 0, 0]}}}]}"#,
        (1, 48),
        "`objects[0].mesh.inline.positions`: has 2 numbers; expected a multiple of 3",
    ),
    (
        r#"{"objects": [{"mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 0]}}}]}"#,
        (1, 70),
        "`objects[0].mesh.inline.indices`: has 2 numbers; expected a multiple of 3",
    ),
    (
        r#"{"objects": [{"mesh": {"inline": {"positions": [0, 0, 0], "indices": []}}}]}"#,
        (1, 70),
        "`objects[0].mesh.inline.indices`: is empty; expected at least one triangle",
    ),
    (
        r#"{"objects": [{"mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 1, 0]}}}]}"#,
        (1, 74),
        "`objects[0].mesh.inline.indices[1]`: is 1; expected less than 1, the number of vertices",
    ),
    (
        r#"{"objects": [{"mesh": {"inline": {"positions": [0, 1e39, 0], "indices": [0, 0, 0]}}}]}"#,
        (1, 52),
        "`objects[0].mesh.inline.positions[1]`: is inf; expected a finite number",
    ),
    (
        r#"{"objects": [{"mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 0, 0], "normals": [0, 1]}}}]}"#,
        (1, 92),
        "`objects[0].mesh.inline.normals`: has 2 numbers; expected 3 for each of the 1 vertices",
    ),
    (
        r#"{"objects": [{"mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 0, 0], "uvs": [0, 1, 0]}}}]}"#,
        (1, 88),
        "`objects[0].mesh.inline.uvs`: has 3 numbers; expected 2 for each of the 1 vertices",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "material": "gold leaf"}]}"#,
        (1, 48),
        "`objects[0].material`: no preset is named \"gold leaf\"; expected one of emerald, jade, ",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "back_material": {"opacity": 1.5}}]}"#,
        (1, 65),
        "`objects[0].back_material.opacity`: is 1.5; expected a number from 0 to 1",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "material": {"shininess": -1}}]}"#,
        (1, 62),
        "`objects[0].material.shininess`: is -1; expected a finite number, 0 or more",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "tolerance": {"steps": -2}}]}"#,
        (1, 59),
        "`objects[0].tolerance.steps`: is -2; expected a finite number, 0 or more",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "transform": {"rotation": [0, 90, 0, 0]}}]}"#,
        (1, 62),
        "`objects[0].transform.rotation`: has the length 90.000; expected a quaternion [x, y, z, w] of length 1",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "transform": {"rotation": [0, 0, 0, 0]}}]}"#,
        (1, 62),
        "`objects[0].transform.rotation`: has the length 0.000; ",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "transform": {"scale": [1, 1e39, 1]}}]}"#,
        (1, 63),
        "`objects[0].transform.scale[1]`: is inf; expected a finite number",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "transform": {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2]}}]}"#,
        (1, 94),
        "`objects[0].transform.matrix[15]`: is 2; expected 1: the last row is 0, 0, 0, 1",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "transform": {"matrix": [1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1]}}]}"#,
        (1, 67),
        "`objects[0].transform.matrix[3]`: is 5; expected 0: the last row is 0, 0, 0, 1",
    ),
];
