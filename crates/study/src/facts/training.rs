//! The facts of trainings, and of the models that they give.

use serde::Serialize;
use serde_json::Value as Json;

use impactlab_core::units::Quantity;
use impactlab_networks::force::{ForceConfig, ForceModel, VarianceFactors};
use impactlab_networks::learning::TrainingRecord;
use impactlab_networks::response::{
    ForceOrigin, LATENT_NAMES, LatentScales, ResponseConfig, ResponseModel,
};

use crate::facts::{Fact, FactTable, Term, Value};
use crate::{LogReport, ResponseTrainingReport, TrainForceReport};

impl TrainForceReport {
    /// What the answer says: what was learned from, how well, and which cases are left out.
    pub fn facts(&self) -> Vec<FactTable> {
        let mut facts = self.model_facts();
        facts.push(factors_fact(Term::VarianceFactors, &self.variance_factors.near));
        let far = self.variance_factors.far.map(|far| far.factors);
        facts.extend(far.map(|far| factors_fact(Term::FarVarianceFactors, &far)));
        facts.push(time(self.seconds));
        let losses = self.train.zip(self.validation).map(|(train, validation)| {
            let row = |((name, train), (_, validation))| loss_row(name, &[train, validation]);
            let rows = train.named().into_iter().zip(validation.named()).map(row).collect();
            loss_table(rows, &[Term::OfTraining, Term::OfValidation])
        });
        let tables = [Some(FactTable::new(Term::ForceTraining, facts)), losses];
        tables.into_iter().chain([left_out(&self.left_out)]).flatten().collect()
    }

    fn model_facts(&self) -> Vec<Fact> {
        let count = |term, n| Fact::new(term, Value::Count(n));
        let best = Value::CountOf(self.best_epoch, self.epochs);
        let mut facts = vec![
            count(Term::CasesLearned, self.n_train),
            count(Term::CasesForValidation, self.n_validation),
            count(Term::CasesForTest, self.n_test),
            Fact::new(Term::BestEpoch, best),
        ];
        let loss = |loss| Fact::number(Term::ValidationLoss, Quantity::Ratio, loss);
        facts.extend(self.validation.map(|terms| loss(terms.total)));
        facts.push(count(Term::Weights, self.n_parameters));
        facts
    }
}

fn factors_fact(term: Term, factors: &VarianceFactors) -> Fact {
    let factors = [
        ("impulse", factors.impulse.unwrap_or(factors.shared)),
        ("latent factors", factors.shared),
        ("single instants", factors.single),
        ("duration", factors.duration),
        ("peaks", factors.peak.scale),
        ("spread of peaks", factors.peak.spread),
    ];
    Fact::new(term, Value::named(factors.map(|(name, factor)| (name, Value::Fixed(factor, 2)))))
}

impl ResponseTrainingReport {
    /// What the answer says: what was learned from, how well, what was made of each log, and which
    /// cases are left out.
    pub fn facts(&self) -> Vec<FactTable> {
        let LatentScales { scales, n_calibrated, .. } = self.latents;
        let scales = LATENT_NAMES.into_iter().zip(scales.map(Value::Share));
        let mut facts = self.model_facts();
        facts.extend([
            Fact::new(Term::LatentScales, Value::named(scales)),
            Fact::new(Term::CalibratedOn, calibration(n_calibrated, self.keeps_latents)),
            time(self.seconds),
        ]);
        let losses = self.loss.map(|loss| {
            let rows = loss.named().into_iter().map(|(name, value)| loss_row(name, &[value]));
            loss_table(rows.collect(), &[Term::OfTraining])
        });
        let first = [Some(FactTable::new(Term::ResponseTraining, facts)), losses];
        let logs = self.logs.iter().map(|log| Some(log.table()));
        first.into_iter().chain(logs).chain([left_out(&self.left_out)]).flatten().collect()
    }

    fn model_facts(&self) -> Vec<Fact> {
        let count = |term, n| Fact::new(term, Value::Count(n));
        let mut facts = vec![
            count(Term::Motions, self.n_simulated),
            count(Term::TrajectoriesLearned, self.train.len()),
            count(Term::TrajectoriesForTest, self.n_test),
            count(Term::Epochs, self.epochs),
        ];
        let loss = |loss| Fact::number(Term::LastLoss, Quantity::Ratio, loss);
        facts.extend(self.loss.map(|terms| loss(terms.total)));
        facts.push(count(Term::Weights, self.n_parameters));
        facts
    }
}

