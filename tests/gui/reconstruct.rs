//! The workspace Reconstruct: evidence in, speeds out.

use std::path::{Path, PathBuf};

use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use impactlab::app::{
    App, CaseCommand, Command, FollowedParticle, Leaving, Output, PlaybackCommand,
    ReconstructionCommand, State, Workspace,
};
use impactlab_core::collision::Side;
use impactlab_core::vehicle::built_in_vehicle;
use impactlab_reconstruct::evidence::{Edr, Evidence, RestPose, Stated};
use impactlab_study::{EvidenceChoice, VehicleChoice};

use crate::harness::{apply, open, open_at, open_with, state, step_until};
use crate::looks::collisions;
use crate::pictures::save;

/// A car that spun to rest, with few marks.
pub const EVIDENCE: &str = r#"
case = "spin"
[road]
friction = 0.7
[struck_car]
mass_kg = 1900
[striking_car]
mass_kg = 1700
[damage]
side = "right"
x_m = -1.7
[rest]
x_m = 30
y_m = -6
heading_deg = 190
[after]
blocked_wheels = []
[edr]
speed_before_m_s = 17
"#;

/// Writes the evidence into a folder.
pub fn evidence_in(folder: &Path) -> PathBuf {
    let path = folder.join("evidence.toml");
    std::fs::write(&path, EVIDENCE).expect("a file");
    path
}

fn evidence(harness: &Harness<'_, App>) -> Evidence {
    state(harness).evidence().expect("evidence").clone()
}

fn is_outdated(harness: &Harness<'_, App>) -> bool {
    let State { project, session, .. } = state(harness);
    session.reconstruction.is_outdated(project.reconstruct.as_ref())
}

/// Opens a window of a size on a file with evidence and few particles.
pub fn opened(path: &Path, size: [f32; 2], particles: usize) -> Harness<'static, App> {
    let mut harness = open_at((size, 1.0), &[path.to_str().expect("a plain name")], None);
    harness.run_steps(4);
    harness.state_mut().state_mut().project.reconstruct.as_mut().expect("evidence").particles =
        particles;
    harness.run_steps(2);
    harness
}

/// Whether the evidence has been reconstructed.
pub fn is_answered(state: &State) -> bool {
    let of = &state.session.reconstruction;
    !of.run.is_running() && of.answer().is_some()
}

fn run(harness: &mut Harness<'static, App>) {
    harness.get_by_label("Run").click();
    harness.run_steps(4);
    step_until(harness, "the particles that are not the answer yet", |state| {
        let live = state.session.reconstruction.live.as_ref();
        live.is_some_and(|live| !live.paths.drawn.is_empty() && live.paths.drawn.len() <= 60)
    });
    assert!(harness.query_by_label_contains("Not the answer yet").is_some());
}

#[test]
fn the_question_what_happened_leads_to_a_form_for_what_was_found() {
    let mut harness = open(&[]);
    harness.run_steps(3);
    harness.get_by_label("Reconstruct a collision").click();
    harness.run_steps(4);
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Reconstruct);
    assert!(!state(&harness).session.shows_doors && state(&harness).evidence().is_none());
    assert!(state(&harness).project.subject().is_none(), "nobody has entered a scenario");
    for label in ["Open an evidence file…", "Look at the example", "New evidence"] {
        assert!(harness.query_by_label(label).is_some(), "{label}");
    }
    harness.get_by_label("New evidence").click();
    harness.run_steps(4);
    assert!(evidence(&harness).missing().is_some());
    assert!(harness.query_by_label("Add evidence").is_some());
}

/// A single car could be opened from a file only.
#[test]
fn a_form_of_a_single_car_is_begun_in_the_window() {
    let mut harness = open(&[]);
    harness.run_steps(3);
    harness.get_by_label("Reconstruct a collision").click();
    harness.run_steps(4);
    harness.get_by_label("New evidence of a single car").click();
    harness.run_steps(4);
    assert!(evidence(&harness).is_single_car() && evidence(&harness).missing().is_some());
    assert!(harness.query_by_label("Car at the start").is_some());
    assert!(harness.query_by_label("Damage of the struck car").is_none());
}

