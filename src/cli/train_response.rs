//! `impactlab train response`: pre-trains the response network.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use crate::cli::CliError;
use crate::cli::progress::{complete, with_progress};
use crate::cli::response_training::{
    checkpoint_of, config, data_name, load_cases, print_config, print_model, under_bar,
};
use crate::cli::run::{Console, Verdict};
use crate::cli::vehicle_choice::vehicle;
use crate::data::DatasetKind;
use crate::force::ForceCase;
use crate::learning::{ModelFile, TEST_SHARE, split};
use crate::response::{ImpactRecord, ResponseCase, ResponseTrainSettings, pretrain};
use crate::vehicle::{Preset, VehicleParameters};

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct TrainResponseArgs {
    /// A force or trajectory data set: its forces drive the simulations; a quarter of its cases is
    /// left out
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// The struck vehicle: a preset or a file; the data set's own, or the reference car
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// Where the model goes; the training is kept beside it in MODEL.training
    #[arg(long, value_name = "MODEL")]
    out: PathBuf,
    /// Settings (TOML); what it leaves out keeps its default, see --print-config
    #[arg(long, value_name = "CONFIG.toml")]
    config: Option<PathBuf>,
    /// The plain network of the comparison instead: no 4DOF model, no guard, no physics
    #[arg(long)]
    plain: bool,
    /// Seed of the split and of all draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Go on from MODEL.training, if it is there
    #[arg(long)]
    resume: bool,
    /// Print the settings as TOML and stop
    #[arg(long)]
    print_config: bool,
}

const EXAMPLES: &str = "\
Examples:
  impactlab train response --data datasets/fea --out pretrained.safetensors
  impactlab fine-tune response --model pretrained.safetensors \\
      --data datasets/trajectories-fea --trajectories 20 --out response.safetensors

The network learns on simulations of the 4DOF model, under the forces of the data set, what another
vehicle, another road and another speed change. No recorded motion is looked at.

JSON: model, data, data_digest, seed, n_simulated, train, n_test, n_parameters, seconds, epochs, loss,
  balance, latents, keeps_latents";

/// Pre-trains.
pub(super) fn run(
    args: &TrainResponseArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let mut config = config(args.config.as_deref())?;
    if args.plain {
        config = config.plain();
    }
    if args.print_config {
        return print_config(&config, console);
    }
    let records = records(args)?;
    let settings = ResponseTrainSettings {
        config,
        seed: args.seed,
        checkpoint: Some(checkpoint_of(&args.out)),
        resume: args.resume,
    };
    let started = Instant::now();
    let name = data_name(&args.data);
    let model = under_bar(|report| pretrain((&name, &records), &settings, report))?;
    model.save(&args.out)?;
    print_model((&args.out, &model, started.elapsed().as_secs_f64()), &[], console)
}

/// Forces of the cases that are not kept for a test.
fn records(args: &TrainResponseArgs) -> Result<Vec<ImpactRecord>, CliError> {
    let share = TEST_SHARE;
    if DatasetKind::of_folder(&args.data) == Some(DatasetKind::Trajectory) {
        let cases = load_cases(&args.data, args.vehicle.as_deref())?;
        let train = split(&cases, args.seed, share).train;
        let kept = train.into_iter().filter_map(|idx| cases.get(idx));
        return Ok(kept.filter_map(ResponseCase::impact).collect());
    }
    let struck = match &args.vehicle {
        Some(name) => vehicle(name)?,
        None => Preset::Reference.parameters(),
    };
    let cases = complete(with_progress(|report| ForceCase::load_all(&args.data, report))?)?;
    let train = split(&cases, args.seed, share).train;
    let kept = train.into_iter().filter_map(|idx| cases.get(idx));
    Ok(kept.filter_map(|case| impact_record(case, &struck)).collect())
}

/// The impact of a case of a force data set; `None` where it does not say where the contact was.
fn impact_record(case: &ForceCase, vehicle: &VehicleParameters) -> Option<ImpactRecord> {
    let scenario = &case.scenario;
    let contact_m = scenario.contact_m?;
    let vehicle = vehicle.clone().with_mass(scenario.mass_kg[0], scenario.yaw_inertia_kg_m2[0]);
    let force = case.curve.to_history();
    Some(ImpactRecord::under_force(vehicle, scenario.target_velocity_m_s, contact_m, force))
}
