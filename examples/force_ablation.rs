//! Measures what each part of the force network contributes, and what more training cases would
//! bring.
//!
//! It prints two Markdown tables of errors and scores from a cross-validation over the training
//! cases of a data set: variants of the network with one part changed, and the default network
//! trained on different numbers of cases. The test cases of the data set are not used. The second
//! argument, if there is one, is a data set whose cases are added for the second table.
//!
//! `cargo run --release --example force_ablation -- \
//! datasets/fea datasets/fea-wide`

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::data::{Dataset, Outcome};
use impactlab_core::numerics::sha256_hex;
use impactlab_networks::force::metrics::{
    BAND_LEVELS, CurveMetrics, PointErrors, ProbabilisticScores, ProbabilisticSettings,
};
use impactlab_networks::force::{
    Centre, CrushConfig, CurvePrediction, ForceCase, ForceConfig, ForceModel, ForceScenario,
    NetworkConfig, TrainingConfig, fit_physics, train_around,
};
use impactlab_networks::learning::{TrainSettings, TrainingSet, folds, split};

type Answer<T> = Result<T, Box<dyn Error>>;

/// Seed of the split, the folds, the trainings and the draws.
const SEED: u64 = 0;
/// Number of folds of the cross-validation.
const N_FOLDS: usize = 3;
/// Number of curves drawn from a prediction to compute its probabilistic scores.
const N_DRAWS: usize = 500;

/// A configuration to train, with the errors and scores over the cases on which it was tested.
struct Variant {
    name: &'static str,
    config: ForceConfig,
    /// Whether contact point, position and body of the bullet are withheld from the prediction,
    /// which then knows only θ: masses, velocities and heading of the bullet.
    is_theta_alone: bool,
    /// Errors of each case, with whether the vehicles separate without hooking.
    errors: Vec<(bool, PointErrors)>,
    /// Probabilistic scores of each case, in the same order.
    scores: Vec<ProbabilisticScores>,
}

impl Variant {
    fn new(name: &'static str, config: ForceConfig) -> Self {
        Self { name, config, is_theta_alone: false, errors: Vec::new(), scores: Vec::new() }
    }

    /// Predicts the cases with a model and appends their errors and scores.
    fn add(&mut self, model: &ForceModel, cases: &[&ForceCase]) -> Answer<()> {
        for (i, case) in cases.iter().enumerate() {
            let scenario = match self.is_theta_alone {
                false => case.scenario.clone(),
                true => ForceScenario {
                    contact_m: None,
                    striking_position_m: None,
                    striking_body: None,
                    ..case.scenario.clone()
                },
            };
            let predicted = model.predict(&scenario)?;
            let settings = ProbabilisticSettings { n_samples: N_DRAWS, seed: SEED };
            self.scores.push(ProbabilisticScores::new(
                case,
                &predicted.mixture,
                settings,
                i as u64,
            )?);
            let prediction = CurvePrediction::from_mixture(predicted.mixture, &predicted.likely);
            self.errors.push((case.is_clean(), PointErrors::new(case, &prediction)));
        }
        Ok(())
    }

    /// Prints the row of the variant: point errors in %, shares of the recorded values inside the
    /// band in %, CRPS in kN and negative log-likelihood in nats.
    fn print(&self) {
        let of = |is_all: bool, scores: &[&ProbabilisticScores]| {
            let chosen: Vec<&PointErrors> =
                self.errors.iter().filter(|(clean, _)| is_all || *clean).map(|(_, e)| e).collect();
            CurveMetrics::new(&chosen, scores)
        };
        let scores: Vec<&ProbabilisticScores> = self.scores.iter().collect();
        let (Some(all), Some(clean)) = (of(true, &scores), of(false, &[])) else { return };
        let Some(spread) = all.probabilistic else { return };
        let percent = |share: f64| format!("{:.1}", 100.0 * share);
        let cells = [
            percent(clean.history_error.mean),
            percent(all.history_error.mean),
            percent(clean.rmse_over_peak.mean),
            percent(clean.impulse_error.median),
            percent(clean.peak_error.median),
            percent(clean.duration_error.median),
            percent(spread.force_n[2].share),
            percent(spread.impulse_n_s[2].share),
            percent(spread.peak_n[2].share),
            format!("{:.2}", spread.crps_force_n.mean / 1e3),
            format!("{:.0}", spread.nll_nats.median),
        ];
        println!("| {} | {} |", self.name, cells.join(" | "));
    }
}

fn header() {
    println!(
        "\n| | history | all cases | RMSE | impulse | peak | duration | F(t) in {0:.0} % | impulse \
         in | peak in | CRPS [kN] | NLL |",
        100.0 * BAND_LEVELS[2]
    );
    println!("|{}", " --- |".repeat(12));
}

