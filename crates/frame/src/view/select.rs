//! Select: what the frustum sees, with its matrices.

use crate::error::{RenderError, bad_transform, label};
use crate::report::FrameReport;
use crate::view::camera::View;
use crate::view::looks::{Look, Looks, any_newer};
use crate::view::matrices::{Lengths, MatricesOf, ModelView, NormalMatrix, compose, is_flat_twice};
use bevy_ecs::change_detection::{ContiguousComponentTicksMut, ContiguousMut, ContiguousRef, Tick};
use bevy_ecs::prelude::*;
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_lighting::{Camera, Edges, Lens, Shown};
use halfway_mesh::{Mesh, Mesh3d, SpawnOrder};
use rayon::prelude::*;
use std::ops::Range;

/// The objects that are not [hidden](halfway_lighting::Visibility) and whose bounding sphere meets the frustum, in
/// spawn order.
/// Holds after [`RenderSet::Select`](crate::sets::RenderSet::Select).
#[derive(Resource, Clone, Debug, Default)]
pub struct Visible(pub Vec<Entity>);

/// The objects of whose looks the frame makes sure: the first visible one of each look, and all whose look is not known,
/// in spawn order. Holds after [`RenderSet::Select`](crate::sets::RenderSet::Select).
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Representatives(pub(crate) Vec<Entity>);

/// The outcome of selecting, which is kept table by table while neither the view nor the objects change.
#[derive(Resource, Debug, Default)]
pub struct Selected {
    /// Of the rows of each table in turn.
    parts: Vec<Seen>,
    /// The view that it was seen in; `None` where some objects are hidden.
    seen_in: Option<SeenIn>,
    /// The visible objects in spawn order.
    visible: Vec<(SpawnOrder, Entity, Look)>,
    /// The number of the frame, from 1 on.
    pub(crate) frame: u64,
    /// The [number of changes](Looks::changes) of looks when it was selected.
    changes: u64,
    /// By the number of a look, the last frame that had it.
    frames: Vec<u64>,
    /// Whether the visible objects, their places and their looks are those of the last frame.
    pub(crate) stands: bool,
}

/// All that decides what is seen, beside the objects.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SeenIn {
    epoch: u64,
    lens: Lens,
    /// A wireframe has no surface.
    has_surfaces: bool,
}

/// The components that decide whether an object is seen, its look, and what follows from its place.
type Objects = (
    Entity,
    Ref<'static, Mesh3d>,
    Ref<'static, GlobalTransform>,
    Ref<'static, SpawnOrder>,
    Option<Ref<'static, Edges>>,
    &'static Look,
    &'static mut ModelView,
    &'static mut NormalMatrix,
);