/// The window asked what the striking car was, and drew where the struck car was hit.
#[test]
fn a_single_car_is_run_without_anything_of_an_impact() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = root.join("docs/guide/examples/single_car.toml");
    let mut harness = opened(&path, [1280.0, 720.0], 60);
    for label in ["Damage of the struck car", "Striking car", "Struck car", "Ranges beforehand"] {
        assert!(harness.query_by_label(label).is_none(), "{label}");
    }
    assert!(harness.query_by_label("Driver and wheels").is_some());
    harness.get_by_label("Run").click();
    harness.run_steps(4);
    step_until(&mut harness, "the speed", is_answered);
    harness.run_steps(4);
    let answer = state(&harness).session.reconstruction.answer().expect("an answer");
    assert!(answer.answer.posterior.is_of_single_car());
    assert_eq!(answer.answer.report.quantities[0].name, "speed_m_s");
    for label in ["Δv of the struck car", "closing speed", "speed of the striking car"] {
        assert!(harness.query_by_label(label).is_none(), "{label}");
    }
}

#[test]
fn evidence_that_is_opened_is_run_edited_and_undone() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = evidence_in(folder.path());
    let mut harness = opened(&path, [1280.0, 720.0], 60);
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Reconstruct);
    let choice = state(&harness).project.reconstruct.as_ref().map(|of| of.evidence.clone());
    assert_eq!(choice, Some(EvidenceChoice::File(path)));
    // “No case chosen, choose a case of the data that are open” stood above the evidence.
    assert!(harness.query_by_label("No case chosen").is_none());
    assert!(harness.query_by_label("Reconstruction: –").is_some());
    assert!(!state(&harness).session.playback.is_playing);

    run(&mut harness);
    step_until(&mut harness, "the speeds", is_answered);
    assert!(!is_outdated(&harness));
    let answer = state(&harness).session.reconstruction.answer().expect("an answer");
    assert_eq!(answer.answer.report.n_particles, 60);
    assert!(harness.query_by_label("Reconstruction: –").is_none());
    for label in ["Play the median", "Items of the evidence: found and expected"] {
        assert!(harness.query_by_label(label).is_some(), "{label}");
    }
    // The wheels of the example turn for a part of the way, so that no drag factor is known of it.
    assert!(harness.query_by_label_contains("By hand, each number").is_none());

    // The course of events that is clicked is shown alone, and a path of it is played.
    let name = answer.answer.report.modes[0].name.clone();
    harness.get_by_label(&name).scroll_to_me();
    harness.run_steps(8);
    harness.get_by_label(&name).click();
    harness.run_steps(4);
    assert_eq!(state(&harness).session.reconstruction.mode, Some(0));
    harness.get_by_label("Play a draw").click();
    harness.run_steps(4);
    let session = &state(&harness).session;
    assert_eq!(session.reconstruction.followed, FollowedParticle::Draw(0));
    assert!(session.playback.is_playing && session.playback.time_s > 0.0);
    assert!(session.playback.time_s <= state(&harness).end_time_s());

    // The same with the cars as bodies, from above and in perspective.
    harness.get_by_label("Cars").click();
    harness.run_steps(4);
    for view in ["From above", "Perspective"] {
        harness.get_by_label(view).click();
        harness.run_steps(4);
        save(
            &mut harness,
            &format!("reconstruct-cars-{view}.png").to_lowercase().replace(' ', "-"),
        );
        assert!(harness.query_by_label("Picture of the scene").is_some());
        assert!(harness.query_by_label("struck car at rest, 90 % ellipse").is_some());
    }
    harness.get_by_label("Plan").click();
    harness.run_steps(4);
    assert!(harness.query_by_label("Picture of the scene").is_none());

    // The struck car was found elsewhere: the answer is of other evidence until that is undone.
    let mut moved = evidence(&harness);
    moved.rest.as_mut().expect("a place of rest").x_m = Some(35.0);
    let project = &mut harness.state_mut().state_mut().project;
    project.reconstruct.as_mut().expect("evidence").evidence =
        EvidenceChoice::Inline(Box::new(moved.clone()));
    harness.run_steps(120); // The history takes up what has stood for a second.
    assert_eq!(evidence(&harness), moved);
    assert!(is_outdated(&harness));
    assert!(harness.query_by_label("Play the median").is_none(), "old paths over new evidence");
    assert!(harness.query_all_by_label_contains("were changed since the last run").count() > 0);
    apply(&mut harness, Command::Undo);
    harness.run_steps(2);
    assert_eq!(state(&harness).project.reconstruct.as_ref().map(|of| of.evidence.clone()), choice);
    assert!(!is_outdated(&harness));
}

