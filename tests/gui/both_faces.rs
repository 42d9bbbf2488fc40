//! Every kind of question is asked in the window and on the command line. Both must give the same
//! report, to the last digit that is printed.

mod networks;

use std::path::Path;
use std::process::{Command as Program, Output};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{
    App, Command, Latest, Pane, QuestionJob, ReconstructionCommand, RecorderCommand, State, Subject,
};
use impactlab_core::collision::Role;
use impactlab_study::{ForceSource, ModelChoice, Question, Request, SimulateAnswer, VehicleChoice};
use serde::Serialize;
use serde_json::Value;

use crate::harness::{apply, is_idle, open, state, step_until};
use crate::reconstruct::evidence_in;
use crate::recorder::BEFORE;

const FORCES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea");
const TRAJECTORIES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea");
const SCENARIO: &str = "assets/scenarios/pit_right_rear.toml";

/// Keys of durations, and of the files that only the command line writes.
const NOT_COMPARED: [&str; 4] = ["seconds", "training_s", "time_per_step_us", "out"];

/// A question as the command line asks it.
struct CommandLine<'a> {
    args: &'a [&'a str],
    /// Keys of the report that only the command line prints.
    only_printed: &'a [&'a str],
    /// Keys in which the questions of the two may differ, such as the file of a training's state.
    not_compared: &'a [&'a str],
}

fn run(args: &[&str]) -> Output {
    let mut program = Program::new(env!("CARGO_BIN_EXE_impactlab"));
    program.current_dir(env!("CARGO_MANIFEST_DIR")).args(args);
    program.output().expect("the program starts")
}

fn printed(args: &[&str], option: &str) -> String {
    let output = run(&[args, &[option]].concat());
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(text.starts_with('{'), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    text
}

/// Returns the lines of an indented JSON text without those of some keys. The values of these keys
/// must be scalars or lists of scalars.
fn lines_without(text: &str, keys: &[&str]) -> Vec<String> {
    let mut is_in_list = false;
    let is_compared = |line: &&str| {
        let line = line.trim();
        if is_in_list {
            is_in_list = !line.starts_with(']');
            return false;
        }
        let is_left_out = keys.iter().any(|key| line.starts_with(&format!("\"{key}\":")));
        is_in_list = is_left_out && line.ends_with('[');
        !is_left_out
    };
    // Whether a line ends in a comma depends on the line after it, which may have been removed.
    text.lines().filter(is_compared).map(|line| line.trim_end_matches(',').to_owned()).collect()
}

fn without(request: Value, keys: &[&str]) -> Value {
    let Value::Object(mut fields) = request else { panic!("{request}") };
    fields.retain(|key, _| !keys.contains(&key.as_str()));
    Value::Object(fields)
}

impl<'a> CommandLine<'a> {
    fn new(args: &'a [&'a str]) -> Self {
        Self { args, only_printed: &[], not_compared: &[] }
    }

    fn prints(self, only_printed: &'a [&'a str]) -> Self {
        Self { only_printed, ..self }
    }

    fn asks_differently(self, not_compared: &'a [&'a str]) -> Self {
        Self { not_compared, ..self }
    }

    /// Asks the question on the command line and compares question and report with those of the
    /// window.
    fn compare(self, request: impl Into<Request>, report: &impl Serialize) {
        let keys = [&NOT_COMPARED, self.only_printed].concat();
        let shown = serde_json::to_string_pretty(report).expect("JSON");
        let in_json = printed(self.args, "--json");
        let [shown, in_json] = [&shown, &in_json].map(|text| lines_without(text, &keys));
        assert!(shown.len() > 5, "{shown:?}");
        let difference = shown.iter().zip(&in_json).position(|(shown, in_json)| shown != in_json);
        if let Some(at) = difference {
            panic!("{:?}: window {:?}, command line {:?}", self.args, shown[at], in_json[at]);
        }
        assert_eq!(shown.len(), in_json.len(), "{:?}", self.args);

        let printed_request =
            serde_json::from_str(&printed(self.args, "--print-request")).expect("JSON");
        let request = serde_json::to_value(request.into()).expect("JSON");
        let [request, printed_request] =
            [request, printed_request].map(|of| without(of, self.not_compared));
        assert_eq!(request, printed_request, "{:?}", self.args);
    }
}

/// Returns the question that was asked last, and its answer.
fn latest<Q: Question>(latest: &Latest<Q>) -> (Q, &Q::Answer) {
    assert!(!latest.is_waiting());
    let answer = latest.answer.as_ref().expect("an answer");
    (latest.question.clone().expect("a question"), answer.as_ref().expect("no problem"))
}

