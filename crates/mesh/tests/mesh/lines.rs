//! Lines and points: made, read and written.

use glam::{Mat4, Vec3, Vec4};
use halfway_mesh::{Format, LinePart, Lines, MeshError, Model, load, load_bytes, write, write_quantised};

use crate::common::{Folder, glb};

const CORNERS: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];

#[test]
fn lines_name_vertices_that_are_there() {
    let made = |segments: &[[u32; 2]], points: &[u32]| Lines::new(CORNERS.to_vec(), segments.to_vec(), points.to_vec());
    assert_eq!(made(&[], &[]), Err(MeshError::NoLines));
    let outside = |element, number, index| Err(MeshError::NoSuchVertex { element, number, index, vertices: 4 });
    assert_eq!(made(&[[0, 1], [2, 4]], &[]), outside("line", 1, 4));
    assert_eq!(made(&[], &[3, 7]), outside("point", 1, 7));
    assert!(matches!(Lines::cloud(vec![Vec3::NAN]), Err(MeshError::NotFinite { vertex: 0, .. })));
    assert_eq!(Lines::path(vec![Vec3::ZERO]), Err(MeshError::NoLines));
    assert_eq!(Lines::path(CORNERS.to_vec()).unwrap().segments(), [[0, 1], [1, 2], [2, 3]]);
    // Vertices that nothing uses do not count.
    let lines = made(&[[0, 1]], &[2]).unwrap();
    assert_eq!((lines.bounds().min, lines.bounds().max), (Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)));
    let lines = lines.with_normals(vec![Vec3::X * 1e-30, Vec3::ZERO, Vec3::Y, -Vec3::Z * 7.0]).unwrap();
    assert_eq!(lines.normals(), Some(&[Vec3::X, Vec3::ZERO, Vec3::Y, Vec3::NEG_Z][..]));
    assert!(matches!(lines.with_colors(vec![Vec4::ONE]), Err(MeshError::CountMismatch { found: 1, expected: 4, .. })));
}

#[test]
fn obj_has_lines_and_points_by_name_and_material() {
    let text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\no wire\nl 1 2/1 3 # there\nf 1 2 3\np -1 1\no blob\np 4\n";
    let model = load_bytes(Format::Obj, text.as_bytes()).unwrap();
    assert_eq!(model.warnings, ["model.obj:7: texture coordinates of lines are skipped"]);
    assert_eq!((model.parts.len(), model.line_count(), model.point_count()), (1, 2, 3));
    let [wire, blob] = &model.lines[..] else { panic!("{} groups of lines", model.lines.len()) };
    assert_eq!((wire.name.as_str(), blob.name.as_str()), ("wire", "blob"));
    assert_eq!((wire.lines.segments(), wire.lines.points()), (&[[0, 1], [1, 2]][..], &[3, 0][..]));
    assert_eq!(wire.lines.positions(), CORNERS.map(|p| p));
    assert_eq!(wire.lines.colors().map(|colors| colors[0]), Some(Vec4::new(1.0, 0.0, 0.0, 1.0)));
    assert_eq!(blob.lines.positions(), [Vec3::Z]);
    assert_eq!(model.bounds().map(|bounds| bounds.max), Some(Vec3::ONE));
    // Vertices may be defined later.
    let later = load_bytes(Format::Obj, b"l 1 2\nv 0 0 0\nv 1 0 0\n").unwrap();
    assert_eq!(later.line_count(), 1);
}

#[test]
fn ply_has_points_or_edges() {
    let header = |elements: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n{elements}end_header\n0 0 0 0 0 2\n1 0 0 0 0 1\n0 1 0 0 0 1\n"
        )
    };
    let cloud = load_bytes(Format::Ply, header("element face 0\nproperty list uchar int vertex_indices\n").as_bytes());
    let cloud = cloud.unwrap();
    assert!(cloud.parts.is_empty() && cloud.warnings.is_empty(), "{:?}", cloud.warnings);
    assert_eq!((cloud.point_count(), cloud.lines[0].name.as_str()), (3, "model"));
    assert_eq!(cloud.lines[0].lines.normals(), Some(&[Vec3::Z; 3][..]));

    let edges = "element edge 2\nproperty int vertex1\nproperty int vertex2\nproperty uchar weight\n";
    let edged = load_bytes(Format::Ply, format!("{}0 1 9\n1 2 9\n", header(edges)).as_bytes()).unwrap();
    assert_eq!(edged.lines[0].lines.segments(), [[0, 1], [1, 2]]);
    assert_eq!((edged.point_count(), &edged.warnings[..]), (0, &["of `edge` is skipped: weight".to_owned()][..]));
    let error = load_bytes(Format::Ply, format!("{}0 1 9\n1 3 9\n", header(edges)).as_bytes()).unwrap_err().to_string();
    assert!(error.contains("edge 1, vertex2: vertex 3; one of 3 vertices that stand before it"), "{error}");
}

