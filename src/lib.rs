//! What happens when one vehicle hits another, and in the second after.
//!
//! Data flows one way, and each module names only those above it:
//!
//! 1. [`bibliography`], [`units`]: sources, unit conversion;
//! 2. [`numerics`], [`jobs`]: integration, statistics; background work;
//! 3. [`data`]: files become checked time series in SI units;
//! 4. [`vehicle`]: the one place of the equations of motion;
//! 5. [`collision`]: the impact itself: impulse, contact geometry, scenarios, pulses, filter;
//! 6. [`nn`]: layers, parameters, optimiser and files of the networks;
//! 7. [`uncertainty`]: distributions of whole force curves;
//! 8. [`compare`]: simulation against reference;
//! 9. [`learning`]: what the trainings of both networks share;
//! 10. [`force`], [`response`]: the force network and its baselines; the response network;
//! 11. [`shipped`]: the trained networks that are part of the program;
//! 12. [`analysis`]: one case, from its file to a motion;
//! 13. [`figure`]: what a plot shows, as plain data;
//! 14. `render` (feature `gui`): one drawing function for the panel and the off-screen picture;
//! 15. `cli` and `app` (feature `gui`): the command line and the window.
//!
//! ```
//! use impactlab::vehicle::{Integrator, Manoeuvre, Preset, VehicleState};
//!
//! let manoeuvre = Manoeuvre {
//!     initial: VehicleState { yaw_rate_rad_s: 2.0, ..VehicleState::driving_straight(20.0) },
//!     contact_load: None,
//!     steer: None,
//!     duration_s: 4.0,
//! };
//! let motion = Preset::Reference.parameters().simulate(&manoeuvre, Integrator::Rk4)?;
//! assert_eq!(motion.series.n_samples(), 401);
//! # Ok::<(), impactlab::vehicle::SimulationError>(())
//! ```

pub mod analysis;
#[cfg(feature = "gui")]
pub mod app;
pub mod bibliography;
pub mod cli;
pub mod collision;
pub mod compare;
pub mod data;
mod error_chain;
pub mod figure;
pub mod force;
pub mod jobs;
pub mod learning;
pub mod nn;
pub mod numerics;
#[cfg(feature = "gui")]
pub mod render;
pub mod response;
pub mod shipped;
pub mod study;
pub mod uncertainty;
pub mod units;
pub mod vehicle;

pub use error_chain::error_chain;
