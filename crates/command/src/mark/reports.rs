//! Reports as lines and as JSON.

use std::fmt::Write;

use halfway::reference::marking::{Area, Cause, Finding};
use serde_json::{Value, json};

use super::Report;

/// Points without needless digits.
pub(super) fn points(points: f64) -> String {
    let rounded = (points * 100.0).round() / 100.0;
    format!("{rounded}")
}

/// The report in sentences, a line each.
pub(super) fn lines(report: &Report) -> String {
    let mut text = String::new();
    let [width, height] = report.size.to_array();
    let passes = if report.examined.passes() { "passes" } else { "differs" };
    let (mark, of) = (points(report.mark), points(report.points));
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}, {width} × {height} pixels: {passes}, {mark} of {of} points", report.picture);
    let Some(diagnosis) = &report.examined.diagnosis else { return text };
    let _ = writeln!(text, "{} % of the pixels inside objects are right", percent(diagnosis.right));
    for (number, explanation) in diagnosis.explanations.iter().enumerate() {
        if number > 0 {
            let _ = writeln!(text, "or:");
        }
        describe(&mut text, report, explanation);
    }
    if diagnosis.explanations.is_empty() {
        let _ = writeln!(text, "none of the known mistakes explains the difference");
        if let Some(nearest) = &diagnosis.nearest {
            let names: Vec<&str> = nearest.causes.iter().flat_map(names).collect();
            let _ = writeln!(text, "nearest is {}, which explains {} %", names.join(" or "), percent(nearest.share));
        }
    }
    text
}

/// Whole percents, 100 only where nothing is missing.
fn percent(share: f64) -> u32 {
    (100.0 * share.clamp(0.0, 1.0) + 1e-9) as u32
}

fn names(cause: &Cause) -> impl Iterator<Item = &'static str> {
    cause.alternatives.iter().map(|mistake| mistake.name())
}

fn describe(text: &mut String, report: &Report, explanation: &Finding) {
    for cause in &explanation.causes {
        for (number, mistake) in cause.alternatives.iter().enumerate() {
            let or = if number > 0 { "  or, which looks the same here: " } else { "" };
            let _ = writeln!(text, "{or}{mistake}: {} {}", mistake.explanation(), mistake.remedy());
        }
    }
    let Area { from, to } = explanation.area;
    let on = report.examined.object(explanation).map_or(String::new(), |name| format!(", most of it on {name}"));
    let share = percent(explanation.share);
    let _ = writeln!(
        text,
        "  explains {share} % of the difference, in columns {} to {}, rows {} to {}{on}",
        from.0, to.0, from.1, to.1
    );
}

/// Everything, under halfway's own keys.
pub(super) fn json(report: &Report) -> Value {
    let diagnosis = report.examined.diagnosis.as_ref();
    let explained = |explanation: &Finding| {
        let mistake = |mistake: &halfway::reference::mistakes::Mistake| json!({ "name": mistake.name(), "explanation": mistake.explanation(), "remedy": mistake.remedy() });
        let cause = |cause: &Cause| cause.alternatives.iter().map(mistake).collect::<Vec<_>>();
        json!({
            "causes": explanation.causes.iter().map(cause).collect::<Vec<_>>(),
            "share": explanation.share,
            "area": { "from": explanation.area.from, "to": explanation.area.to },
            "object": report.examined.object(explanation),
        })
    };
    json!({
        "picture": report.picture,
        "size": report.size.to_array(),
        "passes": report.examined.passes(),
        "mark": report.mark,
        "points": report.points,
        "right": diagnosis.map_or(1.0, |it| it.right),
        "explanations": diagnosis.map_or_else(Vec::new, |it| it.explanations.iter().map(explained).collect()),
        "nearest": diagnosis.and_then(|it| it.nearest.as_ref()).map(explained),
        "verdict": crate::figures::verdict(&report.examined.verdict),
    })
}

/// `results.json` of Gradescope's autograders.
pub(super) fn gradescope(report: &Report) -> Value {
    json!({
        "tests": [{
            "name": report.picture,
            "score": report.mark,
            "max_score": report.points,
            "status": if report.examined.passes() { "passed" } else { "failed" },
            "output": lines(report),
        }],
    })
}

/// The output of Submitty's custom validators: a score from 0 to 1.
pub(super) fn submitty(report: &Report) -> Value {
    let score =
        if report.points > 0.0 { report.mark / report.points } else { f64::from(u8::from(report.examined.passes())) };
    let status = if report.examined.passes() { "success" } else { "failure" };
    json!({ "score": score, "message": lines(report), "status": status })
}
