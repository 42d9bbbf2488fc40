//! Tests of the commands of the response network: pre-training, fine-tuning, resuming after a kill,
//! evaluation, comparison and prediction.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use impactlab_networks::response::evaluate::Comparison;
use serde_json::{Value, json as value};
use tempfile::TempDir;

use crate::program::{
    SCENARIO, TINY_RESPONSE_NETWORK, TRAJECTORIES as DATA, json, kill_at_checkpoint, ok, program,
};

const EFFORT: &str = "\
[pretraining]
motions = 4
epochs = 2

[single_steps]
epochs = 6

[rollouts]
lengths = [5]
epochs = 6

[calibration]
folds = 2

[tuning]
particles = 3
iterations = 1
";

struct Workplace {
    folder: TempDir,
    config: PathBuf,
    pretrained: PathBuf,
    tuned: PathBuf,
    /// The evaluation of the tuned model.
    evaluated: Value,
}

fn fine_tune(place: (&Path, &Path), model: &Path) -> Command {
    let (config, pretrained) = place;
    let mut command = program();
    command.args(["fine-tune", "response", "--data", DATA, "--trajectories", "4", "--json"]);
    command.arg("--config").arg(config).arg("--model").arg(pretrained).arg("--out").arg(model);
    command
}

/// Returns two tiny models, which are trained once for all tests.
fn workplace() -> &'static Workplace {
    static PLACE: OnceLock<Workplace> = OnceLock::new();
    PLACE.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let [config, pretrained, tuned] =
            ["tiny.toml", "pretrained", "tuned"].map(|name| folder.path().join(name));
        fs::write(&config, [TINY_RESPONSE_NETWORK, EFFORT].concat()).unwrap();
        let mut train = program();
        train.args(["train", "response", "--data", "datasets/fea", "--json"]);
        train.arg("--config").arg(&config).arg("--out").arg(&pretrained);
        let report = json(&ok(train.output().unwrap()));
        assert_eq!((&report["n_simulated"], &report["epochs"]), (&Value::from(4), &Value::from(2)));
        let report = json(&ok(fine_tune((&config, &pretrained), &tuned).output().unwrap()));
        assert_eq!(report["train"].as_array().unwrap().len(), 4);
        assert_eq!((&report["n_test"], &report["epochs"]), (&Value::from(25), &Value::from(14)));
        assert_eq!(report["latents"]["n_calibrated"], 4);
        let evaluated = evaluate(&tuned);
        Workplace { folder, config, pretrained, tuned, evaluated }
    })
}

fn evaluate(model: &Path) -> Value {
    let mut command = program();
    command.args(["evaluate", "response", "--data", DATA, "--json", "--model"]).arg(model);
    json(&ok(command.output().unwrap()))
}

/// Returns the errors of an evaluation, without the durations, which differ between runs.
fn errors(comparison: &Value) -> Value {
    comparison["models"][0]["average_error_m"].clone()
}

#[test]
fn a_killed_fine_tuning_goes_on_to_the_same_model() {
    let place = workplace();
    let killed = place.folder.path().join("killed");
    let start = (place.config.as_path(), place.pretrained.as_path());
    kill_at_checkpoint(&mut fine_tune(start, &killed), &killed);
    ok(fine_tune(start, &killed).arg("--resume").output().unwrap());
    assert_eq!(errors(&evaluate(&killed)), errors(&place.evaluated));
    let other = fine_tune(start, &killed).args(["--resume", "--seed", "9"]).output().unwrap();
    let message = String::from_utf8(other.stderr).unwrap();
    assert!(message.contains("the training to resume had another"), "{message}");
}