/// A mode with its lines and points.
type ModeRow = (u32, &'static [[u32; 2]], &'static [u32]);

#[test]
fn gltf_has_all_modes() {
    let positions: Vec<u8> = CORNERS.iter().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes).collect();
    let json = |mode: u32, primitive: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0,"translation":[5,0,0]}},{{"mesh":0}}],
            "meshes":[{{"name":"m","primitives":[{{"mode":{mode},"attributes":{{"POSITION":0{primitive}}}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4,"min":[0,0,0],"max":[1,1,1]}}],
            "bufferViews":[{{"buffer":0,"byteLength":48}}],"buffers":[{{"byteLength":48}}]}}"#
        )
    };
    let rows: [ModeRow; 4] = [
        (0, &[], &[0, 1, 2, 3]),
        (1, &[[0, 1], [2, 3]], &[]),
        (2, &[[0, 1], [1, 2], [2, 3], [3, 0]], &[]),
        (3, &[[0, 1], [1, 2], [2, 3]], &[]),
    ];
    for (mode, segments, points) in rows {
        let model = load_bytes(Format::Glb, &glb(&json(mode, ",\"NORMAL\":0"), &positions)).unwrap();
        assert!(model.warnings.is_empty() && model.parts.is_empty(), "{:?}", model.warnings);
        let [near, far] = &model.lines[..] else { panic!("{} groups of lines", model.lines.len()) };
        assert_eq!((near.lines.segments(), near.lines.points()), (segments, points), "{mode}");
        assert_eq!(far.lines.positions().as_ptr(), near.lines.positions().as_ptr(), "both share the data");
        assert_eq!((near.world_from_part.w_axis.x, near.name.as_str()), (5.0, "m"));
        assert_eq!(near.lines.normals().map(|normals| normals[1]), Some(Vec3::X));
    }
}

#[test]
fn written_ones_come_back() {
    let folder = Folder::new();
    let lines = Lines::new(CORNERS.to_vec(), vec![[0, 1], [3, 2]], vec![1, 3]).unwrap();
    let colors = CORNERS.iter().map(|p| p.extend(1.0)).collect();
    let lines = lines.with_colors(colors).unwrap();
    let place = Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0));
    let part = LinePart { name: "wire".into(), lines, material: None, world_from_part: place };
    let model = Model { lines: vec![part.clone()], ..Model::default() };
    // GLB writes a primitive of each kind.
    for quantised in [false, true] {
        let path = folder.path().join("lines.glb");
        let lost = if quantised { write_quantised(&path, &model).unwrap().1 } else { write(&path, &model).unwrap() };
        let back = load(&path).unwrap();
        assert!(lost.is_empty() && back.warnings.is_empty(), "{lost:?}");
        let [segments, points] = &back.lines[..] else { panic!("{} groups of lines", back.lines.len()) };
        assert_eq!((segments.lines.segments().len(), points.lines.points().len()), (2, 2));
        assert_eq!((segments.world_from_part, &segments.name[..]), (place, "wire"));
        assert_eq!(back.bounds(), model.bounds());
        assert_eq!(points.lines.colors().map(|colors| colors[1]), Some(Vec4::new(0.0, 0.0, 1.0, 1.0)));
    }
    let path = folder.path().join("lines.obj");
    let lost = write(&path, &model).unwrap();
    assert_eq!(lost, ["1 places of parts; their vertices are moved instead"]);
    let back = load(&path).unwrap();
    assert_eq!((back.line_count(), back.point_count(), back.bounds()), (2, 2, model.bounds()));
    assert_eq!(back.lines[0].lines.colors().map(|colors| colors[1]), Some(Vec4::new(1.0, 0.0, 0.0, 1.0)));
    let lost = write(&folder.path().join("lines.smf"), &model).unwrap();
    assert!(lost.contains(&"2 lines".to_owned()) && lost.contains(&"2 points".to_owned()), "{lost:?}");
}
