//! Values that entities share, such as meshes and images.
//!
//! [`Assets`] holds all values of one type. [`Assets::add`] gives a [`Handle`], which components hold and which may be
//! cloned. When the last clone is dropped, the value is removed before the next update of the app; so an asset lives as
//! long as an entity shows it.
//!
//! ```
//! use bevy_app::App;
//! use halfway_asset::{Assets, add_assets};
//!
//! let mut app = App::new();
//! add_assets::<String>(&mut app);
//! let mut names = app.world_mut().resource_mut::<Assets<String>>();
//! let bunny = names.add("bunny");
//! names.get_mut(&bunny).unwrap().push('!');
//! assert_eq!(names.get(&bunny).unwrap(), "bunny!");
//!
//! let id = bunny.id();
//! drop(bunny);
//! app.update();
//! assert!(!app.world().resource::<Assets<String>>().contains(id));
//! ```

mod assets;
mod handle;

pub use assets::{AssetGone, Assets, add_assets};
pub use handle::{AssetId, Handle};
