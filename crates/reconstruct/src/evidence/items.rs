//! The items of the evidence as plain data, SI units.
//!
//! World axes: origin at the CG of the struck car at first contact, X along its heading before the
//! impact, Y to the left.

use serde::{Deserialize, Serialize};

use impactlab_core::collision::Side;
use impactlab_core::vehicle::Wheel;

/// A number with its standard deviation, both in the same unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// One standard deviation.
    pub sigma: f64,
}

/// Everything that is found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// Name of the case.
    pub case: String,
    /// Peak friction of the road, where it was measured.
    pub friction: Option<Measured>,
    /// The car that was struck.
    pub struck_car: CarEvidence,
    /// The car that struck it.
    pub striking_car: CarEvidence,
    /// Error of the one scale that weighed both cars, as a share of what it shows; `None` if they were
    /// not weighed on one. The standard deviation of each mass is that of its other errors.
    #[serde(default)]
    pub shared_scale_sigma: Option<f64>,
    /// Where the struck car was hit.
    pub damage: Damage,
    /// Where the struck car came to rest; `None` if that is not known.
    pub rest: Option<RestPose>,
    /// Where the striking car came to rest.
    pub striking_rest: Option<RestPose>,
    /// What driver and damage did to the wheels of the struck car.
    pub after: After,
    /// Tire marks of the struck car.
    pub marks: Vec<Mark>,
    /// Event data recorder of the struck car.
    pub edr: Edr,
    /// Positions of the struck car from a video.
    pub positions: Vec<VideoPosition>,
    /// Ranges that the user gives to what is asked for.
    pub prior: PriorRanges,
}

/// What is known of a car.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CarEvidence {
    /// Mass, kg.
    pub mass_kg: Option<Measured>,
    /// Distance from the CG to the front axle, m.
    pub cg_to_front_axle_m: Option<f64>,
    /// Distance from the CG to the rear axle, m.
    pub cg_to_rear_axle_m: Option<f64>,
    /// Track width, m.
    pub track_m: Option<f64>,
    /// Height of the CG, m.
    pub cg_height_m: Option<f64>,
    /// Outer length, m.
    pub length_m: Option<f64>,
    /// Outer width, m.
    pub width_m: Option<f64>,
    /// Yaw moment of inertia, kg m².
    pub yaw_inertia_kg_m2: Option<f64>,
}

/// Where and in which direction the struck car was hit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Damage {
    /// Struck side.
    pub side: Side,
    /// Middle of the first contact along that side, from the CG, m: forward on the left and the right
    /// side, to the left at front and rear.
    pub along_m: Measured,
    /// Depth of the contact point at right angles to the side, from the CG, m; half the width of the
    /// car, or its end, if `None`.
    pub depth_m: Option<f64>,
    /// Heading of the striking car against that of the struck car by the damage, rad.
    pub angle_rad: Option<Measured>,
}

/// Where a car came to rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestPose {
    /// X of the CG, m.
    pub x_m: f64,
    /// Y of the CG, m.
    pub y_m: f64,
    /// Standard deviation along each axis, m.
    pub position_sigma_m: f64,
    /// Heading, rad; whole turns do not count.
    pub heading_rad: Option<Measured>,
}

/// Whether the driver braked after the impact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DriverBraked {
    /// He did.
    Yes,
    /// He did not.
    No,
    /// Nobody knows.
    #[default]
    Unknown,
}

/// What driver and damage did to the wheels after the impact.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct After {
    /// Wheels that were found blocked; `None` if nobody looked, so that each wheel near the damage may
    /// be.
    pub blocked_wheels: Option<Vec<Wheel>>,
    /// Whether the driver braked.
    pub driver_braked: DriverBraked,
}

/// What left a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MarkKind {
    /// A wheel that slid sideways.
    SideSlip,
    /// A locked wheel.
    Locked,
}

/// A tire mark.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    /// The wheel that left it.
    pub wheel: Wheel,
    /// What left most of it, if that can be told.
    pub kind: Option<MarkKind>,
    /// Points along it in the order of time, m; the first is where it starts, the last where it ends.
    pub points_m: Vec<[f64; 2]>,
    /// Standard deviation of a point along each axis, m.
    pub sigma_m: f64,
}

/// Record of an event data recorder in the struck car.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Edr {
    /// Bounds of the change of velocity along the x axis of the car, m/s.
    pub delta_v_x_m_s: Option<[f64; 2]>,
    /// Bounds of the change of velocity along the y axis of the car, m/s.
    pub delta_v_y_m_s: Option<[f64; 2]>,
    /// Speed before the impact, m/s.
    pub speed_before_m_s: Option<Measured>,
    /// Place of the sensor from the CG, x forward and y left, m.
    pub sensor_m: [f64; 2],
    /// When the record of the change of velocity ends, s after the first contact; the end of the
    /// contact if `None`.
    pub ends_s: Option<f64>,
}

