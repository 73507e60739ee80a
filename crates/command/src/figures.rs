//! Figures as JSON.

use halfway::reference::metrics::{Comparison, Errors, PERCENTILES, Statistics, Verdict, Worst};
use serde_json::{Map, Value, json};

/// Every figure of a comparison.
pub(crate) fn comparison(it: &Comparison) -> Value {
    let coverage = it.coverage.map(|coverage| {
        json!({
            "both": coverage.both,
            "neither": coverage.neither,
            "only_actual": coverage.only_actual,
            "only_expected": coverage.only_expected,
            "first_difference": coverage.first_difference,
        })
    });
    json!({
        "size": it.size,
        "counted": it.counted,
        "coverage": coverage,
        "not_finite": it.not_finite.map_or(0, |bad| bad.count),
        "range": it.range,
        "equal": it.equal,
        "anywhere": { "steps": it.anywhere.steps, "at": it.anywhere.at },
        "steps": errors(&it.steps),
        "linear": errors(&it.linear),
    })
}

/// Every figure of a verdict.
pub(crate) fn verdict(it: &Verdict) -> Value {
    json!({
        "most": it.most,
        "worst": it.worst,
        "at": it.at.map(worst),
        "equal": it.equal,
        "edges": it.edges,
        "layered": it.layered,
        "counted": it.counted,
        "bad": it.bad,
        "within": it.is_within(),
    })
}

fn errors(errors: &Errors) -> Value {
    let [red, green, blue] = errors.channels.each_ref().map(statistics);
    json!({ "red": red, "green": green, "blue": blue, "all": statistics(&errors.all) })
}

fn statistics(it: &Statistics) -> Value {
    json!({
        "max": it.max(),
        "mean": it.mean,
        "bias": it.bias,
        "rmse": it.rmse,
        "percentiles": percentiles(it.percentiles),
        "worst": it.worst.map(worst),
    })
}

/// Percentiles by their percentages.
pub(crate) fn percentiles(values: [f64; 4]) -> Value {
    let named = PERCENTILES.iter().zip(values).map(|(share, value)| (share.to_string(), json!(value)));
    named.collect::<Map<_, _>>().into()
}

fn worst(it: Worst) -> Value {
    json!({ "at": it.at, "channel": it.channel, "actual": it.actual, "expected": it.expected })
}
