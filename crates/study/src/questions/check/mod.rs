//! What is in files, and what is wrong with them.

pub(crate) mod report;
pub(crate) mod request;
