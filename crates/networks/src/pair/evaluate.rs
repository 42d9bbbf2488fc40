//! How far the forecast of two vehicles lies from a recorded pair.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::pair::{CourseShare, PairDraw, PairForecast};
use impactlab_core::compare::PairCase;
use impactlab_core::data::{Channel, SeriesError, TimeSeries};
use impactlab_core::numerics::{
    Summary, interpolate, is_half_turn, is_quarter_turn, median, wrap_angle_rad,
};
use impactlab_core::vehicle::OUTPUT_INTERVAL_S;

/// Time after the first contact over which paths are compared, s.
const COMPARED_S: f64 = 4.0;

/// Interval at which it is asked whether a region holds the recorded position, s.
const COVERAGE_INTERVAL_S: f64 = 0.1;

/// The forecast of a recorded pair beside the record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EvaluatedPair {
    /// Name of the case.
    pub case: String,
    /// Kind of the collision; empty if the data do not say it.
    pub kind: String,
    /// Whether the struck car has electronic stability control.
    pub has_stability_control: bool,
    /// The struck vehicle.
    pub struck: VehicleScore,
    /// The striking vehicle.
    pub striking: VehicleScore,
    /// What becomes of the struck vehicle, the likeliest first.
    pub courses: Vec<CourseShare>,
    /// Time for which the vehicles are in contact, s.
    pub contact_s: Compared,
    /// Impulse on the struck vehicle over all contacts, N s.
    pub impulse_n_s: Compared,
    /// Draws that could be computed.
    pub n_draws: usize,
}

/// A number of the forecast and of the record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Compared {
    /// Median over the draws, or of the motion with everything at its median.
    pub forecast: f64,
    /// Recorded; `null` if the data do not have it.
    pub recorded: Option<f64>,
}

/// A vehicle of a forecast beside its record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VehicleScore {
    /// Mean distance of the positions over 4 s from the first contact, m, of the motion with everything at
    /// its median.
    pub average_error_m: f64,
    /// Distance of the positions at the end of the record, m, likewise.
    pub end_error_m: f64,
    /// Difference of the headings at the end of the record, wrapped, rad, likewise.
    pub end_heading_error_rad: f64,
    /// Probability that the vehicle turns by 90° or more.
    pub quarter_turn_probability: f64,
    /// Whether the recorded vehicle did.
    pub quarter_turn_recorded: bool,
    /// Probability that the vehicle turns by more than 180°.
    pub half_turn_probability: f64,
    /// Whether the recorded vehicle did.
    pub half_turn_recorded: bool,
    /// Share of the instants over 4 s at which the region of 50 % holds the recorded position.
    pub path_50: f64,
    /// The same of the region of 90 %.
    pub path_90: f64,
    /// Whether the region of 50 % holds the recorded position at the end of the record.
    pub end_50: bool,
    /// The same of the region of 90 %.
    pub end_90: bool,
}

/// Forecasts of several recorded pairs, of one of the two vehicles.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct VehicleSummary {
    /// Mean distance of the positions over 4 s from the first contact, m.
    pub average_error_m: Summary,
    /// Distance of the positions at the end of the record, m.
    pub end_error_m: Summary,
    /// Share of the cases in which the likelier side of 90° was the recorded one.
    pub quarter_turn_right: f64,
    /// The same of 180°.
    pub half_turn_right: f64,
    /// Share of the instants at which a region held the recorded position, by its level in percent.
    pub coverage: Coverage,
    /// Share of the cases in which it did at the end of the record.
    pub end_coverage: Coverage,
}

/// How often regions held the recorded position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Coverage {
    /// Those of 50 %.
    #[serde(rename = "50")]
    pub of_50: f64,
    /// Those of 90 %.
    #[serde(rename = "90")]
    pub of_90: f64,
}

/// Forecasts of several recorded pairs.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PairSummary {
    /// Number of cases.
    pub n: usize,
    /// The struck vehicle.
    pub struck: VehicleSummary,
    /// The striking vehicle.
    pub striking: VehicleSummary,
    /// Median over the cases of the forecast duration of contact over the recorded one.
    pub contact_ratio: Option<f64>,
    /// Median over the cases of the forecast impulse over the recorded one.
    pub impulse_ratio: Option<f64>,
}

