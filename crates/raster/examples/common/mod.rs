//! Scenes S1 and S4 of the project's benchmarks, as plain data.

use halfway_lighting::lights::Kind;
use halfway_lighting::record::{InstanceRecord, LightRange, LightRecord, MaterialRecord, SurfaceLights, SurfaceRecord};
use halfway_lighting::{Frequency, Lens, Samples, Terms};
use halfway_mesh::{Mesh, UvSphere};
use halfway_raster::{DrawCall, Pass, Pieces, PixelFormat, RasterError, TriangleOrder, VertexLists};

/// The frequency of shading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shading {
    Constant,
    Flat,
    Gouraud,
    Phong,
}

impl Shading {
    pub(crate) const ALL: [Self; 4] = [Self::Constant, Self::Flat, Self::Gouraud, Self::Phong];
}

/// The data that a pass borrows.
pub(crate) struct Scene {
    pub(crate) size: [u32; 2],
    pub(crate) samples: Samples,
    pub(crate) pixels: PixelFormat,
    pub(crate) clear: [f32; 3],
    pub(crate) lens: Lens,
    pub(crate) lights: Vec<LightRecord>,
    pub(crate) lists: Vec<u32>,
    pub(crate) surfaces: Vec<SurfaceRecord>,
    pub(crate) instances: Vec<InstanceRecord>,
    pub(crate) meshes: Vec<Pieces>,
    pub(crate) draws: Vec<DrawCall>,
}

impl Scene {
    /// Calls `draw` with a pass that borrows the data.
    pub(crate) fn with_pass<R>(&self, draw: impl FnOnce(&Pass) -> R) -> R {
        let meshes: Vec<_> = self.meshes.iter().collect();
        draw(&Pass {
            size: self.size,
            samples: self.samples,
            pixels: self.pixels,
            clear: self.clear,
            lens: self.lens,
            local_viewer: true,
            lights: &self.lights,
            lists: &self.lists,
            surfaces: &self.surfaces,
            instances: &self.instances,
            meshes: &meshes,
            maps: &[],
            surroundings: None,
            draws: &self.draws,
        })
    }
}

/// A lens with this vertical angle in degrees.
pub(crate) fn lens([width, height]: [u32; 2], degrees: f64) -> Lens {
    let y = 1.0 / (degrees.to_radians() * 0.5).tan();
    Lens::perspective([(y * f64::from(height) / f64::from(width)) as f32, y as f32], 0.1)
}

/// A mesh cut into pieces.
pub(crate) fn pieces(mesh: &Mesh, order: TriangleOrder) -> Result<Pieces, RasterError> {
    let positions: Vec<_> = mesh.positions().iter().map(|&p| p.into()).collect();
    let normals: Vec<_> = mesh.normals().iter().map(|&n| n.into()).collect();
    Pieces::new(&positions, VertexLists { normals: &normals, ..VertexLists::default() }, mesh.indices(), &[], order)
}

/// A mesh at this place, unturned.
pub(crate) fn at(place: [f32; 3], surface: u32) -> InstanceRecord {
    let row = |axis: usize| {
        let mut row = [0.0, 0.0, 0.0, place[axis]];
        row[axis] = 1.0;
        row
    };
    InstanceRecord {
        eye_from_model: [row(0), row(1), row(2)],
        normal: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        surface,
    }
}

/// A draw of N instances of a whole mesh.
pub(crate) fn draw(mesh: &Pieces, instances: u32, shading: Shading) -> DrawCall {
    let terms = Terms::both(match shading {
        Shading::Constant => Frequency::Never,
        Shading::Flat => Frequency::Triangle,
        Shading::Gouraud => Frequency::Vertex,
        Shading::Phong => Frequency::Fragment,
    });
    DrawCall { indices: 0..3 * mesh.triangle_count() as u32, instances: 0..instances, terms, ..DrawCall::default() }
}

/// One sphere of 261,120 triangles under four lights, or a small one of 3,968 under one.
pub(crate) fn sphere(small: bool, shading: Shading) -> Result<Scene, RasterError> {
    let size = if small { [256, 256] } else { [1280, 720] };
    let (segments, rings) = if small { (64, 32) } else { (512, 256) };
    let mesh = pieces(&Mesh::from(UvSphere { radius: 1.0, segments, rings }), TriangleOrder::Clustered)?;
    let c = 1.0 / 3.0_f32.sqrt();
    let from_the_side = |strength: f32| LightRecord {
        position: [c; 3],
        diffuse: [strength; 3],
        specular: [strength; 3],
        ..LightRecord::default()
    };
    let point = |position: [f32; 3], color: [f32; 3]| LightRecord {
        kind: Kind::Point as u32,
        position: [position[0], position[1], position[2] - 3.0],
        linear: 0.09,
        quadratic: 0.032,
        diffuse: color.map(|x| 0.5 * x),
        specular: color.map(|x| 0.5 * x),
        ..LightRecord::default()
    };
    let lights = if small {
        vec![from_the_side(0.9)]
    } else {
        let points = [
            point([2.0, 0.0, 2.0], [1.0, 0.9, 0.8]),
            point([-2.0, 1.0, 1.5], [0.8, 0.9, 1.0]),
            point([0.0, -2.0, 2.0], [0.9, 1.0, 0.9]),
        ];
        [vec![from_the_side(0.6)], points.to_vec()].concat()
    };
    let lights_of_all =
        SurfaceLights { both: LightRange { start: 0, count: lights.len() as u32 }, ..SurfaceLights::default() };
    let front = MaterialRecord {
        base: [0.08, 0.03, 0.02],
        diffuse: [0.8, 0.3, 0.2],
        specular: if small { [0.0; 3] } else { [1.0; 3] },
        shininess: 32.0,
        opacity: 1.0,
        ..MaterialRecord::default()
    };
    Ok(Scene {
        size,
        samples: Samples::One,
        pixels: PixelFormat::SrgbBytes,
        clear: [0.01, 0.012, 0.02],
        lens: lens(size, 45.0),
        lists: (0..lights.len() as u32).collect(),
        lights,
        surfaces: vec![SurfaceRecord { front, lights: lights_of_all, ..SurfaceRecord::default() }],
        instances: vec![at([0.0, 0.0, -3.0], 0)],
        draws: vec![draw(&mesh, 1, shading)],
        meshes: vec![mesh],
    })
}
