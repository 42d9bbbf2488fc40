//! Tests of the atlas: made of rows, described, cut, drawn and written.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::PathBuf;

use impactlab_core::numerics::random_stream;
use impactlab_sweep::{Column, Outcome, Rows, RowsMeta, rows_bytes};
use rand::RngExt;
use serde_json::Value;
use tempfile::TempDir;

use crate::program::{answer, ok, program, text};

const AXES: &str = "\
[[axis]]
name = \"target_speed_m_s\"
word = \"speed\"
label = \"Speed of the struck car\"
unit = \"mph\"
edges = [30, 40, 50, 60]

[[axis]]
name = \"closing_m_s\"
word = \"closing\"
label = \"Closing speed\"
unit = \"m/s\"
edges = [0, 3, 6]

[[axis]]
name = \"esc\"
word = \"esc\"
label = \"Stability control\"
unit = \"1\"
labels = [\"without ESC\", \"with ESC\"]
";

const MPH_M_S: f64 = 0.447_04;

/// Rows of which three quarters turn without ESC and a quarter with it; no car stands still above
/// 50 mph, and no network applies there.
fn rows(first: u64, n: u64) -> Rows {
    let mut rng = random_stream(1, "rows of a test", first);
    let mut inputs: [Vec<f64>; 3] = Default::default();
    let mut outcomes = vec![Vec::new(); Outcome::ALL.len()];
    for _ in 0..n {
        let speed = MPH_M_S * (30.0 + 30.0 * rng.random::<f64>());
        let esc = f64::from(u8::from(rng.random::<bool>()));
        for (values, value) in inputs.iter_mut().zip([speed, 6.0 * rng.random::<f64>(), esc]) {
            values.push(value);
        }
        let turns = f64::from(u8::from(rng.random::<f64>() < 0.75 - 0.5 * esc));
        let is_fast = speed > 50.0 * MPH_M_S;
        for (outcome, values) in Outcome::ALL.iter().zip(&mut outcomes) {
            values.push(match outcome {
                Outcome::Turns90 => turns,
                Outcome::RestTimeS | Outcome::RestDistanceM if is_fast => f64::NAN,
                Outcome::ForceApplies | Outcome::ResponseApplies if is_fast => 0.1,
                Outcome::ForceApplies | Outcome::ResponseApplies => 0.9,
                Outcome::ReachM => 100.0 * rng.random::<f64>(),
                other if other.is_probability() => 0.0,
                _ => 5.0 + rng.random::<f64>(),
            });
        }
    }
    let names = [("target_speed_m_s", "m/s"), ("closing_m_s", "m/s"), ("esc", "1")];
    let column = |name: &str, unit: &str, values| Column {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    };
    let inputs = names.into_iter().zip(inputs);
    Rows {
        inputs: inputs.map(|((name, unit), values)| column(name, unit, values)).collect(),
        outcomes: Outcome::ALL
            .iter()
            .zip(outcomes)
            .map(|(outcome, values)| column(outcome.name(), outcome.unit(), values))
            .collect(),
        index: (first..first + n).collect(),
        caveats: None,
        reasons: vec![String::new(); n as usize],
        meta: RowsMeta {
            plan_sha256: "5a".repeat(32),
            program: "0.1.0+test".to_owned(),
            ..RowsMeta::default()
        },
    }
}

/// A folder with two chunks of rows, a file of axes, and the atlas that is made of them.
struct Made {
    folder: TempDir,
}

impl Made {
    fn new() -> Self {
        let made = Self { folder: TempDir::new().unwrap() };
        fs::write(made.path("axes.toml"), AXES).unwrap();
        for (name, first) in [("a.parquet", 0), ("b.parquet", 3000)] {
            fs::write(made.path(name), rows_bytes(&rows(first, 3000)).unwrap()).unwrap();
        }
        let args = made.make(&["a.parquet", "b.parquet"]);
        let told = answer(&args.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!((&told["n_rows"], &told["n_cells"]), (&6000.into(), &12.into()));
        made
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        text(&self.path(name)).to_owned()
    }

    /// Arguments that make the atlas.
    fn make(&self, rows: &[&str]) -> Vec<String> {
        let mut args = vec!["atlas".to_owned(), "make".to_owned()];
        args.extend(rows.iter().map(|name| self.text(name)));
        for (option, name) in [("--axes", "axes.toml"), ("--out", "test.atlas")] {
            args.extend([option.to_owned(), self.text(name)]);
        }
        args
    }

    fn answer(&self, args: &[&str]) -> Value {
        answer(&reading(args, &self.text("test.atlas")))
    }

    fn printed(&self, args: &[&str]) -> String {
        let atlas = self.text("test.atlas");
        ok(program().args(reading(args, &atlas)).output().unwrap())
    }

    /// What a command that must fail says.
    fn refused(&self, args: &[&str]) -> String {
        let atlas = self.text("test.atlas");
        let output = program().args(reading(args, &atlas)).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{args:?}");
        String::from_utf8(output.stderr).unwrap()
    }
}

/// Arguments of a command that reads an atlas.
fn reading<'a>(args: &[&'a str], atlas: &'a str) -> Vec<&'a str> {
    [&["atlas"][..], args, &["--atlas", atlas]].concat()
}

fn is_close(value: &Value, expected: f64, tolerance: f64) -> bool {
    value.as_f64().is_some_and(|value| (value - expected).abs() <= tolerance)
}

#[test]
fn an_atlas_says_what_it_is_and_what_its_cells_hold() {
    let made = Made::new();
    let described = made.answer(&[]);
    let note = described["note"].as_str().unwrap();
    assert!(
        note.contains("model study") && note.ends_with("this program: force, response"),
        "{note}"
    );
    assert_eq!(described["axes"][2]["labels"][1], "with ESC");
    assert_eq!(described["has_sensitivity"], false);
    let printed = made.printed(&[]);
    for part in ["safe speed", "48.28 to 64.37 km/h", "turns_90", "corridor_length_m"] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
    for (esc, share) in [("without ESC", 0.75), ("1", 0.25)] {
        let cell = made.answer(&["cell", "--set", &format!("esc={esc}"), "--set", "speed=45mph"]);
        let n = cell["n_rows"].as_f64().unwrap();
        assert!((900.0..1100.0).contains(&n), "{n}");
        let outcomes = cell["outcomes"].as_array().unwrap();
        let turns = outcomes.iter().find(|of| of["name"] == "turns_90").unwrap();
        let error = turns["standard_error"].as_f64().unwrap();
        assert!((error - (share * (1.0 - share) / n).sqrt()).abs() < 1e-3, "{error}");
        assert!(is_close(&turns["mean"], share, 4.0 * error), "{turns}");
        let length = &cell["corridor"]["length_m"];
        assert!(is_close(&length["value"], 90.0, 5.0), "{length}");
    }
    let fast = made.answer(&["cell", "--set", "speed=55mph"]);
    assert!(is_close(&fast["inside"], 0.0, 0.0), "{fast}");
    let outcomes = fast["outcomes"].as_array().unwrap();
    let rest = outcomes.iter().find(|of| of["name"] == "rest_time_s").unwrap();
    assert_eq!((&rest["mean"], &rest["n_applies"]), (&Value::Null, &0.into()));
}

#[test]
fn a_map_is_a_table_a_picture_and_numbers() {
    let made = Made::new();
    let slice = ["slice", "--x", "speed", "--y", "closing", "--set", "esc=0"];
    let map = made.answer(&slice);
    let cells = map["cells"].as_array().unwrap();
    assert_eq!((cells.len(), &map["outcome"]), (6, &Value::from("turns_90")));
    assert!(cells.iter().all(|cell| is_close(&cell["mean"], 0.75, 0.1)), "{map}");
    let printed = made.printed(&slice);
    assert!(printed.contains("Stability control: without ESC"), "{printed}");
    // The networks apply nowhere above 50 mph.
    assert_eq!(printed.matches("not to be relied upon").count(), 2, "{printed}");
    // Nor does a car stand still there, of which the number of all rows was told.
    let rests = made.printed(&[&slice[..], &["--outcome", "rest_time_s"]].concat());
    assert_eq!(rests.matches("  0 of ").count(), 2, "{rests}");

    let csv = made.path("map.csv");
    made.answer(&[&slice[..], &["--out", text(&csv)]].concat());
    let table = fs::read_to_string(&csv).unwrap();
    assert!(table.starts_with("target_speed_m_s_low,target_speed_m_s_high,closing_m_s_low,"));
    assert_eq!(table.lines().count(), 7, "{table}");
    assert_eq!(table.matches(",true,,\n").count(), 2, "{table}");
    // Nothing said of which rows the numbers are, nor that they are a study.
    let first = table.lines().nth(1).unwrap();
    assert!(first.contains("a model study") && first.contains(": without ESC"), "{first}");
    assert!(made.refused(&[&slice[..], &["--out", text(&csv)]].concat()).contains("exists"));

    for (name, more) in [("light.png", &[][..]), ("dark.png", &["--dark"][..])] {
        let png = made.path(name);
        let size = ["--size", "1280x800", "--out", text(&png)];
        made.answer(&[&slice[..], &size, more].concat());
        let picture = image::open(&png).unwrap().to_rgb8();
        assert_eq!(picture.dimensions(), (1280, 800));
        // The cells are blue: three quarters of the way to the end of the scale.
        let is_blue = |pixel: &image::Rgb<u8>| pixel.0[2] > 100 && pixel.0[0] < 80;
        let n_blue = picture.pixels().filter(|pixel| is_blue(pixel)).count();
        assert!(n_blue > 1280 * 800 / 4, "{name}: {n_blue}");
    }
}

#[test]
fn mistakes_are_named() {
    let made = Made::new();
    for (args, part) in [
        (&["cell", "--set", "speed=200mph"][..], "48.28 km/h to 96.56 km/h"),
        (&["cell", "--set", "speed=200mph", "--units", "us"][..], "30.00 mph to 60.00 mph"),
        (&["cell", "--set", "speed=fast"][..], "expected a number"),
        (&["cell", "--set", "esc=2"][..], "0: without ESC, 1: with ESC"),
        (&["cell", "--set", "mass=2000"][..], "expected one of speed, closing, esc"),
        (&["slice", "--x", "speed", "--y", "speed"][..], "both name"),
        // The last one of two values was taken, and one of an axis of the map left out.
        (
            &["cell", "--set", "speed=35mph", "--set", "speed=45mph"],
            "--set speed: the axis is set twice",
        ),
        (
            &["slice", "--x", "speed", "--y", "closing", "--set", "closing=1"],
            "--set closing: the map goes over that axis",
        ),
        (&["slice", "--x", "speed", "--y", "esc", "--outcome", "luck"][..], "turns_180"),
        (&["slice", "--x", "speed", "--y", "esc", "--out", "a.jpg"][..], ".png or .csv"),
        (&["sensitivity"][..], "no Sobol indices"),
    ] {
        let error = made.refused(args);
        assert!(error.contains(part), "{args:?}: {error}");
    }
    // Rows twice, rows of another kind, and no rows.
    fs::remove_file(made.path("test.atlas")).unwrap();
    let make = |rows: &[&str]| {
        let output = program().args(made.make(rows)).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{rows:?}");
        assert!(!made.path("test.atlas").exists(), "{rows:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(make(&["a.parquet", "a.parquet"]).contains("row 0 is there twice"));
    assert!(make(&["axes.toml"]).contains("axes.toml"));
    let mut other = rows(9000, 100);
    other.meta.plan_sha256 = "00".repeat(32);
    fs::write(made.path("other.parquet"), rows_bytes(&other).unwrap()).unwrap();
    assert!(make(&["a.parquet", "other.parquet"]).contains("different plans"));
    other.outcomes.pop();
    fs::write(made.path("short.parquet"), rows_bytes(&other).unwrap()).unwrap();
    assert!(make(&["short.parquet"]).contains("no column \"response_applies\""));
}

#[test]
fn what_is_no_atlas_is_refused() {
    let made = Made::new();
    let bytes = fs::read(made.path("test.atlas")).unwrap();
    let refused = |name: &str, bytes: &[u8]| {
        let path = made.path(name);
        fs::write(&path, bytes).unwrap();
        let output = program().args(["atlas", "--atlas", text(&path)]).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{name}");
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains(name) && error.contains("is no atlas"), "{error}");
    };
    refused("empty.atlas", b"");
    refused("text.atlas", b"speed,closing\n1,2\n");
    refused("cut.atlas", &bytes[..bytes.len() / 2]);
}

#[test]
fn the_shipped_atlas_is_of_the_shipped_plans_and_networks() {
    let folder = TempDir::new().unwrap();
    let shipped = answer(&["atlas"]);
    assert_eq!(
        shipped["n_rows"].as_u64().unwrap() + shipped["n_failed"].as_u64().unwrap(),
        1 << 15
    );
    assert_eq!(shipped["has_sensitivity"], true);
    // Base points with a row that failed, or without the outcome, are in no index.
    let indices = answer(&["atlas", "sensitivity", "--outcome", "turns_90"]);
    assert!((900..=1024).contains(&indices["outcomes"][0]["n_bases"].as_u64().unwrap()));
    let out = folder.path().join("pit");
    answer(&["sweep", "plan", "assets/atlas/pit.toml", "--out", text(&out)]);
    let plan: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("plan.json")).unwrap()).unwrap();
    assert_eq!(shipped["networks"], plan["networks"]);
    // Of the middle of the speeds, everything else averaged over.
    let cell = answer(&["atlas", "cell", "--set", "speed=52mph"]);
    assert!(cell["n_rows"].as_u64().unwrap() > 1000, "{cell}");
    assert!(!cell["note"].as_str().unwrap().contains("other networks"), "{cell}");
    // It was told as “too few rows”.
    let corridor = &cell["corridor"];
    assert_eq!(
        (&corridor["width_m"], &corridor["width_more_than_m"]),
        (&Value::Null, &60.0.into())
    );
    assert_eq!(corridor["length_more_than_m"], Value::Null);
    let output = program().args(["atlas", "cell", "--set", "speed=52mph"]).output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(printed.contains("more than 60.00 m") && !printed.contains("too few"), "{printed}");
    // A share of many rows was told as “99.9 % ± 0.0 %”.
    let output = program().args(["atlas", "cell"]).output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(printed.contains("% ± 0.1 %") && !printed.contains("% ± 0.0 %"), "{printed}");
}

#[test]
fn the_plans_of_the_shipped_atlas_are_plans() {
    let folder = TempDir::new().unwrap();
    for (name, n_rows) in [("pit", 1 << 15), ("pit-saltelli", 1024 * 12)] {
        let (plan, out) = (format!("assets/atlas/{name}.toml"), folder.path().join(name));
        let planned = answer(&["sweep", "plan", &plan, "--out", text(&out)]);
        assert_eq!(planned["rows"], n_rows, "{planned}");
    }
}
