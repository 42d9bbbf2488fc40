//! Figures and readouts of the motion over time.

use crate::figure::{Axis, Figure, FigureElement, LineStyle, Role, Series};
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_core::numerics::interpolate;
use impactlab_core::units::{Quantity, UnitSystem, significant};

/// Channels that the motion panel shows, from top to bottom.
pub const MOTION_CHANNELS: [Channel; 4] =
    [Channel::Vx, Channel::Vy, Channel::YawRate, Channel::Roll];

/// Largest value, in the unit of display, of a channel that is zero but for rounding.
const ROUNDING: f64 = 1e-6;

/// One channel over time: the simulation as a solid, the reference as a dashed line. A motion
/// without the channel is left out.
pub fn motion_figure(
    name: &str,
    channel: Channel,
    [simulation, reference]: [Option<&TimeSeries>; 2],
    units: UnitSystem,
) -> Figure {
    let x = Axis::shown("Time", Quantity::Time, units);
    let y = Axis::shown(channel.label(), channel.quantity(), units);
    let line = |name: &str, role, style, series: Option<&TimeSeries>| {
        let series = series?;
        let values = series.get(channel)?.iter().map(|value| y.unit.from_si(*value));
        // Rounding would fill the axis.
        let is_zero = values.clone().all(|value| value.abs() < ROUNDING);
        let values = values.map(|value| if is_zero { 0.0 } else { value });
        let samples = series.time_s().iter().zip(values);
        let points = samples.map(|(t, value)| [x.unit.from_si(*t), value]).collect();
        Some(FigureElement::Line(Series { name: name.to_owned(), role, style, points }))
    };
    let elements = [
        line("recorded", Role::Reference, LineStyle::Dashed, reference),
        line("4DOF simulation", Role::Simulation, LineStyle::Solid, simulation),
    ];
    let elements: Vec<FigureElement> = elements.into_iter().flatten().collect();
    Figure::new(format!("{name}: {} over time", channel.label()), [x, y], elements)
}

/// A recording of a channel over time, to be drawn over a figure of that channel; `None` without it.
///
/// - `offset_s`: time of the figure at which the recording has its time zero, s.
pub fn recording_line(
    name: &str,
    series: &TimeSeries,
    offset_s: f64,
    channel: Channel,
    units: UnitSystem,
) -> Option<FigureElement> {
    let [x, y] = [Quantity::Time, channel.quantity()].map(|quantity| quantity.display_unit(units));
    let samples = series.time_s().iter().zip(series.get(channel)?);
    let points = samples.map(|(t, v)| [x.from_si(t + offset_s), y.from_si(*v)]).collect();
    let (role, style) = (Role::Reference, LineStyle::Dotted);
    Some(FigureElement::Line(Series { name: name.to_owned(), role, style, points }))
}

/// The path of a recording, to be drawn over a scene; `None` without a position.
pub fn recording_path(name: &str, series: &TimeSeries, units: UnitSystem) -> Option<FigureElement> {
    let unit = Quantity::Length.display_unit(units);
    let positions = series.get(Channel::X)?.iter().zip(series.get(Channel::Y)?);
    let points = positions.map(|(x, y)| [unit.from_si(*x), unit.from_si(*y)]).collect();
    let (role, style) = (Role::Reference, LineStyle::Dotted);
    Some(FigureElement::Line(Series { name: name.to_owned(), role, style, points }))
}

/// Values of a channel in both motions at a time, for example “v_x 31.2 · recorded 30.4 km/h”. If
/// neither motion has the channel, the text is its label alone.
///
/// - `time_s`: time of the values, s; the motions are interpolated linearly.
pub fn motion_readout(
    channel: Channel,
    [simulation, reference]: [Option<&TimeSeries>; 2],
    time_s: f64,
    units: UnitSystem,
) -> String {
    let unit = channel.quantity().display_unit(units);
    let at = |series: Option<&TimeSeries>| {
        let series = series?;
        let value = interpolate(series.time_s(), series.get(channel)?, time_s)?;
        Some(significant(unit.from_si(value)))
    };
    let values = match (at(simulation), at(reference)) {
        (Some(simulated), Some(recorded)) => format!("{simulated} · recorded {recorded}"),
        (Some(value), None) | (None, Some(value)) => value,
        (None, None) => return channel.label().to_owned(),
    };
    format!("{} {values} {}", channel.label(), unit.symbol)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The yaw rate of a car that ran straight into a wall had an axis of “0.000000000”.
    #[test]
    fn a_channel_that_is_zero_but_for_rounding_is_drawn_as_zero() {
        let drawn = |rates_rad_s: [f64; 3]| -> Vec<f64> {
            let mut series = TimeSeries::new(vec![0.0, 0.1, 0.2]).unwrap();
            series.insert(Channel::YawRate, rates_rad_s.to_vec()).unwrap();
            let motions = [Some(&series), None];
            let figure = motion_figure("wall", Channel::YawRate, motions, UnitSystem::Si);
            let [FigureElement::Line(line)] = &figure.elements[..] else { return Vec::new() };
            line.points.iter().map(|point| point[1]).collect()
        };
        assert_eq!(drawn([0.0, 3e-13, -8e-13]), [0.0; 3]);
        assert!(drawn([0.0, 3e-13, 1e-3])[2] > 0.05);
    }
}
