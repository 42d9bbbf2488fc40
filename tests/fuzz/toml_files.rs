//! TOML: vehicles, scenarios, configurations of both networks.

use std::path::Path;

use impactlab_core::collision::Scenario;
use impactlab_core::vehicle::{Integrator, Manoeuvre, VehicleParameters, VehicleState};
use impactlab_networks::force::ForceConfig;
use impactlab_networks::response::ResponseConfig;

use crate::harness::{Answer, Format, run};
use crate::mutation::Mutator;

fn toml_format(name: &'static str, n_inputs: u64, load: &dyn Fn(&Path) -> Answer) {
    run(&Format {
        name,
        n_inputs,
        file_name: "file.toml",
        names_file: true,
        seeds: Vec::new(),
        mutate: Mutator::text,
        load,
    });
}

/// A vehicle, and how it turns in a tenth of a second.
fn vehicle(path: &Path) -> Answer {
    let vehicle = match VehicleParameters::load(path) {
        Ok(vehicle) => vehicle,
        Err(error) => return Answer::refused(&error),
    };
    let manoeuvre = Manoeuvre {
        initial: VehicleState { yaw_rate_rad_s: 2.0, ..VehicleState::driving_straight(20.0) },
        duration_s: 0.1,
        ..Manoeuvre::default()
    };
    let answer = Answer::accepted(&vehicle);
    match vehicle.simulate(&manoeuvre, Integrator::Rk4) {
        Ok(motion) => answer.and(&motion.series),
        Err(_) => answer,
    }
}

#[test]
fn vehicle_files() {
    toml_format("vehicle", 8_000, &vehicle);
}

#[test]
fn vehicle_files_of_multibody_models() {
    toml_format("vehicle-multibody", 8_000, &vehicle);
}

#[test]
fn scenario_files() {
    toml_format("scenario", 8_000, &|path| match Scenario::load(path) {
        Ok(scenario) => {
            let answer = Answer::accepted(&scenario);
            match scenario.solve() {
                Ok(solution) => answer.and(&solution),
                Err(_) => answer,
            }
        }
        Err(error) => Answer::refused(&error),
    });
}

#[test]
fn configurations_of_the_force_network() {
    toml_format("force-config", 4_000, &|path| match ForceConfig::load(path) {
        Ok(config) => Answer::accepted(&config),
        Err(error) => Answer::refused(&error),
    });
}

#[test]
fn configurations_of_the_response_network() {
    toml_format("response-config", 4_000, &|path| match ResponseConfig::load(path) {
        Ok(config) => Answer::accepted(&config),
        Err(error) => Answer::refused(&error),
    });
}
