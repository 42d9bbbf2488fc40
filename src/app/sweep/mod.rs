//! Sweeps in the window: one question many times, computed in chunks into a folder of the user. The pane
//! Sweep shows them.

mod command;
mod session;
mod update;
mod work;

pub use command::SweepCommand;
pub use session::{KnownSweep, ReadSweep, SweepSession, SweepView, TimedRows};
