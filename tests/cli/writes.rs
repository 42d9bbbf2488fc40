//! What commands do to files that are there already, and what they say of those that they write.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use impactlab_core::data::write::FileDigest;
use impactlab_core::numerics::sha256_hex;
use serde_json::Value;
use tempfile::TempDir;

use crate::force::train;
use crate::program::{SCENARIO, TRAJECTORIES, json, kill_at_checkpoint, names, ok, program, text};

/// What a command that must fail prints at its end.
fn error(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    let errors: Vec<&str> = text.lines().filter(|line| line.starts_with("error: ")).collect();
    assert_eq!(errors.len(), 1, "{text}");
    errors[0].to_owned()
}

fn command(args: &[&str], out: &Path) -> Command {
    let mut command = program();
    command.args(args).arg("--out").arg(out);
    command
}

const PREDICT_FORCE: [&str; 4] = ["predict", "force", "--scenario", SCENARIO];
const SIMULATE: [&str; 5] = ["simulate", "--vehicle", "reference-2000", "--speed", "20"];

#[test]
fn a_file_is_replaced_only_where_that_is_said() {
    let folder = TempDir::new().unwrap();
    for (name, args) in [
        ("motion.csv", &SIMULATE[..]),
        ("impact.csv", &["render", "impact", SCENARIO]),
        ("impact.png", &["render", "impact", SCENARIO]),
    ] {
        let out = folder.path().join(name);
        fs::write(&out, "mine").unwrap();
        let text = error(&mut command(args, &out));
        assert!(text.ends_with(&format!("{name}: exists already; --overwrite replaces it")));
        assert_eq!(fs::read_to_string(&out).unwrap(), "mine");
        ok(command(args, &out).arg("--overwrite").output().unwrap());
        assert!(fs::metadata(&out).unwrap().len() > 100, "{name}");
        let device = error(command(args, Path::new("/dev/full")).arg("--overwrite"));
        let kind = ["is a device", "expected a name that ends in"];
        assert!(kind.iter().any(|kind| device.contains(kind)), "{device}");
    }
    assert!(error(&mut command(&SIMULATE, folder.path())).contains("is a folder"));
}

/// “written: motion.csv” was said, with exit code 0, of a file that was never made.
#[test]
fn a_motion_that_is_not_simulated_is_no_file_that_was_written() {
    let folder = TempDir::new().unwrap();
    let [log, out] = ["log.csv", "motion.csv"].map(|name| folder.path().join(name));
    let row = |i: i32| format!("{},{},0,0,0\n", f64::from(i) * 0.01, f64::from(i) * 0.2);
    let rows: String = (0..200).map(row).collect();
    fs::write(&log, format!("time [s],x [m],y [m],yaw [deg],yaw rate [deg/s]\n{rows}")).unwrap();
    let args = ["simulate", "--trajectory", text(&log)];
    let said = error(&mut command(&args, &out));
    assert!(said.contains("motion.csv: is not written, as there is no simulated motion"), "{said}");
    let printed = command(&args, &out).arg("--json").output().unwrap().stdout;
    let answer = json(&String::from_utf8(printed).unwrap());
    assert!(answer["out"].is_null() && answer["name"] == "log", "{answer}");
    assert!(!out.exists());
    ok(program().args(args).output().unwrap());
}

/// Half of the JSON was printed, and then “the output cannot be written”.
#[cfg(target_os = "linux")]
#[test]
fn json_is_printed_whole_or_not_at_all() {
    let folder = TempDir::new().unwrap();
    let name: &std::ffi::OsStr = std::os::unix::ffi::OsStrExt::from_bytes(b"a\xff.toml");
    let path = folder.path().join(name);
    fs::copy("assets/scenarios/pit_right_rear.toml", &path).unwrap();
    let output = program().args(["impact", "--print-request"]).arg(&path).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(output.stdout.is_empty(), "{}", String::from_utf8_lossy(&output.stdout));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains("the name of a file is not Unicode") && said.contains("rename"),
        "{said}"
    );
}

