//! The collision of two vehicles.
//!
//! - `impact`, `pdof`: planar impact of two rigid bodies by conservation of momentum, and the
//!   principal direction of force;
//! - `footprint`, `outline_contact`: contact point and contact normal from the outlines of the
//!   vehicles;
//! - `scenario` and its files: two vehicles that are about to collide, as a user describes them;
//! - `contact_distribution`: how uncertain restitution and friction are;
//! - [`crush`]: force over time from the crush of both vehicles;
//! - [`contact`]: the contact of any two faces, and both vehicles on their tires to the end;
//! - `pulse`: classic pulse shapes that carry a given impulse;
//! - `channel_filter`: the low-pass filter of crash tests (SAE J211);
//! - `impulse_clusters`: groups of collisions of similar impulse.
//!
//! ```
//! use impactlab_core::collision::{Pulse, PulseShape, Scenario};
//!
//! let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/scenarios/pit_right_rear.toml");
//! let scenario = Scenario::load(file.as_ref())?;
//! let solution = scenario.solve()?;
//! assert!(solution.struck.yaw_rate_rad_s < 0.0, "the tail goes left, the nose right");
//!
//! let pulse = Pulse::new(PulseShape::Haversine, solution.impulse_world_n_s, 0.0, 0.1)?;
//! let force = pulse.to_history(0.001)?;
//! assert_eq!(force.time_s.len(), 100);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod impact;
#[cfg(test)]
mod impact_tests;
mod implied_contact;
mod pdof;
mod restitution_line;

mod contact_distribution;
mod contact_work;
mod dented_outline;
mod fixed_place;
mod footprint;
mod impact_case;
mod outline_contact;
mod polygon;
mod scenario;
mod scenario_file;
mod scenario_of_vehicle;
mod scenario_preset;
mod scenario_skid;
mod scenario_write;
mod second_contact;
mod side_approach;

pub mod contact;
pub mod crush;

mod pulse;

mod channel_filter;

mod impulse_clusters;

pub use channel_filter::{
    ChannelClass, ChannelFilter, FilterError, filter_channel, filter_history,
};
pub use contact_distribution::{
    ContactDistribution, DEFAULT_FRICTION_LIMIT, DEFAULT_RESTITUTION, HARD_RESTITUTION,
    RESTITUTION_SPEEDS_M_S, default_restitution, default_restitution_in_words, restitution_bounds,
};
pub use contact_work::contact_work_j;
pub use dented_outline::DentedOutlines;
pub use footprint::{Footprint, FootprintError, OffOutline, Pose, Side};
pub use impact::{
    BodyAfter, ContactSurface, FrictionModel, Impact, ImpactBody, ImpactError, ImpactSolution,
    Regime, RestitutionForm,
};
pub use impact_case::ImpactCase;
pub use implied_contact::{ImpliedContact, ImpliedContacts};
pub use impulse_clusters::{ImpulseClusters, ImpulseFeatures};
pub use outline_contact::{
    Contact, MAX_APPROACH_TIME_S, MovingFootprint, StruckSurface, TOUCH_TOLERANCE_M, find_contact,
    overlap_centre_m, overlap_m, place_touching,
};
pub use pdof::PrincipalDirectionOfForce;
pub use pulse::{Pulse, PulseError, PulseShape};
pub use scenario::{
    ContactLocation, Scenario, ScenarioContact, ScenarioError, ScenarioGeometry, ScenarioVehicle,
};
pub use scenario_of_vehicle::{Role, SharedNumber};
pub use scenario_preset::SCENARIO_PRESETS;
pub use scenario_skid::{BeforeSkid, ScenarioSkid};
pub use second_contact::SecondContact;
pub use side_approach::SideApproach;

#[cfg(test)]
mod pit_tests;
