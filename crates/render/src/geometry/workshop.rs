//! What makes levels of detail: a thread beside the frames, or, where nobody watches them, the frame itself.

use crate::error::{RenderError, panic_message};
use crate::geometry::detail::MeshTriangles;
use bevy_asset::AssetId;
use bevy_ecs::prelude::Resource;
use bevy_platform::collections::HashMap;
use halfway_mesh::Mesh;
use halfway_raster::Pieces;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// Meshes with fewer triangles have no levels.
const FEWEST: usize = 64;

/// So many meshes are on their way at most; the others wait until some are made. A mesh that is gone by then is never
/// made: what comes and goes faster than levels are made must not pile up.
const MOST_ON_THEIR_WAY: usize = 64;

/// The meshes whose levels are asked for, and one thread that has them made, one after the other.
#[derive(Resource)]
pub(crate) struct Workshop {
    orders: HashMap<AssetId<Mesh>, Order>,
    /// The number of the frame.
    frame: u64,
    thread: Option<Thread>,
    /// How many meshes have been sent to the thread and have not come back.
    on_their_way: usize,
    make: Make,
    /// How what draws takes them, if it takes time: done with them, and not in the frame that shows them first.
    pub(crate) cut: Option<Cut>,
    /// What went wrong beside the frames, until it is reported.
    pub(crate) failures: Vec<RenderError>,
}

impl Default for Workshop {
    fn default() -> Self {
        Self::making(MeshTriangles::in_levels)
    }
}

/// Makes the levels of a mesh, unless it is told to stop.
type Make = fn(&Mesh, &AtomicBool) -> Option<MeshTriangles>;

/// Cuts triangles into the CPU's pieces, if it can.
type Cut = fn(&Mesh, &MeshTriangles) -> Option<Pieces>;

struct Order {
    source: Mesh,
    /// The frame that wanted it last.
    wanted: u64,
    state: OrderState,
}

enum OrderState {
    /// Seen in one frame, or waiting for others to be made. A picture that is drawn once needs no levels.
    Seen,
    /// On its way.
    Asked,
    Made(MeshTriangles),
    /// There is no thread to make it, or making it went wrong.
    Refused,
}

struct Thread {
    wanted: Sender<(AssetId<Mesh>, Mesh, Option<Cut>)>,
    made: Mutex<Receiver<Made>>,
    /// What it is doing is no longer wanted.
    stop: Arc<AtomicBool>,
}

/// Nobody waits for the thread to end.
impl Drop for Thread {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// A mesh and its levels, or what went wrong.
type Made = (AssetId<Mesh>, Mesh, Result<MeshTriangles, String>);

impl Workshop {
    fn making(make: Make) -> Self {
        Self {
            orders: HashMap::default(),
            frame: 0,
            thread: None,
            on_their_way: 0,
            make,
            cut: None,
            failures: Vec::new(),
        }
    }

    /// The levels of `mesh` if they are made. Asks for them if another frame has wanted them before, and then waits for
    /// them if it `waits`.
    pub(crate) fn levels(&mut self, id: AssetId<Mesh>, mesh: &Mesh, waits: bool) -> Option<&MeshTriangles> {
        if mesh.triangle_count() < FEWEST {
            return None;
        }
        let Self { orders, frame, thread, on_their_way, make, cut, failures } = self;
        let order = orders.entry(id).or_insert_with(|| Order::new(mesh, *frame));
        if !is_same(&order.source, mesh) {
            *order = Order::new(mesh, *frame);
        }
        let before = std::mem::replace(&mut order.wanted, *frame);
        if matches!(order.state, OrderState::Seen) && before < *frame && waits {
            order.state = match made(*make, *cut, mesh, &AtomicBool::new(false)) {
                Ok(triangles) => triangles.map_or(OrderState::Refused, OrderState::Made),
                Err(reason) => {
                    failures.push(no_levels(id, reason));
                    OrderState::Refused
                }
            };
        }
        if matches!(order.state, OrderState::Seen) && before < *frame && *on_their_way < MOST_ON_THEIR_WAY {
            if thread.is_none() {
                *thread = Thread::start(*make);
            }
            let asked = thread.as_ref().is_some_and(|thread| thread.wanted.send((id, mesh.clone(), *cut)).is_ok());
            order.state = if asked { OrderState::Asked } else { OrderState::Refused };
            if asked {
                *on_their_way += 1;
            } else {
                failures.push(no_levels(id, "the system gives no thread".into()));
            }
        }
        if let OrderState::Made(triangles) = &order.state { Some(triangles) } else { None }
    }

    /// Begins a frame, and takes in what has been made.
    pub(crate) fn collect(&mut self) {
        self.frame += 1;
        let Some(thread) = &self.thread else { return };
        let made = thread.made.lock().unwrap_or_else(PoisonError::into_inner);
        for (id, source, triangles) in made.try_iter() {
            self.on_their_way -= 1;
            // The asset may have got another mesh since.
            let Some(order) = self.orders.get_mut(&id).filter(|order| is_same(&order.source, &source)) else {
                continue;
            };
            order.state = match triangles {
                Ok(triangles) => OrderState::Made(triangles),
                Err(reason) => {
                    self.failures.push(no_levels(id, reason));
                    OrderState::Refused
                }
            };
        }
    }

