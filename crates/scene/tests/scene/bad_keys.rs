//! Texts that are not JSON, and JSON that is not a scene.

use super::bad::Bad;

/// The text, the place and the message of every case that is wrong in its JSON.
pub(super) const NOT_JSON: &[Bad] = &[
    ("", (1, 1), "the text ends inside a value"),
    ("{", (1, 2), "the text ends inside an object"),
    (r#"{"size": [1280, 72"#, (1, 19), "`size`: the text ends inside a list"),
    (r#"{"size": [NaN, 1]}"#, (1, 11), "`size[0]`: not JSON: expected a value"),
    (r#"{"camera": {"fov_y_deg": 30, "ne"#, (1, 33), "`camera`: the text ends inside a string"),
    ("{\n  \"samples\": 1,\n}", (3, 1), "trailing comma"),
    ("{\n  \"samples\": 1\n  \"size\": [2, 2]\n}", (3, 3), "expected `,` or `}`"),
    ("{\n  \"samples\": 1,\n  // four\n  \"size\": [2, 2]}", (3, 3), "not JSON: expected a key in quotes"),
    ("{\n  'samples': 1\n}", (2, 3), "not JSON: expected a key in quotes"),
    ("{\n  \"size\": [\n    2,\n    2,\n  ]\n}", (5, 3), "`size`: trailing comma"),
    ("{\n  \"objects\": [\n    {\n", (4, 1), "`objects[0]`: the text ends inside an object"),
    ("{\n  \"samples\": 1\n}\n}\n", (4, 1), "more text after the end of the scene"),
    (r#"{"samples": 1} {"#, (1, 16), "more text after the end of the scene"),
    ("[]", (1, 1), "is a value of the wrong type: list, expected an object with the keys of a scene"),
    (r#"{"samples": 01}"#, (1, 13), "`samples`: invalid number"),
    (r#"{"ambient": [1e400, 0, 0]}"#, (1, 14), "`ambient[0]`: number out of range"),
];

/// The same for every key: unknown ones, wrong types, lengths of lists.
pub(super) const NOT_THE_FORMAT: &[Bad] = &[
    (r#"{"sise": [1, 1]}"#, (1, 2), "`sise`: unknown key `sise`, expected one of `schema_version`, `size`, "),
    ("{\n  \"samples\": 1,\n  \"samples\": 4}", (3, 3), "`samples`: key given twice: `samples`"),
    (r#"{"size": [1280]}"#, (1, 10), "`size`: is a list of length 1, expected a list of length 2"),
    (r#"{"size": [1280, 720, 3]}"#, (1, 22), "`size[2]`: is one item too many; expected a list of length 2"),
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
        "`intensity`: unknown value `aces2`, expected \"clamp\", \"renormalise\", \"reinhard\", \"aces\", {\"renormalise\": {",
    ),
    (r#"{"intensity": {"aces": {}}}"#, (1, 16), "`intensity.aces`: unknown key `aces`, expected \"clamp\", "),
    (
        r#"{"intensity": {"reinhard": 4}}"#,
        (1, 28),
        "`intensity.reinhard`: is a value of the wrong type: integer `4`, expected an object such as {\"white\": 4}",
    ),
    (
        r#"{"intensity": {"reinhard": {"smoothing": 0.5}}}"#,
        (1, 29),
        "`intensity.reinhard.smoothing`: unknown key `smoothing`, expected `white`",
    ),
    (
        r#"{"shading": "smooth"}"#,
        (1, 13),
        "`shading`: unknown value `smooth`, expected \"flat\", \"gouraud\" or \"phong\"",
    ),
    (r#"{"output": 3}"#, (1, 12), "`output`: is a value of the wrong type: integer `3`, expected \"srgb\" or \"raw\""),
    (r#"{"output": {"srgb": null}}"#, (1, 12), "`output`: is a value of the wrong type: object, expected \"srgb\""),
    (
        r#"{"shading": {"flat": null}}"#,
        (1, 14),
        "`shading.flat`: unknown key `flat`, expected \"flat\", \"gouraud\" or ",
    ),
    (r#"{"shading": "Auto"}"#, (1, 13), "`shading`: unknown value `Auto`, expected \"flat\", \"gouraud\" or "),
    (
        r#"{"tolerance": 1}"#,
        (1, 15),
        "`tolerance`: is a value of the wrong type: integer `1`, expected an object such as",
    ),
    (r#"{"tolerance": {"step": 1}}"#, (1, 16), "`tolerance.step`: unknown key `step`, expected `steps`"),
    (r#"{"shading": {}}"#, (1, 13), "`shading`: is empty; expected \"flat\", "),
    (
        r#"{"shading": {"auto": [1]}}"#,
        (1, 22),
        "`shading.auto`: is a value of the wrong type: list, expected an object such as {\"tolerance\": 1.0}",
    ),
    (
        r#"{"shading": 1}"#,
        (1, 13),
        "`shading`: is a value of the wrong type: integer `1`, expected \"flat\", \"gouraud\" or ",
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
        "`objects[0].mesh`: is empty; expected an object with one of the keys path, uv_sphere, plane, box, ",
    ),
    (
        r#"{"objects": [{"mesh": "a.obj"}]}"#,
        (1, 23),
        "`objects[0].mesh`: is a value of the wrong type: string \"a.obj\", expected an object with one of the keys path, ",
    ),
    (
        r#"{"objects": [{"mesh": {"torus": {}}}]}"#,
        (1, 24),
        "`objects[0].mesh.torus`: unknown key `torus`, expected an object with one of the keys path, uv_sphere, plane, box, ",
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
    (
        r#"{"lights": [{"kind": "point", "position": [0, 0]}]}"#,
        (1, 43),
        "`lights[0].position`: has 2 numbers; expected 3, or 4 of a homogeneous light",
    ),
    (
        r#"{"objects": [{"mesh": {"box": {}}, "solid": {"colors": [[0, 0, 0]]}}]}"#,
        (1, 56),
        "`objects[0].solid.colors`: is a list of length 1, expected a list of length 2",
    ),
    // Keys that look like paths, and keys with escapes.
    (r#"{"camera": {"up.x[0]": 1}}"#, (1, 13), "`camera.up.x[0]`: unknown key `up.x[0]`, expected one of "),
    (r#"{"camera": {"u\"p" : 1}}"#, (1, 13), "`camera.u\"p`: unknown key `u\"p`, expected one of "),
    // A key that is not ASCII: columns are counted in characters.
    ("{\"objects\": [{\"name\": \"Käse\", \"größe\": 1}]}", (1, 31), "`objects[0].größe`: unknown key `größe`"),
];
