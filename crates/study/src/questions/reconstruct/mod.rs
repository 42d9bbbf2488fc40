//! From the evidence to the speeds before the collision.

pub(crate) mod assumed;
mod badges;
mod cut_off;
pub(crate) mod evidence_choice;
mod impact_place;
pub(crate) mod later_contacts;
mod particle_columns;
pub(crate) mod paths;
mod progress;
pub(crate) mod request;
mod single_car;
mod tried;
