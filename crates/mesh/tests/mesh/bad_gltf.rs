//! Malformed glTF documents: each is refused with a message that names the element, without a panic and without taking
//! memory on the word of the file.

use halfway_mesh::load;

use crate::common::{Folder, TRIANGLE_JSON, glb, triangle_data};

/// A row: what is wrong, the text replaced and its replacement, what the message must hold.
type Row = (&'static str, &'static str, &'static str, &'static str);

const ROWS: &[Row] = &[
    // Accessors and what they count.
    (
        "absurd count of positions",
        "\"count\":3,\"min\"",
        "\"count\":4000000000,\"min\"",
        "accessors[0]: byteOffset 0 and count 4000000000; at least one item, and no more than 36 bytes hold, is expected",
    ),
    (
        "count one too many",
        "\"count\":3,\"min\"",
        "\"count\":4,\"min\"",
        "accessors[0]: byteOffset 0 and count 4; at least one item, and no more than 36 bytes hold, is expected",
    ),
    ("count 0", "\"count\":3,\"min\"", "\"count\":0,\"min\"", "accessors[0]: byteOffset 0 and count 0"),
    ("absurd count of indices", "\"SCALAR\",\"count\":3", "\"SCALAR\",\"count\":18446744073709551615", "accessors[3]"),
    (
        "absurd offset of an accessor",
        "{\"bufferView\":0,\"componentType\"",
        "{\"bufferView\":0,\"byteOffset\":18446744073709551615,\"componentType\"",
        "accessors[0]: byteOffset 18446744073709551615 and count 3",
    ),
    (
        "no view and an absurd count",
        "{\"bufferView\":3,\"componentType\":5123,\"type\":\"SCALAR\",\"count\":3}",
        "{\"componentType\":5123,\"type\":\"SCALAR\",\"count\":1600,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":3,\"componentType\":5123},\"values\":{\"bufferView\":3}}}",
        "accessors[3]: count 1600 without a bufferView; a number from 1 to the 104 bytes of data is expected",
    ),
    (
        "neither view nor sparse, and an absurd count",
        "{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3",
        "{\"componentType\":5126,\"type\":\"VEC3\",\"count\":105",
        "accessors[0]: count 105 without a bufferView; a number from 1 to the 104 bytes of data is expected",
    ),
    ("missing view", "\"bufferView\":1", "\"bufferView\":9", "accessors[1].bufferView: index out of bounds"),
    (
        "positions in pairs",
        "\"type\":\"VEC3\",\"count\":3,\"min\"",
        "\"type\":\"VEC2\",\"count\":3,\"min\"",
        "accessors[0]: Vec2 of F32; Vec3 of one of [F32] is expected",
    ),
    (
        "positions as bytes",
        "\"bufferView\":0,\"componentType\":5126",
        "\"bufferView\":0,\"componentType\":5121",
        "accessors[0]: Vec3 of U8",
    ),
    (
        "indices as floats",
        "\"componentType\":5123",
        "\"componentType\":5126",
        "accessors[3]: Scalar of F32; Scalar of one of [U8, U16, U32] is expected",
    ),
    (
        "texture coordinates as plain integers",
        "\"bufferView\":2,\"componentType\":5126",
        "\"bufferView\":2,\"componentType\":5123",
        "accessors[2]: normalized false",
    ),
    (
        "unknown component type",
        "\"componentType\":5123",
        "\"componentType\":17",
        "accessors[3].componentType: invalid value",
    ),
    (
        "fewer normals than positions",
        "\"bufferView\":1,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3",
        "\"bufferView\":1,\"componentType\":5126,\"type\":\"VEC3\",\"count\":2",
        "meshes[0].primitives[0]: 2 normals for 3 vertices",
    ),
    (
        "fewer texture coordinates",
        "\"VEC2\",\"count\":3",
        "\"VEC2\",\"count\":1",
        "meshes[0].primitives[0]: 1 uvs for 3 vertices",
    ),
    (
        "two indices",
        "\"SCALAR\",\"count\":3",
        "\"SCALAR\",\"count\":2",
        "meshes[0].primitives[0]: 2 indices; three a triangle are expected",
    ),
    // Views and buffers.
    (
        "absurd length of a view",
        "\"byteOffset\":0,\"byteLength\":36",
        "\"byteOffset\":0,\"byteLength\":4000000000",
        "bufferViews[0]: byteOffset 0 and byteLength 4000000000; at most the buffer's 104 bytes are expected",
    ),
    (
        "absurd offset of a view",
        "\"byteOffset\":36",
        "\"byteOffset\":18446744073709551615",
        "bufferViews[1]: byteOffset 18446744073709551615",
    ),
    (
        "stride too small",
        "\"byteOffset\":0,\"byteLength\":36",
        "\"byteOffset\":0,\"byteLength\":36,\"byteStride\":4",
        "bufferViews[0].byteStride: 4; at least the 12 bytes of an item of accessors[0] are expected",
    ),
    (
        "stride too large",
        "\"byteOffset\":0,\"byteLength\":36",
        "\"byteOffset\":0,\"byteLength\":36,\"byteStride\":18446744073709551615",
        "bufferViews[0].byteStride: invalid value",
    ),
    (
        "missing buffer",
        "{\"buffer\":0,\"byteOffset\":0",
        "{\"buffer\":1,\"byteOffset\":0",
        "bufferViews[0].buffer: index out of bounds",
    ),
    (
        "absurd length of a buffer",
        "{\"byteLength\":104}",
        "{\"byteLength\":4000000000}",
        "buffers[0]: byteLength 4000000000 for 104 bytes of data; at most as many as there are is expected",
    ),
    (
        "second buffer without data",
        "{\"byteLength\":104}",
        "{\"byteLength\":104},{\"byteLength\":104}",
        "buffers[1]: neither; a uri, or a binary chunk for the first buffer, is expected",
    ),
    // Sources of data.
    ("file missing", "{\"byteLength\":104}", "{\"byteLength\":104,\"uri\":\"gone.bin\"}", "gone.bin: cannot be read: "),
    (
        "path escape",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"../data.bin\"}",
        "buffers[0]: uri \"../data.bin\"; a file in the folder of the model, or in one inside it, is expected",
    ),
    (
        "encoded path escape",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"%2e%2e/data.bin\"}",
        "buffers[0]: uri \"%2e%2e/data.bin\"",
    ),
    (
        "escape from a folder inside",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"a/../../data.bin\"}",
        "buffers[0]: uri \"a/../../data.bin\"",
    ),
    (
        "absolute path",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"/etc/passwd\"}",
        "buffers[0]: uri \"/etc/passwd\"",
    ),
    (
        "foreign path",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"C:\\\\data.bin\"}",
        "buffers[0]: uri \"C:\\\\data.bin\"",
    ),
    (
        "network",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"https://example.org/data.bin\"}",
        "buffers[0]: uri \"https://example.org/data.bin\"",
    ),
    ("a folder", "{\"byteLength\":104}", "{\"byteLength\":104,\"uri\":\"folder\"}", "folder: not a regular file"),
    (
        "an empty file",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"empty.bin\"}",
        "empty.bin: the file is empty",
    ),
    (
        "a short file",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"short.bin\"}",
        "buffers[0]: byteLength 104 for 12 bytes of data",
    ),
    (
        "data that is none",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"data:text/plain\"}",
        "buffers[0]: a data uri without a comma; one before the data is expected",
    ),
    (
        "short text",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"data:text/plain,a%20c\"}",
        "buffers[0]: byteLength 104 for 3 bytes of data",
    ),
    (
        "broken base64",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"data:;base64,*\"}",
        "buffers[0]: Invalid symbol 42, offset 0.; base64 is expected",
    ),
    (
        "short base64",
        "{\"byteLength\":104}",
        "{\"byteLength\":104,\"uri\":\"data:;base64,AAAA\"}",
        "buffers[0]: byteLength 104 for 3 bytes of data",
    ),
    // Sparse values.
    (
        "absurd sparse count",
        "\"max\":[1,1,0]}",
        "\"max\":[1,1,0],\"sparse\":{\"count\":4000000000,\"indices\":{\"bufferView\":3,\"componentType\":5123},\"values\":{\"bufferView\":1}}}",
        "accessors[0].sparse: count 4000000000; at most the accessor's count 3 is expected",
    ),
    (
        "sparse count 0",
        "\"max\":[1,1,0]}",
        "\"max\":[1,1,0],\"sparse\":{\"count\":0,\"indices\":{\"bufferView\":3,\"componentType\":5123},\"values\":{\"bufferView\":1}}}",
        "accessors[0].sparse.indices: byteOffset 0 and count 0",
    ),
    (
        "sparse values too few",
        "\"max\":[1,1,0]}",
        "\"max\":[1,1,0],\"sparse\":{\"count\":3,\"indices\":{\"bufferView\":3,\"componentType\":5123},\"values\":{\"bufferView\":2}}}",
        "accessors[0].sparse.values: byteOffset 0 and count 3",
    ),
    (
        "sparse indices out of view",
        "\"max\":[1,1,0]}",
        "\"max\":[1,1,0],\"sparse\":{\"count\":3,\"indices\":{\"bufferView\":3,\"byteOffset\":4,\"componentType\":5123},\"values\":{\"bufferView\":1}}}",
        "accessors[0].sparse.indices: byteOffset 4 and count 3",
    ),
    (
        "sparse index out of range",
        "\"max\":[1,1,0]}",
        "\"max\":[1,1,0],\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":1,\"byteOffset\":8,\"componentType\":5125},\"values\":{\"bufferView\":1}}}",
        "accessors[0].sparse.indices: index 1073741824 as number 0; a growing sequence below 3 is expected",
    ),
    (
        "sparse indices that do not grow",
        "\"max\":[1,1,0]}",
        "\"max\":[1,1,0],\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":1}}}",
        "accessors[0].sparse.indices: index 0 as number 1",
    ),
    // Primitives, nodes, materials, lights.
    (
        "POSITION out of range",
        "\"POSITION\":0",
        "\"POSITION\":99",
        "meshes[0].primitives[0].attributes.POSITION: accessor 99; one of the 4 accessors, from 0, is expected",
    ),
    ("NORMAL out of range", "\"NORMAL\":1", "\"NORMAL\":99", "index out of bounds"),
    (
        "nothing but a primitive without POSITION",
        "\"POSITION\":0,",
        "",
        "1 primitives have no positions and are skipped",
    ),
    ("indices out of range", "\"indices\":3", "\"indices\":4", "meshes[0].primitives[0].indices: index out of bounds"),
    (
        "material out of range",
        "\"material\":0",
        "\"material\":1",
        "meshes[0].primitives[0].material: index out of bounds",
    ),
    ("unknown mode", "\"material\":0", "\"material\":0,\"mode\":7", "meshes[0].primitives[0].mode: invalid value"),
    ("mesh out of range", "\"mesh\":0", "\"mesh\":1", "nodes[0].mesh: index out of bounds"),
    ("child out of range", "\"mesh\":0", "\"mesh\":0,\"children\":[1]", "nodes[0].children[0]: index out of bounds"),
    (
        "node its own child",
        "\"mesh\":0",
        "\"mesh\":0,\"children\":[0]",
        "nodes[0]: reached twice; a tree, in which every node has one parent at most, is expected",
    ),
    ("node twice in the scene", "{\"nodes\":[0]}", "{\"nodes\":[0,0]}", "nodes[0]: reached twice"),
    ("scene out of range", "\"scene\":0", "\"scene\":1", "scene: index out of bounds"),
    (
        "infinite translation",
        "[0,0,5]",
        "[0,0,1e300]",
        "nodes[0].translation: [0.0, 0.0, inf]; finite numbers are expected",
    ),
    (
        "no rotation",
        "\"translation\":[0,0,5]",
        "\"rotation\":[0,0,0,0]",
        "nodes[0].rotation: [0.0, 0.0, 0.0, 0.0]; a unit quaternion is expected",
    ),
    (
        "projective matrix",
        "\"translation\":[0,0,5]",
        "\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]",
        "nodes[0].matrix: last row [1.0, 0.0, 0.0, 1.0]; 0, 0, 0, 1 is expected",
    ),
    (
        "infinite colour",
        "[1,0,0,1]",
        "[1e300,0,0,1]",
        "materials[0].baseColorFactor: [inf, 0.0, 0.0, 1.0]; finite numbers are expected",
    ),
    ("unknown alpha mode", "{\"name\":\"red\",", "{\"alphaMode\":\"SOME\",", "materials[0].alphaMode: invalid value"),
    (
        "light out of range",
        "\"mesh\":0,",
        "\"mesh\":0,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}},",
        "index out of bounds",
    ),
    (
        "spot without its cone",
        "{\"version\":\"2.0\"}",
        "{\"version\":\"2.0\"},\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\"}]}}",
        "spot: missing data",
    ),
    // The document.
    (
        "required extension",
        "{\"version\":\"2.0\"}",
        "{\"version\":\"2.0\"},\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]",
        ": the extension KHR_draco_mesh_compression is required, which is not supported; `gltf-transform copy` writes the file without it",
    ),
    (
        "required extension of someone's own",
        "{\"version\":\"2.0\"}",
        "{\"version\":\"2.0\"},\"extensionsRequired\":[\"ACME_shapes\"]",
        ": the extension ACME_shapes is required, which is not supported",
    ),
    ("old version", "\"2.0\"", "\"1.0\"", "asset.version: version \"1.0\"; version \"2.0\" is expected"),
    ("no asset", "\"asset\":{\"version\":\"2.0\"},", "", "JSON: missing field `asset`"),
    (
        "a word for a number",
        "\"count\":3,\"min\"",
        "\"count\":\"three\",\"min\"",
        "JSON: invalid type: string \"three\", expected u64 at line 9 column",
    ),
    (
        "a negative count",
        "\"count\":3,\"min\"",
        "\"count\":-3,\"min\"",
        "JSON: invalid value: integer `-3`, expected u64 at line 9 column",
    ),
    (
        "no meshes shown",
        "{\"nodes\":[0]}",
        "{\"nodes\":[]}",
        ": no triangles, lines or points; at least one is expected",
    ),
];

#[test]
fn every_fault_is_refused_by_element() {
    let folder = Folder::new();
    folder.write("folder/x", "x");
    folder.write("empty.bin", "");
    folder.write("short.bin", [0; 12]);
    for &(name, from, to, expected) in ROWS {
        assert_eq!(TRIANGLE_JSON.matches(from).count(), 1, "{name}");
        let path = folder.write("model.glb", glb(&TRIANGLE_JSON.replace(from, to), &triangle_data()));
        let message = match load(&path) {
            Ok(_) => panic!("{name}: loaded"),
            Err(error) => error.to_string(),
        };
        assert!(message.starts_with(&folder.path().display().to_string()), "{name}: {message}");
        assert!(message.contains(expected), "{name}: {message}\nexpected: {expected}");
    }
}
