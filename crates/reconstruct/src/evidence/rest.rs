//! Where a car came to rest.

use std::f64::consts::TAU;

use impactlab_core::collision::Pose;
use impactlab_core::numerics::wrap_angle_rad;
use impactlab_core::ranges::{ANGLE_SIGMA, EVIDENCE_HEADING, EVIDENCE_POSITION, POSITION_SIGMA};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::{
    Choice, Field, Fields, Group, Item, Measured, PlaceMut, Section, Sigma, Stated, Word,
};
use crate::likelihood::{Comparison, PathResidual};

/// Points of an ellipse.
const N_ELLIPSE: usize = 48;
/// Half axis of an ellipse that holds 90 % of a plane normal distribution, standard deviations.
const NINETY: f64 = 2.1460;

/// The struck car at rest in a file, a form and a report.
pub const STRUCK: Section = Section {
    key: "rest",
    title: "struck car at rest",
    group: Group::Scene,
    is_required: false,
    missing: "has not been placed: drag its dot in the scene or type X and Y; remove the card if \
              its place is not known",
};
/// The striking car at rest, likewise.
pub const STRIKING: Section =
    Section { key: "striking_rest", title: "striking car at rest", ..STRUCK };
/// A single car at rest, likewise.
pub const SINGLE: Section = Section { title: "car at rest", ..STRUCK };

const X: Field = Field::new("x", "X of the CG", EVIDENCE_POSITION).required();
const Y: Field = Field::new("y", "Y of the CG", EVIDENCE_POSITION).required().turned();
const SIGMA: Sigma = Sigma::fixed(
    "position_sigma",
    "± along each axis",
    POSITION_SIGMA,
    0.15,
    // A total station or GNSS rover is far better. `Brach2011`, uncertainty of measurements at the scene.
    "a tape, or a pace from a photograph",
);
const HEADING: Field = Field::new("heading", "heading", EVIDENCE_HEADING).turned();
const HEADING_SIGMA: Sigma = Sigma::fixed(
    "heading_sigma",
    "±",
    ANGLE_SIGMA,
    0.035,
    "2 deg, read off a sketch to scale or a photograph from above; assumed",
);
const STOPPED_BY: Choice =
    Choice { key: "stopped_by", label: "stopped by", is_required: false, none: "the road alone" };

/// What stopped a car beside the road.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum StoppedBy {
    /// Something that it struck on its way, such as a pole, a kerb or a third car.
    Obstacle,
}

impl Word for StoppedBy {
    const ALL: &'static [Self] = &[Self::Obstacle];

    fn word(self) -> &'static str {
        self.into()
    }

    fn label(self) -> &'static str {
        match self {
            Self::Obstacle => "a further obstacle",
        }
    }
}

/// Where a car came to rest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RestPose {
    /// X of the CG, m; `None` until it is entered.
    pub x_m: Option<f64>,
    /// Y of the CG, m; `None` until it is entered.
    pub y_m: Option<f64>,
    /// Standard deviation along each axis, m; `None` for that of the program.
    pub position_sigma_m: Option<f64>,
    /// Heading, rad; whole turns do not count.
    pub heading_rad: Option<Stated>,
    /// What stopped it beside the road: the speed does not follow from such a place; `None` if it rolled or slid freely.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped_by: Option<StoppedBy>,
}

impl Item for RestPose {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { x_m, y_m, position_sigma_m: sigma_m, heading_rad, stopped_by } = self;
        visitor.place([&X, &Y], &SIGMA, PlaceMut { x_m, y_m, sigma_m });
        visitor.measured(&HEADING, &HEADING_SIGMA, heading_rad);
        visitor.optional_choice(&STOPPED_BY, stopped_by);
    }
}

impl RestPose {
    /// Place of the CG, m; `None` until it is entered.
    pub fn place_m(&self) -> Option<[f64; 2]> {
        Some([self.x_m?, self.y_m?])
    }

    /// Whether the car rolled or slid there freely, so that its speed follows from the place.
    pub fn is_free(&self) -> bool {
        self.stopped_by.is_none()
    }

    /// Standard deviation of the place along each axis, m.
    pub fn position_sigma_m(&self) -> f64 {
        self.position_sigma_m.unwrap_or(SIGMA.default_at(0.0))
    }

    /// Heading, rad.
    pub fn heading(&self) -> Option<Measured> {
        HEADING_SIGMA.resolve(self.heading_rad)
    }

    /// Its pose, where place and heading are known.
    pub fn pose(&self) -> Option<Pose> {
        let [x_m, y_m] = self.place_m()?;
        Some(Pose { x_m, y_m, yaw_rad: self.heading()?.value })
    }

    /// The ellipse in which the CG lies with 90 %, m; without points until the place is entered.
    pub fn ellipse_90_m(&self) -> Vec<[f64; 2]> {
        let Some([x_m, y_m]) = self.place_m() else { return Vec::new() };
        let point = |i| {
            let (sin, cos) = (TAU * i as f64 / N_ELLIPSE as f64).sin_cos();
            let radius_m = NINETY * self.position_sigma_m();
            [x_m + radius_m * cos, y_m + radius_m * sin]
        };
        (0..=N_ELLIPSE).map(point).collect()
    }

    /// Says nothing of a car that something else stopped.
    pub(super) fn compare(&self, comparison: &mut Comparison<'_>) {
        if self.is_free() {
            comparison.part("rest pose", |comparison| self.add_to(comparison));
        }
    }

    fn add_to(&self, comparison: &mut Comparison<'_>) {
        let Some([found_x_m, found_y_m]) = self.place_m() else { return };
        let track = comparison.car.track;
        let [x_m, y_m, yaw_rad] = track.rest();
        let at = PathResidual {
            travelled_m: track.whole_m(),
            turned_rad: track.turned_rad.last().copied().unwrap_or(0.0),
            direction: [1.0, 0.0],
            lever: 0.0,
            residual: found_x_m - x_m,
            sigma: self.position_sigma_m(),
        };
        comparison.add_residual("rest x", at, [x_m, found_x_m]);
        let across = PathResidual { direction: [0.0, 1.0], residual: found_y_m - y_m, ..at };
        comparison.add_residual("rest y", across, [y_m, found_y_m]);
        if let Some(Measured { value, sigma }) = self.heading() {
            let residual = wrap_angle_rad(value - yaw_rad);
            let turned = PathResidual { direction: [0.0; 2], lever: 1.0, residual, sigma, ..at };
            comparison.add_residual("rest heading", turned, [value - residual, value]);
        }
    }
}