/// A table was written under the name of a picture, and a package under that of a case.
#[test]
fn a_file_holds_what_its_name_says() {
    let folder = TempDir::new().unwrap();
    let pack = ["case", "pack", "assets/examples/pit.impactlab"];
    for (args, wrong, right) in
        [(&SIMULATE[..], "motion.png", "motion.CSV"), (&pack[..], "pit.impactlab", "pit.zip")]
    {
        let out = folder.path().join(wrong);
        let text = error(&mut command(args, &out));
        let ending = right.rsplit('.').next().unwrap().to_lowercase();
        let expected = format!("{wrong}: cannot be made; expected a name that ends in .{ending}");
        assert!(text.ends_with(&expected), "{text}");
        ok(command(args, &folder.path().join(right)).output().unwrap());
    }
    assert_eq!(names(folder.path()), ["motion.CSV", "pit.zip"]);
}

#[test]
fn a_package_of_what_is_asked_has_no_drafts() {
    let folder = TempDir::new().unwrap();
    let [path, zip] = ["pit.impactlab", "pit.zip"].map(|name| folder.path().join(name));
    let mut case = json(&fs::read_to_string("assets/examples/pit.impactlab").unwrap());
    let draft = serde_json::json!({"question": "check", "paths": ["./draft.csv"]});
    case["variants"][0]["unasked"] = serde_json::json!([draft]);
    case["variants"][0]["view"] = serde_json::json!({"steering_ratio": 17.25});
    fs::write(&path, case.to_string()).unwrap();
    let all = ["--overwrite", "--asked"];
    for (options, has_drafts) in [(&all[..1], true), (&all[..], false)] {
        let pack = [&["case", "pack", text(&path)][..], options].concat();
        ok(command(&pack, &zip).output().unwrap());
        let out = folder.path().join(format!("drafts {has_drafts}"));
        let unpacked = ok(command(&["case", "unpack", text(&zip)], &out).output().unwrap());
        let said = fs::read_to_string(unpacked.trim()).unwrap();
        for draft in ["draft.csv", "17.25"] {
            assert_eq!(said.contains(draft), has_drafts, "{options:?}: {said}");
        }
        assert!(said.contains("predict_motion"), "the questions are there");
    }
}

/// The package of a case whose network was just trained said nothing of the network that it lacks.
#[test]
fn a_package_says_which_network_it_lacks() {
    let folder = TempDir::new().unwrap();
    let [path, zip] = ["pit.impactlab", "pit.zip"].map(|name| folder.path().join(name));
    let mut case = json(&fs::read_to_string("assets/examples/pit.impactlab").unwrap());
    let question = &mut case["variants"][0]["questions"][2];
    assert_eq!(question["model"], "shipped");
    question["model"] = serde_json::json!({"held": "my cars"});
    fs::write(&path, case.to_string()).unwrap();
    let said = ok(command(&["case", "pack", text(&path)], &zip).output().unwrap());
    assert!(said.contains("warning: the network my cars is in no file"), "{said}");
    let args = ["case", "pack", text(&path), "--overwrite", "--json"];
    let answer = json(&ok(command(&args, &zip).output().unwrap()));
    assert_eq!(answer["networks_in_no_file"], serde_json::json!(["my cars"]));
    let pack = ["case", "pack", "assets/examples/pit.impactlab", "--overwrite"];
    let said = ok(command(&pack, &zip).output().unwrap());
    assert!(!said.contains("warning"), "{said}");
}

