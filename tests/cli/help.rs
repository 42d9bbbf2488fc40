//! The help of a command names every key of its answer.

use tempfile::TempDir;

use crate::program::{SCENARIO, answer, ok, program, text};

/// The list of `predict` lacked 6 of 24 keys.
#[test]
fn the_help_names_every_key_of_an_answer() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let braked = ["simulate", "--vehicle", "toyota-camry-2018", "--speed", "20", "--brake", "1.5"];
    let questions: [(&[&str], &[&str]); 4] = [
        (&["impact"], &["impact", SCENARIO]),
        (&["predict", "force"], &["predict", "force", "--scenario", SCENARIO]),
        (&["simulate"], &braked),
        (&["predict"], &["predict", "--scenario", SCENARIO, "--draws", "2", "--out", text(&out)]),
    ];
    for (command, question) in questions {
        let help = ok(program().args(command).arg("--help").output().unwrap());
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let words: Vec<&str> = help.split(|c| !is_part(c)).collect();
        let report = answer(question);
        for key in report.as_object().unwrap().keys() {
            assert!(words.contains(&key.as_str()), "{command:?}: the help has no {key}");
        }
    }
}
