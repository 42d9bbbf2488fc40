use std::ops::ControlFlow;

use super::*;
use crate::examples::spin;
use crate::facts::{Term, Value};
use crate::questions::reconstruct::assumed::assumptions;
use crate::questions::reconstruct::badges::apart_by_hand;
use impactlab_core::uncertainty::{CaveatKind, CaveatSubject};
use impactlab_reconstruct::evidence::{Edr, Measured};
use impactlab_reconstruct::{HandCheck, HandSpeed, HingeInput, Latent};

fn request(particles: usize) -> ReconstructRequest {
    let evidence = EvidenceChoice::Inline(Box::new(spin()));
    ReconstructRequest { particles, ..ReconstructRequest::new(evidence) }
}

fn answer(request: &ReconstructRequest) -> ReconstructAnswer {
    let outcome = request.answer(&Library::default(), &mut |_| ControlFlow::Continue(()));
    outcome.unwrap().complete().unwrap()
}

#[test]
fn a_tiny_case_is_reconstructed_the_same_way_each_time() {
    let request = request(120);
    let report = answer(&request).report;
    assert_eq!(report, answer(&request).report);
    for name in [
        "target_speed_m_s",
        "bullet_speed_m_s",
        "closing_speed_m_s",
        "heading_difference_rad",
        "road_friction",
        "delta_v_target_m_s",
    ] {
        let found = report.quantities.iter().find(|quantity| quantity.name == name).unwrap();
        let (median, [low, high]) = (found.estimate.median, found.estimate.ninety());
        assert!(low <= median && median <= high && low < high, "{found:?}");
        let [least, most] = found.estimate.interval(0.95).unwrap();
        assert!(least <= low && high <= most, "{found:?}");
    }
    let speed = report.quantities[0].estimate.median;
    assert!((17.0..23.0).contains(&speed), "{speed} m/s where a recorder says 20 ± 0.8");
    let probability: f64 = report.modes.iter().map(|mode| mode.probability).sum();
    assert!((0.9..=1.0 + 1e-9).contains(&probability), "{:?}", report.modes);
    assert!(report.fit.iter().all(|item| !item.is_unexplained()), "{:?}", report.fit);
    assert!(!report.budget.is_empty() && report.n_simulations > 120);
    // What the speeds hinge on and the courses of events stand before the speeds.
    let titles: Vec<_> = report.facts().into_iter().map(|table| table.title).collect();
    let place = |term: Term| titles.iter().position(|title| *title == Value::Term(term));
    assert!(place(Term::Hinges) < place(Term::Speeds), "{titles:?}");
    assert_eq!(report.hinges[0].input, HingeInput::Drawn(Latent::RoadFriction));
    // The request comes back from JSON.
    let text = serde_json::to_string(&request).unwrap();
    assert_eq!(serde_json::from_str::<ReconstructRequest>(&text).unwrap(), request);
}

/// A place of rest alone that a car reaches in three ways: the median lies where none of them is.
#[test]
fn several_courses_of_events_come_before_any_median_with_a_badge_and_a_path_each() {
    let file =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/guide/examples/position_alone.toml");
    let evidence = EvidenceChoice::File(file.into());
    let answer =
        answer(&ReconstructRequest { particles: 150, ..ReconstructRequest::new(evidence) });
    let report = &answer.report;
    assert!(report.modes.len() > 1, "{:?}", report.modes);
    let badge =
        report.caveats.iter().find(|caveat| caveat.kind == CaveatKind::SeveralCourses).unwrap();
    assert!(badge.is_warning() && badge.text.contains(&report.modes[1].name), "{badge}");
    assert_eq!(report.facts()[0].title, Value::Term(Term::Courses));
    assert!(report.modes.iter().all(|mode| mode.standard_error > 0.005), "{:?}", report.modes);
    let paths = crate::ReconstructedPaths::from_answer(&answer);
    assert_eq!(paths.others.len(), report.modes.len() - 1);
    for (path, mode) in paths.median.iter().chain(&paths.others).zip(&report.modes) {
        assert!(path.name.ends_with(&mode.name), "{} {}", path.name, mode.name);
        let chance = path.chance.as_ref().unwrap();
        assert_eq!(path.name, format!("{chance}: {}", mode.name));
    }
}

