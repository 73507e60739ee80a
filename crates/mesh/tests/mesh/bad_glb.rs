//! Malformed glTF data and containers: refused without a panic and without taking memory on the word of the file.

use halfway_mesh::load;

use crate::common::{Folder, TRIANGLE_JSON, glb, triangle_data};

#[test]
fn faults_in_the_data_are_refused_by_vertex() {
    let nan = f32::NAN.to_le_bytes();
    let rows = [
        ("NaN position", 16, &nan[..], "meshes[0].primitives[0]: vertex 1: position [1.0, NaN, 0.0]"),
        ("NaN normal", 68, &nan[..], "meshes[0].primitives[0]: vertex 2: normal [0.0, 0.0, NaN]"),
        ("NaN texture coordinate", 72, &nan[..], "meshes[0].primitives[0]: vertex 0: uv [NaN, 1.0, 0.0]"),
        (
            "index out of range",
            98,
            &[3, 0][..],
            "meshes[0].primitives[0]: triangle 0: index 3 at corner 1; the mesh has 3 vertices, numbered from 0",
        ),
    ];
    for (name, at, bytes, expected) in rows {
        let mut data = triangle_data();
        data[at..at + bytes.len()].copy_from_slice(bytes);
        let folder = Folder::new();
        let path = folder.write("model.glb", glb(TRIANGLE_JSON, &data));
        let message = load(&path).unwrap_err().to_string();
        assert!(message.contains(expected), "{name}: {message}");
    }
}

#[test]
fn truncated_files_are_refused() {
    let folder = Folder::new();
    let whole = glb(TRIANGLE_JSON, &triangle_data());
    for length in 0..whole.len() {
        let message = load(&folder.write("model.glb", &whole[..length])).unwrap_err().to_string();
        let element = match length {
            0 => "the file is empty",
            _ => "GLB header",
        };
        assert!(message.contains(element), "{length}: {message}");
    }
    // A header that admits to the shorter length leaves the chunks, or the buffer, too short.
    for length in 12..whole.len() {
        let mut cut = whole[..length].to_vec();
        cut[8..12].copy_from_slice(&(length as u32).to_le_bytes());
        let message = load(&folder.write("model.glb", cut)).unwrap_err().to_string();
        assert!(message.contains("GLB") || message.contains("buffers[0]"), "{length}: {message}");
    }
    for length in 1..TRIANGLE_JSON.len() {
        let message = load(&folder.write("model.gltf", &TRIANGLE_JSON[..length])).unwrap_err().to_string();
        assert!(message.contains("JSON: EOF while parsing"), "{length}: {message}");
    }
}

#[test]
fn malformed_containers_are_refused() {
    let whole = glb(TRIANGLE_JSON, &triangle_data());
    let patched = |at: usize, bytes: &[u8]| {
        let mut file = whole.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    let rows = [
        ("magic", patched(0, b"glTG"), "GLB header: no magic; a file that begins with \"glTF\" is expected"),
        ("version", patched(4, &[1]), "GLB: unsupported version"),
        ("length 0", patched(8, &[0; 4]), "GLB header: length 0"),
        ("length 11", patched(8, &[11, 0, 0, 0]), "GLB header: length 11"),
        ("absurd length", patched(8, &[0xFF; 4]), "GLB header: length 4294967295; at most the file's"),
        ("absurd chunk", patched(12, &[0xFF; 4]), "GLB: JSON chunk length exceeds that of slice"),
        ("unknown chunk", patched(16, b"TEXT"), "GLB: unknown chunk type"),
        ("text", TRIANGLE_JSON.into(), "GLB header: no magic"),
        ("wrong UTF-8", patched(20 + 15, &[0xFF]), "JSON: "),
    ];
    for (name, file, expected) in rows {
        let folder = Folder::new();
        let message = load(&folder.write("model.glb", file)).unwrap_err().to_string();
        assert!(message.contains(expected), "{name}: {message}");
    }
}

#[test]
fn shared_data_cannot_be_asked_for_without_end() {
    // A thousand primitives of the same 20,000 triangles, and 1,000 nodes that show them all.
    let vertices = 60_000;
    let data = vec![0_u8; vertices * 12];
    let primitive = "{\"attributes\":{\"POSITION\":0}}";
    let node = "{\"mesh\":0}";
    let file = |primitives: usize, nodes: usize| {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{}],"meshes":[{{"primitives":[{}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{vertices},"min":[0,0,0],"max":[0,0,0]}}],
            "bufferViews":[{{"buffer":0,"byteLength":{}}}],"buffers":[{{"byteLength":{}}}]}}"#,
            vec![node; nodes].join(","),
            vec![primitive; primitives].join(","),
            data.len(),
            data.len()
        );
        let folder = Folder::new();
        load(&folder.write("model.glb", glb(&json, &data)))
    };
    assert_eq!(file(3, 100).unwrap().parts.len(), 300);
    let message = file(1000, 1).unwrap_err().to_string();
    assert!(message.contains("more than 64 times the 720000 bytes of data"), "{message}");
    let message = file(10, 30_000).unwrap_err().to_string();
    assert!(message.contains("nodes[26214]: more than 262144 primitives shown; fewer are expected"), "{message}");
}

#[test]
fn deep_trees_do_not_overflow_the_stack() {
    let depth = 100_000;
    let nodes: Vec<String> = (1..depth).map(|child| format!("{{\"children\":[{child}]}}")).collect();
    let json = TRIANGLE_JSON.replace(
        "\"nodes\":[{\"name\":\"node\",\"mesh\":0,\"translation\":[0,0,5]}]",
        &format!("\"nodes\":[{},{{\"mesh\":0}}]", nodes.join(",")),
    );
    let folder = Folder::new();
    let model = load(&folder.write("model.glb", glb(&json, &triangle_data()))).unwrap();
    assert_eq!(model.parts.len(), 1);
}
