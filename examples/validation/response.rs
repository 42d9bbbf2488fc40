//! The table of the response network on cars that it has not seen.

use std::error::Error;
use std::path::Path;

use impactlab_core::data::list_folder;
use impactlab_core::numerics::Summary;
use impactlab_networks::response::evaluate::{ComparedCase, MotionCoverage};
use impactlab_study::{
    BadCases, EvaluateResponseRequest, EvaluatedCases, HeldIntervals, Measured, ModelChoice,
    TriedMotion, VehicleChoice,
};

use crate::tables::answer;
use crate::{Found, Row};

/// The sets of sampled cars that nothing was fitted to, one of each design.
const HELD_OUT_CARS: [&str; 3] = [
    "trajectories-cars-held-out",
    "trajectories-cars-wide-held-out",
    "trajectories-cars-edge-held-out",
];

/// Errors of the shipped response network on cars that it has not seen, each by its data sheet, and how
/// often its regions held.
pub(crate) fn of_cars_held_out(datasets: &Path) -> Result<Found, Box<dyn Error>> {
    let mut cases: Vec<(ComparedCase, MotionCoverage)> = Vec::new();
    let mut n_left_out = 0;
    let mut cars = Vec::new();
    for set in HELD_OUT_CARS {
        cars.extend(list_folder(&datasets.join(set))?.into_iter().filter(|path| path.is_dir()));
    }
    for car in cars {
        let question = EvaluateResponseRequest {
            model: ModelChoice::default(),
            data: car,
            split: EvaluatedCases::All,
            vehicle: VehicleChoice::default(),
            seed: 0,
            bad_cases: BadCases::LeaveOut,
        };
        let report = answer(&question)?.report.report;
        n_left_out += report.left_out.len();
        for case in report.comparison.cases {
            let coverage = case.metrics.coverage.ok_or("no regions")?;
            cases.push((case, coverage));
        }
    }
    println!("motions of cars held out: {} measured, {n_left_out} left out", cases.len());
    let mut rows = Vec::new();
    for (name, is_braked) in [("coasting", false), ("braked", true)] {
        let of: Vec<&(ComparedCase, MotionCoverage)> =
            cases.iter().filter(|(case, _)| case.is_braked == is_braked).collect();
        let summary = |value: fn(&ComparedCase) -> Option<f64>| {
            Summary::from_values(of.iter().filter_map(|(case, _)| value(case))).ok_or("no cases")
        };
        let path_m = summary(|case| Some(case.metrics.average_error_4_s_m))?;
        let end_m = summary(|case| Some(case.metrics.error.final_error_m))?;
        let share = |value: fn(&MotionCoverage) -> f64| {
            let sum: f64 = of.iter().map(|(_, coverage)| value(coverage)).sum();
            format!("{:.0} %", 100.0 * sum / of.len().max(1) as f64)
        };
        rows.push(Row::new(
            &[
                name.to_owned(),
                of.len().to_string(),
                format!("{:.2}", path_m.mean),
                format!("{:.2}", path_m.median),
                format!("{:.1}", end_m.median),
                share(|held| held.path_50),
                share(|held| held.path_90),
                share(|held| held.end_50),
                share(|held| held.end_90),
            ],
            1,
        ));
    }
    let held = |quantity: &str, kind: Option<TriedMotion>| {
        let is_of = |case: &ComparedCase| {
            kind.is_none_or(|kind| case.is_braked == (kind == TriedMotion::Braked))
        };
        let of: Vec<&MotionCoverage> =
            cases.iter().filter(|(case, _)| is_of(case)).map(|(_, coverage)| coverage).collect();
        let count = |holds: fn(&MotionCoverage) -> f64| {
            of.iter().filter(|coverage| holds(coverage) > 0.5).count()
        };
        HeldIntervals {
            quantity: quantity.to_owned(),
            in_50: count(|held| held.end_50),
            in_90: count(|held| held.end_90),
            n: of.len(),
            of: kind,
        }
    };
    let held = vec![
        held("place at the end", None),
        held("place of a coasting car at the end", Some(TriedMotion::Coasting)),
        held("place of a braked car at the end", Some(TriedMotion::Braked)),
    ];
    Ok(Found {
        subject: Measured::ResponseNetwork,
        tables: vec![rows],
        held,
        held_in_all: Vec::new(),
    })
}
