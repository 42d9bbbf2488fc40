//! Files become checked time series in SI units here, and series become files.

mod channel;
mod force_history;
mod series;

pub use channel::Channel;
pub use force_history::{CumulativeImpulse, ForceAxes, ForceHistory, Sampling};
pub use series::{SeriesError, TimeSeries};
