//! Measures what each part of the response network contributes. It prints a Markdown table from a
//! cross-validation over the training trajectories of a data set, whose test trajectories are not
//! used.
//!
//! In every fold the network learns from the same number of trajectories, which a seed chooses
//! among the training part of the fold, and predicts the others from their recorded forces.
//! Pre-training uses the forces of all training trajectories, but none of their motions. Each row
//! is printed as soon as it is known.
//!
//! `cargo run --release --example response_ablation -- \
//! --data datasets/trajectories-fea --trajectories 20 --choices 2`

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Parser;
use impactlab_core::data::Outcome;
use impactlab_core::numerics::median;
use impactlab_networks::learning::{
    TEST_SHARE, TrainSettings, TrainingReport, TrainingSet, folds, split,
};
use impactlab_networks::response::{
    Correction, ImpactRecord, N_RESIDUAL, PhysicsTrend, ResponseCase, ResponseConfig,
    ResponseModel, ResponseTrainSettings, STEP_S, average_error_m, fine_tune, pretrain, rollout,
};

type Answer<T> = Result<T, Box<dyn Error>>;

/// Seed of the split into training and test trajectories, which is the default of the commands. The
/// test part is not used.
const SPLIT_SEED: u64 = 0;
/// Seed that assigns the trajectories to folds.
const FOLD_SEED: u64 = 7;
/// Factor in the seed of a training, `choice · CHOICE_STRIDE + fold`.
const CHOICE_STRIDE: u64 = 10;
/// Times after the start of the impact at which the predicted regions of the position are tested,
/// s.
const INSTANTS_S: [f64; 5] = [0.5, 1.0, 2.0, 3.0, 3.99];
/// Probabilities of the predicted regions that are tested.
const LEVELS: [f64; 2] = [0.5, 0.9];
/// Bounds of the offsets of v_x and v_y, m/s, and of r and φ̇, rad/s, in one step, for the variant
/// with the paper's offset of the state.
const PAPER_OFFSET: [f64; N_RESIDUAL] = [5.0, 3.0, 1.0, 0.8];

#[derive(Parser)]
struct Arguments {
    /// A trajectory data set
    #[arg(long, default_value = "datasets/trajectories-fea")]
    data: PathBuf,
    /// How many trajectories each training learns from
    #[arg(long, default_value_t = 20)]
    trajectories: usize,
    /// How many choices of them, by the seeds 0, 1, …
    #[arg(long, default_value_t = 1)]
    choices: u64,
    /// Folds of the cross-validation, 2 to 10
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(2..=10))]
    folds: u64,
    /// Settings (TOML) that the variants depart from
    #[arg(long)]
    config: Option<PathBuf>,
    /// Only the variants whose name contains this
    #[arg(long)]
    only: Option<String>,
}

/// A configuration to train.
struct Variant {
    name: &'static str,
    config: ResponseConfig,
    /// Whether fine-tuning starts from a pre-trained network; otherwise from random weights.
    is_pretrained: bool,
}

/// Results over the trajectories on which the trainings were tested.
#[derive(Default)]
struct Scores {
    /// Average position error of each trajectory, m.
    errors_m: Vec<f64>,
    /// Number of recorded positions inside the predicted region of each level.
    inside: [usize; LEVELS.len()],
    /// Number of recorded positions that were tested.
    n_positions: usize,
    /// Total time of all trainings, including their calibration, s.
    fine_tuning_s: f64,
    n_trainings: usize,
}

impl Scores {
    /// Predicts a trajectory with a model and adds its error and coverage.
    fn add(&mut self, model: &ResponseModel, case: &ResponseCase) -> Answer<()> {
        let Some(initial) = case.states.first() else { return Ok(()) };
        let predictor = model.predictor(&case.vehicle)?;
        let path = predictor.central_path(initial, &case.inputs);
        self.errors_m.push(average_error_m(&path, &case.states));
        let motion = predictor.forecast(initial, &case.inputs);
        for time_s in INSTANTS_S {
            let idx = (time_s / STEP_S).round() as usize;
            let Some(state) = case.states.get(idx) else { continue };
            let level = motion.position(idx).level_of([state.x_m, state.y_m]);
            for (inside, wanted) in self.inside.iter_mut().zip(LEVELS) {
                *inside += usize::from(level <= wanted);
            }
            self.n_positions += 1;
        }
        Ok(())
    }

