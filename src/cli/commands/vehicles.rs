//! `impactlab vehicles`: the vehicles that come with the program.

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_json, print_table};
use impactlab_core::vehicle::sheet::Estimate;
use impactlab_core::vehicle::{
    BuiltInVehicle, LibraryVehicle, Preset, VehicleClass, VehicleParameters,
};
use impactlab_study::StudyError;

/// List the vehicles that come with the program, or print one as a file to save and edit
///
/// The presets are the vehicles of the data sets. The library holds the data sheets of ordinary
/// vehicles: what a sheet does not state is estimated by rule, with its scatter. Either serves as
/// --vehicle; a file of your own needs no more than mass, length and width, or the class.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct VehiclesArgs {
    /// Print this vehicle's file
    #[arg(value_name = "ID")]
    id: Option<String>,
    /// With ID: what its data sheet does not state, with median, 90 % range, rule and source
    #[arg(long, requires = "id")]
    estimates: bool,
}

const EXAMPLES: &str = "\
Examples:
  impactlab vehicles
  impactlab vehicles reference-2000 > my-car.toml
  impactlab vehicles ford-explorer-2004 --estimates

JSON: {\"vehicles\": [{id, kind, name, class, model_year, source, mass_kg, n_estimates}]}; with ID all parameters, and
  data_sheet_estimates [{quantity, unit, median, intervals, rule, source}]";

#[derive(Debug, Serialize)]
struct Listed {
    id: &'static str,
    /// `preset` or `library`.
    kind: &'static str,
    name: String,
    class: Option<&'static str>,
    model_year: Option<u32>,
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
        Some(id) => print_one(id, args.estimates, console)?,
        None => print_list(console)?,
    }
    Ok(Verdict::Clean)
}

/// All parameters of a vehicle, and how uncertain those are that its data sheet does not state.
#[derive(Debug, Serialize)]
struct PrintedVehicle<'a> {
    #[serde(flatten)]
    parameters: &'a VehicleParameters,
    data_sheet_estimates: &'a [Estimate],
}

fn print_one(id: &str, estimates: bool, console: &mut Console<'_>) -> Result<(), CliError> {
    let preset = Preset::from_id(id).map(|preset| (preset.parameters(), preset.text()));
    let library = || {
        let vehicle = LibraryVehicle::from_id(id)?;
        Some((vehicle.parameters(), vehicle.text()))
    };
    let (parameters, text) =
        preset.or_else(library).ok_or_else(|| StudyError::unknown_vehicle(id))?;
    let data_sheet_estimates =
        parameters.sheet.as_ref().map_or_else(Vec::new, |sheet| sheet.estimates());
    if console.json {
        let (parameters, data_sheet_estimates) = (&parameters, data_sheet_estimates.as_slice());
        return print_json(console.out, &PrintedVehicle { parameters, data_sheet_estimates });
    }
    if !estimates {
        write!(console.out, "{text}")?;
        return Ok(());
    }
    let row = |estimate: &Estimate| {
        let Estimate { quantity, unit, value, rule, source } = estimate;
        let (median, [low, high]) = (value.median, value.ninety());
        let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        vec![
            format!("{}{unit}", quantity.label()),
            format!("{median:.4}"),
            format!("{low:.4} to {high:.4}"),
            (*rule).to_owned(),
            (*source).to_owned(),
        ]
    };
    let rows: Vec<_> = data_sheet_estimates.iter().map(row).collect();
    print_table(console.out, &["quantity", "median", "90 %", "rule", "source"], &rows)?;
    Ok(())
}

fn print_list(console: &mut Console<'_>) -> Result<(), CliError> {
    let listed = |of: &BuiltInVehicle| Listed {
        id: of.id,
        kind: if of.is_of_library { "library" } else { "preset" },
        mass_kg: of.parameters.mass.mass_kg,
        n_estimates: of.parameters.estimates.len(),
        name: of.parameters.name.clone(),
        class: of.class().map(VehicleClass::word),
        model_year: of.model_year(),
        source: of.parameters.source.clone(),
    };
    let vehicles: Vec<Listed> = BuiltInVehicle::all().iter().map(listed).collect();
    if console.json {
        return print_json(console.out, &List { vehicles });
    }
    let row = |vehicle: &Listed| {
        vec![
            vehicle.id.to_owned(),
            vehicle.kind.to_owned(),
            vehicle.class.unwrap_or_default().to_owned(),
            vehicle.model_year.map(|year| year.to_string()).unwrap_or_default(),
            format!("{:.0}", vehicle.mass_kg),
            vehicle.n_estimates.to_string(),
            vehicle.name.clone(),
        ]
    };
    let rows: Vec<_> = vehicles.iter().map(row).collect();
    print_table(
        console.out,
        &["id", "kind", "class", "year", "mass [kg]", "estimates", "name"],
        &rows,
    )?;
    Ok(())
}
