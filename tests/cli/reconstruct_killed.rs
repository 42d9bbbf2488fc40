//! Reconstructions that are killed at random moments: no file is half written, and the run that goes on
//! ends at the particles of one that was never interrupted.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use serde_json::Value;
use tempfile::TempDir;

use crate::program::{ok, program, text};

const EVIDENCE: &str = "tests/data/evidence/spin.toml";

/// Runs, and how often each is killed before it may end.
const RUNS: usize = 3;
const KILLS_PER_RUN: usize = 3;

/// A reconstruction with its checkpoint and results in a folder.
fn reconstruct(folder: &Path) -> Command {
    let mut command = program();
    command.args(["reconstruct", EVIDENCE, "--particles", "50", "--resume", "--overwrite"]);
    command.arg("--checkpoint").arg(folder.join("run.reconstruction"));
    command.arg("--out").arg(folder.join("out"));
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The files of a folder that a user sees.
fn visible(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| !path.file_name().unwrap().to_str().unwrap().starts_with('.'));
    paths.sort();
    paths
}

/// Checks that what is there is whole.
fn check_whole(out: &Path, particles: &[u8], moment: Duration) {
    for path in visible(out) {
        let bytes = fs::read(&path).unwrap();
        match path.extension().unwrap().to_str().unwrap() {
            "csv" => assert!(bytes == particles, "{} after {moment:?}", path.display()),
            _ => {
                let read = serde_json::from_slice::<Value>(&bytes);
                assert!(read.is_ok(), "{} after {moment:?}: {read:?}", path.display());
            }
        }
    }
}

#[test]
fn a_killed_reconstruction_goes_on_to_the_same_particles() {
    let folder = TempDir::new().unwrap();
    let reference = folder.path().join("reference");
    fs::create_dir(&reference).unwrap();
    let started = Instant::now();
    ok(reconstruct(&reference).output().unwrap());
    let duration = started.elapsed();
    let particles = fs::read(reference.join("out/particles.csv")).unwrap();
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(11);
    let [mut before, mut during, mut after] = [0; 3];
    for run in 0..RUNS {
        let own = folder.path().join(run.to_string());
        fs::create_dir(&own).unwrap();
        for _ in 0..KILLS_PER_RUN {
            let moment = duration.mul_f64(rng.random::<f64>() * 0.8);
            let mut child = reconstruct(&own).spawn().unwrap();
            std::thread::sleep(moment);
            match child.try_wait().unwrap() {
                Some(_) => after += 1,
                None if own.join("run.reconstruction").exists() => during += 1,
                None => before += 1,
            }
            child.kill().unwrap();
            child.wait().unwrap();
            check_whole(&own.join("out"), &particles, moment);
        }
        ok(reconstruct(&own).output().unwrap());
        check_whole(&own.join("out"), &particles, Duration::MAX);
        // Nothing of the killed runs is left.
        for (path, expected) in [
            (own.join("out"), &["manifest.json", "particles.csv", "reconstruction.json"][..]),
            (own.clone(), &["out", "run.reconstruction"]),
        ] {
            let entries = fs::read_dir(&path).unwrap();
            let mut names: Vec<String> =
                entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
            names.sort();
            assert_eq!(names, expected, "{}", text(&path));
        }
    }
    println!("killed before the first checkpoint {before}, later {during}, ended before {after}");
    assert!(during > 0, "no kill fell between two checkpoints");
}
