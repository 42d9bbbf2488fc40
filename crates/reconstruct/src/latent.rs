//! The quantities that the motion of a collision depends on, and a value of each.

use schemars::JsonSchema;
use serde::Serialize;

use impactlab_core::units::Quantity;

/// Probability that a driver brakes of whom nothing is known.
pub const BRAKE_PROBABILITY: f64 = 0.75;

/// Probability that a driver brakes already when the cars meet who hits another car and of whom nothing is
/// known.
pub const STRIKING_BRAKES_BEFORE: f64 = 0.4;

/// Probability that he brakes then or later.
pub const STRIKING_BRAKES: f64 = 0.8;

/// Probability that the brakes of a single car have an anti-lock system of which nothing is known: half of the
/// draws have one, since it decides how much a wheel brakes that is braked too hard.
pub const ANTI_LOCK_PROBABILITY: f64 = 0.5;

/// Probability that the driver of a car that hits a flank behind the CG steers in and pushes on, as in a
/// PIT manoeuvre, where nobody says whether he does.
pub const PUSH_PROBABILITY: f64 = 0.5;

/// Probability that a wheel near the damage is blocked if nobody looked.
pub const BLOCKED_PROBABILITY: f64 = 0.2;

macro_rules! latents {
    ($($(#[$doc:meta])* $name:ident: $key:literal, $unit:literal, $label:literal;)+) => {
        /// A quantity that the motion depends on.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum Latent {
            $($(#[$doc])* $name,)+
        }

        impl Latent {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$name),+];

            /// Name with its unit, as in a table of particles.
            pub const fn key(self) -> &'static str {
                match self { $(Self::$name => $key),+ }
            }

            /// Symbol of the unit; empty for a pure number.
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$name => $unit),+ }
            }

            /// What it is called.
            pub const fn label(self) -> &'static str {
                match self { $(Self::$name => $label),+ }
            }
        }
    };
}

