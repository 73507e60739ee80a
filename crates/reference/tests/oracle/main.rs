//! The oracle against closed forms, hand arithmetic and itself.

mod beside;
mod bits;
mod blending;
mod coverage;
mod errors;
mod explained;
mod folds;
mod four;
mod grid;
mod mutants;
mod needles;
mod orthographic;
mod possible;
mod probes;
mod repeats;
mod scene;
mod surfaces;
mod transforms;
mod values;
