//! Figures of a benchmark as JSON, and the machine they come from.

use halfway::prelude::*;
use halfway_chart::timing::{self, Machine, Spread};
use serde_json::{Map, Value, json};

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

pub(super) fn counters(report: &FrameReport) -> Value {
    let counters = timing::counters(report).into_iter().map(|(name, count)| (name, json!(count)));
    let all = counters.chain([("left_out", json!(report.left_out))]);
    all.map(|(name, value)| (name.to_owned(), value)).collect::<Map<_, _>>().into()
}

pub(super) fn machine(it: &Machine) -> Value {
    json!({
        "adapter": it.adapter,
        "backend": it.backend,
        "software": it.software,
        "driver": it.driver,
        "driver_version": it.driver_version,
        "halfway": it.halfway,
        "cpu": it.cpu,
        "cores": it.cores,
    })
}

pub(super) fn print_facts(machine: &Machine) {
    for (name, value) in machine.facts() {
        println!("{name}: {value}");
    }
}