latents! {
    /// Speed of the struck car before the impact, m/s.
    #[serde(rename = "target_speed")]
    StruckSpeed: "target_speed_m_s", "m/s", "speed of the struck car";
    /// Speed of the striking car before the impact, m/s, where it has a range of its own.
    #[serde(rename = "bullet_speed")]
    StrikingSpeed: "bullet_speed_m_s", "m/s", "speed of the striking car";
    /// Speed of the striking car beyond that of the struck car, m/s, where it has none.
    SpeedDifference: "speed_difference_m_s", "m/s", "striking car faster by";
    /// Heading of the striking car, rad, turned towards the struck side.
    HeadingTowards: "heading_towards_rad", "rad", "striking car turned in by";
    /// Direction in which the striking car moves beside its heading, rad, towards the struck side.
    SideslipTowards: "sideslip_towards_rad", "rad", "striking car moves inwards by";
    /// First contact along the struck side, from the CG, m.
    ContactAlong: "contact_along_m", "m", "contact along the side";
    /// First contact at right angles to the struck side, from the CG, m.
    ContactAcross: "contact_across_m", "m", "contact across the side";
    /// Place of the coefficient of restitution between its bounds, 0 to 1.
    RestitutionShare: "restitution_share", "", "restitution within its bounds";
    /// Friction limit of the contact.
    ContactFriction: "contact_friction", "", "friction of the contact";
    /// By how much the normal of the contact is turned from that of the struck side towards where the
    /// striking car points, rad.
    NormalTilt: "normal_tilt_rad", "rad", "normal of the contact turned by";
    /// Duration of the contact, s.
    PulseDuration: "pulse_duration_s", "s", "duration of the contact";
    /// Peak friction of the road.
    RoadFriction: "road_friction", "", "friction of the road";
    /// Friction of the tires of the struck car over that of the road.
    TireFrictionFactor: "tire_friction_factor", "", "tire friction over that of the road";
    /// Mass of the struck car, kg.
    #[serde(rename = "target_mass")]
    StruckMass: "target_mass_kg", "kg", "mass of the struck car";
    /// Mass of the striking car, kg.
    #[serde(rename = "bullet_mass")]
    StrikingMass: "bullet_mass_kg", "kg", "mass of the striking car";
    /// True weight over what the one scale that weighed both cars shows: a factor of both masses.
    MassScaleFactor: "mass_scale_factor", "", "true weight over that of the scale";
    /// Yaw inertia of the struck car over that of its data sheet.
    YawInertiaFactor: "yaw_inertia_factor", "", "yaw inertia over the estimate";
    /// Cornering coefficient of the front tires over that of the data sheet.
    FrontCorneringFactor: "front_cornering_factor", "", "front cornering over the estimate";
    /// The same of the rear tires.
    RearCorneringFactor: "rear_cornering_factor", "", "rear cornering over the estimate";
    /// Sliding friction over peak friction.
    SlidingRatio: "sliding_friction_ratio", "", "sliding over peak friction";
    /// Friction of a wheel along its plane over that across it.
    LongitudinalFrictionRatio: "longitudinal_friction_ratio", "", "tire friction along over across";
    /// Rolling resistance over vertical load.
    RollingResistance: "rolling_resistance", "", "rolling resistance";
    /// Whether the driver brakes: below its threshold he does.
    BrakeDecision: "brake_decision", "", "whether the driver brakes";
    /// When he begins, s after the first contact.
    BrakeStart: "brake_start_s", "s", "driver brakes from";
    /// Braking force over the largest that the road can hold.
    BrakeShare: "brake_share", "", "braking over what the road holds";
    /// How long the braking force rises, s.
    BrakeRise: "brake_rise_s", "s", "braking rises within";
    /// Share of the front axle in the braking force beyond that with which both axles reach the limit
    /// together.
    FrontBrakeShift: "front_brake_shift", "", "front share of the brakes, beyond";
    /// Deceleration by the engine, m/s².
    EngineBraking: "engine_braking_m_s2", "m/s²", "engine braking";
    /// Angle of the front wheels, rad.
    SteerAngle: "steer_angle_rad", "rad", "angle of the front wheels";
    /// Which wheel is blocked, where nobody looked, 0 to 1.
    BlockedWheel: "blocked_wheel", "", "which wheel is blocked";
    /// How far it is blocked: drag over what the road can hold; more than 1 is locked.
    BlockedDrag: "blocked_drag", "", "drag of the blocked wheel";
    /// Whether the driver of the striking car brakes: below one threshold he already does at first contact,
    /// below another he does later.
    #[serde(rename = "bullet_brake_decision")]
    StrikingBrakeDecision: "bullet_brake_decision", "", "whether the striking driver brakes";
    /// When the driver of the striking car brakes, s after the first contact.
    #[serde(rename = "bullet_brake_start")]
    StrikingBrakeStart: "bullet_brake_start_s", "s", "striking driver brakes from";
    /// Its braking force over the largest that the road can hold.
    #[serde(rename = "bullet_brake_share")]
    StrikingBrakeShare: "bullet_brake_share", "", "braking of the striking car";
    /// Friction of the tires of the striking car over that of the road.
    #[serde(rename = "bullet_tire_friction_factor")]
    StrikingTireFrictionFactor: "bullet_tire_friction_factor", "",
        "tire friction of the striking car over that of the road";
    /// Which front wheel of the striking car is blocked, where nobody looked, 0 to 1.
    #[serde(rename = "bullet_blocked_wheel")]
    StrikingBlockedWheel: "bullet_blocked_wheel", "", "which wheel of the striking car is blocked";
    /// How far it is blocked: drag over what the road can hold; more than 1 is locked.
    #[serde(rename = "bullet_blocked_drag")]
    StrikingBlockedDrag: "bullet_blocked_drag", "", "drag of the blocked wheel of the striking car";
    /// Whether the driver of the striking car steers in and pushes on: below its threshold he does.
    #[serde(rename = "bullet_push_decision")]
    PushDecision: "bullet_push_decision", "", "whether the striking driver pushes on";
    /// By how much he turns the steering wheel towards the struck car, rad.
    #[serde(rename = "bullet_steering_wheel")]
    PushSteeringWheel: "bullet_steering_wheel_rad", "rad", "steering wheel of the striking car";
    /// How long he steers in and keeps his speed, s after the first contact.
    #[serde(rename = "bullet_push")]
    PushDuration: "bullet_push_s", "s", "striking driver pushes for";
    /// Yaw rate of the striking car at first contact, rad/s, towards the struck side.
    #[serde(rename = "bullet_yaw_rate")]
    StrikingYawRate: "bullet_yaw_rate_rad_s", "rad/s", "yaw rate of the striking car inwards";
    /// Loads that crush both cars over those of their classes, where later contacts are followed.
    ContactStiffnessFactor: "contact_stiffness_factor", "", "stiffness of both cars over the usual";
    /// Length of the skid of the struck car to first contact, m.
    SkidLength: "skid_before_m", "m", "skid before the impact";
    /// Its drag factor, where it is known of this skid.
    SkidDrag: "skid_drag", "", "drag of the skid before the impact";
    /// Length of the skid of the striking car to first contact, m.
    #[serde(rename = "bullet_skid_length")]
    StrikingSkidLength: "bullet_skid_before_m", "m", "skid of the striking car before the impact";
    /// Its drag factor, where it is known of this skid.
    #[serde(rename = "bullet_skid_drag")]
    StrikingSkidDrag: "bullet_skid_drag", "", "drag of the skid of the striking car";
    /// Speed of a single car at the start, m/s.
    #[serde(rename = "speed")]
    CarSpeed: "speed_m_s", "m/s", "speed of the car at the start";
    /// Direction of motion of its CG against its heading there, rad, positive to the left.
    #[serde(rename = "sideslip")]
    CarSideslip: "sideslip_rad", "rad", "sideslip angle at the start";
    /// Its yaw rate there, rad/s, positive to the left.
    #[serde(rename = "yaw_rate")]
    CarYawRate: "yaw_rate_rad_s", "rad/s", "yaw rate at the start";
    /// X of the place by which its start is known, m.
    StartX: "start_x_m", "m", "X of the start";
    /// Y of it, m.
    StartY: "start_y_m", "m", "Y of the start";
    /// Heading at the start, rad, where it is stated.
    StartHeading: "start_heading_rad", "rad", "heading at the start";
    /// Direction of motion at the start, rad, where the heading is not stated.
    StartCourse: "start_course_rad", "rad", "course at the start";
    /// Friction of the zones of the ground over that which the site says, in all of them alike.
    ZoneFrictionFactor: "zone_friction_factor", "", "friction of the zones over that of the site";
    /// Whether the brakes of the struck or the single car have an anti-lock system: below its threshold they do.
    AntiLockDecision: "anti_lock_decision", "", "whether the brakes have an anti-lock system";
    /// How long the driver of a single car braked before the start, s.
    BrakedBefore: "braked_before_s", "s", "driver braked before the start for";
    /// Braking force there over the largest that the road can hold.
    BrakedBeforeShare: "braked_before_share", "", "braking before the start over the friction";
}

