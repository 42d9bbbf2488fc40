//! The command line as its users see it: help, exit codes, JSON keys, errors, results.
//!
//! One program: each test program of its own would link everything anew.

mod closed_pipe;
mod commands;
mod force;
mod guide;
mod log;
mod program;
mod response;
