//! What stability control changes for the struck vehicle of a recorded pair: the same collision with and
//! without it, forecast with our systems beside what was recorded.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::pair::PairForecast;
use impactlab_core::compare::{PairCase, largest_yaw_change_rad};
use impactlab_core::data::SeriesError;
use impactlab_core::numerics::{is_quarter_turn, median};

/// The same of a vehicle without and with stability control.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ByControl<T> {
    /// Without it.
    pub without: T,
    /// With it.
    pub with: T,
}

/// How far the struck vehicle turns, forecast and recorded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TwinOutcome {
    /// Largest turn that was recorded, rad.
    pub recorded_turn_rad: f64,
    /// Median over the draws of the largest turn, rad.
    pub forecast_turn_rad: f64,
    /// Probability that the vehicle turns by 90° or more.
    pub quarter_turn_probability: f64,
}

/// Two recorded pairs that differ by the stability control of the struck vehicle alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EvaluatedTwins {
    /// Names of the cases.
    pub cases: ByControl<String>,
    /// What becomes of them.
    pub outcomes: ByControl<TwinOutcome>,
    /// Whether stability control saved the recorded vehicle: it turns by 90° or more without it alone.
    pub saved_recorded: bool,
    /// Whether it is likelier than not to turn by 90° or more without stability control and not so with it.
    pub saved_forecast: bool,
}

/// Twins over all.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TwinSummary {
    /// Number of twins.
    pub n: usize,
    /// Those of which it is forecast as it was recorded whether stability control saves the vehicle.
    pub n_right: usize,
    /// The same for each case.
    pub saved: SavedCounts,
    /// Vehicles that turn by 90° or more.
    pub quarter_turns: ByControl<RecordedAndForecast>,
}

/// How many twins stability control saves, by record and forecast.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SavedCounts {
    /// Recorded and forecast.
    pub both: usize,
    /// Recorded and not forecast.
    pub recorded_alone: usize,
    /// Forecast and not recorded.
    pub forecast_alone: usize,
    /// Neither recorded nor forecast.
    pub neither: usize,
}

/// A number of cases.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RecordedAndForecast {
    /// In which it was recorded.
    pub recorded: usize,
    /// In which it is likelier than not.
    pub forecast: usize,
}

impl TwinOutcome {
    /// The outcome of a case.
    ///
    /// # Errors
    /// [`SeriesError`] if the record lacks headings.
    pub fn new(case: &PairCase, forecast: &PairForecast) -> Result<Self, SeriesError> {
        let turns = forecast.draws.iter().map(|draw| draw.largest_turn_rad(0));
        Ok(Self {
            recorded_turn_rad: largest_yaw_change_rad(&case.motions[0])?,
            forecast_turn_rad: median(turns).unwrap_or(0.0),
            quarter_turn_probability: forecast
                .share(|draw| is_quarter_turn(draw.largest_turn_rad(0))),
        })
    }

    /// Whether the recorded vehicle turns by 90° or more, and whether the forecast one does likelier than
    /// not.
    pub fn quarter_turns(&self) -> [bool; 2] {
        [is_quarter_turn(self.recorded_turn_rad), self.quarter_turn_probability > 0.5]
    }
}

impl EvaluatedTwins {
    /// Twins from what becomes of them.
    pub fn new(cases: ByControl<String>, outcomes: ByControl<TwinOutcome>) -> Self {
        let ByControl { without, with } = outcomes;
        let ([recorded_without, forecast_without], [recorded_with, forecast_with]) =
            (without.quarter_turns(), with.quarter_turns());
        Self {
            cases,
            outcomes,
            saved_recorded: recorded_without && !recorded_with,
            saved_forecast: forecast_without && !forecast_with,
        }
    }

    /// Whether it is forecast as it was recorded if stability control saves the vehicle.
    pub fn is_right(&self) -> bool {
        self.saved_recorded == self.saved_forecast
    }
}

impl TwinSummary {
    /// Over twins; `None` without any.
    pub fn from_twins(twins: &[EvaluatedTwins]) -> Option<Self> {
        if twins.is_empty() {
            return None;
        }
        let count = |holds: &dyn Fn(&EvaluatedTwins) -> bool| {
            twins.iter().filter(|twins| holds(twins)).count()
        };
        let saved = |recorded: bool, forecast: bool| {
            count(&|twins| [twins.saved_recorded, twins.saved_forecast] == [recorded, forecast])
        };
        let turns = |outcome: fn(&EvaluatedTwins) -> TwinOutcome| RecordedAndForecast {
            recorded: count(&|twins| outcome(twins).quarter_turns()[0]),
            forecast: count(&|twins| outcome(twins).quarter_turns()[1]),
        };
        Some(Self {
            n: twins.len(),
            n_right: count(&EvaluatedTwins::is_right),
            saved: SavedCounts {
                both: saved(true, true),
                recorded_alone: saved(true, false),
                forecast_alone: saved(false, true),
                neither: saved(false, false),
            },
            quarter_turns: ByControl {
                without: turns(|twins| twins.outcomes.without),
                with: turns(|twins| twins.outcomes.with),
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn twins(name: &str, recorded_deg: [f64; 2], probability: [f64; 2]) -> EvaluatedTwins {
        let outcome = |i: usize| TwinOutcome {
            recorded_turn_rad: recorded_deg[i].to_radians(),
            forecast_turn_rad: 1.0,
            quarter_turn_probability: probability[i],
        };
        let cases = ByControl { without: name.to_owned(), with: format!("{name}e") };
        EvaluatedTwins::new(cases, ByControl { without: outcome(0), with: outcome(1) })
    }

    #[test]
    fn a_vehicle_is_saved_that_turns_without_stability_control_alone() {
        let all = [
            twins("saved", [170.0, 20.0], [0.9, 0.2]),
            twins("missed", [170.0, 20.0], [0.9, 0.6]),
            twins("not_saved", [170.0, 120.0], [0.9, 0.1]),
            twins("never_turned", [30.0, 20.0], [0.5, 0.0]),
            twins("made_worse", [30.0, 95.0], [0.2, 0.8]),
        ];
        let right: Vec<bool> = all.iter().map(EvaluatedTwins::is_right).collect();
        assert_eq!(right, [true, false, false, true, true]);
        let summary = TwinSummary::from_twins(&all).unwrap();
        assert_eq!((summary.n, summary.n_right), (5, 3));
        let saved = SavedCounts { both: 1, recorded_alone: 1, forecast_alone: 1, neither: 2 };
        assert_eq!(summary.saved, saved);
        let ByControl { without, with } = summary.quarter_turns;
        assert_eq!(without, RecordedAndForecast { recorded: 3, forecast: 3 });
        assert_eq!(with, RecordedAndForecast { recorded: 2, forecast: 2 });
        assert_eq!(TwinSummary::from_twins(&[]), None);
    }
}
