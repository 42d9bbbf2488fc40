//! Reports as a person reads them.

mod facts;
mod trained;

pub(super) use facts::{PrintedAnswer, print_answer};
pub(super) use trained::print_trained;
