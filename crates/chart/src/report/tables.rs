//! The report as CSV files.

use super::{NamedFile, Report};
use crate::measure::accuracy::Measured;
use crate::measure::convergence::QUANTITIES;
use crate::measure::highlight::{Unsteadiness, unsteadiness};
use crate::measure::{SHADINGS, shading_name};
use crate::page::csv;

impl Report {
    /// Every table.
    pub(super) fn tables(&self) -> Vec<NamedFile> {
        let own = [
            ("error.csv".to_owned(), self.error_csv()),
            ("convergence.csv".to_owned(), self.convergence_csv()),
            ("slopes.csv".to_owned(), self.slopes_csv()),
            ("highlight.csv".to_owned(), self.highlight_csv()),
            ("unsteadiness.csv".to_owned(), self.unsteadiness_csv()),
        ];
        own.into_iter().chain(self.scaling.tables()).collect()
    }

    /// How unsteady each of [`SHADINGS`] is, where that can be said.
    pub(super) fn unsteadiness(&self) -> [Option<Unsteadiness>; SHADINGS.len()] {
        self.energies.shaded.each_ref().map(|energies| unsteadiness(energies, &self.energies.truth))
    }

    fn error_csv(&self) -> String {
        let header = [
            "object",
            "level",
            "triangles",
            "shading",
            "reflectance",
            "viewer",
            "frame (ms)",
            "constant colour (ms)",
            "time (constant colour = 1)",
            "largest error (linear)",
            "RMS error (linear)",
            "largest error (8-bit steps)",
            "RMS error (8-bit steps)",
            "mean ꟻLIP",
            "covered by both (pixels)",
            "covered by the mesh only (pixels)",
            "covered by the surface only (pixels)",
        ];
        csv(header, self.accuracy.iter().map(error_row))
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

fn error_row(measured: &Measured) -> [String; 17] {
    let [reflectance, viewer] = measured.variant.names();
    let comparison = &measured.comparison;
    let coverage = comparison.coverage.unwrap_or_default();
    [
        measured.object.name().to_owned(),
        measured.level.to_string(),
        measured.triangles.to_string(),
        shading_name(measured.shading).to_owned(),
        reflectance.to_owned(),
        viewer.to_owned(),
        number(measured.frame_ms),
        number(measured.constant_ms),
        number(measured.ratio),
        number(comparison.linear.all.max()),
        number(comparison.linear.all.rmse),
        number(comparison.steps.all.max()),
        number(comparison.steps.all.rmse),
        number(measured.flip),
        coverage.both.to_string(),
        coverage.only_actual.to_string(),
        coverage.only_expected.to_string(),
    ]
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