    /// Keeps the orders of these assets, and no others.
    pub(crate) fn retain(&mut self, keep: impl Fn(AssetId<Mesh>) -> bool) {
        self.orders.retain(|&id, _| keep(id));
    }

    /// How many meshes are on order, or made.
    #[cfg(test)]
    pub(crate) fn len(&self) -> usize {
        self.orders.len()
    }

    /// How many meshes the frame wants whose levels are not made yet.
    pub(crate) fn pending(&self) -> u32 {
        let waits =
            |order: &&Order| order.wanted == self.frame && matches!(order.state, OrderState::Seen | OrderState::Asked);
        self.orders.values().filter(waits).count() as u32
    }
}

/// Whether two meshes are clones of each other.
pub(crate) fn is_same(a: &Mesh, b: &Mesh) -> bool {
    a.positions().as_ptr() == b.positions().as_ptr()
        && a.normals().as_ptr() == b.normals().as_ptr()
        && a.indices().as_ptr() == b.indices().as_ptr()
}

impl Order {
    fn new(mesh: &Mesh, wanted: u64) -> Self {
        Self { source: mesh.clone(), wanted, state: OrderState::Seen }
    }
}

fn no_levels(id: AssetId<Mesh>, reason: String) -> RenderError {
    RenderError::NoLevels { mesh: format!("mesh {id}"), reason }
}

/// What is made of a mesh, `None` where it was told to stop, or what went wrong.
fn made(make: Make, cut: Option<Cut>, mesh: &Mesh, stop: &AtomicBool) -> Result<Option<MeshTriangles>, String> {
    let made = || {
        let mut triangles = make(mesh, stop)?;
        triangles.pieces = cut.and_then(|cut| cut(mesh, &triangles)).map(Arc::new);
        Some(triangles)
    };
    // What was being made is dropped, and the flag is as good as before.
    catch_unwind(AssertUnwindSafe(made)).map_err(|panic| panic_message(&*panic))
}

impl Thread {
    /// `None` where the system gives no thread.
    fn start(make: Make) -> Option<Self> {
        let (wanted, wishes) = channel::<(AssetId<Mesh>, Mesh, Option<Cut>)>();
        let (sender, receiver) = channel();
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let work = move || {
            // Ends when the workshop is gone.
            for (id, mesh, cut) in wishes {
                let triangles = match made(make, cut, &mesh, &stopped) {
                    Ok(Some(triangles)) => Ok(triangles),
                    Ok(None) => break,
                    Err(reason) => Err(reason),
                };
                if sender.send((id, mesh, triangles)).is_err() {
                    break;
                }
            }
        };
        std::thread::Builder::new().name("levels of detail".into()).spawn(work).ok()?;
        Some(Self { wanted, made: Mutex::new(receiver), stop })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_asset::Assets;
    use halfway_mesh::UvSphere;

    #[test]
    fn a_mesh_whose_levels_cannot_be_made_is_refused_and_the_next_one_is_made() {
        let broken = Mesh::from(UvSphere::new(1.0, 16, 8));
        let whole = Mesh::from(UvSphere::new(1.0, 24, 12));
        let mut assets = Assets::<Mesh>::default();
        let handles = [&broken, &whole].map(|mesh| assets.add(mesh.clone()));
        for waits in [false, true] {
            let mut workshop = Workshop::making(|mesh, stop| {
                assert!(mesh != &Mesh::from(UvSphere::new(1.0, 16, 8)), "this mesh is broken");
                MeshTriangles::in_levels(mesh, stop)
            });
            let mut failures = Vec::new();
            let mut frame = |workshop: &mut Workshop| {
                workshop.collect();
                let [first, second] = &handles;
                let made = [(first, &broken), (second, &whole)]
                    .map(|(at, mesh)| workshop.levels(at.id(), mesh, waits).is_some());
                failures.append(&mut workshop.failures);
                (made, workshop.pending())
            };
            assert_eq!(frame(&mut workshop), ([false, false], 2), "waits {waits}: seen once");
            while !waits && frame(&mut workshop).1 > 0 {
                std::thread::yield_now();
            }
            // Where it waits, both are done by the second frame.
            for _ in 0..3 {
                assert_eq!(frame(&mut workshop), ([false, true], 0), "waits {waits}");
            }
            assert_eq!(workshop.thread.is_none(), waits, "a thread beside the frames");
            let [RenderError::NoLevels { mesh, reason }] = &failures[..] else {
                panic!("waits {waits}: said once, not {failures:?}")
            };
            assert!(mesh.starts_with("mesh ") && reason == "this mesh is broken", "waits {waits}: {mesh}: {reason}");
        }
    }
}
