//! What every part of impactlab computes with: units and numbers, files and time series, vehicles,
//! the impact, the ground, distributions and comparisons.
//!
//! Data flows in one direction. Each module uses only modules above it in this list:
//!
//! 1. [`bibliography`], [`units`], [`error_chain()`], [`program`]: sources, quantities and their
//!    units, errors with their causes as one line, the version of the program;
//! 2. [`ranges`], [`numerics`], [`jobs`]: the values that numbers may have; scalar types,
//!    integration and statistics; background work;
//! 3. [`data`]: files become checked time series in SI units;
//! 4. [`vehicle`]: parameters, tires and the equations of motion, which exist only here;
//! 5. [`collision`]: the impact: impulse, contact geometry, scenarios, pulses, channel filter,
//!    crush; [`site`]: the ground: orthophoto, lanes, zones of friction, drawings;
//! 6. [`uncertainty`], [`compare`]: distributions of force curves and positions; comparison of a
//!    simulation with a reference.
//!
//! This example simulates a vehicle that drives at 20 m/s with an initial yaw rate of 2 rad/s:
//!
//! ```
//! use impactlab_core::vehicle::{Integrator, Manoeuvre, Preset, VehicleState};
//!
//! let manoeuvre = Manoeuvre {
//!     initial: VehicleState { yaw_rate_rad_s: 2.0, ..VehicleState::driving_straight(20.0) },
//!     duration_s: 4.0,
//!     ..Manoeuvre::default()
//! };
//! let motion = Preset::Reference.parameters().simulate(&manoeuvre, Integrator::Rk4)?;
//! assert_eq!(motion.series.n_samples(), 401);
//! # Ok::<(), impactlab_core::vehicle::SimulationError>(())
//! ```

pub mod bibliography;
pub mod collision;
pub mod compare;
pub mod data;
mod error_chain;
pub mod jobs;
pub mod numerics;
pub mod program;
pub mod ranges;
pub mod site;
pub mod uncertainty;
pub mod units;
pub mod vehicle;

pub use error_chain::error_chain;