/// Returns the latest question of a [`QuestionJob`] and its answer.
fn finished<Q: Question>(job: &QuestionJob<Q>) -> (Q, &Q::Answer) {
    assert!(!job.is_running());
    let latest = job.latest.as_ref().expect("an answer");
    (latest.question.clone(), latest.answer.as_ref().expect("no problem"))
}

/// Opens the window on a path and waits until its first case has been simulated.
fn open_on(path: &str) -> Harness<'static, App> {
    let mut harness = open(&[path]);
    step_until(&mut harness, "the data", is_idle);
    harness
}

fn select(harness: &mut Harness<'_, App>, dataset: &str, case: &str) {
    let subject = Subject::Case { dataset: dataset.into(), case: case.to_owned() };
    apply(harness, Command::Select(subject));
    step_until(harness, "the case", |state| {
        is_idle(state) && state.analysis().is_some_and(|answer| answer.report.name == case)
    });
}

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a file");
    path.display().to_string()
}

#[test]
fn what_is_open_is_checked_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let unclear = write(folder.path(), "unclear.csv", "Zeit;Kraft\n0;0\n1;2,5\n2;0\n");
    for path in [
        FORCES,
        concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea/forces/c001.csv"),
        TRAJECTORIES,
        &unclear,
    ] {
        let mut harness = open(&[path]);
        step_until(&mut harness, "the data", |state| {
            state.session.sources.iter().all(impactlab::app::Source::is_settled)
        });
        let check = state(&harness).session.sources[0].check.as_ref().expect("a check");
        let answer = check.answer.as_ref().expect("a report");
        CommandLine::new(&["check", path]).compare(check.question.clone(), &answer.report);
    }
}

#[test]
fn a_scenario_is_solved_simulated_and_predicted_alike() {
    let mut harness = open_on(FORCES);
    apply(&mut harness, Command::Open(vec![SCENARIO.into()]));
    step_until(&mut harness, "the scenario", |state| {
        is_idle(state) && !state.session.impact.is_waiting()
    });
    // The window asks about a scenario in memory, the command line about a file.
    let (request, answer) = latest(&state(&harness).session.impact);
    CommandLine::new(&["impact", SCENARIO])
        .asks_differently(&["scenario"])
        .compare(request, &answer.report);
    let (request, answer) = latest(&state(&harness).session.analysis);
    CommandLine::new(&["simulate", "--scenario", SCENARIO])
        .asks_differently(&["source"])
        .compare(request, &answer.report);

    apply(&mut harness, Command::Show(Pane::ForcePrediction));
    apply(&mut harness, Command::PredictScenario);
    let is_answered = |state: &State| {
        let forecast = &state.session.force.forecast;
        forecast.question.as_ref() == state.force_request().as_ref() && !forecast.is_waiting()
    };
    let has_model = |state: &State| state.session.force.model.current.is_some();
    step_until(&mut harness, "the force model", has_model);
    step_until(&mut harness, "the force", is_answered);
    let (request, answer) = latest(&state(&harness).session.force.forecast);
    CommandLine::new(&["predict", "force", "--scenario", SCENARIO])
        .asks_differently(&["collision"]) // The file; the window has its content.
        .compare(request, &answer.report);
    select(&mut harness, FORCES, "c002");
    step_until(&mut harness, "the force of the case", is_answered);
    let (request, answer) = latest(&state(&harness).session.force.forecast);
    CommandLine::new(&["predict", "force", "--dataset", FORCES, "--case", "c002"])
        .compare(request, &answer.report);
}

/// Both have the scenario of the chosen car in the question, whole.
#[test]
fn a_car_and_a_road_that_are_chosen_are_asked_about_alike() {
    let mut harness = open_on(SCENARIO);
    for (role, id) in
        [(Role::Struck, "toyota-corolla-2020"), (Role::Striking, "ford-explorer-2004")]
    {
        let choice = VehicleChoice::Preset(id.to_owned());
        apply(&mut harness, Command::ChooseVehicle(role, Box::new(choice)));
    }
    let [friction, sigma] = harness.state_mut().state_mut().project.road_mut();
    (*friction, *sigma) = (Some(0.55), Some(0.05));
    step_until(&mut harness, "the simulation", |state| {
        let asked = state.session.analysis.question.as_ref();
        is_idle(state) && asked.is_some_and(|of| Some(of) == state.simulate_request().as_ref())
    });
    let (request, answer) = latest(&state(&harness).session.analysis);
    let cars = ["--vehicle", "toyota-corolla-2020", "--bullet", "ford-explorer-2004"];
    let road = ["--friction", "0.55", "--friction-sigma", "0.05"];
    let asks = [&["simulate", "--scenario", SCENARIO][..], &cars, &road].concat();
    CommandLine::new(&asks).compare(request, &answer.report);
}

