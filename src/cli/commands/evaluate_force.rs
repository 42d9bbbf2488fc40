//! `impactlab evaluate force`: how well a force network does, beside its baselines.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::files::write_force_evaluation;
use crate::cli::options::{BadCasesArg, OverwriteArg, SPLITS, Words, count, one_of, one_value_of};
use crate::cli::text::print_answer;
use impactlab_core::ranges::FOLDS;
use impactlab_core::units::UnitSystem;
use impactlab_networks::force::ColumnSet;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{EvaluateForceRequest, EvaluatedCases, Question};

/// What is known of a scenario.
const COLUMNS: Words<ColumnSet> = &[
    (
        "full",
        "Masses, velocities, angle, contact point, body of the striking vehicle",
        ColumnSet::ThetaContactAndBody,
    ),
    ("theta", "Masses, velocities, angle: the rest is left open", ColumnSet::Theta),
];

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct EvaluateForceArgs {
    /// A trained force network: `shipped` or a file
    #[arg(long, value_name = "MODEL")]
    model: ModelSource,
    /// A force data set
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// Which of its cases
    #[arg(long, value_parser = one_value_of(SPLITS), default_value = "test")]
    split: EvaluatedCases,
    /// What is known of each scenario
    #[arg(long, value_parser = one_of(COLUMNS), default_value = "full")]
    columns: ColumnSet,
    /// Instead: train anew with the model's settings in K folds of its training cases, so that no
    /// test case is looked at
    #[arg(long, value_name = "K", value_parser = count::<usize>(FOLDS))]
    cross_validate: Option<usize>,
    /// Seed of folds, clusters and draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    bad_cases: BadCasesArg,
    /// Folder for evaluation.json and evaluation.md
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: OverwriteArg,
}

const EXAMPLES: &str = "\
Examples:
  impactlab evaluate force --model shipped --data datasets/fea --json
  impactlab evaluate force --model shipped --data datasets/fea \\
      --columns theta --out evaluation

The baselines are fitted here, to the cases that the model was trained on, which it carries.

JSON: impactlab schema evaluate-force --answer says every key with its unit";

/// Evaluates.
pub(in crate::cli) fn run(
    args: &EvaluateForceArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = EvaluateForceRequest {
        model: args.model.clone().into(),
        data: args.data.clone(),
        split: args.split,
        columns: args.columns,
        cross_validate: args.cross_validate,
        seed: args.seed,
        bad_cases: args.bad_cases.into(),
        for_figures: false,
    };
    let known = match args.cross_validate {
        Some(_) => ["cross_validation.json"],
        None => ["evaluation.json"],
    };
    let out = args.out.as_deref().map(|folder| (folder, args.overwrite.into(), &known[..]));
    let answer = console.ask_into(&request, out, |output, answer| {
        write_force_evaluation(output.staging(), &answer.report)?;
        Ok(answer.report.provenance.clone())
    })?;
    let Some(answer) = answer else { return Ok(Verdict::Clean) };
    let units = UnitSystem::default();
    console.print(&answer.report, |out| print_answer(out, &answer.report, units))?;
    Ok(Verdict::from_problems(EvaluateForceRequest::has_problems(&answer.report)))
}
