//! What an answer rests on and what restricts it.

pub(crate) mod assumption;
pub(crate) mod badges;
pub(crate) mod trust;
pub(crate) mod unused;
