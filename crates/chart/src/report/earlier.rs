//! What an earlier run found, as its `chart.json` tells it, and where this one's fronts are others.

use serde_json::Value;

use super::Fronts;
use crate::front::{Area, Front, FrontPoint};

/// The points of an earlier run: of each its names, and what fronts are made of.
#[derive(Clone, Debug, PartialEq)]
pub struct EarlierRun {
    points: Vec<FrontPoint>,
}

impl EarlierRun {
    /// Reads what [`Fronts::files`](super::Fronts::files) wrote as `chart.json`.
    ///
    /// # Errors
    /// It is no JSON, or a point lacks something; in words.
    pub fn read(json: &str) -> Result<Self, String> {
        let all: Value = serde_json::from_str(json).map_err(|error| error.to_string())?;
        let points =
            all["points"].as_array().ok_or("there is no list `points`; expected a chart.json of `halfway chart`")?;
        let points = points.iter().enumerate().map(|(place, json)| {
            point(json).ok_or_else(|| {
                format!(
                    "`points[{place}]`: expected the words `scene`, `method`, `words`, `tessellation`, `detail` and \
                     `backend`, and the numbers `ratio`, `ratio_quartiles`, `rms` and `whole.rms`"
                )
            })
        });
        Ok(Self { points: points.collect::<Result<_, _>>()? })
    }
}

fn point(json: &Value) -> Option<FrontPoint> {
    let text = |key: &str| json[key].as_str().map(str::to_owned);
    let mut point = FrontPoint {
        scene: text("scene")?,
        method: text("method")?,
        words: text("words")?,
        detail: text("tessellation")?,
        detail_words: text("detail")?,
        backend: text("backend")?,
        ..FrontPoint::default()
    };
    point.ratio.median = json["ratio"].as_f64()?;
    point.ratio.lower_quartile = json["ratio_quartiles"][0].as_f64()?;
    point.ratio.upper_quartile = json["ratio_quartiles"][1].as_f64()?;
    point.errors.covered.steps.rms = json["rms"].as_f64()?;
    point.errors.whole.steps.rms = json["whole"]["rms"].as_f64()?;
    Some(point)
}

impl Fronts {
    /// The points on which the fronts of this run and of an earlier one disagree, a line each: what is on the front of
    /// one and clearly beaten in the other ([`Front::disagreement`]). Of what only one of them measured nothing is
    /// said.
    pub fn disagreements(&self, earlier: &EarlierRun) -> Vec<String> {
        let mut told = Vec::new();
        for (scene, (backend, _)) in self.scenes.iter().flat_map(|scene| self.machines.iter().map(move |m| (scene, m)))
        {
            let here = |point: &&FrontPoint| point.scene == scene.name && point.backend == *backend;
            let own: Vec<&FrontPoint> = scene.points.iter().filter(here).collect();
            let theirs: Vec<&FrontPoint> = earlier.points.iter().filter(here).collect();
            if theirs.is_empty() {
                continue;
            }
            for (area, name) in [(Area::Covered, "covered pixels"), (Area::Whole, "the whole picture")] {
                let error = |point: &FrontPoint| point.errors.over(area).steps.rms;
                told.extend(Front::disagreement(&own, &theirs, error).into_iter().map(|point| {
                    let FrontPoint { words, detail_words, ratio, .. } = point;
                    format!(
                        "{} on {backend}, {name}: {words}, {detail_words}, at {:.2} × the reference frame and {:.2} steps off \
                         is on the front of one run and clearly beaten in the other",
                        scene.name,
                        ratio.median,
                        error(point)
                    )
                }));
            }
        }
        told
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ReportPlan;
    use crate::front::MeasuredScene;
    use crate::timing::{Machine, Spread};

    fn run(times: [f64; 2]) -> Fronts {
        let point = |method: &str, time: f64, error: f64| {
            let spread =
                Spread { lower_quartile: 0.99 * time, median: time, upper_quartile: 1.01 * time, ..Spread::default() };
            let names = [method, method, "8", "8 cells", "cpu"].map(str::to_owned);
            let [method, words, detail, detail_words, backend] = names;
            let scene = "sphere".to_owned();
            let mut point = FrontPoint {
                scene,
                method,
                words,
                detail,
                detail_words,
                backend,
                ratio: spread,
                ..FrontPoint::default()
            };
            point.errors.covered.steps.rms = error;
            point.errors.whole.steps.rms = 2.0 * error;
            point
        };
        let points = vec![point("flat", times[0], 5.0), point("phong", times[1], 0.5)];
        let scene = MeasuredScene { name: "sphere".into(), points, ..MeasuredScene::default() };
        let machines = vec![("cpu".to_owned(), Machine::default())];
        Fronts { plan: ReportPlan::QUICK.fronts, machines, scenes: vec![scene] }
    }

    #[test]
    fn what_takes_longer_has_more_milliseconds() {
        let mut fronts = run([1.0, 2.0]);
        // The machine was half as fast while the first was measured.
        for (point, ms) in fronts.scenes[0].points.iter_mut().zip([20.0, 20.0]) {
            point.ms.median = ms;
        }
        let advice = fronts.advice(&fronts.scenes[0]);
        let choices =
            "at most 8 of 255 steps: flat, 8 cells, 20.00 ms; at most 0.5 of 255 steps: phong, 8 cells, 40.00 ms.";
        assert!(advice.len() == 1 && advice[0].ends_with(choices), "{advice:?}");
    }

    fn written(fronts: &Fronts) -> String {
        fronts.tables().into_iter().find(|(name, _)| name == "chart.json").unwrap().1
    }

    #[test]
    fn a_run_agrees_with_itself_and_not_with_one_of_another_front() {
        let earlier = EarlierRun::read(&written(&run([1.0, 2.0]))).unwrap();
        assert!(run([1.0, 2.0]).disagreements(&earlier).is_empty());
        // Phong shading, now the fastest, beats flat shading.
        let told = run([1.0, 0.5]).disagreements(&earlier);
        assert!(told.len() == 2 && told.iter().all(|line| line.starts_with("sphere on cpu, ")), "{told:?}");
        assert!(told[0].contains("flat, 8 cells, at 1.00 × the reference frame and 5.00 steps off"), "{told:?}");
        assert!(told[1].contains("the whole picture: flat"), "{told:?}");
    }

    #[test]
    fn what_is_no_chart_is_told_by_its_place() {
        let whole = written(&run([1.0, 2.0]));
        for (text, told) in [
            ("[".to_owned(), "line 1"),
            ("{}".to_owned(), "`points`"),
            (whole.replacen("\"rms\"", "\"rmse\"", 20), "`points[0]`"),
            (whole.replace("\"phong\"", "3"), "`points[1]`"),
        ] {
            let error = EarlierRun::read(&text).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
    }
}