/// Position of the struck car at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VideoPosition {
    /// Time after the first contact, s.
    pub time_s: f64,
    /// X of the CG, m.
    pub x_m: f64,
    /// Y of the CG, m.
    pub y_m: f64,
    /// Standard deviation along each axis, m.
    pub sigma_m: f64,
}

/// Ranges in which quantities are taken to lie before the evidence is looked at; each value inside is
/// equally likely. What has none has the default of [`Prior`](crate::Prior).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PriorRanges {
    /// Speed of the struck car before the impact, m/s.
    #[serde(rename = "target_speed_m_s")]
    pub struck_speed_m_s: Option<[f64; 2]>,
    /// Speed of the striking car before the impact, m/s.
    #[serde(rename = "bullet_speed_m_s")]
    pub striking_speed_m_s: Option<[f64; 2]>,
    /// Heading of the striking car against that of the struck car, rad, positive to the left.
    pub heading_difference_rad: Option<[f64; 2]>,
    /// Direction in which the striking car moves against its heading, rad, positive to the left.
    #[serde(rename = "bullet_sideslip_rad")]
    pub striking_sideslip_rad: Option<[f64; 2]>,
    /// Coefficient of restitution.
    pub restitution: Option<[f64; 2]>,
    /// Largest ratio of tangential to normal impulse.
    pub contact_friction: Option<[f64; 2]>,
    /// When the driver of the struck car begins to brake, s after the first contact.
    pub brake_start_s: Option<[f64; 2]>,
    /// Braking force over the largest that the road can hold.
    pub brake_share: Option<[f64; 2]>,
}

impl Evidence {
    /// The same without the record of the event data recorder.
    pub fn without_edr(&self) -> Self {
        Self { edr: Edr::default(), ..self.clone() }
    }

    /// The same with nothing of the motion but the rest poses, and nothing of what driver and wheels
    /// did.
    pub fn rest_only(&self) -> Self {
        let after = After::default();
        Self { marks: Vec::new(), positions: Vec::new(), after, ..self.without_edr() }
    }

    /// What a mirror on the X axis shows: left and right are swapped.
    pub fn mirrored(&self) -> Self {
        let point = |[x, y]: [f64; 2]| [x, -y];
        let angle = |it: Measured| Measured { value: -it.value, ..it };
        let span = |[low, high]: [f64; 2]| [-high, -low];
        let pose = |pose: RestPose| RestPose {
            y_m: -pose.y_m,
            heading_rad: pose.heading_rad.map(angle),
            ..pose
        };
        let mut mirror = self.clone();
        let damage = &mut mirror.damage;
        damage.side = match damage.side {
            Side::Left => Side::Right,
            Side::Right => Side::Left,
            other => other,
        };
        match damage.side {
            Side::Left | Side::Right => damage.depth_m = damage.depth_m.map(|y_m| -y_m),
            Side::Front | Side::Rear => damage.along_m = angle(damage.along_m),
        }
        damage.angle_rad = damage.angle_rad.map(angle);
        mirror.rest = self.rest.map(pose);
        mirror.striking_rest = self.striking_rest.map(pose);
        let blocked = &mut mirror.after.blocked_wheels;
        *blocked = blocked.take().map(|wheels| wheels.into_iter().map(opposite).collect());
        for mark in &mut mirror.marks {
            mark.wheel = opposite(mark.wheel);
            mark.points_m.iter_mut().for_each(|at| *at = point(*at));
        }
        mirror.edr.delta_v_y_m_s = self.edr.delta_v_y_m_s.map(span);
        mirror.edr.sensor_m = point(self.edr.sensor_m);
        mirror.positions.iter_mut().for_each(|at| at.y_m = -at.y_m);
        let prior = &mut mirror.prior;
        prior.heading_difference_rad = prior.heading_difference_rad.map(span);
        prior.striking_sideslip_rad = prior.striking_sideslip_rad.map(span);
        mirror
    }
}

/// The wheel on the other side of the axle.
fn opposite(wheel: Wheel) -> Wheel {
    match wheel {
        Wheel::FrontLeft => Wheel::FrontRight,
        Wheel::FrontRight => Wheel::FrontLeft,
        Wheel::RearLeft => Wheel::RearRight,
        Wheel::RearRight => Wheel::RearLeft,
    }
}
