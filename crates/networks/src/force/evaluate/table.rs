//! An evaluation as tables for the terminal and for Markdown.

use crate::force::evaluate::{Evaluation, ForceMetrics};
use crate::force::metrics::{CurveMetrics, DistributionMetrics, IntervalCoverage};
use impactlab_core::numerics::Summary;

/// A title over a header and rows, all of one width.
struct MetricsTable {
    title: String,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Evaluation {
    /// Tables in columns of equal width.
    pub fn to_text(&self) -> String {
        self.tables().iter().map(MetricsTable::to_text).collect::<Vec<_>>().join("\n")
    }

    /// Tables in Markdown.
    pub fn to_markdown(&self) -> String {
        self.tables().iter().map(MetricsTable::to_markdown).collect::<Vec<_>>().join("\n")
    }

    fn tables(&self) -> Vec<MetricsTable> {
        let mut tables = vec![self.errors("all cases", |metrics| Some(&metrics.overall))];
        if self.metrics.separated.is_some() {
            let title = "without cases that hook or have not separated";
            tables.push(self.errors(title, |metrics| metrics.separated.as_ref()));
        }
        tables.extend(self.coverage());
        tables.extend(self.scores());
        tables.push(self.by_cluster());
        tables
    }

    fn models(&self) -> [(&str, &ForceMetrics); 4] {
        let baselines = &self.baselines;
        [
            (self.model.as_str(), &self.metrics),
            ("classic pulse", &baselines.pulse),
            ("nearest case", &baselines.nearest),
            ("Gaussian processes", &baselines.statistical),
        ]
    }

    fn errors<'a>(
        &'a self,
        title: &str,
        block: impl Fn(&'a ForceMetrics) -> Option<&'a CurveMetrics>,
    ) -> MetricsTable {
        let row = |(name, metrics): (&str, &'a ForceMetrics)| {
            let metrics = block(metrics)?;
            let errors = [
                metrics.history_error,
                metrics.rmse_over_peak,
                metrics.impulse_error,
                metrics.peak_error,
                metrics.duration_error,
            ];
            let cells = errors.iter().map(|error| median_and_mean(error, 100.0));
            Some(std::iter::once(name.to_owned()).chain(cells).collect())
        };
        let n_cases = block(&self.metrics).map_or(0, |metrics| metrics.n_cases);
        MetricsTable {
            title: format!("Median (mean) error in %, {title}: {n_cases}"),
            header: header(&["", "history", "RMSE/peak", "impulse", "peak", "duration"]),
            rows: self.models().into_iter().filter_map(row).collect(),
        }
    }

    fn with_distribution(&self) -> impl Iterator<Item = (&str, &DistributionMetrics)> {
        let models = self.models().into_iter();
        models.filter_map(|(name, metrics)| Some((name, metrics.overall.probabilistic.as_ref()?)))
    }

    fn coverage(&self) -> Option<MetricsTable> {
        let by_domain = [("in the domain", &self.domain.inside), ("outside", &self.domain.outside)];
        let by_domain = by_domain.into_iter().filter_map(|(name, metrics)| {
            let metrics = metrics.as_ref().filter(|_| self.domain.outside.is_some())?;
            Some((
                format!("{}, {} {name}", self.model, metrics.n_cases),
                metrics.probabilistic.as_ref()?,
            ))
        });
        let all =
            self.with_distribution().map(|(name, distribution)| (name.to_owned(), distribution));
        let rows = all.chain(by_domain).flat_map(|(name, distribution)| {
            let quantities = [
                ("F(t)", &distribution.force_n),
                ("impulse", &distribution.impulse_n_s),
                ("peak", &distribution.peak_n),
                ("duration", &distribution.duration_s),
            ];
            quantities.map(|(quantity, coverage)| {
                let labels = [name.clone(), quantity.to_owned()];
                labels.into_iter().chain(coverage.iter().map(share)).collect::<Vec<_>>()
            })
        });
        let rows: Vec<Vec<String>> = rows.collect();
        let header = header(&["", "bands of", "50 %", "80 %", "90 %", "95 %"]);
        let title = "Share inside the bands in %, ± standard error between cases".to_owned();
        (!rows.is_empty()).then_some(MetricsTable { title, header, rows })
    }

    fn scores(&self) -> Option<MetricsTable> {
        let rows = self.with_distribution().map(|(name, distribution)| {
            let scores = [
                (distribution.crps_force_n, 1e-3),
                (distribution.energy_score_n, 1e-3),
                (distribution.crps_impulse_n_s, 1e-3),
                (distribution.crps_peak_n, 1e-3),
                (distribution.crps_duration_s, 1e3),
                (distribution.nll_nats, 1.0),
            ];
            let cells = scores.iter().map(|(score, scale)| format!("{:.3}", score.mean * scale));
            std::iter::once(name.to_owned()).chain(cells).collect()
        });
        let rows: Vec<Vec<String>> = rows.collect();
        let header = header(&[
            "",
            "CRPS F(t) [kN]",
            "energy score [kN]",
            "CRPS |P| [kN s]",
            "CRPS peak [kN]",
            "CRPS duration [ms]",
            "NLL [nats]",
        ]);
        let title = "Mean scores, smaller is better".to_owned();
        (!rows.is_empty()).then_some(MetricsTable { title, header, rows })
    }

    fn by_cluster(&self) -> MetricsTable {
        let row = |cluster: &crate::force::evaluate::ClusterMetrics| {
            vec![
                cluster.name.clone(),
                cluster.model.n_cases.to_string(),
                format!("{:.2}", cluster.impulse_n_s * 1e-3),
                median_and_mean(&cluster.model.history_error, 100.0),
                median_and_mean(&cluster.statistical.history_error, 100.0),
            ]
        };
        MetricsTable {
            title: "History error in % by cluster of impulse, median (mean)".to_owned(),
            header: header(&["", "cases", "impulse [kN s]", &self.model, "Gaussian processes"]),
            rows: self.clusters.iter().map(row).collect(),
        }
    }
}

fn header(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn median_and_mean(summary: &Summary, scale: f64) -> String {
    format!("{:.1} ({:.1})", summary.median * scale, summary.mean * scale)
}

fn share(coverage: &IntervalCoverage) -> String {
    format!("{:.0} ± {:.0}", coverage.share * 100.0, coverage.standard_error * 100.0)
}

impl MetricsTable {
    fn to_text(&self) -> String {
        let lines = || std::iter::once(&self.header).chain(&self.rows);
        let width = |column: usize| {
            lines().filter_map(|line| line.get(column)).map(|cell| cell.chars().count()).max()
        };
        let pad = |line: &Vec<String>| {
            let cells = line.iter().enumerate().map(|(column, cell)| {
                let width = width(column).unwrap_or_default();
                // Names to the left, numbers to the right.
                if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
        };
        format!("{}\n\n{}", self.title, lines().map(pad).collect::<String>())
    }

    fn to_markdown(&self) -> String {
        let row = |line: &Vec<String>| format!("| {} |\n", line.join(" | "));
        let rule: Vec<String> = (0..self.header.len())
            .map(|column| if column == 0 { "---" } else { "---:" }.to_owned())
            .collect();
        let rows: String = self.rows.iter().map(row).collect();
        format!("**{}**\n\n{}{}{rows}", self.title, row(&self.header), row(&rule))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> MetricsTable {
        let row = |a: &str, b: &str| vec![a.to_owned(), b.to_owned()];
        MetricsTable {
            title: "Title".to_owned(),
            header: row("", "error"),
            rows: vec![row("the network", "1.0 (2.0)"), row("θ", "0.5")],
        }
    }

    #[test]
    fn columns_line_up() {
        let expected = "\
Title

                 error
the network  1.0 (2.0)
θ                  0.5
";
        assert_eq!(table().to_text(), expected);
    }

    #[test]
    fn markdown_is_a_table() {
        let expected = "\
**Title**

|  | error |
| --- | ---: |
| the network | 1.0 (2.0) |
| θ | 0.5 |
";
        assert_eq!(table().to_markdown(), expected);
    }
}
