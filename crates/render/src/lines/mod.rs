//! Lines over the finished picture: the edges of meshes.

mod segment;

use crate::lines::segment::{Reached, Segment};
use crate::picture::Picture;
use crate::quantities::{SurfacePoint, Surfaces, no_camera};
use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{DVec2, DVec3, IVec2, UVec2};
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_frame::error::{RenderError, label};
use halfway_lighting::{Camera, Cameras, Edges, Encoding, HiddenEdges, Lens, Shown, WhichEdges, current_camera};
use halfway_mesh::{Mesh, Mesh3d, MeshEdge, SpawnOrder};

/// Dashes and gaps, in pixels.
const DASH: [f64; 2] = [5.0, 4.0];

/// Whether objects of this world have lines.
pub(crate) fn are_there(world: &World) -> bool {
    world.try_query::<&Edges>().is_some_and(|mut edges| edges.iter(world).next().is_some())
}

/// Draws the edges of all objects that have some over the newest frame's picture.
///
/// # Errors
/// Those of [`Surfaces::take`], and an invalid [`Edges`].
pub(crate) fn draw_over_frame(world: &mut World, picture: &mut Picture) -> Result<(), RenderError> {
    if edged_objects(world)?.is_empty() {
        return Ok(());
    }
    let surfaces = Surfaces::take(world)?;
    draw_edges(world, picture, &surfaces)
}

/// Draws the [`Edges`] of all objects that have some over a picture that shows these surfaces, in the camera's encoding.
/// [`take_picture`](crate::take_picture) and [`render_picture`](crate::render_picture) have done it.
///
/// # Errors
/// [`RenderError::Invalid`] for an invalid [`Edges`], [`RenderError::NoCamera`], and [`RenderError::ManyCameras`] where it
/// is no camera's [turn](halfway_lighting::CameraTurn).
pub fn draw_edges(world: &mut World, picture: &mut Picture, surfaces: &Surfaces) -> Result<(), RenderError> {
    let objects = edged_objects(world)?;
    let camera = current_camera(world).map_err(no_camera)?;
    let encoding = world.get::<Camera>(camera).ok_or(RenderError::NoCamera)?.encoding;
    let drawing = Drawing { surfaces };
    for same in objects.chunk_by(|a, b| a.edges == b.edges) {
        let mut coverage = vec![0.0_f32; surfaces.size().element_product() as usize];
        for object in same {
            drawing.add(object, &mut coverage);
        }
        lay_over(picture, &coverage, &same[0].edges, encoding);
    }
    Ok(())
}

struct EdgedObject {
    entity: Entity,
    edges: Edges,
    mesh: Mesh,
    transform: GlobalTransform,
}

/// The shown objects with edges of their own or the camera's, in spawn order.
fn edged_objects(world: &mut World) -> Result<Vec<EdgedObject>, RenderError> {
    type Objects<'w, 's> = Query<
        'w,
        's,
        (
            Entity,
            &'static Mesh3d,
            &'static GlobalTransform,
            &'static SpawnOrder,
            Option<&'static Edges>,
            Option<&'static Name>,
        ),
    >;
    let mut state = bevy_ecs::system::SystemState::<(
        Objects,
        Query<&Edges, With<Camera>>,
        Cameras,
        Shown,
        Res<Assets<Mesh>>,
    )>::new(world);
    let (objects, of_cameras, cameras, shown, meshes) = state.get(world).map_err(|_| RenderError::NoPicture)?;
    let of_camera = cameras.current().ok().and_then(|camera| of_cameras.get(camera).ok());
    let is_shown = shown.by_entity();
    let mut found = Vec::new();
    for (entity, mesh, transform, order, own, name) in &objects {
        let (Some(edges), Some(mesh)) = (own.or(of_camera), meshes.get(&mesh.0)) else { continue };
        if is_shown(entity) && transform.affine().is_finite() {
            let invalid = |source| RenderError::Invalid { entity: label(entity, name), source };
            edges.validate().map_err(invalid)?;
            found.push((*order, EdgedObject { entity, edges: *edges, mesh: mesh.clone(), transform: *transform }));
        }
    }
    found.sort_unstable_by_key(|&(order, _)| order);
    Ok(found.into_iter().map(|(_, object)| object).collect())
}