/// What the evidence lacked, and how far a run was, stood above the cards, which moved while one typed.
#[test]
fn the_cards_stay_where_they_are_while_they_are_filled_in_and_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = opened(&evidence_in(folder.path()), [1280.0, 720.0], 800);
    let place = |harness: &Harness<'_, App>| harness.get_by_label("Add evidence").rect();
    let before = place(&harness);
    for x_m in [None, Some(35.0)] {
        let mut changed = evidence(&harness);
        changed.rest.as_mut().expect("a place of rest").x_m = x_m;
        let project = &mut harness.state_mut().state_mut().project;
        project.reconstruct.as_mut().expect("evidence").evidence =
            EvidenceChoice::Inline(Box::new(changed));
        harness.run_steps(4);
        assert_eq!(evidence(&harness).missing().is_some(), x_m.is_none());
        let says = harness.query_by_label_contains("has not been placed").is_some();
        assert_eq!(says, x_m.is_none());
        assert_eq!(place(&harness), before, "{x_m:?}");
    }
    run(&mut harness);
    assert_eq!(place(&harness), before, "a run");
    harness.get_by_label("Cancel").click();
    step_until(&mut harness, "the end of the run", |state| {
        !state.session.reconstruction.run.is_running()
    });
    assert_eq!(place(&harness), before, "after it");
}

#[test]
fn a_run_that_is_cancelled_gives_no_speeds() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = opened(&evidence_in(folder.path()), [1280.0, 720.0], 800);
    run(&mut harness);
    harness.get_by_label("Cancel").click();
    step_until(&mut harness, "the end of the run", |state| {
        !state.session.reconstruction.run.is_running()
    });
    harness.run_steps(2);
    assert!(state(&harness).session.reconstruction.answer().is_none());
    assert!(harness.query_by_label_contains("once it has been run").is_some());
}

#[test]
fn a_finished_run_is_back_after_a_restart_and_a_damaged_one_is_sampled_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let evidence = evidence_in(folder.path());
    let (store, runs) = (folder.path().join("state.json"), folder.path().join("reconstructions"));
    let mut harness = open_with(&[evidence.to_str().expect("a plain name")], Some(store.clone()));
    harness.run_steps(4);
    harness.state_mut().state_mut().project.reconstruct.as_mut().expect("evidence").particles = 60;
    harness.run_steps(2);
    let particles = |harness: &Harness<'_, App>| {
        let answer = state(harness).session.reconstruction.answer().expect("an answer");
        answer.answer.particles.z.clone()
    };
    harness.get_by_label("Run").click();
    harness.run_steps(4);
    step_until(&mut harness, "the speeds", is_answered);
    let first = particles(&harness);
    let runs: Vec<PathBuf> =
        std::fs::read_dir(&runs).expect("a folder").map(|of| of.expect("a file").path()).collect();
    assert_eq!(runs.len(), 1, "{runs:?}");
    harness.run_steps(90);
    step_until(&mut harness, "the stored state", |_| {
        std::fs::read_to_string(&store).is_ok_and(|text| text.contains("60"))
    });
    drop(harness);

    // Nobody asks, and the answer is the same one.
    let mut harness = open_with(&[], Some(store.clone()));
    step_until(&mut harness, "the speeds again", is_answered);
    assert_eq!(particles(&harness), first);
    assert!(!is_outdated(&harness));
    drop(harness);

    std::fs::write(&runs[0], b"no run").expect("a file");
    let mut harness = open_with(&[], Some(store));
    step_until(&mut harness, "the speeds anew", is_answered);
    assert_eq!(particles(&harness), first);
}

