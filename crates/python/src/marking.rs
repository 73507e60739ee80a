//! Reports of marked pictures as dictionaries.

use halfway::reference::marking::{Cause, Examined, Explanation, Rubric};
use halfway::reference::mistakes::Mistake;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The keys are those of `halfway mark --json`.
pub(crate) fn report<'py>(py: Python<'py>, examined: &Examined, rubric: &Rubric) -> PyResult<Bound<'py, PyDict>> {
    let diagnosis = examined.diagnosis.as_ref();
    let explained = |explanation: &Explanation| explanation_dict(py, examined, explanation);
    let explanations = diagnosis.map_or(&[][..], |it| &it.explanations).iter().map(explained);
    let report = PyDict::new(py);
    report.set_item("passes", examined.passes())?;
    report.set_item("mark", examined.mark(rubric))?;
    report.set_item("points", rubric.points())?;
    report.set_item("right", diagnosis.map_or(1.0, |it| it.right))?;
    report.set_item("explanations", explanations.collect::<PyResult<Vec<_>>>()?)?;
    report.set_item("nearest", diagnosis.and_then(|it| it.nearest.as_ref()).map(explained).transpose()?)?;
    Ok(report)
}

fn explanation_dict<'py>(
    py: Python<'py>,
    examined: &Examined,
    explanation: &Explanation,
) -> PyResult<Bound<'py, PyDict>> {
    let mistake = |mistake: &Mistake| {
        let entry = PyDict::new(py);
        entry.set_item("name", mistake.name())?;
        entry.set_item("explanation", mistake.explanation())?;
        entry.set_item("remedy", mistake.remedy())?;
        Ok(entry)
    };
    let cause = |cause: &Cause| cause.alternatives.iter().map(mistake).collect::<PyResult<Vec<_>>>();
    let area = PyDict::new(py);
    area.set_item("from", explanation.area.from)?;
    area.set_item("to", explanation.area.to)?;
    let entry = PyDict::new(py);
    entry.set_item("causes", explanation.causes.iter().map(cause).collect::<PyResult<Vec<_>>>()?)?;
    entry.set_item("share", explanation.share)?;
    entry.set_item("area", area)?;
    entry.set_item("object", examined.object(explanation))?;
    Ok(entry)
}
