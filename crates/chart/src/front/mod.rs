//! Error against time: scenes, the methods that draw them, and the points of error and time that are measured.

mod errors;
mod method;
mod over;
mod pages;
mod point;
mod scene;
pub mod scenes;
mod stage;
mod sweep;

pub use errors::{AreaErrors, ErrorFigures, PointErrors};
pub use method::{Family, Method};
pub use over::{MeasuredOver, Over};
pub use pages::Fronts;
pub use point::FrontPoint;
pub use scene::{BuildScene, ChartedScene, SceneDetail, Still};
pub use sweep::{ChartedAdapter, FrontFilter, FrontPlan, MeasuredScene, sweep};