impl LogReport {
    /// What was made of the log.
    fn table(&self) -> FactTable {
        let seconds = |s| Value::Decimals(Quantity::Time, s, 2);
        let contact = self.contact_s.map(|ends| Value::span(ends.map(seconds)));
        let force = match self.force {
            ForceOrigin::Recorded => Term::ForceRecorded,
            ForceOrigin::Estimated => Term::ForceEstimated,
            ForceOrigin::None => Term::None,
        };
        let mut facts = vec![
            Fact::new(Term::Contact, contact.unwrap_or(Value::Term(Term::None))),
            Fact::new(Term::MotionFrom, seconds(self.start_s)),
            Fact::new(Term::ForceOrigin, Value::Term(force)),
        ];
        if self.force != ForceOrigin::None {
            facts.push(Fact::vector(Term::Impulse, Quantity::Impulse, self.impulse_n_s));
        }
        let noise = &self.noise;
        let noise = [
            (Term::PositionNoise, Quantity::Length, Some(noise.position_m), 3),
            (Term::YawNoise, Quantity::Angle, Some(noise.yaw_rad), 2),
            (Term::VelocityNoise, Quantity::Speed, noise.velocity_m_s, 2),
            (Term::YawRateNoise, Quantity::AngularVelocity, noise.yaw_rate_rad_s, 2),
        ];
        facts.push(Fact::new(Term::States, Value::Count(self.n_samples)));
        facts.extend(noise.into_iter().filter_map(|(term, quantity, si, decimals)| {
            Some(Fact::new(term, Value::Decimals(quantity, si?, decimals)))
        }));
        FactTable::new(Value::File(self.log.clone()), facts)
    }
}

/// What is known of a model of the force network.
pub fn force_model_table(model: &ForceModel) -> FactTable {
    let mut facts = TrainForceReport::new(model, 0.0, Vec::new()).model_facts();
    facts.extend(origin(model.record()));
    FactTable::new(Term::ForceTraining, facts)
}

/// What is known of a model of the response network.
pub fn response_model_table(model: &ResponseModel) -> FactTable {
    let (record, n_calibrated) = (model.record(), model.latents().n_calibrated);
    let report = ResponseTrainingReport::new(model, 0.0, (Vec::new(), Vec::new()));
    let mut facts = report.model_facts();
    // What is uncertain is known of a fleet by its cars, of a single car by its trajectories.
    facts.push(match model.population() {
        Some(population) => Fact::new(Term::CarsKnown, Value::Count(population.cars().len())),
        None => {
            Fact::new(Term::CalibratedOn, calibration(n_calibrated, record.detail.keeps_latents))
        }
    });
    facts.extend(origin(record));
    FactTable::new(Term::ResponseTraining, facts)
}

/// The settings of a model of the force network that are not the usual ones; none without any.
pub fn force_settings_table(model: &ForceModel) -> Option<FactTable> {
    settings_table(model.config(), &ForceConfig::default())
}

/// The settings of a model of the response network that are not the usual ones; none without any.
pub fn response_settings_table(model: &ResponseModel) -> Option<FactTable> {
    settings_table(model.config(), &ResponseConfig::default())
}

/// The settings that differ from the usual ones, by their names in a settings file.
fn settings_table<C: Serialize>(config: &C, usual: &C) -> Option<FactTable> {
    let mut facts = Vec::new();
    if let (Ok(config), Ok(usual)) = (serde_json::to_value(config), serde_json::to_value(usual)) {
        differences(String::new(), &config, Some(&usual), &mut facts);
    }
    FactTable::new(Term::UnusualSettings, facts).unless_empty()
}

fn differences(name: String, value: &Json, usual: Option<&Json>, found: &mut Vec<Fact>) {
    if Some(value) == usual {
        return;
    }
    match value {
        Json::Object(fields) => {
            for (key, field) in fields {
                let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                differences(name, field, usual.and_then(|usual| usual.get(key)), found);
            }
        }
        _ => found.push(Fact::row(Value::Text(name), vec![Value::Text(value.to_string())])),
    }
}

/// Data, seed and program of a training.
fn origin<E, T>(record: &TrainingRecord<E, T>) -> [Fact; 3] {
    let (seed, data) = (record.seed.to_string(), in_short(&record.data));
    [(Term::Seed, &seed), (Term::Program, &record.version), (Term::Data, &data)]
        .map(|(term, text)| Fact::new(term, Value::Text(text.clone())))
}

