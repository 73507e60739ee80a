//! Which objects come so near to a part of another that coarser triangles could change which of them hides which.
//!
//! A tolerance lets points move by its pixels, in whatever direction, so also in depth. Where two surfaces are nearer
//! to each other than both may move, the farther one could show in place of the nearer one, which no motion by that
//! many pixels explains. So a group of patches keeps its triangles where the box and the sphere around another object
//! come that near to the sphere around it. What is finer has a smaller sphere in that one and moves less, so that it
//! may be drawn where the group may.
//!
//! Objects are found by where they are, in grids that are made in the first place of a frame that asks for them.

use crate::geometry::outlines::Outline;
use crate::view::camera::View;
use crate::view::matrices::ModelView;
use bevy_math::{Affine3A, Vec3, Vec3A};
use halfway_mesh::Bounds;

/// A box and a sphere around an object, in eye space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObjectBox {
    center: Vec3A,
    /// Of unit length and perpendicular; zero where the object is flat.
    axes: [Vec3A; 3],
    /// How far it reaches along each.
    half: Vec3A,
    radius: f32,
    /// By how many pixels its points may move.
    pixels: f32,
}

impl ObjectBox {
    /// Of what is not drawn.
    pub(crate) const NOWHERE: Self =
        Self { center: Vec3A::ZERO, axes: Vec3A::AXES, half: Vec3A::ZERO, radius: f32::NEG_INFINITY, pixels: 0.0 };

    /// Around an object of which no point is farther than `radius` from the middle of its bounds.
    pub(crate) fn new(bounds: &Bounds, radius: f32, model_view: &ModelView, pixels: f32) -> Self {
        let Affine3A { matrix3: m, translation } = model_view.eye_from_model;
        let center = m * Vec3A::from(bounds.center()) + translation;
        let half = 0.5 * Vec3A::from(bounds.max - bounds.min);
        let columns = [m.x_axis, m.y_axis, m.z_axis];
        let lengths = columns.map(Vec3A::length);
        let axes = columns.map(Vec3A::normalize_or_zero);
        let [x, y, z] = axes;
        let radius = radius * model_view.largest_scale();
        if [x.dot(y), y.dot(z), z.dot(x)].iter().any(|cosine| cosine.abs() > 1e-4) {
            // Sheared: the box around its sphere.
            return Self { center, axes: Vec3A::AXES, half: Vec3A::splat(radius), radius, pixels };
        }
        Self { center, axes, half: half * Vec3A::from_array(lengths), radius, pixels }
    }

    /// How far a point is from the object at least; 0 within its box and its sphere.
    fn distance(&self, p: Vec3A) -> f32 {
        let offset = p - self.center;
        let along = Vec3A::from_array(self.axes.map(|axis| offset.dot(axis)));
        let from_box = (along.abs() - self.half).max(Vec3A::ZERO).length();
        from_box.max(offset.length() - self.radius)
    }
}

/// What rounding may add to distances, as a part of what they are the difference of.
const SLACK: f32 = 1e-5;

/// With more near objects than this, those near to each patch are looked up.
const FEW: usize = 16;

/// The visible objects of a frame, by where they are: in grids whose cells are powers of two, each object in that with
/// the smallest cells that are no smaller than it.
#[derive(Debug, Default)]
pub(crate) struct NearObjects {
    is_made: bool,
    /// In the order of the visible objects.
    boxes: Vec<ObjectBox>,
    /// By how many pixels any of them moves at most.
    pixels: f32,
    /// Each grid with the number of its objects.
    grids: Vec<(Grid, usize)>,
    /// Where the objects of each bucket of cells begin; one more at the end.
    starts: Vec<u32>,
    objects: Vec<(Cell, u32)>,
    /// The object that was asked for last, and those that come near to it.
    asked: Option<u32>,
    near: Vec<u32>,
    near_patch: Vec<u32>,
}

/// A grid of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Grid {
    cell: f32,
    per_cell: f32,
}

/// A cell of a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Cell {
    at: [i32; 3],
    /// Of the grid.
    size: f32,
}

impl Grid {
    /// That of an object of this radius: its cells are no smaller than the object, and less than twice as large.
    fn of(radius: f32) -> Self {
        // The fraction's bits carry into the exponent unless they are 0.
        let fraction = 0x007F_FFFF;
        let cell = f32::from_bits(((2.0 * radius).clamp(1e-30, 1e30).to_bits() + fraction) & !fraction);
        Self { cell, per_cell: cell.recip() }
    }

