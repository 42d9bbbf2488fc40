//! The quantities that a reconstruction is asked for, and an estimate of one.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{ImpactState, Latent, LatentValues};
use impactlab_core::numerics::{quantile_of_sorted, unwrapped_rad};
use impactlab_core::units::{Estimate, Quantity};

macro_rules! quantities {
    (
        $($(#[$doc:meta])* $name:ident: $key:literal, $unit:literal, $value:expr;)+
        --- $($late:ident),+
        --- $($single:ident),+
    ) => {
        /// A quantity that a reconstruction asks for.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum ReconstructedQuantity {
            $($(#[$doc])* $name,)+
        }

        impl ReconstructedQuantity {
            /// Every one of them.
            pub const EVERY: &'static [Self] = &[$(Self::$name),+];

            /// Those that only a collision with a skid before the impact has.
            pub const BEFORE_SKID: &'static [Self] = &[$(Self::$late),+];

            /// Those that only a single car has: the last ones, after those of a skid.
            const OF_SINGLE_CAR: &'static [Self] = &[$(Self::$single),+];

            /// Those that every collision has.
            pub const ALL: &'static [Self] = Self::EVERY
                .split_at(
                    Self::EVERY.len() - Self::BEFORE_SKID.len() - Self::OF_SINGLE_CAR.len(),
                )
                .0;

            /// Name with its unit.
            pub const fn key(self) -> &'static str {
                match self { $(Self::$name => $key),+ }
            }

            /// Symbol of the unit; empty for a pure number.
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$name => $unit),+ }
            }

            /// Its value of a particle.
            pub(crate) fn value(self, point: &PosteriorPoint<'_>) -> f64 {
                let value: fn(&PosteriorPoint<'_>) -> f64 = match self { $(Self::$name => $value),+ };
                value(point)
            }
        }
    };
}

quantities! {
    /// Speed of the struck car before the impact, m/s.
    StruckSpeed: "target_speed_m_s", "m/s",
        |point| point.of_impact(|impact| impact.struck_speed_m_s);
    /// Speed of the striking car before the impact, m/s.
    StrikingSpeed: "bullet_speed_m_s", "m/s",
        |point| point.of_impact(|impact| impact.striking_speed_m_s);
    /// Size of the difference of both velocities, m/s.
    ClosingSpeed: "closing_speed_m_s", "m/s",
        |point| point.of_impact(|impact| impact.closing_speed_m_s);
    /// Heading of the striking car against that of the struck car at first contact, rad.
    HeadingDifference: "heading_difference_rad", "rad",
        |point| point.of_impact(|impact| impact.heading_difference_rad);
    /// Peak friction of the road.
    RoadFriction: "road_friction", "", |point| point.values.get(Latent::RoadFriction);
    /// Change of velocity of the struck car by the contact, m/s.
    DeltaVStruck: "delta_v_target_m_s", "m/s",
        |point| point.of_impact(ImpactState::delta_v_struck_m_s);
    /// Yaw rate of the struck car at the end of the contact, over which the tires act as well, rad/s.
    StruckYawRate: "target_yaw_rate_after_rad_s", "rad/s", |point| point.yaw_rate_after_rad_s;
    /// Speed of the struck car before a skid that ended at the impact, m/s.
    StruckSpeedBeforeSkid: "target_speed_before_skid_m_s", "m/s",
        |point| point.of_impact(|impact| impact.speeds_before_skid_m_s[0].unwrap_or(f64::NAN));
    /// The same of the striking car, m/s.
    StrikingSpeedBeforeSkid: "bullet_speed_before_skid_m_s", "m/s",
        |point| point.of_impact(|impact| impact.speeds_before_skid_m_s[1].unwrap_or(f64::NAN));
    /// Speed of a single car at the start, m/s.
    CarSpeed: "speed_m_s", "m/s", |point| point.values.get(Latent::CarSpeed);
    /// Direction of motion of its CG against its heading there, rad.
    CarSideslip: "sideslip_rad", "rad", |point| point.values.get(Latent::CarSideslip);
    /// Its yaw rate there, rad/s.
    CarYawRate: "yaw_rate_rad_s", "rad/s", |point| point.values.get(Latent::CarYawRate);
    /// Speed at which a single car began to brake before the start, m/s.
    CarSpeedBeforeBraking: "speed_before_braking_m_s", "m/s",
        |point| point.speed_before_braking_m_s;
    --- StruckSpeedBeforeSkid, StrikingSpeedBeforeSkid
    --- CarSpeed, CarSideslip, CarYawRate, CarSpeedBeforeBraking
}

impl ReconstructedQuantity {
    /// Those that every single car has.
    pub const SINGLE_CAR: &'static [Self] =
        &[Self::CarSpeed, Self::CarSideslip, Self::CarYawRate, Self::RoadFriction];