#[test]
fn evidence_that_contradicts_itself_is_flagged() {
    let mut request = request(60);
    let EvidenceChoice::Inline(evidence) = &mut request.evidence else { unreachable!() };
    // The recorder says 5 m/s, and the car came 150 m far on a dry road.
    let speed_before_m_s = Some(Measured { value: 5.0, sigma: 0.2 }.into());
    evidence.edr = Some(Edr { speed_before_m_s, ..Edr::default() });
    evidence.rest.as_mut().unwrap().x_m = Some(150.0);
    let report = answer(&request).report;
    let is_flagged = report.caveats.has(CaveatKind::EvidenceUnexplained);
    assert!(is_flagged, "{:?} {:?}", report.caveats, report.fit);
}

#[test]
fn a_stop_before_all_of_the_evidence_counts_gives_no_answer() {
    let outcome = request(60).answer(&Library::default(), &mut |_| ControlFlow::Break(()));
    assert!(outcome.unwrap().complete().is_none(), "medians of the prior pass for speeds");
}

#[test]
fn a_run_goes_on_from_its_checkpoint_to_the_same_answer_and_from_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.reconstruction");
    let saved = ReconstructRequest { checkpoint: Some(path.clone()), ..request(60) };
    // Some way beyond the first checkpoint.
    let mut n_left = 20;
    let stop = &mut |_: Event<'_>| {
        n_left -= i32::from(path.exists());
        if n_left < 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    saved.answer(&Library::default(), stop).unwrap();
    assert!(path.exists());
    let go_on = ReconstructRequest { resume: true, ..saved.clone() };
    assert_eq!(answer(&go_on).report, answer(&request(60)).report);
    let again = saved.answer(&Library::default(), &mut |_| ControlFlow::Continue(()));
    assert!(again.unwrap_err().to_string().contains("run.reconstruction"));
    let other = ReconstructRequest { seed: 7, ..go_on };
    let refused = other.answer(&Library::default(), &mut |_| ControlFlow::Continue(()));
    let refused = impactlab_core::error_chain(&refused.unwrap_err());
    assert!(refused.contains("another seed"), "{refused}");
}

#[test]
fn numbers_out_of_range_are_refused_before_the_work() {
    let error = ReconstructRequest { particles: 1, ..request(60) };
    let outcome = error.answer(&Library::default(), &mut |_| ControlFlow::Continue(()));
    assert!(outcome.unwrap_err().to_string().starts_with("particles"));
}

/// A car whose way ends on ice: with the zone the speed is found, without it a far higher one is.
#[test]
fn a_way_over_ice_is_no_sign_of_a_high_speed() {
    let folder = tempfile::tempdir().unwrap();
    let site = folder.path().join("site.toml");
    let ice = "name = \"lake\"\n[[friction_zone]]\nname = \"ice\"\nfriction = 0.15\n\
               border_m = [[20, -60], [300, -60], [300, 60], [20, 60]]\n";
    std::fs::write(&site, ice).unwrap();
    let mut evidence = spin();
    evidence.edr = None;
    let inline = |evidence: &Evidence| EvidenceChoice::Inline(Box::new(evidence.clone()));
    let on_site = ReconstructRequest { site: Some(site), ..request(100) };

    // The motion of the medians at 20 m/s, of which the place of rest is found.
    let model = on_site.model(&evidence).unwrap();
    let mut z = vec![0.0; model.prior().components().len()];
    z[0] = -0.43;
    let [truth] = &model.motions(&[z], |motion| motion)[..] else { panic!("one motion") };
    let end = truth.path.points.last().unwrap();
    let rest = evidence.rest.as_mut().unwrap();
    (rest.x_m, rest.y_m) = (Some(end.x_m), Some(end.y_m));
    rest.heading_rad.as_mut().unwrap().value = Some(end.yaw_rad);
    assert!(end.x_m > 30.0, "it rests on the ice: {end:?}");

    let speed = |request: &ReconstructRequest| {
        let report = answer(request).report;
        (report.quantities[0].clone(), report)
    };
    let (known, report) =
        speed(&ReconstructRequest { evidence: inline(&evidence), ..on_site.clone() });
    let true_m_s = truth.impact.unwrap().struck_speed_m_s;
    assert!((known.estimate.median / true_m_s - 1.0).abs() < 0.25, "{true_m_s} m/s, {known:?}");
    assert_eq!(report.friction_zones[0].name, "ice");
    for part in ["friction of the zone \"ice\" is 0.15", "all of which stood on one friction"] {
        assert!(report.caveats.iter().any(|caveat| caveat.text.contains(part)), "{part}");
    }
    assert!(report.priors.iter().any(|prior| prior.latent == Latent::ZoneFrictionFactor));
    let zones =
        report.caveats.iter().find(|caveat| caveat.text.contains("zones of the site")).unwrap();
    assert_eq!(zones.subject, Some(CaveatSubject::RoadFriction));
    let without = ReconstructRequest { site: None, evidence: inline(&evidence), ..on_site };
    let (blind, report) = speed(&without);
    assert!(blind.estimate.median > 1.2 * true_m_s, "{true_m_s} m/s, {blind:?}");
    assert!(report.friction_zones.is_empty());
}

