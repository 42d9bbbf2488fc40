//! `impactlab predict force`: the distribution of an impact force history.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::files::write_force_prediction;
use crate::cli::options::{OverwriteArg, UNITS, count, one_value_of};
use crate::cli::text::print_answer;
use impactlab_core::ranges::SAMPLES;
use impactlab_core::units::UnitSystem;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{
    Answer, ForceQuestion, PredictForceReport, PredictForceRequest, ScenarioChoice,
};

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct PredictForceArgs {
    /// The force network: `shipped` or a file
    #[arg(long, default_value_t, value_name = "MODEL")]
    model: ModelSource,
    /// The scenario: a file, or `pit-right-rear`
    #[arg(long, value_name = "NAME|FILE", required_unless_present = "dataset")]
    scenario: Option<PathBuf>,
    /// Instead: a force data set, of which --case says the collision
    #[arg(long, value_name = "DIR", requires = "case", conflicts_with = "scenario")]
    dataset: Option<PathBuf>,
    /// The case of the data set
    #[arg(long, value_name = "NAME", requires = "dataset", conflicts_with = "scenario")]
    case: Option<String>,
    /// Kind of body of the striking vehicle, as the training data name it; left open if not given
    #[arg(long, value_name = "NAME")]
    body: Option<String>,
    /// Kind of body of the struck vehicle, likewise
    #[arg(long, value_name = "NAME")]
    struck_body: Option<String>,
    /// Leave the contact point open: it is drawn from that of the training cases
    #[arg(long)]
    open_contact: bool,
    /// Whole curves to draw
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = count::<usize>(SAMPLES))]
    samples: usize,
    /// Seed of the draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Folder for bands.csv, mean.csv, prediction.json and the samples
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

const EXAMPLES: &str = "\
Example:
  impactlab predict force --scenario pit-right-rear --samples 5 --out prediction

bands.csv: time, mean and the edges of the 50, 80, 90 and 95 % bands of F_x, F_y and |F|, N.
mean.csv and sample_001.csv, …: force histories that every other command reads.

JSON: impactlab schema predict-force --answer says every key with its unit;
  and out, the folder of the files";

/// The report, and where its files are.
#[derive(Debug, Serialize)]
struct PrintedForce<'a> {
    #[serde(flatten)]
    report: &'a Answer<PredictForceReport>,
    out: Option<&'a Path>,
}

/// Files that are written whatever is predicted.
const KNOWN_FILES: [&str; 3] = ["bands.csv", "mean.csv", "prediction.json"];

/// Predicts a force.
pub(in crate::cli) fn run(
    args: &PredictForceArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = PredictForceRequest {
        collision: collision(args)?,
        model: args.model.clone().into(),
        body: args.body.clone(),
        struck_body: args.struck_body.clone(),
        open_contact: args.open_contact,
        samples: args.samples,
        seed: args.seed,
    };
    let out = args.out.as_deref();
    let into = out.map(|folder| (folder, args.overwrite.into(), &KNOWN_FILES[..]));
    let answer = console.ask_into(&request, into, |output, answer| {
        // What lies in the folder does not say where the folder is.
        let printed = PrintedForce { report: &answer.report, out: None };
        write_force_prediction(output.staging(), answer, &printed)?;
        Ok(answer.report.provenance.clone())
    })?;
    let Some(answer) = answer else { return Ok(Verdict::Clean) };
    let printed = PrintedForce { report: &answer.report, out };
    let report = &answer.report;
    console.print(&printed, |out| print_answer(out, report, args.units))?;
    Ok(Verdict::Clean)
}

fn collision(args: &PredictForceArgs) -> Result<ForceQuestion, CliError> {
    if let Some(path) = args.scenario.clone() {
        return Ok(ForceQuestion::Scenario(ScenarioChoice::File(path)));
    }
    match (args.dataset.clone(), args.case.clone()) {
        (Some(dataset), Some(case)) => Ok(ForceQuestion::Case { dataset, case }),
        _ => Err(CliError::NothingToPredict),
    }
}
