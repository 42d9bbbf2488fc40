//! `impactlab vehicles`: the vehicles that come with the program.

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_json, print_table};
use crate::cli::options::{UNITS, one_value_of};
use impactlab_core::units::{NumberFormat, Quantity, Unit, UnitSystem};
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
    /// Units of the list and of --estimates (JSON and vehicle files are always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

const EXAMPLES: &str = "\
Examples:
  impactlab vehicles
  impactlab vehicles reference-2000 > my-car.toml
  impactlab vehicles ford-explorer-2004 --estimates --units us

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
        Some(id) => print_one(id, args, console)?,
        None => print_list(args.units, console)?,
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

fn print_one(id: &str, args: &VehiclesArgs, console: &mut Console<'_>) -> Result<(), CliError> {
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
    if !args.estimates {
        write!(console.out, "{text}")?;
        return Ok(());
    }
    let format = NumberFormat::english(args.units);
    let row = |estimate: &Estimate| {
        let Estimate { quantity, unit, value, rule, source } = estimate;
        let shown = quantity.range().quantity.display_unit(args.units);
        // Such as deg/g, which is the same in every system.
        let symbol = if shown.symbol.is_empty() { *unit } else { shown.symbol };
        let symbol = if symbol.is_empty() { String::new() } else { format!(" [{symbol}]") };
        // The unit stands with the name.
        let text = format.estimate_in(Unit { symbol: "", ..shown }, value);
        vec![
            format!("{}{symbol}", quantity.label()),
            text.median.clone(),
            text.at(0.9).map_or_else(String::new, |interval| interval.range.clone()),
            (*rule).to_owned(),
            (*source).to_owned(),
        ]
    };
    let rows: Vec<_> = data_sheet_estimates.iter().map(row).collect();
    print_table(console.out, &["quantity", "median", "90 %", "rule", "source"], &rows)?;
    Ok(())
}

fn print_list(units: UnitSystem, console: &mut Console<'_>) -> Result<(), CliError> {
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
    let (format, mass) = (NumberFormat::english(units), Quantity::Mass.display_unit(units));
    let row = |vehicle: &Listed| {
        vec![
            vehicle.id.to_owned(),
            vehicle.kind.to_owned(),
            vehicle.class.unwrap_or_default().to_owned(),
            vehicle.model_year.map(|year| year.to_string()).unwrap_or_default(),
            format!("{:.0}", mass.from_si(vehicle.mass_kg)),
            vehicle.n_estimates.to_string(),
            BuiltInVehicle::name_in_units(&vehicle.name, &vehicle.name, &format),
        ]
    };
    let rows: Vec<_> = vehicles.iter().map(row).collect();
    let mass = format!("mass [{}]", mass.symbol);
    let columns = ["id", "kind", "class", "year", mass.as_str(), "estimates", "name"];
    print_table(console.out, &columns, &rows)?;
    Ok(())
}
