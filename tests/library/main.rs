//! Tests of the core library through its public interface, with the shipped data and with bad
//! input.
//!
//! All tests are in one program, because each test program would link all libraries again.

mod any_car;
mod atlas_check;
mod case_file;
mod case_package;
mod cost_growth;
mod data_bad_input;
mod data_budgets;
mod data_corrections;
mod data_dialects;
mod data_foreign;
mod data_import;
mod data_loggers;
mod data_maps;
mod data_quality;
mod data_shipped;
mod data_solver_bodies;
mod data_solver_speeds;
mod data_solvers;
mod data_writes;
mod dependencies;
mod endings;
mod evidence_guide;
mod exchange;
mod fleet;
mod force_baselines;
mod force_domain;
mod force_model;
mod hand_published;
mod measurements;
mod model_budgets;
mod ranges;
mod report;
mod report_german;
mod report_opinion;
mod report_pdf;
mod report_pictures;
mod report_reconstruction;
mod report_stills;
mod report_tables;
mod response_model;
mod solver_files;
mod validation_collision;
mod vehicle;
