//! One room for each kind of question.

pub(crate) mod check;
pub(crate) mod evaluate;
pub(crate) mod hand;
pub(crate) mod impact;
pub(crate) mod predict;
pub(crate) mod reconstruct;
pub(crate) mod recorded_pair;
pub(crate) mod replay;
pub(crate) mod simulate;
pub(crate) mod train;
