//! Scene files that are refused, and the messages that say why.

use std::path::Path;

use crate::scene::{LightEntry, LightSource, SceneError, SceneFile};

/// A scene file, where its error is (line and column), and how the message goes on.
type Bad = (&'static str, (usize, usize), &'static str);

/// The text, the place and the message of every case that is wrong in its JSON.
const NOT_JSON: &[Bad] = &[
    ("", (1, 1), "the text ends inside a value"),
    ("{", (1, 1), "the text ends inside an object"),
    (r#"{"size": [1280, 72"#, (1, 17), "`size[1]`: the text ends inside a list"),
    (r#"{"size": [NaN, 1]}"#, (1, 11), "`size[0]`: not JSON: expected a value"),
    ("{\n  \"samples\": 1,\n}", (1, 1), "trailing comma"),
    (r#"{"samples": 1} {"#, (1, 1), "more text after the end of the scene"),
    ("[]", (1, 1), "is a value of the wrong type: list, expected an object with the keys of a scene"),
    (r#"{"samples": 01}"#, (1, 13), "`samples`: invalid number"),
    (r#"{"ambient": [1e400, 0, 0]}"#, (1, 14), "`ambient[0]`: number out of range"),
];

/// The same for every key: unknown ones, wrong types, lengths of lists.
const NOT_THE_FORMAT: &[Bad] = &[
    (r#"{"sise": [1, 1]}"#, (1, 2), "`sise`: unknown key `sise`, expected one of `schema_version`, `size`, "),
    ("{\n  \"samples\": 1,\n  \"samples\": 4}", (3, 3), "`samples`: key given twice: `samples`"),
    (r#"{"size": [1280]}"#, (1, 10), "`size`: is a list of length 1, expected a list of length 2"),
    (r#"{"size": [1280, 720, 3]}"#, (1, 22), "`size[2]`: is one number too many"),
    (r#"{"size": [-1, 720]}"#, (1, 11), "`size[0]`: is out of range: integer `-1`, expected a whole number from 0 to"),
    (
        r#"{"size": [1.5, 720]}"#,
        (1, 11),
        "`size[0]`: is a value of the wrong type: floating point `1.5`, expected a whole",
    ),
    (
        r#"{"background": "red"}"#,
        (1, 16),
        "`background`: is a value of the wrong type: string \"red\", expected a list of length 3",
    ),
    (r#"{"output": "linear"}"#, (1, 12), "`output`: unknown value `linear`, expected \"srgb\" or \"raw\""),
    (r#"{"viewer": null}"#, (1, 12), "`viewer`: null is not allowed here, expected \"local\" or \"infinite\""),
    (
        r#"{"intensity": "aces2"}"#,
        (1, 15),
        "`intensity`: unknown value `aces2`, expected \"clamp\" (or \"renormalise\", ",
    ),
    (
        r#"{"shading": "smooth"}"#,
        (1, 13),
        "`shading`: unknown value `smooth`, expected \"flat\", \"gouraud\", \"phong\" or {",
    ),
    (r#"{"output": 3}"#, (1, 12), "`output`: is a value of the wrong type: integer `3`, expected \"srgb\" or \"raw\""),
    (r#"{"output": {"srgb": null}}"#, (1, 12), "`output`: is a value of the wrong type: object, expected \"srgb\""),
    (r#"{"shading": {"flat": null}}"#, (1, 14), "`shading.flat`: unknown key `flat`, expected \"flat\", \"gouraud\", "),
    (r#"{"shading": "auto"}"#, (1, 13), "`shading`: unknown value `auto`, expected \"flat\", \"gouraud\", "),
    (r#"{"shading": {}}"#, (1, 13), "`shading`: is empty; expected \"flat\", "),
    (
        r#"{"shading": {"auto": [1]}}"#,
        (1, 22),
        "`shading.auto`: is a value of the wrong type: list, expected an object such as {\"tolerance\": 1.0}",
    ),
    (
        r#"{"shading": 1}"#,
        (1, 13),
        "`shading`: is a value of the wrong type: integer `1`, expected \"flat\", \"gouraud\", ",
    ),
    (
        r#"{"shading": {"auto": {}, "phong": 1}}"#,
        (1, 26),
        "`shading.phong`: unknown key `phong`, expected one key only: ",
    ),
    (r#"{"shading": {"auto": {"tol": 1}}}"#, (1, 23), "`shading.auto.tol`: unknown key `tol`, expected `tolerance`"),
    (
        r#"{"camera": {"fov": 45}}"#,
        (1, 13),
        "`camera.fov`: unknown key `fov`, expected one of `position`, `target`, `up`, ",
    ),
    (
        r#"{"camera": []}"#,
        (1, 12),
        "`camera`: is a value of the wrong type: list, expected an object with the keys of a camera",
    ),
    (
        "{\"camera\": {\n  \"position\":\n    [0, \"0\", 3]}}",
        (3, 9),
        "`camera.position[1]`: is a value of the wrong type: string \"0\", expected a number",
    ),
    (r#"{"lights": {}}"#, (1, 12), "`lights`: is a value of the wrong type: object, expected a list"),
    (
        r#"{"lights": [["point"]]}"#,
        (1, 13),
        "`lights[0]`: is a value of the wrong type: list, expected an object with the keys of a light",
    ),
    (
        r#"{"objects": [1]}"#,
        (1, 14),
        "`objects[0]`: is a value of the wrong type: integer `1`, expected an object with the keys of a scene's object",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "transform": [1]}]}"#,
        (1, 49),
        "`objects[0].transform`: is a value of the wrong type: list, expected an object with translation, ",
    ),
    (
        r#"{"objects": [{"mesh": {"box": [1]}}]}"#,
        (1, 31),
        "`objects[0].mesh.box`: is a value of the wrong type: list, expected an object such as",
    ),
    (
        r#"{"lights": [{"kind": 1}]}"#,
        (1, 22),
        "`lights[0].kind`: is a value of the wrong type: integer `1`, expected \"point\", \"spot\", ",
    ),
    (r#"{"lights": [{}]}"#, (1, 13), "`lights[0]`: missing key `kind`"),
    (
        r#"{"lights": [{"kind": "area"}]}"#,
        (1, 22),
        "`lights[0].kind`: unknown value `area`, expected \"point\", \"spot\", ",
    ),
    (
        "{\"lights\": [\n  {\"kind\": \"point\"},\n  {\"kind\": \"point\",\n   \"colour\": [1, 1, 1]}]}",
        (4, 4),
        "`lights[1].colour`: unknown key `colour`, expected one of `kind`, `position`, ",
    ),
    (
        "{\"lights\": [{\n  \"cutoff_deg\": 30,\n  \"kind\": \"point\"}]}",
        (2, 3),
        "`lights[0].cutoff_deg`: does not belong to a point light, whose keys are position, attenuation, ",
    ),
    (
        r#"{"lights": [{"kind": "point", "inner_deg": null}]}"#,
        (1, 31),
        "`lights[0].inner_deg`: does not belong to a point light",
    ),
    (
        r#"{"lights": [{"kind": "point", "direction": [0, 0, 1]}]}"#,
        (1, 31),
        "`lights[0].direction`: does not belong to a point light",
    ),
    (
        r#"{"lights": [{"kind": "directional", "position": [0, 0, 1]}]}"#,
        (1, 37),
        "`lights[0].position`: does not belong to a directional light, whose keys are direction, ambient, ",
    ),
    (
        r#"{"lights": [{"kind": "directional", "range": 3}]}"#,
        (1, 37),
        "`lights[0].range`: does not belong to a directional light",
    ),
    (
        r#"{"lights": [{"kind": "directional", "attenuate_ambient": true}]}"#,
        (1, 37),
        "`lights[0].attenuate_ambient`: does not belong",
    ),
    (
        r#"{"lights": [{"kind": "point", "position": [0, 0, 1, 1]}]}"#,
        (1, 31),
        "`lights[0].position`: has 4 numbers; a point light has 3",
    ),
    (
        r#"{"lights": [{"kind": "homogeneous", "position": [0, 0, 1]}]}"#,
        (1, 37),
        "`lights[0].position`: has 3 numbers; a homogeneous light has 4",
    ),
    (
        r#"{"lights": [{"kind": "point", "range": "far"}]}"#,
        (1, 40),
        "`lights[0].range`: is a value of the wrong type: string \"far\", expected a number",
    ),
    (
        r#"{"lights": [{"kind": "point", "attach": "sun"}]}"#,
        (1, 41),
        "`lights[0].attach`: unknown value `sun`, expected \"world\", \"camera\" or {\"object\": \"name\"}",
    ),
    (
        r#"{"lights": [{"kind": "point", "attach": {"objekt": "a"}}]}"#,
        (1, 42),
        "`lights[0].attach.objekt`: unknown key `objekt`, expected \"world\", ",
    ),
    (
        r#"{"lights": [{"kind": "point", "attach": {"object": "a", "b": 1}}]}"#,
        (1, 57),
        "`lights[0].attach.b`: unknown key `b`, expected one key only: ",
    ),
    (r#"{"objects": [{}]}"#, (1, 14), "`objects[0]`: missing key `mesh`"),
    (
        r#"{"objects": [{"mesh": {}}]}"#,
        (1, 23),
        "`objects[0].mesh`: is empty; expected one of the keys path, uv_sphere, plane, box, ",
    ),
    (
        r#"{"objects": [{"mesh": "a.obj"}]}"#,
        (1, 23),
        "`objects[0].mesh`: is a value of the wrong type: string \"a.obj\", expected an object with one of the keys path, ",
    ),
    (
        r#"{"objects": [{"mesh": {"torus": {}}}]}"#,
        (1, 24),
        "`objects[0].mesh.torus`: unknown key `torus`, expected path, uv_sphere, plane, box, teapot or inline; further surfaces: not yet",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}, "plane": {}}}]}"#,
        (1, 35),
        "`objects[0].mesh.plane`: unknown key `plane`, expected one key only: ",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {"side": 1}}}]}"#,
        (1, 32),
        "`objects[0].mesh.box.side`: unknown key `side`, expected `size`",
    ),
    (
        r#"{"objects": [{"mesh": {"box": 1}}]}"#,
        (1, 31),
        "`objects[0].mesh.box`: is a value of the wrong type: integer `1`, expected an object such as {\"size\": [1, 1, 1]}",
    ),
    (
        r#"{"objects": [{"mesh": {"path": 1}}]}"#,
        (1, 32),
        "`objects[0].mesh.path`: is a value of the wrong type: integer `1`, expected a path in quotes",
    ),
    (
        r#"{"objects": [{"mesh": {"uv_sphere": {"segments": 5e9}}}]}"#,
        (1, 50),
        "`objects[0].mesh.uv_sphere.segments`: is a value of the wrong type: floating point `5000000000.0`, expected a whole",
    ),
    (
        r#"{"objects": [{"mesh": {"uv_sphere": {"segments": 5000000000}}}]}"#,
        (1, 50),
        "`objects[0].mesh.uv_sphere.segments`: is out of range: integer `5000000000`, expected a whole number from 0 to",
    ),
    (
        r#"{"objects": [{"mesh": {"inline": {"positions": []}}}]}"#,
        (1, 34),
        "`objects[0].mesh.inline`: missing key `indices`",
    ),
    (
        r#"{"objects": [{"mesh": {"inline": {"positions": [0, 0, 0], "indices": [0, 0, -1]}}}]}"#,
        (1, 77),
        "`objects[0].mesh.inline.indices[2]`: is out of range: integer `-1`",
    ),
    (r#"{"objects": [{"mesh": {"box": {}}, "faces": null}]}"#, (1, 45), "`objects[0].faces`: null is not allowed here"),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "normals": "smooth"}]}"#,
        (1, 47),
        "`objects[0].normals`: unknown value `smooth`, expected \"keep\", \"face\", ",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "material": {"color": [1, 0, 0]}}]}"#,
        (1, 49),
        "`objects[0].material.color`: unknown key `color`, expected one of `ambient`, `diffuse`, ",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "material": 3}]}"#,
        (1, 48),
        "`objects[0].material`: is a value of the wrong type: integer `3`, expected a preset's name or an object",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "transform": {"translate": [1, 0, 0]}}]}"#,
        (1, 50),
        "`objects[0].transform.translate`: unknown key `translate`, expected one of `translation`, ",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "transform": {"matrix": [1, 0]}}]}"#,
        (1, 60),
        "`objects[0].transform.matrix`: is a list of length 2, expected a list of length 16",
    ),
    (
        "{\"objects\": [{\"mesh\": {\"box\": {}}, \"transform\": {\n\"scale\": [1, 1, 1],\n\"matrix\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}}]}",
        (2, 1),
        "`objects[0].transform.scale`: cannot stand beside `matrix`, which says it all",
    ),
    // A key that is not ASCII: columns are counted in characters.
    ("{\"objects\": [{\"name\": \"Käse\", \"größe\": 1}]}", (1, 31), "`objects[0].größe`: unknown key `größe`"),
];

