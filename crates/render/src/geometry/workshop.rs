//! The thread that makes levels of detail beside the frames.

use crate::geometry::detail::MeshTriangles;
use bevy_asset::AssetId;
use bevy_ecs::prelude::Resource;
use bevy_platform::collections::HashMap;
use halfway_mesh::Mesh;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, PoisonError};

/// Meshes with fewer triangles have no levels.
const FEWEST: usize = 64;

/// The meshes whose levels are asked for, and one thread that makes them, one after the other.
#[derive(Resource, Default)]
pub(crate) struct Workshop {
    orders: HashMap<AssetId<Mesh>, Order>,
    /// The number of the frame.
    frame: u64,
    thread: Option<Thread>,
}

struct Order {
    source: Mesh,
    /// The frame that wanted it last.
    wanted: u64,
    state: OrderState,
}

enum OrderState {
    /// Seen in one frame. A picture that is drawn once needs no levels.
    Seen,
    /// On its way.
    Asked,
    Made(MeshTriangles),
    /// There is no thread to make it.
    Refused,
}

struct Thread {
    wanted: Sender<(AssetId<Mesh>, Mesh)>,
    made: Mutex<Receiver<Made>>,
}

type Made = (AssetId<Mesh>, Mesh, MeshTriangles);

impl Workshop {
    /// The levels of `mesh` if they are made. Asks for them if another frame has wanted them before.
    pub(crate) fn levels(&mut self, id: AssetId<Mesh>, mesh: &Mesh) -> Option<&MeshTriangles> {
        if mesh.triangle_count() < FEWEST {
            return None;
        }
        let Self { orders, frame, thread } = self;
        let order = orders.entry(id).or_insert_with(|| Order::new(mesh, *frame));
        if !is_same(&order.source, mesh) {
            *order = Order::new(mesh, *frame);
        }
        let before = std::mem::replace(&mut order.wanted, *frame);
        if matches!(order.state, OrderState::Seen) && before < *frame {
            if thread.is_none() {
                *thread = Thread::start();
            }
            let asked = thread.as_ref().is_some_and(|thread| thread.wanted.send((id, mesh.clone())).is_ok());
            order.state = if asked { OrderState::Asked } else { OrderState::Refused };
        }
        if let OrderState::Made(triangles) = &order.state { Some(triangles) } else { None }
    }

    /// Begins a frame, and takes in what has been made.
    pub(crate) fn collect(&mut self) {
        self.frame += 1;
        let Some(thread) = &self.thread else { return };
        let made = thread.made.lock().unwrap_or_else(PoisonError::into_inner);
        for (id, source, triangles) in made.try_iter() {
            // The asset may have got another mesh since.
            if let Some(order) = self.orders.get_mut(&id).filter(|order| is_same(&order.source, &source)) {
                order.state = OrderState::Made(triangles);
            }
        }
    }

    pub(crate) fn forget(&mut self, id: AssetId<Mesh>) {
        self.orders.remove(&id);
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

impl Thread {
    /// `None` where the system gives no thread.
    fn start() -> Option<Self> {
        let (wanted, wishes) = channel::<(AssetId<Mesh>, Mesh)>();
        let (sender, made) = channel();
        let make = move || {
            // Ends when the workshop is gone.
            for (id, mesh) in wishes {
                let triangles = MeshTriangles::in_levels(&mesh);
                if sender.send((id, mesh, triangles)).is_err() {
                    break;
                }
            }
        };
        std::thread::Builder::new().name("levels of detail".into()).spawn(make).ok()?;
        Some(Self { wanted, made: Mutex::new(made) })
    }
}
