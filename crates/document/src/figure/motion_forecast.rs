//! Figures of a motion forecast with its uncertainty: from above, and over time.

use std::sync::Arc;

use crate::figure::scene::{path_of, vehicle_outline};
use crate::figure::{
    Axis, Band, Figure, FigureElement, HeatMap, LineStyle, Path, Role, STRIKING, Series,
};
use impactlab_core::collision::{Footprint, Pose};
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_core::vehicle::VehicleState;
use impactlab_networks::response::{MotionDistribution, STEP_S};
use impactlab_study::PredictMotionAnswer;
use impactlab_study::analysis::{
    Analysis, DensityMap, MOTION_BAND_LEVELS, MotionBand, MotionBands, RestOutcome,
};

/// Opacity of the band at each of [`MOTION_BAND_LEVELS`].
const BAND_OPACITIES: [f32; MOTION_BAND_LEVELS.len()] = [0.18, 0.25];
/// Distance from the means of all groups of draws that the view around a vehicle covers, in standard
/// deviations.
const SURROUNDINGS_REACH: f64 = 3.0;
/// Largest number of draws whose paths are shown.
const MAX_PATHS: usize = 15;

/// Data that the figures of a forecast show.
#[derive(Debug, Clone, Copy)]
pub struct MotionForecastFigure<'a> {
    /// Title of the figure.
    pub title: &'a str,
    /// Predicted distribution of the motion.
    pub distribution: &'a MotionDistribution,
    /// Central path of the forecast, one state for each instant of the distribution.
    pub central: &'a [VehicleState<f64>],
    /// Central intervals of the forecast over time.
    pub bands: &'a MotionBands,
    /// Probability density of the vehicle's position, if it is shown.
    pub density: Option<&'a DensityMap>,
    /// Whether paths of draws are shown.
    pub draws: bool,
    /// Recorded motion, if there is one.
    pub reference: Option<&'a TimeSeries>,
    /// Motion simulated with the 4DOF model, if there is one.
    pub simulation: Option<&'a TimeSeries>,
    /// Central path and outline of the striking vehicle, where both are followed.
    pub striking: Option<(&'a [VehicleState<f64>], Footprint)>,
    /// Outline of the vehicle.
    pub footprint: Footprint,
    /// Time at which outlines and readouts are given, s.
    pub time_s: f64,
    /// Time of a second contact, which is not computed, s: no probability is shown after it.
    pub until_s: f64,
    /// Time after which 95 % of the draws are at rest, s, where they are followed to rest: figures over
    /// time end there.
    pub at_rest_s: Option<f64>,
    /// System of units of the axes.
    pub units: UnitSystem,
    /// What restricts the forecast.
    pub caveats: &'a Caveats,
}

impl<'a> MotionForecastFigure<'a> {
    /// A forecast without density, draws, recorded and simulated motion.
    pub fn new(
        answer: &'a PredictMotionAnswer,
        bands: &'a MotionBands,
        caveats: &'a Caveats,
        time_s: f64,
        units: UnitSystem,
    ) -> Self {
        let PredictMotionAnswer { analysis, forecast, .. } = answer;
        Self {
            title: &analysis.name,
            distribution: &forecast.distribution,
            central: &forecast.central,
            bands,
            density: None,
            draws: false,
            reference: None,
            simulation: None,
            striking: striking(answer),
            footprint: analysis.footprint,
            time_s,
            until_s: answer.report.known_until_s(),
            at_rest_s: forecast.rest.as_ref().and_then(RestOutcome::nearly_all_at_rest_s),
            units,
            caveats,
        }
    }

    /// The density, if it is not one of positions after a second contact.
    fn known_density(&self) -> Option<&'a DensityMap> {
        self.density.filter(|map| map.window_s[1] <= self.until_s)
    }

    /// The intervals up to a second contact.
    fn known_bands(&self) -> impl Iterator<Item = (&'a f64, &'a MotionBand)> + use<'a> {
        let (bands, until_s) = (self.bands, self.until_s);
        bands.time_s.iter().zip(&bands.intervals).filter(move |(time_s, _)| **time_s <= until_s)
    }

    /// Number of instants that figures over time show.
    fn n_shown(&self) -> usize {
        let all = self.central.len();
        self.at_rest_s.map_or(all, |at_s| all.min((at_s / STEP_S).ceil() as usize + 1))
    }

    /// Why the figures over time end before the forecast; `None` where they do not.
    pub fn cut(&self) -> Option<&'static str> {
        (self.n_shown() < self.central.len()).then_some("until 95 % of the draws are at rest")
    }

    /// The same with the recorded and the simulated motion beside the forecast, as far as there are any.
    #[must_use]
    pub fn with_motions(self, analysis: &'a Analysis) -> Self {
        Self {
            reference: analysis.reference.as_ref(),
            simulation: analysis.simulation.as_ref().map(|motion| &motion.series),
            ..self
        }
    }
}

