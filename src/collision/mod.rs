//! Two vehicles meet: momentum-conservation impact, contact geometry, scenarios, classic pulses, the
//! crash-test filter, and clusters of collisions by their impulse.
//!
//! ```
//! use impactlab::collision::{Pulse, PulseShape, Scenario};
//!
//! let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/pit_right_rear.toml");
//! let scenario = Scenario::load(file.as_ref())?;
//! let solution = scenario.solve()?;
//! assert!(solution.target.yaw_rate_rad_s < 0.0, "the tail goes left, the nose right");
//!
//! let pulse = Pulse::new(PulseShape::Haversine, solution.impulse_n_s, 0.0, 0.1)?;
//! let force = pulse.to_history(0.001)?;
//! assert_eq!(force.time_s.len(), 100);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod impact;
#[cfg(test)]
mod impact_tests;
mod pdof;

mod contact_distribution;
mod footprint;
mod scenario;
mod scenario_file;
mod scenario_preset;
mod scenario_write;

pub mod crush;

mod pulse;

mod channel_filter;

mod impulse_clusters;

pub use channel_filter::{
    ChannelClass, ChannelFilter, FilterError, filter_channel, filter_history,
};
pub use contact_distribution::ContactDistribution;
pub use footprint::{
    Contact, Footprint, FootprintError, Pose, Side, StruckSurface, TOUCH_TOLERANCE_M, find_contact,
    place_touching,
};
pub use impact::{
    BodyAfter, ContactSurface, FrictionModel, Impact, ImpactBody, ImpactError, ImpactSolution,
    ImpliedContact, Regime, contact_work_j,
};
pub use impulse_clusters::{ImpulseClusters, ImpulseFeatures};
pub use pdof::PrincipalDirectionOfForce;
pub use pulse::{Pulse, PulseError, PulseShape};
pub use scenario::{
    ContactLocation, DEFAULT_FRICTION_LIMIT, DEFAULT_RESTITUTION, ImpactCase, Scenario,
    ScenarioContact, ScenarioError, ScenarioGeometry, ScenarioVehicle,
};
pub use scenario_preset::SCENARIO_PRESETS;
