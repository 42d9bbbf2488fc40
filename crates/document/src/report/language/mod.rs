//! The languages of a report: each has one file.

mod words;

mod en;

mod de;

mod de_terms;

mod de_sources;

mod de_training;

mod look_up;

pub(super) use look_up::{given_name_of, phrase_of, words_of};
pub(super) use words::Words;
