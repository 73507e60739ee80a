//! Scenes of one light or one object that is refused.

use super::bad::BadEntry;

/// The keys of a light, the column of its error, and the message about it.
pub(super) const LIGHTS: &[BadEntry] = &[
    (r#""kind": 1"#, 22, r#".kind`: is a value of the wrong type: integer `1`, expected "point", "spot", "#),
    ("", 13, "`: missing key `kind`"),
    (r#""kind": "area""#, 22, r#".kind`: unknown value `area`, expected "point", "spot", "#),
    (r#""kind": "point", "inner_deg": null"#, 31, ".inner_deg`: does not belong to a point light"),
    (r#""kind": "point", "direction": [0, 0, 1]"#, 31, ".direction`: does not belong to a point light"),
    (
        r#""kind": "directional", "position": [0, 0, 1]"#,
        37,
        ".position`: does not belong to a directional light, whose keys are direction, ambient, ",
    ),
    (r#""kind": "directional", "range": 3"#, 37, ".range`: does not belong to a directional light"),
    (r#""kind": "directional", "attenuate_ambient": true"#, 37, ".attenuate_ambient`: does not belong"),
    (r#""kind": "point", "position": [0, 0, 1, 1]"#, 31, ".position`: has 4 numbers; a point light has 3"),
    (r#""kind": "homogeneous", "position": [0, 0, 1]"#, 37, ".position`: has 3 numbers; a homogeneous light has 4"),
    (
        r#""kind": "point", "range": "far""#,
        40,
        r#".range`: is a value of the wrong type: string "far", expected a number"#,
    ),
    (
        r#""kind": "point", "attach": "sun""#,
        41,
        r#".attach`: unknown value `sun`, expected "world", "camera" or {"object": "name"}"#,
    ),
    (
        r#""kind": "point", "attach": {"objekt": "a"}"#,
        42,
        r#".attach.objekt`: unknown key `objekt`, expected "world", "#,
    ),
    (
        r#""kind": "point", "attach": {"object": "a", "b": 1}"#,
        57,
        ".attach.b`: unknown key `b`, expected one key only: ",
    ),
    (
        r#""kind": "point", "position": [0, 0]"#,
        43,
        ".position`: has 2 numbers; expected 3, or 4 of a homogeneous light",
    ),
    (
        r#""kind": "point", "attenuation": [0, 0, 0]"#,
        46,
        ".attenuation`: is [0, 0, 0]; expected at least one number above 0",
    ),
    (
        r#""kind": "point", "attenuation": [1, -1, 0]"#,
        50,
        ".attenuation[1]`: is -1; expected a finite number, 0 or more",
    ),
    (r#""kind": "point", "range": 0"#, 40, ".range`: is 0; expected a finite number above 0"),
    (
        r#""kind": "point", "diffuse": [1, 1, 2e12]"#,
        49,
        ".diffuse[2]`: is 2000000000000; expected a number from 0 to 1e12",
    ),
    (r#""kind": "directional", "direction": [0, 0, 0]"#, 50, ".direction`: is [0, 0, 0]; expected a direction"),
    (r#""kind": "spot", "direction": [0, 0, 0]"#, 43, ".direction`: is [0, 0, 0]; expected a direction"),
    (
        r#""kind": "spot", "cutoff_deg": 91"#,
        44,
        ".cutoff_deg`: is 91; expected degrees from 0 to 90, or 180 for no cone",
    ),
    (r#""kind": "spot", "cutoff_deg": -1"#, 44, ".cutoff_deg`: is -1; expected degrees from 0 to 90"),
    (
        r#""kind": "spot", "inner_deg": 31"#,
        43,
        ".inner_deg`: is 31; expected degrees from 0 to cutoff_deg, which is 30",
    ),
    (r#""kind": "spot", "exponent": -0.1"#, 42, ".exponent`: is -0.1; expected a finite number, 0 or more"),
    (
        r#""kind": "homogeneous", "position": [0, 0, 0, 0]"#,
        49,
        ".position`: is [0, 0, 0, 0]; expected a point (w not 0) or a direction (w = 0)",
    ),
    (
        r#""kind": "homogeneous", "position": [1, 0, 0, 1e-39]"#,
        49,
        ".position`: is [1.0, 0.0, 0.0, 1e-39]; expected xyz/w to be finite, or w = 0",
    ),
    (
        r#""kind": "point", "attach": {"object": "pot"}"#,
        52,
        r#".attach.object`: is "pot"; no object of the scene has that name"#,
    ),
    (r#""kind": "point", "attach": {"object": 2}"#, 52, ".attach.object`: is 2; the scene has 0 objects"),
    (
        r#""kind": "directional", "animation": [{"of": "position", "keys": [[0, [0, 0, 0]]]}]"#,
        58,
        r#".animation[0].of`: is "position"; expected a key of this light: direction, ambient, diffuse, specular"#,
    ),
];

/// The keys of an object, the column of its error, and the message about it.
pub(super) const OBJECTS: &[BadEntry] = &[
    (
        r#""mesh": {"box": {}}, "transform": [1]"#,
        49,
        ".transform`: is a value of the wrong type: list, expected an object with translation, ",
    ),
    (r#""mesh": {"box": [1]}"#, 31, ".mesh.box`: is a value of the wrong type: list, expected an object such as"),
    ("", 14, "`: missing key `mesh`"),
    (r#""mesh": {}"#, 23, ".mesh`: is empty; expected an object with one of the keys path, uv_sphere, plane, box, "),
    (
        r#""mesh": "a.obj""#,
        23,
        r#".mesh`: is a value of the wrong type: string "a.obj", expected an object with one of the keys path, "#,
    ),
    (
        r#""mesh": {"tetrahedron": {}}"#,
        24,
        ".mesh.tetrahedron`: unknown key `tetrahedron`, expected an object with one of the keys path, uv_sphere, plane, ",
    ),
    (r#""mesh": {"torus": {"tube": 0}}"#, 42, ".mesh.torus.tube`: is 0; expected a length from 1e-30 to 1e30"),
    (r#""mesh": {"torus": {"tube": 2}}"#, 42, ".mesh.torus.tube`: is 2; "),
    (r#""mesh": {"torus": {"rows": 2}}"#, 42, ".mesh.torus.rows`: is 2; expected at least 3 for this surface"),
    (r#""mesh": {"cone": {"rows": 4000}}"#, 41, ".mesh.cone.rows`: is 4000; expected 1 to 2048"),
    (
        r#""mesh": {"bezier": {"points": [[[0, 0, 0]]]}}"#,
        45,
        ".mesh.bezier.points`: columns: 1; a number from 2 to 33 is expected",
    ),
    (
        r#""mesh": {"bezier": {"points": [[[0, 0, 0], [1, 0, 0]], [[0, 0, 0]]]}}"#,
        34,
        ".mesh.bezier`: `points[1]` has 1 items; expected 2, as the row before",
    ),
    (r#""mesh": {"height_field": {}}"#, 40, ".mesh.height_field`: has no heights; expected `path` or `heights`"),
    (
        r#""mesh": {"height_field": {"path": "a.png", "heights": [[0, 1], [2, 3]]}}"#,
        40,
        ".mesh.height_field`: `path` cannot stand beside `heights`",
    ),
    (
        r#""mesh": {"box": {}}, "normals": {"creased": {"angle_deg": 200}}"#,
        73,
        ".normals.creased.angle_deg`: is 200; expected degrees from 0 to 180",
    ),
    (r#""mesh": {"box": {}, "plane": {}}"#, 35, ".mesh.plane`: unknown key `plane`, expected one key only: "),
    (r#""mesh": {"box": {"side": 1}}"#, 32, ".mesh.box.side`: unknown key `side`, expected `size`"),
    (
        r#""mesh": {"box": 1}"#,
        31,
        r#".mesh.box`: is a value of the wrong type: integer `1`, expected an object such as {"size": [1, 1, 1]}"#,
    ),
    (r#""mesh": {"path": 1}"#, 32, ".mesh.path`: is a value of the wrong type: integer `1`, expected a path in quotes"),
    (
        r#""mesh": {"uv_sphere": {"segments": 5e9}}"#,
        50,
        ".mesh.uv_sphere.segments`: is a value of the wrong type: floating point `5000000000.0`, expected a whole",
    ),
    (
        r#""mesh": {"uv_sphere": {"segments": 5000000000}}"#,
        50,
        ".mesh.uv_sphere.segments`: is out of range: integer `5000000000`, expected a whole number from 0 to",
    ),
    (r#""mesh": {"inline": {"positions": []}}"#, 34, ".mesh.inline`: missing key `indices`"),
    (
        r#""mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 0, -1]}}"#,
        77,
        ".mesh.inline.indices[2]`: is out of range: integer `-1`",
    ),
    (r#""mesh": {"box": {}}, "faces": null"#, 45, ".faces`: null is not allowed here"),
    (
        r#""mesh": {"box": {}}, "normals": "smooth""#,
        47,
        r#".normals`: unknown value `smooth`, expected "keep", "face", "#,
    ),
    (
        r#""mesh": {"box": {}}, "material": {"color": [1, 0, 0]}"#,
        49,
        ".material.color`: unknown key `color`, expected one of `ambient`, `diffuse`, ",
    ),
    (
        r#""mesh": {"box": {}}, "material": 3"#,
        48,
        ".material`: is a value of the wrong type: integer `3`, expected a preset's name or an object",
    ),
    (
        r#""mesh": {"box": {}}, "transform": {"translate": [1, 0, 0]}"#,
        50,
        ".transform.translate`: unknown key `translate`, expected one of `translation`, ",
    ),
    (
        r#""mesh": {"box": {}}, "transform": {"matrix": [1, 0]}"#,
        60,
        ".transform.matrix`: is a list of length 2, expected a list of length 16",
    ),
    (
        r#""mesh": {"box": {}}, "solid": {"colors": [[0, 0, 0]]}"#,
        56,
        ".solid.colors`: is a list of length 1, expected a list of length 2",
    ),
    (r#""name": "Käse", "größe": 1"#, 31, ".größe`: unknown key `größe`"),
    (
        r#""mesh": {"path": "a.fbx"}"#,
        32,
        ".mesh.path`: is a.fbx; expected a file that ends in .smf, .obj, .gltf, .glb, .ply, .stl, .off or .3mf (Blender, or `assimp export` of Assimp, converts it to glb)",
    ),
    (r#""mesh": {"path": ""}"#, 32, ".mesh.path`: is ; expected a file that ends in"),
    (
        r#""mesh": {"uv_sphere": {"segments": 4000000000}}"#,
        50,
        ".mesh.uv_sphere.segments`: is 4000000000; expected 3 to 4096",
    ),
    (r#""mesh": {"uv_sphere": {"rings": 1}}"#, 47, ".mesh.uv_sphere.rings`: is 1; expected 2 to 2048"),
    (
        r#""mesh": {"uv_sphere": {"radius": 0}}"#,
        48,
        ".mesh.uv_sphere.radius`: is 0; expected a length from 1e-30 to 1e30",
    ),
    (
        r#""mesh": {"plane": {"divisions": 4294967295}}"#,
        47,
        ".mesh.plane.divisions`: is 4294967295; expected 1 to 2048",
    ),
    (r#""mesh": {"plane": {"size": -2}}"#, 42, ".mesh.plane.size`: is -2; expected a length from"),
    (r#""mesh": {"box": {"size": [1, 0, 1]}}"#, 44, ".mesh.box.size[1]`: is 0; expected a length from"),
    (r#""mesh": {"teapot": {"divisions": 257}}"#, 48, ".mesh.teapot.divisions`: is 257; expected 1 to 256"),
    (
        r#""mesh": {"inline": {"positions": [0, 0], "indices": [0, 0, 0]}}"#,
        48,
        ".mesh.inline.positions`: has 2 numbers; expected a multiple of 3",
    ),
    (
        r#""mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 0]}}"#,
        70,
        ".mesh.inline.indices`: has 2 numbers; expected a multiple of 3",
    ),
    (
        r#""mesh": {"inline": {"positions": [0, 0, 0], "indices": []}}"#,
        70,
        ".mesh.inline.indices`: is empty; expected at least one triangle",
    ),
    (
        r#""mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 1, 0]}}"#,
        74,
        ".mesh.inline.indices[1]`: is 1; expected less than 1, the number of vertices",
    ),
    (
        r#""mesh": {"inline": {"positions": [0, 1e39, 0], "indices": [0, 0, 0]}}"#,
        52,
        ".mesh.inline.positions[1]`: is too large; expected a number of at most 3.4e38",
    ),
    (
        r#""mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 0, 0], "normals": [0, 1]}}"#,
        92,
        ".mesh.inline.normals`: has 2 numbers; expected 3 for each of the 1 vertices",
    ),
    (
        r#""mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 0, 0], "uvs": [0, 1, 0]}}"#,
        88,
        ".mesh.inline.uvs`: has 3 numbers; expected 2 for each of the 1 vertices",
    ),
    (
        r#""mesh": {"box": {}}, "material": "gold leaf""#,
        48,
        r#".material`: no preset is named "gold leaf"; expected one of emerald, jade, "#,
    ),
    (
        r#""mesh": {"box": {}}, "back_material": {"opacity": 1.5}"#,
        65,
        ".back_material.opacity`: is 1.5; expected a number from 0 to 1",
    ),
    (
        r#""mesh": {"box": {}}, "material": {"shininess": -1}"#,
        62,
        ".material.shininess`: is -1; expected a finite number, 0 or more",
    ),
    (
        r#""mesh": {"box": {}}, "tolerance": {"steps": -2}"#,
        59,
        ".tolerance.steps`: is -2; expected a finite number, 0 or more",
    ),
    (
        r#""mesh": {"box": {}}, "transform": {"rotation": [0, 90, 0, 0]}"#,
        62,
        ".transform.rotation`: has the length 90.000; expected a quaternion [x, y, z, w] of length 1",
    ),
    (
        r#""mesh": {"box": {}}, "transform": {"rotation": [0, 0, 0, 0]}"#,
        62,
        ".transform.rotation`: has the length 0.000; ",
    ),
    (
        r#""mesh": {"box": {}}, "transform": {"scale": [1, 1e39, 1]}"#,
        63,
        ".transform.scale[1]`: is too large; expected a number of at most 3.4e38",
    ),
    (
        r#""mesh": {"box": {}}, "transform": {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2]}"#,
        94,
        ".transform.matrix[15]`: is 2; expected 1: the last row is 0, 0, 0, 1",
    ),
    (
        r#""mesh": {"box": {}}, "transform": {"matrix": [1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1]}"#,
        67,
        ".transform.matrix[3]`: is 5; expected 0: the last row is 0, 0, 0, 1",
    ),
];
