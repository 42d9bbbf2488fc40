//! What physics and regressions say of a collision: the curve in the centre, around which the
//! network learns, and what it leaves over on cases that it has not seen.

mod momentum;

mod bare;

pub mod regression;

mod centre;
mod committee;
mod crush_laws;

mod residuals;

pub(crate) use bare::BareForce;
pub use bare::{
    DIRECTION_STD_RAD as MOMENTUM_DIRECTION_STD_RAD, IMPULSE_LOG_STD as MOMENTUM_IMPULSE_LOG_STD,
};
#[cfg(test)]
pub(crate) use centre::tests::haversine_centre;
pub use centre::{CentreCurve, CentreModel};
pub(crate) use crush_laws::Bodies;
pub use momentum::MomentumModel;
pub(crate) use residuals::{DURATION_UNIT_S, ResidualModel};
