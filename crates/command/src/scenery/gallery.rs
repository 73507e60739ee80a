//! S5 and S6: realistic meshes, with odd counts, holes, creases, thin walls and noise.
//!
//! Objects of S5 stand on a grid of 10 × 6, 3 apart; object i is of kind i mod 5 and turned about +Y by 0.7·i.
//!
//! | kind | mesh | triangles |
//! |---|---|---|
//! | 0 | a machine part: a turned profile with thirteen sharp edges, 96 around | 2,688 |
//! | 1 | a scan: a stone with the noise of a scanner, and a hole of one triangle | 150,001 |
//! | 2 | a terrain of 127 × 127 cells, two units wide | 32,258 |
//! | 3 | the Utah teapot, 8 × 8 cells a patch | 4,032 |
//! | 4 | a vase: a wall of 0.03 and a bottom, turned, 128 around | 10,496 |
//!
//! Three point lights of 0.6 circle about (−9, 4, 0), (0, 4, 0) and (9, 4, 0) as those of S3 do; the spot of 1.5 with a
//! half angle of 0.6 shines from (0, 8, 0) down.

use std::f32::consts::{PI, TAU};

use halfway::mesh::{HeightField, NormalWeighting, Normals, ParametricSurface, Tessellation};
use halfway::prelude::*;
use halfway_chart::front::scenes::{sound, stone_mesh};

use super::{Circling, Scenery, Turning, grey, hsv};

/// The distance between objects.
const STEP: f32 = 3.0;

impl Scenery<'_, '_, '_> {
    pub(super) fn gallery(&mut self) {
        self.camera(Vec3::new(0.0, 10.0, 19.0));
        self.two_suns();
        let kinds = [machine_part(), scan(), terrain(), Teapot::new(8).into(), vase()];
        let scales = [1.0, 1.0, 0.25, 0.6, 1.0];
        let kinds = kinds.map(|mesh| Mesh3d(self.meshes.add(mesh)));
        for i in 0..60_u8 {
            let kind = usize::from(i % 5);
            let (column, row) = (f32::from(i % 10), f32::from(i / 10));
            let place = Transform::from_xyz((column - 4.5) * STEP, 0.0, (row - 2.5) * STEP)
                .with_rotation(Quat::from_rotation_y(0.7 * f32::from(i)))
                .with_scale(Vec3::splat(scales[kind]));
            let material = self.look.material(hsv(f32::from(i % 5) / 5.0, 0.4, 0.8));
            self.commands.spawn((kinds[kind].clone(), material, self.look.shading(), place));
        }
        for i in 0..3_u8 {
            let start = TAU * f32::from(i) / 3.0;
            let light = PointLight::new(hsv(f32::from(i) / 3.0, 0.4, 0.6));
            let center = Vec3::new((f32::from(i) - 1.0) * 9.0, 4.0, 0.0);
            self.commands.spawn((light, Circling { center, start }));
        }
        let spot = SpotLight { light: PointLight::new(grey(1.5)), cone: Cone::new(0.6) };
        self.commands.spawn((spot, Transform::from_xyz(0.0, 8.0, 0.0).looking_at(Vec3::ZERO, Vec3::Z)));
    }

    pub(super) fn large_scan(&mut self) {
        self.camera(Vec3::new(0.0, 0.0, 2.5));
        self.two_suns();
        let lamp = PointLight::new(LinearRgba::rgb(0.3, 0.25, 0.2));
        self.commands.spawn((lamp, Transform::from_xyz(-1.5, 0.5, 1.5)));
        // 2 · 1000 · (501 − 1) triangles.
        let mesh = Mesh3d(self.meshes.add(sound(stone_mesh(1000, 501))));
        let material = self.look.material(LinearRgba::rgb(0.5, 0.45, 0.38));
        self.commands.spawn((mesh, material, self.look.shading(), Transform::default(), Turning { start: 0.0 }));
    }

    fn two_suns(&mut self) {
        self.sun(0.4, Quat::IDENTITY);
        self.sun(0.2, Quat::from_rotation_y(-0.5 * PI));
    }
}

