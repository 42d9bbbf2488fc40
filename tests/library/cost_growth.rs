//! How `examples/cost_growth` finds the exponent of a cost.

#[path = "../../examples/cost_growth/fit.rs"]
mod fit;

use fit::{exponent_of_n_log_n, growth, upper_half};

fn points(cost: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    (2..10).map(|step| 10_f64.powf(f64::from(step) / 2.0)).map(|n| (n, cost(n))).collect()
}

#[test]
fn a_power_has_its_exponent_and_no_error() {
    for exponent in [0.0, 0.5, 1.0, 2.0] {
        let found = growth(&points(|n| 3e-4 * n.powf(exponent))).unwrap();
        assert!((found.exponent - exponent).abs() < 1e-12, "{found:?}");
        assert!(found.standard_error < 1e-6, "{found:?}");
    }
}

#[test]
fn a_constant_cost_counts_less_in_the_upper_half() {
    let points = points(|n| 1.0 + 1e-3 * n);
    let [all, upper] = [points.as_slice(), upper_half(&points)].map(|part| growth(part).unwrap());
    assert!(all.exponent < upper.exponent && upper.exponent < 1.0, "{all:?} {upper:?}");
    assert_eq!(upper_half(&points).len(), 4);
    assert_eq!(upper_half(&points[..4]).len(), 3);
    assert_eq!(upper_half(&points[..2]).len(), 2);
}

/// The residuals 0.1, −0.2, 0.1 about a line of slope 1 leave the slope alone.
#[test]
fn scatter_makes_the_standard_error_and_not_the_slope() {
    let scattered = [(1.0, 0.1), (2.0, -0.2), (3.0, 0.1)];
    let points = scattered.map(|(x, residual): (f64, f64)| (x.exp(), (x + residual).exp()));
    let found = growth(&points).unwrap();
    assert!((found.exponent - 1.0).abs() < 1e-12, "{found:?}");
    // √(Σ residual² / (n − 2) / Σ (x − x̄)²)
    assert!((found.standard_error - (0.06_f64 / 2.0).sqrt()).abs() < 1e-12, "{found:?}");
}

#[test]
fn n_log_n_lies_between_the_first_and_the_second_power() {
    let of_n_log_n = exponent_of_n_log_n(&points(|_| 1.0)).unwrap();
    let found = growth(&points(|n| n * n.ln())).unwrap();
    assert!((found.exponent - of_n_log_n).abs() < 1e-12);
    assert!((1.05..1.5).contains(&of_n_log_n), "{of_n_log_n}");
}

#[test]
fn what_determines_no_line_has_no_exponent() {
    assert_eq!(growth(&[(10.0, 1.0), (100.0, 2.0)]), None);
    assert_eq!(growth(&[(10.0, 1.0); 3]), None);
    assert_eq!(growth(&[(10.0, 1.0), (100.0, 0.0), (1000.0, 2.0)]), None);
    assert_eq!(exponent_of_n_log_n(&[(1.0, 1.0), (3.0, 1.0), (10.0, 1.0)]), None);
}
