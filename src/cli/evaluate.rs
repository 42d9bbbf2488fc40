//! `impactlab evaluate force`: how well a force network does, beside its baselines.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, ValueEnum};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::evaluate_response::{self, EvaluateResponseArgs};
use crate::cli::output::{print_json, print_table};
use crate::cli::progress::{complete, with_progress};
use crate::cli::run::{Console, Verdict};
use crate::data::write_atomically;
use crate::force::metrics::Figures;
use crate::force::{
    ColumnSet, CrossValidation, Evaluation, EvaluationSettings, ForceCase, cross_validate,
    evaluate_model,
};
use crate::shipped::ModelSource;

/// Measure a trained network against data
#[derive(Debug, Args)]
pub(super) struct EvaluateArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// The force network beside classic pulse, nearest case and Gaussian processes
    Force(EvaluateForceArgs),
    /// A response network on trajectories
    Response(EvaluateResponseArgs),
}

/// Which cases of the data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum SplitArg {
    /// Those that the model was not trained on, recognised by their content
    Test,
    /// All, also those that it was trained on
    All,
}

/// What is known of a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ColumnsArg {
    /// Masses, velocities, angle, contact point, bullet body
    Full,
    /// Masses, velocities, angle: the rest is left open
    Theta,
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
struct EvaluateForceArgs {
    /// A trained force network: `shipped` or a file
    #[arg(long, value_name = "MODEL")]
    model: ModelSource,
    /// A force data set
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// Which of its cases
    #[arg(long, value_enum, default_value_t = SplitArg::Test)]
    split: SplitArg,
    /// What is known of each scenario
    #[arg(long, value_enum, default_value_t = ColumnsArg::Full)]
    columns: ColumnsArg,
    /// Instead: train anew with the model's settings in K folds of its training cases, so that no
    /// test case is looked at
    #[arg(long, value_name = "K")]
    cross_validate: Option<usize>,
    /// Seed of folds, clusters and draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Folder for evaluation.json and evaluation.md
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  impactlab evaluate force --model shipped --data datasets/fea --json
  impactlab evaluate force --model shipped --data datasets/fea \\
      --columns theta --out evaluation

The baselines are fitted here, to the cases that the model was trained on, which it carries.

JSON: overall and separated (without hooked and unseparated cases), each with rmse_over_peak,
  history_error, impulse_error, peak_error, duration_error {mean, median, p90}, coverage {50, 80,
  90, 95} and more; baselines {pulse, nearest, statistical}, each with overall and separated;
  clusters, cases, n_train, columns, split, problems";

#[derive(Debug, Serialize)]
struct Answer<'a> {
    model_file: &'a ModelSource,
    data: &'a Path,
    split: SplitArg,
    n_test: usize,
    n_trained_on: usize,
    #[serde(flatten)]
    evaluation: &'a Evaluation,
}

/// Evaluates what was asked for.
pub(super) fn run(args: &EvaluateArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    match &args.what {
        What::Force(args) => evaluate_force(args, console),
        What::Response(args) => evaluate_response::run(args, console),
    }
}

fn evaluate_force(
    args: &EvaluateForceArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let model = args.model.force_model()?;
    let cases = complete(with_progress(|report| ForceCase::load_all(&args.data, report))?)?;
    let columns = match args.columns {
        ColumnsArg::Full => ColumnSet::ThetaContactAndBody,
        ColumnsArg::Theta => ColumnSet::Theta,
    };
    let settings = EvaluationSettings { columns, seed: args.seed, ..EvaluationSettings::default() };
    if let Some(n_folds) = args.cross_validate {
        let training = model.training_cases();
        let evaluation = complete(with_progress(|report| {
            cross_validate(training, model.config(), (n_folds, &settings), report)
        })?)?;
        return print_folds(args, &evaluation, console);
    }
    let test: Vec<ForceCase> = cases
        .into_iter()
        .filter(|case| args.split == SplitArg::All || !model.is_trained_on(case))
        .collect();
    if test.is_empty() {
        return Err(CliError::NoTestCase { path: args.data.clone() });
    }
    let n_trained_on = test.iter().filter(|case| model.is_trained_on(case)).count();
    let evaluation =
        complete(with_progress(|report| evaluate_model(&model, &test, &settings, report))?)?;
    print(args, (&evaluation, n_trained_on), console)
}

fn print(
    args: &EvaluateForceArgs,
    (evaluation, n_trained_on): (&Evaluation, usize),
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let answer = Answer {
        model_file: &args.model,
        data: &args.data,
        split: args.split,
        n_test: evaluation.cases.len(),
        n_trained_on,
        evaluation,
    };
    if let Some(folder) = &args.out {
        let to_error = |source| CliError::Folder { path: folder.clone(), source };
        fs::create_dir_all(folder).map_err(to_error)?;
        write_atomically(&folder.join("evaluation.json"), |out| {
            serde_json::to_writer_pretty(&mut *out, &answer)?;
            writeln!(out)
        })?;
        write_atomically(&folder.join("evaluation.md"), |out| {
            write!(out, "{}", evaluation.to_markdown())
        })?;
    }
    if console.json {
        print_json(console.out, &answer)?;
        return Ok(Verdict::Clean);
    }
    writeln!(console.out, "{}", evaluation.to_text())?;
    if n_trained_on > 0 {
        writeln!(
            console.out,
            "warning: the model was trained on {n_trained_on} of these {} cases",
            answer.n_test
        )?;
    }
    Ok(Verdict::of(!evaluation.problems.is_empty()))
}

fn print_folds(
    args: &EvaluateForceArgs,
    validation: &CrossValidation,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    if let Some(folder) = &args.out {
        let to_error = |source| CliError::Folder { path: folder.clone(), source };
        fs::create_dir_all(folder).map_err(to_error)?;
        write_atomically(&folder.join("cross_validation.json"), |out| {
            serde_json::to_writer_pretty(&mut *out, validation)?;
            writeln!(out)
        })?;
    }
    if console.json {
        print_json(console.out, validation)?;
        return Ok(Verdict::Clean);
    }
    let parts = [("all cases", &validation.overall), ("clean cases", &validation.separated)];
    for (title, compared) in parts {
        let Some(compared) = compared else { continue };
        writeln!(console.out, "{title}, {} folds", validation.folds.len())?;
        let row = |(name, figures): (&str, &Figures)| {
            let percent = |x: f64| format!("{:.1}", 100.0 * x);
            vec![
                name.to_owned(),
                percent(figures.rmse_over_peak.mean),
                format!("{:.3}", figures.history_error.mean),
                percent(figures.impulse_error.median),
                percent(figures.peak_error.median),
                percent(figures.duration_error.median),
            ]
        };
        let rows: Vec<Vec<String>> = compared.named().into_iter().map(row).collect();
        let header = [
            "model",
            "RMSE/peak, mean [%]",
            "history, mean",
            "impulse, median [%]",
            "peak, median [%]",
            "duration, median [%]",
        ];
        print_table(console.out, &header, &rows)?;
        writeln!(console.out)?;
    }
    Ok(Verdict::Clean)
}
