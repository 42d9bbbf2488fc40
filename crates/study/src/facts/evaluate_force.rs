//! The facts of an evaluation of a force network.

use impactlab_core::numerics::Summary;
use impactlab_core::units::Quantity;
use impactlab_networks::force::metrics::{CurveMetrics, DistributionMetrics, IntervalCoverage};
use impactlab_networks::force::{Evaluation, ForceMetrics};

use crate::facts::training::left_out;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{CrossValidateForceReport, EvaluateForceReport, ForceEvaluation};

/// Takes one number of a summary.
type Statistic = fn(&Summary) -> f64;

/// What is told of the errors over the cases.
const STATISTICS: [(Term, Statistic); 3] =
    [(Term::Median, |of| of.median), (Term::Mean, |of| of.mean), (Term::Percentile90, |of| of.p90)];

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
        let problems = FactTable::lines(Term::Problems, &of.problems);
        let first = std::iter::once(FactTable::new(Term::ForceEvaluation, facts));
        first.chain(self.tables()).chain(problems).chain(left_out(&self.left_out)).collect()
    }

    /// The errors of the network and its baselines, and what their intervals hold.
    pub fn tables(&self) -> Vec<FactTable> {
        let of = &self.evaluation;
        let all = models(of).map(|(name, of)| (name, Some(&of.overall)));
        let mut tables = vec![errors(Term::ErrorsOfAll, all)];
        if of.metrics.separated.is_some() {
            let separated = models(of).map(|(name, of)| (name, of.separated.as_ref()));
            tables.push(errors(Term::ErrorsOfSeparated, separated));
        }
        tables.extend(coverage(of).into_iter().chain(scores(of)));
        tables.push(clusters(of));
        tables
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

/// The errors of each model.
fn errors<const N: usize>(title: Term, models: [(&str, Option<&CurveMetrics>); N]) -> FactTable {
    let rows = STATISTICS.into_iter().flat_map(|(term, statistic)| {
        models.into_iter().filter_map(move |(name, of)| {
            let of = of?;
            let errors = [
                &of.history_error,
                &of.rmse_over_peak,
                &of.impulse_error,
                &of.peak_error,
                &of.duration_error,
            ];
            let first = [Value::Term(term), Value::Count(of.n_cases)].into_iter();
            let values = first.chain(errors.map(|error| Value::Share(statistic(error))));
            Some(Fact::row(Value::Phrase(name.to_owned()), values.collect()))
        })
    });
    let columns = [
        Term::Statistic,
        Term::Cases,
        Term::HistoryError,
        Term::RmseOverPeak,
        Term::ImpulseError,
        Term::PeakError,
        Term::DurationError,
    ];
    table(title, rows.collect(), &columns)
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

/// The errors by cluster of impulse.
fn clusters(of: &Evaluation) -> FactTable {
    let rows = STATISTICS.into_iter().flat_map(|(term, statistic)| {
        of.clusters.iter().map(move |cluster| {
            let model = &cluster.model;
            let errors = [&model.history_error, &model.impulse_error, &model.peak_error];
            let errors = errors.into_iter().chain([&cluster.statistical.history_error]);
            let first = [
                Value::Term(term),
                Value::Count(model.n_cases),
                Value::Number(Quantity::Impulse, cluster.impulse_n_s),
            ];
            let values = errors.map(|error| Value::Share(statistic(error)));
            Fact::row(Value::Text(cluster.name.clone()), first.into_iter().chain(values).collect())
        })
    });
    let columns = [
        Term::Statistic,
        Term::Cases,
        Term::ClusterCentre,
        Term::HistoryError,
        Term::ImpulseError,
        Term::PeakError,
        Term::HistoryOfGaussianProcesses,
    ];
    let table = FactTable::new(Term::ErrorsByCluster, rows.collect());
    table.with_rows(Term::Cluster).with_columns(&columns)
}
