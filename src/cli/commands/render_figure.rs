//! The figures that `impactlab render` makes, each with notes on how it was made.

use crate::cli::CliError;
use crate::cli::console::Console;
use crate::cli::options::SourceArgs;
use impactlab_core::collision::{ChannelClass, filter_history};
use impactlab_core::data::{Channel, contact_interval};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{
    Figure, ForceFigure, WheelInput, analysis_motion_figure, control_figure, force_figure,
    impact_figure,
};
use impactlab_study::{
    Drive, ImpactRequest, RecordedForceRequest, Request, SimulateAnswer, SimulateRequest,
    StudyError,
};

/// A figure and what should be said with it.
pub(super) type Noted = (Figure, Vec<String>);

/// Notes, restrictions and assumptions as lines.
pub(super) fn noted(caveats: &Caveats, units: UnitSystem) -> Vec<String> {
    let caveats = caveats.in_units(units);
    let restrictions = caveats.restrictions().into_iter();
    let restrictions = restrictions.map(|of| format!("{}: {}", of.kind.label(), of.text));
    let assumed = caveats.assumptions().map(ToString::to_string);
    caveats.notes().map(str::to_owned).chain(restrictions).chain(assumed).collect()
}

/// The force of a case or a file, filtered if a class is given.
pub(super) fn force(
    source: &SourceArgs,
    class: Option<ChannelClass>,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<Noted, CliError> {
    let source = source.motion_source(&console.library, Drive::default())?;
    let files = Request::from(SimulateRequest::new(source.clone())).files_read();
    let recorded = console.answer_reading(&RecordedForceRequest { source }, &files)?;
    let (name, raw) = (recorded.name, recorded.force);
    let filtered = class.map(|class| filter_history(class, &raw)).transpose();
    let filtered = filtered.map_err(|source| CliError::Filter { name: name.clone(), source })?;
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
        caveats: &recorded.caveats,
    });
    Ok((figure, noted(&recorded.caveats, units)))
}

/// One channel of the motion of a case or a file.
pub(super) fn motion(
    request: &SimulateRequest,
    channel: Channel,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<Noted, CliError> {
    let SimulateAnswer { report, analysis } = console.answer(request)?;
    let figure = analysis_motion_figure(&analysis, &report.caveats, channel, units);
    if figure.elements.is_empty() {
        let (name, channel) = (request.source.name(), channel.header());
        return Err(CliError::NothingToShow { name, channel });
    }
    Ok((figure, noted(&report.caveats, units)))
}

/// What acts on the wheels of both vehicles of a case, a file or a scenario.
pub(super) fn controls(
    request: &SimulateRequest,
    input: WheelInput,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<Noted, CliError> {
    let SimulateAnswer { report, analysis } = console.answer(request)?;
    let figure = control_figure(&analysis, input, &report.caveats, units)
        .ok_or_else(|| CliError::NoInput { name: request.source.name(), input: input.label() })?;
    Ok((figure, noted(&report.caveats, units)))
}

/// The impact of a scenario.
pub(super) fn impact(
    request: &ImpactRequest,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<Noted, CliError> {
    let answer = console.answer(request)?;
    let name = answer.report.name.clone();
    let figure = impact_figure(&answer.scenario, &answer.solution, &answer.report.caveats, units)
        .map_err(|source| StudyError::Scenario { name, source })?;
    Ok((figure, noted(&answer.report.caveats, units)))
}