/// Selects the visible objects, and makes their matrices.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn select(
    mut objects: Query<Objects>,
    (cameras, names): (Query<&Edges, With<Camera>>, Query<&Name>),
    shown: Shown,
    (meshes, looks): (Res<Assets<Mesh>>, Res<Looks>),
    mut selected: ResMut<Selected>,
    mut view: ResMut<View>,
    (mut visible, mut representatives): (ResMut<Visible>, ResMut<Representatives>),
    (mut matrices_of, mut report): (ResMut<MatricesOf>, ResMut<FrameReport>),
) {
    let selected = &mut *selected;
    selected.frame += 1;
    selected.stands = false;
    if view.camera.is_none() {
        selected.seen_in = None;
        visible.0.clear();
        representatives.0.clear();
        return;
    }
    let of_camera = view.entity.and_then(|camera| cameras.get(camera).ok());
    let seen_in =
        SeenIn { epoch: view.epoch, lens: view.lens, has_surfaces: of_camera.is_none_or(|edges| edges.surface) };
    let is_shown = shown.by_entity();
    let before = std::mem::replace(&mut selected.seen_in, (!shown.hides_any()).then_some(seen_in));
    let mut keeps = selected.seen_in == before && before.is_some() && !meshes.is_changed();
    // All of the components are kept in tables.
    let Ok(tables) = objects.contiguous_iter_mut() else { return };
    let mut tables: Vec<Table> = tables.map(Table::new).collect();
    let mut parts = Vec::new();
    for table in &mut tables {
        table.cut(&mut parts);
    }
    let as_many = selected.parts.len() == parts.len();
    selected.parts.resize_with(parts.len(), Seen::default);
    if keeps && matrices_of.0 != view.epoch {
        // They are another camera's, so that all are made anew unless none is needed.
        keeps = as_many && parts.iter().zip(&selected.parts).all(|(rows, seen)| rows.are_those_of(seen));
    }
    let look_at = |(rows, seen): (&mut Rows, &mut Seen)| {
        seen.is_kept = keeps && rows.are_those_of(seen);
        if seen.is_kept {
            seen.matrices = 0;
        } else {
            rows.see(seen, (&seen_in, &view), &meshes, &is_shown);
        }
    };
    if parts.len() < PARTS_FOR_THREADS {
        parts.iter_mut().zip(&mut selected.parts).for_each(look_at);
    } else {
        parts.par_iter_mut().zip(&mut selected.parts).for_each(look_at);
    }
    let mut stands = as_many && selected.parts.iter().all(|seen| seen.is_kept);
    if !stands {
        matrices_of.0 = view.epoch;
    }
    selected.report(&names, &mut view, &mut report);
    stands &=
        selected.changes == looks.changes && visible.0.iter().eq(selected.visible.iter().map(|(_, object, _)| object));
    selected.stands = stands;
    if !stands {
        selected.changes = looks.changes;
        selected.list(&parts, &looks, (&mut visible.0, &mut representatives.0));
    }
    report.visible = visible.0.len() as u32;
}

impl Selected {
    /// Sums up what the parts have seen.
    fn report(&self, names: &Query<&Name>, view: &mut View, report: &mut FrameReport) {
        let mut farthest = 0.0;
        let mut depths = [f64::INFINITY, f64::NEG_INFINITY];
        for seen in &self.parts {
            report.objects += seen.objects;
            report.matrices += seen.matrices;
            for (entity, refused) in &seen.refused {
                let name = names.get(*entity).ok();
                report.errors.push(match refused {
                    Refused::MissingMesh => RenderError::MissingMesh { entity: label(*entity, name) },
                    Refused::Transform(transform) => bad_transform(*entity, name, transform),
                });
            }
            farthest = f64::max(farthest, seen.farthest);
            depths = [depths[0].min(seen.depths[0]), depths[1].max(seen.depths[1])];
        }
        view.unit_exponent = unit_exponent(farthest);
        view.lens = view.lens.fitted(depths.map(|depth| depth as f32));
    }

    /// Lists the visible objects and their representatives.
    fn list(
        &mut self,
        parts: &[Rows],
        looks: &Looks,
        (visible, representatives): (&mut Vec<Entity>, &mut Vec<Entity>),
    ) {
        self.visible.clear();
        for (rows, seen) in parts.iter().zip(&self.parts) {
            let object = |&row: &u32| {
                let row = row as usize;
                (rows.orders[row], rows.entities[row], rows.looks[row])
            };
            self.visible.extend(seen.rows.iter().map(object));
        }
        self.visible.sort_unstable_by_key(|&(order, entity, _)| (order, entity));
        visible.clear();
        representatives.clear();
        for &(_, entity, look) in &self.visible {
            visible.push(entity);
            let Some(number) = looks.known(look) else {
                representatives.push(entity);
                continue;
            };
            if self.frames.len() <= number as usize {
                self.frames.resize(number as usize + 1, 0);
            }
            if std::mem::replace(&mut self.frames[number as usize], self.frame) != self.frame {
                representatives.push(entity);
            }
        }
    }
}

/// So many objects of a table are looked at by one thread, and not at all while none of them changes.
const ROWS: usize = 1024;

/// From so many parts on, threads share them.
const PARTS_FOR_THREADS: usize = 4;

/// Objects that follow one another in a table.
struct Rows<'a> {
    entities: &'a [Entity],
    meshes: &'a [Mesh3d],
    transforms: &'a [GlobalTransform],
    orders: &'a [SpawnOrder],
    edges: Option<&'a [Edges]>,
    looks: &'a [Look],
    model_views: Written<'a, ModelView>,
    normal_matrices: Written<'a, NormalMatrix>,
    /// Whether a component that decides what is seen has changed.
    have_changed: bool,
}

