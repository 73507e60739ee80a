//! What each pixel should be, in f64: a ray through its centre, the nearest triangle that is drawn, and what the
//! object's shading means there. It works in world space and with matrix inverses, where the renderer works in eye space
//! and with cofactors, and shares with it the components only.

use crate::render::scene::{Kind, Scene, Thing, world_from};
use bevy_math::{DAffine3, DMat3, DVec3};
use halfway::lighting::Frequency;
use halfway::lighting::equations::{
    self, Coefficients, Light, Surface, interpolated_normal, light_terms, normal_matrix, rgb, transform_normal,
};
use halfway::mesh::face_normal;
use halfway::prelude::*;
use std::cell::RefCell;
use std::collections::HashMap;

pub(crate) type Colour = [f64; 3];

/// A point of the scene that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    pub(crate) thing: usize,
    pub(crate) triangle: usize,
    /// Barycentric in space, which is perspective-correct on the picture.
    pub(crate) weights: [f64; 3],
    /// Distance along the view.
    pub(crate) depth: f64,
    pub(crate) front: bool,
}

/// The scene, ready for evaluation in world space.
pub(crate) struct Oracle {
    width: u32,
    height: u32,
    eye: DVec3,
    world_from_eye: DMat3,
    tan_half_fov: f64,
    near: f64,
    background: Colour,
    ambient: Colour,
    viewer: equations::View<f64>,
    lights: Vec<Light<f64>>,
    solids: Vec<Solid>,
    /// What has been shaded at vertices and centroids.
    shaded: RefCell<HashMap<Once, Colour>>,
}

/// What is shaded once, by the object, the vertex or triangle, and the side.
type Once = (usize, usize, bool);

/// An object in world space.
struct Solid {
    corners: Vec<DVec3>,
    normals: Vec<[f64; 3]>,
    triangles: Vec<[usize; 3]>,
    /// Geometric normals, on the front side.
    faces: Vec<[f64; 3]>,
    /// The transform turns windings over.
    mirrored: bool,
    front: Coefficients<f64>,
    back: Coefficients<f64>,
    opacity: [f64; 2],
    reflectance: Reflectance,
    shows: Faces,
    frequency: Often,
    blend: bool,
}

#[derive(Clone, Copy)]
enum Often {
    Flat,
    Smooth { diffuse: Frequency, specular: Frequency },
}

/// Which terms of the equation are summed.
#[derive(Clone, Copy)]
pub(crate) struct Sum {
    pub(crate) base: bool,
    pub(crate) diffuse: bool,
    pub(crate) specular: bool,
}

const ALL: Sum = Sum { base: true, diffuse: true, specular: true };

impl Oracle {
    pub(crate) fn new(scene: &Scene, width: u32, height: u32) -> Self {
        let world_from_eye = DMat3::from_quat(scene.eye.rotation.as_dquat().normalize());
        let eye = scene.eye.translation.as_dvec3();
        let viewer = match scene.camera.viewer {
            Viewer::Local => equations::View::Local(eye.to_array()),
            Viewer::Infinite => equations::View::Infinite(world_from_eye.z_axis.to_array()),
        };
        Self {
            width,
            height,
            eye,
            world_from_eye,
            tan_half_fov: (f64::from(scene.camera.fov_y) * 0.5).tan(),
            near: scene.camera.near.into(),
            background: rgb(scene.camera.background),
            ambient: rgb(scene.ambient),
            viewer,
            lights: lights(scene),
            solids: scene.things.iter().map(|thing| Solid::new(scene, thing)).collect(),
            shaded: RefCell::default(),
        }
    }

    /// The ray through a point of the picture, in pixels from its top left corner; its length along the view is 1.
    fn ray(&self, x: f64, y: f64) -> DVec3 {
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        let across = self.tan_half_fov * width / height;
        let eye_ray = DVec3::new((2.0 * x / width - 1.0) * across, (1.0 - 2.0 * y / height) * self.tan_half_fov, -1.0);
        self.world_from_eye * eye_ray
    }

    /// Where a point of the world is on the picture, in pixels from its top left corner; `None` behind the near plane.
    pub(crate) fn pixel_of(&self, point: Vec3) -> Option<(f64, f64)> {
        self.project(point.as_dvec3())
    }

    fn project(&self, point: DVec3) -> Option<(f64, f64)> {
        let p = self.world_from_eye.transpose() * (point - self.eye);
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        let across = self.tan_half_fov * width / height;
        (-p.z > self.near)
            .then(|| (0.5 * width * (1.0 - p.x / p.z / across), 0.5 * height * (1.0 + p.y / p.z / self.tan_half_fov)))
    }

    /// Everything drawn on the ray through (x, y), the nearest first.
    pub(crate) fn hits(&self, x: f64, y: f64) -> Vec<Hit> {
        let ray = self.ray(x, y);
        let mut hits = Vec::new();
        for (thing, solid) in self.solids.iter().enumerate() {
            for triangle in 0..solid.triangles.len() {
                hits.extend(self.meet(ray, thing, triangle));
            }
        }
        hits.sort_by(|a: &Hit, b: &Hit| a.depth.total_cmp(&b.depth));
        hits
    }

