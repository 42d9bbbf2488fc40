//! What is found after a collision, and how well each item of it is known.
//!
//! An item is one file: its fields with key, range, default and mirror image, and what it says of a motion.
//! [`Evidence::items`] lists the items. Files, forms, reports and pictures are visitors of the fields.

mod after;
mod car;
mod complete;
mod damage;
#[cfg(test)]
pub(crate) mod examples;
mod field;
mod items;
mod kind;
mod mark;
mod mirror;
mod odd;
mod odd_copy;
mod odd_course;
mod odd_distance;
mod odd_drag;
mod odd_rest;
mod places;
mod position;
mod prior_ranges;
mod read;
mod recorder;
mod rest;
mod road;
mod skid;
mod speed;
mod start;
mod visit;
mod weighing;
mod write;

pub use after::{After, YesNoUnknown};
pub use car::{
    CarEvidence, DEFAULT_MASS_SHARE, SINGLE as SINGLE_CAR, STRIKING as STRIKING_CAR,
    STRUCK as STRUCK_CAR,
};
pub use damage::Damage;
pub use field::{Bounds, Choice, Field, Measured, Sigma, Stated, Word, ends};
pub use items::Evidence;
pub use kind::EvidenceKind;
pub use mark::{Mark, MarkKind};
pub use places::FoundPlace;
pub use position::VideoPosition;
pub use prior_ranges::PriorRanges;
pub use recorder::{Edr, RECORDED_SPEED_SHARE};
pub use rest::{RestPose, StoppedBy};
pub use road::{DEFAULT_FRICTION, DEFAULT_FRICTION_SIGMA, Road};
pub use skid::SkidBefore;
pub use speed::RecordedSpeed;
pub use start::Start;
pub use visit::{Fields, Group, Item, Items, PlaceMut, PointsMut, Section};
pub use weighing::Weighing;
