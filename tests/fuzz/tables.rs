//! Delimited text: forces, motions, steer angles, logs, and tables of cases.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::data::{
    Dataset, Loaded, Opened, Outcome, ReadSettings, check_case, check_series, contact_interval,
    open, propose_columns, read_force_file, read_motion_log, read_steer_file, read_trajectory_file,
    read_wheels_file,
};
use impactlab_core::error_chain;
use impactlab_core::vehicle::Preset;
use impactlab_networks::force::ForceCase;
use impactlab_networks::response::ResponseCase;

use crate::harness::{Answer, Format, run};
use crate::mutation::Mutator;

/// How many files of a time series are tried, and their name.
const SERIES: (u64, &str) = (4_000, "file.csv");

/// What a file of a time series holds, and what is made of it at once: flags, force, contact.
fn series(loaded: &Loaded) -> Answer {
    let (series, sampling) = (&loaded.series, loaded.force_sampling());
    check_series(series, sampling);
    let answer = Answer::accepted(&(loaded, series.time_s()));
    match impactlab_core::data::ForceHistory::from_series(series, sampling) {
        Ok(force) => {
            let impulse = force.cumulative();
            answer.and(&(impulse, force.impulse_n_s(), contact_interval(&force)))
        }
        Err(_) => answer,
    }
}

/// Tries a loader of delimited text.
///
/// - `file_name`: where the file lies in the folder that it is read from.
fn text_format(
    name: &'static str,
    (n_inputs, file_name): (u64, &'static str),
    load: &dyn Fn(&Path) -> Answer,
) {
    let (seeds, mutate) = (Vec::new(), Mutator::text);
    run(&Format { name, n_inputs, file_name, names_file: true, seeds, mutate, load });
}

fn series_format(
    name: &'static str,
    load: fn(&Path) -> Result<Loaded, impactlab_core::data::DataError>,
) {
    text_format(name, SERIES, &|path| match load(path) {
        Ok(loaded) => series(&loaded),
        Err(error) => Answer::refused(&error),
    });
}

#[test]
fn force_files() {
    series_format("force", |path| read_force_file(path, None));
}

#[test]
fn trajectory_files() {
    series_format("trajectory", |path| read_trajectory_file(path, None));
}

#[test]
fn steer_files() {
    series_format("steer", |path| read_steer_file(path, None));
}

#[test]
fn files_of_wheel_torques() {
    series_format("wheels", |path| read_wheels_file(path, None));
}

#[test]
fn logs_of_motions() {
    series_format("log", |path| read_motion_log(path, None));
}

#[test]
fn files_of_unknown_kind() {
    text_format("any-series", SERIES, &|path| {
        let mut go_on = |_| ControlFlow::Continue(());
        let proposed = propose_columns(path, &ReadSettings::default());
        match open(path, &mut go_on) {
            Ok(Outcome::Complete(Opened::File(loaded))) => series(&loaded).and(&proposed),
            Ok(other) => panic!("a file is opened as {other:?}"),
            Err(error) => Answer::refused(&error),
        }
    });
}

/// Loads the data set around a table of cases, with files for the cases `a`, `b` and `c`.
fn cases_format(name: &'static str, folder: &'static str, file_name: &'static str) {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/cases").join(folder);
    let vehicle = Preset::Reference.parameters();
    let load = |path: &Path| {
        let root = path.parent().expect("a table of cases lies in a folder");
        let files = root.join(folder);
        if !files.exists() {
            fs::create_dir(&files).expect("a folder for the cases");
            for case in ["a.csv", "b.csv", "c.csv"] {
                fs::copy(example.join(case), files.join(case)).expect("the case can be copied");
            }
        }
        let mut go_on = |_| ControlFlow::Continue(());
        let dataset = match Dataset::load(root, &mut go_on) {
            Ok(dataset) => dataset.complete().expect("nothing cancels"),
            Err(error) => return Answer::refused(&error),
        };
        let mut answer = Answer { is_accepted: !dataset.cases.is_empty(), ..Answer::default() };
        answer.messages.extend(dataset.problems.iter().map(|problem| error_chain(problem)));
        for case in &dataset.cases {
            check_case(case);
            let attributes: Vec<_> = case.attributes.iter().collect();
            answer = answer.and(&attributes);
            if let Ok(case) = ForceCase::from_case(case) {
                answer = answer.and(&case);
            }
            if let Ok(case) = ResponseCase::from_case(case, &vehicle) {
                answer = answer.and(&case);
            }
        }
        if !answer.is_accepted && answer.messages.is_empty() {
            answer.messages.push(format!("{}: has no case", path.display()));
        }
        answer
    };
    text_format(name, (1_500, file_name), &load);
}

#[test]
fn tables_of_force_cases() {
    cases_format("force-cases", "forces", "data/cases.csv");
}

#[test]
fn tables_of_trajectories() {
    cases_format("trajectory-cases", "trajectories", "data/cases.csv");
}
