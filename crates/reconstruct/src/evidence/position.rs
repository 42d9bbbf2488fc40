//! Position of the struck car at a time, from a video.

use impactlab_core::ranges::{EVIDENCE_POSITION, EVIDENCE_TIME, POSITION_SIGMA};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::{Field, Fields, Group, Item, PlaceMut, Section, Sigma};
use crate::likelihood::{Comparison, PathResidual};

/// A position in a file, a form and a report.
pub const SECTION: Section = Section {
    key: "position",
    title: "position in a video",
    group: Group::Scene,
    is_required: false,
    missing: "has not been entered: type its time and place",
};

const TIME: Field = Field::new("time", "time", EVIDENCE_TIME).required();
const X: Field = Field::new("x", "X of the CG", EVIDENCE_POSITION).required();
const Y: Field = Field::new("y", "Y of the CG", EVIDENCE_POSITION).required().turned();
const SIGMA: Sigma = Sigma::fixed("sigma", "± along each axis", POSITION_SIGMA, 0.30, "assumed");

/// Position of the struck car at a time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct VideoPosition {
    /// Time after the first contact, s; `None` until it is entered.
    pub time_s: Option<f64>,
    /// X of the CG, m; `None` until it is entered.
    pub x_m: Option<f64>,
    /// Y of the CG, m; `None` until it is entered.
    pub y_m: Option<f64>,
    /// Standard deviation along each axis, m; `None` for that of the program.
    pub sigma_m: Option<f64>,
}

impl Item for VideoPosition {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { time_s, x_m, y_m, sigma_m } = self;
        visitor.number(&TIME, time_s);
        visitor.place([&X, &Y], &SIGMA, PlaceMut { x_m, y_m, sigma_m });
    }
}

impl VideoPosition {
    pub(super) fn compare(&self, comparison: &mut Comparison<'_>) {
        let (Some(time_s), Some(x_m), Some(y_m)) = (self.time_s, self.x_m, self.y_m) else {
            return;
        };
        let track = comparison.car.track;
        let Some((idx, at)) = track.at_time(time_s) else { return };
        let along = PathResidual {
            travelled_m: track.travelled_m[idx],
            turned_rad: track.turned_rad[idx],
            direction: [1.0, 0.0],
            lever: 0.0,
            residual: x_m - at.x_m,
            sigma: self.sigma_m.unwrap_or(SIGMA.default_at(0.0)),
        };
        let name = |axis: &str| format!("position at {time_s} s, {axis}");
        comparison.add_residual(&name("x"), along, [at.x_m, x_m]);
        let across = PathResidual { direction: [0.0, 1.0], residual: y_m - at.y_m, ..along };
        comparison.add_residual(&name("y"), across, [at.y_m, y_m]);
    }
}
