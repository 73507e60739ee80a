//! The same bits on every machine.

use bevy_math::Vec3;
use bevy_transform::components::GlobalTransform;
use halfway_lighting::{Blend, Cone, Faces, Material, PointLight, Reflectance, Shading, SpotLight};
use halfway_mesh::{Mesh, UvSphere};
use halfway_reference::{Image, Mode};

use crate::scene::Stage;

/// An octahedron whose faces are cut in four `cuts` times and pushed to the unit sphere: of square roots only, so that
/// the mesh is the same on every machine.
fn geode(cuts: u32) -> Mesh {
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z];
    let mut faces =
        vec![[x, y, z], [y, -x, z], [-x, -y, z], [-y, x, z], [y, x, -z], [-x, y, -z], [-y, -x, -z], [x, -y, -z]];
    for _ in 0..cuts {
        let cut = |[a, b, c]: [Vec3; 3]| {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                let sum = p + q;
                sum / (sum.x * sum.x + sum.y * sum.y + sum.z * sum.z).sqrt()
            });
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.into_iter().flat_map(cut).collect();
    }
    let corners: Vec<Vec3> = faces.into_iter().flatten().collect();
    let indices = (0..corners.len() as u32).collect();
    Mesh::from_parts(corners.clone(), Some(corners), None, indices).expect("triangles of unit vectors")
}

/// FNV-1a over the bits of every channel.
fn hash(picture: &Image) -> u64 {
    let bytes = picture.pixels().iter().flatten().flat_map(|channel| channel.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A lit scene with every function of angles and powers in it; transforms are written as they are.
fn lit(shading: Shading, reflectance: Reflectance) -> Stage {
    let mut stage = Stage::new();
    let cone = Cone { cutoff: 0.6, inner: Some(0.3), exponent: 2.7 };
    let light = PointLight { range: Some(9.0), ..PointLight::white() };
    stage.world.spawn((SpotLight { light, cone }, GlobalTransform::from_xyz(0.3, 0.2, 0.5)));
    stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(-2.0, 3.0, 1.0)));
    let material = Material { shininess: 13.7, ..Material::BRASS };
    stage.add_at(geode(3), GlobalTransform::from_xyz(0.25, -0.125, -2.5), (material, shading, reflectance));
    let glass = Material { opacity: 0.375, ..Material::default() };
    stage.add_at(
        geode(1),
        GlobalTransform::from_xyz(-0.5, 0.25, -1.75),
        (glass, Blend, Faces::Both, shading, reflectance),
    );
    stage
}

#[test]
fn pictures_have_the_same_bits_on_every_machine() {
    // Recorded from this test. A change of the oracle may change them; a change of the machine may not.
    let pictures = [
        ("Phong", lit(Shading::Phong, Reflectance::Phong).draw(40, 30), 0x3afa_6ba9_189d_5328_u64),
        ("Gouraud", lit(Shading::Gouraud, Reflectance::BlinnPhongMatched).draw(40, 30), 0xaaef_1d47_86ec_18c1),
        (
            "the surface",
            {
                let mut stage = Stage::new();
                stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(-2.0, 3.0, 1.0)));
                stage.add_at(UvSphere::new(1.0, 8, 4), GlobalTransform::from_xyz(0.25, -0.125, -2.5), Material::BRASS);
                stage.oracle(40, 30).with_mode(Mode::Surface).draw()
            },
            0x1dee_3268_8a10_f8f3,
        ),
    ];
    let found: Vec<String> =
        pictures.iter().map(|(name, picture, _)| format!("{name}: {:#018x}", hash(picture))).collect();
    let recorded: Vec<String> = pictures.iter().map(|(name, _, hash)| format!("{name}: {hash:#018x}")).collect();
    assert_eq!(found, recorded);
}