    /// The cell of a point; of one beyond all numbers, the last one.
    fn cell(self, p: Vec3A) -> Cell {
        let Vec3 { x, y, z } = (p * self.per_cell).floor().into();
        Cell { at: [x as i32, y as i32, z as i32], size: self.cell }
    }

    /// The first and the last cell of objects that may reach into a sphere.
    fn around(self, center: Vec3A, radius: f32) -> [[i32; 3]; 2] {
        let reach = Vec3A::splat(radius + 0.5 * self.cell);
        [center - reach, center + reach].map(|corner| self.cell(corner).at)
    }
}

impl Cell {
    fn bucket(self, buckets: usize) -> usize {
        let [x, y, z] = self.at.map(|at| at as u32);
        let mixed = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ z.wrapping_mul(0xC2B2_AE3D);
        let mixed = (mixed ^ self.size.to_bits()).wrapping_mul(0x27D4_EB2F);
        (mixed >> 7) as usize & (buckets - 1)
    }
}

/// An object that is to be drawn coarser.
#[derive(Clone, Copy)]
pub(crate) struct CoarserObject<'a> {
    /// Its number among the visible ones.
    pub(crate) number: u32,
    pub(crate) model_view: &'a ModelView,
    pub(crate) view: &'a View,
    /// By how many pixels its points may move.
    pub(crate) pixels: f32,
}

impl NearObjects {
    /// Begins a frame.
    pub(crate) fn begin(&mut self) {
        self.is_made = false;
        self.asked = None;
    }

    /// Whether another object comes so near to a patch whose points move by `error`, in the mesh's units, that the
    /// order of both could turn. `boxes` are those of all visible objects, which are asked for once in a frame.
    pub(crate) fn is_near<I: Iterator<Item = ObjectBox>>(
        &mut self,
        object: &CoarserObject,
        patch: &Outline,
        error: f32,
        boxes: impl FnOnce() -> I,
    ) -> bool {
        let &CoarserObject { number, model_view, view, pixels } = object;
        // What does not move hides what it hid; the other one sees to itself.
        if error <= 0.0 {
            return false;
        }
        if !self.is_made {
            self.make(boxes());
        }
        if self.asked != Some(number) {
            let of = self.boxes[number as usize];
            let reach = of.radius + moved(view, pixels + self.pixels, of.center.into(), of.radius);
            let mut near = std::mem::take(&mut self.near);
            self.find(number, of.center, with_slack(reach, of.center), &mut near);
            (self.asked, self.near) = (Some(number), near);
        }
        if self.near.is_empty() {
            return false;
        }
        let (center, radius) = patch.sphere(model_view);
        let center = Vec3A::from(center);
        let radius = radius + error * model_view.largest_scale();
        let moved = |pixels: f32| with_slack(radius + moved(view, pixels, center.into(), radius), center);
        let is_near = |&other: &u32| {
            let other = &self.boxes[other as usize];
            other.distance(center) <= moved(other.pixels)
        };
        if self.near.len() <= FEW {
            return self.near.iter().any(is_near);
        }
        let mut near = std::mem::take(&mut self.near_patch);
        self.find(number, center, moved(self.pixels), &mut near);
        let found = near.iter().any(is_near);
        self.near_patch = near;
        found
    }

    fn make(&mut self, boxes: impl Iterator<Item = ObjectBox>) {
        let Self { boxes: all, grids, starts, objects, .. } = self;
        self.is_made = true;
        all.clear();
        all.extend(boxes);
        let drawn = || (0..).zip(&*all).filter(|(_, of)| of.radius >= 0.0);
        self.pixels = drawn().map(|(_, of)| of.pixels).fold(0.0, f32::max);
        grids.clear();
        let buckets = all.len().next_power_of_two();
        starts.clear();
        starts.resize(buckets + 1, 0);
        for (_, of) in drawn() {
            let grid = Grid::of(of.radius);
            match grids.iter_mut().find(|(other, _)| *other == grid) {
                Some((_, count)) => *count += 1,
                None => grids.push((grid, 1)),
            }
            starts[grid.cell(of.center).bucket(buckets)] += 1;
        }
        let mut end = 0;
        for start in &mut *starts {
            end += *start;
            *start = end;
        }
        objects.clear();
        objects.resize(end as usize, (Cell::default(), 0));
        for (number, of) in drawn() {
            let cell = Grid::of(of.radius).cell(of.center);
            let start = &mut starts[cell.bucket(buckets)];
            *start -= 1;
            objects[*start as usize] = (cell, number);
        }
    }

