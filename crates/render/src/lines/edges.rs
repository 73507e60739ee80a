//! Lines along the edges of meshes.

use crate::lines::drawing::{Drawing, Placed, Sight, is_dash};
use crate::lines::mix::lay_over;
use crate::lines::segment::{Reached, Segment};
use crate::picture::Picture;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_platform::collections::HashMap;
use bevy_transform::components::GlobalTransform;
use halfway_asset::{AssetId, Assets};
use halfway_frame::error::{RenderError, label};
use halfway_lighting::{Camera, Cameras, Edges, Encoding, HiddenEdges, Shown, WhichEdges};
use halfway_mesh::{Mesh, Mesh3d, MeshEdge, SpawnOrder};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Draws the edges of all these objects.
pub(super) fn draw(picture: &mut Picture, drawing: &Drawing, objects: &[EdgedObject], encoding: Encoding) {
    for same in objects.chunk_by(|a, b| a.edges == b.edges) {
        let mut coverage = vec![0.0_f32; drawing.size().element_product() as usize];
        for object in same {
            drawing.add_edges(object, &mut coverage);
        }
        let Edges { color, opacity, .. } = same[0].edges;
        let ink = [color.red, color.green, color.blue];
        lay_over(picture, encoding, coverage.iter().map(|share| (ink, share * opacity)));
    }
}

pub(super) struct EdgedObject {
    entity: Entity,
    edges: Edges,
    mesh: Mesh,
    all: Arc<[MeshEdge]>,
    transform: GlobalTransform,
}

/// The edges of meshes, with the meshes that they were made for.
#[derive(Resource, Default)]
struct KnownEdges(HashMap<AssetId<Mesh>, (Mesh, Arc<[MeshEdge]>)>);

impl KnownEdges {
    fn find(&mut self, id: AssetId<Mesh>, mesh: &Mesh) -> Arc<[MeshEdge]> {
        match self.0.get(&id) {
            Some((known, edges)) if known.is_clone_of(mesh) => edges.clone(),
            _ => {
                let edges: Arc<[MeshEdge]> = mesh.edges().into();
                self.0.insert(id, (mesh.clone(), edges.clone()));
                edges
            }
        }
    }
}

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

type Data<'w, 's> = (
    Objects<'w, 's>,
    Query<'w, 's, &'static Edges, With<Camera>>,
    Cameras<'w, 's>,
    Shown<'w, 's>,
    Res<'w, Assets<Mesh>>,
);

/// The shown objects with edges of their own or the camera's, in spawn order.
pub(super) fn edged_objects(world: &mut World) -> Result<Vec<EdgedObject>, RenderError> {
    let mut known = world.remove_resource::<KnownEdges>().unwrap_or_default();
    let mut state = bevy_ecs::system::SystemState::<Data>::new(world);
    let (objects, of_cameras, cameras, shown, meshes) = state.get(world).map_err(|_| RenderError::NoPicture)?;
    let of_camera = cameras.current().ok().and_then(|camera| of_cameras.get(camera).ok());
    let is_shown = shown.by_entity();
    let mut found = Vec::new();
    for (entity, handle, transform, order, own, name) in &objects {
        let (Some(edges), Some(mesh)) = (own.or(of_camera), meshes.get(&handle.0)) else { continue };
        if is_shown(entity) && transform.affine().is_finite() {
            let invalid = |source| RenderError::Invalid { entity: label(entity, name), source };
            edges.validate().map_err(invalid)?;
            let all = known.find(handle.0.id(), mesh);
            let (mesh, transform) = (mesh.clone(), *transform);
            found.push((*order, EdgedObject { entity, edges: *edges, mesh, all, transform }));
        }
    }
    known.0.retain(|id, _| meshes.contains(*id));
    found.sort_unstable_by_key(|&(order, _)| order);
    drop((is_shown, meshes));
    world.insert_resource(known);
    Ok(found.into_iter().map(|(_, object)| object).collect())
}

