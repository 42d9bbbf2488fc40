//! Figures of a replay of a recorder: the path from above, and what was recorded beside what was replayed.

use crate::figure::scene::shown;
use crate::figure::{Axis, Band, Figure, FigureElement, LineStyle, Path, Role, Series};
use impactlab_core::units::{Estimate, Quantity, UnitSystem};
use impactlab_core::vehicle::frames::world_from_body;
use impactlab_study::{Answer, ReplayPoint, ReplayReport, ReplaySample};

/// Names of what was recorded, of what was replayed, and of where 90 % of the draws are.
const RECORDED: &str = "recorded";
const REPLAYED: &str = "replayed";
const BAND: &str = "90 % band";

/// Opacity of a band.
const BAND_OPACITY: f32 = 0.25;

/// Half the length of a tick along the heading, m.
const HALF_TICK_M: f64 = 1.0;

/// Places of the path from one tick to the next.
const TICK_STEP: usize = 5;

/// What a replay shows over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ReplayCurve {
    /// Velocity along the vehicle.
    Speed,
    /// Yaw rate.
    YawRate,
    /// Steer angle of the road wheels.
    Steering,
}

impl ReplayCurve {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Speed, Self::YawRate, Self::Steering];

    /// What it is called.
    pub fn label(self) -> &'static str {
        match self {
            Self::Speed => "Speed",
            Self::YawRate => "Yaw rate",
            Self::Steering => "Steer angle of the road wheels",
        }
    }

    fn quantity(self) -> Quantity {
        match self {
            Self::Speed => Quantity::Speed,
            Self::YawRate => Quantity::AngularVelocity,
            Self::Steering => Quantity::Angle,
        }
    }

    /// What was recorded at a sample; none if nothing was.
    fn recorded(self, sample: &ReplaySample, steering_ratio: f64) -> Option<f64> {
        match self {
            Self::Speed => Some(sample.recorded_speed_m_s),
            Self::YawRate => sample.recorded_yaw_rate_rad_s,
            Self::Steering => Some(sample.steering_wheel_rad / steering_ratio),
        }
    }

    /// What was replayed at a sample.
    fn replayed(self, sample: &ReplaySample) -> &Estimate {
        match self {
            Self::Speed => &sample.vx_body_m_s,
            Self::YawRate => &sample.yaw_rate_rad_s,
            Self::Steering => &sample.steer_rad,
        }
    }

    /// What was replayed between the samples; none of what is a line between them.
    fn between(self, point: &ReplayPoint) -> Option<f64> {
        match self {
            Self::Speed => Some(point.vx_body_m_s),
            Self::YawRate => Some(point.yaw_rate_rad_s),
            Self::Steering => None,
        }
    }
}

/// A curve of a replay over the clock of the recorder: what was recorded as points on a dashed line, what was
/// replayed as a line, and the band of 90 % at the samples. The recorded steering wheel is shown over the
/// steering ratio.
pub fn replay_curve_figure(
    report: &Answer<ReplayReport>,
    curve: ReplayCurve,
    units: UnitSystem,
) -> Figure {
    let x = Axis::shown("Time on the clock of the recorder", Quantity::Time, units);
    let y = Axis::shown(curve.label(), curve.quantity(), units);
    let at = |time_s: f64, value: f64| [x.unit.from_si(time_s), y.unit.from_si(value)];
    let samples = &report.samples;
    let ends = |idx: usize| -> Vec<f64> {
        let end = |sample: &ReplaySample| y.unit.from_si(curve.replayed(sample).ninety()[idx]);
        samples.iter().map(end).collect()
    };
    let band = FigureElement::Band(Band {
        name: BAND.to_owned(),
        role: Role::Simulation,
        opacity: BAND_OPACITY,
        x: samples.iter().map(|sample| x.unit.from_si(sample.recorder_time_s)).collect(),
        low: ends(0),
        high: ends(1),
    });
    // The path begins at the first sample, and its clock is that of the contact.
    let shift_s = report.path.first().map_or(0.0, |first| report.recorded_s[0] - first.time_s);
    let between = |point: &ReplayPoint| Some(at(point.time_s + shift_s, curve.between(point)?));
    let mut line: Vec<[f64; 2]> = report.path.iter().filter_map(between).collect();
    if line.is_empty() {
        let median = |of: &ReplaySample| at(of.recorder_time_s, curve.replayed(of).median);
        line = samples.iter().map(median).collect();
    }
    let recorded = |sample: &ReplaySample| {
        Some(at(sample.recorder_time_s, curve.recorded(sample, report.steering_ratio)?))
    };
    let recorded: Vec<[f64; 2]> = samples.iter().filter_map(recorded).collect();
    let mut elements = vec![band, FigureElement::line(REPLAYED, Role::Simulation, line)];
    if !recorded.is_empty() {
        elements.push(FigureElement::dashed(RECORDED, Role::Reference, recorded.clone()));
        elements.push(FigureElement::points(RECORDED, Role::Reference, recorded));
    }
    let title = format!("{}: {}, recorded and replayed", report.name, curve.label());
    Figure::new(title, [x, y], elements).with_caveats(&report.caveats.in_units(units))
}

