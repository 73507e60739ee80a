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
    (r#"{"ambient": [1e400, 0, 0]}"#, (1, 14), "`ambient[0]`: is too large; expected a number of at most 3.4e38"),
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
        "`shading`: unknown value `smooth`, expected \"flat\", \"gouraud\", \"phong\", \"unlit\" or {\"terms\": ",
    ),
    (r#"{"output": 3}"#, (1, 12), "`output`: is a value of the wrong type: integer `3`, expected \"srgb\" or \"raw\""),
    (r#"{"output": {"srgb": null}}"#, (1, 12), "`output`: is a value of the wrong type: object, expected \"srgb\""),
    (
        r#"{"shading": {"flat": null}}"#,
        (1, 14),
        "`shading.flat`: unknown key `flat`, expected \"flat\", \"gouraud\", \"phong\", \"unlit\" or ",
    ),
    (
        r#"{"shading": "Auto"}"#,
        (1, 13),
        "`shading`: unknown value `Auto`, expected \"flat\", \"gouraud\", \"phong\", \"unlit\" or ",
    ),
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
        "`shading`: is a value of the wrong type: integer `1`, expected \"flat\", \"gouraud\", \"phong\", \"unlit\" or ",
    ),
    (
        r#"{"shading": {"auto": {}, "phong": 1}}"#,
        (1, 26),
        "`shading.phong`: unknown key `phong`, expected one key only: ",
    ),
    (
        r#"{"shading": {"terms": {"diffuse": "pixel"}}}"#,
        (1, 35),
        "`shading.terms.diffuse`: unknown value `pixel`, expected \"fragment\", \"vertex\", \"triangle\" or \"never\"",
    ),
    (
        r#"{"shading": {"terms": {"diffuse": "triangle", "specular": "vertex"}}}"#,
        (1, 23),
        "`shading.terms`: the term is evaluated once a triangle and the other at Vertex",
    ),
    (
        r#"{"lights": "sun"}"#,
        (1, 12),
        "`lights`: unknown value `sun`, expected a list or one of \"studio\", \"three_point\"",
    ),
    (r#"{"shading": {"auto": {"tol": 1}}}"#, (1, 23), "`shading.auto.tol`: unknown key `tol`, expected `tolerance`"),
    (
        r#"{"camera": {"fov": 45}}"#,
        (1, 13),
        "`camera.fov`: unknown key `fov`, expected one of `name`, `position`, `target`, `up`, ",
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
    (
        r#"{"lights": {}}"#,
        (1, 12),
        "`lights`: is a value of the wrong type: object, expected a list or one of \"studio\"",
    ),
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
        "{\"objects\": [{\"mesh\": {\"box\": {}}, \"transform\": {\n\"scale\": [1, 1, 1],\n\"matrix\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}}]}",
        (2, 1),
        "`objects[0].transform.scale`: cannot stand beside `matrix`, which says it all",
    ),
    // Keys that look like paths, and keys with escapes.
    (r#"{"camera": {"up.x[0]": 1}}"#, (1, 13), "`camera.up.x[0]`: unknown key `up.x[0]`, expected one of "),
    (r#"{"camera": {"u\"p" : 1}}"#, (1, 13), "`camera.u\"p`: unknown key `u\"p`, expected one of "),
    // A key that is not ASCII: columns are counted in characters.
];
