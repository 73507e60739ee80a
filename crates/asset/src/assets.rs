//! All assets of one type.

use std::fmt;

use bevy_app::{App, PreUpdate};
use bevy_ecs::prelude::{DetectChangesMut, ResMut, Resource};

use crate::handle::{AssetId, Dropped, Handle};

/// All assets of one type, as a resource of the app.
///
/// ```
/// use halfway_asset::Assets;
///
/// let mut names = Assets::<String>::default();
/// let teapot = names.add("teapot");
/// names.insert(&teapot, "kettle").expect("the handle still exists");
/// let all: Vec<&String> = names.iter().map(|(_, name)| name).collect();
/// assert_eq!(all, ["kettle"]);
/// ```
#[derive(Resource)]
pub struct Assets<T: Send + Sync + 'static> {
    slots: Vec<Slot<T>>,
    free: Vec<u32>,
    dropped: Dropped,
}

/// A slot for an asset. It is reused after the last handle is dropped, with a new generation.
struct Slot<T> {
    generation: u32,
    asset: Option<T>,
}

impl<T: Send + Sync + 'static> Default for Assets<T> {
    fn default() -> Self {
        Self { slots: Vec::new(), free: Vec::new(), dropped: Dropped::default() }
    }
}

impl<T: Send + Sync + 'static> Assets<T> {
    /// Adds an asset, which stays until the last clone of the handle is dropped.
    pub fn add(&mut self, asset: impl Into<T>) -> Handle<T> {
        let slot = self.free.pop().unwrap_or_else(|| {
            self.slots.push(Slot { generation: 0, asset: None });
            self.slots.len() as u32 - 1
        });
        let Slot { generation, asset: place } = &mut self.slots[slot as usize];
        *place = Some(asset.into());
        Handle::new(AssetId::new(slot, *generation), &self.dropped)
    }

    /// The asset, unless it was removed.
    pub fn get(&self, id: impl Into<AssetId<T>>) -> Option<&T> {
        let id = id.into();
        self.slots.get(id.slot as usize).filter(|slot| slot.generation == id.generation)?.asset.as_ref()
    }

    /// The asset, mutably: every entity that shows it shows the change.
    pub fn get_mut(&mut self, id: impl Into<AssetId<T>>) -> Option<&mut T> {
        self.place(id.into())?.as_mut()
    }

    /// Whether the asset exists.
    pub fn contains(&self, id: impl Into<AssetId<T>>) -> bool {
        self.get(id).is_some()
    }

    /// Replaces an asset, or one that was removed, and returns the old one.
    ///
    /// # Errors
    /// The last handle was dropped and the asset removed since, or it is the id of the default handle.
    pub fn insert(&mut self, id: impl Into<AssetId<T>>, asset: impl Into<T>) -> Result<Option<T>, AssetGone> {
        let id = id.into();
        let place = self.place(id).ok_or(AssetGone { slot: id.slot, generation: id.generation })?;
        Ok(place.replace(asset.into()))
    }

    /// Removes an asset. Its handles have none until another is [inserted](Self::insert).
    pub fn remove(&mut self, id: impl Into<AssetId<T>>) -> Option<T> {
        self.place(id.into())?.take()
    }

    /// The number of assets.
    pub fn len(&self) -> usize {
        self.iter().count()
    }

    /// Whether there are no assets.
    pub fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }

    /// All assets, with their ids.
    pub fn iter(&self) -> impl Iterator<Item = (AssetId<T>, &T)> {
        let numbered = self.slots.iter().enumerate();
        numbered.filter_map(|(slot, Slot { generation, asset })| {
            Some((AssetId::new(slot as u32, *generation), asset.as_ref()?))
        })
    }

    /// All assets mutably, with their ids.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (AssetId<T>, &mut T)> {
        let numbered = self.slots.iter_mut().enumerate();
        numbered.filter_map(|(slot, Slot { generation, asset })| {
            Some((AssetId::new(slot as u32, *generation), asset.as_mut()?))
        })
    }

    fn place(&mut self, id: AssetId<T>) -> Option<&mut Option<T>> {
        let slot = self.slots.get_mut(id.slot as usize)?;
        (slot.generation == id.generation).then_some(&mut slot.asset)
    }

    /// Removes assets without a handle. [`add_assets`] runs it before each update.
    fn remove_unused(mut assets: ResMut<Self>) {
        // Assets have changed only if some go.
        let dropped = assets.bypass_change_detection().dropped.take();
        if dropped.is_empty() {
            return;
        }
        for &slot in &dropped {
            let Slot { generation, asset } = &mut assets.slots[slot as usize];
            *asset = None;
            *generation = generation.wrapping_add(1);
        }
        assets.free.extend(dropped);
    }
}

