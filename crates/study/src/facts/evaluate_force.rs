//! The facts of an evaluation of a force network.

use impactlab_core::numerics::Summary;
use impactlab_core::units::Quantity;
use impactlab_networks::force::metrics::{CurveMetrics, DistributionMetrics, IntervalCoverage};
use impactlab_networks::force::{ClusterMetrics, Evaluation, ForceMetrics};

use crate::facts::training::left_out;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{CrossValidateForceReport, EvaluateForceReport, ForceEvaluation};

/// Columns of a table of errors.
const ERRORS: [Term; 5] = [
    Term::HistoryError,
    Term::RmseOverPeak,
    Term::ImpulseError,
    Term::PeakError,
    Term::DurationError,
];

impl ForceEvaluation {
    /// What the answer says: the errors of the network and its baselines, and what its intervals hold.
    pub fn facts(&self) -> Vec<FactTable> {
        match self {
            Self::Cases(report) => report.facts(),
            Self::Folds(report) => report.facts(),
        }
    }
}

impl EvaluateForceReport {
    /// What the answer says: the errors of the network and its baselines, what their intervals hold,
    /// and which cases are left out.
    pub fn facts(&self) -> Vec<FactTable> {
        let of = &self.evaluation;
        let facts = vec![
            Fact::new(Term::Cases, Value::Count(self.n_test)),
            Fact::new(Term::CasesOfTraining, Value::Count(self.n_trained_on)),
            Fact::new(Term::CasesOfBaselines, Value::Count(of.n_train)),
        ];
        let mut tables = vec![
            FactTable::new(Term::ForceEvaluation, facts),
            errors(Term::ErrorsOfAll, models(of).map(|(name, of)| (name, Some(&of.overall)))),
        ];
        if of.metrics.separated.is_some() {
            let separated = models(of).map(|(name, of)| (name, of.separated.as_ref()));
            tables.push(errors(Term::ErrorsOfSeparated, separated));
        }
        let problems = FactTable::lines(Term::Problems, &of.problems);
        let others = [coverage(of), scores(of), Some(clusters(of)), problems];
        let others = others.into_iter().chain([left_out(&self.left_out)]);
        tables.into_iter().chain(others.flatten()).collect()
    }
}

impl CrossValidateForceReport {
    /// The errors over all folds.
    fn facts(&self) -> Vec<FactTable> {
        let of = &self.validation;
        let folds = Fact::new(Term::Folds, Value::Count(of.folds.len()));
        let parts = [(Term::ErrorsOfAll, &of.overall), (Term::ErrorsOfSeparated, &of.separated)];
        let tables = parts.into_iter().filter_map(|(title, compared)| {
            let models = compared.as_ref()?.named();
            Some(errors(title, models.map(|(name, of)| (name, Some(of)))))
        });
        std::iter::once(FactTable::new(Term::CrossValidation, vec![folds])).chain(tables).collect()
    }
}

/// The network and its baselines.
fn models(of: &Evaluation) -> [(&str, &ForceMetrics); 4] {
    let baselines = &of.baselines;
    [
        (of.model.as_str(), &of.metrics),
        ("classic pulse", &baselines.pulse),
        ("nearest case", &baselines.nearest),
        ("Gaussian processes", &baselines.statistical),
    ]
}

/// A table with a row a model.
fn table(title: Term, rows: Vec<Fact>, columns: &[Term]) -> FactTable {
    FactTable::new(title, rows).with_rows(Term::NameOfModel).with_columns(columns)
}

/// Median and mean of the errors of each model.
fn errors<const N: usize>(title: Term, models: [(&str, Option<&CurveMetrics>); N]) -> FactTable {
    let row = |(name, of): (&str, Option<&CurveMetrics>)| {
        let of = of?;
        let errors = [
            &of.history_error,
            &of.rmse_over_peak,
            &of.impulse_error,
            &of.peak_error,
            &of.duration_error,
        ];
        let values = std::iter::once(Value::Count(of.n_cases)).chain(errors.map(median_and_mean));
        Some(Fact::row(Value::Phrase(name.to_owned()), values.collect()))
    };
    let columns: Vec<Term> = std::iter::once(Term::Cases).chain(ERRORS).collect();
    table(title, models.into_iter().filter_map(row).collect(), &columns)
}

