//! Where a single car was when it is first known of, and ranges of how it moved there. Place and heading are
//! measured by themselves, so that they are parts of the prior.

use impactlab_core::ranges::{
    ANGLE_SIGMA, BRAKE_SHARE, BRAKED_BEFORE, BRAKED_SHARE, CONTROL_TIME, EVIDENCE_HEADING,
    EVIDENCE_POSITION, EVIDENCE_SPEED, POSITION_SIGMA, STEER_ANGLE, YAW_RATE,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::{
    Bounds, Field, Fields, Group, Item, Measured, PlaceMut, Section, Sigma, Stated,
};

/// The start in a file, a form and a report.
pub const SECTION: Section = Section {
    key: "start",
    title: "car at the start",
    group: Group::Scene,
    is_required: false,
    missing: "",
};

const X: Field = Field::new("x", "X of the CG", EVIDENCE_POSITION);
const Y: Field = Field::new("y", "Y of the CG", EVIDENCE_POSITION).turned();
const SIGMA: Sigma = Sigma::fixed(
    "position_sigma",
    "± along each axis",
    POSITION_SIGMA,
    0.3,
    "the start of a mark is faint; assumed",
);
const HEADING: Field = Field::new("heading", "heading", EVIDENCE_HEADING).turned();
const HEADING_SIGMA: Sigma = Sigma::fixed(
    "heading_sigma",
    "±",
    ANGLE_SIGMA,
    0.05,
    "3 deg, by the direction of the lane or of the first marks; assumed",
);
const SPEED: Field = Field::new("speed", "range of the speed", EVIDENCE_SPEED);
const SIDESLIP: Field =
    Field::new("sideslip", "range of the sideslip angle", EVIDENCE_HEADING).turned();
const YAW_RATE_RANGE: Field = Field::new("yaw_rate", "range of the yaw rate", YAW_RATE).turned();
const ROAD_WHEEL: Field =
    Field::new("road_wheel", "range of the angle of the front wheels", STEER_ANGLE).turned();
const BRAKE_START: Field = Field::new("brake_start", "driver brakes from", CONTROL_TIME);
const BRAKE_SHARE_RANGE: Field =
    Field::new("brake_share", "braking over what the road holds", BRAKE_SHARE);
const BEFORE: Field =
    Field::new("braked_before", "driver braked before the start for", BRAKED_BEFORE);
const BEFORE_SHARE: Field =
    Field::new("braked_before_share", "with this share of the friction", BRAKED_SHARE);

/// The start of the motion of a single car: the CG is at this place at time 0. Each value of a range is
/// equally likely.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Start {
    /// X of the CG, m; where the earliest mark begins if `None`.
    pub x_m: Option<f64>,
    /// Y of the CG, m.
    pub y_m: Option<f64>,
    /// Standard deviation along each axis, m; `None` for that of the program.
    pub position_sigma_m: Option<f64>,
    /// Heading, rad; by the direction of the earliest mark if `None`.
    pub heading_rad: Option<Stated>,
    /// Speed, m/s.
    pub speed_m_s: Option<Bounds>,
    /// Direction of motion of the CG against the heading, rad, positive to the left.
    pub sideslip_rad: Option<Bounds>,
    /// Yaw rate, rad/s, positive to the left.
    pub yaw_rate_rad_s: Option<Bounds>,
    /// Angle of the front road wheels, which the driver holds, rad, positive to the left.
    pub road_wheel_rad: Option<Bounds>,
    /// When the driver begins to brake, s after the start.
    pub brake_start_s: Option<Bounds>,
    /// Braking force over the largest that the road can hold.
    pub brake_share: Option<Bounds>,
    /// How long the driver braked before the start, where there are no marks, s; `None` where nothing is said of
    /// it. It tells the speed at which braking began.
    pub braked_before_s: Option<Bounds>,
    /// Braking force there over the largest that the road can hold.
    pub braked_before_share: Option<Bounds>,
}

impl Item for Start {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self {
            x_m,
            y_m,
            position_sigma_m: sigma_m,
            heading_rad,
            speed_m_s,
            sideslip_rad,
            yaw_rate_rad_s,
            road_wheel_rad,
            brake_start_s,
            brake_share,
            braked_before_s,
            braked_before_share,
        } = self;
        let (x, y) = (X.required_if(y_m.is_some()), Y.required_if(x_m.is_some()));
        visitor.place([&x, &y], &SIGMA, PlaceMut { x_m, y_m, sigma_m });
        visitor.measured(&HEADING, &HEADING_SIGMA, heading_rad);
        visitor.interval(&SPEED, speed_m_s);
        visitor.interval(&SIDESLIP, sideslip_rad);
        visitor.interval(&YAW_RATE_RANGE, yaw_rate_rad_s);
        visitor.interval(&ROAD_WHEEL, road_wheel_rad);
        visitor.interval(&BRAKE_START, brake_start_s);
        visitor.interval(&BRAKE_SHARE_RANGE, brake_share);
        visitor.interval(&BEFORE, braked_before_s);
        visitor.interval(&BEFORE_SHARE, braked_before_share);
    }
}

impl Start {
    /// Place of the CG, m; `None` where it is not entered.
    pub fn place_m(&self) -> Option<[f64; 2]> {
        Some([self.x_m?, self.y_m?])
    }

    /// Standard deviation of a place at the start along each axis, m.
    pub fn position_sigma_m(&self) -> f64 {
        self.position_sigma_m.unwrap_or(SIGMA.default_at(0.0))
    }

    /// Heading, rad.
    pub fn heading(&self) -> Option<Measured> {
        HEADING_SIGMA.resolve(self.heading_rad)
    }
}
