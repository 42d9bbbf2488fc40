//! `impactlab sweep`: the same rows whatever computes them, and nothing half done.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use impactlab_sweep::{Outcome, Rows, chunk_path, read_rows, rows_bytes};
use tempfile::TempDir;

use crate::program::{json, ok, program};

mod requests;

const PIT: &str = "\
name = \"PIT\"
question = \"pit\"
n = 10
chunk = 3
seed = 5

[pit]
scenario = \"pit-right-rear\"
limit_s = 20
pairs = [{ struck = \"toyota-camry-2018\", striking = \"ford-explorer-2020\" }]

[vary.target_speed_m_s]
uniform = [15, 20]

[vary.closing_m_s]
triangular = [2, 3, 5]

[vary.esc]
list = [0, 1]

[vary.driver]
list = [0, 1, 2]
";

fn sweep(args: &[&str]) -> Command {
    let mut command = program();
    command.arg("sweep").args(args);
    command
}

fn run(args: &[&str]) -> Output {
    sweep(args).output().unwrap()
}

fn shown(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A plan that was resolved into a folder of its own.
fn planned(folder: &TempDir, plan: &str, name: &str) -> std::path::PathBuf {
    let file = folder.path().join(format!("{name}.toml"));
    fs::write(&file, plan).unwrap();
    let out = folder.path().join(name);
    ok(run(&["plan", shown(&file), "--out", shown(&out)]));
    out
}

fn merged(folder: &Path) -> Vec<u8> {
    let out = folder.with_extension("parquet");
    ok(run(&["merge", shown(folder), "--out", shown(&out), "--overwrite"]));
    fs::read(out).unwrap()
}

fn error(args: &[&str]) -> String {
    let output = run(args);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

fn bits(rows: &Rows, n: usize) -> Vec<u64> {
    let columns = rows.inputs.iter().chain(&rows.outcomes);
    columns.flat_map(|column| column.values[..n].iter().map(|value| value.to_bits())).collect()
}

#[test]
fn whatever_computes_the_chunks_the_table_has_the_same_bytes() {
    let folder = TempDir::new().unwrap();
    let at_once = planned(&folder, PIT, "once");
    ok(run(&["run", shown(&at_once)]));
    let whole = merged(&at_once);

    // In another order, on one thread, as tasks of an array, and killed in between.
    let parts = planned(&folder, PIT, "parts");
    ok(sweep(&["run", shown(&parts), "--chunks", "2..3"])
        .env("RAYON_NUM_THREADS", "1")
        .output()
        .unwrap());
    let mut killed = sweep(&["run", shown(&parts), "--chunk", "0"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    killed.kill().unwrap();
    killed.wait().unwrap();
    let status = json(&ok(run(&["status", shown(&parts), "--json"])));
    assert_eq!(status["broken"].as_array().map(Vec::len), Some(0), "{status}");
    for task in ["0", "1"] {
        let mut array = sweep(&["run", shown(&parts), "--array", "--stride", "2"]);
        ok(array.env("SLURM_ARRAY_TASK_ID", task).output().unwrap());
    }
    assert!(merged(&parts) == whole, "the same rows have other bytes");
    let status = json(&ok(run(&["status", shown(&parts), "--json"])));
    assert!(status["missing"] == "" && status["rows_done"] == 10, "{status}");

    let rows = read_rows(&at_once.with_extension("parquet")).unwrap();
    assert_eq!(rows.index, (0..10).collect::<Vec<_>>());
    assert_eq!(rows.n_failed(), 0, "{:?}", rows.reasons);
    assert_eq!(rows.outcomes.len(), Outcome::ALL.len());
    let speeds = &rows.column("target_speed_m_s").unwrap().values;
    assert!(speeds.iter().all(|speed| (15.0..=20.0).contains(speed)), "{speeds:?}");
    let travel = &rows.column("travel_m").unwrap().values;
    assert!(travel.iter().all(|travel| (5.0..600.0).contains(travel)), "{travel:?}");
    let contact = &rows.column("contact_s").unwrap().values;
    assert!(contact.iter().any(|contact| *contact > 0.0), "{contact:?}");

    // Other chunks and fewer rows: what is there is the same.
    let plan = PIT.replace("n = 10", "n = 7").replace("chunk = 3", "chunk = 5");
    let fewer = planned(&folder, &plan, "fewer");
    ok(run(&["run", shown(&fewer)]));
    merged(&fewer);
    let fewer = read_rows(&fewer.with_extension("parquet")).unwrap();
    assert_eq!(bits(&fewer, 7), bits(&rows, 7));
}

#[test]
fn a_broken_chunk_is_found_and_computed_anew() {
    let folder = TempDir::new().unwrap();
    let sweep = planned(&folder, &PIT.replace("n = 10", "n = 6"), "sweep");
    ok(run(&["run", shown(&sweep)]));
    let before = fs::read(chunk_path(&sweep, 1)).unwrap();
    fs::write(chunk_path(&sweep, 1), &before[..before.len() / 2]).unwrap();
    let output = run(&["status", shown(&sweep)]);
    assert_eq!(output.status.code(), Some(1), "a broken chunk is a problem");
    assert_eq!(ok(run(&["status", shown(&sweep), "--missing"])), "1\n");
    let out = folder.path().join("all.parquet");
    // It wrote Parquet under this name.
    let text = folder.path().join("all.csv");
    let said = error(&["merge", shown(&sweep), "--out", shown(&text), "--overwrite"]);
    assert!(said.contains("all.csv: cannot be made; expected a name that ends in .parquet"));
    assert!(!text.exists());
    let said = error(&["merge", shown(&sweep), "--out", shown(&out)]);
    assert!(said.contains("part-000001.parquet: is no whole table"), "{said}");
    assert!(!out.exists());
    let told = ok(run(&["run", shown(&sweep)]));
    assert!(told.contains("part-000001.parquet: computed anew"), "{told}");
    assert!(told.contains("1 chunks computed, 3 rows"), "{told}");
    assert_eq!(fs::read(chunk_path(&sweep, 1)).unwrap(), before);
    // A chunk under another number is none of this plan.
    fs::copy(chunk_path(&sweep, 0), chunk_path(&sweep, 1)).unwrap();
    assert_eq!(ok(run(&["status", shown(&sweep), "--missing", "--stride", "1"])), "0\n");
    fs::remove_file(chunk_path(&sweep, 0)).unwrap();
    let said = error(&["merge", shown(&sweep), "--out", shown(&out)]);
    assert!(said.contains("sweep: chunks are missing: 0;"), "{said}");
}

/// A chunk that could not be opened ended `status` with an error, and nothing was told of all the others.
#[test]
fn a_chunk_that_cannot_be_read_is_told_beside_all_others() {
    let folder = TempDir::new().unwrap();
    let plan = PIT.replace("n = 10", "n = 4").replace("chunk = 3", "chunk = 1");
    let sweep = planned(&folder, &plan, "sweep");
    ok(run(&["run", shown(&sweep), "--chunks", "0,2-3"]));
    fs::create_dir(chunk_path(&sweep, 1)).unwrap();
    let mut later = fs::read(chunk_path(&sweep, 2)).unwrap();
    later.truncate(later.len() / 2);
    fs::write(chunk_path(&sweep, 2), later).unwrap();
    let output = run(&["status", shown(&sweep), "--json"]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let status = json(&String::from_utf8(output.stdout).unwrap());
    assert!(status["chunks_done"] == 2 && status["missing"] == "1-2", "{status}");
    let broken = status["broken"].as_array().unwrap();
    assert!(broken.len() == 2 && broken[1][0] == 2, "{status}");
    assert_eq!(broken[0], serde_json::json!([1, "is a folder, expected a file"]));
    let output = run(&["status", shown(&sweep)]);
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.contains("part-000001.parquet: is a folder, expected a file\n"), "{told}");
    let out = folder.path().join("all.parquet");
    for command in [&["merge", "--out", shown(&out)][..], &["run", "--chunk", "1"]] {
        let args = [&command[..1], &[shown(&sweep)], &command[1..]].concat();
        let said = error(&args);
        assert!(said.contains("part-000001.parquet: is a folder, expected a file"), "{said}");
    }
    assert!(!out.exists());
}

/// Hours of rows were lost where a plan was made anew in the folder of another one.
#[test]
fn whole_rows_of_another_plan_are_not_replaced() {
    let folder = TempDir::new().unwrap();
    let plan = PIT.replace("n = 10", "n = 2").replace("chunk = 3", "chunk = 1");
    let first = planned(&folder, &plan, "first");
    ok(run(&["run", shown(&first), "--chunk", "1"]));
    let second = planned(&folder, &plan.replace("seed = 5", "seed = 6"), "second");
    let foreign = chunk_path(&second, 1);
    fs::copy(chunk_path(&first, 1), &foreign).unwrap();
    let before = fs::read(&foreign).unwrap();
    let said = error(&["run", shown(&second), "--chunk", "1"]);
    assert!(said.contains("part-000001.parquet: holds rows of another plan"), "{said}");
    assert!(fs::read(&foreign).unwrap() == before, "they are as they were");
}

#[test]
fn a_plan_that_is_wrong_is_refused_with_its_place() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("plan.toml");
    let out = folder.path().join("out");
    for (line, instead, expected) in [
        ("seed = 5", "sede = 5", "plan.toml:5:1: unknown field `sede`"),
        ("[vary.esc]", "[vary.ecs]", "vary.ecs"),
        (
            "uniform = [15, 20]",
            "uniform = [20, 15]",
            "plan.toml:13:11: vary.target_speed_m_s.uniform",
        ),
        // Every row had the upper end.
        ("uniform = [15, 20]", "uniform = [-1e308, 1e308]", "low < high and a finite width"),
        ("uniform = [15, 20]", "uniform = [-inf, 20]", "uniform is [-inf, 20], expected finite"),
        ("uniform = [15, 20]", "lognormal = [15, 900]", "plan.toml:13:13: vary.target_speed_m_s"),
        ("uniform = [15, 20]", "steps = [-1e308, 1e308, 3]", "each above the last"),
        ("uniform = [15, 20]", "uniform = [15, 200]", "expected 1 to 100 m/s throughout"),
        ("uniform = [15, 20]", "normal = [15, 2]", "with low and high"),
        ("list = [0, 1]", "list = [0, 2]", "a list of whole numbers, 0 to 1"),
        ("limit_s = 20", "limit_s = 1000", "plan.toml:9:11: pit.limit_s is 1000"),
        ("limit_s = 20", "friction_sigma = -1", "plan.toml:9:18: pit.friction_sigma is -1"),
        // Each place was there twice.
        (
            "uniform = [15, 20]",
            "steps = [15, 15, 2]",
            "number of values from 2 to 10000] with low < high",
        ),
        ("toyota-camry-2018", "camry", "not \"camry\""),
        // Every row had the first pair.
        (
            "pairs = [",
            "pairs = [{ struck = \"toyota-rav4-2019\", striking = \"ford-explorer-2020\" }, ",
            "plan.toml:10:9: pit.pairs",
        ),
        ("n = 10", "n = 0", "plan.toml:3:5: n is 0, expected 1 to"),
        ("pit-right-rear", "carpenter-welcher-barrier", "plan.toml:8:12: pit.scenario"),
    ] {
        assert!(PIT.contains(line), "{line}");
        fs::write(&file, PIT.replacen(line, instead, 1)).unwrap();
        let said = error(&["plan", shown(&file), "--out", shown(&out)]);
        assert!(said.contains(expected), "{instead}: {said}");
        assert!(!out.exists(), "{instead}");
    }
}

#[test]
fn every_file_that_a_row_may_read_is_known_by_its_content() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    let vehicles = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/vehicles");
    for (name, of) in [("a.toml", "reference-2000.toml"), ("b.toml", "target-2000.toml")] {
        fs::copy(vehicles.join(of), at(name)).unwrap();
    }
    let [a, b] = ["a.toml", "b.toml"].map(|name| shown(&at(name)).to_owned());
    let mut question = program();
    question.args(["simulate", "--vehicle", &a, "--speed", "20"]);
    question.args(["--duration", "1", "--print-request"]);
    fs::write(at("ask.json"), ok(question.output().unwrap())).unwrap();
    let plan = format!(
        "question = \"request\"\ndesign = \"grid\"\nn = 1\n[request]\nfile = \"ask.json\"\n\
         outcomes = [{{ name = \"x_m\", at = \"/end/x_m\", unit = \"m\" }}]\n\
         [vary.vehicle]\nat = \"/vehicle/File\"\nlist = ['{a}', '{b}']\n"
    );
    let sweep = planned(&folder, &plan, "vehicles");
    ok(run(&["run", shown(&sweep)]));
    let told = ok(run(&["status", shown(&sweep)]));
    assert!(told.contains("failed   0"), "{told}");
    let path = sweep.join("plan.json");
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(json(&text)["files"].as_array().map(Vec::len), Some(2), "{text}");
    // It says where they are from its own folder, so that both go to another place together.
    let place = folder.path().to_str().unwrap();
    assert!(!text.contains(place) && text.contains("\"../a.toml\""), "{text}");
    let chunk = fs::read(chunk_path(&sweep, 0)).unwrap();
    let elsewhere = TempDir::new().unwrap();
    for name in ["a.toml", "b.toml"] {
        fs::copy(at(name), elsewhere.path().join(name)).unwrap();
    }
    let moved = elsewhere.path().join("moved");
    fs::create_dir(&moved).unwrap();
    fs::copy(&path, moved.join("plan.json")).unwrap();
    ok(run(&["run", shown(&moved)]));
    assert!(fs::read(chunk_path(&moved, 0)).unwrap() == chunk, "the chunk depends on the place");
    // Plans of the first format have absolute paths.
    let mut first = json(&text.replace("../a.toml", &a).replace("../b.toml", &b));
    first["format"] = 1.into();
    let old = folder.path().join("old");
    fs::create_dir(&old).unwrap();
    fs::write(old.join("plan.json"), first.to_string()).unwrap();
    ok(run(&["run", shown(&old)]));
    let told = ok(run(&["status", shown(&old)]));
    assert!(told.contains("failed   0"), "{told}");
    // A plan that leaves a file out reads it in no row.
    fs::remove_file(chunk_path(&sweep, 0)).unwrap();
    let mut fewer = json(&text);
    fewer["files"].as_array_mut().unwrap().pop();
    fs::write(&path, fewer.to_string()).unwrap();
    ok(run(&["run", shown(&sweep)]));
    let told = ok(run(&["status", shown(&sweep)]));
    assert!(told.contains("failed   1") && told.contains("does not know its content"), "{told}");
    fs::write(&path, &text).unwrap();
    fs::write(at("b.toml"), fs::read_to_string(at("b.toml")).unwrap() + "# changed\n").unwrap();
    let said = error(&["run", shown(&sweep)]);
    assert!(said.contains("plan.json: the plan was made with the content of"), "{said}");
    assert!(said.contains("b.toml"), "{said}");
}

/// A data set, whose folder stands in the question, named from the folder in which the plan is made.
#[test]
fn a_plan_finds_what_was_named_from_another_folder_and_moves_with_it() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/trajectories-fea");
    fs::create_dir_all(at("here/data/trajectories")).unwrap();
    for name in ["cases.csv", "vehicle.toml", "trajectories/FE_c001.csv"] {
        let text = fs::read_to_string(shipped.join(name)).unwrap();
        let n_lines = if name == "cases.csv" { 2 } else { usize::MAX };
        let lines: Vec<&str> = text.lines().take(n_lines).collect();
        fs::write(at("here/data").join(name), lines.join("\n") + "\n").unwrap();
    }
    let in_here = |command: &mut Command| ok(command.current_dir(at("here")).output().unwrap());
    let ask = ["simulate", "--dataset", "data", "--case", "FE_c001", "--print-request"];
    fs::write(at("ask.json"), in_here(program().args(ask))).unwrap();
    let plan = "question = \"request\"\ndesign = \"grid\"\nn = 1\n[request]\nfile = \"ask.json\"\n\
                outcomes = [{ name = \"error_m\", at = \"/cases/0/average_error_m\", unit = \"m\" }]\n\
                [vary.case]\nat = \"/case\"\nlist = [\"FE_c001\"]\n";
    fs::write(at("plan.toml"), plan).unwrap();
    in_here(&mut sweep(&["plan", "../plan.toml", "--out", "../sweep"]));
    ok(run(&["run", shown(&at("sweep"))]));
    let told = ok(run(&["status", shown(&at("sweep"))]));
    assert!(told.contains("failed   0"), "{told}");
    let text = fs::read_to_string(at("sweep/plan.json")).unwrap();
    assert!(text.contains("\"dataset\": \"../here/data\""), "{text}");
    assert!(!text.contains(shown(folder.path())), "{text}");

    let chunk = fs::read(chunk_path(&at("sweep"), 0)).unwrap();
    fs::create_dir_all(at("elsewhere/sweep")).unwrap();
    fs::rename(at("here"), at("elsewhere/here")).unwrap();
    fs::rename(at("sweep/plan.json"), at("elsewhere/sweep/plan.json")).unwrap();
    ok(run(&["run", shown(&at("elsewhere/sweep"))]));
    let moved = fs::read(chunk_path(&at("elsewhere/sweep"), 0)).unwrap();
    assert!(moved == chunk, "the chunk depends on the place");
}

#[test]
fn a_plan_of_another_program_or_of_another_file_is_not_run() {
    let folder = TempDir::new().unwrap();
    let sweep = planned(&folder, PIT, "sweep");
    let path = sweep.join("plan.json");
    let text = fs::read_to_string(&path).unwrap();
    let mut plan = json(&text);
    plan["program"] = "0.0.1+other".into();
    fs::write(&path, plan.to_string()).unwrap();
    let said = error(&["run", shown(&sweep), "--chunk", "0"]);
    assert!(said.contains("plan.json: the plan was made with impactlab 0.0.1+other"), "{said}");
    let mut plan = json(&text);
    plan["networks"]["force"] = "ab".into();
    fs::write(&path, plan.to_string()).unwrap();
    let said = error(&["run", shown(&sweep), "--chunk", "0"]);
    assert!(said.contains("plan.json: the plan was made with networks"), "{said}");
    let mut plan = json(&text);
    plan["chunk"] = 0.into();
    fs::write(&path, plan.to_string()).unwrap();
    let said = error(&["status", shown(&sweep)]);
    assert!(said.contains("plan.json: is no plan of a sweep: chunk"), "{said}");
    // The usual car took the place of one that nobody knows.
    fs::write(&path, text.replace("toyota-camry-2018", "camry")).unwrap();
    let said = error(&["run", shown(&sweep), "--chunk", "0"]);
    assert!(said.contains("plan.json: is no plan of a sweep: pit.pairs"), "{said}");
    // It counted as 0.
    let mut plan = json(&text);
    plan["question"]["pit"]["road_sigma"] = (-0.05_f64).into();
    fs::write(&path, plan.to_string()).unwrap();
    let said = error(&["run", shown(&sweep), "--chunk", "0"]);
    assert!(said.contains("is no plan of a sweep: pit.friction_sigma: expected 0 to"), "{said}");
    fs::write(&path, &text).unwrap();
    let said = error(&["run", shown(&sweep), "--chunk", "4"]);
    assert!(said.contains("there is no chunk 4"), "{said}");
    // Another plan does not take the place of this one.
    let other = folder.path().join("other.toml");
    fs::write(&other, PIT.replace("seed = 5", "seed = 6")).unwrap();
    let said = error(&["plan", shown(&other), "--out", shown(&sweep)]);
    // It told of an --overwrite that there is not.
    assert!(said.contains("plan.json: is another plan"), "{said}");
    assert!(said.contains("another folder") && !said.contains("--overwrite"), "{said}");
    assert_eq!(fs::read_to_string(&path).unwrap(), text);
    // A folder that cannot be made “cannot be read”.
    let said = error(&["plan", shown(&other), "--out", shown(&other)]);
    assert!(said.contains("other.toml: is no folder"), "{said}");
    let below = other.join("below");
    let said = error(&["plan", shown(&other), "--out", shown(&below)]);
    assert!(said.contains("cannot be written"), "{said}");
}

#[test]
fn the_batch_file_for_slurm_is_a_script_of_the_shell() {
    let folder = TempDir::new().unwrap();
    let sweep = planned(&folder, PIT, "a 'b'");
    let script = ok(run(&["script", "slurm", shown(&sweep), "--program", "/opt/impactlab"]));
    assert!(script.contains("#SBATCH --array=0-3\n"), "{script}");
    assert!(script.contains("--array --stride 4\n") && script.contains("afterany:"), "{script}");
    let file = folder.path().join("sweep.sh");
    fs::write(&file, &script).unwrap();
    ok(Command::new("bash").arg("-n").arg(&file).output().unwrap());
    // The list of a sweep of which nothing is missing is empty, and sent off the whole array.
    let mut again = Command::new("bash");
    again.arg(&file).arg("").env_remove("SLURM_JOB_ID");
    assert_eq!(ok(again.output().unwrap()), "no chunk is missing, and nothing was sent off\n");
    let quoted = script.lines().find(|line| line.starts_with("plan=")).unwrap();
    let echo = format!("{quoted}; printf %s \"$plan\"");
    let echoed = ok(Command::new("bash").args(["-c", &echo]).output().unwrap());
    assert_eq!(Path::new(&echoed), sweep);
}
