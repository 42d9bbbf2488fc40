//! `impactlab evaluate response`: how well a response network does on a data set.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::compare::print_tables;
use crate::cli::evaluate::SplitArg;
use crate::cli::output::print_json;
use crate::cli::response_training::{data_name, load_cases};
use crate::cli::run::{Console, Verdict};
use crate::response::comparison::{MotionModel, evaluate_motion_model, write_comparison};
use crate::response::{Correction, ResponseCase, ResponseModel};
use crate::shipped::ModelSource;

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct EvaluateResponseArgs {
    /// A fine-tuned response network: `shipped` or a file
    #[arg(long, value_name = "MODEL")]
    model: ModelSource,
    /// A trajectory data set
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// Which of its cases
    #[arg(long, value_enum, default_value_t = SplitArg::Test)]
    split: SplitArg,
    /// The struck vehicle: a preset or a file, instead of the data set's own
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// Seed of the clusters
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Folder for comparison.json, comparison.md and the tables as CSV
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Example:
  impactlab evaluate response --model shipped --data datasets/trajectories-fea --json

--split test: the trajectories that the model was not trained on, recognised by their content; if the
model knows which were kept for its test, those of them that are there.

JSON: as of impactlab compare, with one model";

/// Evaluates.
pub(super) fn run(
    args: &EvaluateResponseArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let model = args.model.response_model()?;
    let cases = load_cases(&args.data, args.vehicle.as_deref())?;
    let chosen: Vec<&ResponseCase> = match args.split {
        SplitArg::All => cases.iter().collect(),
        SplitArg::Test => test_cases(&model, &cases),
    };
    if chosen.is_empty() {
        return Err(CliError::NoTestCase { path: args.data.clone() });
    }
    let trajectories = model.record().train.len();
    let rival = match model.config().network.correction {
        Correction::Whole => MotionModel::Plain(Box::new(model)),
        _ => MotionModel::Network(Box::new(model)),
    };
    let name = data_name(&args.data);
    let comparison = evaluate_motion_model((&name, &chosen), &rival, (trajectories, args.seed))?;
    if let Some(folder) = &args.out {
        write_comparison(folder, &comparison)?;
    }
    if console.json {
        print_json(console.out, &comparison)?;
    } else {
        print_tables(&comparison, console)?;
    }
    Ok(Verdict::Clean)
}

/// Those kept for the test of the model, or, of other data, all that it was not trained on.
fn test_cases<'a>(model: &ResponseModel, cases: &'a [ResponseCase]) -> Vec<&'a ResponseCase> {
    let test = &model.record().test;
    let kept: Vec<&ResponseCase> =
        cases.iter().filter(|case| test.iter().any(|id| id.digest == case.digest)).collect();
    if !kept.is_empty() {
        return kept;
    }
    cases.iter().filter(|case| !model.is_trained_on(case)).collect()
}
