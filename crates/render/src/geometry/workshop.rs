//! Where levels of detail are made, beside the frames.

use crate::geometry::detail::Triangles;
use crate::geometry::meshes::is_same;
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
    state: State,
}

enum State {
    /// Seen in one frame. A picture that is drawn once needs no levels.
    Seen,
    /// On its way.
    Asked,
    Made(Triangles),
    /// There is no thread to make it.
    Refused,
}

struct Thread {
    wanted: Sender<(AssetId<Mesh>, Mesh)>,
    made: Mutex<Receiver<Made>>,
}

type Made = (AssetId<Mesh>, Mesh, Triangles);

impl Workshop {
    /// The levels of `mesh` if they are made. Asks for them if another frame has wanted them before.
    pub(crate) fn levels(&mut self, id: AssetId<Mesh>, mesh: &Mesh) -> Option<&Triangles> {
        if mesh.triangle_count() < FEWEST {
            return None;
        }
        let Self { orders, frame, thread } = self;
        let order = orders.entry(id).or_insert_with(|| Order::new(mesh, *frame));
        if !is_same(&order.source, mesh) {
            *order = Order::new(mesh, *frame);
        }
        let before = std::mem::replace(&mut order.wanted, *frame);
        if matches!(order.state, State::Seen) && before < *frame {
            if thread.is_none() {
                *thread = Thread::start();
            }
            let asked = thread.as_ref().is_some_and(|thread| thread.wanted.send((id, mesh.clone())).is_ok());
            order.state = if asked { State::Asked } else { State::Refused };
        }
        if let State::Made(triangles) = &order.state { Some(triangles) } else { None }
    }

    /// Begins a frame, and takes in what has been made.
    pub(crate) fn collect(&mut self) {
        self.frame += 1;
        let Some(thread) = &self.thread else { return };
        let made = thread.made.lock().unwrap_or_else(PoisonError::into_inner);
        for (id, source, triangles) in made.try_iter() {
            // The asset may have got another mesh since.
            if let Some(order) = self.orders.get_mut(&id).filter(|order| is_same(&order.source, &source)) {
                order.state = State::Made(triangles);
            }
        }
    }

    pub(crate) fn forget(&mut self, id: AssetId<Mesh>) {
        self.orders.remove(&id);
    }

    /// How many meshes the frame wants whose levels are not made yet.
    pub(crate) fn pending(&self) -> u32 {
        let waits = |order: &&Order| order.wanted == self.frame && matches!(order.state, State::Seen | State::Asked);
        self.orders.values().filter(waits).count() as u32
    }
}

impl Order {
    fn new(mesh: &Mesh, wanted: u64) -> Self {
        Self { source: mesh.clone(), wanted, state: State::Seen }
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
                let triangles = Triangles::in_levels(&mesh);
                if sender.send((id, mesh, triangles)).is_err() {
                    break;
                }
            }
        };
        std::thread::Builder::new().name("levels of detail".into()).spawn(make).ok()?;
        Some(Self { wanted, made: Mutex::new(made) })
    }
}
