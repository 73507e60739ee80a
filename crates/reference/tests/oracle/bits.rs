//! The same bits on every machine.

use bevy_math::{Vec2, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_lighting::{AlphaMode, Cone, Faces, Intensity, Material, PointLight, Reflectance, Shading, SpotLight};
use halfway_mesh::{Mesh, UvSphere};
use halfway_reference::{Image, Mode};
use halfway_texture::environment::{Environment, EnvironmentLight, EnvironmentMap, EnvironmentShape};
use halfway_texture::{
    LevelFilter, MapKind, Maps, Sampling, SolidKind, SolidTexture, SurfaceMap, TexelImage, Texture, UvTransform,
};

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
        (glass, AlphaMode::Blend, Faces::Both, shading, reflectance),
    );
    stage
}

/// Texels that differ from their neighbours, of whole numbers.
fn texels(width: u32, height: u32, seed: u32) -> TexelImage {
    let number = |i: u32| (i.wrapping_mul(2_654_435_761) >> 24) as f32 / 256.0;
    let texel = |x: u32, y: u32| [0, 7, 14, 21].map(|k| number(seed + 31 * x + 1023 * y + k));
    TexelImage::from_fn(width, height, texel).expect("finite texels")
}

/// Solids of each kind over a floor with images of colours and heights, which shrink far away, by each way to look them
/// up.
fn mapped(intensity: Intensity) -> Stage {
    let mut stage = Stage::new();
    stage.camera().intensity = intensity;
    stage.world.insert_resource(Assets::<Texture>::default());
    stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(-2.0, 3.0, 1.0)));
    let texture = stage.world.resource_mut::<Assets<Texture>>().add(Texture::from(texels(16, 8, 1)));
    let heights = stage.world.resource_mut::<Assets<Texture>>().add(Texture::from(texels(8, 8, 5)));
    let filters = [
        LevelFilter::None,
        LevelFilter::Nearest,
        LevelFilter::Linear,
        LevelFilter::Ripmap,
        LevelFilter::SummedArea,
        LevelFilter::Anisotropic8,
        LevelFilter::Elliptical,
    ];
    for (i, levels) in filters.into_iter().enumerate() {
        let [left, right] = [i, i + 1].map(|i| 0.75 * i as f32 - 2.625);
        let corners = [(left, -1.0), (right, -1.0), (right, -9.0), (left, -9.0)].map(|(x, z)| Vec3::new(x, -1.0, z));
        let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::new(1.0, 8.0), Vec2::new(0.0, 8.0)];
        let strip = Mesh::from_parts(corners.to_vec(), Some(vec![Vec3::Y; 4]), Some(uvs), vec![0, 1, 2, 0, 2, 3]);
        let sampling = Sampling { levels, ..Sampling::default() };
        let transform = UvTransform { rotation: 0.3, ..UvTransform::default() };
        let color = SurfaceMap { sampling, transform, ..texture.clone().into() };
        let height = SurfaceMap { amount: 0.05, ..heights.clone().into() };
        let maps = Maps::new(MapKind::Color, color).with(MapKind::Height, height);
        stage.add(strip.expect("a rectangle"), (Material::default(), maps));
    }
    for (i, kind) in SolidKind::ALL.into_iter().enumerate() {
        let solid = SolidTexture::new(kind, [[0.125, 0.25, 0.5], [1.0, 0.75, 0.5]]).scaled(3.0);
        let at = GlobalTransform::from_xyz(1.25 * i as f32 - 1.875, 0.375, -2.5);
        stage.add_at(geode(2), at, (Material::default(), solid));
    }
    stage
}

/// Balls that are lit by a cube map alone, before it.
fn surrounded(intensity: Intensity) -> Stage {
    let mut stage = Stage::new();
    stage.camera().intensity = intensity;
    let faces = (0..6).map(|face| texels(8, 8, 100 * face)).collect();
    let cube = Environment::new(EnvironmentShape::Cube, faces).expect("six squares");
    let mut maps = Assets::<EnvironmentMap>::default();
    let map = maps.add(EnvironmentMap::new(&cube).expect("a cube map"));
    stage.world.insert_resource(maps);
    stage.world.spawn(EnvironmentLight { map, strength: 2.5, rotation: 0.7, sky: true });
    for (x, shading) in [(-1.25, Shading::Flat), (1.25, Shading::Phong)] {
        stage.add_at(geode(3), GlobalTransform::from_xyz(x, -0.125, -2.5), (Material::BRASS, shading));
    }
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
        ("images and solids by the curve of ACES", mapped(Intensity::Aces).draw(40, 30), 0x3513_02e4_6cc3_0398),
        (
            "an environment, divided by the brightest",
            surrounded(Intensity::Renormalize { smoothing: 0.0 }).draw(40, 30),
            0xb049_5fb4_6a19_d5b0,
        ),
    ];
    let found: Vec<String> =
        pictures.iter().map(|(name, picture, _)| format!("{name}: {:#018x}", hash(picture))).collect();
    let recorded: Vec<String> = pictures.iter().map(|(name, _, hash)| format!("{name}: {hash:#018x}")).collect();
    assert_eq!(found, recorded);
}
