//! What writing a file does to what is there already: nothing that was not asked for.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::ffi::OsString;
use std::fs::{self, File};
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

use impactlab_core::data::write::{OutputFolder, RunRecord, WriterLock};
use impactlab_core::data::{Existing, check_target, write_atomically, write_bytes};
use impactlab_core::error_chain;
use tempfile::TempDir;

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn write(path: &Path, existing: Existing, text: &str) -> Result<(), String> {
    let written = write_bytes(path, existing, text.as_bytes());
    written.map_err(|error| error_chain(&error))
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().permissions().mode() & 0o7777
}

fn set_mode(path: &Path, mode: u32) {
    fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_new_file_has_the_permissions_of_every_new_file() {
    let here = folder();
    File::create(here.path().join("plain")).unwrap();
    write(&here.path().join("ours"), Existing::Refuse, "x").unwrap();
    assert_eq!(mode(&here.path().join("ours")), mode(&here.path().join("plain")));
}

#[test]
fn a_replaced_file_keeps_its_permissions() {
    let here = folder();
    let path = here.path().join("f.csv");
    for bits in [0o600, 0o640, 0o666, 0o755] {
        fs::write(&path, "old").unwrap();
        set_mode(&path, bits);
        write(&path, Existing::Replace, "new").unwrap();
        assert_eq!(mode(&path), bits, "{bits:o}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    }
}

/// While a private file was written, and after a kill, everybody could read what was to become of it.
#[test]
fn nobody_reads_in_the_making_what_is_private() {
    let here = folder();
    let path = here.path().join("case.impactlab");
    fs::write(&path, "old").unwrap();
    set_mode(&path, 0o600);
    let mut seen = Vec::new();
    let written = write_atomically(&path, Existing::Replace, |out| {
        out.write_all(b"new")?;
        let making = names(here.path()).into_iter().filter(|name| name.ends_with(".tmp"));
        seen.extend(making.map(|name| mode(&here.path().join(name))));
        Ok(())
    });
    written.unwrap();
    assert_eq!((seen, mode(&path)), (vec![0o600], 0o600));
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
}

#[test]
fn the_target_of_a_symbolic_link_is_replaced_and_the_link_stays() {
    let here = folder();
    let (links, files) = (here.path().join("links"), here.path().join("files"));
    fs::create_dir(&links).unwrap();
    fs::create_dir(&files).unwrap();
    fs::write(files.join("old.csv"), "old").unwrap();
    symlink("../files/old.csv", links.join("relative")).unwrap();
    symlink(links.join("relative"), links.join("chain")).unwrap();
    symlink(files.join("new.csv"), links.join("dangling")).unwrap();
    for (link, file) in [("relative", "old.csv"), ("chain", "old.csv"), ("dangling", "new.csv")] {
        write(&links.join(link), Existing::Replace, link).unwrap();
        assert!(links.join(link).is_symlink(), "{link}");
        assert_eq!(fs::read_to_string(files.join(file)).unwrap(), link);
    }
    assert_eq!(names(&links), ["chain", "dangling", "relative"]);
    symlink("circle", links.join("circle")).unwrap();
    let circle = write(&links.join("circle"), Existing::Replace, "x").unwrap_err();
    assert!(circle.contains("leads to no file"), "{circle}");
}

#[test]
fn what_is_no_file_is_refused_at_once_and_stays() {
    let here = folder();
    let (fifo, inner) = (here.path().join("fifo"), here.path().join("folder"));
    assert!(Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    fs::create_dir(&inner).unwrap();
    let device = here.path().join("device");
    symlink("/dev/null", &device).unwrap();
    let socket = here.path().join("socket");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    let new_folder = here.path().join("new/");
    for (path, kind) in [
        (fifo.as_path(), "is a named pipe"),
        (&inner, "is a folder"),
        (&new_folder, "is a folder"),
        (&device, "is a device"),
        (&socket, "is a socket"),
        (Path::new("/dev/null"), "is a device"),
        (Path::new(".."), "is a folder"),
    ] {
        for existing in [Existing::Refuse, Existing::Replace] {
            let early = check_target(path, existing).unwrap_err().to_string();
            assert!(early.contains(kind), "{early}");
            assert_eq!(write(path, existing, "x").unwrap_err(), early);
        }
    }
    assert_eq!(names(here.path()), ["device", "fifo", "folder", "socket"]);
}

#[test]
fn a_read_only_file_and_one_that_nobody_said_to_replace_stay() {
    let here = folder();
    let path = here.path().join("f.csv");
    fs::write(&path, "old").unwrap();
    let refused = write(&path, Existing::Refuse, "new").unwrap_err();
    assert!(refused.ends_with("f.csv: exists already; --overwrite replaces it"), "{refused}");
    set_mode(&path, 0o444);
    let refused = write(&path, Existing::Replace, "new").unwrap_err();
    assert!(refused.ends_with("f.csv: is read-only, so it is not replaced"), "{refused}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    let nowhere = check_target(&here.path().join("no/f.csv"), Existing::Replace).unwrap_err();
    assert!(nowhere.to_string().contains("because there is no folder"), "{nowhere}");
    assert_eq!(names(here.path()), ["f.csv"]);
}

#[test]
fn a_file_that_appears_while_it_is_written_is_not_replaced() {
    let here = folder();
    let path = here.path().join("f.csv");
    let late = write_atomically(&path, Existing::Refuse, |out| {
        fs::write(&path, "theirs")?;
        out.write_all(b"ours")
    });
    assert!(late.unwrap_err().to_string().contains("exists already"));
    assert_eq!(fs::read_to_string(&path).unwrap(), "theirs");
    assert_eq!(names(here.path()), ["f.csv"]);
}

#[test]
fn leftovers_of_killed_writes_are_swept_and_living_writers_are_spared() {
    let here = folder();
    let path = here.path().join("f.csv");
    let others = ["f.csv.tmp", ".f.csv.impactlab-abcdef", ".g.csv.impactlab-abcdef.tmp"];
    for name in others.iter().chain(&[".f.csv.impactlab-killed.tmp"]) {
        fs::write(here.path().join(name), "half").unwrap();
    }
    let living = File::create(here.path().join(".f.csv.impactlab-living.tmp")).unwrap();
    living.lock().unwrap();
    write(&path, Existing::Refuse, "whole").unwrap();
    let mut left: Vec<String> = others.map(str::to_owned).to_vec();
    left.extend([".f.csv.impactlab-living.tmp".to_owned(), "f.csv".to_owned()]);
    left.sort();
    assert_eq!(names(here.path()), left);
}

#[test]
fn any_name_that_a_file_may_have_can_be_written() {
    let here = folder();
    let foreign = OsString::from_vec(vec![b'a', 0xff, b'b']);
    for name in [OsString::from("x".repeat(255)), "ü".repeat(127).into(), foreign] {
        let path = here.path().join(&name);
        write(&path, Existing::Refuse, "x").unwrap();
        write(&path, Existing::Replace, "y").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "y", "{name:?}");
    }
    assert_eq!(names(here.path()).len(), 3);
}

#[test]
fn a_second_writer_is_told_who_the_first_one_is() {
    let here = folder();
    let path = here.path().join("model.training");
    let first = WriterLock::lock_file(&path).unwrap();
    let second = WriterLock::lock_file(&path).unwrap_err().to_string();
    assert!(second.contains(&format!("process {} is writing it", std::process::id())), "{second}");
    drop(first);
    assert!(names(here.path()).is_empty());
    // What a killed writer leaves stands in nobody's way.
    fs::write(here.path().join(".model.training.impactlab-lock"), "12345").unwrap();
    drop(WriterLock::lock_file(&path).unwrap());
    assert!(names(here.path()).is_empty());
    // A link in place of the lock file is not followed.
    fs::write(here.path().join("victim"), "kept").unwrap();
    symlink("victim", here.path().join(".model.training.impactlab-lock")).unwrap();
    assert!(WriterLock::lock_file(&path).is_err());
    assert_eq!(fs::read_to_string(here.path().join("victim")).unwrap(), "kept");
}

/// Writes a folder as a command does.
fn fill(folder: &Path, existing: Existing, files: &[(&str, &str)]) -> Result<(), String> {
    let known: Vec<&str> = files.iter().take(1).map(|(name, _)| *name).collect();
    let begun = OutputFolder::begin(folder, existing, &known, Vec::new());
    let output = begun.map_err(|error| error_chain(&error))?;
    for (name, text) in files {
        fs::write(output.staging().join(name), text).unwrap();
    }
    output.finish(RunRecord::default()).map_err(|error| error_chain(&error))
}

fn manifest(folder: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(folder.join("manifest.json")).unwrap()).unwrap()
}

#[test]
fn an_output_folder_holds_one_run_and_what_is_not_ours() {
    let here = folder();
    let out = here.path().join("deep/out");
    fill(&out, Existing::Refuse, &[("a.csv", "1"), ("b.csv", "2"), ("c.csv", "3")]).unwrap();
    assert_eq!(names(&out), ["a.csv", "b.csv", "c.csv", "manifest.json"]);
    let listed = manifest(&out);
    assert_eq!(listed["complete"], true);
    assert_eq!(listed["files"][0]["name"], "a.csv");
    assert_eq!(listed["files"][0]["bytes"], 1);
    let of_1 = "6b86b273ff34fce19d6b804eff5a3f5747ada4eaa22f1d49c01e52ddb7875b4b";
    assert_eq!(listed["files"][0]["sha256"], of_1);

    let refused = fill(&out, Existing::Refuse, &[("a.csv", "4")]).unwrap_err();
    assert!(refused.ends_with("of an earlier run; --overwrite replaces them"), "{refused}");
    assert_eq!(fs::read_to_string(out.join("a.csv")).unwrap(), "1");

    // The user's own file, and one of ours that the user has changed.
    fs::write(out.join("notes.txt"), "mine").unwrap();
    fs::write(out.join("c.csv"), "edited").unwrap();
    let edited = fill(&out, Existing::Replace, &[("a.csv", "4"), ("c.csv", "5")]).unwrap_err();
    assert!(edited.contains("c.csv: was not written by an earlier run, or has been edited"));
    fill(&out, Existing::Replace, &[("a.csv", "4")]).unwrap();
    assert_eq!(names(&out), ["a.csv", "c.csv", "manifest.json", "notes.txt"]);
    assert_eq!(fs::read_to_string(out.join("a.csv")).unwrap(), "4");
    assert_eq!(manifest(&out)["files"].as_array().unwrap().len(), 1);
}

#[test]
fn a_foreign_file_is_not_replaced_unasked_and_a_foreign_manifest_is_not_obeyed() {
    let here = folder();
    let (out, victim) = (here.path().join("out"), here.path().join("victim"));
    fs::create_dir(&out).unwrap();
    fs::write(out.join("b.csv"), "theirs").unwrap();
    // `b.csv` is not known beforehand: it is found before anything is moved.
    let refused = fill(&out, Existing::Refuse, &[("a.csv", "1"), ("b.csv", "2")]).unwrap_err();
    assert!(refused.contains("b.csv: was not written by an earlier run"), "{refused}");
    let refused = fill(&out, Existing::Replace, &[("a.csv", "1"), ("b.csv", "2")]).unwrap_err();
    assert!(refused.contains("not even with --overwrite"), "{refused}");
    assert_eq!(names(&out), ["b.csv"]);
    assert_eq!(fs::read_to_string(out.join("b.csv")).unwrap(), "theirs");

    fs::write(&victim, "kept").unwrap();
    let digest = "79f076abdd19a752db7267bfff2f9022161d120dea919fdaca2ffdfc24ca8c96";
    for name in ["../victim", victim.to_str().unwrap(), "x/../../victim", ".."] {
        let text = format!(
            r#"{{"program": "impactlab", "files": [{{"name": {name:?}, "bytes": 4, "sha256": "{digest}"}}]}}"#
        );
        fs::write(out.join("manifest.json"), text).unwrap();
        fill(&out, Existing::Replace, &[("a.csv", "1")]).unwrap();
        assert_eq!(fs::read_to_string(&victim).unwrap(), "kept", "{name}");
        fs::remove_file(out.join("a.csv")).unwrap();
    }
    fs::write(out.join("manifest.json"), "{}").unwrap();
    for existing in [Existing::Refuse, Existing::Replace] {
        let refused = fill(&out, existing, &[("z.csv", "1")]).unwrap_err();
        assert!(refused.contains("manifest.json: was not written by"), "{refused}");
        assert_eq!(fs::read_to_string(out.join("manifest.json")).unwrap(), "{}");
    }
}

#[test]
fn a_folder_is_written_by_one_process_at_a_time_and_left_as_it_was_by_a_failure() {
    let here = folder();
    let out = here.path().join("out");
    let first = OutputFolder::begin(&out, Existing::Refuse, &[], Vec::new()).unwrap();
    let second =
        OutputFolder::begin(&out, Existing::Replace, &[], Vec::new()).unwrap_err().to_string();
    assert!(second.contains(&format!("process {}", std::process::id())), "{second}");
    fs::write(first.staging().join("a.csv"), "half").unwrap();
    drop(first);
    assert!(!out.exists(), "a folder that was made for nothing is removed");

    fs::write(&out, "a file").unwrap();
    let refused =
        OutputFolder::begin(&out, Existing::Replace, &[], Vec::new()).unwrap_err().to_string();
    assert!(refused.contains("is no folder"), "{refused}");
}