/// The picture that edges are drawn over.
struct Drawing<'a> {
    surfaces: &'a Surfaces,
}

/// An edge on the picture.
struct Line<'a> {
    object: &'a EdgedObject,
    edge: &'a MeshEdge,
    segment: Segment,
    /// Of its ends; see [`Lens::unfitted_nearness`].
    nearness: [f64; 2],
}

impl Drawing<'_> {
    fn lens(&self) -> &Lens<f64> {
        self.surfaces.lens()
    }

    fn size(&self) -> UVec2 {
        self.surfaces.size()
    }

    fn add(&self, object: &EdgedObject, coverage: &mut [f32]) {
        let world_from_model = crate::quantities::world_from_model(&object.transform);
        let eye_from_model = self.surfaces.eye_from_world() * world_from_model;
        let corners: Vec<DVec3> =
            object.mesh.positions().iter().map(|p| eye_from_model.transform_point3(p.as_dvec3())).collect();
        for edge in object.mesh.edges() {
            if !self.is_drawn(object, &edge, &corners) {
                continue;
            }
            let Some((ends, nearness)) = self.placed(edge.ends.map(|vertex| corners[vertex as usize])) else {
                continue;
            };
            let segment = Segment { from: ends[0], to: ends[1], width: f64::from(object.edges.width) };
            self.draw(&Line { object, edge: &edge, segment, nearness }, coverage);
        }
    }

    fn is_drawn(&self, object: &EdgedObject, edge: &MeshEdge, corners: &[DVec3]) -> bool {
        let is_outline = || edge.is_border() || self.is_silhouette(object, edge, corners);
        match object.edges.which {
            WhichEdges::All => true,
            WhichEdges::Feature(angle) => edge.angle >= angle || is_outline(),
            WhichEdges::Boundary => edge.is_border(),
            WhichEdges::Silhouette => is_outline(),
        }
    }

    /// Whether one of its triangles faces the camera and the other does not.
    fn is_silhouette(&self, object: &EdgedObject, edge: &MeshEdge, corners: &[DVec3]) -> bool {
        let [first, second] = edge.triangles.map(|triangle| {
            let [a, b, c] =
                object.mesh.indices().as_chunks::<3>().0[triangle as usize].map(|vertex| corners[vertex as usize]);
            (b - a).cross(c - a).dot(DVec3::from(self.lens().sight(a.to_array())))
        });
        // A triangle that is seen from its side faces nobody.
        (first < 0.0) != (second < 0.0)
    }

    /// The part of an edge before the camera, on the picture; `None` where there is none.
    fn placed(&self, ends: [DVec3; 2]) -> Option<([DVec2; 2], [f64; 2])> {
        let [a, b] = ends.map(|end| -end.z);
        let near = self.lens().near;
        let cut = |inside: DVec3, outside: DVec3| {
            let share = (-inside.z - near) / (outside.z - inside.z);
            inside + share * (outside - inside)
        };
        let ends = match (a >= near, b >= near) {
            (true, true) => ends,
            (true, false) => [ends[0], cut(ends[0], ends[1])],
            (false, true) => [cut(ends[1], ends[0]), ends[1]],
            (false, false) => return None,
        };
        let size = self.size().as_dvec2();
        let at = ends.map(|end| {
            let [x, y, _, w] = self.lens().clip_from_eye(end.to_array());
            DVec2::new(0.5 + 0.5 * x / w, 0.5 - 0.5 * y / w) * size
        });
        let is_finite = at.iter().all(|end| end.is_finite());
        is_finite.then(|| (at, ends.map(|end| self.lens().unfitted_nearness(-end.z))))
    }

    /// Adds a line to the coverage of pixels. Where lines of one colour meet, the larger coverage counts.
    fn draw(&self, line: &Line, coverage: &mut [f32]) {
        let length = (line.segment.to - line.segment.from).length();
        line.segment.each(self.size(), |Reached { x, y, coverage: share, along }| {
            let there = &mut coverage[(y * self.size().x + x) as usize];
            if share as f32 <= *there {
                return;
            }
            let is_dash = || (along * length) % (DASH[0] + DASH[1]) < DASH[0];
            let shows = self.is_visible(line, along) || line.object.edges.hidden == HiddenEdges::Dash && is_dash();
            if shows {
                *there = share as f32;
            }
        });
    }

    /// Whether no surface lies before a point of the line.
    ///
    /// It is seen where its pixel or one beside it shows a triangle of the edge, something that lies farther away, or
    /// nothing: at a silhouette the pixel itself may show either side. In its pixel, the plane of the surface counts.
    fn is_visible(&self, line: &Line, along: f64) -> bool {
        let at = line.segment.from.lerp(line.segment.to, along);
        let pixel = at.floor().as_ivec2().clamp(IVec2::ZERO, self.size().as_ivec2() - 1);
        let nearness = line.nearness[0] + along * (line.nearness[1] - line.nearness[0]);
        let depth = self.lens().depth_at(nearness);
        // Nearer by a quarter of a pixel, so that an edge is not hidden by its own surface.
        let depth = depth - 0.25 * self.lens().pixel_size(depth, self.size().as_dvec2().to_array());
        AROUND.into_iter().any(|step| {
            let [x, y] = (pixel + step).to_array();
            let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return false };
            if x >= self.size().x || y >= self.size().y {
                return false;
            }
            let Some((entity, triangle)) = self.surfaces.number_at(x, y) else { return true };
            if entity == line.object.entity && line.edge.triangles.contains(&triangle) {
                return true;
            }
            let Some(seen) = self.surfaces.at(x, y) else { return true };
            depth <= if step == IVec2::ZERO { self.plane_depth(&seen, at) } else { seen.depth }
        })
    }

    /// The depth of a surface's plane on the ray through a point of the picture, or of the surface if that lies farther.
    fn plane_depth(&self, seen: &SurfacePoint, at: DVec2) -> f64 {
        let middle = at / self.size().as_dvec2();
        let ray = self.lens().ray([2.0 * middle.x - 1.0, 1.0 - 2.0 * middle.y]);
        let [origin, direction] = [ray.origin, ray.direction].map(DVec3::from);
        let normal = self.surfaces.in_eye_space(seen.face_normal);
        let on_plane = self.surfaces.eye_from_world().transform_point3(seen.position);
        let depth = normal.dot(on_plane - origin) / normal.dot(direction);
        if depth.is_finite() { depth.max(seen.depth) } else { seen.depth }
    }
}

