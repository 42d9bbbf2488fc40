//! Histories with one fault each raise the flag of that fault and no other.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::data::{
    Case, Channel, Dataset, Flag, FlagKind, Sampling, Severity, TimeSeries, check_case,
    check_series, contact_interval,
};

/// A haversine pulse of 60 kN from 20 ms to 120 ms, sampled at 1 kHz for 0.2 s.
fn pulse(spoil: impl Fn(usize, f64) -> f64) -> Vec<f64> {
    let force_n = |i: usize| match i {
        20..=120 => 3e4 * (1.0 - ((i - 20) as f64 / 100.0 * std::f64::consts::TAU).cos()),
        _ => 0.0,
    };
    (0..200).map(|i| spoil(i, force_n(i))).collect()
}

fn flags(time_s: impl Fn(usize) -> f64, fy_n: Vec<f64>) -> Vec<Flag> {
    let mut series = TimeSeries::new((0..fy_n.len()).map(time_s).collect()).unwrap();
    series.insert(Channel::Fx, vec![0.0; fy_n.len()]).unwrap();
    series.insert(Channel::Fy, fy_n).unwrap();
    check_series(&series, Sampling::Instant)
}

#[test]
fn every_fault_raises_its_flag() {
    let clock = |i: usize| i as f64 * 1e-3;
    let clean = || pulse(|_, force| force);
    assert!(flags(clock, clean()).is_empty());
    let late = |i: usize| clock(i) + if i > 70 { 0.02 } else { 0.0 };
    let jitter = |i: usize| clock(i) + if i % 2 == 1 { 1e-4 } else { 0.0 };
    let spiked = |at: usize| pulse(move |i, force| if i == at { force + 4e4 } else { force });
    for (kind, found) in [
        (FlagKind::SamplingGap, flags(late, clean())),
        (FlagKind::NonUniformSampling, flags(jitter, clean())),
        (FlagKind::Spike, flags(clock, spiked(40))),
        (FlagKind::Spike, flags(clock, spiked(70))),
        (FlagKind::Spike, flags(clock, spiked(160))),
        (FlagKind::ImplausibleForce, flags(clock, pulse(|_, force| force * 50.0))),
        (FlagKind::LongContact, flags(|i| clock(i) * 1e3, clean())),
        (FlagKind::NoForce, flags(clock, vec![0.0; 200])),
        (FlagKind::NotSeparated, flags(clock, clean()[..90].to_vec())),
    ] {
        let kinds: Vec<FlagKind> = found.iter().map(|flag| flag.kind).collect();
        assert_eq!(kinds, [kind], "{found:?}");
    }
}

#[test]
fn an_offset_is_drift_and_hides_the_separation() {
    let found = flags(|i| i as f64 * 1e-3, pulse(|_, force| force + 4e3));
    let kinds: Vec<FlagKind> = found.iter().map(|flag| flag.kind).collect();
    assert_eq!(kinds, [FlagKind::NotSeparated, FlagKind::Drift]);
    assert_eq!(
        found[1].to_string(),
        "force before contact is 6.2 % of the peak, limit 5 %; remove the offset"
    );
}

fn shipped_case(dataset: &str) -> Case {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets").join(dataset);
    let loaded = Dataset::load(&root, &mut |_| ControlFlow::Continue(())).unwrap();
    loaded.complete().unwrap().cases.swap_remove(0)
}

#[test]
fn forces_that_do_not_explain_the_motion_are_flagged() {
    for (dataset, channel) in [("fea", Channel::Fy), ("trajectories-pulse", Channel::FyBody)] {
        for (factor, severity) in [(1.05, Severity::Warning), (-1.0, Severity::Error)] {
            let mut case = shipped_case(dataset);
            let forces = case.series.require(channel).unwrap();
            let wrong = forces.iter().map(|force| force * factor).collect();
            case.series.insert(channel, wrong).unwrap();
            let found = check_case(&case);
            assert_eq!(found.len(), 1, "{dataset}: {found:?}");
            assert_eq!(found[0].kind, FlagKind::MomentumResidual);
            assert_eq!(found[0].severity, severity, "{dataset}");
        }
    }
}

#[test]
fn the_contact_interval_agrees_with_the_table_of_cases() {
    let case = shipped_case("fea");
    let (start, end) = contact_interval(&case.force_history().unwrap()).unwrap();
    let stated = |name| case.attributes.number(name).unwrap();
    assert!((start - stated("t_start_s")).abs() < 0.001, "{start}");
    assert!((end - stated("t_end_s")).abs() < 0.005, "{end}");
}

#[test]
fn attributes_are_all_kept_in_order() {
    let case = shipped_case("fea");
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/fea/cases.csv");
    let text = fs::read_to_string(table).unwrap();
    let header = text.lines().next().unwrap();
    assert!(case.attributes.iter().map(|(name, _)| name).eq(header.split(',')));
    assert_eq!(case.attributes.text("bullet_body"), Some("A"));
    assert_eq!(case.attributes.number("m_t_kg"), Some(2000.0));
    assert_eq!(case.attributes.flag("hooked"), Some(false));
    assert_eq!(case.attributes.get("no such column"), None);
}
