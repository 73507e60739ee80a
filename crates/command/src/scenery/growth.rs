//! Scenes that grow: by objects, lights, triangles or pixels, with all else as it is.

use std::f32::consts::TAU;
use std::str::FromStr;

use halfway::prelude::*;

/// One size of one of them, as a plugin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Growing {
    pub(crate) by: Growth,
    pub(crate) count: u32,
}

/// The number that grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Growth {
    /// Cubes that stand before a camera that stands.
    Standing,
    /// The same cubes, turning.
    Turning,
    /// Moving points of range 6, each above a sphere of 224 triangles, 8 apart.
    Lights,
    /// The triangles of one sphere, around which the camera turns.
    Triangles,
    /// The pixels of a square picture of one sphere of 3,968 triangles, which turns.
    Pixels,
}

impl Growth {
    pub(crate) const ALL: [Self; 5] = [Self::Standing, Self::Turning, Self::Lights, Self::Triangles, Self::Pixels];

    /// Its name, and the unit of its counts.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Standing => "objects-standing",
            Self::Turning => "objects-turning",
            Self::Lights => "lights",
            Self::Triangles => "triangles",
            Self::Pixels => "pixels",
        }
    }

    /// The least and the largest count; each is four times the one before.
    pub(crate) fn counts(self) -> impl Iterator<Item = u32> {
        let (least, steps) = match self {
            Self::Standing | Self::Turning => (1 << 10, 6),
            Self::Lights => (1 << 6, 5),
            Self::Triangles => (1 << 12, 6),
            Self::Pixels => (1 << 16, 5),
        };
        (0..steps).map(move |step| least << (2 * step))
    }
}

impl FromStr for Growing {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once(':').and_then(|(name, count)| {
            let by = Growth::ALL.into_iter().find(|by| by.name() == name)?;
            Some(Self { by, count: count.parse().ok().filter(|count| *count > 0)? })
        });
        parsed.ok_or_else(|| format!("{text}: expected a number that grows, a colon and a count"))
    }
}

/// Turns or circles, by the number of the frame.
#[derive(Component, Clone, Copy)]
enum Moving {
    Turning(f32),
    Circling(Vec3),
    Around(f32),
}

#[derive(Resource, Default)]
struct FrameNumber(u32);

fn advance(mut number: ResMut<FrameNumber>, mut moving: Query<(&Moving, &mut Transform)>) {
    let time = 0.02 * number.0 as f32;
    number.0 += 1;
    for (moving, mut at) in &mut moving {
        match *moving {
            Moving::Turning(start) => at.rotation = Quat::from_rotation_y(start + time),
            Moving::Circling(middle) => {
                let (sin, cos) = (middle.x + middle.z + time).sin_cos();
                at.translation = middle + Vec3::new(cos, 0.0, sin);
            }
            Moving::Around(away) => {
                let (sin, cos) = time.sin_cos();
                *at = Transform::from_xyz(away * sin, 0.0, away * cos).looking_at(Vec3::ZERO, Vec3::Y);
            }
        }
    }
}

impl Growing {
    /// The size of its picture in pixels.
    pub(crate) fn size(self) -> UVec2 {
        match self.by {
            Growth::Pixels => UVec2::splat(f64::from(self.count).sqrt().round() as u32),
            _ => UVec2::new(640, 360),
        }
    }

    fn spawn(self, commands: &mut Commands, meshes: &mut Assets<Mesh>) {
        let camera = Camera::perspective(0.8);
        let sun = DirectionalLight::new(LinearRgba::gray(if self.by == Growth::Lights { 0.1 } else { 0.8 }));
        commands.spawn((sun, Transform::from_xyz(1.0, 2.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y)));
        match self.by {
            Growth::Standing | Growth::Turning => {
                let cube = meshes.add(Cuboid::default());
                let edge = self.lattice(2.5, |at, number| {
                    let material = [Material::BRASS, Material::DEFAULT][number as usize % 2];
                    let place = Transform::from_translation(at);
                    let mut object = commands.spawn((Mesh3d(cube.clone()), material, Shading::Phong, place));
                    if self.by == Growth::Turning {
                        object.insert(Moving::Turning(number as f32));
                    }
                });
                commands.spawn((camera, above(edge)));
            }
            Growth::Lights => {
                let sphere = meshes.add(UvSphere::new(1.0, 16, 8));
                let lamp = PointLight { range: Some(6.0), ..PointLight::new(LinearRgba::gray(0.8)) };
                let edge = self.lattice(8.0, |at, _| {
                    commands.spawn((Mesh3d(sphere.clone()), Material::DEFAULT, Transform::from_translation(at)));
                    commands.spawn((lamp, Moving::Circling(at + 3.0 * Vec3::Y), Transform::default()));
                });
                commands.spawn((camera, above(edge)));
            }
            Growth::Triangles | Growth::Pixels => {
                let triangles = if self.by == Growth::Triangles { self.count } else { 3968 };
                let rings = (f64::from(triangles) / 4.0).sqrt().round() as u32;
                let sphere = meshes.add(UvSphere::new(1.0, 2 * rings, rings));
                commands.spawn((Mesh3d(sphere), Material::BRASS));
                commands.spawn((camera, Transform::default(), Moving::Around(3.0)));
            }
        }
    }

    /// Calls `place` with each place of a square lattice around the origin; returns its edge.
    fn lattice(self, apart: f32, mut place: impl FnMut(Vec3, u32)) -> f32 {
        let side = f64::from(self.count).sqrt().ceil() as u32;
        let middle = 0.5 * (side - 1) as f32;
        for number in 0..self.count {
            let [column, row] = [number % side, number / side].map(|index| index as f32 - middle);
            place(Vec3::new(column, 0.0, row) * apart, number);
        }
        side as f32 * apart
    }
}

/// From where all of a square around the origin is seen.
fn above(edge: f32) -> Transform {
    let (sin, cos) = (0.15 * TAU).sin_cos();
    Transform::from_translation(1.4 * edge * Vec3::new(0.0, sin, cos)).looking_at(Vec3::ZERO, Vec3::Y)
}

impl Plugin for Growing {
    fn build(&self, app: &mut App) {
        let scene = *self;
        app.insert_resource(GlobalAmbient(LinearRgba::gray(0.1)))
            .init_resource::<FrameNumber>()
            .add_systems(Update, advance)
            .add_systems(Startup, move |mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>| {
                scene.spawn(&mut commands, &mut meshes);
            });
    }
}