/// A quantity of a forecast that is shown over time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForecastChannel {
    /// Channel of the quantity in a time series.
    pub channel: Channel,
    /// Index of the quantity in [`VehicleState::planar`] and in the intervals.
    axis: usize,
}

/// Quantities for which there are intervals, from top to bottom.
pub const FORECAST_CHANNELS: [ForecastChannel; 6] = [
    ForecastChannel { channel: Channel::X, axis: 0 },
    ForecastChannel { channel: Channel::Y, axis: 1 },
    ForecastChannel { channel: Channel::Yaw, axis: 2 },
    ForecastChannel { channel: Channel::Vx, axis: 3 },
    ForecastChannel { channel: Channel::Vy, axis: 4 },
    ForecastChannel { channel: Channel::YawRate, axis: 5 },
];

/// The forecast from above: central path, paths of draws, recorded and simulated path, density of
/// the position with its regions, and vehicle outlines at the time of the figure.
pub fn forecast_scene_figure(input: &MotionForecastFigure<'_>) -> Figure {
    let x = Axis::shown("X, along the road", Quantity::Length, input.units);
    let y = Axis::shown("Y, to the left", Quantity::Length, input.units);
    let shown = |[px, py]: [f64; 2]| [x.unit.from_si(px), y.unit.from_si(py)];
    let path = |name: &str, role: Role, states: &[&VehicleState<f64>]| {
        let points = states.iter().map(|state| shown([state.x_m, state.y_m])).collect();
        FigureElement::Path(Path {
            series: Series { name: name.to_owned(), role, style: LineStyle::Solid, points },
            time_s: (0..states.len()).map(|i| i as f64 * STEP_S).collect(),
            yaw_rad: states.iter().map(|state| state.yaw_rad).collect(),
        })
    };
    let at = instant(input);
    let mut elements: Vec<FigureElement> = input
        .known_density()
        .map(|map| FigureElement::HeatMap(heat_map(map, &shown)))
        .into_iter()
        .collect();
    for region in input.known_density().iter().flat_map(|map| &map.regions) {
        let name = format!("{:.0} % region", 100.0 * region.level);
        let outline = |points: &Vec<[f64; 2]>| {
            let points = points.iter().map(|point| shown(*point)).collect();
            FigureElement::line(&name, Role::Model, points)
        };
        elements.extend(region.outlines.iter().map(outline));
    }
    if input.draws {
        for states in input.distribution.draws().iter().take(MAX_PATHS) {
            elements.push(path("drawn motions", Role::Muted, &states.iter().collect::<Vec<_>>()));
        }
    }
    let line = |name: &str, role, style, series: &TimeSeries| -> Option<FigureElement> {
        let points = series.get(Channel::X)?.iter().zip(series.get(Channel::Y)?);
        let points = points.map(|(px, py)| shown([*px, *py])).collect();
        Some(path_of(Series { name: name.to_owned(), role, style, points }, series))
    };
    let others = [
        ("4DOF model", Role::Pulse, LineStyle::Dotted, input.simulation),
        ("recorded", Role::Reference, LineStyle::Dashed, input.reference),
    ];
    for (name, role, style, series) in others {
        elements.extend(series.and_then(|series| line(name, role, style, series)));
    }
    if let Some((central, footprint)) = input.striking {
        let (role, name) = (Role::Striking, STRIKING);
        elements.push(path(name, role, &central.iter().collect::<Vec<_>>()));
        if let Some(state) = central.get(at) {
            let pose = Pose::from_state(state);
            let style = LineStyle::Solid;
            elements.extend(vehicle_outline(name, role, style, &footprint, &pose, x.unit));
        }
    }
    let central: Vec<_> = input.central.iter().collect();
    elements.push(path("central path", Role::Target, &central));
    if let Some(state) = input.central.get(at) {
        let pose = Pose::from_state(state);
        let (role, style) = (Role::Target, LineStyle::Solid);
        let footprint = &input.footprint;
        elements.extend(vehicle_outline("central path", role, style, footprint, &pose, x.unit));
    }
    if let Some(pose) =
        input.reference.and_then(|series| Pose::from_motion(series, at as f64 * STEP_S))
    {
        let (role, style) = (Role::Reference, LineStyle::Dashed);
        let footprint = &input.footprint;
        elements.extend(vehicle_outline("recorded", role, style, footprint, &pose, x.unit));
    }
    let title = format!("{}: position after {:.2} s", input.title, at as f64 * STEP_S);
    Figure::new(title, [x, y], elements).plan().with_caveats(&input.caveats.in_units(input.units))
}

