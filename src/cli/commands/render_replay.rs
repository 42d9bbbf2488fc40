//! `impactlab render replay`: the path by a recorder, or what was recorded beside what was
//! replayed.

use clap::Args;

use crate::cli::CliError;
use crate::cli::commands::render::OutputArgs;
use crate::cli::commands::render_figure::{Noted, noted};
use crate::cli::commands::replay::RecordArgs;
use crate::cli::console::Console;
use crate::cli::options::{Words, one_of};
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{ReplayCurve, replay_curve_figure, replay_path_figure};

/// The record, and what is drawn.
#[derive(Debug, Args)]
pub(super) struct ReplayFigureArgs {
    #[command(flatten)]
    record: RecordArgs,
    /// What is drawn
    #[arg(long, value_parser = one_of(PLOTS), default_value = "path")]
    plot: ReplayPlot,
    #[command(flatten)]
    pub(super) output: OutputArgs,
}

/// A figure of a replay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ReplayPlot {
    Path,
    Curve(ReplayCurve),
}

const PLOTS: Words<ReplayPlot> = &[
    ("path", "The path from above", ReplayPlot::Path),
    ("speed", "Speed, recorded and replayed", ReplayPlot::Curve(ReplayCurve::Speed)),
    ("yaw-rate", "Yaw rate, likewise", ReplayPlot::Curve(ReplayCurve::YawRate)),
    (
        "steering",
        "Steer angle of the road wheels, likewise",
        ReplayPlot::Curve(ReplayCurve::Steering),
    ),
];

/// Follows the record and draws the figure.
pub(super) fn figure(
    args: &ReplayFigureArgs,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<Noted, CliError> {
    let report = console.answer(&args.record.request())?.report;
    let figure = match args.plot {
        ReplayPlot::Path => replay_path_figure(&report, units),
        ReplayPlot::Curve(curve) => replay_curve_figure(&report, curve, units),
    };
    Ok((figure, noted(&report.caveats, units)))
}
