//! Reconstruction: from the evidence of a collision back to the speeds before it, as a distribution.
//!
//! ```text
//! p(z | E) ∝ N(z; 0, I) · Π_i p(E_i | motion(z))
//! ```
//!
//! - [`evidence`]: what was found, from a file;
//! - `cars`: the two vehicles, from data sheets and evidence;
//! - [`domain`]: vehicles, roads and damage that a reconstruction is not made for;
//! - `latent`: the quantities that the motion depends on;
//! - `prior`: every quantity that the motion depends on, as a transformation of one component of z;
//! - `forward`: from z to the motion of both cars, or of a `single_car`; `later_contact`: where they meet
//!   again;
//! - `likelihood`: how well a motion goes with the evidence;
//! - [`sampler`]: draws from the posterior;
//! - `point_optimum`: the most probable point with its curvature, which it is compared with;
//! - [`hand`]: what one computes by hand: methods that are asked, the baseline, independent checks;
//! - [`evaluate`]: how well all of these do on staged collisions, of which the truth is known.

pub mod domain;
pub mod evaluate;
pub mod evidence;
pub mod hand;
pub mod sampler;

mod budget;
mod calibration;
mod cars;
mod computed_marks;
mod distribution;
mod forward;
mod held_wheels;
mod hinges;
mod impact_state;
mod latent;
mod later_contact;
mod left_out;
mod likelihood;
mod modes;
mod point_optimum;
mod posterior;
mod prior;
mod quantity;
mod single_car;
mod skid;

pub use budget::Narrowing;
pub use calibration::{RankedQuantity, Ranks, ranks_of_cases};
pub use cars::{Car, Cars};
pub use computed_marks::MarkComparison;
pub use distribution::Distribution;
pub use forward::{CollisionMotion, ForwardModel, StrikingMotion};
pub use hand::{HandCalculation, HandCheck, HandSpeed};
pub use hinges::{HingeInput, SpeedChange, SpeedHinge};
pub use impact_state::ImpactState;
pub use latent::{
    ANTI_LOCK_PROBABILITY, BLOCKED_PROBABILITY, BRAKE_PROBABILITY, Latent, LatentValues,
    PUSH_PROBABILITY, STRIKING_BRAKES, STRIKING_BRAKES_BEFORE,
};
pub use left_out::LeftOut;
pub use likelihood::{ComparedBy, Discrepancy, EvidenceFit, EvidenceTerm, ReconstructionTarget};
pub use point_optimum::{OptimumSettings, PointOptimum};
pub use posterior::{BudgetItem, LEAST_ESS_FOR_INTERVALS, Mode, Posterior};
pub use prior::{Prior, PriorComponent, PriorSource};
pub use quantity::{QuantityEstimate, ReconstructedQuantity};