    /// Finds the objects but this one whose spheres reach into a sphere.
    fn find(&self, number: u32, center: Vec3A, radius: f32, found: &mut Vec<u32>) {
        found.clear();
        let comes_near = |other: u32| {
            let of = &self.boxes[other as usize];
            other != number && of.center.distance(center) <= of.radius + radius
        };
        let ranges = || self.grids.iter().map(|&(grid, count)| (grid, grid.around(center, radius), count));
        let cells = |[low, high]: [[i32; 3]; 2]| -> f64 {
            (0..3).map(|axis| f64::from(high[axis]) - f64::from(low[axis]) + 1.0).product()
        };
        if ranges().any(|(_, range, count)| cells(range) > (count + 27) as f64) {
            found.extend(self.objects.iter().map(|&(_, other)| other).filter(|&other| comes_near(other)));
            return;
        }
        let buckets = self.starts.len() - 1;
        for (grid, [low, high], _) in ranges() {
            for z in low[2]..=high[2] {
                for y in low[1]..=high[1] {
                    for x in low[0]..=high[0] {
                        let cell = Cell { at: [x, y, z], size: grid.cell };
                        let bucket = cell.bucket(buckets);
                        let objects = &self.objects[self.starts[bucket] as usize..self.starts[bucket + 1] as usize];
                        let near = objects.iter().filter(|(of, other)| *of == cell && comes_near(*other));
                        found.extend(near.map(|&(_, other)| other));
                    }
                }
            }
        }
    }
}

fn with_slack(reach: f32, center: Vec3A) -> f32 {
    reach + SLACK * (center.length() + reach)
}

