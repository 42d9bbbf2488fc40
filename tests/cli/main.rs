//! Tests of the command line: help, exit codes, JSON keys, errors and results.
//!
//! All tests are in one program, because each test program would link all libraries again.

mod answers;
mod atlas;
mod badges;
mod both_vehicles;
mod budgets;
mod closed_pipe;
mod commands;
mod contact;
mod contradictions;
mod controls;
mod data_sheets;
mod endings;
mod export;
mod film;
mod force;
mod ground;
mod guide;
mod hand;
mod help;
mod import;
mod import_ground;
mod inputs;
mod kinds;
mod log;
mod maps;
mod motion;
mod pairs;
mod program;
mod ranges;
mod reconstruct;
mod reconstruct_absurd;
mod reconstruct_inline;
mod reconstruct_killed;
mod reconstruct_single_car;
mod replay;
mod replays;
mod report;
mod response;
mod restrictions;
mod staged;
mod sweep;
mod trust;
mod writes;
mod writes_killed;
