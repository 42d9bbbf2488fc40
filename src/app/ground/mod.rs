//! The ground of the scene: the site that was opened, and where its orthophoto was put.

mod cloud;
mod command;
mod session;
mod update;

pub use cloud::{CloudForm, MadeGround};
pub use command::GroundCommand;
pub use session::GroundSession;