/// How far points move at most, in eye space, that move by this many pixels to where they are in a sphere, or come from
/// there.
fn moved(view: &View, pixels: f32, center: Vec3, radius: f32) -> f32 {
    // At a depth z, by no more than a part of z.
    let part = pixels / view.pixels_at_unit_depth;
    if part < 1.0 { (radius - center.z).max(0.0) * part / (1.0 - part) } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_math::{DAffine3, EulerRot, Mat3, Mat3A, Quat};
    use halfway_mesh::{Mesh, UvSphere};

    fn placed(Affine3A { matrix3, translation }: Affine3A) -> ModelView {
        let translation = Vec3::from(translation).as_dvec3();
        ModelView::new(&DAffine3::from_mat3_translation(Mat3::from(matrix3).as_dmat3(), translation))
    }

    fn view() -> View {
        View { pixels_at_unit_depth: 100.0, ..View::default() }
    }

    fn random(seed: &mut u32) -> f32 {
        *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (*seed >> 8) as f32 / 16_777_216.0
    }

    /// The grids find what looking at all boxes finds, of objects of many sizes.
    #[test]
    fn what_the_grids_find_is_what_is_there() {
        let mesh = Mesh::from(UvSphere::new(1.0, 8, 4));
        let patch = Outline::whole(&mesh);
        let view = view();
        let mut seed = 7;
        for count in [1, 2, 9, 70, 700] {
            let places: Vec<ModelView> = (0..count)
                .map(|_| {
                    let at = Vec3::new(random(&mut seed) - 0.5, random(&mut seed) - 0.5, random(&mut seed) - 2.0) * 8.0;
                    let turned = Quat::from_euler(EulerRot::XYZ, 6.0 * random(&mut seed), random(&mut seed), 0.0);
                    let size = 0.05 * (2.0 + 5.0 * random(&mut seed)).exp2() * 0.25;
                    placed(Affine3A::from_scale_rotation_translation(Vec3::splat(size), turned, at))
                })
                .collect();
            let boxes: Vec<_> = places.iter().map(|at| ObjectBox::new(&mesh.bounds(), 1.0, at, 0.5)).collect();
            let mut near = NearObjects::default();
            let (mut found, mut asked, mut crowded) = (0, 0, 0);
            for (number, model_view) in places.iter().enumerate() {
                let object = CoarserObject { number: number as u32, model_view, view: &view, pixels: 0.5 };
                let boxes_again = || {
                    asked += 1;
                    boxes.iter().copied()
                };
                let is_near = near.is_near(&object, &patch, 0.01, boxes_again);
                let (center, radius) = patch.sphere(model_view);
                let error = 0.01 * model_view.largest_scale();
                let reach = radius + error + moved(&view, 0.5, center, radius + error);
                let distance = |other: &ObjectBox| other.distance(center.into());
                let expected = (0..).zip(&boxes).any(|(other, of)| other != number && distance(of) <= reach);
                assert_eq!(is_near, expected, "{number} of {count}");
                found += u32::from(is_near);
                crowded += u32::from(near.near.len() > FEW);
            }
            assert_eq!(asked, 1, "boxes are asked for once");
            assert!(count < 70 || found > count / 10, "{found} of {count}");
            // Of some objects all near ones are looked at, of others those near to the patch.
            assert!(count < 700 || (crowded > 0 && crowded < count), "{crowded} of {count} have many near");
        }
    }

    #[test]
    fn cells_are_powers_of_two_no_smaller_than_objects() {
        for (radius, cell) in [(1.0, 2.0), (1.00001, 4.0), (0.99999, 2.0), (0.3, 1.0), (0.25, 0.5), (1000.0, 2048.0)] {
            assert_eq!(Grid::of(radius), Grid { cell, per_cell: 1.0 / cell }, "{radius}");
        }
        let [least, most] = [0.0, f32::MAX].map(|radius| Grid::of(radius).cell);
        assert!(least > 0.0 && least < 1e-29 && most >= 1e30 && most.is_finite());
        let far = Grid::of(0.0).cell(Vec3A::new(f32::MAX, -1.0, f32::NEG_INFINITY)).at;
        assert_eq!(far[0], i32::MAX, "beyond all numbers");
    }

    #[test]
    fn boxes_are_as_far_as_they_are() {
        let bounds = Bounds { min: Vec3::new(-1.0, 0.0, -2.0), max: Vec3::new(1.0, 0.5, 2.0) };
        let turned = Quat::from_rotation_y(0.5);
        let at = Vec3::new(3.0, -1.0, -8.0);
        let floor = placed(Affine3A::from_scale_rotation_translation(Vec3::new(2.0, 1.0, 3.0), turned, at));
        let of = ObjectBox::new(&bounds, bounds.radius(), &floor, 0.0);
        let distance = |p: Vec3| of.distance((at + turned * p).into());
        for (p, expected) in [
            (Vec3::new(0.0, 0.25, 0.0), 0.0),
            (Vec3::new(2.0, 0.5, -6.0), 0.0),
            (Vec3::new(0.0, 1.5, 5.0), 1.0),
            (Vec3::new(2.3, 0.9, 0.0), 0.5),
            (Vec3::new(0.0, -0.25, 7.0), 17.0_f32.sqrt() * 0.25),
        ] {
            assert!((distance(p) - expected).abs() < 1e-5, "{p}: {}", distance(p));
        }
        // Sheared, it is as near as its sphere at least.
        let sheared = Mat3A::from_cols(Vec3A::X, Vec3A::new(0.7, 1.0, 0.0), Vec3A::Z);
        let of = ObjectBox::new(
            &bounds,
            bounds.radius(),
            &placed(Affine3A { matrix3: sheared, translation: at.into() }),
            0.0,
        );
        assert!(of.distance((at + Vec3::new(1.1, 0.5, 2.0)).into()) <= 0.0);
    }

    /// What does not move is drawn coarser however near another is; what moves, where the other is farther than both
    /// move.
    #[test]
    fn a_patch_is_near_within_what_both_move() {
        let mesh = Mesh::from(UvSphere::new(1.0, 8, 4));
        let patch = Outline::whole(&mesh);
        let view = view();
        let at = |x: f32| placed(Affine3A::from_translation(Vec3::new(x, 0.0, -10.0)));
        let near = |apart: f32, error: f32, pixels: f32| {
            let places = [at(0.0), at(apart)];
            let object = CoarserObject { number: 0, model_view: &places[0], view: &view, pixels: 1.0 };
            let boxes = || places.iter().map(|at| ObjectBox::new(&mesh.bounds(), 1.0, at, pixels));
            NearObjects::default().is_near(&object, &patch, error, boxes)
        };
        assert!(near(2.0, 0.01, 0.0) && near(2.009, 0.01, 0.0) && !near(2.012, 0.01, 0.0));
        // At a depth of 11 a pixel is 0.11 of a unit, and 0.1111 of one that comes from behind.
        assert!(near(2.11, 0.01, 1.0) && near(2.121, 0.01, 1.0) && !near(2.125, 0.01, 1.0));
        assert!(!near(1.0, 0.0, 1.0));
    }
}
