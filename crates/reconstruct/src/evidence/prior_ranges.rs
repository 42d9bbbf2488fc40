//! Ranges in which quantities are taken to lie before the evidence is looked at.

use impactlab_core::ranges::{
    BRAKE_SHARE, CONTROL_TIME, EVIDENCE_HEADING, EVIDENCE_SPEED, FRICTION_LIMIT, HEADING,
    LARGEST_STEERING_WHEEL_ANGLE, RESTITUTION,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::{Bounds, Field, Fields, Group, Item, Section};

/// The ranges in a file, a form and a report.
pub const SECTION: Section = Section {
    key: "prior",
    title: "ranges beforehand",
    group: Group::Prior,
    is_required: false,
    missing: "",
};

const STRUCK_SPEED: Field = Field::new("target_speed", "speed of the struck car", EVIDENCE_SPEED);
const STRIKING_SPEED: Field =
    Field::new("bullet_speed", "speed of the striking car", EVIDENCE_SPEED);
const HEADING_DIFFERENCE: Field =
    Field::new("heading_difference", "angle of the cars", HEADING).turned();
const STRIKING_SIDESLIP: Field =
    Field::new("bullet_sideslip", "sideslip of the striking car", EVIDENCE_HEADING).turned();
const RESTITUTION_RANGE: Field = Field::new("restitution", "restitution", RESTITUTION);
const CONTACT_FRICTION: Field =
    Field::new("contact_friction", "friction of the contact", FRICTION_LIMIT);
const BRAKE_START: Field = Field::new("brake_start", "driver brakes from", CONTROL_TIME);
const BRAKE_SHARE_RANGE: Field =
    Field::new("brake_share", "braking over what the road holds", BRAKE_SHARE);
const STRIKING_BRAKE_START: Field =
    Field::new("bullet_brake_start", "striking driver brakes from", CONTROL_TIME);
const STRIKING_BRAKE_SHARE: Field =
    Field::new("bullet_brake_share", "braking of the striking car", BRAKE_SHARE);
const STRIKING_STEERING_WHEEL: Field = Field::new(
    "bullet_steering_wheel",
    "steering wheel of the striking car",
    LARGEST_STEERING_WHEEL_ANGLE,
);

/// Ranges in which quantities are taken to lie before the evidence is looked at; each value inside is
/// equally likely. What has none has the default of [`Prior`](crate::Prior).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PriorRanges {
    /// Speed of the struck car before the impact, m/s.
    #[serde(rename = "target_speed_m_s")]
    pub struck_speed_m_s: Option<Bounds>,
    /// Speed of the striking car before the impact, m/s.
    #[serde(rename = "bullet_speed_m_s")]
    pub striking_speed_m_s: Option<Bounds>,
    /// Heading of the striking car against that of the struck car, rad, positive to the left.
    pub heading_difference_rad: Option<Bounds>,
    /// Direction in which the striking car moves against its heading, rad, positive to the left.
    #[serde(rename = "bullet_sideslip_rad")]
    pub striking_sideslip_rad: Option<Bounds>,
    /// Coefficient of restitution.
    pub restitution: Option<Bounds>,
    /// Largest ratio of tangential to normal impulse.
    pub contact_friction: Option<Bounds>,
    /// When the driver of the struck car begins to brake, s after the first contact.
    pub brake_start_s: Option<Bounds>,
    /// Braking force over the largest that the road can hold.
    pub brake_share: Option<Bounds>,
    /// When the driver of the striking car begins to brake, s after the first contact.
    #[serde(rename = "bullet_brake_start_s")]
    pub striking_brake_start_s: Option<Bounds>,
    /// Its braking force over the largest that the road can hold.
    #[serde(rename = "bullet_brake_share")]
    pub striking_brake_share: Option<Bounds>,
    /// By how much the driver of the striking car turns the steering wheel towards the struck car as he
    /// pushes it, rad, as in a PIT manoeuvre; where the range ends at 5° or less he does not.
    #[serde(rename = "bullet_steering_wheel_rad")]
    pub striking_steering_wheel_rad: Option<Bounds>,
}

impl Item for PriorRanges {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self {
            struck_speed_m_s,
            striking_speed_m_s,
            heading_difference_rad,
            striking_sideslip_rad,
            restitution,
            contact_friction,
            brake_start_s,
            brake_share,
            striking_brake_start_s,
            striking_brake_share,
            striking_steering_wheel_rad,
        } = self;
        visitor.interval(&STRUCK_SPEED, struck_speed_m_s);
        visitor.interval(&STRIKING_SPEED, striking_speed_m_s);
        visitor.interval(&HEADING_DIFFERENCE, heading_difference_rad);
        visitor.interval(&STRIKING_SIDESLIP, striking_sideslip_rad);
        visitor.interval(&RESTITUTION_RANGE, restitution);
        visitor.interval(&CONTACT_FRICTION, contact_friction);
        visitor.interval(&BRAKE_START, brake_start_s);
        visitor.interval(&BRAKE_SHARE_RANGE, brake_share);
        visitor.interval(&STRIKING_BRAKE_START, striking_brake_start_s);
        visitor.interval(&STRIKING_BRAKE_SHARE, striking_brake_share);
        visitor.interval(&STRIKING_STEERING_WHEEL, striking_steering_wheel_rad);
    }
}