#[test]
fn evidence_is_saved_with_the_case_and_clicked_marks_are_asked_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_at(([1280.0, 720.0], 1.0), &["no/such/folder"], None);
    harness.run_steps(4);
    apply(&mut harness, Command::ShowWorkspace(Workspace::Reconstruct));
    harness.run_steps(2);
    save(&mut harness, "reconstruct-empty.png");
    harness.get_by_label("New evidence").click();
    harness.run_steps(4);
    let mut edited = evidence(&harness);
    assert!(edited.marks.is_empty() && edited.striking_car.mass_kg.is_none());
    assert!(harness.query_by_label_contains("car at rest has not been placed").is_some());
    assert!(harness.get_by_label("Run").accesskit_node().is_disabled());
    assert!(harness.get_by_label("Save as…").accesskit_node().is_disabled());
    // What a form starts with is no number.
    let empty = edited.rest.expect("a card");
    assert_eq!((empty.place_m(), edited.damage.along()), (None, None));
    edited.rest = Some(RestPose { x_m: Some(30.0), y_m: Some(0.0), ..empty });
    edited.damage.along_m = Some(Stated { value: Some(-1.5), sigma: None });
    assert_eq!(edited.damage.side, None);
    edited.damage.side = Some(Side::Right);
    let project = &mut harness.state_mut().state_mut().project;
    project.reconstruct.as_mut().expect("evidence").evidence =
        EvidenceChoice::Inline(Box::new(edited));
    harness.run_steps(4);
    assert!(!harness.get_by_label("Run").accesskit_node().is_disabled());
    harness.get_by_label("Add evidence").click();
    harness.run_steps(4);
    harness.get_by_label("Tire mark").click();
    harness.run_steps(4);
    assert_eq!(evidence(&harness).marks.len(), 1);
    assert!(harness.query_by_label_contains("needs at least two points").is_some());
    harness.get_by_label("Add points").click();
    harness.run_steps(4);
    assert_eq!(state(&harness).session.reconstruction.adds_to.map(|mark| mark.idx), Some(0));
    // A click beside the title of the pane lies in the scene.
    let title = harness.get_by_label("Reconstructed scene").rect();
    for right in [60.0, 120.0] {
        let at = title.left_bottom() + egui::vec2(right, 260.0);
        harness.hover_at(at);
        harness.run_steps(2);
        harness.drag_at(at);
        harness.run_steps(1);
        harness.drop_at(at);
        harness.run_steps(3);
    }
    assert_eq!(evidence(&harness).marks[0].points_m.len(), 2);
    assert!(harness.query_by_label("y of point 2").is_some(), "what was clicked is listed");
    save(&mut harness, "reconstruct-new.png");

    edited = evidence(&harness);
    let path = folder.path().join("new.toml");
    apply(&mut harness, Command::Write(Output::Evidence(Box::new(edited.clone())), path.clone()));
    assert_eq!(Evidence::load(&path).expect("the file"), edited);
    apply(
        &mut harness,
        Command::Write(Output::Evidence(Box::new(edited.mirrored())), path.clone()),
    );
    assert!(
        state(&harness).session.dialogs.replacing().is_some(),
        "it was written without a question"
    );
    assert_eq!(Evidence::load(&path).expect("the file"), edited);
    apply(&mut harness, Command::CloseDialog);
    let case = folder.path().join("spin.impactlab");
    apply(&mut harness, Command::Write(Output::Case, case.clone()));
    step_until(&mut harness, "the case file", |state| state.case.path.is_some());
    apply(&mut harness, Command::Case(CaseCommand::Leave(Leaving::New)));
    harness.run_steps(2);
    assert!(state(&harness).evidence().is_none());
    apply(&mut harness, Command::Open(vec![case.clone()]));
    harness.run_steps(4);
    assert_eq!(evidence(&harness), edited);
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Reconstruct);
    let text = std::fs::read_to_string(case).expect("the case file");
    assert!(text.contains(r#""question": "reconstruct""#));
}

#[test]
fn marks_and_recorder_of_the_striking_car_have_cards_of_their_own() {
    let mut harness = open_at(([1280.0, 1200.0], 1.0), &["no/such/folder"], None);
    harness.run_steps(4);
    apply(&mut harness, Command::ShowWorkspace(Workspace::Reconstruct));
    harness.run_steps(2);
    harness.get_by_label("New evidence").click();
    harness.run_steps(4);
    for item in ["Tire mark of the striking car", "Event data recorder of the striking car"] {
        harness.get_by_label("Add evidence").click();
        harness.run_steps(4);
        harness.get_by_label(item).click();
        harness.run_steps(4);
    }
    let found = evidence(&harness);
    assert_eq!((found.striking_marks.len(), found.striking_edr), (1, Some(Edr::default())));
    assert!(found.marks.is_empty() && found.edr.is_none());
    assert!(harness.query_by_label("Tire mark of the striking car 1").is_some());
    assert!(harness.query_by_label("Event data recorder of the striking car").is_some());
    harness.get_by_label("Add points").click();
    harness.run_steps(4);
    let adds_to = state(&harness).session.reconstruction.adds_to;
    let section = adds_to.map(|mark| (mark.section, mark.idx));
    assert_eq!(section, Some(("striking_mark", 0)));
}

/// A speed of 15 m/s, 54 km/h, is one like any other, from a file and typed.
#[test]
fn what_is_recorded_is_run_and_saved_whatever_its_number() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = evidence_in(folder.path());
    let text = EVIDENCE.replace("speed_before_m_s = 17", "speed_before_m_s = 15");
    std::fs::write(&path, text.replace("y_m = -6", "y_m = 0")).expect("a file");
    let mut harness = opened(&path, [1280.0, 1700.0], 60);
    let can = |harness: &Harness<'_, App>| {
        ["Run", "Save as…"].map(|label| !harness.get_by_label(label).accesskit_node().is_disabled())
    };
    assert_eq!(can(&harness), [true, true]);

    // A card in which nothing was entered waits; the number that is typed into it is taken.
    let mut edited = evidence(&harness);
    edited.edr = Some(Edr::default());
    let project = &mut harness.state_mut().state_mut().project;
    project.reconstruct.as_mut().expect("evidence").evidence =
        EvidenceChoice::Inline(Box::new(edited));
    harness.run_steps(4);
    assert_eq!(can(&harness), [false, false]);
    assert!(harness.query_by_label_contains("event data recorder: nothing has been").is_some());
    for (typed, value) in [("54", Some(15.0)), ("0", Some(0.0)), ("", None), ("54", Some(15.0))] {
        harness.get_by_label("Speed before the impact").focus();
        harness.run_steps(2);
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        harness.key_press(egui::Key::Delete);
        harness.run_steps(2);
        harness.event(egui::Event::Text(typed.to_owned()));
        harness.run_steps(2);
        harness.key_press(egui::Key::Enter);
        harness.run_steps(4);
        let speed = evidence(&harness).recorder().speed_before_m_s.and_then(|of| of.value);
        let is_same = speed.zip(value).is_some_and(|(a, b)| (a - b).abs() < 1e-9);
        assert!(is_same || speed == value, "{typed:?}: {speed:?}");
    }
    assert_eq!(can(&harness), [true, true]);
}

