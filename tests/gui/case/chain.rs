//! The chain of answers above the panes.

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Subject};
use impactlab_core::uncertainty::{CaveatKind, Caveats};
use impactlab_core::units::{NumberFormat, Quantity, UnitSystem};
use impactlab_study::{ForceSource, ModelChoice};

use super::{is_answered, pit_as_opened, scenario, state};
use crate::harness::{apply, step_until};

fn forecast_caveats<'a>(harness: &'a Harness<'_, App>) -> &'a Caveats {
    &state(harness).session.response.forecast.ok().expect("a forecast").answer.report.caveats
}

#[test]
fn the_chain_says_where_each_answer_comes_from_and_marks_what_is_late() {
    let mut harness = pit_as_opened();
    let chain = state(&harness).chain();
    let titles: Vec<&str> = chain.iter().map(|link| link.title).collect();
    assert_eq!(titles, ["Scenario", "Impact", "Force", "Motion", "Outcome"]);
    assert!(chain.iter().all(|link| link.figure.is_some() && !link.is_late), "{chain:?}");
    let report = &state(&harness).session.response.forecast.ok().unwrap().answer.report;
    assert!(report.known_until_s() > report.outcome.time_s, "every contact is followed");
    let figure = chain[4].figure.clone().unwrap();
    let format = NumberFormat::english(UnitSystem::Si);
    let x = format.estimate_in_words(Quantity::Length, &report.outcome.x_m);
    assert!(figure.starts_with(&format!("X {x}, Y ")), "{figure} {x}");
    // Two figures of one quantity do not differ: that of the scenario panel is the chain's.
    let delta_v_m_s =
        state(&harness).session.impact.ok().unwrap().report.struck.delta_v_magnitude_m_s;
    let delta_v = format.rough(Quantity::Speed, delta_v_m_s);
    assert_eq!(chain[1].figure, Some(format!("Δv {delta_v}")));
    assert!(!chain[1].warnings.iter().any(|warning| warning.contains("second contact")));

    // The force network's impulse takes the place of the pulse once it drives the forecast.
    let project = &mut harness.state_mut().state_mut().project;
    project.predict_motion.force = ForceSource::Predicted(ModelChoice::default());
    harness.run_steps(2);
    step_until(&mut harness, "the forecast", is_answered);
    let force = &state(&harness).chain()[2];
    assert!(force.source.starts_with("force network"), "{force:?}");
    assert!(force.figure.as_ref().unwrap().contains(" to "), "{force:?}");
    // It has learned from such collisions, and from none with a vehicle of nine tonnes.
    assert!(!forecast_caveats(&harness).has(CaveatKind::OutsideDomain));
    scenario(&mut harness).striking.mass_kg = 9000.0;
    harness.run_steps(2);
    step_until(&mut harness, "the forecast", is_answered);
    let caveats = forecast_caveats(&harness);
    assert!(caveats.has(CaveatKind::OutsideDomain), "{caveats:?}");

    // No figure of another subject stands while the new one is computed.
    apply(&mut harness, Command::Select(Subject::File("nowhere.csv".into())));
    let chain = state(&harness).chain();
    assert!(chain[1..].iter().all(|link| link.figure.is_none()), "{chain:?}");
    // “Scenario: mylog.csv” stood there.
    assert_eq!((chain[0].title, chain[0].figure.as_deref()), ("File", Some("nowhere.csv")));
    // A click leads to the panel.
    let motion = harness.query_all_by_label_contains("Motion:").next().expect("the link");
    motion.click();
    harness.run_steps(3);
    harness.get_by_label("drawn motions");
}