/// Components that are written, each with the tick of its last change, and the tick of now.
struct Written<'a, T> {
    values: &'a mut [T],
    changed: &'a mut [Tick],
    now: Tick,
}

impl<'a, T> Written<'a, T> {
    fn new((values, ticks): &'a mut (&mut [T], ContiguousComponentTicksMut)) -> Self {
        let now = ticks.this_run();
        Self { values, changed: ticks.changed_mut(), now }
    }

    /// Splits the first rows off.
    fn split(&mut self, count: usize) -> Self {
        let Self { values, changed, now } = self;
        let (values, changed) = (values.split_off_mut(..count), changed.split_off_mut(..count));
        Self { values: values.unwrap_or_default(), changed: changed.unwrap_or_default(), now: *now }
    }

    fn set(&mut self, row: usize, value: T) {
        self.values[row] = value;
        self.changed[row] = self.now;
    }
}

/// The components of a table's objects.
type ComponentsOf<'w> = (
    &'w [Entity],
    ContiguousRef<'w, Mesh3d>,
    ContiguousRef<'w, GlobalTransform>,
    ContiguousRef<'w, SpawnOrder>,
    Option<ContiguousRef<'w, Edges>>,
    &'w [Look],
    ContiguousMut<'w, ModelView>,
    ContiguousMut<'w, NormalMatrix>,
);

/// All objects of a table.
struct Table<'w> {
    entities: &'w [Entity],
    meshes: ContiguousRef<'w, Mesh3d>,
    transforms: ContiguousRef<'w, GlobalTransform>,
    orders: ContiguousRef<'w, SpawnOrder>,
    edges: Option<ContiguousRef<'w, Edges>>,
    looks: &'w [Look],
    model_views: (&'w mut [ModelView], ContiguousComponentTicksMut<'w>),
    normal_matrices: (&'w mut [NormalMatrix], ContiguousComponentTicksMut<'w>),
}

impl<'w> Table<'w> {
    fn new(components: ComponentsOf<'w>) -> Self {
        let (entities, meshes, transforms, orders, edges, looks, model_views, normal_matrices) = components;
        let model_views = ContiguousMut::bypass_change_detection_split(model_views);
        let normal_matrices = ContiguousMut::bypass_change_detection_split(normal_matrices);
        Self { entities, meshes, transforms, orders, edges, looks, model_views, normal_matrices }
    }

    /// Cuts it into parts.
    fn cut<'a>(&'a mut self, parts: &mut Vec<Rows<'a>>)
    where
        'w: 'a,
    {
        let mut model_views = Written::new(&mut self.model_views);
        let mut normal_matrices = Written::new(&mut self.normal_matrices);
        let count = self.entities.len();
        for start in (0..count).step_by(ROWS) {
            let rows = start..count.min(start + ROWS);
            let edges = self.edges.as_ref();
            parts.push(Rows {
                entities: &self.entities[rows.clone()],
                meshes: &self.meshes[rows.clone()],
                transforms: &self.transforms[rows.clone()],
                orders: &self.orders[rows.clone()],
                edges: edges.map(|edges| &edges[rows.clone()]),
                looks: &self.looks[rows.clone()],
                model_views: model_views.split(rows.len()),
                normal_matrices: normal_matrices.split(rows.len()),
                have_changed: have_changed(&self.meshes, &rows)
                    || have_changed(&self.transforms, &rows)
                    || have_changed(&self.orders, &rows)
                    || edges.is_some_and(|edges| have_changed(edges, &rows)),
            });
        }
    }
}

/// Whether a component of some rows has changed since the last frame.
fn have_changed<T>(of: &ContiguousRef<T>, rows: &Range<usize>) -> bool {
    let (last, now) = (of.last_run_tick(), of.this_run_tick());
    any_newer(&of.changed_ticks_slice()[rows.clone()], last, now)
}