#[test]
fn cases_and_files_are_simulated_alike() {
    let mut harness = open_on(FORCES);
    select(&mut harness, FORCES, "c003");
    let (request, answer) = latest(&state(&harness).session.analysis);
    CommandLine::new(&["simulate", "--dataset", FORCES, "--case", "c003"])
        .compare(request, &answer.report);
    for (option, path) in [
        ("--force", concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea/forces/c001.csv")),
        ("--force", concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea-wide/forces/w001.csv")),
        (
            "--trajectory",
            concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/datasets/trajectories-fea/trajectories/FE_c001.csv"
            ),
        ),
    ] {
        let harness = open_on(path);
        let (request, answer) = latest(&state(&harness).session.analysis);
        CommandLine::new(&["simulate", option, path]).compare(request, &answer.report);
    }
}

#[test]
fn a_scenario_on_a_road_with_zones_of_friction_is_simulated_alike() {
    let site = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sites/country-road/site.toml");
    // Nobody brakes, so that the struck car gets to the verge.
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the scenario", |state| is_idle(state) && state.analysis().is_some());
    let report = |state: &State| {
        let (_, answer) = latest(&state.session.analysis);
        serde_json::to_value(&answer.report).expect("JSON")
    };
    let off_road = report(state(&harness));
    apply(&mut harness, Command::Open(vec![site.into()]));
    step_until(&mut harness, "the ground", |state| {
        let has_zones = |of: &SimulateAnswer| !of.report.friction_zones.is_empty();
        is_idle(state) && state.analysis().is_some_and(has_zones)
    });
    let on_road = report(state(&harness));
    assert_ne!(off_road["end"], on_road["end"], "the zones make a difference");
    let (request, answer) = latest(&state(&harness).session.analysis);
    // The window asks about a scenario in memory, the command line about a file.
    CommandLine::new(&["simulate", "--scenario", SCENARIO, "--site", site])
        .asks_differently(&["source"])
        .compare(request, &answer.report);
}

#[test]
fn a_data_set_is_simulated_alike() {
    let mut harness = open_on(TRAJECTORIES);
    harness.get_by_label("Simulate all 100 cases").click();
    step_until(&mut harness, "all cases", |state| {
        state.session.replays.values().any(|replay| replay.report().is_some())
    });
    let replays = &state(&harness).session.replays;
    let (request, answer) = finished(&replays[Path::new(TRAJECTORIES)].question);
    CommandLine::new(&["simulate", "--dataset", TRAJECTORIES]).compare(request, &answer.report);
}

/// Waits until the window has predicted the motion under a force, and compares the report with that
/// of a command.
fn compare_motion(harness: &mut Harness<'_, App>, force: ForceSource, asks: CommandLine<'_>) {
    let is_predicted = matches!(force, ForceSource::Predicted(_));
    harness.state_mut().state_mut().project.predict_motion.force = force;
    step_until(harness, "the motion", |state| {
        let forecast = &state.session.response.forecast;
        let printed_request =
            forecast.question.as_ref().map(|printed_request| &printed_request.request);
        printed_request.is_some()
            && printed_request == state.motion_request().as_ref()
            && !forecast.is_waiting()
            && state.motion_forecast().is_some_and(|of| of.is_predicted() == is_predicted)
    });
    let (question, shown) = latest(&state(harness).session.response.forecast);
    asks.prints(&["files"]).compare(question.request, &shown.answer.report);
}

#[test]
fn a_motion_is_predicted_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let drawn = ["--draws", "3", "--seed", "7", "--out", &out, "--overwrite"];
    let few_draws = |harness: &mut Harness<'_, App>| {
        let form = &mut harness.state_mut().state_mut().project.predict_motion;
        (form.draws, form.seed) = (3, 7);
    };

    let mut harness = open_on(FORCES);
    few_draws(&mut harness);
    select(&mut harness, FORCES, "c002");
    let of_case = [&["predict", "--dataset", FORCES, "--case", "c002"][..], &drawn].concat();
    // Where nobody says which force, it is that which was recorded, and of a scenario the predicted one.
    let usual = |harness: &Harness<'_, App>| state(harness).project.predict_motion.force.clone();
    assert_eq!(usual(&harness), ForceSource::Given);
    compare_motion(&mut harness, ForceSource::Given, CommandLine::new(&of_case));
    let predicted = [&of_case[..], &["--force-model", "shipped"]].concat();
    compare_motion(
        &mut harness,
        ForceSource::Predicted(ModelChoice::default()),
        CommandLine::new(&predicted),
    );

    // The window asks about a scenario in memory, the command line about a file.
    apply(&mut harness, Command::Open(vec![SCENARIO.into()]));
    step_until(&mut harness, "the scenario", is_idle);
    assert_eq!(usual(&harness), ForceSource::Predicted(ModelChoice::default()));
    let of_scenario = [&["predict", "--scenario", SCENARIO][..], &drawn].concat();
    let predicted = CommandLine::new(&of_scenario).asks_differently(&["motion"]);
    compare_motion(&mut harness, ForceSource::Predicted(ModelChoice::default()), predicted);
    let given = [&of_scenario[..], &["--given-force"]].concat();
    let given = CommandLine::new(&given).asks_differently(&["motion"]);
    compare_motion(&mut harness, ForceSource::Given, given);
    let braked = {
        let pit = std::fs::read_to_string(SCENARIO).expect("the scenario");
        let ending = "\n[ending]\nbrake_start_s = 0.3\nbrake_share = 0.9\n";
        write(folder.path(), "braked.toml", &(pit + ending))
    };
    apply(&mut harness, Command::Open(vec![braked.clone().into()]));
    let project = &mut harness.state_mut().state_mut().project;
    (project.simulate.until_rest, project.simulate.duration_s) = (true, 30.0);
    step_until(&mut harness, "the braked scenario", is_idle);
    let results = folder.path().join("results").display().to_string();
    let to_rest = [
        &["predict", "--scenario", &braked, "--until-rest", "--duration", "30", "--draws", "3"][..],
        &["--seed", "7", "--out", &results, "--overwrite"],
    ]
    .concat();
    let predicted = CommandLine::new(&to_rest).asks_differently(&["motion"]);
    compare_motion(&mut harness, ForceSource::Predicted(ModelChoice::default()), predicted);
    let rest = state(&harness).motion_forecast().and_then(|of| of.answer.report.rest.clone());
    assert!(rest.is_some_and(|rest| rest.share_at_rest == 1.0));

    let record =
        concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea/trajectories/FE_c001.csv");
    let mut harness = open_on(record);
    few_draws(&mut harness);
    let of_record = [&["predict", "--trajectory", record, "--given-force"][..], &drawn].concat();
    compare_motion(&mut harness, ForceSource::Given, CommandLine::new(&of_record));
}

