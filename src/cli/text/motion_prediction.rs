//! A predicted motion, as a person reads it.

use std::io::{self, Write};

use crate::analysis::Spread;
use crate::cli::console::{print_badges, print_facts, shown};
use crate::cli::text::contact::implied_facts;
use crate::cli::text::sensitivity::print_sensitivity;
use crate::study::PredictMotionReport;
use crate::units::{Quantity, UnitSystem, percent};

/// Prints how the motion ends.
pub(in crate::cli) fn print_motion_prediction(
    out: &mut dyn Write,
    report: &PredictMotionReport,
    units: UnitSystem,
) -> io::Result<()> {
    let outcome = &report.outcome;
    let spread = |quantity: Quantity, of: &Spread| {
        let [low, high] = of.ninety;
        format!(
            "{} (90 %: {} to {})",
            shown(quantity, of.median, units),
            shown(quantity, low, units),
            shown(quantity, high, units)
        )
    };
    let when = match outcome.is_at_rest {
        true => format!("at rest after {:.2} s", outcome.time_s),
        false => format!("after {:.2} s, still moving", outcome.time_s),
    };
    let mut facts = vec![
        ("scenario", report.scenario.clone()),
        ("vehicle", report.vehicle.clone()),
        ("forces", format!("{}, each as likely", report.n_forces)),
        ("end", when),
        ("speed", shown(Quantity::Speed, outcome.speed_m_s, units)),
        ("yaw rate", shown(Quantity::AngularVelocity, outcome.yaw_rate_rad_s, units)),
        ("X", spread(Quantity::Length, &outcome.x_m)),
        ("Y", spread(Quantity::Length, &outcome.y_m)),
        ("heading change", spread(Quantity::Angle, &outcome.heading_change_rad)),
        ("90 % region", format!("{:.1} m²", outcome.region_90_m2)),
        ("P(quarter turn or more)", percent(outcome.p_quarter_turn)),
        ("P(half turn or more)", percent(outcome.p_half_turn)),
    ];
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
    print_badges(out, &report.badges, &report.assumptions)
}
