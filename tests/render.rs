//! Whole-system tests of the renderer: scenes are spawned through the facade, drawn headless, and their pixels
//! compared with the f64 evaluation of what the shading means.
//!
//! `render/scene.rs` describes a scene once; `render/stage.rs` spawns and draws it; `render/oracle.rs` says what each
//! pixel should be; `render/compare.rs` measures the difference.

#![expect(clippy::float_cmp, reason = "what is exact in binary, and what is copied, is compared to the bit")]
#![expect(clippy::type_complexity, reason = "a table's rows are tuples, with a function for what differs")]

mod render {
    mod blend;
    mod changes;
    mod compare;
    mod counters;
    mod degenerate;
    mod edges;
    mod errors;
    mod light_counts;
    mod oracle;
    mod picture;
    mod pipelines;
    mod plugins;
    mod random;
    mod scene;
    mod sides;
    mod stage;
    mod surfaces;
    mod sweep;
    mod terms;
    mod transforms;
    mod values;
}