/// Trains every variant on the cases of one fold and tests it on the others. Variants with the same
/// physics share its fit.
fn add_fold(
    variants: &mut [Variant],
    (train, test): (Vec<ForceCase>, &[&ForceCase]),
) -> Answer<()> {
    let set = TrainingSet { name: "fold".to_owned(), train, test: Vec::new() };
    let settings = |config: &ForceConfig| TrainSettings::unsaved(config.clone(), SEED);
    let mut fitted: Vec<((Centre, CrushConfig), _)> = Vec::new();
    for variant in variants {
        let key = (variant.config.network.centre, variant.config.crush);
        let settings = settings(&variant.config);
        let known = fitted.iter().find(|(of, _)| *of == key).map(|(_, physics)| physics);
        let physics = match known {
            Some(physics) => Clone::clone(physics),
            None => {
                let physics = fit_physics(&set, &settings, &mut |_| ControlFlow::Continue(()))?;
                fitted.push((key, physics.clone()));
                physics
            }
        };
        let model = train_around(physics, &set, &settings, &mut |_| ControlFlow::Continue(()))?;
        variant.add(&model, test)?;
        eprintln!("{}: {} cases", variant.name, variant.errors.len());
    }
    Ok(())
}

fn load(path: &str) -> Answer<Vec<ForceCase>> {
    let go_on = &mut |_: impactlab_core::jobs::Progress| ControlFlow::Continue(());
    match Dataset::load(Path::new(path), go_on)? {
        Outcome::Complete(data) => {
            Ok(data.cases.iter().filter_map(|case| ForceCase::from_case(case).ok()).collect())
        }
        Outcome::Cancelled => Ok(Vec::new()),
    }
}

/// Returns the training part of the split of a data set.
fn training_cases(path: &str, config: &ForceConfig) -> Answer<Vec<ForceCase>> {
    let cases = load(path)?;
    let parts = split(&cases, SEED, config.training.test_share);
    Ok(parts.train.iter().filter_map(|&idx| cases.get(idx).cloned()).collect())
}

/// Trains and tests every variant on each fold.
///
/// - `n_most`: largest number of cases of a fold to train on.
fn cross_validate(variants: &mut [Variant], cases: &[ForceCase], n_most: usize) -> Answer<()> {
    for fold in folds(cases, N_FOLDS, SEED) {
        let of = |indices: &[usize]| -> Vec<&ForceCase> {
            indices.iter().filter_map(|&idx| cases.get(idx)).collect()
        };
        // In the order of a hash, because the order of the files is not always random.
        let mut train = of(&fold.train);
        train.sort_by_cached_key(|case| {
            sha256_hex([&SEED.to_le_bytes()[..], case.digest.as_bytes()])
        });
        let seen = train.into_iter().take(n_most).cloned().collect();
        add_fold(variants, (seen, &of(&fold.test)))?;
    }
    Ok(())
}

/// Returns the default network and the variants in which one part of it is changed.
fn ablations(config: &ForceConfig) -> Vec<Variant> {
    let with = |change: fn(&mut NetworkConfig)| {
        let mut config = config.clone();
        change(&mut config.network);
        config
    };
    let untrained = ForceConfig {
        training: TrainingConfig { epochs: 1, learning_rate: 1e-12, ..config.training },
        ..config.clone()
    };
    let free = |network: &mut NetworkConfig| {
        network.centre = Centre::None;
        network.component_shift = 1.0;
    };
    let mut theta = Variant::new("the same, θ alone", config.clone());
    theta.is_theta_alone = true;
    vec![
        Variant::new("as shipped, all columns", config.clone()),
        theta,
        Variant::new("physics and its residuals alone, network untrained", untrained),
        Variant::new("without attention", with(|network| network.attention = false)),
        Variant::new("independent instants (no latent factors)", with(|n| n.factors = 0)),
        Variant::new("trunk of one layer of 16", with(|network| network.trunk = vec![16])),
        Variant::new(
            "the paper's trunk of 8 layers",
            with(|network| network.trunk = ForceConfig::paper().network.trunk),
        ),
        Variant::new("one component", with(|network| network.components = 1)),
        Variant::new(
            "crush model without regressions",
            with(|network| network.centre = Centre::Crush),
        ),
        Variant::new(
            "momentum solution instead of crush model",
            with(|network| network.centre = Centre::Momentum),
        ),
        Variant::new("without physics layer", with(free)),
    ]
}

fn main() -> Answer<()> {
    let mut arguments = std::env::args().skip(1);
    let data = arguments.next().unwrap_or_else(|| "datasets/fea".to_owned());
    let config = ForceConfig::default();
    let mut train = training_cases(&data, &config)?;
    let mut variants = ablations(&config);
    cross_validate(&mut variants, &train, usize::MAX)?;
    header();
    variants.iter().for_each(Variant::print);

    // Only with a second data set do two of the three folds hold more than 75 cases.
    if let Some(extra) = arguments.next() {
        train.extend(load(&extra)?);
    }
    header();
    for (name, n_cases) in
        [("20 cases", 20), ("40 cases", 40), ("75 cases", 75), ("two folds of three", usize::MAX)]
    {
        let mut variants = [Variant::new(name, config.clone())];
        cross_validate(&mut variants, &train, n_cases)?;
        variants[0].print();
    }
    Ok(())
}
