//! What the program prints as JSON stands in the schemas that it prints, or in the help of the command.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{SCENARIO, TRAJECTORIES, answer, json, ok, program, text};
use impactlab_document::scene::ForecastScene;

const EVIDENCE: &str = "tests/data/evidence/spin.toml";

/// Keys of a schema that restrict a value.
const RESTRICTIONS: [&str; 8] =
    ["$ref", "allOf", "anyOf", "oneOf", "type", "properties", "enum", "const"];

/// The schema of a question (`--request`) or of its answer (`--answer`).
fn schema(question: &str, side: &str) -> Value {
    json(&ok(program().args(["schema", question, side]).output().unwrap()))
}

/// A schema with all that it refers to or is combined from.
fn parts<'a>(root: &'a Value, schema: &'a Value) -> Vec<&'a Value> {
    let mut found = vec![schema];
    if let Some(reference) = schema["$ref"].as_str() {
        let target = root.pointer(reference.trim_start_matches('#'));
        found.extend(parts(root, target.unwrap_or_else(|| panic!("{reference} leads nowhere"))));
    }
    for combination in ["allOf", "anyOf", "oneOf"] {
        for part in schema[combination].as_array().into_iter().flatten() {
            found.extend(parts(root, part));
        }
    }
    found
}

/// Whether a schema admits every value.
fn is_free(schema: &Value) -> bool {
    match schema {
        Value::Object(keys) => !RESTRICTIONS.iter().any(|key| keys.contains_key(*key)),
        other => *other == Value::Bool(true),
    }
}

/// The places of all keys of a value, at any depth, that none of the schemas of their place has.
fn unknown_keys(root: &Value, schemas: &[&Value], value: &Value, place: &str) -> Vec<String> {
    let schemas: Vec<&Value> =
        schemas.iter().copied().flat_map(|schema| parts(root, schema)).collect();
    if schemas.iter().copied().any(is_free) {
        return Vec::new();
    }
    let mut unknown = Vec::new();
    match value {
        Value::Object(fields) => {
            for (key, field) in fields {
                let named = schemas.iter().copied().filter_map(|of| of["properties"].get(key));
                let others = schemas.iter().copied();
                let others = others
                    .flat_map(|of| [&of["additionalProperties"], &of["unevaluatedProperties"]]);
                let others = others.filter(|of| of.is_object() || **of == Value::Bool(true));
                let of_key: Vec<&Value> = named.chain(others).collect();
                let place = if place.is_empty() { key.clone() } else { format!("{place}.{key}") };
                if of_key.is_empty() {
                    unknown.push(place);
                } else {
                    unknown.extend(unknown_keys(root, &of_key, field, &place));
                }
            }
        }
        Value::Array(items) => {
            for (idx, item) in items.iter().enumerate() {
                let of_item = schemas.iter().copied();
                let of_item = of_item.flat_map(|of| [&of["items"], &of["prefixItems"][idx]]);
                let of_item: Vec<&Value> = of_item.filter(|of| !of.is_null()).collect();
                unknown.extend(unknown_keys(root, &of_item, item, &format!("{place}[{idx}]")));
            }
        }
        _ => {}
    }
    unknown
}

/// The lists of keys that stood in the help were written by hand; that of `predict` lacked 6 of 24.
#[test]
fn every_key_that_is_printed_stands_in_its_schema_or_in_the_help() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let braked = ["simulate", "--vehicle", "toyota-camry-2018", "--speed", "20", "--brake", "1.5"];
    let recorded = ["simulate", "--dataset", TRAJECTORIES, "--case", "FE_c001"];
    let questions: [(&[&str], &[&str]); 7] = [
        (&["check"], &["check", SCENARIO, TRAJECTORIES]),
        (&["impact"], &["impact", SCENARIO]),
        (&["predict", "force"], &["predict", "force", "--scenario", SCENARIO]),
        (&["simulate"], &braked),
        (&["simulate"], &recorded),
        (&["predict"], &["predict", "--scenario", SCENARIO, "--draws", "2", "--out", text(&out)]),
        (&["reconstruct"], &["reconstruct", EVIDENCE, "--particles", "60", "--seed", "3"]),
    ];
    for (command, question) in questions {
        let asked = program().args(question).arg("--print-request").output().unwrap();
        let request = json(&ok(asked));
        let name = request["question"].as_str().unwrap();
        let of_request = schema(name, "--request");
        let unknown = unknown_keys(&of_request, &[&of_request], &request, "");
        assert_eq!(unknown, [""; 0], "{question:?}: the schema of {name} lacks keys");

        let help = ok(program().args(command).arg("--help").output().unwrap());
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let words: Vec<&str> = help.split(|c| !is_part(c)).collect();
        let of_answer = schema(name, "--answer");
        for key in unknown_keys(&of_answer, &[&of_answer], &answer(question), "") {
            assert!(words.contains(&key.as_str()), "{question:?}: {key} stands nowhere");
        }
    }
}

