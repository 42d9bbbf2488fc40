//! Where the struck vehicle goes, with how sure that is: from above and over time.

use crate::collision::{Footprint, Pose};
use crate::data::{Channel, TimeSeries};
use crate::figure::scene::vehicle_outline;
use crate::figure::{Axis, Band, Element, Figure, HeatMap, LineStyle, Role, Series, pose_at};
use crate::response::{MotionDistribution, STEP_S};
use crate::uncertainty::PlanarGrid;
use crate::units::{Quantity, UnitSystem};
use crate::vehicle::VehicleState;

/// Points of the density along the longer side of the rectangle.
const GRID_POINTS: usize = 220;
/// How many standard deviations of all parts the density is shown.
const REACH: f64 = 3.5;
/// Least width of the rectangle, m.
const LEAST_SIDE_M: f64 = 2.0;
/// Levels of the bands, from the widest on, and how much of the ground each hides.
const BANDS: [(f64, f32); 2] = [(0.9, 0.18), (0.5, 0.25)];
/// Every how many steps the bands have an edge point.
const BAND_STRIDE: usize = 5;
/// Component paths that are drawn.
const MAX_PATHS: usize = 15;

/// What is shown of a forecast.
#[derive(Debug, Clone, Copy)]
pub struct MotionForecastFigure<'a> {
    /// What it is.
    pub title: &'a str,
    /// The forecast.
    pub distribution: &'a MotionDistribution,
    /// Its central path.
    pub central: &'a [VehicleState<f64>],
    /// What was recorded, if anything was.
    pub reference: Option<&'a TimeSeries>,
    /// What the 4DOF model says, if it was asked.
    pub simulation: Option<&'a TimeSeries>,
    /// Outline of the vehicle.
    pub footprint: Footprint,
    /// The moment of density and outlines, s.
    pub time_s: f64,
    /// Units of the axes.
    pub units: UnitSystem,
}

/// A quantity of a forecast over time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForecastChannel {
    /// The channel.
    pub channel: Channel,
    /// Its place in the covariance.
    axis: usize,
}

/// Those with bands, from top to bottom.
pub const FORECAST_CHANNELS: [ForecastChannel; 6] = [
    ForecastChannel { channel: Channel::X, axis: 0 },
    ForecastChannel { channel: Channel::Y, axis: 1 },
    ForecastChannel { channel: Channel::Yaw, axis: 2 },
    ForecastChannel { channel: Channel::Vx, axis: 3 },
    ForecastChannel { channel: Channel::Vy, axis: 4 },
    ForecastChannel { channel: Channel::YawRate, axis: 5 },
];

/// The central path and those of components, density of the position at a moment, outlines.
pub fn forecast_scene_figure(input: &MotionForecastFigure<'_>) -> Figure {
    let x = Axis::shown("X, along the road", Quantity::Length, input.units);
    let y = Axis::shown("Y, to the left", Quantity::Length, input.units);
    let shown = |[px, py]: [f64; 2]| [x.unit.from_si(px), y.unit.from_si(py)];
    let path = |states: &mut dyn Iterator<Item = &VehicleState<f64>>| -> Vec<[f64; 2]> {
        states.map(|state| shown([state.x_m, state.y_m])).collect()
    };
    let at = instant(input);
    let mut elements = vec![Element::HeatMap(density(input, at, &shown))];
    let components = &input.distribution.components;
    let stride = components.len().div_ceil(MAX_PATHS).max(1);
    for component in components.iter().step_by(stride) {
        let points = path(&mut component.states.iter().map(|state| &state.mean));
        elements.push(Element::line("components", Role::Muted, points));
    }
    let line = |name: &str, role, style, series: &TimeSeries| -> Option<Element> {
        let points = series.get(Channel::X)?.iter().zip(series.get(Channel::Y)?);
        let points = points.map(|(px, py)| shown([*px, *py])).collect();
        Some(Element::Line(Series { name: name.to_owned(), role, style, points }))
    };
    let others = [
        ("4DOF model", Role::Simulation, LineStyle::Dotted, input.simulation),
        ("reference", Role::Reference, LineStyle::Dashed, input.reference),
    ];
    for (name, role, style, series) in others {
        elements.extend(series.and_then(|series| line(name, role, style, series)));
    }
    elements.push(Element::line("central path", Role::Target, path(&mut input.central.iter())));
    if let Some(state) = input.central.get(at) {
        let pose = Pose { x_m: state.x_m, y_m: state.y_m, yaw_rad: state.yaw_rad };
        let look = ("central path", Role::Target, LineStyle::Solid);
        elements.extend(vehicle_outline(look, (&input.footprint, &pose), x.unit));
    }
    if let Some(pose) = input.reference.and_then(|series| pose_at(series, at as f64 * STEP_S)) {
        let look = ("reference", Role::Reference, LineStyle::Dashed);
        elements.extend(vehicle_outline(look, (&input.footprint, &pose), x.unit));
    }
    let title = format!("{}: position after {:.2} s", input.title, at as f64 * STEP_S);
    Figure { title, x, y, equal_aspect: true, log_y: false, elements }
}

