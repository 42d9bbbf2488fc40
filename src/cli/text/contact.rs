//! Restitution and friction of a contact, as a person reads them.

use crate::cli::console::shown_vector;
use impactlab_core::units::{Quantity, UnitSystem, significant};
use impactlab_study::analysis::Estimate;
use impactlab_study::{ImpliedContactReport, MomentumReport};

/// Names and values of the implied restitution and impulse ratio, and of the momentum solution with
/// the collision's own values.
pub(in crate::cli) fn implied_facts(
    implied: &ImpliedContactReport,
    units: UnitSystem,
) -> Vec<(&'static str, String)> {
    let estimate = |of: &Estimate| {
        let interval = of.interval(0.9).map_or(String::new(), |[low, high]| {
            format!(" (90 %: {} to {})", significant(low), significant(high))
        });
        format!("{}{interval}", significant(of.median))
    };
    let momentum = &implied.momentum;
    let [x, y] = momentum.impulse_n_s;
    vec![
        ("implied e", estimate(&implied.restitution)),
        ("P_τ/P_n", format!("implied {}", estimate(&implied.impulse_ratio))),
        (
            "momentum",
            format!(
                "{} with {}",
                shown_vector(Quantity::Impulse, [x, y], ["x", "y"], units),
                surface(momentum)
            ),
        ),
    ]
}

/// Restitution and friction limit of a momentum solution, and its regime.
pub(in crate::cli) fn surface(momentum: &MomentumReport) -> String {
    format!(
        "e {} {}, μ_c {}: {}",
        momentum.restitution,
        momentum.restitution_form.label(),
        (momentum.friction_limit * 1e4).round() / 1e4,
        momentum.regime.label()
    )
}
