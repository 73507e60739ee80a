//! Shared by the tests of files.
#![allow(dead_code, reason = "each test program uses a part of it")]

pub(crate) mod gltf_file;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use halfway_mesh::{Animations, Model, Pose, PosedPart};

/// A folder of the test's own, removed at the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("halfway_mesh-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file and returns its path.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, content).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A zip archive of these parts, not compressed (APPNOTE 6.3.3).
pub(crate) fn zip(parts: &[(&str, &[u8])]) -> Vec<u8> {
    let packed: Vec<_> = parts.iter().map(|(name, bytes)| (*name, *bytes, 0, bytes.len())).collect();
    zip_of(&packed, parts)
}

/// A zip archive of parts as they are packed, each with its method, beside those they unpack to.
pub(crate) fn zip_of(packed: &[(&str, &[u8], u16, usize)], parts: &[(&str, &[u8])]) -> Vec<u8> {
    let (mut file, mut directory) = (Vec::new(), Vec::new());
    for ((name, bytes, method, length), (_, whole)) in packed.iter().zip(parts) {
        let start = file.len() as u32;
        let mut common = vec![20, 0, 0, 0];
        common.extend(method.to_le_bytes());
        // The time of day, and the first of January 1980.
        common.extend([0, 0, 0x21, 0]);
        common.extend([crc(whole), bytes.len() as u32, *length as u32].map(u32::to_le_bytes).as_flattened());
        common.extend((name.len() as u32).to_le_bytes());
        file.extend(b"PK\x03\x04".iter().chain(&common).copied().chain(name.bytes()).chain(bytes.iter().copied()));
        directory.extend(b"PK\x01\x02\x14\0".iter().chain(&common));
        // Of comments, disks and attributes there are none.
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes().iter().copied().chain(name.bytes()));
    }
    let (start, count) = (file.len() as u32, (parts.len() as u16).to_le_bytes());
    let length = directory.len() as u32;
    file.extend(directory);
    file.extend(b"PK\x05\x06\0\0\0\0".iter().chain(&count).chain(&count));
    file.extend([length.to_le_bytes(), start.to_le_bytes()].as_flattened());
    file.extend([0, 0]);
    file
}

/// CRC-32 (ISO 3309), bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 })
    })
}

/// Checks that a model is valid.
pub(crate) fn check_model(model: &Model) {
    assert!(!model.parts.is_empty() || !model.lines.is_empty());
    for part in &model.lines {
        let lines = &part.lines;
        assert!(part.world_from_part.is_finite() && part.world_from_part.row(3) == [0.0, 0.0, 0.0, 1.0].into());
        assert!(part.material.is_none_or(|material| material < model.materials.len()));
        assert!(!lines.segments().is_empty() || !lines.points().is_empty());
        let vertices = lines.positions().len();
        let mut ends = lines.segments().iter().flatten().chain(lines.points());
        assert!(ends.all(|&end| (end as usize) < vertices));
        assert!(lines.positions().iter().all(|p| p.is_finite()));
        assert!(lines.normals().is_none_or(|all| all.len() == vertices && all.iter().all(|n| n.is_finite())));
        assert!(lines.colors().is_none_or(|all| all.len() == vertices && all.iter().all(|c| c.is_finite())));
    }
    for part in &model.parts {
        let mesh = &part.mesh;
        assert!(part.world_from_part.is_finite() && part.world_from_part.row(3) == [0.0, 0.0, 0.0, 1.0].into());
        assert!(part.material.is_none_or(|material| material < model.materials.len()));
        assert!(mesh.triangle_count() > 0);
        assert!(mesh.positions().iter().all(|p| p.is_finite()));
        assert!(mesh.normals().iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
        assert!(mesh.indices().iter().all(|&i| (i as usize) < mesh.positions().len()));
        let vertices = mesh.positions().len();
        assert!(mesh.uvs().is_none_or(|uvs| uvs.len() == vertices && uvs.iter().all(|uv| uv.is_finite())));
        assert!(mesh.colors().is_none_or(|colors| colors.len() == vertices && colors.iter().all(|c| c.is_finite())));
        assert!(mesh.tangents().is_none_or(|all| all.len() == vertices && all.iter().all(|t| t.is_finite())));
    }
    assert!(model.lights.iter().all(|light| light.world_from_light.is_finite()));
    assert!(model.cameras.iter().all(|camera| camera.world_from_camera.is_finite()));
    model.animations.iter().for_each(|animations| check_poses(model, animations));
    assert!(model.bounds().is_some_and(|bounds| bounds.min.is_finite() && bounds.max.is_finite()));
}

/// Checks that a model stays valid in its first animations.
fn check_poses(model: &Model, animations: &Animations) {
    for (clip, times) in animations.clips().iter().enumerate().take(2) {
        for time in [0.0, 0.4 * times.duration, times.duration, 1e9] {
            let Pose { parts, lines, lights, cameras } = animations.pose(clip, time);
            for PosedPart { part, world_from_part, mesh } in parts {
                assert!(world_from_part.is_finite());
                let still = &model.parts[part].mesh;
                assert!(mesh.is_none_or(|mesh| {
                    let are_unit = mesh.normals().iter().all(|n| (n.length() - 1.0).abs() < 1e-6);
                    are_unit && mesh.shares_triangles(still) && mesh.positions().iter().all(|p| p.is_finite())
                }));
            }
            assert!(lines.iter().all(|(index, place)| *index < model.lines.len() && place.is_finite()));
            assert!(lights.iter().all(|(index, place)| *index < model.lights.len() && place.is_finite()));
            assert!(cameras.iter().all(|(index, place)| *index < model.cameras.len() && place.is_finite()));
        }
    }
}

/// A binary glTF file.
pub(crate) fn glb(json: &str, data: &[u8]) -> Vec<u8> {
    let header = gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 };
    let glb = gltf::Glb { header, json: json.as_bytes().into(), bin: Some(data.into()) };
    glb.to_vec().unwrap()
}

/// A triangle with normals, texture coordinates, indices, a material and a node.
pub(crate) const TRIANGLE_JSON: &str = r#"{
"asset":{"version":"2.0"},
"scene":0,
"scenes":[{"nodes":[0]}],
"nodes":[{"name":"node","mesh":0,"translation":[0,0,5]}],
"meshes":[{"name":"mesh","primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0}]}],
"materials":[{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"metallicFactor":0.25,"roughnessFactor":0.5}}],
"accessors":[
{"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"type":"VEC3","count":3},
{"bufferView":2,"componentType":5126,"type":"VEC2","count":3},
{"bufferView":3,"componentType":5123,"type":"SCALAR","count":3}],
"bufferViews":[
{"buffer":0,"byteOffset":0,"byteLength":36},
{"buffer":0,"byteOffset":36,"byteLength":36},
{"buffer":0,"byteOffset":72,"byteLength":24},
{"buffer":0,"byteOffset":96,"byteLength":6}],
"buffers":[{"byteLength":104}]
}"#;

/// The data of [`TRIANGLE_JSON`].
pub(crate) fn triangle_data() -> Vec<u8> {
    let floats: [f32; 24] = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, // positions
        0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 2.0, // normals, not of unit length
        0.0, 1.0, 1.0, 1.0, 0.0, 0.0, // texture coordinates
    ];
    let mut data: Vec<u8> = floats.iter().copied().flat_map(f32::to_le_bytes).collect();
    data.extend([0_u16, 1, 2, 0].into_iter().flat_map(u16::to_le_bytes));
    data
}
