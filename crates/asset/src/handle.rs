//! Handles and ids of assets.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;
use std::sync::{Arc, Mutex, PoisonError};

/// The id of an asset of one type; the same [`Assets`](crate::Assets) never gives it twice.
///
/// It does not keep the asset alive; a [`Handle`] does.
pub struct AssetId<T> {
    pub(crate) slot: u32,
    pub(crate) generation: u32,
    of: PhantomData<fn() -> T>,
}

impl<T> AssetId<T> {
    pub(crate) fn new(slot: u32, generation: u32) -> Self {
        Self { slot, generation, of: PhantomData }
    }

    fn number(self) -> (u32, u32) {
        (self.slot, self.generation)
    }
}

impl<T> Clone for AssetId<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for AssetId<T> {}

impl<T> PartialEq for AssetId<T> {
    fn eq(&self, other: &Self) -> bool {
        self.number() == other.number()
    }
}

impl<T> Eq for AssetId<T> {}

impl<T> PartialOrd for AssetId<T> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for AssetId<T> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.number().cmp(&other.number())
    }
}

impl<T> Hash for AssetId<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.number().hash(state);
    }
}

/// The slot and its generation, as in `3v1`.
impl<T> fmt::Display for AssetId<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}v{}", self.slot, self.generation)
    }
}

impl<T> fmt::Debug for AssetId<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "AssetId({self})")
    }
}

impl<T> From<&Handle<T>> for AssetId<T> {
    fn from(handle: &Handle<T>) -> Self {
        handle.id
    }
}

/// Keeps an asset alive: it stays in its [`Assets`](crate::Assets) until the last clone of its handle is dropped.
///
/// Handles are equal if they refer to the same asset. The default refers to none.
///
/// ```
/// use halfway_asset::{Assets, Handle};
///
/// let mut names = Assets::<String>::default();
/// let (a, b) = (names.add("bunny"), names.add("bunny"));
/// assert!(a == a.clone() && a != b);
/// assert_eq!(names.get(&Handle::default()), None);
/// ```
pub struct Handle<T> {
    id: AssetId<T>,
    /// Shared by all clones; `None` in the default.
    lease: Option<Arc<Lease>>,
}

impl<T> Handle<T> {
    pub(crate) fn new(id: AssetId<T>, dropped: &Dropped) -> Self {
        Self { id, lease: Some(Arc::new(Lease { slot: id.slot, dropped: dropped.clone() })) }
    }

    /// The id of the asset, which does not keep it alive.
    pub fn id(&self) -> AssetId<T> {
        self.id
    }
}

impl<T> Clone for Handle<T> {
    fn clone(&self) -> Self {
        Self { id: self.id, lease: self.lease.clone() }
    }
}

impl<T> Default for Handle<T> {
    fn default() -> Self {
        Self { id: AssetId::new(u32::MAX, 0), lease: None }
    }
}

impl<T> PartialEq for Handle<T> {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl<T> Eq for Handle<T> {}

impl<T> Hash for Handle<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.id.hash(state);
    }
}

impl<T> fmt::Debug for Handle<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Handle({})", self.id)
    }
}

/// The slots whose last handle was dropped, until they are emptied.
#[derive(Clone, Default)]
pub(crate) struct Dropped(Arc<Mutex<Vec<u32>>>);

impl Dropped {
    /// Takes all slots out.
    pub(crate) fn take(&self) -> Vec<u32> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

struct Lease {
    slot: u32,
    dropped: Dropped,
}

impl Drop for Lease {
    fn drop(&mut self) {
        self.dropped.0.lock().unwrap_or_else(PoisonError::into_inner).push(self.slot);
    }
}
