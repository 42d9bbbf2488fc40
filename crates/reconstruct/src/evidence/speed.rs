//! Speed of a single car at a time, from a recorder, a tachograph or a video.

use impactlab_core::ranges::{EVIDENCE_SPEED, EVIDENCE_TIME, SPEED_SIGMA};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::recorder::RECORDED_SPEED_SHARE;
use crate::evidence::{Field, Fields, Group, Item, Measured, Section, Sigma, Stated};
use crate::likelihood::Comparison;

/// A speed in a file, a form and a report.
pub const SECTION: Section = Section {
    key: "recorded_speed",
    title: "recorded speed",
    group: Group::Scene,
    is_required: false,
    missing: "",
};

const TIME: Field =
    Field::new("time", "time after the start", EVIDENCE_TIME).with_default("at the start");
const SPEED: Field = Field::new("speed", "speed", EVIDENCE_SPEED).required();
const SIGMA: Sigma = Sigma::share(
    "speed_sigma",
    "±",
    SPEED_SIGMA,
    [RECORDED_SPEED_SHARE, 0.3],
    "4 %, as stated for early recorders, and at least the rounding of the record",
);

/// Speed of a single car at a time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RecordedSpeed {
    /// Time after the start, s; at the start if `None`.
    pub time_s: Option<f64>,
    /// Speed of the CG, m/s; `None` until it is entered.
    pub speed_m_s: Option<Stated>,
}

impl Item for RecordedSpeed {
    /// Speeds of one device have one error.
    const COUNTS_ONCE: bool = true;

    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { time_s, speed_m_s } = self;
        visitor.number(&TIME, time_s);
        visitor.measured(&SPEED, &SIGMA, speed_m_s);
    }
}

impl RecordedSpeed {
    /// Speed, m/s; `None` until it is entered.
    pub fn speed(&self) -> Option<Measured> {
        SIGMA.resolve(self.speed_m_s)
    }

    /// - `n_speeds`: number of speeds, which one device records with one error: all together count as one.
    pub(super) fn compare(&self, n_speeds: usize, comparison: &mut Comparison<'_>) {
        let Some(Measured { value, sigma }) = self.speed() else { return };
        let time_s = self.time_s.unwrap_or(0.0);
        let Some((_, at)) = comparison.car.track.at_time(time_s) else { return };
        let expected = at.vx_body_m_s.hypot(at.vy_body_m_s);
        let name = format!("recorded speed at {time_s} s");
        comparison.part(&name, |comparison| {
            let distance = ((value - expected) / sigma).powi(2);
            comparison.log_likelihood -= distance / 2.0 / n_speeds as f64;
            comparison.tell(&name, "m/s", [expected, value], distance);
        });
    }
}