#[test]
fn a_folder_of_results_is_replaced_only_where_that_is_said_and_holds_one_run() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("prediction");
    let seed = ["--seed", "5", "--samples", "2", "--json"];
    let report = json(&ok(command(&[&PREDICT_FORCE[..], &seed].concat(), &out).output().unwrap()));
    let written = ["bands.csv", "manifest.json", "mean.csv", "prediction.json"];
    let samples = ["sample_001.csv", "sample_002.csv"];
    assert_eq!(names(&out), [&written[..], &samples].concat());

    let manifest = json(&fs::read_to_string(out.join("manifest.json")).unwrap());
    assert_eq!(manifest["program"], "impactlab");
    assert_eq!(manifest["version"], impactlab::VERSION);
    assert_eq!(manifest["complete"], true);
    assert_eq!(manifest["seed"], 5);
    assert_eq!(manifest["request"]["question"], "predict_force");
    assert_eq!(manifest["command"][1], "predict");
    assert!(manifest["started"].as_str().unwrap().ends_with('Z'), "{manifest}");
    assert!(manifest["seconds"].as_f64().unwrap() > 0.0);
    assert_eq!(manifest["models"], report["model_digests"]);
    assert_eq!(manifest["inputs"][0]["name"], SCENARIO);
    let scenario = FileDigest::from_file("", Path::new(SCENARIO)).unwrap();
    assert_eq!(manifest["inputs"][0]["sha256"], scenario.sha256);
    assert_eq!(manifest["files"].as_array().unwrap().len(), 5);
    for file in manifest["files"].as_array().unwrap() {
        let name = file["name"].as_str().unwrap();
        let found = FileDigest::from_file(name, &out.join(name)).unwrap();
        assert_eq!(*file, serde_json::to_value(found).unwrap());
    }

    let text = error(&mut command(&PREDICT_FORCE, &out));
    assert!(text.ends_with("files of an earlier run; --overwrite replaces them"), "{text}");
    fs::write(out.join("notes.txt"), "mine").unwrap();
    ok(command(&PREDICT_FORCE, &out).arg("--overwrite").output().unwrap());
    let mut left = [&written[..], &["notes.txt"]].concat();
    left.sort_unstable();
    assert_eq!(names(&out), left, "the samples of the run before are gone");
}

/// A folder of results goes to others; it said the home folder of who made it.
#[test]
fn a_folder_of_results_names_no_folder_of_this_machine() {
    let folder = TempDir::new().unwrap();
    let scenario = folder.path().join("own scenario.toml");
    fs::copy(SCENARIO, &scenario).unwrap();
    let model = folder.path().join("own.safetensors");
    fs::copy("assets/models/force.safetensors", &model).unwrap();
    let motion = ["predict", "--draws", "2", "--duration", "0.5", "--scenario", text(&scenario)];
    let force = ["predict", "force", "--model", text(&model), "--scenario", text(&scenario)];
    for args in [&motion[..], &force] {
        let out = folder.path().join(format!("results of {}", args[1]));
        ok(command(args, &out).output().unwrap());
        for (name, bytes) in contents(&out) {
            let said = String::from_utf8_lossy(&bytes);
            assert!(!said.contains(text(folder.path())), "{args:?}: {name} says where it is");
        }
        let manifest = json(&fs::read_to_string(out.join("manifest.json")).unwrap());
        assert_eq!(manifest["command"][0], "impactlab");
        assert_eq!(manifest["command"][args.len()], "own scenario.toml");
        let inputs = manifest["inputs"].to_string();
        assert!(inputs.contains("\"own scenario.toml\""), "{inputs}");
        assert!(manifest["request"].to_string().contains("\"own scenario.toml\""), "{manifest}");
    }
}

#[test]
fn a_folder_that_holds_a_file_of_the_same_name_is_refused_before_the_work_begins() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("outcome.json"), "mine").unwrap();
    let text = error(&mut command(&["predict", "--scenario", SCENARIO], folder.path()));
    assert!(text.contains("outcome.json: was not written by an earlier run"), "{text}");
    assert_eq!(names(folder.path()), ["outcome.json"]);
    let nowhere = folder.path().join("a/b");
    error(&mut command(&["predict", "--scenario", "missing.toml"], &nowhere));
    assert!(!folder.path().join("a").exists(), "what was made for nothing is removed");
}

