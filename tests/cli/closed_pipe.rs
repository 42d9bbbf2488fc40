//! Commands whose output is no longer read, as after `| head -1`, end without a panic.

use std::io::{BufRead, BufReader};
use std::process::Stdio;

use crate::program::{SCENARIO, TRAJECTORIES, closed_pipe, program};

const FORCE: &str = "datasets/fea/forces/c001.csv";

/// Commands of each kind with much, little and no output, and their exit codes when all output is
/// read.
const COMMANDS: &[(&[&str], i32)] = &[
    (&["--help"], 0),
    (&["--version"], 0),
    (&["train", "force", "--help"], 0),
    (&["no-such-command"], 2),
    (&["check", "datasets", "--all", "--json"], 0),
    (&["check", FORCE, "--json"], 0),
    (&["check", "no/such/file.csv"], 1),
    (&["impact", SCENARIO], 0),
    (&["simulate", "--vehicle", "reference-2000", "--speed", "20", "--force", FORCE], 0),
    (&["simulate", "--dataset", TRAJECTORIES, "--json"], 0),
    (&["train", "force", "--data", "x", "--out", "y", "--print-config"], 0),
    (&["train", "response", "--data", "x", "--out", "y", "--print-config"], 0),
    (&["fine-tune", "response", "--data", "x", "--out", "y", "--print-config"], 0),
    (&["predict", "force", "--scenario", SCENARIO], 0),
    (&["vehicles"], 0),
    (&["vehicles", "reference-2000", "--json"], 0),
];

#[test]
fn no_command_panics_when_its_output_is_closed() {
    for (args, code) in COMMANDS {
        let closed_out = program().args(*args).stdout(closed_pipe()).output().unwrap();
        let message = String::from_utf8(closed_out.stderr).unwrap();
        assert!(!message.contains("panicked"), "{args:?}: {message}");
        let ended = closed_out.status.code().unwrap();
        match code {
            0 => assert_eq!((ended, message.as_str()), (0, ""), "{args:?}"),
            // A command that fails to write what it found may also exit with 0.
            _ => assert!([0, *code].contains(&ended), "{args:?}: {ended}"),
        }

        let closed_err = program().args(*args).stderr(closed_pipe()).output().unwrap();
        assert_eq!(closed_err.status.code(), Some(*code), "{args:?}");
    }
}

#[test]
fn a_reader_may_stop_after_the_first_line() {
    for args in [&["check", "datasets/fea", "--all", "--json"][..], &["vehicles", "target-2000"]] {
        let mut child =
            program().args(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut first = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut first).unwrap();
        assert!(!first.is_empty(), "{args:?}");
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}");
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "", "{args:?}");
    }
}
