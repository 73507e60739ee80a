//! OBJ files read by this crate and by `tobj` hold the same triangles.
//!
//! `tobj` 4.0 does not read all of them (docs/decisions/0012-own-readers.md), so a row says what it makes of its file.

use std::path::Path;

use glam::{Vec2, Vec3};
use halfway_mesh::{Model, load};

use crate::common::Folder;

/// Of each corner of each triangle position, texture coordinates and normal, in the order of the file.
type TriangleCorners = Vec<(Vec3, Option<Vec2>, Option<Vec3>)>;

const OPTIONS: tobj::LoadOptions =
    tobj::LoadOptions { single_index: false, triangulate: false, ignore_points: true, ignore_lines: true };

fn by_tobj(path: &Path) -> Result<TriangleCorners, tobj::LoadError> {
    let (models, _) = tobj::load_obj(path, &OPTIONS)?;
    let mut corners = Vec::new();
    for tobj::Model { mesh, .. } in &models {
        let mut first = 0;
        let faces = mesh.indices.len() / 3;
        let sides: Vec<usize> = if mesh.face_arities.is_empty() {
            vec![3; faces]
        } else {
            mesh.face_arities.iter().map(|&n| n as usize).collect()
        };
        for count in sides {
            // The polygons of these files are convex, which both cut as fans.
            for i in 1..count - 1 {
                for at in [0, i, i + 1].map(|corner| first + corner) {
                    let three = |all: &[f32], i: u32| Vec3::from_slice(&all[3 * i as usize..]);
                    let uv =
                        mesh.texcoord_indices.get(at).map(|&i| Vec2::from_slice(&mesh.texcoords[2 * i as usize..]));
                    let n = mesh.normal_indices.get(at).map(|&i| three(&mesh.normals, i));
                    corners.push((three(&mesh.positions, mesh.indices[at]), uv, n));
                }
            }
            first += count;
        }
    }
    Ok(corners)
}

fn by_halfway(model: &Model) -> TriangleCorners {
    let corners = |part: &halfway_mesh::Part| {
        let mesh = part.mesh.clone();
        let corner = move |&i: &u32| {
            let i = i as usize;
            (mesh.positions()[i], mesh.uvs().map(|uvs| uvs[i]), Some(mesh.normals()[i]))
        };
        part.mesh.indices().iter().map(corner).collect::<Vec<_>>()
    };
    model.parts.iter().flat_map(corners).collect()
}

/// The same corners: positions to the bit, texture coordinates to a rounding of 1 − v, normals that the file gives as
/// directions.
fn check(path: &Path) {
    let name = path.display();
    let (ours, theirs) = (by_halfway(&load(path).unwrap()), by_tobj(path).unwrap());
    assert_eq!(ours.len(), theirs.len(), "{name}");
    for (i, ((p, uv, n), (q, vt, m))) in ours.into_iter().zip(theirs).enumerate() {
        assert_eq!(p, q, "{name}, corner {i}");
        if let Some(vt) = vt {
            let uv = uv.unwrap();
            assert_eq!(uv.x.to_bits(), vt.x.to_bits(), "{name}, corner {i}");
            assert!((uv.y - (1.0 - vt.y)).abs() <= f32::EPSILON * vt.y.abs().max(1.0), "{name}, corner {i}");
        }
        if let Some(m) = m {
            assert!(n.unwrap().distance(m.normalize()) < 1e-6, "{name}, corner {i}");
        }
    }
}

#[test]
fn the_same_corners_as_tobj_reads() {
    let asset = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/teapot.obj");
    check(&asset);
    let folder = Folder::new();
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let [uvs, normals] = ["vt 0 0\nvt 1 0.25\n", "vn 0 0 2\n"];
    // A file has only what its faces use: `tobj` makes up the rest.
    for (i, (header, faces)) in [
        ("", "f 1 2 3\n"),
        ("", "f 1 2 3 4\nf 1 3 4\n"),
        ("", "f 1// 2// 3//\n"),
        ("", "f -4 -3 -2\n"),
        ("", "o a\nf 1 2 3\ng b\nusemtl c\nf 1 3 4\ns 1\nf 2 3 4\nl 1 2\np 3\n"),
        (uvs, "f 1/1 2/2 3/1\n"),
        (normals, "f 1//1 2//1 3//1\n"),
        (&[uvs, normals].concat(), "f 1/1/1 2/2/1 3/1/1 4/2/1\nf -4/-2/-1 -3/-1/-1 -2/-2/-1\n"),
    ]
    .into_iter()
    .enumerate()
    {
        check(&folder.write(&format!("{i}.obj"), format!("{square}{header}{faces}")));
    }
}

#[test]
fn files_that_tobj_refuses_are_read() {
    let folder = Folder::new();
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let own = |text: &[u8]| {
        let path = folder.write("model.obj", text);
        (load(&path).unwrap().triangle_count(), by_tobj(&path).map(|corners| corners.len() / 3))
    };
    // Refused as a whole.
    for (name, text) in [
        ("faces before their vertices", format!("o a\nf 1 2 3\no b\n{corners}f 1 2 3\n").into_bytes()),
        ("a texture coordinate of one number", format!("{corners}vt 0.5\nf 1/1 2/1 3/1\n").into_bytes()),
        ("continued lines", format!("{corners}f 1 2 \\\n3\n").into_bytes()),
        ("a comment behind a face", format!("{corners}f 1 2 3 # one\n").into_bytes()),
        ("a Latin-1 name", [corners.as_bytes(), b"g caf\xE9\nf 1 2 3\n"].concat()),
        ("colors at one vertex", b"v 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec()),
        ("a material without a name", format!("{corners}usemtl\nf 1 2 3\n").into_bytes()),
    ] {
        let (count, theirs) = own(&text);
        assert!(count > 0 && theirs.is_err(), "{name}: {theirs:?}");
    }
    // Read otherwise, and nothing says so: a normal that a corner lacks is that of the corner before.
    let path = folder.write("model.obj", format!("{corners}vn 1 0 0\nf 1//1 2 3\n"));
    assert_eq!(by_tobj(&path).unwrap()[2].2, Some(Vec3::X));
    assert_eq!(by_halfway(&load(&path).unwrap())[2].2, Some(Vec3::Z));
    // A fourth number of `v` is a weight of curves, which divides nothing.
    let path = folder.write("model.obj", "v 0 0 0\nv 4 0 0 2\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(by_tobj(&path).unwrap()[1].0, Vec3::X * 2.0);
    assert_eq!(by_halfway(&load(&path).unwrap())[1].0, Vec3::X * 4.0);
}
