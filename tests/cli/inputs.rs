//! Commands never write over a file that they read, not even with `--overwrite`.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::program::{TRAJECTORIES, ok, program, text};

/// A folder with a force, a motion, a scenario, a case, a network's settings and a site.
fn inputs() -> TempDir {
    let folder = TempDir::new().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::create_dir(folder.path().join("site")).unwrap();
    for (from, to) in [
        ("datasets/fea/forces/c001.csv", "c.csv"),
        ("datasets/trajectories-fea/trajectories/FE_c002.csv", "tr.csv"),
        ("assets/scenarios/pit_right_rear.toml", "scenario.csv.toml"),
        ("assets/examples/pit.impactlab", "pit.impactlab"),
        ("assets/sites/country-road/site.toml", "site/site.toml"),
        ("assets/sites/country-road/edges.dxf", "site/edges.dxf"),
        ("assets/sites/country-road/orthophoto.jgw", "site/orthophoto.jgw"),
        ("assets/sites/country-road/orthophoto.jpg", "site/orthophoto.png"),
    ] {
        fs::copy(root.join(from), folder.path().join(to)).unwrap();
    }
    let site = folder.path().join("site/site.toml");
    let names_png = fs::read_to_string(&site).unwrap().replace("orthophoto.jpg", "orthophoto.png");
    fs::write(site, names_png).unwrap();
    folder
}

/// All files below a folder with their content.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => found.extend(contents(&path)),
            false => found.push((path.clone(), fs::read(&path).unwrap())),
        }
    }
    found.sort();
    found
}

/// Runs a command in a folder, which has to refuse to write over an input and to leave everything as it is.
fn assert_refused(folder: &Path, args: &[&str], input: &str) {
    let before = contents(folder);
    let mut command = program();
    let output = command.current_dir(folder).args(args).arg("--overwrite").output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{args:?}: {error}");
    let expected = format!("is an input ({input}) of what is to be written, so it is not replaced");
    assert!(error.contains(&expected), "{args:?}: {error}");
    assert!(contents(folder) == before, "{args:?} has changed a file");
}

#[test]
fn records_sites_and_cases_outlive_what_is_made_of_them() {
    let folder = inputs();
    let here = folder.path();
    let simulate = ["simulate", "--vehicle", "reference-2000", "--speed", "20"];
    let on_site = ["--site", "site/site.toml"];
    let export = ["export", "pit-right-rear"];
    for (args, options, input) in [
        (&simulate[..], &["--force", "c.csv", "--out", "c.csv"][..], "c.csv"),
        (&simulate, &["--force", "c.csv", "--out", "./site/../c.csv"], "c.csv"),
        (&["render", "force", "c.csv"], &["--out", "c.csv"], "c.csv"),
        (&["export", "tr.csv"], &["--out", "tr.csv"], "tr.csv"),
        (&export, &[&on_site[..], &["--out", "site/edges.dxf"]].concat(), "site/edges.dxf"),
        (&["case", "pack", "pit.impactlab"], &["--out", "pit.impactlab"], "pit.impactlab"),
    ] {
        assert_refused(here, &[args, options].concat(), input);
    }
    {
        let scene = ["render", "scene", "pit-right-rear", "--time", "1"];
        let photo = "site/orthophoto.png";
        assert_refused(here, &[&scene[..], &on_site, &["--out", photo]].concat(), photo);
    }
}

#[cfg(unix)]
#[test]
fn an_input_is_known_behind_a_link() {
    let folder = inputs();
    let here = folder.path();
    std::os::unix::fs::symlink("pit.impactlab", here.join("link.md")).unwrap();
    assert_refused(here, &["report", "pit.impactlab", "--out", "link.md"], "pit.impactlab");
    std::os::unix::fs::symlink("c.csv", here.join("link.csv")).unwrap();
    let simulate = ["simulate", "--vehicle", "reference-2000", "--speed", "20", "--force"];
    assert_refused(here, &[&simulate[..], &["link.csv", "--out", "c.csv"]].concat(), "link.csv");
    assert_refused(here, &[&simulate[..], &["c.csv", "--out", "link.csv"]].concat(), "c.csv");
}

#[test]
fn a_file_of_a_result_folder_that_is_read_is_neither_replaced_nor_removed() {
    let folder = inputs();
    let here = folder.path();
    let run = |scenario: &str| {
        let mut command = program();
        command.current_dir(here).args(["predict", "force", "--scenario", scenario]);
        command.args(["--out", "out", "--overwrite"]);
        command.output().unwrap()
    };
    ok(run("pit-right-rear"));
    // The manifest names its files; one of them serves as a scenario from now on.
    let manifest: serde_json::Value =
        serde_json::from_slice(&fs::read(here.join("out/manifest.json")).unwrap()).unwrap();
    let name = manifest["files"][0]["name"].as_str().unwrap();
    let input = format!("out/{name}");
    fs::copy(here.join("scenario.csv.toml"), here.join(&input)).unwrap();
    let args = ["predict", "force", "--scenario", text(Path::new(&input)), "--out", "out"];
    assert_refused(here, &args, &input);
}

#[test]
fn the_motions_of_a_data_set_are_not_written_over_its_records() {
    let folder = TempDir::new().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(TRAJECTORIES);
    fs::create_dir_all(folder.path().join("set/trajectories")).unwrap();
    for (from, content) in contents(&root) {
        let name = from.strip_prefix(&root).unwrap();
        fs::write(folder.path().join("set").join(name), content).unwrap();
    }
    let args = ["simulate", "--dataset", "set", "--case", "FE_c002", "--out", "set/trajectories"];
    assert_refused(folder.path(), &args, "set/trajectories/FE_c002.csv");
}