/// Most data sets that are all named.
const MOST_NAMED: usize = 4;

/// Names of the data sets of a training, of many the first ones and how many more there are.
fn in_short(data: &str) -> String {
    let names: Vec<&str> = data.split(" and ").collect();
    match names.split_at_checked(MOST_NAMED - 1) {
        Some((first, others)) if names.len() > MOST_NAMED => {
            format!("{} + {}", first.join(", "), others.len())
        }
        _ => data.to_owned(),
    }
}

/// What the standard deviations of the latent factors come from.
fn calibration(n: usize, keeps_latents: bool) -> Value {
    let of = |term| Value::Joined(vec![Value::Count(n), Value::Term(term)], " ");
    match (n, keeps_latents) {
        (0, true) => Value::Term(Term::GuessOfModelBefore),
        (0, false) => Value::Term(Term::UsualValues),
        (_, true) => of(Term::TrajectoriesOfModelBefore),
        (_, false) => of(Term::UnseenTrajectories),
    }
}

fn time(seconds: f64) -> Fact {
    Fact::new(Term::ComputingTime, Value::Decimals(Quantity::Time, seconds, 0))
}

fn loss_row(name: &str, losses: &[f64]) -> Fact {
    let values = losses.iter().map(|loss| Value::Fixed(*loss, 4)).collect();
    Fact::row(Value::Phrase(name.to_owned()), values)
}

fn loss_table(rows: Vec<Fact>, columns: &[Term]) -> FactTable {
    FactTable::new(Term::Losses, rows).with_rows(Term::LossTerm).with_columns(columns)
}

/// Cases that are left out; none without any.
pub(super) fn left_out(cases: &[String]) -> Option<FactTable> {
    FactTable::lines(Term::CasesLeftOut, cases)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::FactWriter;
    use impactlab_core::units::{Language, NumberFormat, UnitSystem};
    use impactlab_networks::force::LossTerms;

    fn report() -> TrainForceReport {
        let (train, validation) = (LossTerms::default(), LossTerms::default());
        TrainForceReport {
            data: "fea".to_owned(),
            data_digest: String::new(),
            n_train: 60,
            n_validation: 15,
            n_test: 25,
            n_parameters: 1000,
            seconds: 61.4,
            best_epoch: 3,
            epochs: 7,
            variance_factors: Default::default(),
            train: Some(train),
            validation: Some(validation),
            left_out: vec!["c007: no force".to_owned()],
        }
    }

    #[test]
    fn of_many_data_sets_the_first_are_named() {
        assert_eq!(in_short("fea and pulse"), "fea and pulse");
        assert_eq!(in_short("a and b and c and d"), "a and b and c and d");
        assert_eq!(in_short("a and b and c and d and e"), "a, b, c + 2");
    }

    #[test]
    fn a_training_gives_its_counts_losses_and_what_it_left_out_in_each_language() {
        let english = FactWriter::english(UnitSystem::Si);
        let format = NumberFormat { language: Language::De, ..english.format };
        for (writer, best, time) in [
            (english, "best epoch: 3 of 7", "computing time: 61 s"),
            (FactWriter { format, ..english }, "beste Epoche: 3 von 7", "Rechenzeit: 61 s"),
        ] {
            let [facts, losses, left_out] = &report().facts()[..] else { panic!() };
            let rows = facts.to_text(&writer).rows.into_iter().map(|row| row.cells.join(": "));
            let rows: Vec<String> = rows.collect();
            assert!([best, time].iter().all(|fact| rows.iter().any(|row| row == fact)), "{rows:?}");
            let losses = losses.to_text(&writer);
            assert!(losses.rows.iter().all(|row| row.cells.len() == losses.header.len()));
            assert_eq!(left_out.to_text(&writer).rows[0].cells, ["c007: no force"]);
        }
    }

    #[test]
    fn settings_that_differ_are_named_as_in_a_file() {
        let usual = ForceConfig::default();
        assert_eq!(settings_table(&usual, &usual), None);
        let mut other = usual.clone();
        other.training.epochs = 7;
        other.network.trunk = vec![3];
        let table = settings_table(&other, &usual).unwrap();
        let text = table.to_text(&FactWriter::english(UnitSystem::Si));
        let cells: Vec<String> = text.rows.iter().map(|row| row.cells.join(" ")).collect();
        assert_eq!(cells, ["network.trunk [3]", "training.epochs 7"]);
    }
}
