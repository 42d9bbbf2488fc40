//! Calibrates anew how wide the regions of cars are that a response network has not seen, from the
//! trajectories that it has learned from; the network stays as it is.
//!
//! The arguments are the model, the file that is written, and trajectory data sets or folders of them, as
//! `impactlab fine-tune response --fleet` had them. Trajectories that the model has not learned from are
//! left alone, so that they can judge the result. It prints the widths before and after.
//!
//! ```text
//! cargo run --release --example calibrate_response -- assets/models/response.safetensors \
//!     calibrated.safetensors datasets/trajectories-fleet datasets/trajectories-cars
//! ```

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use impactlab_core::data::{CASES_FILE, Existing, Outcome, check_target};
use impactlab_networks::learning::{ModelFile, TrainingReport};
use impactlab_networks::response::{ResponseCase, ResponseModel, recalibrate};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, out, folders @ ..] = &arguments[..] else {
        return Err("expected: MODEL OUT DATA_SET…".into());
    };
    let out = Path::new(out);
    check_target(out, Existing::Refuse)?;
    let mut model = ResponseModel::load(Path::new(model))?;
    let mut cases = Vec::new();
    for folder in folders {
        let sets = data_sets(Path::new(folder))?;
        if sets.is_empty() {
            return Err(format!("{folder}: no data set in it").into());
        }
        for set in sets {
            let go_on = &mut |_| ControlFlow::Continue(());
            if let Outcome::Complete(of_set) = ResponseCase::load_all(&set, None, go_on)? {
                cases.extend(of_set);
            }
        }
    }
    println!("before: {:?}", model.population().map(|population| population.widths()));
    let mut done = 0;
    let mut report = |report: &TrainingReport| {
        if let TrainingReport::Fit(fit) = report {
            let percent = 100 * fit.done / fit.n_steps.max(1);
            if percent > done {
                done = percent;
                eprintln!("{percent} %: {fit}");
            }
        }
        ControlFlow::Continue(())
    };
    recalibrate(&mut model, &cases, &mut report)?;
    println!("after: {:?}", model.population().map(|population| population.widths()));
    model.save(out, Existing::Refuse)?;
    Ok(())
}

/// The data set that a folder is, or those in it by their names.
fn data_sets(folder: &Path) -> Result<Vec<PathBuf>, std::io::Error> {
    let is_set = |path: &PathBuf| path.join(CASES_FILE).is_file();
    if is_set(&folder.to_owned()) {
        return Ok(vec![folder.to_owned()]);
    }
    let entries = std::fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    let mut sets: Vec<PathBuf> =
        entries.into_iter().map(|entry| entry.path()).filter(is_set).collect();
    sets.sort();
    Ok(sets)
}
