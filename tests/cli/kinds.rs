//! Files that are not what a command needs: each is called what it is, by its name.

use std::fs;

use tempfile::TempDir;

use crate::answers::write;
use crate::commands::impactlab;
use crate::program::{SCENARIO, text};

/// An answer was "a comparison of response networks" that lacks the field `data`, an empty file "neither
/// evidence nor a scenario", and a missing one was "read as a table of time series".
#[test]
fn a_check_says_what_an_answer_an_empty_and_a_missing_file_are() {
    let folder = TempDir::new().unwrap();
    let answer = write(&folder, "answer.json", &impactlab(&["impact", SCENARIO, "--json"]).out);
    let empty = write(&folder, "empty.toml", "\n");
    let missing = folder.path().join("missing.csv");
    for (path, words) in [
        (&answer, "is neither a question (as --print-request writes it)"),
        (&empty, "empty.toml: is empty\n"),
        (&missing, "missing.csv: does not exist; check the name\n"),
    ] {
        let ran = impactlab(&["check", text(path)]);
        assert!(ran.out.contains(words), "{words}: {}", ran.out);
        assert!(!ran.out.contains("read as"), "{}", ran.out);
    }
}

/// What is no text was "invalid utf-8 sequence of 1 bytes", whatever it was.
#[test]
fn what_is_asked_of_a_file_of_another_kind_is_refused_by_its_kind() {
    let folder = TempDir::new().unwrap();
    let picture = folder.path().join("photo.png");
    fs::write(&picture, b"\x89PNG\r\n\x1a\n\0\xff").unwrap();
    let bytes = folder.path().join("bytes.json");
    fs::write(&bytes, b"ab\xff").unwrap();
    for (path, words) in [
        (text(&picture), "photo.png: is an orthophoto, expected a question"),
        (SCENARIO, "is a scenario, expected a question"),
        (text(&bytes), "it is not UTF-8 text from byte 3 on"),
    ] {
        let refused = impactlab(&["ask", path]);
        assert!(refused.error_line().contains(words), "{words}: {}", refused.err);
    }
}
