//! Record of an event data recorder in one of the cars.

use impactlab_core::data::{RecordedControls, RecordedDeltaV, RecorderRecord};
use impactlab_core::ranges::{CONTACT_X, CONTACT_Y, EVIDENCE_SPEED, PULSE_END, SPEED, SPEED_SIGMA};
use impactlab_core::units::KILOMETRE_PER_HOUR_M_S;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Latent;
use crate::evidence::{Bounds, Field, Fields, Group, Item, Measured, Section, Sigma, Stated, ends};
use crate::likelihood::{Comparison, SINGLE_DEGREES_OF_FREEDOM, student};

/// Standard deviation of a recorded speed that nobody states, as a share of it.
pub const RECORDED_SPEED_SHARE: f64 = 0.04;

/// Share of a recorded change of velocity by which it may be wrong (49 CFR 563.8, UN R160).
const DELTA_V_SHARE: f64 = 0.1;

/// Half of the step in which it is recorded, m/s: 1 km/h (49 CFR 563.8).
const DELTA_V_ROUNDING_M_S: f64 = 0.5 * KILOMETRE_PER_HOUR_M_S;

/// Standard deviation of a change of velocity that is small, m/s: the rounding of the record.
const LEAST_DELTA_V_SIGMA_M_S: f64 = 0.03;

/// Least deceleration that a driver is taken to be able to have between the speed that was recorded last and the
/// crash, m/s²: a rule of ours.
const UNSEEN_DECELERATION_M_S2: f64 = 2.0;

/// The recorder of the struck car in a file, a form and a report.
pub const STRUCK: Section = Section {
    key: "edr",
    title: "event data recorder",
    group: Group::Scene,
    is_required: false,
    missing: "",
};
/// That of the striking car, likewise.
pub const STRIKING: Section =
    Section { key: "striking_edr", title: "event data recorder of the striking car", ..STRUCK };

const SPEED_BEFORE: Field = Field::new("speed_before", "speed before the impact", EVIDENCE_SPEED);
const SPEED_BEFORE_SIGMA: Sigma = Sigma::share(
    "speed_before_sigma",
    "±",
    SPEED_SIGMA,
    [RECORDED_SPEED_SHARE, 0.3],
    "4 %, as stated for early recorders (49 CFR 563 asks for 1 km/h), and at least the rounding of the record",
);
const DELTA_V_X: Field = Field::new("delta_v_x", "Δv ahead", SPEED);
const DELTA_V_Y: Field = Field::new("delta_v_y", "Δv to the left", SPEED).turned();
const SENSOR_X: Field =
    Field::new("sensor_x", "sensor ahead of the CG", CONTACT_X).with_default("at the CG");
const SENSOR_Y: Field = Field::new("sensor_y", "sensor to the left of the CG", CONTACT_Y)
    .turned()
    .with_default("at the CG");
const ENDS: Field =
    Field::new("ends", "end of the record", PULSE_END).with_default("end of contact");

/// Record of an event data recorder in one of the cars.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Edr {
    /// Bounds of the change of velocity along the x axis of the car, m/s.
    pub delta_v_x_m_s: Option<Bounds>,
    /// Bounds of the change of velocity along the y axis of the car, m/s.
    pub delta_v_y_m_s: Option<Bounds>,
    /// Speed before the impact, m/s.
    pub speed_before_m_s: Option<Stated>,
    /// Place of the sensor from the CG, x forward and y left, m; at the CG where nobody states it.
    pub sensor_m: [Option<f64>; 2],
    /// When the record of the change of velocity ends, s after the first contact; the end of the
    /// contact if `None`.
    pub ends_s: Option<f64>,
}

impl Item for Edr {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { delta_v_x_m_s, delta_v_y_m_s, speed_before_m_s, sensor_m, ends_s } = self;
        let [sensor_x_m, sensor_y_m] = sensor_m;
        visitor.measured(&SPEED_BEFORE, &SPEED_BEFORE_SIGMA, speed_before_m_s);
        visitor.bounds(&DELTA_V_X, delta_v_x_m_s);
        visitor.bounds(&DELTA_V_Y, delta_v_y_m_s);
        visitor.number(&SENSOR_X, sensor_x_m);
        visitor.number(&SENSOR_Y, sensor_y_m);
        visitor.number(&ENDS, ends_s);
    }

    /// A sensor without a record says nothing.
    fn is_empty(&self) -> bool {
        self.delta_v_x_m_s.is_none()
            && self.delta_v_y_m_s.is_none()
            && self.speed_before_m_s.is_none()
    }
}

