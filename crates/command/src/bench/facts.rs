//! Figures of a benchmark as JSON, and the machine they come from in words.

use halfway::prelude::*;
use halfway_chart::timing::{Machine, Spread};
use serde_json::{Value, json};

pub(super) fn spread(it: &Spread) -> Value {
    let Spread { min, lower_quartile, median, upper_quartile, max, count } = it;
    json!({
        "min": min,
        "lower_quartile": lower_quartile,
        "median": median,
        "upper_quartile": upper_quartile,
        "max": max,
        "frames": count,
    })
}

/// The counts of a frame, by the names in [`FrameReport`].
pub(super) fn counters(report: &FrameReport) -> Value {
    json!({
        "objects": report.objects,
        "visible": report.visible,
        "lights": report.lights,
        "triangles_in": report.triangles_in,
        "patches": report.patches,
        "patches_culled": report.patches_culled,
        "lights_assigned": report.lights_assigned,
        "light_pairs": report.light_pairs,
        "draws": report.draws,
        "triangles": report.triangles,
        "matrices": report.matrices,
        "materials": report.materials,
        "bytes_uploaded": report.bytes_uploaded,
        "pipelines": report.pipelines,
        "left_out": report.left_out,
    })
}

pub(super) fn print_facts(machine: &Machine) {
    for (name, value) in machine.facts() {
        println!("{name}: {value}");
    }
}
