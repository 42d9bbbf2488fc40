//! What an answer rests on and what restricts it.

pub(crate) mod assumed;
pub(crate) mod bodies;
pub(crate) mod covered;
pub(crate) mod domain;
pub(crate) mod driver;
pub(crate) mod few_draws;
pub(crate) mod other_vehicle;
pub(crate) mod restrictions;
pub(crate) mod unused;