#[test]
fn evaluation_and_comparison_have_their_keys() {
    let place = workplace();
    assert_eq!(place.evaluated["test"].as_array().unwrap().len(), 25);
    let out = place.folder.path().join("comparison");
    let mut command = program();
    command.args(["compare", "--data", DATA, "--trajectories", "3", "--choices", "2", "--json"]);
    command.arg("--config").arg(&place.config).arg("--model").arg(&place.pretrained);
    command.arg("--out").arg(&out);
    let comparison = json(&ok(command.output().unwrap()));
    let models = comparison["models"].as_array().unwrap();
    let names: Vec<&str> = models.iter().map(|model| model["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["4DOF untuned", "4DOF tuned", "NN-only", "PINN"]);
    for model in models {
        assert!(model["average_error_m"]["median"].as_f64().unwrap() > 0.0, "{model}");
        assert!(model["rmse"]["yaw_rate_deg_s"]["mean"].is_number());
        assert!(model["time_per_step_us"].is_number() && model["violations"].is_number());
    }
    let network = &models[3];
    assert_eq!(network["n"], 50);
    assert_eq!(network["violations"], 0);
    assert!(network["coverage"]["90"].as_f64().unwrap() > 0.0);
    assert!(models[0]["coverage"].is_null());
    assert!(!comparison["clusters"].as_array().unwrap().is_empty());
    // The error of the untuned 4DOF model does not depend on the tiny network.
    let untuned = models[0]["average_error_m"]["mean"].as_f64().unwrap();
    assert!((0.5..1.5).contains(&untuned), "{untuned}");
    let text = fs::read_to_string(out.join("comparison.md")).unwrap();
    assert!(text.contains("| PINN | 3 |") && text.contains("other data"), "{text}");
    for file in ["comparison.json", "models.csv", "horizons.csv", "uncertainty.csv", "clusters.csv"]
    {
        assert!(out.join(file).is_file(), "{file}");
    }
    let read = Comparison::load(&out.join("comparison.json")).unwrap();
    assert_eq!((read.models.len(), read.test.len()), (4, 25));
    assert!(read.test.iter().all(|case| case.path.len() >= 40));
    assert_eq!(read.cases.len(), 25 * (1 + 3 * 2));
    fs::write(out.join("cut.json"), "{\"data\": \"x\",\n 1}").unwrap();
    let problem = Comparison::load(&out.join("cut.json")).unwrap_err().to_string();
    assert!(problem.contains("cut.json") && problem.contains("line 2"), "{problem}");
}

#[test]
fn a_prediction_writes_trajectory_density_and_outcome() {
    let place = workplace();
    let predict = |duration: &str, out: &Path| {
        let mut command = program();
        command.args([
            "predict",
            "--one-contact",
            "--scenario",
            SCENARIO,
            "--draws",
            "3",
            "--json",
        ]);
        command.args(["--duration", duration]);
        command.arg("--response-model").arg(&place.tuned).arg("--out").arg(out);
        json(&ok(command.output().unwrap()))
    };
    let out = place.folder.path().join("prediction");
    let answer = predict("0.26", &out);
    let outcome = &answer["outcome"];
    assert_eq!((&answer["n_forces"], &outcome["time_s"]), (&Value::from(3), &Value::from(0.26)));
    let x = &outcome["x_m"];
    let [low, high] = [0, 1].map(|end| x["ninety"][end].as_f64().unwrap());
    assert!(low < x["median"].as_f64().unwrap() && x["median"].as_f64().unwrap() < high);
    let probability = outcome["p_quarter_turn"].as_f64().unwrap();
    assert!((0.0..=1.0).contains(&probability));
    let trajectory = fs::read_to_string(out.join("trajectory.csv")).unwrap();
    assert_eq!(trajectory.lines().count(), 1 + 27);
    // After a second contact, which is not computed, no position has a probability, in no file.
    let beyond = place.folder.path().join("beyond");
    let answer = predict("2", &beyond);
    let outcome = &answer["outcome"];
    assert!(outcome["x_m"]["median"].is_number() && outcome["x_m"]["intervals"] == value!([]));
    assert!(outcome["p_quarter_turn"].is_null() && outcome["p_half_turn"].is_null(), "{outcome}");
    assert!(outcome["region_90_m2"].is_null() && !beyond.join("density.csv").exists());
    let rows = fs::read_to_string(beyond.join("trajectory.csv")).unwrap();
    let spread = |at: usize| rows.lines().nth(1 + at).unwrap().split(',').nth(3).unwrap().len();
    assert_eq!((rows.lines().count(), spread(200)), (1 + 201, 0));
    assert!(spread(10) > 0, "before the second contact");
    let density = fs::read_to_string(out.join("density.csv")).unwrap();
    let mut points = density.lines().skip(1).map(|line| {
        // The last column says what restricts the forecast.
        let cells = line.split(',').take(3);
        let numbers: Vec<f64> = cells.map(|cell| cell.parse().unwrap()).collect();
        (numbers[0], numbers[1], numbers[2])
    });
    let (x0, y0, first) = points.next().unwrap();
    let (mut sum, mut step, mut rise) = (first, f64::INFINITY, f64::INFINITY);
    for (x, y, value) in points {
        sum += value;
        step = if x > x0 { step.min(x - x0) } else { step };
        rise = if y > y0 { rise.min(y - y0) } else { rise };
    }
    assert!((sum * step * rise - 1.0).abs() < 0.02, "{}", sum * step * rise);
    assert!(out.join("outcome.json").is_file() && out.join("scene.csv").is_file());
}

#[test]
fn a_recorded_force_takes_the_place_of_the_predicted_one() {
    let place = workplace();
    let out = place.folder.path().join("recorded");
    let mut command = program();
    command.args(["predict", "--scenario", SCENARIO, "--json"]);
    command.args(["--force", "datasets/fea/forces/c001.csv", "--response-model"]);
    command.arg(&place.tuned).arg("--out").arg(&out);
    let answer = json(&ok(command.output().unwrap()));
    assert_eq!(answer["n_forces"], 1);
    assert!(answer["force_model"].is_null() && answer["hooking_probability"].is_null());
}

#[test]
fn a_force_that_does_not_say_where_it_acts_replaces_no_recorded_one() {
    let place = workplace();
    let with_moment = fs::read_to_string("datasets/fea/forces/c001.csv").unwrap();
    let without_moment = place.folder.path().join("without-moment.csv");
    let rows: Vec<String> = with_moment
        .lines()
        .map(|line| line.split(',').take(3).collect::<Vec<_>>().join(","))
        .collect();
    fs::write(&without_moment, rows.join("\n")).unwrap();
    let predict = |force: &Path, contact: &[&str]| {
        let mut command = program();
        let record = "datasets/trajectories-fea/trajectories/FE_c001.csv";
        command.args(["predict", "--trajectory", record, "--force"]).arg(force).args(contact);
        command.arg("--response-model").arg(&place.tuned);
        command.arg("--out").arg(place.folder.path().join("moment")).output().unwrap()
    };
    // The recorded motion has a yaw moment about the centre of gravity and no contact point.
    let refused = predict(&without_moment, &[]);
    let text = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && text.contains("without-moment.csv"), "{text}");
    assert!(text.contains("yaw moment"), "{text}");
    ok(predict(&without_moment, &["--contact", "-2,-0.9,0.5"]));
    ok(predict(Path::new("datasets/fea/forces/c001.csv"), &["--overwrite"]));
}

#[test]
fn what_cannot_be_done_is_said_in_one_line() {
    let place = workplace();
    let error = |command: &mut Command| {
        let output = command.output().unwrap();
        assert!(!output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let text = error(program().args(["predict", "--draws", "3"]));
    assert!(text.contains("--scenario"), "{text}");
    let text = error(
        program()
            .args(["evaluate", "response", "--data", "datasets/fea", "--model"])
            .arg(&place.tuned),
    );
    assert!(text.contains("holds force histories, expected a trajectory data set"), "{text}");
    let start = (place.config.as_path(), place.pretrained.as_path());
    let many = fine_tune(start, &place.folder.path().join("many"))
        .args(["--trajectories", "200"])
        .output();
    assert!(!many.unwrap().status.success());
    let wrong = place.folder.path().join("wrong.toml");
    fs::write(&wrong, "[network]\ncomponents = 0\n").unwrap();
    let text = error(program().args(["compare", "--data", DATA, "--config"]).arg(&wrong));
    let expected = "wrong.toml:2:14: network.components is 0, expected 1 to 32\n";
    assert!(text.ends_with(expected), "{text}");
}

#[test]
fn a_forecast_is_rendered_beside_the_record() {
    let place = workplace();
    let out = place.folder.path().join("forecast.csv");
    let render = |extra: &[&str]| {
        let mut command = program();
        command.args(["render", "forecast", DATA, "--case", "FE_c002", "--out"]).arg(&out);
        command.arg("--response-model").arg(&place.tuned).arg("--overwrite").args(extra);
        command.output().unwrap()
    };
    ok(render(&["--channel", "yaw"]));
    let text = fs::read_to_string(&out).unwrap();
    for name in ["90 % band (low)", "recorded", "central path", "4DOF model"] {
        assert!(text.contains(name), "{name}");
    }
    ok(render(&["--window", "0,2"]));
    assert!(fs::read_to_string(&out).unwrap().contains("density of the CG, 0.00 to 2.00 s"));
    let late = render(&["--time", "9"]);
    assert_eq!(late.status.code(), Some(1));
    assert!(String::from_utf8(late.stderr).unwrap().contains("--time is 9 s"));
}
