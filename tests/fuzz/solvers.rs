//! Results of finite-element solvers: text, LSDA and records of Fortran.

use std::path::Path;

use impactlab_core::data::{ColumnMap, Table, check_series, read_any_series};

use crate::harness::{Answer, Format, run};
use crate::mutation::Mutator;

/// Reads a file as it is, which asks for its units, and with units.
fn load(path: &Path) -> Answer {
    let map: ColumnMap = "deck=t-mm-s".parse().expect("a map");
    let asked = match Table::read(path).and_then(|_| read_any_series(path, None)) {
        Ok(_) => None,
        Err(error) => Some(impactlab_core::error_chain(&error)),
    };
    let answer = match read_any_series(path, Some(&map)) {
        Ok(loaded) => {
            check_series(&loaded.series, loaded.force_sampling());
            Answer::accepted(&(&loaded, loaded.series.time_s()))
        }
        Err(error) => Answer::refused(&error),
    };
    let messages = answer.messages.iter().cloned().chain(asked).collect();
    Answer { messages, ..answer }
}

fn solver_format(name: &'static str, file_name: &'static str) {
    run(&Format {
        name,
        n_inputs: 3_000,
        file_name,
        names_file: true,
        seeds: Vec::new(),
        mutate: Mutator::text,
        load: &load,
    });
}

#[test]
fn forces_of_contacts() {
    solver_format("rcforc", "rcforc");
}

#[test]
fn motions_of_nodes() {
    solver_format("nodout", "nodout");
}

#[test]
fn forces_of_sections() {
    solver_format("secforc", "secforc");
}

#[test]
fn binary_containers_of_ls_dyna() {
    solver_format("binout", "binout0000");
}

#[test]
fn time_histories_of_radioss() {
    solver_format("t01", "runT01");
}
