//! Error against time: scenes, the methods that draw them, the points of error and time that are measured, and the
//! front of those that nothing beats.

mod errors;
mod keep;
mod method;
mod over;
mod pareto;
mod point;
mod scene;
pub mod scenes;
mod stage;
mod sweep;

pub use errors::{Area, AreaErrors, ErrorFigures, PointErrors};
pub use keep::KeptResults;
pub use method::{Family, Method, Shade};
pub use over::{MeasuredOver, Over};
pub use pareto::{BOUGHT_RATIOS, BestWithin, ERROR_STEPS, Front};
pub use point::FrontPoint;
pub use scene::{BuildScene, ChartedScene, SceneDetail, SceneProblem, Still};
pub use sweep::{ChartedAdapter, FrontFilter, FrontPlan, MeasuredScene, sweep};
