//! A predicted motion, as a person reads it.

use std::io::{self, Write};

use crate::cli::console::{print_caveats, print_facts, shown};
use crate::cli::text::contact::implied_facts;
use crate::cli::text::sensitivity::print_sensitivity;
use impactlab_core::units::{Quantity, UnitSystem, percent};
use impactlab_study::PredictMotionReport;
use impactlab_study::analysis::{RestOutcome, Spread};

/// Prints how the motion ends.
pub(in crate::cli) fn print_motion_prediction(
    out: &mut dyn Write,
    report: &PredictMotionReport,
    units: UnitSystem,
) -> io::Result<()> {
    let outcome = &report.outcome;
    let when = match (&report.rest, outcome.is_at_rest) {
        (Some(rest), _) => shown_share(rest),
        (None, true) => format!("at rest after {:.2} s", outcome.time_s),
        (None, false) => format!("after {:.2} s, still moving", outcome.time_s),
    };
    let mut facts = vec![
        ("scenario", report.scenario.clone()),
        ("vehicle", report.vehicle.clone()),
        ("forces", format!("{}, each as likely", report.n_forces)),
        ("end", when),
    ];
    facts.extend(report.rest.iter().flat_map(|rest| rest_facts(rest, units)));
    facts.extend([
        ("speed", shown(Quantity::Speed, outcome.speed_m_s, units)),
        ("yaw rate", shown(Quantity::AngularVelocity, outcome.yaw_rate_rad_s, units)),
        ("X", shown_spread(Quantity::Length, &outcome.x_m, units)),
        ("Y", shown_spread(Quantity::Length, &outcome.y_m, units)),
        ("heading change", shown_spread(Quantity::Angle, &outcome.heading_change_rad, units)),
        ("90 % region", format!("{:.1} m²", outcome.region_90_m2)),
        ("P(quarter turn or more)", percent(outcome.p_quarter_turn)),
        ("P(half turn or more)", percent(outcome.p_half_turn)),
    ]);
    if let Some(probability) = report.hooking_probability {
        facts.push(("P(hooking)", percent(probability)));
    }
    facts.extend(report.implied_contact.iter().flat_map(|of| implied_facts(of, units)));
    if report.applicability < 1.0 {
        facts.push(("applicability", format!("{:.2} of 1", report.applicability)));
    }
    if report.n_vehicles > 0 {
        facts.push(("vehicles", format!("{} drawn from the data sheet", report.n_vehicles)));
    }
    print_facts(out, &facts)?;
    print_sensitivity(out, &report.sensitivity)?;
    print_caveats(out, &report.caveats)
}

/// Median and central 90 %.
fn shown_spread(quantity: Quantity, of: &Spread, units: UnitSystem) -> String {
    let [low, high] = of.ninety.map(|value| shown(quantity, value, units));
    format!("{} (90 %: {low} to {high})", shown(quantity, of.median, units))
}

/// In how many of the draws the vehicle comes to rest.
pub(super) fn shown_share(rest: &RestOutcome) -> String {
    let RestOutcome { n_draws, share_at_rest, limit_s, .. } = rest;
    format!("at rest in {} of {n_draws} draws, within {limit_s:.0} s", percent(*share_at_rest))
}

/// When, after what distance and with what heading the vehicle comes to rest. Where some of the draws
/// still move, the upper ends are those of the time for which they were followed.
pub(super) fn rest_facts(rest: &RestOutcome, units: UnitSystem) -> Vec<(&'static str, String)> {
    let both = |quantity: Quantity, of: &Spread| {
        let [low, high] = of.half.map(|value| shown(quantity, value, units));
        format!("{}; 50 %: {low} to {high}", shown_spread(quantity, of, units))
    };
    let [half, ninety] = [rest.region_50_m2, rest.region_90_m2];
    vec![
        ("time to rest", both(Quantity::Time, &rest.time_s)),
        ("distance to rest", both(Quantity::Length, &rest.distance_m)),
        ("heading at rest", both(Quantity::Angle, &rest.yaw_rad)),
        ("50 % region", format!("{half:.1} m² (90 %: {ninety:.1} m²)")),
    ]
}