#[test]
fn every_question_and_the_case_have_schemas() {
    let list = answer(&["schema"]);
    let names: Vec<&str> = list["questions"]
        .as_array()
        .unwrap()
        .iter()
        .map(|question| question["name"].as_str().unwrap())
        .collect();
    assert!(names.contains(&"fine_tune") && names.contains(&"case"), "{names:?}");
    for name in names {
        for side in ["--request", "--answer"] {
            assert!(schema(name, side)["$schema"].is_string(), "{name} {side}");
        }
    }
    let fine_tune = schema("fine-tune", "--request");
    assert_eq!(fine_tune["properties"]["question"]["const"], "fine_tune");
    let ran = program().args(["schema", "nonsense"]).output().unwrap();
    let error = String::from_utf8(ran.stderr).unwrap();
    assert!(error.contains("no question is called \"nonsense\""), "{error}");
}

/// `render scene` draws no ghosts unless asked to: its help has the number that the window and reports draw.
#[test]
fn the_help_has_the_usual_number_of_ghosts() {
    let help = ok(program().args(["render", "scene", "--help"]).output().unwrap());
    let words: Vec<&str> = help.split_whitespace().collect();
    let usual = format!("Window and reports draw {}", ForecastScene::N_GHOSTS);
    assert!(words.join(" ").contains(&usual), "{help}");
}

/// The words of options follow from the values: a value that is renamed would change what users type.
#[test]
fn options_take_the_words_of_a_question_with_hyphens() {
    let drive = "simulate --speed 15 --engine-braking 0.5";
    let force = "evaluate force --model shipped --data datasets/fea";
    let staged = "evaluate reconstruction datasets/staged";
    let methods =
        "momentum-in-line momentum crush-energy spin-out yaw-mark skid airborne time-distance";
    for (command, pointer, words) in [
        (format!("{staged} --known"), "/known/0", "everything without-edr rest-only"),
        (format!("{staged} --cases"), "/split", "all tuning reported"),
        ("evaluate pairs datasets/pairs --cases".to_owned(), "/split", "all fitted reported"),
        (format!("{force} --bad-cases"), "/bad_cases", "refuse leave-out"),
        (format!("{force} --split"), "/split", "test all"),
        (format!("{drive} --integrator"), "/integrator", "rk4 euler"),
        (format!("{drive} --equations"), "/equations", "corrected paper"),
        (format!("{drive} --driven"), "/ending/engine/axle", "front rear all"),
        (
            "simulate --speed 15 --locked".to_owned(),
            "/ending/damage/0/wheel",
            "front-left front-right rear-left rear-right",
        ),
        ("hand".to_owned(), "/method", methods),
    ] {
        for typed in words.split(' ') {
            let asked = program()
                .args(command.split(' '))
                .args([typed, "--print-request"])
                .output()
                .unwrap();
            let asked = json(&ok(asked));
            let word = asked.pointer(pointer).and_then(Value::as_str).unwrap_or_default();
            assert_eq!(word.to_lowercase(), typed.replace('-', "_"), "{command} {typed}: {asked}");
        }
    }
}

#[test]
fn a_case_file_has_the_keys_of_its_schema() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/examples/pit.impactlab");
    let case = json(&fs::read_to_string(root).unwrap());
    let of_case = schema("case", "--request");
    assert_eq!(unknown_keys(&of_case, &[&of_case], &case, ""), [""; 0]);
}

#[test]
fn a_command_prints_its_question_or_refuses_to_and_writes_nothing() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let case = "assets/examples/pit.impactlab";
    let site = "assets/sites/country-road/site.toml";
    for args in [
        &["case", "check", case][..],
        &["case", "pack", case, "--out", text(&out)],
        &["case", "unpack", "a.zip", "--out", text(&out)],
        &["render", "scene", SCENARIO, "--time", "1", "--out", "a.png"],
        &["export", SCENARIO, "--site", site, "--out", "a.dxf"],
        &["vehicles"],
        &["ranges"],
        &["schema"],
        &["licences"],
        &["app"],
        &[],
    ] {
        let refused = program().args(args).arg("--print-request").output().unwrap();
        let error = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{args:?}: {error}");
        assert!(error.contains("asks no question"), "{args:?}: {error}");
        assert!(refused.stdout.is_empty() && !out.exists(), "{args:?}");
    }
    let asked = program().args(["case", "run", case, "--print-request"]).output().unwrap();
    assert_eq!(json(&ok(asked))[0]["questions"][0]["question"], "impact");
}