#[test]
fn a_recorder_is_replayed_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = write(folder.path(), "report.csv", BEFORE);
    let mut harness = open(&[]);
    let command =
        RecorderCommand::Replay { path: file.clone().into(), event: None, car: Role::Striking };
    apply(&mut harness, Command::Recorder(command));
    let asked = harness.state_mut().state_mut().project.replay.as_mut().expect("a question");
    (asked.steering_ratio, asked.draws, asked.seed) = (Some(14.5), 60, 3);
    (asked.vehicle, asked.contact.x_m) = (VehicleChoice::named("toyota-camry-2018"), 12.0);
    apply(&mut harness, Command::Recorder(RecorderCommand::RunReplay));
    step_until(&mut harness, "the replay", |state| {
        let run = &state.session.recorder_replay;
        !run.is_running() && run.ok().is_some()
    });
    let (request, answer) = finished(&state(&harness).session.recorder_replay);
    let car = ["--vehicle", "toyota-camry-2018", "--steering-ratio", "14.5", "--x", "12"];
    let args = [&["replay", &file][..], &car, &["--draws", "60", "--seed", "3"]].concat();
    CommandLine::new(&args).compare(request, &answer.report);
}

#[test]
fn a_reconstruction() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = evidence_in(folder.path());
    let path = path.to_str().expect("a plain name");
    let site = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sites/country-road/site.toml");
    for ground in [&[][..], &[site]] {
        let mut harness = open(&[&[path], ground].concat());
        step_until(&mut harness, "the evidence on its ground", |state| {
            let form = state.project.reconstruct.as_ref();
            form.is_some_and(|form| form.site.is_some() != ground.is_empty())
        });
        let form = harness.state_mut().state_mut().project.reconstruct.as_mut().expect("evidence");
        (form.particles, form.seed) = (60, 3);
        apply(&mut harness, Command::Reconstruct(ReconstructionCommand::Run));
        step_until(&mut harness, "the speeds", |state| {
            let run = &state.session.reconstruction.run;
            !run.is_running() && run.latest.is_some()
        });
        let (question, answer) = finished(&state(&harness).session.reconstruction.run);
        let mut args = vec!["reconstruct", path, "--particles", "60", "--seed", "3"];
        args.extend(ground.iter().flat_map(|site| ["--site", site]));
        CommandLine::new(&args).compare(question.request, &answer.answer.report);
    }
}
