//! Reports as lines and as JSON.

use std::fmt;

use serde_json::{Value, json};

use super::diagnosis::{Area, Cause, Finding};
use super::examined::Examined;
use super::rubric::Rubric;
use crate::mistakes::Mistake;

/// All that is said of a picture: [`Display`](fmt::Display) writes it in sentences, a line each.
#[derive(Clone, Debug)]
pub struct Report {
    /// The name of the picture.
    pub picture: String,
    /// Its width and height.
    pub size: [u32; 2],
    /// Whether it passes, and what explains the difference.
    pub examined: Examined,
    /// Its points.
    pub mark: f64,
    /// The points of a picture that passes.
    pub points: f64,
}

/// Points without needless digits.
fn rounded(points: f64) -> f64 {
    (points * 100.0).round() / 100.0
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        let passes = if self.examined.passes() { "passes" } else { "differs" };
        writeln!(f, "{}, {width} × {height} pixels: {passes}, {}", self.picture, self.marked())?;
        let Some(diagnosis) = &self.examined.diagnosis else { return Ok(()) };
        writeln!(f, "{} % of the pixels inside objects are right", percent(diagnosis.right))?;
        for (number, explanation) in diagnosis.explanations.iter().enumerate() {
            if number > 0 {
                writeln!(f, "or:")?;
            }
            self.describe(f, explanation)?;
        }
        if diagnosis.explanations.is_empty() {
            writeln!(f, "none of the known mistakes explains the difference")?;
            if let Some(nearest) = &diagnosis.nearest {
                let names: Vec<&str> = nearest.causes.iter().flat_map(names).collect();
                writeln!(f, "nearest is {}, which explains {} %", names.join(" or "), percent(nearest.share))?;
            }
        }
        Ok(())
    }
}

/// Whole percents, 100 only where nothing is missing.
fn percent(share: f64) -> u32 {
    (100.0 * share.clamp(0.0, 1.0) + 1e-9) as u32
}

fn names(cause: &Cause) -> impl Iterator<Item = &'static str> {
    cause.alternatives.iter().map(|mistake| mistake.name())
}

fn explained(mistake: Mistake) -> Value {
    json!({ "name": mistake.name(), "explanation": mistake.explanation(), "remedy": mistake.remedy() })
}

impl Report {
    /// Of a picture with this name and size, with points by a rubric.
    pub fn new(picture: String, size: [u32; 2], examined: Examined, rubric: &Rubric) -> Self {
        Self { picture, size, mark: examined.mark(rubric), points: rubric.points(), examined }
    }

    /// The points: `80 of 100 points`.
    pub fn marked(&self) -> String {
        format!("{} of {} points", rounded(self.mark), rounded(self.points))
    }

    fn describe(&self, f: &mut fmt::Formatter<'_>, explanation: &Finding) -> fmt::Result {
        for cause in &explanation.causes {
            for (number, mistake) in cause.alternatives.iter().enumerate() {
                let or = if number > 0 { "  or, which looks the same here: " } else { "" };
                writeln!(f, "{or}{mistake}: {} {}", mistake.explanation(), mistake.remedy())?;
            }
        }
        let Area { from, to } = explanation.area;
        let on = self.examined.object(explanation).map_or(String::new(), |name| format!(", most of it on {name}"));
        let share = percent(explanation.share);
        writeln!(
            f,
            "  explains {share} % of the difference, in columns {} to {}, rows {} to {}{on}",
            from.0, to.0, from.1, to.1
        )
    }

    /// Everything but the figures of the verdict, under halfway's own keys.
    pub fn to_json(&self) -> Value {
        let diagnosis = self.examined.diagnosis.as_ref();
        let found = |explanation: &Finding| {
            let cause = |cause: &Cause| cause.alternatives.iter().copied().map(explained).collect::<Vec<_>>();
            json!({
                "causes": explanation.causes.iter().map(cause).collect::<Vec<_>>(),
                "share": explanation.share,
                "area": { "from": explanation.area.from, "to": explanation.area.to },
                "object": self.examined.object(explanation),
            })
        };
        json!({
            "picture": self.picture,
            "size": self.size,
            "passes": self.examined.passes(),
            "mark": self.mark,
            "points": self.points,
            "right": diagnosis.map_or(1.0, |it| it.right),
            "explanations": diagnosis.map_or_else(Vec::new, |it| it.explanations.iter().map(found).collect()),
            "nearest": diagnosis.and_then(|it| it.nearest.as_ref()).map(found),
        })
    }

    /// `results.json` of Gradescope's autograders.
    pub fn to_gradescope(&self) -> Value {
        json!({
            "tests": [{
                "name": self.picture,
                "score": self.mark,
                "max_score": self.points,
                "status": if self.examined.passes() { "passed" } else { "failed" },
                "output": self.to_string(),
            }],
        })
    }

    /// The output of Submitty's custom validators: a score from 0 to 1.
    pub fn to_submitty(&self) -> Value {
        let passes = self.examined.passes();
        let score = if self.points > 0.0 { self.mark / self.points } else { f64::from(u8::from(passes)) };
        let status = if passes { "success" } else { "failure" };
        json!({ "score": score, "message": self.to_string(), "status": status })
    }
}
