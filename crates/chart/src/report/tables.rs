//! The report as CSV files.

use super::{NamedFile, Report};
use crate::measure::convergence::QUANTITIES;
use crate::measure::highlight::{Unsteadiness, unsteadiness};
use crate::measure::{SHADINGS, shading_name};
use crate::page::csv;

impl Report {
    /// Every table.
    pub(super) fn tables(&self) -> Vec<NamedFile> {
        let own = [
            ("convergence.csv".to_owned(), self.convergence_csv()),
            ("slopes.csv".to_owned(), self.slopes_csv()),
            ("highlight.csv".to_owned(), self.highlight_csv()),
            ("unsteadiness.csv".to_owned(), self.unsteadiness_csv()),
        ];
        self.fronts.tables().into_iter().chain(own).chain(self.scaling.tables()).collect()
    }

    /// How unsteady each of [`SHADINGS`] is, where that can be said.
    pub(super) fn unsteadiness(&self) -> [Option<Unsteadiness>; SHADINGS.len()] {
        self.energies.shaded.each_ref().map(|energies| unsteadiness(energies, &self.energies.truth))
    }

    fn convergence_csv(&self) -> String {
        let header = [
            "object",
            "material",
            "shading",
            "level",
            "triangles",
            "longest edge (units)",
            "largest error (linear)",
            "RMS error (linear)",
            "error that 95 % keep to (linear)",
        ];
        let rows = self.convergence.iter().flat_map(|found| {
            found.levels.iter().map(|level| {
                [
                    found.object.name().to_owned(),
                    found.surface.name().to_owned(),
                    shading_name(found.shading).to_owned(),
                    level.level.to_string(),
                    level.triangles.to_string(),
                    number(level.edge),
                    number(level.max()),
                    number(level.rms()),
                    number(level.common()),
                ]
            })
        });
        csv(header, rows)
    }

    fn slopes_csv(&self) -> String {
        let header = ["object", "material", "shading", "quantity", "slope"];
        let rows = self.convergence.iter().flat_map(|found| {
            QUANTITIES.into_iter().map(|(name, error)| {
                [
                    found.object.name().to_owned(),
                    found.surface.name().to_owned(),
                    shading_name(found.shading).to_owned(),
                    name.to_owned(),
                    found.order(error).map(number).unwrap_or_default(),
                ]
            })
        });
        csv(header, rows)
    }

    fn highlight_csv(&self) -> String {
        let [flat, gouraud, phong] = &self.energies.shaded;
        let rows = self.energies.truth.iter().enumerate().map(|(frame, truth)| {
            [frame.to_string(), number(*truth), number(flat[frame]), number(gouraud[frame]), number(phong[frame])]
        });
        let header = ["frame", "true surface (linear × pixels)", "flat", "Gouraud", "Phong"];
        csv(header, rows)
    }

    fn unsteadiness_csv(&self) -> String {
        let rows = SHADINGS.into_iter().zip(self.unsteadiness()).filter_map(|(shading, found)| {
            let Unsteadiness { rms, worst, worst_frame } = found?;
            Some([shading_name(shading).to_owned(), number(rms), number(worst), worst_frame.to_string()])
        });
        csv(["shading", "RMS (mean true energy = 1)", "worst (mean true energy = 1)", "worst frame"], rows)
    }
}

/// Five significant digits.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = value.abs().log10().floor() as i32;
    if (-3..6).contains(&exponent) {
        let decimals = usize::try_from(4 - exponent).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        format!("{value:.4e}")
    }
}

/// The text with its first letter as at the beginning of a sentence.
pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().collect::<String>() + letters.as_str()).unwrap_or_default()
}

/// Links to charts as SVG and to tables as CSV.
pub(super) fn files(charts: &[(&str, &str)], tables: &[(&str, &str)]) -> Vec<(String, String)> {
    let link =
        |what: &str, kind: &str, stem: &str, ending: &str| (format!("{what} ({kind})"), format!("{stem}.{ending}"));
    let charts = charts.iter().map(|(what, stem)| link(what, "SVG", stem, "svg"));
    charts.chain(tables.iter().map(|(what, stem)| link(what, "CSV", stem, "csv"))).collect()
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_keep_five_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1.0000"),
            (-0.012_345_6, "-0.012346"),
            (123_456.7, "123457"),
            (3.2e-7, "3.2000e-7"),
            (1e9, "1.0000e9"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