#[test]
fn a_friction_that_the_evidence_leaves_open_is_that_of_the_road() {
    let mut evidence = spin();
    evidence.friction = None;
    let choice = EvidenceChoice::Inline(Box::new(evidence.clone()));
    let model = ReconstructRequest { evidence: choice, ..request(100) }.model(&evidence).unwrap();
    let caveats = assumptions(&evidence, &model);
    let friction =
        caveats.iter().find(|caveat| caveat.to_string().contains("[road] friction")).unwrap();
    assert!(
        friction.to_string().starts_with("assumed road friction: friction of the road, 90 %: 0."),
        "{friction}"
    );
}

#[test]
fn a_form_that_has_not_been_filled_in_is_not_reconstructed_from() {
    let mut evidence = spin();
    evidence.rest.as_mut().unwrap().y_m = None;
    let evidence = EvidenceChoice::Inline(Box::new(evidence));
    let error = evidence.load().unwrap_err().to_string();
    assert!(error.contains("struck car at rest has not been placed"), "{error}");
}

#[test]
fn the_slope_of_a_site_moves_the_cars_and_another_one_of_the_evidence_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let site = folder.path().join("site.toml");
    std::fs::write(&site, "name = \"hill\"\n[road]\ngrade = 0.04\n").unwrap();
    let mut evidence = spin();
    let on_site = ReconstructRequest { site: Some(site), ..request(100) };
    let model = on_site.model(&evidence).unwrap();
    let cars = model.cars();
    for car in [&cars.struck, &cars.striking] {
        assert_eq!((car.parameters.slope.grade, car.parameters.slope.cross_slope), (0.04, 0.0));
    }
    evidence.friction.as_mut().unwrap().grade = Some(0.05);
    let error = on_site.model(&evidence).unwrap_err();
    assert!(error.to_string().contains("another slope than the site"), "{error}");
    let alone = request(100).model(&evidence).unwrap();
    assert_eq!(alone.cars().struck.parameters.slope.grade, 0.05);
}

/// Both stood in the report, and nothing said that they do not agree.
#[test]
fn a_calculation_by_hand_that_the_answer_contradicts_is_a_warning() {
    let mut posterior = answer(&request(120)).posterior;
    let [low, high] = posterior.speed_of(HandSpeed::StruckAfter).unwrap().ninety();
    let check = |value_m_s| HandCheck {
        speed: HandSpeed::StruckAfter,
        value_m_s,
        sigma_m_s: 0.5,
        holds: "",
    };
    assert_eq!(apart_by_hand(&[check(high + 0.8), check(low - 0.8)], &posterior), None);
    for value_m_s in [high + 0.9, low - 0.9] {
        let caveat = apart_by_hand(&[check(high), check(value_m_s)], &posterior).unwrap();
        assert!(caveat.is_warning() && caveat.kind == CaveatKind::Disagreement, "{caveat}");
        assert!(caveat.text.contains("struck car after the impact"), "{caveat}");
        assert_eq!(caveat.text.matches("km/h by hand and").count(), 1, "{caveat}");
    }
    // Too few particles say nothing of how far the others reach.
    posterior.ess = 50.0;
    assert_eq!(apart_by_hand(&[check(high + 9.0)], &posterior), None);
}
