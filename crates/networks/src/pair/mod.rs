//! Two vehicles with all contacts between them, to the end: whole draws of what is not known.
//!
//! The contact is that of [`impactlab_core::collision::contact`]: it begins, lasts, ends and begins anew
//! as the motions have it. While the vehicles are apart after their first contact, a response network may
//! correct both; while they push each other the equations of motion stand alone, since no network has
//! learned from such motions.
//!
//! - `scatter`: what is not known of two vehicles, and its draws;
//! - `forecast`: the motions of all draws;
//! - `outcome`: courses of events, contacts, regions;
//! - `evaluate`: how far a forecast lies from a recorded pair;
//! - `twins`: what stability control changes, forecast and recorded.

mod evaluate;
mod forecast;
mod outcome;
mod scatter;
mod twins;

pub use evaluate::{
    Compared, Coverage, EvaluatedPair, PairSummary, VehicleScore, VehicleSummary, evaluate_pair,
};
pub use forecast::{
    DrawnVehicle, PairDraw, PairForecast, PairQuestion, PairSettings, forecast_pair,
};
pub use outcome::{Course, CourseShare};
pub use scatter::PairScatter;
pub use twins::{
    ByControl, EvaluatedTwins, RecordedAndForecast, SavedCounts, TwinOutcome, TwinSummary,
};