/// The error of inserting an asset under an id without a handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AssetGone {
    slot: u32,
    generation: u32,
}

impl fmt::Display for AssetGone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "no handle stands for asset {}v{} any more; expected the id of a handle that is held",
            self.slot, self.generation
        )
    }
}

impl std::error::Error for AssetGone {}

/// Adds [`Assets`] of a type to an app, and removes those without a handle in [`PreUpdate`].
///
/// May be called late and more than once: existing assets stay.
///
/// ```
/// use bevy_app::App;
/// use halfway_asset::{Assets, add_assets};
///
/// let mut app = App::new();
/// add_assets::<String>(&mut app);
/// let handle = app.world_mut().resource_mut::<Assets<String>>().add("bunny");
/// app.update();
/// assert_eq!(app.world().resource::<Assets<String>>().len(), 1);
/// drop(handle);
/// app.update();
/// assert!(app.world().resource::<Assets<String>>().is_empty());
/// ```
pub fn add_assets<T: Send + Sync + 'static>(app: &mut App) {
    /// Marks that the system was added.
    #[derive(Resource)]
    struct Added<T: Send + Sync + 'static>(std::marker::PhantomData<fn() -> T>);

    if !app.world().contains_resource::<Added<T>>() {
        app.insert_resource(Added::<T>(std::marker::PhantomData));
        app.init_resource::<Assets<T>>().add_systems(PreUpdate, Assets::<T>::remove_unused);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn app_with(names: [&str; 2]) -> (App, [Handle<String>; 2]) {
        let mut app = App::new();
        add_assets::<String>(&mut app);
        let handles = names.map(|name| assets(&mut app).add(name));
        (app, handles)
    }

    fn assets(app: &mut App) -> &mut Assets<String> {
        app.world_mut().resource_mut::<Assets<String>>().into_inner()
    }

    #[test]
    fn an_asset_lives_as_long_as_a_handle() {
        let (mut app, [a, b]) = app_with(["a", "b"]);
        let id = a.id();
        let clone = a.clone();
        drop(a);
        app.update();
        assert_eq!(assets(&mut app).get(id).map(String::as_str), Some("a"));
        drop(clone);
        app.update();
        assert!(!assets(&mut app).contains(id));
        assert_eq!(assets(&mut app).iter().map(|(id, name)| (id, name.as_str())).collect::<Vec<_>>(), [(b.id(), "b")]);
    }

    #[test]
    fn a_reused_slot_has_another_id() {
        let (mut app, [a, _b]) = app_with(["a", "b"]);
        let old = a.id();
        drop(a);
        app.update();
        let c = assets(&mut app).add("c");
        assert_eq!((c.id().slot, assets(&mut app).len()), (old.slot, 2));
        assert_ne!(c.id(), old);
        assert_eq!(assets(&mut app).get(old), None);
        let gone = assets(&mut app).insert(old, "d").unwrap_err().to_string();
        assert!(gone.starts_with("no handle stands for asset 0v0 any more"), "{gone}");
        assert_eq!(assets(&mut app).get(&c).map(String::as_str), Some("c"));
    }

    #[test]
    fn a_removed_asset_can_be_replaced() {
        let (mut app, [a, _b]) = app_with(["a", "b"]);
        assert_eq!(assets(&mut app).remove(&a).as_deref(), Some("a"));
        app.update();
        assert!(!assets(&mut app).contains(&a));
        assert_eq!(assets(&mut app).insert(&a, "c"), Ok(None));
        assert_eq!(assets(&mut app).insert(&a, "d"), Ok(Some("c".into())));
        assert_eq!(assets(&mut app).get(&a).map(String::as_str), Some("d"));
    }

    #[test]
    fn the_default_handle_has_no_asset() {
        let (mut app, _) = app_with(["a", "b"]);
        let none = Handle::<String>::default();
        assert!(assets(&mut app).insert(&none, "c").is_err());
        assert!(!assets(&mut app).contains(&none));
        assert_eq!(none, Handle::default());
    }
}