/// Compares a forecast with a recorded pair.
///
/// # Errors
/// [`SeriesError`] if the record lacks positions or headings.
pub fn evaluate_pair(
    case: &PairCase,
    forecast: &PairForecast,
) -> Result<EvaluatedPair, SeriesError> {
    let centre = PairDraw::from_motion(0, forecast.centre.clone());
    let first_s = case.contact.first_s.unwrap_or(0.0);
    let score = |vehicle: usize| -> Result<VehicleScore, SeriesError> {
        let record = Record::new(&case.motions[vehicle])?;
        Ok(vehicle_score(&record, vehicle, first_s, (forecast, &centre)))
    };
    let end_s = case.motions[0].time_s().last().copied().unwrap_or(0.0);
    let median =
        |value: &dyn Fn(&PairDraw) -> f64| median(forecast.draws.iter().map(value)).unwrap_or(0.0);
    Ok(EvaluatedPair {
        case: case.name.clone(),
        kind: case.attributes.kind.clone(),
        has_stability_control: case.attributes.has_stability_control,
        struck: score(0)?,
        striking: score(1)?,
        courses: forecast.courses(),
        contact_s: Compared {
            forecast: median(&|draw| draw.contact_s(end_s)),
            recorded: case.contact_s(),
        },
        impulse_n_s: Compared {
            forecast: median(&|draw| draw.impulse_n_s()),
            recorded: case.impulse_n_s(),
        },
        n_draws: forecast.draws.len(),
    })
}

/// The recorded motion of a vehicle.
struct Record<'a> {
    time_s: &'a [f64],
    x_m: &'a [f64],
    y_m: &'a [f64],
    yaw_rad: &'a [f64],
}

impl<'a> Record<'a> {
    fn new(series: &'a TimeSeries) -> Result<Self, SeriesError> {
        Ok(Self {
            time_s: series.time_s(),
            x_m: series.require(Channel::X)?,
            y_m: series.require(Channel::Y)?,
            yaw_rad: series.require(Channel::Yaw)?,
        })
    }

    fn end_s(&self) -> f64 {
        self.time_s.last().copied().unwrap_or(0.0)
    }

    /// X, Y, m, and heading, rad.
    fn at(&self, time_s: f64) -> [f64; 3] {
        [self.x_m, self.y_m, self.yaw_rad]
            .map(|values| interpolate(self.time_s, values, time_s).unwrap_or(f64::NAN))
    }

    fn largest_turn_rad(&self) -> f64 {
        let first = self.yaw_rad.first().copied().unwrap_or(0.0);
        self.yaw_rad.iter().map(|yaw| (yaw - first).abs()).fold(0.0, f64::max)
    }
}

fn vehicle_score(
    record: &Record<'_>,
    vehicle: usize,
    first_s: f64,
    (forecast, centre): (&PairForecast, &PairDraw),
) -> VehicleScore {
    let end_s = record.end_s();
    let last_s = (first_s + COMPARED_S).min(end_s);
    let instant = |time_s: f64| (time_s / OUTPUT_INTERVAL_S).round() as usize;
    let times = |interval_s: f64| {
        let n = ((last_s - first_s) / interval_s + 1e-9).floor().max(0.0) as usize;
        (0..=n).map(move |i| first_s + i as f64 * interval_s)
    };
    let off = |time_s: f64| {
        let [x, y, _] = record.at(time_s);
        let state = centre.state(vehicle, instant(time_s));
        state.map_or(f64::NAN, |state| (state.x_m - x).hypot(state.y_m - y))
    };
    let distances: Vec<f64> = times(OUTPUT_INTERVAL_S).map(off).collect();
    let level = |time_s: f64| {
        let [x, y, _] = record.at(time_s);
        forecast.position(vehicle, instant(time_s)).level_of([x, y])
    };
    // At the first contact everything is known.
    let levels: Vec<f64> = times(COVERAGE_INTERVAL_S).skip(1).map(level).collect();
    let within = |limit: f64| {
        let n = levels.iter().filter(|level| **level <= limit).count();
        n as f64 / levels.len().max(1) as f64
    };
    let end_level = level(end_s);
    let end = centre.state(vehicle, instant(end_s));
    let turn_rad = record.largest_turn_rad();
    let turns =
        |counts: fn(f64) -> bool| forecast.share(|draw| counts(draw.largest_turn_rad(vehicle)));
    VehicleScore {
        average_error_m: distances.iter().sum::<f64>() / distances.len().max(1) as f64,
        end_error_m: off(end_s),
        end_heading_error_rad: end
            .map_or(f64::NAN, |state| wrap_angle_rad(state.yaw_rad - record.at(end_s)[2])),
        quarter_turn_probability: turns(is_quarter_turn),
        quarter_turn_recorded: is_quarter_turn(turn_rad),
        half_turn_probability: turns(is_half_turn),
        half_turn_recorded: is_half_turn(turn_rad),
        path_50: within(0.5),
        path_90: within(0.9),
        end_50: end_level <= 0.5,
        end_90: end_level <= 0.9,
    }
}