#[test]
fn every_report_says_which_program_seed_and_models_gave_it() {
    let of_file = |name: &str| {
        sha256_hex([fs::read(format!("assets/models/{name}.safetensors")).unwrap().as_slice()])
    };
    let report = json(&ok(program().args(PREDICT_FORCE).arg("--json").output().unwrap()));
    assert_eq!(report["version"], impactlab::VERSION);
    assert_eq!(report["seed"], 0);
    assert_eq!(report["model_digests"][0]["network"], "force");
    assert_eq!(report["model_digests"][0]["name"], "shipped");
    assert_eq!(report["model_digests"][0]["sha256"], of_file("force"));

    let folder = TempDir::new().unwrap();
    let few = ["predict", "--scenario", SCENARIO, "--draws", "2", "--duration", "0.5", "--json"];
    let out = folder.path().join("out");
    let report = json(&ok(command(&[&few[..], &["--seed", "3"]].concat(), &out).output().unwrap()));
    assert_eq!(report["seed"], 3);
    assert_eq!(report["model_digests"][0]["sha256"], of_file("force"));
    assert_eq!(report["model_digests"][1]["sha256"], of_file("response"));
    let own = out.join("trajectory.csv");
    assert_eq!(report["files"][0], own.to_str().unwrap(), "the files are named where they are");
    assert!(own.exists());

    // The network that stands beside the momentum solution.
    let report = json(&ok(program().args(["impact", SCENARIO, "--json"]).output().unwrap()));
    assert_eq!(report["version"], impactlab::VERSION);
    assert_eq!(report["model_digests"][0]["sha256"], of_file("force"));

    for args in [
        &["check", SCENARIO][..],
        &SIMULATE,
        &["simulate", "--dataset", TRAJECTORIES, "--case", "FE_c001"],
    ] {
        let report = json(&ok(program().args(args).arg("--json").output().unwrap()));
        assert_eq!(report["version"], impactlab::VERSION, "{args:?}");
        assert!(report.get("seed").is_none(), "{args:?}: nothing is drawn");
    }
}

#[test]
fn a_training_is_continued_or_replaced_only_where_that_is_said() {
    let folder = TempDir::new().unwrap();
    let [first, second] = ["first", "second"].map(|name| folder.path().join(name));
    fs::write(&first, "mine").unwrap();
    let text = error(&mut train(&folder, &first));
    assert!(text.ends_with("first: exists already; --overwrite replaces it"), "{text}");
    let report =
        json(&ok(train(&folder, &first).args(["--overwrite", "--json"]).output().unwrap()));
    let bytes = fs::read(&first).unwrap();
    assert_eq!(report["model_digests"][0]["sha256"], sha256_hex([bytes.as_slice()]));
    assert_eq!(report["seed"], 4);

    let text = error(&mut train(&folder, &first));
    let ways = "first.training: holds a training; --resume goes on with it, --overwrite begins \
                anew and replaces it";
    assert!(text.ends_with(ways), "{text}");
    ok(train(&folder, &first).arg("--resume").output().unwrap());
    assert!(fs::read(&first).unwrap() == bytes, "a training that was over is not changed");

    // The same training at another time gives the same bytes.
    ok(train(&folder, &second).output().unwrap());
    assert!(fs::read(&second).unwrap() == bytes, "the models differ");
    let left = ["first", "first.training", "second", "second.training", "tiny.toml"];
    assert_eq!(names(folder.path()), left);
}

/// `--overwrite` is said of the model; the file beside it was replaced, whatever it was.
#[test]
fn a_file_that_is_no_training_is_not_replaced_by_one() {
    let folder = TempDir::new().unwrap();
    let [model, beside] = ["model", "model.training"].map(|name| folder.path().join(name));
    fs::write(&beside, "mine").unwrap();
    for more in [&[][..], &["--overwrite"]] {
        let text = error(train(&folder, &model).args(more));
        assert!(text.contains("model.training: was not written by an earlier run"), "{text}");
        assert_eq!(fs::read_to_string(&beside).unwrap(), "mine");
    }
}

