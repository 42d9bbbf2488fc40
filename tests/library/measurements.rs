//! Error rates that answers and reports state are those of this build and of the data beside it.

use std::path::Path;

use impactlab_core::numerics::sha256_hex;
use impactlab_study::{Measurement, Measurements};

#[path = "../../examples/validation/probes.rs"]
mod probes;

const AGAIN: &str = "measure it again: cargo run --release --example validation";

#[test]
fn measurements_were_made_with_the_data_that_are_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for measurement in Measurements::shipped() {
        let found = probes::data_sha256(root, &measurement.data).expect("the data");
        assert_eq!(found, measurement.data_sha256, "{:?}; {AGAIN}", measurement.subject);
    }
}

/// The digest followed the order in which the file system listed a folder, so that the same data had another one
/// on another machine.
#[test]
fn a_digest_of_data_does_not_depend_on_the_order_of_their_folder() {
    let digest = |names: [&str; 3]| {
        let root = tempfile::tempdir().expect("a folder");
        let folder = root.path().join("data");
        std::fs::create_dir(&folder).expect("made");
        for name in names {
            std::fs::write(folder.join(name), name).expect("written");
        }
        probes::data_sha256(root.path(), &["data".to_owned()]).expect("the data")
    };
    let by_hand =
        ["a", "b", "c"].map(|name| format!("data/{name}\n{}\n", sha256_hex([name.as_bytes()])));
    let by_hand = sha256_hex(by_hand.iter().map(String::as_bytes));
    assert_eq!(digest(["c", "a", "b"]), by_hand);
    assert_eq!(digest(["b", "c", "a"]), by_hand);
}

/// A change of the program that moves numbers moves these: the report said 0.890 m where the model erred
/// by 0.649 m.
#[test]
fn measurements_were_made_with_a_program_that_computes_the_same() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for Measurement { subject, probe, .. } in Measurements::shipped() {
        let found = probes::probe(root, *subject).expect("numbers");
        assert!(found.keys().eq(probe.keys()), "{subject:?}: {found:?}");
        for (name, value) in &found {
            let stated = probe[name];
            let is_same = (value - stated).abs() <= 1e-3 * stated.abs() + 1e-9;
            assert!(is_same, "{subject:?}, {name}: {value}, stated {stated}; {AGAIN}");
        }
    }
}
