//! `impactlab compare`: the response network beside tuned and untuned 4DOF model and a plain network.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{BadCasesArg, OverwriteArg, VehicleArg, count};
use crate::cli::text::print_answer;
use impactlab_core::data::Existing;
use impactlab_core::ranges::{CHOICES, TRAJECTORIES};
use impactlab_core::units::UnitSystem;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{
    Answer, CompareReport, CompareRequest, DEFAULT_CHOICES, ModelChoice, Question, Request,
};

/// Compare response models on trajectories that none has seen
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct CompareArgs {
    /// A trajectory data set; a quarter of its cases is kept apart for the test
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// Ask about cars that the network has not seen: --data is a folder of data sets, one for each car,
    /// and the numbers of trajectories are those of the car that the network is told. A network that
    /// knows how cars differ, such as `shipped`, is asked as it is about cars that are all new to it
    #[arg(long, requires = "model")]
    leave_one_car_out: bool,
    /// With --leave-one-car-out: a data set that is learned from beside; several if given again
    #[arg(long, value_name = "DIR", requires = "leave_one_car_out")]
    beside: Vec<PathBuf>,
    /// Numbers of trajectories to fine-tune on; 5,20 if not given
    #[arg(long, value_delimiter = ',', value_name = "N,N", value_parser = count::<usize>(TRAJECTORIES))]
    trajectories: Vec<usize>,
    /// Choices of the trajectories for each number
    #[arg(long, default_value_t = DEFAULT_CHOICES, value_name = "K", value_parser = count::<u64>(CHOICES))]
    choices: u64,
    /// Seed of the split and of the first choice
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// A pre-trained response network: `shipped-pretrained` or a file; pre-trained here if not given.
    /// With --leave-one-car-out also one that knows how cars differ
    #[arg(long, value_name = "MODEL")]
    model: Option<ModelSource>,
    /// The struck vehicle: a preset or a file, instead of the data set's own
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<VehicleArg>,
    /// Settings of the networks (TOML)
    #[arg(long, value_name = "CONFIG.toml")]
    config: Option<PathBuf>,
    #[command(flatten)]
    bad_cases: BadCasesArg,
    /// Folder for comparison.json, comparison.md and the tables as CSV
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: OverwriteArg,
}

const EXAMPLES: &str = "\
Examples:
  impactlab compare --data datasets/trajectories-fea --out comparison
  impactlab compare --data datasets/trajectories-pulse --trajectories 20 --choices 1 --json
  impactlab compare --leave-one-car-out --data datasets/trajectories-fleet \\
      --model shipped-pretrained --trajectories 1,5 --choices 1
  impactlab compare --leave-one-car-out --data datasets/trajectories-cars-held-out \\
      --model shipped --trajectories 1,5 --choices 1 --bad-cases leave-out

Every model is fitted to the same trajectories and asked about the same others. The column of the
paper holds what it printed, measured on other data.

JSON: impactlab schema compare --answer says every key with its unit";

/// Compares.
pub(in crate::cli) fn run(
    args: &CompareArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let unsaid = CompareRequest::new(&args.data);
    let request = CompareRequest {
        leave_one_car_out: args.leave_one_car_out,
        beside: args.beside.clone(),
        trajectories: match args.trajectories.as_slice() {
            [] => unsaid.trajectories.clone(),
            numbers => numbers.to_vec(),
        },
        choices: args.choices,
        seed: args.seed,
        model: args.model.clone().map(ModelChoice::from),
        vehicle: VehicleArg::choice(&args.vehicle),
        config: args.config.clone().into(),
        bad_cases: args.bad_cases.into(),
        ..unsaid
    };
    print_comparison(&request, args.out.as_deref(), args.overwrite.into(), console)
}

/// Asks what a comparison answers, writes it into a folder if there is one, and prints it.
pub(super) fn print_comparison<Q>(
    request: &Q,
    out: Option<&Path>,
    existing: Existing,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError>
where
    Q: Question<Report = Answer<CompareReport>> + Into<Request>,
{
    let out = out.map(|folder| (folder, existing, &CompareReport::FILES[..]));
    let answer = console.ask_into(request, out, |output, answer| {
        let report = Q::report(answer);
        report.write(output.staging())?;
        Ok(report.provenance_with_seed())
    })?;
    let Some(answer) = answer else { return Ok(Verdict::Clean) };
    let (report, units) = (Q::report(&answer), UnitSystem::default());
    console.print(report, |out| print_answer(out, report, units))?;
    Ok(Verdict::Clean)
}
