//! Sweeps of any request: what its rows hold, and what is said of one that has no answer.

use super::*;

/// The head of a plan that asks for the place at the end of what [`simulation`] has written.
const ASKED: &str = "\
question = \"request\"
design = \"grid\"
n = 1
chunk = 2
[request]
file = \"ask.json\"
outcomes = [{ name = \"x_m\", at = \"/end/x_m\", unit = \"m\" }]
";

/// Writes the request for a drive as `ask.json`.
fn simulation(folder: &TempDir, more: &[&str]) {
    let mut question = program();
    question.args(["simulate", "--vehicle", "reference-2000", "--speed", "20"]);
    question.args(more).arg("--print-request");
    fs::write(folder.path().join("ask.json"), ok(question.output().unwrap())).unwrap();
}

/// A row whose vehicle was still moving, with a driver of whom nobody knew what he did, was like any other.
#[test]
fn a_row_of_a_request_has_the_kinds_of_its_caveats() {
    let folder = TempDir::new().unwrap();
    simulation(&folder, &["--duration", "1", "--until-rest"]);
    let plan = &format!(
        "{ASKED}\
[vary.until_rest]
at = \"/until_rest\"
list = [false, true, 3]
"
    );
    let sweep = planned(&folder, plan, "asked");
    ok(run(&["run", shown(&sweep)]));
    let chunk = fs::read(chunk_path(&sweep, 1)).unwrap();
    let merged = merged(&sweep);
    let rows = read_rows(&sweep.with_extension("parquet")).unwrap();
    let expected = ["", "not_at_rest;driver_open", ""];
    assert_eq!(rows.caveats.as_deref().unwrap(), expected);
    assert!(rows.column("x_m").unwrap().values[2].is_nan(), "{:?}", rows.reasons);

    // Chunks of a program that kept no caveats are merged as they are; beside others they are named.
    for chunk in [0, 1] {
        let path = chunk_path(&sweep, chunk);
        let former = Rows { caveats: None, ..read_rows(&path).unwrap() };
        fs::write(path, rows_bytes(&former).unwrap()).unwrap();
    }
    let out = sweep.with_extension("parquet");
    ok(run(&["merge", shown(&sweep), "--out", shown(&out), "--overwrite"]));
    let former = read_rows(&out).unwrap();
    assert_eq!((former.caveats, former.outcomes.len()), (None, 1));
    fs::write(chunk_path(&sweep, 1), chunk).unwrap();
    fs::write(&out, &merged).unwrap();
    let said = error(&["merge", shown(&sweep), "--out", shown(&out), "--overwrite"]);
    assert!(said.contains("part-000001.parquet") && said.contains("other columns"), "{said}");
    assert!(fs::read(&out).unwrap() == merged, "what was there is kept");

    let plan = plan.replace("\"x_m\"", "\"caveats\"");
    let file = folder.path().join("named.toml");
    fs::write(&file, plan).unwrap();
    let said = error(&["plan", shown(&file), "--out", shown(&folder.path().join("named"))]);
    assert!(said.contains("request.outcomes") && said.contains("not \"caveats\""), "{said}");
}

/// “/home/ann/case/bad.toml:1:8: …” stood in the table, which goes to others.
#[test]
fn the_reason_of_a_row_says_no_folder_of_the_machine() {
    let folder = TempDir::new().unwrap();
    let files = ["bad.toml", "worse.toml"].map(|name| folder.path().join(name));
    files.iter().for_each(|file| fs::write(file, "name = 3\n").unwrap());
    let mut question = program();
    question.args(["impact", "pit-right-rear", "--print-request"]);
    fs::write(folder.path().join("ask.json"), ok(question.output().unwrap())).unwrap();
    let plan = format!(
        "question = \"request\"\ndesign = \"grid\"\nn = 1\n\
         [request]\nfile = \"ask.json\"\n\
         outcomes = [{{ name = \"x_m\", at = \"/x_m\", unit = \"m\" }}]\n\
         [vary.scenario]\nat = \"/scenario/file\"\nlist = {files:?}\n"
    );
    let sweep = planned(&folder, &plan, "asked");
    ok(run(&["run", shown(&sweep)]));
    merged(&sweep);
    let rows = read_rows(&sweep.with_extension("parquet")).unwrap();
    let [bad, worse] = &rows.reasons[..] else { panic!("{:?}", rows.reasons) };
    assert!(bad.starts_with("bad.toml:1:") && worse.starts_with("worse.toml:1:"), "{bad} {worse}");
    assert!(!bad.contains(shown(folder.path())), "{bad}");
}

#[test]
fn any_request_can_be_swept_and_a_row_that_fails_is_a_row_with_its_reason() {
    let folder = TempDir::new().unwrap();
    simulation(&folder, &["--duration", "2"]);
    let plan = &format!(
        "{ASKED}\
[vary.friction]
at = \"/friction\"
list = [0.5, 0.9, 50]
"
    );
    let sweep = planned(&folder, plan, "asked");
    ok(run(&["run", shown(&sweep)]));
    let told = ok(run(&["status", shown(&sweep)]));
    assert!(told.contains("failed   1") && told.contains("friction"), "{told}");
    merged(&sweep);
    let rows = read_rows(&sweep.with_extension("parquet")).unwrap();
    assert_eq!(rows.column("friction").unwrap().values, [0.5, 0.9, 50.0]);
    let x_m = &rows.column("x_m").unwrap().values;
    assert!(x_m[..2].iter().all(|x_m| (35.0..41.0).contains(x_m)) && x_m[2].is_nan(), "{x_m:?}");
    assert!(rows.reasons[2].contains("50"), "{:?}", rows.reasons);
    assert_eq!(rows.column("x_m").unwrap().unit, "m");
    let bad = folder.path().join("bad.toml");
    fs::write(&bad, plan.replace("/friction", "/frictoin")).unwrap();
    let out = folder.path().join("bad");
    let said = error(&["plan", shown(&bad), "--out", shown(&out)]);
    assert!(said.contains("bad.toml:9:6: vary.friction.at") && said.contains("JSON"), "{said}");
    for (line, instead, place) in [
        ("unit = \"m\"", "unit = \"ft\"", "bad.toml:7:12: request.outcomes"),
        (
            "at = \"/friction\"",
            "at = \"/friction\"\nunit = \"%\"",
            "bad.toml:10:8: vary.friction.unit",
        ),
    ] {
        fs::write(&bad, plan.replace(line, instead)).unwrap();
        let said = error(&["plan", shown(&bad), "--out", shown(&out)]);
        assert!(said.contains(place) && said.contains("are in SI units"), "{said}");
    }
    // No row would have had the number, and of two of one name the place was not told.
    let again = "{ name = \"x_m\", at = \"/end/y_m\", unit = \"m\" }, { name";
    for (line, instead, expected) in [
        ("/end/x_m", "end/x_m", "places that begin with \"/\", not \"end/x_m\""),
        ("{ name", again, "a name that no other column has, not \"x_m\""),
    ] {
        fs::write(&bad, plan.replace(line, instead)).unwrap();
        let said = error(&["plan", shown(&bad), "--out", shown(&out)]);
        assert!(said.contains("bad.toml:7:12: request.outcomes"), "{said}");
        assert!(said.contains(expected), "{said}");
    }
    // Two values for one place: one of the columns would say what no row has.
    let again = "[vary.again]\nat = \"/friction\"\nlist = [0.6]\n[vary.friction]";
    fs::write(&bad, plan.replace("[vary.friction]", again)).unwrap();
    let said = error(&["plan", shown(&bad), "--out", shown(&out)]);
    assert!(said.contains("another place than \"/friction\""), "{said}");
}

/// `ask` refuses a key that stands twice, and a sweep took the last one.
#[test]
fn a_request_is_read_as_ask_reads_it() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    let mut question = program();
    question.args(["simulate", "--vehicle", "reference-2000", "--speed", "20"]);
    question.args(["--duration", "1", "--print-request"]);
    let text = ok(question.output().unwrap());
    let twice = text.replace("\"seed\": 0", "\"seed\": 0, \"seed\": 1");
    assert_ne!(twice, text);
    fs::write(at("ask.json"), &twice).unwrap();
    let plan = "question = \"request\"\nn = 1\n[request]\nfile = \"ask.json\"\n\
                outcomes = [{ name = \"x_m\", at = \"/end/x_m\", unit = \"m\" }]\n\
                [vary.\"road.friction\"]\nat = \"/friction\"\nuniform = [0.5, 0.9]\n";
    fs::write(at("plan.toml"), plan).unwrap();
    let out = at("out");
    let said = error(&["plan", shown(&at("plan.toml")), "--out", shown(&out)]);
    assert!(said.contains("ask.json: is no request: duplicate field `seed`"), "{said}");
    // A name with a point was told to have no distribution.
    fs::write(at("ask.json"), &text).unwrap();
    let planned =
        json(&ok(run(&["plan", shown(&at("plan.toml")), "--out", shown(&out), "--json"])));
    assert_eq!(planned["inputs"][0], "road.friction", "{planned}");
}