    /// Prints the row of a variant.
    fn print(self, name: &str, pretraining_s: Option<f64>) {
        let n = self.errors_m.len();
        let mean = self.errors_m.iter().sum::<f64>() / n.max(1) as f64;
        let median = median(self.errors_m.iter().copied()).unwrap_or(f64::NAN);
        let largest = self.errors_m.iter().copied().fold(f64::NAN, f64::max);
        let share = |inside: usize| match self.n_positions {
            0 => "–".to_owned(),
            n => format!("{:.0}", 100.0 * inside as f64 / n as f64),
        };
        let [half, most] = self.inside.map(share);
        let pretraining = pretraining_s.map_or("–".to_owned(), |s| format!("{s:.0}"));
        let fine_tuning = match self.n_trainings {
            0 => "–".to_owned(),
            n => format!("{:.0}", self.fine_tuning_s / n as f64),
        };
        println!(
            "| {name} | {mean:.3} | {median:.3} | {largest:.2} | {half} | {most} | {pretraining} | \
             {fine_tuning} | {n} |"
        );
    }
}

fn header() {
    println!(
        "| | mean [m] | median [m] | largest [m] | in {:.0} % | in {:.0} % | pre-training [s] | \
         fine-tuning [s] | predictions |",
        100.0 * LEVELS[0],
        100.0 * LEVELS[1]
    );
    println!("|{}", " --- |".repeat(9));
}

/// Returns the default network and the variants in which one part of it is changed.
fn ablations(config: &ResponseConfig) -> Vec<Variant> {
    let with = |name, change: &dyn Fn(&mut ResponseConfig)| {
        let mut config = config.clone();
        change(&mut config);
        Variant { name, config, is_pretrained: true }
    };
    let offset = |config: &mut ResponseConfig| {
        let network = &mut config.network;
        network.correction = Correction::StateOffset;
        network.effects = false;
        network.bound = Some(PAPER_OFFSET);
        // The network's output is an offset of the state in one step here, and an acceleration
        // otherwise. Scaling the unit by the step makes an output of one change the state by the
        // same amount.
        network.unit = network.unit.map(|unit| unit * STEP_S);
    };
    let mut fresh = with("without pre-training", &|_| ());
    fresh.is_pretrained = false;
    let mut variants = vec![
        with("default", &|_| ()),
        with("single steps alone, no rollouts", &|config| config.rollouts.lengths.clear()),
        fresh,
        with("without the 4DOF centre", &|config| *config = config.plain()),
        with("the paper's offset of the state", &offset),
        with("without the known effects", &|config| config.network.effects = false),
        with("without physics loss", &|config| config.loss.physics = 0.0),
    ];
    let trends = [
        ("λ as printed", PhysicsTrend::Paper),
        ("λ falls", PhysicsTrend::Decay),
        ("λ falls, largest far from the data", PhysicsTrend::InverseQuality),
    ];
    for (name, trend) in trends.into_iter().filter(|(_, trend)| *trend != config.physics.trend) {
        variants.push(with(name, &|config| config.physics.trend = trend));
    }
    variants
}

/// Returns the part of a configuration on which pre-training depends. Configurations that agree in
/// it share the pre-trained model.
fn pretraining_part(config: &ResponseConfig) -> ResponseConfig {
    let mut part = ResponseConfig {
        network: config.network.clone(),
        pretraining: config.pretraining,
        single_steps: config.single_steps,
        loss: config.loss,
        ..ResponseConfig::default()
    };
    part.loss.physics = 0.0;
    part
}

fn settings(config: &ResponseConfig, seed: u64) -> ResponseTrainSettings {
    TrainSettings::unsaved(config.clone(), seed)
}

fn go_on(_: &TrainingReport) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Pre-trained models with the part of the configuration and the seed on which they depend, and the
/// duration of each pre-training, s.
#[derive(Default)]
struct Pretrained(Vec<((ResponseConfig, u64), ResponseModel, f64)>);