    /// The nearest hit of each pixel, row by row. Triangles are tried only where their corners say they may be.
    pub(crate) fn trace(&self) -> Vec<Option<Hit>> {
        let mut nearest: Vec<Option<Hit>> = vec![None; (self.width * self.height) as usize];
        for (thing, solid) in self.solids.iter().enumerate() {
            for (triangle, corners) in solid.triangles.iter().enumerate() {
                let [columns, rows] = self.box_of(corners.map(|i| solid.corners[i]));
                for y in rows.clone() {
                    for x in columns.clone() {
                        let ray = self.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
                        let Some(hit) = self.meet(ray, thing, triangle) else { continue };
                        let slot = &mut nearest[(y * self.width + x) as usize];
                        if slot.is_none_or(|known| hit.depth < known.depth) {
                            *slot = Some(hit);
                        }
                    }
                }
            }
        }
        nearest
    }

    /// The columns and rows that a triangle may reach; all of them where a corner is behind the near plane.
    fn box_of(&self, corners: [DVec3; 3]) -> [std::ops::Range<u32>; 2] {
        let all = [0..self.width, 0..self.height];
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| self.project(corner)) else { return all };
        let range = |p: f64, q: f64, r: f64, size: u32| {
            let low = p.min(q).min(r).floor().clamp(0.0, f64::from(size)) as u32;
            let high = p.max(q).max(r).ceil().clamp(0.0, f64::from(size)) as u32;
            low..high
        };
        [range(a.0, b.0, c.0, self.width), range(a.1, b.1, c.1, self.height)]
    }

    fn meet(&self, ray: DVec3, thing: usize, triangle: usize) -> Option<Hit> {
        let solid = &self.solids[thing];
        let [a, b, c] = solid.triangles[triangle].map(|i| solid.corners[i] - self.eye);
        // Volumes of the tetrahedra of the eye, the ray and each edge: proportional to the weights.
        let volumes = [ray.dot(b.cross(c)), ray.dot(c.cross(a)), ray.dot(a.cross(b))];
        let sum: f64 = volumes.iter().sum();
        let inside = volumes.iter().all(|v| *v >= 0.0) || volumes.iter().all(|v| *v <= 0.0);
        if !inside || sum == 0.0 {
            return None;
        }
        let weights = volumes.map(|v| v / sum);
        let point = a * weights[0] + b * weights[1] + c * weights[2];
        let depth = -point.dot(self.world_from_eye.z_axis);
        // The sum is ray · (b − a)×(c − a): negative where the triangle winds counter-clockwise as seen.
        let front = (sum < 0.0) != solid.mirrored;
        let shown = if front { solid.shows.shows_front() } else { solid.shows.shows_back() };
        (depth > self.near && shown).then_some(Hit { thing, triangle, weights, depth, front })
    }

    /// I at a hit.
    pub(crate) fn value(&self, hit: &Hit) -> Colour {
        let solid = &self.solids[hit.thing];
        let corners = solid.triangles[hit.triangle];
        match solid.frequency {
            Often::Flat => {
                let [a, b, c] = corners.map(|i| solid.corners[i]);
                let centroid = (a + b + c) / 3.0;
                self.once((hit.thing, hit.triangle, hit.front), || {
                    self.shade(solid, centroid, solid.faces[hit.triangle], hit.front, ALL)
                })
            }
            Often::Smooth { diffuse, specular } => {
                let terms = |often| Sum { base: false, diffuse: diffuse == often, specular: specular == often };
                let per_vertex = Sum { base: true, ..terms(Frequency::Vertex) };
                let vertex = corners.map(|i| {
                    self.once((hit.thing, i, hit.front), || {
                        self.shade(solid, solid.corners[i], solid.normals[i], hit.front, per_vertex)
                    })
                });
                let fragment = self.at_fragment(solid, hit, terms(Frequency::Fragment));
                [0, 1, 2].map(|k| (0..3).map(|i| hit.weights[i] * vertex[i][k]).sum::<f64>() + fragment[k])
            }
        }
    }

    fn once(&self, what: Once, shade: impl FnOnce() -> Colour) -> Colour {
        if let Some(colour) = self.shaded.borrow().get(&what) {
            return *colour;
        }
        let colour = shade();
        self.shaded.borrow_mut().insert(what, colour);
        colour
    }

    fn at_fragment(&self, solid: &Solid, hit: &Hit, sum: Sum) -> Colour {
        if !sum.diffuse && !sum.specular {
            return [0.0; 3];
        }
        let corners = solid.triangles[hit.triangle];
        let mut p = DVec3::ZERO;
        let mut n = DVec3::ZERO;
        for (i, weight) in corners.into_iter().zip(hit.weights) {
            p += solid.corners[i] * weight;
            n += DVec3::from_array(solid.normals[i]) * weight;
        }
        let n = interpolated_normal(n.to_array(), solid.faces[hit.triangle]);
        self.shade(solid, p, n, hit.front, sum)
    }

    /// The equation at a point of one side, or some of its terms.
    fn shade(&self, solid: &Solid, p: DVec3, n: [f64; 3], front: bool, sum: Sum) -> Colour {
        let material = if front { &solid.front } else { &solid.back };
        let normal = equations::side_normal(n, front);
        let surface = Surface { position: p.to_array(), normal };
        if sum.base && sum.diffuse && sum.specular {
            return equations::shade(&surface, material, &self.lights, self.ambient, &self.viewer, solid.reflectance);
        }
        let mut colour = [0.0; 3];
        if sum.base {
            colour = equations::shade(&surface, material, &[], self.ambient, &self.viewer, solid.reflectance);
        }
        for light in &self.lights {
            let terms = light_terms(&surface, material, light, &self.viewer, solid.reflectance);
            // An ambient that attenuates goes with the diffuse term, one that does not is always there.
            let ambient = if light.attenuate_ambient { sum.diffuse } else { sum.base };
            let share = |on: bool, term: [f64; 3], k: usize| if on { term[k] } else { 0.0 };
            colour = [0, 1, 2].map(|k| {
                colour[k]
                    + share(ambient, terms.ambient, k)
                    + share(sum.diffuse, terms.diffuse, k)
                    + share(sum.specular, terms.specular, k)
            });
        }
        colour
    }

    /// What is seen at (x, y), as floating point holds it: opaque things, then blended ones over them.
    pub(crate) fn seen(&self, x: f64, y: f64) -> Colour {
        let hits = self.hits(x, y);
        let opaque = hits.iter().find(|hit| !self.solids[hit.thing].blend);
        let depth = opaque.map_or(f64::INFINITY, |hit| hit.depth);
        let mut colour = opaque.map_or(self.background, |hit| self.value(hit));
        for hit in hits.iter().rev().filter(|hit| self.solids[hit.thing].blend && hit.depth < depth) {
            let opacity = self.solids[hit.thing].opacity[usize::from(!hit.front)];
            let over = self.value(hit);
            colour = [0, 1, 2].map(|k| opacity * over[k] + (1.0 - opacity) * colour[k]);
        }
        colour
    }

    pub(crate) fn background(&self) -> Colour {
        self.background
    }

    pub(crate) fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }
}