#[test]
fn two_trainings_do_not_write_one_file() {
    let folder = TempDir::new().unwrap();
    let model = folder.path().join("model");
    let checkpoint = PathBuf::from(format!("{}.training", model.display()));
    let mut long = train(&folder, &model);
    long.args(["--epochs", "100000"]).stdout(Stdio::null()).stderr(Stdio::null());
    let mut first = long.spawn().unwrap();
    while !checkpoint.exists() {
        assert!(first.try_wait().unwrap().is_none(), "the training has ended");
        std::thread::sleep(Duration::from_millis(5));
    }
    for way in ["--resume", "--overwrite"] {
        let text = error(train(&folder, &model).arg(way));
        let who = format!("model.training: process {} is writing it", first.id());
        assert!(text.contains(&who), "{text}");
    }
    first.kill().unwrap();
    first.wait().unwrap();
    // The lock of a killed training stands in nobody's way, and nothing of it is left.
    ok(train(&folder, &model).arg("--overwrite").output().unwrap());
    assert_eq!(names(folder.path()), ["model", "model.training", "tiny.toml"]);
    kill_at_checkpoint(
        &mut train(&folder, &folder.path().join("other")),
        &folder.path().join("other"),
    );
}

/// A command under a limit of the size of files, which stands in for a full disk: writes beyond it
/// fail like those to a full disk.
#[cfg(target_os = "linux")]
fn under_limit(blocks: u32, args: &[&str], out: &Path) -> Command {
    let mut shell = Command::new("sh");
    shell.current_dir(env!("CARGO_MANIFEST_DIR"));
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
    shell.args(["-c", &script, "sh", env!("CARGO_BIN_EXE_impactlab")]).args(args);
    shell.arg("--overwrite").arg("--out").arg(out);
    shell
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_what_was_there_and_is_named() {
    let folder = TempDir::new().unwrap();
    let motion = folder.path().join("motion.csv");
    fs::write(&motion, "before").unwrap();
    let text = error(&mut under_limit(2, &SIMULATE, &motion));
    assert!(text.contains("motion.csv: cannot be written: File too large"), "{text}");
    assert_eq!(fs::read_to_string(&motion).unwrap(), "before");
    assert_eq!(names(folder.path()), ["motion.csv"]);

    let out = folder.path().join("prediction");
    ok(command(&PREDICT_FORCE, &out).output().unwrap());
    let before: Vec<(String, Vec<u8>)> = contents(&out);
    let text = error(&mut under_limit(8, &PREDICT_FORCE, &out));
    assert!(text.contains("cannot be written: File too large"), "{text}");
    assert!(contents(&out) == before, "the folder is as it was");
    let model = folder.path().join("model");
    let text = error(&mut under_limit(2, &train_args(&folder), &model));
    assert!(text.contains("model.training: cannot be written: File too large"), "{text}");
}

fn train_args(folder: &TempDir) -> Vec<&'static str> {
    let command = train(folder, Path::new("unused"));
    let args = command.get_args().map(|arg| arg.to_str().unwrap().to_owned());
    // Without `--out unused`; the test ends soon enough to leak the rest.
    args.take_while(|arg| arg != "--out").map(|arg| &*arg.leak()).collect()
}

fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let read = |name: String| (name.clone(), fs::read(folder.join(name)).unwrap());
    names(folder).into_iter().map(read).collect()
}

#[test]
fn a_question_that_is_only_printed_writes_nothing() {
    let folder = TempDir::new().unwrap();
    for args in [&PREDICT_FORCE[..], &SIMULATE, &["predict", "--scenario", SCENARIO]] {
        let out = folder.path().join("out");
        let printed: Value =
            json(&ok(command(args, &out).arg("--print-request").output().unwrap()));
        assert!(printed["question"].is_string());
    }
    assert!(names(folder.path()).is_empty());
}

/// A folder in which nobody may write was said not to exist.
#[test]
#[cfg(target_os = "linux")]
fn a_folder_without_the_right_to_write_is_named_with_the_true_cause() {
    let ran = program().args(["render", "impact", SCENARIO, "--out", "/sys/impact.csv"]).output();
    let ran = ran.unwrap();
    let error = String::from_utf8(ran.stderr).unwrap();
    assert!(!ran.status.success(), "{error}");
    assert!(error.starts_with("error: /sys/impact.csv: cannot be written: "), "{error}");
    assert!(error.contains("ermission") || error.contains("not permitted"), "{error}");
    assert!(!error.contains("does not exist"), "{error}");
}
