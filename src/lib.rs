//! Reconstruction of vehicle collisions: the force that acts in an impact, and the motion of the
//! struck vehicle afterwards.
//!
//! Physical models (planar impact, crush, a vehicle model of four degrees of freedom with
//! non-linear tires) compute them, and neural networks around these models predict them with their
//! uncertainty.
//!
//! Data flows in one direction. Each module uses only modules above it in this list:
//!
//! 1. [`bibliography`], [`units`], [`error_chain()`]: sources, quantities and their units, errors
//!    with their causes as one line;
//! 2. [`ranges`], [`numerics`], [`jobs`]: the values that numbers may have; scalar types,
//!    integration and statistics; background work;
//! 3. [`data`]: files become checked time series in SI units;
//! 4. [`vehicle`]: parameters, tires and the equations of motion, which exist only here;
//! 5. [`collision`]: the impact: impulse, contact geometry, scenarios, pulses, channel filter,
//!    crush; [`site`]: the ground: orthophoto, lanes, zones of friction, drawings;
//! 6. [`nn`], [`uncertainty`], [`compare`]: layers, parameters, optimiser and files of networks;
//!    distributions of force curves and positions; comparison of a simulation with a reference;
//! 7. [`learning`]: what the trainings of both networks have in common;
//! 8. [`force`], [`response`]: the network that predicts the contact force, and the network that
//!    predicts the motion, each with its baselines;
//! 9. [`reconstruct`]: from the evidence back to the speeds: the sampler of a posterior;
//! 10. [`shipped`]: the trained networks and notices that are part of the program;
//! 11. [`analysis`]: one case, from its file or scenario to a motion;
//! 12. [`study`]: every question that can be asked, as a request with a report as its answer;
//! 13. [`figure`], [`scene`]: the content of a plot, and of a scene in space, as plain data;
//! 14. [`report`], [`exchange`]: what an expert signs: a document of a case and its answers, as PDF,
//!     Markdown and JSON; scenes and motions for other programs;
//! 15. `render` (feature `gui`): one drawing function for the window and for pictures without a
//!     window;
//! 16. [`cli`] and `app` (feature `gui`): the command line and the window.
//!
//! This example simulates a vehicle that drives at 20 m/s with an initial yaw rate of 2 rad/s:
//!
//! ```
//! use impactlab::vehicle::{Integrator, Manoeuvre, Preset, VehicleState};
//!
//! let manoeuvre = Manoeuvre {
//!     initial: VehicleState { yaw_rate_rad_s: 2.0, ..VehicleState::driving_straight(20.0) },
//!     duration_s: 4.0,
//!     ..Manoeuvre::default()
//! };
//! let motion = Preset::Reference.parameters().simulate(&manoeuvre, Integrator::Rk4)?;
//! assert_eq!(motion.series.n_samples(), 401);
//! # Ok::<(), impactlab::vehicle::SimulationError>(())
//! ```

pub mod analysis;
#[cfg(feature = "gui")]
pub mod app;
pub mod bibliography;
pub mod case_file;
pub mod cli;
pub mod collision;
pub mod compare;
pub mod data;
mod error_chain;
pub mod exchange;
pub mod figure;
pub mod force;
pub mod jobs;
pub mod learning;
pub mod nn;
pub mod numerics;
pub mod ranges;
pub mod reconstruct;
#[cfg(feature = "gui")]
pub mod render;
pub mod report;
pub mod response;
pub mod scene;
pub mod shipped;
pub mod site;
pub mod study;
pub mod uncertainty;
pub mod units;
pub mod vehicle;

pub use error_chain::error_chain;

/// Version of the program and, behind the plus sign, the start of the SHA-256 of the source that it was
/// compiled from (`build.rs`): `0.1.0+0123456789ab`. Every answer, file of results and report names it,
/// and unfinished work of another build is not gone on with.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "+", env!("IMPACTLAB_SOURCE"));
