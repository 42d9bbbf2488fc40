//! `impactlab compare`: the response network beside tuned and untuned 4DOF model and a plain network.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::output::{print_json, print_table};
use crate::cli::progress::with_progress;
use crate::cli::response_training::{config, data_name, load_cases};
use crate::cli::run::{Console, Verdict};
use crate::response::comparison::{
    Comparison, ComparisonSettings, all_tables, compare_models, write_comparison,
};
use crate::shipped::ModelSource;

/// Compare response models on trajectories that none has seen
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct CompareArgs {
    /// A trajectory data set; a quarter of its cases is kept apart for the test
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// Numbers of trajectories to fine-tune on
    #[arg(long, value_delimiter = ',', default_value = "5,20", value_name = "N,N")]
    trajectories: Vec<usize>,
    /// Choices of the trajectories for each number
    #[arg(long, default_value_t = 3, value_name = "K")]
    choices: u64,
    /// Seed of the split and of the first choice
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// A pre-trained response network: `shipped-pretrained` or a file; pre-trained here if not given
    #[arg(long, value_name = "MODEL")]
    model: Option<ModelSource>,
    /// The struck vehicle: a preset or a file, instead of the data set's own
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// Settings of the networks (TOML)
    #[arg(long, value_name = "CONFIG.toml")]
    config: Option<PathBuf>,
    /// Folder for comparison.json, comparison.md and the tables as CSV
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  impactlab compare --data datasets/trajectories-fea --out comparison
  impactlab compare --data datasets/trajectories-pulse --trajectories 20 --choices 1 --json

Every model is fitted to the same trajectories and asked about the same others. The column of the
paper holds what it printed, measured on other data.

JSON: data, seed, n_choices, test [name, cluster, spins, path [X, Y, yaw] every 0.1 s], models [name, trajectories, average_error_m {mean, std, median},
  rmse {x_m, y_m, vx_km_h, vy_km_h, yaw_rate_deg_s}, horizon_error_m, time_per_step_us, violations,
  coverage {50, 90, end_50, end_90, …}], clusters [name, n, impulse_n_s, models],
  cases [case, model, trajectories, choice, average_error_m, …, path]";

/// Compares.
pub(super) fn run(args: &CompareArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let start = args.model.as_ref().map(ModelSource::response_model).transpose()?;
    let config = match (&args.config, &start) {
        (None, Some(start)) => start.config().clone(),
        (path, _) => config(path.as_deref())?,
    };
    let cases = load_cases(&args.data, args.vehicle.as_deref())?;
    let settings = ComparisonSettings {
        config,
        trajectories: args.trajectories.clone(),
        n_choices: args.choices.max(1),
        seed: args.seed,
    };
    let name = data_name(&args.data);
    let compared =
        with_progress(|report| compare_models((&name, &cases), start.as_ref(), &settings, report))?;
    let comparison = compared.ok_or(CliError::Cancelled)?;
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

/// Prints the tables below each other.
pub(super) fn print_tables(
    comparison: &Comparison,
    console: &mut Console<'_>,
) -> Result<(), CliError> {
    writeln!(
        console.out,
        "{}: {} trajectories that no model has seen, seed {}",
        comparison.data,
        comparison.test.len(),
        comparison.seed
    )?;
    for (title, _, table) in all_tables(comparison) {
        if table.rows.is_empty() {
            continue;
        }
        writeln!(console.out, "\n{title}")?;
        let header: Vec<&str> = table.header.iter().map(String::as_str).collect();
        print_table(console.out, &header, &table.rows)?;
    }
    Ok(())
}