impl Edr {
    /// What a recorder has kept, as evidence: a change of velocity within 10 % and at least its rounding, the last
    /// speed before the crash with the standard deviation of the program, and the end of the record of the change
    /// of velocity. A speed that was recorded earlier than the crash has a larger standard deviation: what its last
    /// change, or at least 2 m/s², makes of the time in between. Where the sensor is, no record says.
    pub fn from_record(record: &RecorderRecord) -> Self {
        let bounds = |recorded: RecordedDeltaV, sign: f64| {
            let value = sign * recorded.delta_v_m_s;
            let half = (DELTA_V_SHARE * value.abs()).max(DELTA_V_ROUNDING_M_S);
            [Some(value - half), Some(value + half)]
        };
        // What ends earlier than the other no longer changed there.
        let both = [record.delta_v_ahead, record.delta_v_right].into_iter().flatten();
        let ends: Option<Vec<f64>> = both.map(|of| of.ends_s).collect();
        let ends_s = ends.and_then(|ends| ends.into_iter().reduce(f64::max));
        let speed = record.speed_before.map(|speed| speed.speed_m_s);
        let change_m_s = change_until_crash_m_s(record);
        let stated = |speed: f64| {
            let value = Some(speed);
            let of_record = SPEED_BEFORE_SIGMA.resolve(Some(Stated { value, sigma: None }));
            let wider = of_record.map(|of| of.sigma.hypot(change_m_s).min(SPEED_SIGMA.high));
            Stated { value, sigma: wider.filter(|_| change_m_s > 0.0) }
        };
        Self {
            delta_v_x_m_s: record.delta_v_ahead.map(|recorded| bounds(recorded, 1.0)),
            delta_v_y_m_s: record.delta_v_right.map(|recorded| bounds(recorded, -1.0)),
            speed_before_m_s: speed.filter(|speed| EVIDENCE_SPEED.contains(*speed)).map(stated),
            sensor_m: [None; 2],
            ends_s: ends_s.filter(|ends_s| PULSE_END.contains(*ends_s)),
        }
    }

    /// Speed before the impact, m/s.
    pub fn speed_before(&self) -> Option<Measured> {
        SPEED_BEFORE_SIGMA.resolve(self.speed_before_m_s)
    }

    /// Bounds of the change of velocity along the x axis of the car, m/s.
    pub fn delta_v_x(&self) -> Option<[f64; 2]> {
        ends(self.delta_v_x_m_s)
    }

    /// Bounds of the change of velocity along the y axis of the car, m/s.
    pub fn delta_v_y(&self) -> Option<[f64; 2]> {
        ends(self.delta_v_y_m_s)
    }

    pub(super) fn compare(&self, comparison: &mut Comparison<'_>) {
        if let Some(Measured { value, sigma }) = self.speed_before() {
            let name = "EDR speed before the impact";
            comparison.part(name, |comparison| {
                let expected = comparison.car.speed_before_m_s;
                let distance = ((value - expected) / sigma).powi(2);
                comparison.log_likelihood -= distance / 2.0;
                comparison.tell(name, "m/s", [expected, value], distance);
            });
        }
        if self.delta_v_x().is_some() || self.delta_v_y().is_some() {
            comparison.part("EDR delta-v", |comparison| self.add_delta_v(comparison));
        }
    }