/// The striking vehicle of a forecast of both.
fn striking(answer: &PredictMotionAnswer) -> Option<(&[VehicleState<f64>], Footprint)> {
    let both = answer.forecast.both.as_deref()?;
    Some((&both.striking_central, answer.analysis.striking.as_ref()?.footprint))
}

/// View around the vehicle at the time of the figure, which holds its outline and nearly all of the
/// probability of its position: lowest and highest [x, y] in the units of the axes.
pub fn forecast_surroundings(input: &MotionForecastFigure<'_>) -> [[f64; 2]; 2] {
    let unit = Quantity::Length.display_unit(input.units);
    let at = instant(input);
    let position = input.distribution.position(at);
    let centre = input.central.get(at).map_or([0.0; 2], |state| [state.x_m, state.y_m]);
    let bounds = position.bounds(SURROUNDINGS_REACH).unwrap_or([centre; 2]);
    let end = |axis: usize, sign: f64| {
        let least = centre[axis] + sign * input.footprint.length_m;
        let of_density = bounds[usize::from(sign > 0.0)][axis];
        unit.from_si(if sign > 0.0 { of_density.max(least) } else { of_density.min(least) })
    };
    [-1.0, 1.0].map(|sign| [end(0, sign), end(1, sign)])
}

/// Value on the central path and ends of the 90 % interval at the time of the figure, in the unit
/// of the axis: “Y 3.2 (2.9 … 3.6)”. The value alone after a second contact.
pub fn forecast_readout(input: &MotionForecastFigure<'_>, channel: ForecastChannel) -> String {
    let ForecastChannel { channel, axis } = channel;
    let unit = channel.quantity().display_unit(input.units);
    let at_s = input.time_s;
    let off = |(time_s, _): &(&f64, _)| (**time_s - at_s).abs();
    let band = input.known_bands().min_by(|a, b| off(a).total_cmp(&off(b)));
    let band = band.filter(|_| at_s <= input.until_s).map(|(_, band)| band);
    let Some(state) = input.central.get(instant(input)) else {
        return channel.label().to_owned();
    };
    // The value is rounded before formatting, and adding zero removes the sign of a negative zero.
    let shown = |value: f64| format!("{:.1}", (unit.from_si(value) * 10.0).round() / 10.0 + 0.0);
    let value = shown(state.planar()[axis]);
    let Some([low, high]) = band.map(|band| band[axis][0].map(shown)) else {
        return format!("{} {value}", channel.label());
    };
    format!("{} {value} ({low} … {high})", channel.label())
}

/// Index of the instant at the time of the figure, limited to the forecast.
fn instant(input: &MotionForecastFigure<'_>) -> usize {
    let last = input.distribution.n_instants().saturating_sub(1);
    ((input.time_s.max(0.0) / STEP_S).round() as usize).min(last)
}

/// Heat map of a density; `shown` converts a point from m into the units of the axes.
fn heat_map(map: &DensityMap, shown: &dyn Fn([f64; 2]) -> [f64; 2]) -> HeatMap {
    let grid = &map.grid;
    let low = shown(grid.low_m);
    let next = shown([grid.low_m[0] + grid.step_m[0], grid.low_m[1] + grid.step_m[1]]);
    let [from_s, to_s] = map.window_s;
    let when = match to_s > from_s {
        true => format!("{from_s:.2} to {to_s:.2} s"),
        false => format!("{to_s:.2} s"),
    };
    HeatMap {
        name: format!("density of the CG, {when}"),
        role: Role::Model,
        low,
        step: [next[0] - low[0], next[1] - low[1]],
        size: grid.size,
        values: Arc::clone(&map.values),
    }
}

