//! Time histories of the motion.

use crate::data::{Channel, TimeSeries};
use crate::figure::{Axis, Element, Figure, LineStyle, Role, Series};
use crate::units::{Quantity, UnitSystem};

/// The histories that the motion panel shows, from top to bottom.
pub const MOTION_CHANNELS: [Channel; 4] =
    [Channel::Vx, Channel::Vy, Channel::YawRate, Channel::Roll];

/// One channel over time: simulation full, reference dashed. A series without the channel is left
/// out.
pub fn motion_figure(
    channel: Channel,
    simulation: Option<&TimeSeries>,
    reference: Option<&TimeSeries>,
    units: UnitSystem,
) -> Figure {
    let x = Axis::shown("Time", Quantity::Time, units);
    let y = Axis::shown(channel.label(), channel.quantity(), units);
    let line = |name: &str, role, style, series: Option<&TimeSeries>| {
        let series = series?;
        let samples = series.time_s().iter().zip(series.get(channel)?);
        let points = samples.map(|(&t, &v)| [x.unit.from_si(t), y.unit.from_si(v)]).collect();
        Some(Element::Line(Series { name: name.to_owned(), role, style, points }))
    };
    let elements = [
        line("reference", Role::Reference, LineStyle::Dashed, reference),
        line("4DOF simulation", Role::Simulation, LineStyle::Solid, simulation),
    ];
    Figure {
        title: format!("{} over time", channel.label()),
        x: x.clone(),
        y: y.clone(),
        equal_aspect: false,
        elements: elements.into_iter().flatten().collect(),
    }
}
