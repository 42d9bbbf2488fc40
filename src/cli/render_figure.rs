//! The figures that `impactlab render` makes, each with notes on how it was made.

use std::path::Path;

use crate::analysis::{Analysis, FileSetup, Settings, analyse_case, analyse_file};
use crate::cli::CliError;
use crate::cli::case_choice::{Chosen, choose};
use crate::cli::impact::load;
use crate::cli::render::{SourceArgs, VehicleArgs};
use crate::cli::vehicle_choice::{vehicle, vehicle_or_own};
use crate::collision::{ChannelClass, filter_history};
use crate::data::{Channel, FileKind, ForceHistory, Loaded, contact_interval};
use crate::figure::{
    Figure, ForceFigure, analysis_motion_figure, analysis_scene_figure, force_figure, impact_figure,
};
use crate::units::UnitSystem;
use crate::vehicle::Integrator;

/// How long a force case is simulated, s: as long as the trajectory data sets.
const DURATION_S: f64 = 4.0;

/// A figure and what should be said with it.
pub(super) type Noted = (Figure, Vec<String>);

/// The force of a case or a file, filtered if a class is given.
pub(super) fn force(
    source: &SourceArgs,
    class: Option<ChannelClass>,
    units: UnitSystem,
) -> Result<Noted, CliError> {
    let path = || source.path.clone();
    let (name, force, notes) = match choose_source(source)? {
        Chosen::Case { case, .. } => (case.name.clone(), case.force_history(), Vec::new()),
        Chosen::File { name, loaded } => {
            let force = ForceHistory::from_series(&loaded.series, loaded.force_sampling());
            (name, force, notes(&loaded))
        }
    };
    let raw = force.map_err(|source| CliError::Series { path: path(), source })?;
    let filtered = class.map(|class| filter_history(class, &raw)).transpose();
    let filtered = filtered.map_err(|source| CliError::Filter { path: path(), source })?;
    let title = match class {
        Some(class) => format!("{name}, {}", class.label()),
        None => name,
    };
    let figure = force_figure(&ForceFigure {
        name: &title,
        force: filtered.as_ref().unwrap_or(&raw),
        raw: filtered.as_ref().map(|_| &raw),
        contact_s: contact_interval(&raw),
        pulses: &[],
        units,
    });
    Ok((figure, notes))
}

/// One channel of the motion of a case or a trajectory file.
pub(super) fn motion(
    source: &SourceArgs,
    vehicles: &VehicleArgs,
    channel: Channel,
    units: UnitSystem,
) -> Result<Noted, CliError> {
    let analysis = analyse(source, vehicles)?;
    let figure = analysis_motion_figure(&analysis, channel, units);
    if figure.elements.is_empty() {
        return Err(CliError::NothingToShow {
            path: source.path.clone(),
            channel: channel.header(),
        });
    }
    Ok((figure, analysis.notes))
}

/// The scene of a case or a trajectory file at a moment.
pub(super) fn scene(
    source: &SourceArgs,
    vehicles: &VehicleArgs,
    time_s: f64,
    units: UnitSystem,
) -> Result<Noted, CliError> {
    let analysis = analyse(source, vehicles)?;
    let simulation = analysis.simulation.as_ref().map(|motion| &motion.series);
    if let Some(shown) = analysis.reference.as_ref().or(simulation) {
        let [start_s, end_s] = [shown.time_s().first(), shown.time_s().last()]
            .map(|time| time.copied().unwrap_or_default());
        if !(start_s..=end_s).contains(&time_s) {
            return Err(CliError::TimeOutside { time_s, start_s, end_s });
        }
    }
    let figure = analysis_scene_figure(&analysis, time_s, units);
    Ok((figure, analysis.notes))
}

/// The impact of a scenario.
pub(super) fn impact(path: &Path, paper: bool, units: UnitSystem) -> Result<Noted, CliError> {
    let scenario = load(path, paper)?;
    let unsolved = |source| CliError::Scenario { path: path.to_owned(), source };
    let solution = scenario.solve().map_err(unsolved)?;
    let figure = impact_figure(&scenario, &solution, units).map_err(unsolved)?;
    Ok((figure, Vec::new()))
}

fn choose_source(source: &SourceArgs) -> Result<Chosen, CliError> {
    choose(&source.path, source.case.as_deref(), source.map.as_ref())
}

/// Simulates a case or a trajectory file and compares.
pub(super) fn analyse(source: &SourceArgs, vehicles: &VehicleArgs) -> Result<Analysis, CliError> {
    let settings = |own: Option<&Path>| -> Result<Settings, CliError> {
        Ok(Settings {
            target: vehicle_or_own(vehicles.vehicle.as_deref(), own, &source.path)?,
            bullet: vehicle(&vehicles.bullet)?,
            integrator: Integrator::Rk4,
            duration_s: DURATION_S,
        })
    };
    let analysis = match choose_source(source)? {
        Chosen::Case { case, vehicle_file } => {
            analyse_case(&case, &settings(vehicle_file.as_deref())?)
        }
        Chosen::File { name, loaded } => {
            let setup = file_setup(source, vehicles, &loaded)?;
            analyse_file(&name, &loaded, &setup, &settings(None)?)
        }
    };
    analysis
        .map_err(|error| CliError::Analysis { path: source.path.clone(), source: Box::new(error) })
}

/// Where the force of a trajectory file acts; anything else than a trajectory is refused, since its
/// speed is not known.
fn file_setup(
    source: &SourceArgs,
    vehicles: &VehicleArgs,
    loaded: &Loaded,
) -> Result<FileSetup, CliError> {
    let path = source.path.clone();
    if loaded.kind != FileKind::Trajectory {
        return Err(CliError::WrongKind {
            path,
            got: format!("a {} file", crate::cli::output::word(&loaded.kind)),
            expected: "a trajectory; `impactlab simulate --out FILE.csv` makes one",
        });
    }
    let has = |channel| loaded.series.get(channel).is_some();
    let has_force = has(Channel::Fx) || has(Channel::FxBody);
    match vehicles.contact {
        None if has_force && !has(Channel::Mz) => Err(CliError::NoYawMoment { path }),
        None => Ok(FileSetup::default()),
        Some(contact) => Ok(FileSetup {
            contact_m: [contact.x_m, contact.y_m],
            contact_height_m: contact.height_m,
            ..FileSetup::default()
        }),
    }
}

fn notes(loaded: &Loaded) -> Vec<String> {
    loaded.notes.iter().map(ToString::to_string).collect()
}
