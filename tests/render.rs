//! Whole-system tests of the renderer: scenes are spawned through the facade, drawn headless, and their pixels compared
//! with the oracle's picture of the same world, and with closed forms.
//!
//! `render/scene.rs` describes a scene; `render/stage.rs` spawns and draws it; `render/compare.rs` judges the picture.
//! `render/conformance.rs` is the table of all features and all pairs of them.

#![expect(clippy::float_cmp, reason = "what is exact in binary, and what is copied, is compared to the bit")]
#![expect(clippy::type_complexity, reason = "a table's rows are tuples, with a function for what differs")]

mod render {
    mod adapter;
    mod backgrounds;
    mod blend;
    mod changes;
    mod closed_forms;
    mod coincident;
    mod colors;
    mod compare;
    mod compile;
    mod conformance;
    mod counters;
    mod cpu;
    mod culling;
    mod degenerate;
    mod devices;
    mod edges;
    mod engine;
    mod errors;
    mod explained;
    mod failures;
    mod far;
    mod floats;
    mod globs;
    mod known_issues;
    mod levels;
    mod light_counts;
    mod light_lists;
    mod lines;
    mod maps;
    mod order;
    mod painted;
    mod passes;
    mod picture;
    mod pipelines;
    mod plugins;
    mod policies;
    mod properties;
    mod quantities;
    mod random;
    mod samples;
    mod scalars;
    mod scene;
    mod sides;
    mod slivers;
    mod solids;
    mod stage;
    mod strokes;
    mod surfaces;
    mod terms;
    mod timing;
    mod transforms;
    mod unlit;
    mod values;
    mod viewports;
    mod visibility;
    mod why_empty;
    mod windows;
}
