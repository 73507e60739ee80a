//! Makes levels of detail: on a thread beside the frames of a window, or in the frame itself.

use crate::error::{RenderError, panic_message};
use crate::geometry::patches::{MeshTriangles, Prepared};
use bevy_ecs::prelude::Resource;
use bevy_platform::collections::HashMap;
use halfway_asset::AssetId;
use halfway_mesh::Mesh;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// Meshes with fewer triangles have no levels.
const FEWEST: usize = 64;

/// The meshes whose levels of detail are asked for.
#[derive(Resource, Default)]
pub struct Workshop {
    orders: HashMap<AssetId<Mesh>, Order>,
    thread: Option<Thread>,
    /// The renderer's preparation of triangles, if that takes time: done with the levels, not in the first frame that
    /// has them.
    pub cut: Option<Cut>,
    /// Failures that have not been reported yet.
    pub(crate) failures: Vec<RenderError>,
}

/// Prepares triangles for a renderer, if it can.
pub type Cut = fn(&Mesh, &MeshTriangles) -> Option<Prepared>;

struct Order {
    source: Mesh,
    state: OrderState,
}

enum OrderState {
    /// The thread has it.
    Asked,
    Made(MeshTriangles),
    /// There is no thread to make it, or making it went wrong.
    Refused,
}

struct Thread {
    wanted: Sender<(AssetId<Mesh>, Mesh, Option<Cut>)>,
    made: Mutex<Receiver<Made>>,
    /// Set when its work is no longer wanted.
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
    /// The levels of `mesh` if they are there. Makes them at once if the frame `waits` for them, else beside the
    /// frames.
    pub(crate) fn levels(&mut self, id: AssetId<Mesh>, mesh: &Mesh, waits: bool) -> Option<&MeshTriangles> {
        if mesh.triangle_count() < FEWEST {
            return None;
        }
        let Self { orders, thread, cut, failures } = self;
        let is_known = orders.get(&id).is_some_and(|order| order.source.is_clone_of(mesh));
        if !is_known {
            let made = if waits {
                made(*cut, mesh, &AtomicBool::new(false))
            } else {
                if thread.is_none() {
                    *thread = Thread::start();
                }
                match thread.as_ref().map(|thread| thread.wanted.send((id, mesh.clone(), *cut))) {
                    Some(Ok(())) => Ok(None),
                    _ => Err("the system gives no thread".into()),
                }
            };
            let state = match made {
                Ok(made) => made.map_or(OrderState::Asked, OrderState::Made),
                Err(reason) => {
                    failures.push(no_levels(id, reason));
                    OrderState::Refused
                }
            };
            orders.insert(id, Order { source: mesh.clone(), state });
        }
        match &orders.get(&id)?.state {
            OrderState::Made(triangles) => Some(triangles),
            OrderState::Asked | OrderState::Refused => None,
        }
    }

    /// Takes in what has been made beside the frames.
    pub(crate) fn collect(&mut self) {
        let Some(thread) = &self.thread else { return };
        let made = thread.made.lock().unwrap_or_else(PoisonError::into_inner);
        for (id, source, triangles) in made.try_iter() {
            // The asset may have got another mesh since.
            let Some(order) = self.orders.get_mut(&id).filter(|order| order.source.is_clone_of(&source)) else {
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

    /// The number of meshes that are ordered or made.
    pub fn len(&self) -> usize {
        self.orders.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.orders.is_empty()
    }

    /// The number of meshes that are not made yet.
    pub(crate) fn pending(&self) -> u32 {
        self.orders.values().filter(|order| matches!(order.state, OrderState::Asked)).count() as u32
    }
}

fn no_levels(id: AssetId<Mesh>, reason: String) -> RenderError {
    RenderError::NoLevels { mesh: format!("mesh {id}"), reason }
}

/// The levels of a mesh, `None` where `stop` has become true, or what went wrong.
fn made(cut: Option<Cut>, mesh: &Mesh, stop: &AtomicBool) -> Result<Option<MeshTriangles>, String> {
    let made = || {
        let mut triangles = MeshTriangles::in_levels(mesh, stop)?;
        triangles.pieces = cut.and_then(|cut| cut(mesh, &triangles));
        Some(triangles)
    };
    // Unfinished work is dropped, and the flag is as good as before.
    catch_unwind(AssertUnwindSafe(made)).map_err(|panic| panic_message(&*panic))
}

impl Thread {
    /// `None` where the system gives no thread.
    fn start() -> Option<Self> {
        let (wanted, wishes) = channel::<(AssetId<Mesh>, Mesh, Option<Cut>)>();
        let (sender, receiver) = channel();
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let work = move || {
            // Ends when the workshop is gone.
            for (id, mesh, cut) in wishes {
                let triangles = match made(cut, &mesh, &stopped) {
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