    /// What it is called.
    pub fn label(self) -> &'static str {
        match self {
            Self::StruckSpeed => "speed of the struck car",
            Self::StrikingSpeed => "speed of the striking car",
            Self::ClosingSpeed => "closing speed",
            Self::HeadingDifference => "relative heading of the cars",
            Self::RoadFriction => "friction of the road",
            Self::DeltaVStruck => "Δv of the struck car",
            Self::StruckYawRate => "yaw rate after the impact",
            Self::StruckSpeedBeforeSkid => "speed of the struck car before its skid",
            Self::StrikingSpeedBeforeSkid => "speed of the striking car before its skid",
            Self::CarSpeed => "speed of the car at the start",
            Self::CarSideslip => "sideslip angle at the start",
            Self::CarYawRate => "yaw rate at the start",
            Self::CarSpeedBeforeBraking => "speed of the car when braking began",
        }
    }

    /// What kind of quantity it is.
    pub fn quantity(self) -> Quantity {
        match self {
            Self::StruckSpeed
            | Self::StrikingSpeed
            | Self::ClosingSpeed
            | Self::DeltaVStruck
            | Self::StruckSpeedBeforeSkid
            | Self::StrikingSpeedBeforeSkid
            | Self::CarSpeed
            | Self::CarSpeedBeforeBraking => Quantity::Speed,
            Self::HeadingDifference | Self::CarSideslip => Quantity::Angle,
            Self::RoadFriction => Quantity::Ratio,
            Self::StruckYawRate | Self::CarYawRate => Quantity::AngularVelocity,
        }
    }
}

/// Levels of the intervals of a quantity.
pub(crate) const LEVELS: [f64; 4] = [0.5, 0.8, 0.9, 0.95];

/// A quantity with its intervals, which leave out as much below as above; without any where too few
/// particles are known of it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(into = "WrittenEstimate")]
pub struct QuantityEstimate {
    /// Name with its unit.
    pub name: &'static str,
    /// Symbol of the unit; empty for a pure number.
    pub unit: &'static str,
    /// Median and intervals.
    pub estimate: Estimate,
}

/// A [`QuantityEstimate`] as it is written, with the keys of version 0.1, which a later version will
/// not write.
#[derive(Serialize, JsonSchema)]
struct WrittenEstimate {
    /// Name with its unit.
    name: &'static str,
    /// Symbol of the unit; empty for a pure number.
    unit: &'static str,
    /// Median and intervals.
    #[serde(flatten)]
    estimate: Estimate,
    /// Former key: ends of the interval of 50 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    interval_50: Option<[f64; 2]>,
    /// Former key: ends of the interval of 80 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    interval_80: Option<[f64; 2]>,
    /// Former key: ends of the interval of 90 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    interval_90: Option<[f64; 2]>,
    /// Former key: ends of the interval of 95 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    interval_95: Option<[f64; 2]>,
}

impl From<QuantityEstimate> for WrittenEstimate {
    fn from(quantity: QuantityEstimate) -> Self {
        let QuantityEstimate { name, unit, estimate } = quantity;
        let [interval_50, interval_80, interval_90, interval_95] =
            LEVELS.map(|level| estimate.interval(level));
        Self { name, unit, estimate, interval_50, interval_80, interval_90, interval_95 }
    }
}

/// What a quantity of a particle follows from.
pub(crate) struct PosteriorPoint<'a> {
    pub(crate) values: &'a LatentValues,
    pub(crate) impact: Option<&'a ImpactState>,
    pub(crate) yaw_rate_after_rad_s: f64,
    pub(crate) speed_before_braking_m_s: f64,
}

impl PosteriorPoint<'_> {
    /// A quantity of the impact; NaN of a single car.
    fn of_impact(&self, quantity: impl Fn(&ImpactState) -> f64) -> f64 {
        self.impact.map_or(f64::NAN, quantity)
    }
}

impl QuantityEstimate {
    /// Which quantity it is.
    fn reconstructed(&self) -> Option<ReconstructedQuantity> {
        ReconstructedQuantity::EVERY.iter().copied().find(|quantity| quantity.key() == self.name)
    }

    /// What it is called.
    pub fn label(&self) -> &'static str {
        self.reconstructed().map_or(self.name, ReconstructedQuantity::label)
    }

    /// What kind of quantity it is.
    pub fn quantity(&self) -> Quantity {
        self.reconstructed().map_or(Quantity::Ratio, ReconstructedQuantity::quantity)
    }

    /// Intervals of equally likely values; `None` without values. Those of an angle continue from its
    /// median without a jump, and may end beyond half a turn.
    ///
    /// - `levels`: probabilities of the intervals, ascending.
    pub(crate) fn from_values(
        quantity: ReconstructedQuantity,
        values: Vec<f64>,
        levels: &[f64],
    ) -> Option<Self> {
        let mut values = match quantity.quantity() {
            Quantity::Angle => unwrapped_rad(&values),
            _ => values,
        };
        values.sort_by(f64::total_cmp);
        Self::with_levels(quantity, levels, |share| quantile_of_sorted(&values, share))
    }

    /// Median and intervals of a distribution; `None` if it has no quantiles.
    ///
    /// - `at`: the value below which the quantity lies with a probability.
    pub fn by(quantity: ReconstructedQuantity, at: impl Fn(f64) -> Option<f64>) -> Option<Self> {
        Self::with_levels(quantity, &LEVELS, at)
    }

    fn with_levels(
        quantity: ReconstructedQuantity,
        levels: &[f64],
        at: impl Fn(f64) -> Option<f64>,
    ) -> Option<Self> {
        let estimate = Estimate::from_quantiles(levels, at)?;
        Some(Self { name: quantity.key(), unit: quantity.unit(), estimate })
    }
}