impl Compared {
    /// Median over several of the forecast over the recorded number; `None` without a recorded one.
    pub fn median_ratio(all: impl IntoIterator<Item = Self>) -> Option<f64> {
        median(all.into_iter().filter_map(Self::ratio))
    }

    /// Median over several of the size of the relative error of the forecast; `None` without a recorded
    /// number.
    pub fn median_error(all: impl IntoIterator<Item = Self>) -> Option<f64> {
        let errors = all.into_iter().filter_map(Self::ratio).map(|ratio| (ratio - 1.0).abs());
        median(errors)
    }

    /// The forecast over the recorded number.
    fn ratio(self) -> Option<f64> {
        let recorded = self.recorded.filter(|recorded| *recorded > 0.0);
        recorded.map(|recorded| self.forecast / recorded)
    }
}

impl VehicleScore {
    /// Whether the likelier side of 90° was the recorded one.
    pub fn quarter_turn_right(&self) -> bool {
        (self.quarter_turn_probability > 0.5) == self.quarter_turn_recorded
    }

    /// Whether the likelier side of 180° was the recorded one.
    pub fn half_turn_right(&self) -> bool {
        (self.half_turn_probability > 0.5) == self.half_turn_recorded
    }
}

impl VehicleSummary {
    fn new(scores: &[VehicleScore]) -> Option<Self> {
        let share = |holds: fn(&VehicleScore) -> f64| {
            scores.iter().map(holds).sum::<f64>() / scores.len().max(1) as f64
        };
        let values =
            |value: fn(&VehicleScore) -> f64| -> Vec<f64> { scores.iter().map(value).collect() };
        Some(Self {
            average_error_m: Summary::from_values(values(|score| score.average_error_m))?,
            end_error_m: Summary::from_values(values(|score| score.end_error_m))?,
            quarter_turn_right: share(|score| f64::from(u8::from(score.quarter_turn_right()))),
            half_turn_right: share(|score| f64::from(u8::from(score.half_turn_right()))),
            coverage: Coverage {
                of_50: share(|score| score.path_50),
                of_90: share(|score| score.path_90),
            },
            end_coverage: Coverage {
                of_50: share(|score| f64::from(u8::from(score.end_50))),
                of_90: share(|score| f64::from(u8::from(score.end_90))),
            },
        })
    }
}

impl PairSummary {
    /// Over cases; `None` without any.
    pub fn from_cases<'a>(cases: impl IntoIterator<Item = &'a EvaluatedPair>) -> Option<Self> {
        let cases: Vec<&EvaluatedPair> = cases.into_iter().collect();
        let of_vehicle = |score: fn(&EvaluatedPair) -> VehicleScore| -> Vec<VehicleScore> {
            cases.iter().map(|case| score(case)).collect()
        };
        let ratio = |compared: fn(&EvaluatedPair) -> Compared| {
            Compared::median_ratio(cases.iter().map(|case| compared(case)))
        };
        Some(Self {
            n: cases.len(),
            struck: VehicleSummary::new(&of_vehicle(|case| case.struck))?,
            striking: VehicleSummary::new(&of_vehicle(|case| case.striking))?,
            contact_ratio: ratio(|case| case.contact_s),
            impulse_ratio: ratio(|case| case.impulse_n_s),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two records the larger ratio was the median, so that errors to both sides read as one.
    #[test]
    fn of_two_records_the_median_lies_between() {
        let all = [(40.0, 50.0), (60.0, 50.0)]
            .map(|(forecast, recorded)| Compared { forecast, recorded: Some(recorded) });
        let unknown = Compared { forecast: 9.0, recorded: None };
        let ratio = Compared::median_ratio(all.into_iter().chain([unknown]));
        assert!(ratio.is_some_and(|ratio| (ratio - 1.0).abs() < 1e-12), "{ratio:?}");
        assert_eq!(Compared::median_error([unknown]), None);
    }
}
