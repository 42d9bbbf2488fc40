//! What can be asked, and how it is answered: questions and what they refer to, their checks, the
//! models and data in memory, errors, cost.

pub(crate) mod answer;
pub(crate) mod checks;
pub(crate) mod cost;
pub(crate) mod error;
pub(crate) mod finite;
pub(crate) mod inputs;
pub(crate) mod library;
pub(crate) mod provenance;
pub(crate) mod question;
pub(crate) mod request;
pub(crate) mod schema;
pub(crate) mod word;