impl Pretrained {
    /// Returns the pre-trained model of a configuration and the duration of its training, s. It is
    /// trained the first time it is asked for.
    ///
    /// - `records`: forces of the trajectories, from which the simulations are generated.
    fn get(
        &mut self,
        config: &ResponseConfig,
        seed: u64,
        records: &[ImpactRecord],
    ) -> Answer<(&ResponseModel, f64)> {
        let key = (pretraining_part(config), seed);
        let idx = match self.0.iter().position(|(of, ..)| *of == key) {
            Some(idx) => idx,
            None => {
                let started = Instant::now();
                let model = pretrain("folds", records, &settings(config, seed), &mut go_on)?;
                self.0.push((key, model, started.elapsed().as_secs_f64()));
                self.0.len() - 1
            }
        };
        let (_, model, seconds) = &self.0[idx];
        Ok((model, *seconds))
    }
}

/// Trains and tests a variant on every fold for every choice of trajectories, and prints its row.
fn cross_validate(
    variant: &Variant,
    cases: &[ResponseCase],
    arguments: &Arguments,
    pretrained: &mut Pretrained,
) -> Answer<()> {
    let records: Vec<ImpactRecord> = cases.iter().filter_map(ResponseCase::impact).collect();
    let (mut scores, mut pretraining_s) = (Scores::default(), None);
    for choice in 0..arguments.choices {
        let start = match variant.is_pretrained && variant.config.pretraining.epochs > 0 {
            true => Some(pretrained.get(&variant.config, choice, &records)?),
            false => None,
        };
        if let Some((_, seconds)) = start {
            pretraining_s = Some(pretraining_s.unwrap_or(0.0) + seconds / arguments.choices as f64);
        }
        for (i, fold) in folds(cases, arguments.folds as usize, FOLD_SEED).iter().enumerate() {
            let seed = choice * CHOICE_STRIDE + i as u64;
            let seen: Vec<ResponseCase> =
                fold.train.iter().map(|&idx| cases[idx].clone()).collect();
            let n = Some(arguments.trajectories);
            let set = TrainingSet::from_split("fold", &seen, SPLIT_SEED, 0.0).choose(n, seed)?;
            let started = Instant::now();
            let model = fine_tune(
                start.map(|(model, _)| model),
                &set,
                &settings(&variant.config, seed),
                &mut go_on,
            )?;
            scores.fine_tuning_s += started.elapsed().as_secs_f64();
            scores.n_trainings += 1;
            for &idx in &fold.test {
                scores.add(&model, &cases[idx])?;
            }
            eprintln!("{}: choice {choice}, fold {i}", variant.name);
        }
    }
    scores.print(variant.name, pretraining_s);
    Ok(())
}

/// Prints the row of the 4DOF model with the parameters of the vehicle's data sheet.
fn print_four_dof(cases: &[ResponseCase]) {
    let mut scores = Scores::default();
    for case in cases {
        let Some(initial) = case.states.first() else { continue };
        let path = rollout(&case.vehicle, *initial, &case.inputs, [0.0; N_RESIDUAL]);
        scores.errors_m.push(average_error_m(&path, &case.states));
    }
    scores.print("4DOF model, untuned", None);
}

/// Returns the training part of the split of a data set.
fn training_cases(path: &Path) -> Answer<Vec<ResponseCase>> {
    let go_on = &mut |_: impactlab_core::jobs::Progress| ControlFlow::Continue(());
    let Outcome::Complete(cases) = ResponseCase::load_all(path, None, go_on)? else {
        return Ok(Vec::new());
    };
    let parts = split(&cases, SPLIT_SEED, TEST_SHARE);
    Ok(parts.train.iter().filter_map(|&idx| cases.get(idx).cloned()).collect())
}

fn main() -> Answer<()> {
    let arguments = Arguments::parse();
    let config = match &arguments.config {
        Some(path) => ResponseConfig::load(path)?,
        None => ResponseConfig::default(),
    };
    if config.pretraining.epochs == 0 {
        eprintln!("pretraining.epochs is 0: no variant is pre-trained");
    }
    let cases = training_cases(&arguments.data)?;
    let wanted = arguments.only.as_deref().unwrap_or_default();
    let mut pretrained = Pretrained::default();
    header();
    print_four_dof(&cases);
    for variant in ablations(&config).iter().filter(|variant| variant.name.contains(wanted)) {
        cross_validate(variant, &cases, &arguments, &mut pretrained)?;
    }
    Ok(())
}