/// The same for every value that JSON can hold and the format cannot.
const OUT_OF_RANGE: &[Bad] = &[
    (r#"{"schema_version": 2}"#, (1, 20), "`schema_version`: is 2; this version reads 1 only"),
    (r#"{"schema_version": 0}"#, (1, 20), "`schema_version`: is 0; this version reads 1 only"),
    (r#"{"size": [0, 720]}"#, (1, 11), "`size[0]`: is 0; expected 1 to 16384"),
    (r#"{"size": [1280, 16385]}"#, (1, 17), "`size[1]`: is 16385; expected 1 to 16384"),
    (r#"{"background": [0, -0.5, 0]}"#, (1, 20), "`background[1]`: is -0.5; expected a number from 0 to 1e12"),
    (r#"{"ambient": [0, 0, 1e39]}"#, (1, 20), "`ambient[2]`: is inf; expected a number from 0 to 1e12"),
    (r#"{"samples": 2}"#, (1, 13), "`samples`: is 2; expected 1 or 4"),
    (
        r#"{"intensity": "reinhard"}"#,
        (1, 15),
        "`intensity`: not yet: this version knows the intensity policy \"clamp\" only",
    ),
    (r#"{"intensity": "renormalise"}"#, (1, 15), "`intensity`: not yet: "),
    (r#"{"intensity": "aces"}"#, (1, 15), "`intensity`: not yet: "),
    (
        r#"{"shading": {"auto": {"tolerance": 2}}}"#,
        (1, 22),
        "`shading.auto`: not yet: this version does not choose the shading by itself; ",
    ),
    (
        r#"{"shading": {"auto": {"tolerance": 0}}}"#,
        (1, 36),
        "`shading.auto.tolerance`: is 0; expected a finite number above 0",
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
        r#"{"objects": [{"mesh": {"path": "a.stl"}}]}"#,
        (1, 32),
        "`objects[0].mesh.path`: not yet: this version does not read stl; expected a file that ends in .smf, ",
    ),
    (
        r#"{"objects": [{"mesh": {"path": "a.PLY"}}]}"#,
        (1, 32),
        "`objects[0].mesh.path`: not yet: this version does not read ply; ",
    ),
    (
        r#"{"objects": [{"mesh": {"path": "a.fbx"}}]}"#,
        (1, 32),
        "`objects[0].mesh.path`: is a.fbx; expected a file that ends in .smf, .obj, .gltf or .glb",
    ),
    (r#"{"objects": [{"mesh": {"path": ""}}]}"#, (1, 32), "`objects[0].mesh.path`: is ; expected a file that ends in"),
    (
        r#"{"objects": [{"mesh": {"uv_sphere": {"segments": 4000000000}}}]}"#,
        (1, 50),
        "`objects[0].mesh.uv_sphere.segments`: is 4000000000; a number from 3 to 4096 is expected",
    ),
    (
        r#"{"objects": [{"mesh": {"uv_sphere": {"rings": 1}}}]}"#,
        (1, 47),
        "`objects[0].mesh.uv_sphere.rings`: is 1; a number from 2 to 2048 is expected",
    ),
    (
        r#"{"objects": [{"mesh": {"uv_sphere": {"radius": 0}}}]}"#,
        (1, 48),
        "`objects[0].mesh.uv_sphere.radius`: is 0; a length from 1e-30 to 1e30 is expected",
    ),
    (
        r#"{"objects": [{"mesh": {"plane": {"divisions": 4294967295}}}]}"#,
        (1, 47),
        "`objects[0].mesh.plane.divisions`: is 4294967295; a number from 1 to 2048 is expected",
    ),
    (
        r#"{"objects": [{"mesh": {"plane": {"size": -2}}}]}"#,
        (1, 42),
        "`objects[0].mesh.plane.size`: is -2; a length from",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {"size": [1, 0, 1]}}}]}"#,
        (1, 44),
        "`objects[0].mesh.box.size[1]`: is 0; a length from",
    ),
    (
        r#"{"objects": [{"mesh": {"teapot": {"divisions": 257}}}]}"#,
        (1, 48),
        "`objects[0].mesh.teapot.divisions`: is 257; a number from 1 to 256 is expected",
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
        r#"{"objects": [{"mesh": {"box": {}}, "shading": {"auto": {}}}]}"#,
        (1, 56),
        "`objects[0].shading.auto`: not yet: ",
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

#[test]
fn every_bad_file_is_refused_where_it_is_wrong() {
    let mut wrong = Vec::new();
    for (text, (line, column), message) in [NOT_JSON, NOT_THE_FORMAT, OUT_OF_RANGE].concat() {
        let expected = format!("dir/bad.json:{line}:{column}: {message}");
        match SceneFile::from_json(text, "dir/bad.json") {
            Ok(_) => wrong.push(format!("{text}\n  accepted; expected: {expected}")),
            Err(error) if error.to_string().starts_with(&expected) => {}
            Err(error) => wrong.push(format!("{text}\n  {error}\n  expected: {expected}")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn deep_nesting_is_refused_without_overflow() {
    let text = format!("{{\"objects\": {}", "[".repeat(1_000_000));
    let error = SceneFile::from_json(&text, "deep").unwrap_err();
    assert!(error.to_string().starts_with("deep:1:14: `objects[0]`: is a value of the wrong type: list"), "{error}");
}

#[test]
fn files_that_are_no_text() {
    let dir = std::env::temp_dir().join(format!("halfway-scene-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    let latin1 = dir.join("latin1.json");
    std::fs::write(&latin1, b"{\"objects\": [{\"name\": \"K\xe4se\"}]}").unwrap();
    let marked = dir.join("marked.json");
    std::fs::write(&marked, "\u{feff}{\"samples\": 4}").unwrap();

    let read = |path: &Path| SceneFile::read(path).map_err(|error| error.to_string());
    let error = read(&latin1).unwrap_err();
    assert!(error.starts_with(&format!("{}: is not UTF-8 text (byte 24)", latin1.display())), "{error}");
    assert_eq!(read(&marked).unwrap().samples, 4);
    let missing = dir.join("missing.json");
    let error = read(&missing).unwrap_err();
    assert!(error.starts_with(&format!("{}: cannot be read: ", missing.display())), "{error}");
    let error = read(&dir).unwrap_err();
    assert!(error.starts_with(&format!("{}: cannot be read: ", dir.display())), "{error}");
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn a_scene_made_in_code_is_checked_before_it_is_written() {
    let mut scene = SceneFile::default();
    let mut light = LightEntry::white(LightSource::point());
    light.diffuse[1] = f32::NAN;
    scene.lights = Some(vec![LightEntry::white(LightSource::spot()), light]);
    let error = scene.to_json().unwrap_err();
    assert!(matches!(error, SceneError::Value { .. }));
    assert_eq!(error.key(), Some("lights[1].diffuse[1]"));
    assert_eq!(error.to_string(), "scene: `lights[1].diffuse[1]`: is NaN; expected a number from 0 to 1e12");
}
