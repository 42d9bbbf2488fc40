//! Results of finite-element solvers: text, LSDA and records of Fortran.

use std::fs;
use std::path::Path;

use impactlab_core::data::{ColumnMap, Table, check_series, read_any_series};

use crate::harness::{Answer, Format, run};
use crate::mutation::Mutator;

/// The force of a run beside which its momenta are: 4800 N s.
const FORCES: &str = " a run
  slave 3 time 0.00 x 0.0 y 0.0 z 0.0
  slave 3 time 0.02 x 1.5E+05 y 5.0E+04 z 0.0
  slave 3 time 0.04 x 9.0E+04 y 3.0E+04 z 0.0
  slave 3 time 0.06 x 0.0 y 0.0 z 0.0
";

/// Reads a file as it is, which asks for its units, and with units.
fn load(path: &Path) -> Answer {
    load_as(path, "deck=t-mm-s")
}

/// Reads a file as it is, and with a map.
fn load_as(path: &Path, map: &str) -> Answer {
    let map: ColumnMap = map.parse().expect("a map");
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
    run(&format(name, file_name, &load));
}

fn format<'a>(
    name: &'static str,
    file_name: &'static str,
    load: &'a dyn Fn(&Path) -> Answer,
) -> Format<'a> {
    Format {
        name,
        n_inputs: 3_000,
        file_name,
        names_file: true,
        seeds: Vec::new(),
        mutate: Mutator::text,
        load,
    }
}

#[test]
fn forces_of_contacts() {
    solver_format("rcforc", "rcforc");
}

#[test]
fn motions_of_nodes() {
    solver_format("nodout", "nodout");
}

/// The first body, which begins with its car along x.
#[test]
fn motions_of_rigid_bodies() {
    let load = |path: &Path| load_as(path, "deck=t-mm-s,sheet=2");
    run(&format("rbdout", "rbdout", &load));
}

/// What is wrong with momenta is said of the force beside them, which is read.
#[test]
fn momenta_of_parts() {
    let load = |path: &Path| {
        let forces = path.with_file_name("rcforc");
        if !forces.exists() {
            fs::write(&forces, FORCES).expect("the file can be written");
        }
        let map: ColumnMap = "deck=kg-m-s,sheet=1".parse().expect("a map");
        let loaded = read_any_series(&forces, Some(&map)).expect("the force is read");
        let doubts = loaded.notes.iter().filter(|note| note.is_doubt());
        let messages = doubts.map(ToString::to_string).collect();
        Answer { messages, ..Answer::accepted(&(&loaded, &loaded.model_start)) }
    };
    run(&Format { names_file: false, ..format("matsum", "matsum", &load) });
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