/// The outcome for some rows.
#[derive(Debug, Default)]
struct Seen {
    /// The objects of the rows when they were looked at.
    entities: Vec<Entity>,
    /// Whether it is that of the last frame, since nothing has changed.
    is_kept: bool,
    /// The rows of the objects that are seen.
    rows: Vec<u32>,
    refused: Vec<(Entity, Refused)>,
    /// The number of those that are not hidden.
    objects: u32,
    /// The number of matrices that were made.
    matrices: u32,
    /// The distance of the farthest point.
    farthest: f64,
    /// The least and the largest depth.
    depths: [f64; 2],
}

/// The reason why an object is not drawn.
#[derive(Clone, Copy, Debug)]
enum Refused {
    MissingMesh,
    Transform(GlobalTransform),
}

impl Seen {
    fn begin(&mut self, entities: &[Entity]) {
        self.entities.clear();
        self.entities.extend_from_slice(entities);
        self.rows.clear();
        self.refused.clear();
        (self.objects, self.matrices) = (0, 0);
        (self.farthest, self.depths) = (0.0, [f64::INFINITY, f64::NEG_INFINITY]);
    }
}

impl Rows<'_> {
    /// Whether they are the rows that were looked at, and nothing that decides what is seen has changed.
    fn are_those_of(&self, seen: &Seen) -> bool {
        !self.have_changed && seen.entities == self.entities
    }

    /// Looks at all of them, and makes the matrices of those that are seen.
    fn see(
        &mut self,
        seen: &mut Seen,
        (seen_in, view): (&SeenIn, &View),
        meshes: &Assets<Mesh>,
        is_shown: impl Fn(Entity) -> bool,
    ) {
        seen.begin(self.entities);
        for (row, (&entity, transform)) in self.entities.iter().zip(self.transforms).enumerate() {
            if !is_shown(entity) {
                continue;
            }
            seen.objects += 1;
            let has_surface = self.edges.map_or(seen_in.has_surfaces, |edges| edges[row].surface);
            if !has_surface {
                continue;
            }
            let Some(mesh) = meshes.get(&self.meshes[row].0) else {
                seen.refused.push((entity, Refused::MissingMesh));
                continue;
            };
            if mesh.triangle_count() == 0 {
                continue;
            }
            if !transform.affine().is_finite() {
                seen.refused.push((entity, Refused::Transform(*transform)));
                continue;
            }
            let eye_from_model = compose(&view.eye_from_world, transform);
            if is_flat_twice(&eye_from_model.matrix3) {
                continue;
            }
            let bounds = mesh.bounds();
            let center = eye_from_model.transform_point3(bounds.center().as_dvec3());
            let lengths = Lengths::new(&eye_from_model.matrix3);
            let radius = f64::from(bounds.radius()) * lengths.largest_scale(&eye_from_model.matrix3);
            if !view.lens.sees(center.as_vec3().to_array(), radius as f32) {
                continue;
            }
            seen.farthest = f64::max(seen.farthest, center.length() + radius);
            let [least, largest] = seen.depths;
            seen.depths = [f64::min(least, -center.z - radius), f64::max(largest, -center.z + radius)];
            seen.rows.push(row as u32);
            if !self.model_views.values[row].is_of(seen_in.epoch, transform) {
                let made = ModelView::of_object(&eye_from_model, lengths, seen_in.epoch, transform);
                self.model_views.set(row, made.0);
                self.normal_matrices.set(row, made.1);
                seen.matrices += 1;
            }
        }
    }
}

/// Of the unit in which the shaders measure a scene whose farthest visible point is at this distance: squares of
/// distances down to 10⁻¹⁷ of it, and of lights as far again beyond it, are normal numbers of f32. `SwiftShader` also
/// multiplies the depths of three corners: from 10¹² on interpolated values lose their perspective.
fn unit_exponent(farthest: f64) -> i32 {
    const MOST: i32 = 30;
    const LEAST: i32 = -40;
    let exponent = farthest.log2().ceil();
    match exponent as i32 {
        _ if !exponent.is_finite() => 0,
        large if large > MOST => MOST - large,
        small if small < LEAST => -small,
        _ => 0,
    }
}