/// An edge on the picture.
#[derive(Clone, Copy)]
struct Line {
    triangles: [u32; 2],
    segment: Segment,
    /// Of its ends; see [`Lens::unfitted_nearness`].
    nearness: [f64; 2],
}

/// The most edges that are placed on the picture at a time.
const MOST_LINES: usize = 1 << 16;

/// The bands of rows that are drawn at once.
const BANDS: u32 = 32;

impl Drawing<'_> {
    fn add_edges(&self, object: &EdgedObject, coverage: &mut [f32]) {
        let world_from_model = crate::quantities::world_from_model(&object.transform);
        let eye_from_model = self.eye_from_world() * world_from_model;
        let at_eye = |p: &Vec3| eye_from_model.transform_point3(p.as_dvec3());
        let corners: Vec<DVec3> = object.mesh.positions().par_iter().with_min_len(4096).map(at_eye).collect();
        let (size, number) = (self.size(), self.number_of(object.entity));
        let height = size.y.div_ceil(BANDS);
        for edges in object.all.chunks(MOST_LINES) {
            let placed = edges.par_iter().with_min_len(1024).filter_map(|edge| self.line(object, edge, &corners));
            let lines: Vec<Line> = placed.collect();
            let mut of_bands = vec![Vec::new(); BANDS as usize];
            for line in lines {
                let Range { start, end } = line.segment.rows(size.y);
                for band in start / height..end.div_ceil(height) {
                    of_bands[band as usize].push(line);
                }
            }
            let in_bands = coverage.par_chunks_mut((height * size.x) as usize).zip(&of_bands).enumerate();
            in_bands
                .with_min_len(BANDS as usize / (4 * rayon::current_num_threads()).min(BANDS as usize))
                .for_each_init(
                    || Sight::new(self),
                    |sight, (band, (coverage, lines))| {
                        let first = band as u32 * height;
                        for line in lines {
                            sight.draw_edge((object, number), line, first, coverage);
                        }
                    },
                );
        }
    }

    /// The edge where it is on the picture, if it is one that is drawn.
    fn line(&self, object: &EdgedObject, edge: &MeshEdge, corners: &[DVec3]) -> Option<Line> {
        if !self.is_drawn(object, edge, corners) {
            return None;
        }
        let Placed { ends, nearness, .. } = self.placed(edge.ends.map(|vertex| corners[vertex as usize]))?;
        let widths = nearness.map(|nearness| self.in_pixels(object.edges.width, nearness));
        let segment = Segment { from: ends[0], to: ends[1], widths };
        Some(Line { triangles: edge.triangles, segment, nearness })
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
}

impl Sight<'_> {
    /// Adds a line to the coverage of the rows from `first` on. Where lines of one colour meet, the larger coverage counts.
    fn draw_edge(&self, (object, number): (&EdgedObject, Option<u32>), line: &Line, first: u32, coverage: &mut [f32]) {
        let width = self.drawing.size().x;
        let rows = first..first + coverage.len() as u32 / width;
        let length = (line.segment.to - line.segment.from).length();
        line.segment.each(width, &rows, |Reached { x, y, coverage: share, along }| {
            let there = &mut coverage[((y - first) * width + x) as usize];
            if share as f32 <= *there {
                return;
            }
            let dashes = object.edges.hidden == HiddenEdges::Dash;
            let shows = self.shows_edge(number, line, along) || dashes && is_dash(along * length);
            if shows {
                *there = share as f32;
            }
        });
    }

    /// Whether a point of the line is seen: where one of the edge's own triangles is, too. Objects that no pixel may show
    /// have no number.
    fn shows_edge(&self, number: Option<u32>, line: &Line, along: f64) -> bool {
        let at = line.segment.from.lerp(line.segment.to, along);
        let nearness = line.nearness[0] + along * (line.nearness[1] - line.nearness[0]);
        self.sees(at, self.drawing.lens().depth_at(nearness), number.map(|number| (number, line.triangles)))
    }
}
