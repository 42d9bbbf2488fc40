//! Writers that are killed at random moments: what they were replacing is whole, old or new, and the
//! next write leaves nothing of them behind.
//!
//! `KILLS=200 ./test --test cli writes_killed` kills as often as the number says.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use impactlab_core::data::write::{FileDigest, OutputFolder, RunRecord};
use impactlab_core::data::{Existing, write_atomically};
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use tempfile::TempDir;

use crate::program::names;

/// Size of the file that is written over and over, bytes: written in about the time that bringing
/// it to the disk takes.
const SIZE: usize = 1 << 20;

/// Kills in the tests of the gate.
const KILLS: usize = 20;

/// Latest moment of a kill after the first file is there; each write takes a few milliseconds.
const LATEST: Duration = Duration::from_millis(60);

/// Names the folder into which the killed process writes.
const FOLDER: &str = "IMPACTLAB_KILLED_WRITER";

fn n_kills() -> usize {
    std::env::var("KILLS").map_or(KILLS, |text| text.parse().unwrap())
}

fn folder_of_writer() -> PathBuf {
    std::env::var_os(FOLDER).expect("is run by another test").into()
}

/// A whole content: one letter, as often as the file is long.
fn content(n: usize) -> Vec<u8> {
    vec![b'a' + u8::try_from(n % 26).unwrap(); SIZE]
}

fn is_whole(bytes: &[u8]) -> bool {
    bytes.len() == SIZE && bytes.iter().all(|byte| *byte == bytes[0])
}

#[test]
#[ignore = "needs another test that kills it"]
fn writes_a_file_over_and_over() {
    let path = folder_of_writer().join("target.bin");
    for n in 0.. {
        write_atomically(&path, Existing::Replace, |out| out.write_all(&content(n))).unwrap();
    }
}

#[test]
#[ignore = "needs another test that kills it"]
fn writes_a_folder_over_and_over() {
    let folder = folder_of_writer().join("out");
    for n in 0.. {
        write_folder(&folder, n);
    }
}

/// Files of which each second run has some that the others have not.
fn write_folder(folder: &Path, n: usize) {
    let output =
        OutputFolder::begin(folder, Existing::Replace, &["common.txt"], Vec::new()).unwrap();
    for name in ["common.txt", "other.txt", ["even.txt", "odd.txt"][n % 2]] {
        fs::write(output.staging().join(name), n.to_string()).unwrap();
    }
    output.finish(RunRecord::default()).unwrap();
}

/// Starts a writer, waits until it has written once, and kills it at a random moment after that.
fn kill(writer: &str, folder: &Path, written: &Path, moment: Duration) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", &format!("writes_killed::{writer}"), "--ignored"]);
    command.env(FOLDER, folder).stdout(Stdio::null()).stderr(Stdio::null());
    let before = fs::metadata(written).and_then(|found| found.modified()).ok();
    let mut child = command.spawn().unwrap();
    let started = Instant::now();
    while fs::metadata(written).and_then(|found| found.modified()).ok() == before {
        assert!(started.elapsed() < Duration::from_secs(60), "nothing was written");
        assert!(child.try_wait().unwrap().is_none(), "the writer has ended");
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(moment);
    child.kill().unwrap();
    child.wait().unwrap();
}

fn moments() -> impl Iterator<Item = Duration> {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    std::iter::repeat_with(move || LATEST.mul_f64(rng.random::<f64>())).take(n_kills())
}

#[test]
fn a_killed_write_loses_nothing_and_leaves_nothing() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("target.bin");
    // Killed while the content is written, while it is brought to the disk or renamed, or after.
    let [mut partial, mut complete, mut none] = [0; 3];
    for (n, moment) in moments().enumerate() {
        kill("writes_a_file_over_and_over", folder.path(), &path, moment);
        assert!(is_whole(&fs::read(&path).unwrap()), "kill {n} after {moment:?}");
        let left: Vec<String> =
            names(folder.path()).into_iter().filter(|name| name != "target.bin").collect();
        let sizes = left.iter().map(|name| fs::metadata(folder.path().join(name)).unwrap().len());
        match sizes.max() {
            None => none += 1,
            Some(size) if size == SIZE as u64 => complete += 1,
            Some(_) => partial += 1,
        }
        write_atomically(&path, Existing::Replace, |out| out.write_all(&content(n))).unwrap();
        assert_eq!(names(folder.path()), ["target.bin"], "kill {n} after {moment:?}");
        assert_eq!(fs::read(&path).unwrap(), content(n));
    }
    println!("killed in a write {partial}, in its fsync or rename {complete}, after it {none}");
    assert!(complete > 0, "no kill fell into fsync or rename");
}

#[test]
fn a_killed_run_leaves_a_folder_that_the_next_one_makes_whole() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let (mut n_complete, mut n_partial) = (0, 0);
    for (n, moment) in moments().enumerate() {
        kill("writes_a_folder_over_and_over", folder.path(), &out.join("manifest.json"), moment);
        let text = fs::read_to_string(out.join("manifest.json")).unwrap();
        let manifest: Value = serde_json::from_str(&text).unwrap();
        // A manifest that says so vouches for every file; another one knows all that may be there.
        match manifest["complete"].as_bool().unwrap() {
            true => n_complete += 1,
            false => n_partial += 1,
        }
        for file in manifest["files"].as_array().unwrap() {
            let name = file["name"].as_str().unwrap();
            let found = FileDigest::from_file(name, &out.join(name));
            if manifest["complete"] == true {
                assert_eq!(serde_json::to_value(found.unwrap()).unwrap(), *file, "kill {n}");
            }
        }
        write_folder(&out, n);
        let own = ["even.txt", "odd.txt"][n % 2];
        let mut expected = vec!["common.txt", "manifest.json", "other.txt", own];
        expected.sort_unstable();
        assert_eq!(names(&out), expected, "kill {n} after {moment:?}");
        for name in ["common.txt", "other.txt", own] {
            assert_eq!(fs::read_to_string(out.join(name)).unwrap(), n.to_string());
        }
    }
    println!("found complete {n_complete}, with files in between {n_partial}");
    assert_eq!(n_complete + n_partial, n_kills());
}