fn instant(input: &MotionForecastFigure<'_>) -> usize {
    let last = input.distribution.n_instants().saturating_sub(1);
    ((input.time_s.max(0.0) / STEP_S).round() as usize).min(last)
}

fn density(
    input: &MotionForecastFigure<'_>,
    at: usize,
    shown: &dyn Fn([f64; 2]) -> [f64; 2],
) -> HeatMap {
    let position = input.distribution.position(at);
    let mut bounds = position.bounds(REACH).unwrap_or([[0.0; 2]; 2]);
    let [low, high] = &mut bounds;
    for (low, high) in low.iter_mut().zip(high) {
        let missing = (LEAST_SIDE_M - (*high - *low)).max(0.0);
        *low -= 0.5 * missing;
        *high += 0.5 * missing;
    }
    let sides = [0, 1].map(|axis: usize| bounds[1][axis] - bounds[0][axis]);
    let step = sides[0].max(sides[1]) / GRID_POINTS as f64;
    let size = sides.map(|side| ((side / step).ceil() as usize).max(2));
    let grid = PlanarGrid::over(bounds, size);
    let low = shown(grid.low_m);
    let next = shown([grid.low_m[0] + grid.step_m[0], grid.low_m[1] + grid.step_m[1]]);
    HeatMap {
        name: "density of the CG".to_owned(),
        role: Role::Model,
        low,
        step: [next[0] - low[0], next[1] - low[1]],
        size,
        values: position.density_on(&grid),
    }
}

/// A quantity over time: bands of 50 and 90 %, mean, reference, 4DOF model.
pub fn forecast_channel_figure(
    input: &MotionForecastFigure<'_>,
    channel: ForecastChannel,
) -> Figure {
    let ForecastChannel { channel, axis } = channel;
    let x = Axis::shown("Time", Quantity::Time, input.units);
    let y = Axis::shown(channel.label(), channel.quantity(), input.units);
    let mut elements = Vec::new();
    let instants: Vec<usize> = (0..input.distribution.n_instants()).step_by(BAND_STRIDE).collect();
    let marginals: Vec<_> =
        instants.iter().map(|at| input.distribution.marginal(*at, axis)).collect();
    for (level, opacity) in BANDS {
        let (mut times, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new());
        for (at, marginal) in instants.iter().zip(&marginals) {
            let Some(marginal) = marginal else { continue };
            let [from, to] = marginal.interval(level);
            times.push(x.unit.from_si(*at as f64 * STEP_S));
            low.push(y.unit.from_si(from));
            high.push(y.unit.from_si(to));
        }
        let name = format!("{:.0} % band", 100.0 * level);
        elements.push(Element::Band(Band {
            name,
            role: Role::Model,
            opacity,
            x: times,
            low,
            high,
        }));
    }
    let line = |name: &str, role, style, series: &TimeSeries| -> Option<Element> {
        let samples = series.time_s().iter().zip(series.get(channel)?);
        let points = samples.map(|(&t, &v)| [x.unit.from_si(t), y.unit.from_si(v)]).collect();
        Some(Element::Line(Series { name: name.to_owned(), role, style, points }))
    };
    let others = [
        ("4DOF model", Role::Simulation, LineStyle::Dotted, input.simulation),
        ("reference", Role::Reference, LineStyle::Dashed, input.reference),
    ];
    for (name, role, style, series) in others {
        elements.extend(series.and_then(|series| line(name, role, style, series)));
    }
    let central = input.central.iter().enumerate();
    let central = central.map(|(i, state)| {
        [x.unit.from_si(i as f64 * STEP_S), y.unit.from_si(state.planar()[axis])]
    });
    elements.push(Element::line("central path", Role::Target, central.collect()));
    let title = format!("{}: {} over time", input.title, channel.label());
    Figure { title, x, y, equal_aspect: false, log_y: false, elements }
}
