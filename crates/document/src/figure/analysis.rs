//! The figures of an [`Analysis`]: force and motion over time, and the scene from above.

use crate::figure::{
    Figure, FigureElement, ForceFigure, LineStyle, Role, STRIKING, SceneFigure, SceneVehicle,
    Series, force_figure, motion_figure, motion_readout, scene_figure,
};
use impactlab_core::collision::{ChannelClass, FilterError, filter_history};
use impactlab_core::data::{Channel, ForceHistory, TimeSeries, contact_interval};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Unit, UnitSystem};
use impactlab_study::analysis::Analysis;

/// Half the width of the cross at a second contact, m.
const CROSS_M: f64 = 0.6;

/// Force on the struck vehicle over time, with classic pulses for comparison. `None` if the case
/// has no force.
///
/// - `class`: channel frequency class with which the force is filtered; the raw force is then drawn
///   behind it.
/// - `pulses`: pulses to draw, by name.
/// - `caveats`: what restricts the answer.
///
/// # Errors
/// [`FilterError`] if the channel class does not fit the sampling of the force.
pub fn analysis_force_figure(
    analysis: &Analysis,
    caveats: &Caveats,
    class: Option<ChannelClass>,
    pulses: &[(String, ForceHistory)],
    units: UnitSystem,
) -> Result<Option<Figure>, FilterError> {
    let Some(raw) = &analysis.force else {
        return Ok(None);
    };
    let filtered = class.map(|class| filter_history(class, raw)).transpose()?;
    Ok(Some(force_figure(&ForceFigure {
        name: &analysis.name,
        force: filtered.as_ref().unwrap_or(raw),
        raw: filtered.as_ref().map(|_| raw),
        contact_s: contact_interval(raw),
        pulses,
        units,
        caveats,
    })))
}

/// One channel of the simulated and of the recorded motion over time.
pub fn analysis_motion_figure(
    analysis: &Analysis,
    caveats: &Caveats,
    channel: Channel,
    units: UnitSystem,
) -> Figure {
    motion_figure(&analysis.name, channel, motions(analysis), units)
        .with_caveats(&caveats.in_units(units))
}

/// One line of text with the values of a channel in the simulated and in the recorded motion.
///
/// - `time_s`: the instant, s.
pub fn analysis_readout(
    analysis: &Analysis,
    channel: Channel,
    time_s: f64,
    units: UnitSystem,
) -> String {
    motion_readout(channel, motions(analysis), time_s, units)
}

/// The simulated and the recorded motion.
fn motions(analysis: &Analysis) -> [Option<&TimeSeries>; 2] {
    let simulation = analysis.simulation.as_ref().map(|motion| &motion.series);
    [simulation, analysis.reference.as_ref()]
}

/// The scene from above: the paths of all vehicles, and their outlines at the time `time_s`, s.
pub fn analysis_scene_figure(
    analysis: &Analysis,
    caveats: &Caveats,
    time_s: f64,
    units: UnitSystem,
) -> Figure {
    let footprint = analysis.footprint;
    let striking = analysis.striking.as_ref().map(|track| SceneVehicle {
        name: STRIKING,
        role: Role::Striking,
        style: LineStyle::Solid,
        motion: &track.motion,
        footprint: track.footprint,
    });
    let reference = analysis.reference.as_ref().map(|motion| SceneVehicle {
        name: "recorded",
        role: Role::Reference,
        style: LineStyle::Dashed,
        motion,
        footprint,
    });
    let simulation = analysis.simulation.as_ref().map(|motion| SceneVehicle {
        name: "4DOF simulation",
        role: Role::Simulation,
        style: LineStyle::Solid,
        motion: &motion.series,
        footprint,
    });
    let vehicles: Vec<_> = [striking, reference, simulation].into_iter().flatten().collect();
    let second = analysis.second_contact.as_ref();
    let met = second.filter(|second| second.time_s <= time_s);
    let after = if met.is_some() { ", after a second contact that is not computed" } else { "" };
    let title = format!("{}: scene from above at {time_s:.2} s{after}", analysis.name);
    let mut figure =
        scene_figure(&SceneFigure { title: &title, vehicles: &vehicles, time_s, units })
            .with_caveats(&caveats.in_units(units));
    if let Some(second) = second {
        figure.elements.extend(second_contact_mark(second.point_m, figure.x.unit));
    }
    figure
}

/// A cross where the vehicles meet again.
fn second_contact_mark([x_m, y_m]: [f64; 2], unit: Unit) -> [FigureElement; 2] {
    [1.0, -1.0].map(|slope| {
        let points = [-CROSS_M, CROSS_M].map(|d| [x_m + d, y_m + slope * d]);
        let points = points.map(|point| point.map(|value| unit.from_si(value))).to_vec();
        let name = "second contact".to_owned();
        let (role, style) = (Role::Resultant, LineStyle::Solid);
        FigureElement::Line(Series { name, role, style, points })
    })
}