/// A quantity over time: central path, bands at [`MOTION_BAND_LEVELS`], recorded motion and 4DOF
/// simulation. A forecast to rest is shown until nearly all draws are at rest, which the title says.
pub fn forecast_channel_figure(
    input: &MotionForecastFigure<'_>,
    channel: ForecastChannel,
) -> Figure {
    let ForecastChannel { channel, axis } = channel;
    let x = Axis::shown("Time", Quantity::Time, input.units);
    let y = Axis::shown(channel.label(), channel.quantity(), input.units);
    let n_shown = input.n_shown();
    let shown_s = n_shown as f64 * STEP_S;
    let bands = || input.known_bands().filter(move |(time_s, _)| **time_s < shown_s);
    let mut elements = Vec::new();
    for (rank, (level, opacity)) in MOTION_BAND_LEVELS.into_iter().zip(BAND_OPACITIES).enumerate() {
        let edge = |end: usize| -> Vec<f64> {
            let ends = bands().map(|(_, instant)| instant[axis][rank][end]);
            ends.map(|value| y.unit.from_si(value)).collect()
        };
        elements.push(FigureElement::Band(Band {
            name: format!("{:.0} % band", 100.0 * level),
            role: Role::Model,
            opacity,
            x: bands().map(|(time_s, _)| x.unit.from_si(*time_s)).collect(),
            low: edge(0),
            high: edge(1),
        }));
    }
    let line = |name: &str, role, style, series: &TimeSeries| -> Option<FigureElement> {
        let samples = series.time_s().iter().zip(series.get(channel)?);
        let points = samples.map(|(&t, &v)| [x.unit.from_si(t), y.unit.from_si(v)]).collect();
        Some(FigureElement::Line(Series { name: name.to_owned(), role, style, points }))
    };
    let others = [
        ("4DOF model", Role::Pulse, LineStyle::Dotted, input.simulation),
        ("recorded", Role::Reference, LineStyle::Dashed, input.reference),
    ];
    for (name, role, style, series) in others {
        elements.extend(series.and_then(|series| line(name, role, style, series)));
    }
    let central = input.central.iter().take(n_shown).enumerate();
    let central = central.map(|(i, state)| {
        [x.unit.from_si(i as f64 * STEP_S), y.unit.from_si(state.planar()[axis])]
    });
    elements.push(FigureElement::line("central path", Role::Target, central.collect()));
    let cut = input.cut().map_or(String::new(), |cut| format!(", {cut}"));
    let title = format!("{}: {} over time{cut}", input.title, channel.label());
    Figure::new(title, [x, y], elements).with_caveats(&input.caveats.in_units(input.units))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_forecast_to_rest_is_shown_until_nearly_all_draws_are_at_rest() {
        let n_instants = 1001;
        let central = vec![VehicleState::default(); n_instants];
        let bands = MotionBands {
            time_s: (0..n_instants).step_by(5).map(|at| at as f64 * STEP_S).collect(),
            intervals: vec![[[[0.0, 1.0]; 2]; 6]; n_instants.div_ceil(5)],
        };
        let (distribution, caveats) = (MotionDistribution::default(), Caveats::default());
        let input = MotionForecastFigure {
            title: "case",
            distribution: &distribution,
            central: &central,
            bands: &bands,
            density: None,
            draws: false,
            reference: None,
            simulation: None,
            striking: None,
            footprint: Footprint { length_m: 4.5, width_m: 1.8, cg_from_front_m: 2.2 },
            time_s: 0.0,
            until_s: f64::INFINITY,
            at_rest_s: Some(4.2),
            units: UnitSystem::Si,
            caveats: &caveats,
        };
        let last_s = |input: &MotionForecastFigure<'_>| {
            let figure = forecast_channel_figure(input, FORECAST_CHANNELS[3]);
            let ends = figure.elements.iter().filter_map(|element| match element {
                FigureElement::Line(series) => Some(series.points.last()?[0]),
                FigureElement::Band(band) => band.x.last().copied(),
                _ => None,
            });
            (ends.fold(0.0, f64::max), figure.title)
        };
        let (end_s, title) = last_s(&input);
        assert!((end_s - 4.2).abs() < 1.5 * STEP_S, "{end_s}");
        assert!(title.ends_with("over time, until 95 % of the draws are at rest"), "{title}");
        let (end_s, title) = last_s(&MotionForecastFigure { at_rest_s: None, ..input });
        assert!((end_s - 10.0).abs() < 1e-9 && title.ends_with("over time"), "{end_s} {title}");
    }
}