/// The path of a replay from above, with a tick along the heading each half second, the band across it in which
/// 90 % of the draws are, and the ranges of X and of Y at the first sample, which hold fewer draws together.
pub fn replay_path_figure(report: &Answer<ReplayReport>, units: UnitSystem) -> Figure {
    let x = Axis::shown("X", Quantity::Length, units);
    let y = Axis::shown("Y, to the left", Quantity::Length, units);
    let (unit, path) = (x.unit, &report.path);
    // Its edges as lines, since it may bend.
    let edge = |idx: usize| {
        let place = |point: &ReplayPoint| beside(point, [0.0, point.left_range_m[idx]]);
        let places = path.iter().map(place).collect();
        FigureElement::dashed(BAND, Role::Simulation, shown(unit, places))
    };
    let [x_m, y_m] = [&report.start.x_m, &report.start.y_m].map(Estimate::ninety);
    let corners = vec![[x_m[0], y_m[0]], [x_m[1], y_m[0]], [x_m[1], y_m[1]], [x_m[0], y_m[1]]];
    let mut elements = vec![
        edge(0),
        edge(1),
        FigureElement::polygon(
            "first sample, X and Y each 90 %",
            Role::Muted,
            shown(unit, corners),
        ),
        FigureElement::Path(Path {
            series: Series {
                name: REPLAYED.to_owned(),
                role: Role::Simulation,
                style: LineStyle::Solid,
                points: shown(unit, path.iter().map(|point| [point.x_m, point.y_m]).collect()),
            },
            time_s: path.iter().map(|point| point.time_s).collect(),
            yaw_rad: path.iter().map(|point| point.yaw_rad).collect(),
        }),
    ];
    elements.extend(path.iter().rev().step_by(TICK_STEP).map(|point| {
        let ends = [-HALF_TICK_M, HALF_TICK_M].map(|along_m| beside(point, [along_m, 0.0]));
        FigureElement::line("heading", Role::Simulation, shown(unit, ends.to_vec()))
    }));
    let contact = vec![[report.contact.x_m, report.contact.y_m]];
    elements.push(FigureElement::points("first contact", Role::Target, shown(unit, contact)));
    let title = format!("{}: path up to the first contact", report.name);
    Figure::new(title, [x, y], elements).plan().with_caveats(&report.caveats.in_units(units))
}

