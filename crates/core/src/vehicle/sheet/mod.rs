//! The data sheet of any car: what an analyst knows of it, published rules with their scatter for
//! what nobody knows, and the parameters of the 4DOF vehicle that follow, with their uncertainty.

mod quantity;
mod rules;

mod data_sheet;
mod derive;
mod file;
mod write;

mod library;
mod unusual;

pub use data_sheet::{DataSheet, Estimate};
pub(super) use derive::AIR_DENSITY_KG_M3;
pub use library::LibraryVehicle;
pub use quantity::{SheetQuantity, VehicleClass};
pub use rules::{Rule, Scatter};
pub use unusual::Unusual;