fn median_and_mean(of: &Summary) -> Value {
    Value::beside(Value::Share(of.median), Value::Share(of.mean))
}

/// The distributions that the models predict.
fn distributions(of: &Evaluation) -> impl Iterator<Item = (&str, &DistributionMetrics)> {
    models(of).into_iter().filter_map(|(name, of)| Some((name, of.overall.probabilistic.as_ref()?)))
}

/// The shares of the observed values in the intervals of each model; of the network inside and outside
/// of its domain too.
fn coverage(of: &Evaluation) -> Option<FactTable> {
    let by_domain =
        [(Term::InDomain, &of.domain.inside), (Term::OutsideDomain, &of.domain.outside)];
    let by_domain = by_domain.into_iter().filter_map(|(term, metrics)| {
        let metrics = metrics.as_ref().filter(|_| of.domain.outside.is_some())?;
        let cases = Value::Joined(vec![Value::Count(metrics.n_cases), Value::Term(term)], " ");
        let name = vec![Value::Phrase(of.model.clone()), cases];
        Some((Value::Joined(name, ", "), metrics.probabilistic.as_ref()?))
    });
    let all = distributions(of).map(|(name, of)| (Value::Phrase(name.to_owned()), of));
    let rows = all.chain(by_domain).flat_map(|(name, of)| {
        let quantities = [
            (Term::ForceCurve, &of.force_n),
            (Term::Impulse, &of.impulse_n_s),
            (Term::PeakForce, &of.peak_n),
            (Term::ContactDuration, &of.duration_s),
        ];
        quantities.map(|(quantity, coverage)| {
            let share = |of: &IntervalCoverage| {
                Value::Joined([of.share, of.standard_error].map(Value::Share).to_vec(), " ± ")
            };
            let values = std::iter::once(Value::Term(quantity)).chain(coverage.iter().map(share));
            Fact::row(name.clone(), values.collect())
        })
    });
    let columns = [Term::BandOf, Term::Level50, Term::Level80, Term::Level90, Term::Level95];
    table(Term::Coverage, rows.collect(), &columns).unless_empty()
}

/// Mean scores of the predicted distributions.
fn scores(of: &Evaluation) -> Option<FactTable> {
    let rows = distributions(of).map(|(name, of)| {
        let scores = [
            (Quantity::Force, &of.crps_force_n),
            (Quantity::Force, &of.energy_score_n),
            (Quantity::Impulse, &of.crps_impulse_n_s),
            (Quantity::Force, &of.crps_peak_n),
            (Quantity::Time, &of.crps_duration_s),
            (Quantity::Ratio, &of.nll_nats),
        ];
        let values = scores.map(|(quantity, score)| Value::Number(quantity, score.mean));
        Fact::row(Value::Phrase(name.to_owned()), values.to_vec())
    });
    let columns = [
        Term::CrpsForce,
        Term::EnergyScore,
        Term::CrpsImpulse,
        Term::CrpsPeak,
        Term::CrpsDuration,
        Term::LogLikelihood,
    ];
    table(Term::Scores, rows.collect(), &columns).unless_empty()
}

/// The error of the history by cluster of impulse.
fn clusters(of: &Evaluation) -> FactTable {
    let row = |cluster: &ClusterMetrics| {
        let values = vec![
            Value::Count(cluster.model.n_cases),
            Value::Number(Quantity::Impulse, cluster.impulse_n_s),
            median_and_mean(&cluster.model.history_error),
            median_and_mean(&cluster.statistical.history_error),
        ];
        Fact::row(Value::Text(cluster.name.clone()), values)
    };
    let columns = [Term::Cases, Term::Impulse, Term::OfNetwork, Term::OfGaussianProcesses];
    let rows = of.clusters.iter().map(row).collect();
    FactTable::new(Term::ErrorsByCluster, rows).with_rows(Term::Cluster).with_columns(&columns)
}