/// A place ahead and to the left of the vehicle, m.
fn beside(point: &ReplayPoint, from_cg_m: [f64; 2]) -> [f64; 2] {
    let [dx, dy] = world_from_body(point.yaw_rad, from_cg_m);
    [point.x_m + dx, point.y_m + dy]
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use impactlab_study::{ContactPose, Library, Question, ReplayRequest};

    const TURN: &str = "Time [s],Speed [km/h],Steering Wheel Angle [deg],Yaw Rate [deg/s]\n\
        -2,50,30,-6\n-1.5,50,60,-12\n-1,48,60,-12\n-0.5,44,30,-6\n0,40,0,0\n";

    fn replayed(text: &str) -> Answer<ReplayReport> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("edr.csv");
        std::fs::write(&file, text).unwrap();
        let contact = ContactPose { x_m: 12.0, y_m: -3.0, yaw_rad: 0.4 };
        let request = ReplayRequest {
            steering_ratio: Some(15.0),
            draws: 60,
            contact,
            ..ReplayRequest::new(file)
        };
        let answer = request.answer(&Library::default(), &mut |_| ControlFlow::Continue(()));
        answer.unwrap().complete().unwrap().report
    }

    fn points<'a>(figure: &'a Figure, name: &str) -> &'a [[f64; 2]] {
        let found = figure.elements.iter().find_map(|element| match element {
            FigureElement::Points(series) | FigureElement::Line(series) if series.name == name => {
                Some(series.points.as_slice())
            }
            _ => None,
        });
        found.unwrap_or_else(|| panic!("{name}: {figure:?}"))
    }

    #[test]
    fn what_was_recorded_stands_beside_what_was_replayed_on_one_clock() {
        let report = replayed(TURN);
        let figure = replay_curve_figure(&report, ReplayCurve::Speed, UnitSystem::Si);
        assert_eq!((figure.x.unit.symbol, figure.y.unit.symbol), ("s", "km/h"));
        let recorded = points(&figure, RECORDED);
        let replayed = points(&figure, REPLAYED);
        assert_eq!((recorded.len(), recorded[0][0]), (5, -2.0));
        assert!((replayed[0][0] + 2.0).abs() < 1e-9, "{replayed:?}");
        assert!((recorded[0][1] - 50.0).abs() < 1e-9, "{recorded:?}");
        assert!(replayed.last().unwrap()[0] > 0.0, "the contact is after the last sample");
        for curve in ReplayCurve::ALL {
            let figure = replay_curve_figure(&report, curve, UnitSystem::Si);
            let FigureElement::Band(band) = &figure.elements[0] else { panic!("{figure:?}") };
            let middle = points(&figure, REPLAYED)[0][1];
            assert!(band.low[0] < middle && middle < band.high[0], "{curve:?}: {band:?}");
            assert_eq!(figure.caveats.restrictions().len(), report.caveats.restrictions().len());
        }
        let steering = replay_curve_figure(&report, ReplayCurve::Steering, UnitSystem::Si);
        assert!((points(&steering, RECORDED)[1][1] - 4.0).abs() < 1e-9, "60° over 15");
    }

    /// A record without a yaw rate has none in the figure.
    #[test]
    fn what_was_not_recorded_is_not_drawn() {
        let report = replayed(&TURN.replace("Yaw Rate [deg/s]", "Engine Throttle [%]"));
        let figure = replay_curve_figure(&report, ReplayCurve::YawRate, UnitSystem::Si);
        assert!(figure.elements.iter().all(|element| element.name() != RECORDED), "{figure:?}");
    }

    #[test]
    fn the_band_of_the_path_lies_on_both_sides_and_closes_at_the_contact() {
        let report = replayed(TURN);
        let figure = replay_path_figure(&report, UnitSystem::Si);
        let edge = |idx: usize| match &figure.elements[idx] {
            FigureElement::Line(edge) => edge.points.clone(),
            other => panic!("{other:?}"),
        };
        let last = report.path.last().unwrap();
        for edge in [edge(0), edge(1)] {
            assert_eq!(edge.len(), report.path.len());
            let end = edge.last().unwrap();
            assert!((end[0] - last.x_m).hypot(end[1] - last.y_m) < 1e-9, "{end:?} {last:?}");
        }
        let first = &report.path[0];
        let [low, high] = first.left_range_m;
        assert!(low < 0.0 && high > 0.0 && figure.equal_aspect, "{first:?}");
        let [right, left] = [edge(0)[0], edge(1)[0]];
        let width_m = (left[0] - right[0]).hypot(left[1] - right[1]);
        assert!((width_m - (high - low)).abs() < 1e-9, "{width_m}");
    }
}