#[test]
fn a_data_sheet_stands_in_for_what_the_evidence_does_not_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = opened(&evidence_in(folder.path()), [1280.0, 720.0], 60);
    let wheelbase_m = |harness: &Harness<'_, App>| {
        let preview = state(harness).session.reconstruction.preview.as_ref().expect("a preview");
        preview.cars.struck.parameters.geometry.wheelbase_m()
    };
    let any = wheelbase_m(&harness);
    let choose = |harness: &mut Harness<'static, App>, choice: VehicleChoice| {
        harness.state_mut().state_mut().project.reconstruct.as_mut().expect("evidence").vehicle =
            choice;
        harness.run_steps(4);
    };
    let id = "ford-f-150-2004";
    assert!(built_in_vehicle(id).is_some(), "{id} is not in the library");
    choose(&mut harness, VehicleChoice::Preset(id.to_owned()));
    assert!(wheelbase_m(&harness) > any + 0.3, "{} {any}", wheelbase_m(&harness));
    harness.set_size(egui::vec2(1280.0, 1700.0));
    harness.run_steps(4);
    let name = &built_in_vehicle(id).unwrap().name;
    harness.get_by_label(&format!("Else as {name}")).click();
    harness.run_steps(20);
    save(&mut harness, "reconstruct-sheet.png");
    assert_eq!(collisions(&harness), [""; 0]);
    choose(&mut harness, VehicleChoice::File(folder.path().join("gone.toml")));
    assert!(harness.query_all_by_label_contains("gone.toml").count() > 0);
    assert!(harness.get_by_label("Run").accesskit_node().is_disabled());
}

#[test]
fn the_example_in_both_themes() {
    let mut harness = open_at(([1280.0, 720.0], 1.0), &["no/such/folder"], None);
    apply(&mut harness, Command::Reconstruct(ReconstructionCommand::Example));
    let state = harness.state_mut().state_mut();
    state.session.messages.clear();
    state.project.reconstruct.as_mut().expect("evidence").particles = 60;
    harness.run_steps(4);
    run(&mut harness);
    save(&mut harness, "reconstruct-live.png");
    step_until(&mut harness, "the speeds", is_answered);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(1.5)));
    for (dark, theme) in [(false, "light"), (true, "dark")] {
        harness.state_mut().state_mut().view.dark = dark;
        for (height, name) in [(720.0, "reconstruct"), (2100.0, "reconstruct-tall")] {
            harness.set_size(egui::vec2(1280.0, height));
            harness.run_steps(6);
            save(&mut harness, &format!("{name}-{theme}.png"));
            assert_eq!(collisions(&harness), [""; 0], "{name}, {theme}");
        }
    }
}
