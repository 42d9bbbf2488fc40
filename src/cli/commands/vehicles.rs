//! `impactlab vehicles`: the vehicles that come with the program.

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_json, print_table};
use crate::study::StudyError;
use crate::vehicle::Preset;

/// List the vehicles that come with the program, or print one as a file to save and edit
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct VehiclesArgs {
    /// Print this vehicle's file
    #[arg(value_name = "ID")]
    id: Option<String>,
}

const EXAMPLES: &str = "\
Examples:
  impactlab vehicles
  impactlab vehicles reference-2000 > my-car.toml

JSON: {\"vehicles\": [{id, name, source, mass_kg, n_estimates}]}; with ID all parameters";

#[derive(Debug, Serialize)]
struct Listed {
    id: &'static str,
    name: String,
    source: String,
    mass_kg: f64,
    n_estimates: usize,
}

#[derive(Debug, Serialize)]
struct List {
    vehicles: Vec<Listed>,
}

/// Prints the list or one vehicle.
pub(in crate::cli) fn run(
    args: &VehiclesArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    match &args.id {
        Some(id) => print_one(id, console)?,
        None => print_list(console)?,
    }
    Ok(Verdict::Clean)
}

fn print_one(id: &str, console: &mut Console<'_>) -> Result<(), CliError> {
    let preset = Preset::from_id(id).ok_or_else(|| StudyError::unknown_vehicle(id))?;
    if console.json {
        return print_json(console.out, &preset.parameters());
    }
    write!(console.out, "{}", preset.text())?;
    Ok(())
}

fn print_list(console: &mut Console<'_>) -> Result<(), CliError> {
    let listed = |preset: &Preset| {
        let vehicle = preset.parameters();
        Listed {
            id: preset.id(),
            mass_kg: vehicle.mass.mass_kg,
            n_estimates: vehicle.estimates.len(),
            name: vehicle.name,
            source: vehicle.source,
        }
    };
    let vehicles: Vec<Listed> = Preset::ALL.iter().map(listed).collect();
    if console.json {
        return print_json(console.out, &List { vehicles });
    }
    let row = |vehicle: &Listed| {
        vec![
            vehicle.id.to_owned(),
            format!("{:.0}", vehicle.mass_kg),
            vehicle.n_estimates.to_string(),
            vehicle.name.clone(),
        ]
    };
    let rows: Vec<_> = vehicles.iter().map(row).collect();
    print_table(console.out, &["id", "mass [kg]", "estimates", "name"], &rows)?;
    Ok(())
}
