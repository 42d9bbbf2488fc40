//! Every format that the program reads, given broken and hostile files: one test for each.
//!
//! The kept files of `corpus/FORMAT/` are read first, then files that are made from them by
//! mutation. A fault is a panic, a stack that overflows, more than [`harness::LONGEST`] of
//! computing, more memory than [`harness::memory_limit_bytes`], an accepted file whose values are
//! not finite, and an error that lacks the name of the file, names a line beyond it or is longer than
//! a person reads. A file with a fault is kept, and its path is printed.
//!
//! Beside them, collisions at random are put through the questions that are asked about one.
//!
//! `CONTRIBUTING.md` says how to run a format for hours.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "what a run of hours has done")]

mod archives;
mod ground;
mod harness;
mod json_files;
mod models;
mod mutation;
mod recorded;
mod scenarios;
mod sealed;
mod solvers;
mod tables;
mod texts;
mod toml_files;
