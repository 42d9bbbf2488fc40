//! An option that belongs to another one is refused where something else is given that excludes the other one.
//!
//! clap does not miss a required option that conflicts with one that is there, so that each of these was read and
//! did nothing.

use crate::program::program;

const TRAJECTORY: &str = "datasets/trajectories-fea/trajectories/FE_c001.csv";
const LOGGED: [&str; 5] = ["fine-tune", "response", "--out", "x", "--data"];

#[test]
fn an_option_without_the_one_that_it_belongs_to_is_refused_by_its_name() {
    let drive = ["simulate", "--speed", "15"];
    let recorded = ["simulate", "--trajectory", TRAJECTORY];
    let scenario = ["simulate", "--scenario", "pit-right-rear"];
    let dataset = ["simulate", "--dataset", "datasets/trajectories-fea"];
    let predict = ["predict", "--out", "x", "--scenario", "pit-right-rear"];
    let predict_case = ["predict", "--out", "x", "--dataset", "datasets/fea", "--case", "c001"];
    let predict_record = ["predict", "--out", "x", "--trajectory", TRAJECTORY];
    let predict_force = ["predict", "force", "--scenario", "pit-right-rear"];
    let logged = [&LOGGED[..], &["datasets/fea", "--vehicle", "reference-2000"]].concat();
    let drive_of_log = ["condition", "response", "--out", "x", "--vehicle", "reference-2000"];
    let drive_of_log = [&drive_of_log[..], &["--log", "log.csv", "--no-impact"]].concat();
    let chunk = ["sweep", "run", "folder", "--chunk", "1"];
    let (start, map) = (["--brake-start", "1"], "time=1:s");
    for (command, option) in [
        (&drive[..], &["--one-contact"][..]),
        (&recorded, &["--one-contact"]),
        (&dataset, &["--one-contact"]),
        (&drive, &["--case", "c001"]),
        (&recorded, &["--case", "c001"]),
        (&scenario, &["--case", "c001"]),
        (&drive, &["--map", map]),
        (&recorded, &["--sampling", "instant"]),
        (&[&drive[..], &["--steer-angle", "3deg"]].concat(), &["--steer-map", map]),
        (&[&drive[..], &["--coast"]].concat(), &start),
        (&[&drive[..], &["--coast"]].concat(), &["--abs"]),
        (&predict, &["--case", "c001"]),
        (&predict, &["--map", map]),
        (&predict, &["--contact", "1,0,0.5"]),
        (&[&predict[..], &["--given-force"]].concat(), &["--force-map", map]),
        (&[&predict[..], &["--force-model", "shipped"]].concat(), &["--force-map", map]),
        (&predict_case, &["--site", "site.toml"]),
        (&predict_case, &["--one-contact"]),
        (&predict_case, &["--bullet", "bullet-2000"]),
        (&predict_case, &["--contact", "1,0,0.5"]),
        (&predict_record, &["--site", "site.toml"]),
        (&predict_record, &["--one-contact"]),
        (&predict_record, &["--bullet", "bullet-2000"]),
        (&predict_record, &["--case", "c001"]),
        (&predict_force, &["--case", "c001"]),
        (&logged, &["--force", "force.csv"]),
        (&logged, &["--no-impact"]),
        (&logged, &["--impact", "1"]),
        (&logged, &["--duration", "2"]),
        (&drive_of_log, &["--contact", "1,0,0.5"]),
        (&drive_of_log, &["--force-map", map]),
        (&chunk, &["--stride", "2"]),
    ] {
        let args = [command, option].concat();
        let output = program().args(&args).output().expect("the program can be started");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{args:?}: {text}");
        assert!(text.contains(option[0]), "{args:?}: {text}");
    }
    // The cases of a data set are simulated by another question, which has no drawn vehicles.
    let draws = [&dataset[..], &["--vehicle-draws", "5"]].concat();
    let output = program().args(&draws).output().expect("the program can be started");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && text.contains("leave out --vehicle-draws"), "{text}");
}