/// A pixel, and those beside it.
const AROUND: [IVec2; 9] = [
    IVec2::ZERO,
    IVec2::new(-1, 0),
    IVec2::new(1, 0),
    IVec2::new(0, -1),
    IVec2::new(0, 1),
    IVec2::new(-1, -1),
    IVec2::new(1, -1),
    IVec2::new(-1, 1),
    IVec2::new(1, 1),
];

/// Lays a colour over a picture: coverage · opacity of it, in linear light.
fn lay_over(picture: &mut Picture, coverage: &[f32], edges: &Edges, encoding: Encoding) {
    let (LinearRgba { red, green, blue, .. }, opacity) = (edges.color, edges.opacity);
    let ink = [red, green, blue];
    match picture {
        Picture::Float(image) => {
            for (pixel, &share) in image.pixels_mut().zip(coverage) {
                let share = share * opacity;
                if share > 0.0 {
                    let [r, g, b, a] = pixel.0;
                    let mixed = [0, 1, 2].map(|c| [r, g, b][c] + share * (ink[c] - [r, g, b][c]));
                    pixel.0 = [mixed[0], mixed[1], mixed[2], a + share * (1.0 - a)];
                }
            }
        }
        Picture::Byte(image) => {
            let decoded: [f64; 256] = std::array::from_fn(|byte| encoding.decode(byte as f64 / 255.0));
            for (pixel, &share) in image.pixels_mut().zip(coverage) {
                let share = f64::from(share * opacity);
                if share > 0.0 {
                    for (channel, ink) in pixel.0.iter_mut().zip(ink) {
                        let before = decoded[usize::from(*channel)];
                        let mixed = before + share * (f64::from(ink).min(1.0) - before);
                        *channel = (encoding.encode(mixed) * 255.0).round() as u8;
                    }
                    let alpha = f64::from(pixel.0[3]);
                    pixel.0[3] = (alpha + share * (255.0 - alpha)).round() as u8;
                }
            }
        }
    }
}
