//! `impactlab simulate` of one vehicle.

use std::path::{Path, PathBuf};

use crate::cli::CliError;
use crate::cli::output::{print_json, word};
use crate::cli::run::{Console, Verdict};
use crate::cli::simulate::{SimulateArgs, SingleArgs};
use crate::cli::simulate_answer::{Answer, answer, print_text};
use crate::cli::vehicle_choice::{under, vehicle};
use crate::data::{
    Channel, ForceHistory, Sampling, contact_interval, read_any_series, read_force_file,
    read_steer_file, write_series_csv,
};
use crate::vehicle::{
    ContactLoad, ContactPoint, Integrator, Manoeuvre, SteerHistory, VehicleParameters, VehicleState,
};

/// Simulates one vehicle, writes and prints what came out.
pub(super) fn run(args: &SimulateArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let single = &args.single;
    let vehicle = vehicle(args.vehicle.as_deref().unwrap_or_default())?;
    let mut vehicle = under(vehicle, args.equations);
    if let Some(friction) = single.friction {
        vehicle = vehicle.with_friction(friction);
    }
    let manoeuvre = manoeuvre(single, &vehicle)?;
    let integrator: Integrator = args.integrator.into();
    let motion = vehicle.simulate(&manoeuvre, integrator)?;
    if let Some(path) = &args.out {
        write_series_csv(path, &motion.series)?;
    }
    let answer = Answer {
        vehicle: vehicle.name.clone(),
        equations: word(&vehicle.equations),
        integrator: word(&integrator),
        friction: vehicle.tires.friction,
        duration_s: single.duration,
        out: args.out.clone(),
        ..answer(single, &manoeuvre, &motion)
            .map_err(|source| CliError::Series { path: PathBuf::from(&vehicle.name), source })?
    };
    if console.json {
        print_json(console.out, &answer)?;
    } else {
        print_text(console.out, &answer, args.units.into())?;
    }
    Ok(Verdict::Clean)
}

fn manoeuvre(args: &SingleArgs, vehicle: &VehicleParameters) -> Result<Manoeuvre, CliError> {
    let contact_load =
        args.force.as_deref().map(|path| contact_load(path, args, vehicle)).transpose()?;
    let steer = args.steer.as_deref().map(|path| steer_history(path, args)).transpose()?;
    Ok(Manoeuvre {
        initial: VehicleState {
            vy_m_s: args.vy,
            yaw_rate_rad_s: args.yaw_rate,
            ..VehicleState::driving_straight(args.speed.unwrap_or_default())
        },
        contact_load,
        steer,
        duration_s: args.duration,
    })
}

/// The force of a file, and where it acts.
fn contact_load(
    path: &Path,
    args: &SingleArgs,
    vehicle: &VehicleParameters,
) -> Result<ContactLoad, CliError> {
    let loaded = read_any_series(path, args.map.as_ref())?;
    let sampling = args.sampling.map_or_else(|| loaded.force_sampling(), Sampling::from);
    let force = match ForceHistory::from_series(&loaded.series, sampling) {
        Ok(force) => force,
        // As a force file it gives the error that says where and what to do.
        Err(source) => {
            read_force_file(path, args.map.as_ref())?;
            let path = path.to_owned();
            return Err(CliError::Series { path, source });
        }
    };
    if args.contact.is_none() && force.mz_n_m.is_none() {
        let path = path.to_owned();
        return Err(CliError::NoYawMoment { path });
    }
    if let Some((start_s, end_s)) = contact_interval(&force) {
        let duration_s = args.duration;
        // Times are written with few digits; a millisecond outside does no harm.
        if start_s < -1e-3 || end_s > duration_s + 1e-3 {
            return Err(CliError::ContactOutside {
                path: path.to_owned(),
                start_s,
                end_s,
                duration_s,
            });
        }
    }
    let at_cg = ContactPoint { x_m: 0.0, y_m: 0.0, height_m: vehicle.geometry.cg_height_m };
    Ok(ContactLoad {
        force,
        contact: args.contact.unwrap_or(at_cg),
        recorded_moment: args.contact.is_none(),
    })
}

/// The road-wheel angle of a file: the front axle's, or the mean of its wheels.
fn steer_history(path: &Path, args: &SingleArgs) -> Result<SteerHistory, CliError> {
    let series = read_steer_file(path, args.steer_map.as_ref())?.series;
    let in_file = |source| CliError::Series { path: path.to_owned(), source };
    let steer_rad = match series.get(Channel::Steer) {
        Some(steer) => steer.to_vec(),
        None => {
            let left = series.require(Channel::SteerFl).map_err(in_file)?;
            let right = series.require(Channel::SteerFr).map_err(in_file)?;
            let mean = |(left, right): (&f64, &f64)| (left + right) / 2.0;
            left.iter().zip(right).map(mean).collect()
        }
    };
    Ok(SteerHistory { time_s: series.time_s().to_vec(), steer_rad })
}