impl Solid {
    fn new(scene: &Scene, thing: &Thing) -> Self {
        let world_from_model: DAffine3 = world_from(&thing.frames);
        let m = world_from_model.matrix3;
        let normal_matrix = normals_of(m);
        let turned = |n: Vec3| transform_normal(normal_matrix, n.as_dvec3().to_array()).unwrap_or([0.0; 3]);
        let mesh = &thing.mesh;
        let triangles: Vec<[usize; 3]> = mesh.triangles().map(|corners| corners.map(|i| i as usize)).collect();
        let face = |corners: &[usize; 3]| {
            let [a, b, c] = corners.map(|i| mesh.positions()[i]);
            face_normal(a, b, c).map_or([0.0; 3], turned)
        };
        let back = thing.back.unwrap_or(thing.material);
        Self {
            corners: mesh.positions().iter().map(|p| world_from_model.transform_point3(p.as_dvec3())).collect(),
            normals: mesh.normals().iter().map(|n| turned(*n)).collect(),
            faces: triangles.iter().map(face).collect(),
            triangles,
            mirrored: m.determinant() < -1e-12 * m.x_axis.length() * m.y_axis.length() * m.z_axis.length(),
            front: Coefficients::from(&thing.material),
            back: Coefficients::from(&back),
            opacity: [thing.material, back].map(|material| material.opacity.into()),
            reflectance: thing.reflectance.or(scene.view_reflectance).unwrap_or_default(),
            shows: thing.faces.unwrap_or_default(),
            frequency: often(scene, thing),
            blend: thing.blend,
        }
    }
}

/// M⁻ᵀ, or the lighting crate's cofactors where M has no inverse.
fn normals_of(m: DMat3) -> [[f64; 3]; 3] {
    let product = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    if m.determinant().abs() > 1e-9 * product {
        m.inverse().transpose().to_cols_array_2d()
    } else {
        normal_matrix(m.to_cols_array_2d())
    }
}

fn often(scene: &Scene, thing: &Thing) -> Often {
    let both = |often| Often::Smooth { diffuse: often, specular: often };
    if let Some(Terms { diffuse, specular }) = thing.terms {
        return Often::Smooth { diffuse, specular };
    }
    match thing.shading.or(scene.view_shading).unwrap_or_default() {
        Shading::Flat => Often::Flat,
        Shading::Gouraud => both(Frequency::Vertex),
        _ => both(Frequency::Fragment),
    }
}

fn lights(scene: &Scene) -> Vec<Light<f64>> {
    let place = |lamp| {
        let world_from_light = world_from(&scene.lamp_frames(lamp));
        (world_from_light.translation.to_array(), (-world_from_light.matrix3.z_axis).to_array())
    };
    let light = |lamp| {
        let (position, direction) = place(lamp);
        match &lamp.kind {
            Kind::Directional(light) => light.along(direction).expect("a direction"),
            Kind::Point(light) => light.at(position),
            Kind::Spot(light) => light.at(position, direction).expect("a direction"),
        }
    };
    scene.lamps.iter().map(light).collect()
}