/// A lathed part: cylinders and rings that meet in sharp edges.
fn machine_part() -> Mesh {
    let profile = [
        [0.0, -0.6],
        [1.0, -0.6],
        [1.0, -0.35],
        [0.7, -0.35],
        [0.7, -0.1],
        [0.85, -0.1],
        [0.85, 0.0],
        [0.5, 0.0],
        [0.5, 0.4],
        [0.6, 0.4],
        [0.6, 0.5],
        [0.35, 0.5],
        [0.35, 0.9],
        [0.15, 0.9],
        [0.15, 0.5],
        [0.0, 0.5],
    ];
    turned(&profile, 96)
}

/// One triangle short of a closed sphere with noise: 2 · 419 · (180 − 1) − 1 triangles.
fn scan() -> Mesh {
    let whole = sound(stone_mesh(419, 180));
    let open = whole.indices()[3..].to_vec();
    sound(Mesh::new(whole.positions().to_vec(), open))
}

/// Hills: a smooth surface through 17 × 17 heights, 8 × 8 units around the origin and up to 1.4 high and deep.
fn terrain() -> Mesh {
    let field = sound(HeightField::new(8.0, 8.0, SAMPLES, heights()));
    sound(field.mesh(Tessellation::Count { rows: 127, columns: 127 }))
}

/// Along each side of the terrain.
const SAMPLES: u32 = 17;

fn heights() -> Vec<f32> {
    let height = |i: u32, j: u32| {
        let [x, z] = [i, j].map(|k| k as f32 / (SAMPLES - 1) as f32);
        let waves = [(1.0, 1.3, 0.9, 0.2), (0.5, -2.1, 2.6, 1.1), (0.25, 4.7, 3.9, 2.3), (0.1, 7.1, -6.3, 0.7)];
        waves.iter().map(|(high, a, b, start)| 0.75 * high * (6.0 * (a * x + b * z) + start).sin()).sum()
    };
    (0..SAMPLES * SAMPLES).map(|k| height(k % SAMPLES, k / SAMPLES)).collect()
}

/// A wall of 0.03, up outside and down inside, and a bottom.
fn vase() -> Mesh {
    let outside = |i: u8| {
        let t = f32::from(i) / 20.0;
        [0.45 + 0.3 * (4.4 * t + 0.4).sin() * (1.0 - 0.4 * t), 2.0 * t - 1.0]
    };
    let inside = |i: u8| {
        let [radius, y] = outside(i);
        [radius - 0.03, y]
    };
    let bottom = |[_, y]: [f32; 2]| [0.0, y];
    let wall = (0..=20).map(outside).chain((1..=20).rev().map(inside));
    let profile = std::iter::once(bottom(outside(0))).chain(wall).chain(std::iter::once(bottom(inside(1))));
    turned(&profile.collect::<Vec<_>>(), 128)
}

/// A profile of (radius, height) revolved about +Y, with creases of more than 30°. It faces outward where the profile
/// goes up.
fn turned(profile: &[[f32; 2]], around: u32) -> Mesh {
    let positions = profile.iter().flat_map(|&[radius, y]| {
        (0..around).map(move |i| {
            let (sin, cos) = (TAU * i as f32 / around as f32).sin_cos();
            Vec3::new(radius * sin, y, radius * cos)
        })
    });
    let mut indices = Vec::new();
    for (row, pair) in (0..).zip(profile.windows(2)) {
        for i in 0..around {
            let [a, b] = [i, (i + 1) % around].map(|i| row * around + i);
            let [c, d] = [a + around, b + around];
            // At the axis one of the two triangles has no area.
            if pair[0][0] > 0.0 {
                indices.extend([a, b, d]);
            }
            if pair[1][0] > 0.0 {
                indices.extend([a, d, c]);
            }
        }
    }
    let mesh = sound(Mesh::new(positions.collect(), indices));
    mesh.with_normals(Normals::Creased { angle: PI / 6.0, weighting: NormalWeighting::default() }).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_have_the_triangles_that_are_said() {
        let teapot = Mesh::from(Teapot::new(8));
        let counts = [machine_part(), scan(), terrain(), teapot, vase()].map(|mesh| mesh.triangle_count());
        assert_eq!(counts, [2_688, 150_001, 32_258, 4_032, 10_496]);
        assert_eq!(12 * counts.iter().sum::<usize>(), 2_393_700);
    }
}