    fn add_delta_v(&self, comparison: &mut Comparison<'_>) {
        let end_s = self.ends_s.unwrap_or(comparison.value(Latent::PulseDuration));
        let sensor_m = self.sensor_m.map(Option::unwrap_or_default);
        let Some(recorded) = comparison.car.track.recorded_delta_v_m_s(sensor_m, end_s) else {
            return;
        };
        let size = recorded[0].hypot(recorded[1]);
        let sigma = comparison.discrepancy.delta_v_share * size + LEAST_DELTA_V_SIGMA_M_S;
        for (name, bounds, expected) in [
            ("EDR delta-v along x, middle of its bounds", self.delta_v_x(), recorded[0]),
            ("EDR delta-v along y, middle of its bounds", self.delta_v_y(), recorded[1]),
        ] {
            let Some([low, high]) = bounds else { continue };
            let beyond = (low - expected).max(expected - high).max(0.0) / sigma;
            let distance = beyond * beyond;
            comparison.log_likelihood += student(distance, 1.0, SINGLE_DEGREES_OF_FREEDOM);
            comparison.tell(name, "m/s", [expected, (low + high) / 2.0], distance);
        }
    }
}

/// By how much the speed may have changed from when it was recorded last to the crash, m/s.
fn change_until_crash_m_s(record: &RecorderRecord) -> f64 {
    let Some(last) = record.speed_before else { return 0.0 };
    let RecordedControls { time_s, speed_m_s, .. } = &record.before;
    let rate = match (time_s.as_slice(), speed_m_s.as_slice()) {
        ([.., t0, t1], [.., v0, v1]) if t1 > t0 => ((v1 - v0) / (t1 - t0)).abs(),
        _ => 0.0,
    };
    rate.max(UNSEEN_DECELERATION_M_S2) * (0.0 - last.at_s).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::data::RecordedSpeed;

    #[test]
    fn a_record_becomes_evidence_with_its_bounds() {
        let recorded =
            |delta_v_m_s| RecordedDeltaV { delta_v_m_s, ends_s: Some(0.12), is_cut: false };
        let record = RecorderRecord {
            delta_v_ahead: Some(recorded(-10.0)),
            delta_v_right: Some(recorded(2.0)),
            speed_before: Some(RecordedSpeed { speed_m_s: 20.0, at_s: -0.5 }),
            ..RecorderRecord::default()
        };
        let edr = Edr::from_record(&record);
        assert_eq!(edr.delta_v_x(), Some([-11.0, -9.0]));
        // To the right is to the other side of y.
        assert_eq!(edr.delta_v_y(), Some([-2.2, -1.8]));
        // A change of nothing is one of less than the rounding.
        let none = RecorderRecord { delta_v_right: Some(recorded(0.0)), ..record.clone() };
        assert_eq!(Edr::from_record(&none).delta_v_y(), Some([-0.5 / 3.6, 0.5 / 3.6]));
        let speed = edr.speed_before().unwrap();
        // Half a second before the crash, over which 2 m/s² may have been missed.
        assert!((speed.value, speed.sigma) == (20.0, 0.8_f64.hypot(1.0)), "{speed:?}");
        assert_eq!((edr.ends_s, edr.sensor_m), (Some(0.12), [None; 2]));
        let before = RecordedControls {
            time_s: vec![-1.0, -0.5],
            speed_m_s: vec![24.0, 20.0],
            ..RecordedControls::default()
        };
        let braking = Edr::from_record(&RecorderRecord { before, ..record.clone() });
        let sigma_m_s = braking.speed_before().unwrap().sigma;
        assert!((sigma_m_s - 0.8_f64.hypot(4.0)).abs() < 1e-12, "{sigma_m_s}");
        let at_crash = Some(RecordedSpeed { speed_m_s: 20.0, at_s: 0.0 });
        let at_crash = RecorderRecord { speed_before: at_crash, ..record.clone() };
        let sigma_m_s = Edr::from_record(&at_crash).speed_before().unwrap().sigma;
        assert!((sigma_m_s - 0.8).abs() < 1e-12, "{sigma_m_s}");
        // The component that is over earlier holds at the end of the other one.
        let later = RecordedDeltaV { ends_s: Some(0.2), ..recorded(2.0) };
        let later = RecorderRecord { delta_v_right: Some(later), ..record };
        assert_eq!(Edr::from_record(&later).ends_s, Some(0.2));
        assert!(Edr::from_record(&RecorderRecord::default()).is_empty());
    }
}