impl Latent {
    /// What kind of quantity it is.
    pub fn quantity(self) -> Quantity {
        match self.unit() {
            "m/s" => Quantity::Speed,
            "rad" => Quantity::Angle,
            "rad/s" => Quantity::AngularVelocity,
            "m" => Quantity::Length,
            "s" => Quantity::Time,
            "kg" => Quantity::Mass,
            "m/s²" => Quantity::Acceleration,
            _ => Quantity::Ratio,
        }
    }
}

/// A value of each quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatentValues([f64; Latent::ALL.len()]);

impl LatentValues {
    /// No value of any quantity.
    pub(super) const NONE: Self = Self([f64::NAN; Latent::ALL.len()]);

    /// Value of a quantity; NaN where the case does not have it.
    pub fn get(&self, latent: Latent) -> f64 {
        self.0[latent as usize]
    }

    pub(super) fn set(&mut self, latent: Latent, value: f64) {
        self.0[latent as usize] = value;
    }

    /// Whether the driver of the struck car brakes.
    pub fn brakes(&self) -> bool {
        self.get(Latent::BrakeDecision) < BRAKE_PROBABILITY
    }

    /// When the driver of the striking car brakes, s after the first contact; `None` if he does not.
    pub fn striking_brakes_from_s(&self) -> Option<f64> {
        let decision = self.get(Latent::StrikingBrakeDecision);
        match decision < STRIKING_BRAKES_BEFORE {
            true => Some(0.0),
            false => (decision < STRIKING_BRAKES).then(|| self.get(Latent::StrikingBrakeStart)),
        }
    }

    /// Whether the brakes of the struck or the single car have an anti-lock system.
    pub fn has_anti_lock(&self) -> bool {
        self.get(Latent::AntiLockDecision) < ANTI_LOCK_PROBABILITY
    }

    /// Whether the driver of the striking car steers in and pushes on.
    pub fn striking_pushes(&self) -> bool {
        self.get(Latent::PushDecision) < PUSH_PROBABILITY
    }

    /// Drag factor of the struck car with all wheels locked, over the acceleration of gravity.
    pub fn locked_drag(&self) -> f64 {
        self.locked_drag_on(Latent::TireFrictionFactor)
    }

    /// The same of the striking car; NaN where its tires are not among the quantities.
    pub fn striking_locked_drag(&self) -> f64 {
        self.locked_drag_on(Latent::StrikingTireFrictionFactor)
    }

    /// - `tires`: friction of the tires of the car over that of the road.
    fn locked_drag_on(&self, tires: Latent) -> f64 {
        [Latent::RoadFriction, tires, Latent::LongitudinalFrictionRatio, Latent::SlidingRatio]
            .map(|latent| self.get(latent))
            .iter()
            .product()
    }

    /// Which of two wheels near the damage is blocked, where nobody looked.
    ///
    /// - `which`: [`Latent::BlockedWheel`] or [`Latent::StrikingBlockedWheel`].
    pub fn blocked_of_two(&self, which: Latent) -> Option<usize> {
        let at = self.get(which);
        if at < BLOCKED_PROBABILITY {
            Some(0)
        } else if at < 2.0 * BLOCKED_PROBABILITY {
            Some(1)
        } else {
            None
        }
    }
}
