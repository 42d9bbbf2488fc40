//! The rows of the tables.

use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::collision::{DEFAULT_FRICTION_LIMIT, DEFAULT_RESTITUTION, RestitutionForm};
use impactlab_core::data::Dataset;
use impactlab_core::numerics::{Summary, median, wilson_interval};
use impactlab_core::vehicle::Integrator;
use impactlab_networks::force::{ContactLaw, ForceCase};
use impactlab_networks::learning::{TEST_SHARE, split};
use impactlab_networks::pair::{EvaluatedPair, VehicleScore};
use impactlab_reconstruct::ReconstructedQuantity;
use impactlab_reconstruct::evaluate::{KnownEvidence, StagedCollisions, StagedSplit};
use impactlab_study::{
    BadCases, EvaluateForceRequest, EvaluatePairsRequest, EvaluatedCases, Event, HeldIntervals,
    Library, Measured, ModelChoice, PairSplit, Question, SimulateDatasetRequest, TriedMotion,
    VehicleChoice,
};
use serde::Deserialize;
use serde_json::Value;

use crate::{Found, Row, response};

impl Row {
    /// - `n_names`: how many of the first cells name it.
    pub(crate) fn new(cells: &[String], n_names: usize) -> Self {
        let name = format!("| {} |", cells[..n_names].join(" | "));
        Self { name, line: format!("| {} |", cells.join(" | ")) }
    }
}

/// What takes minutes: impulses, motions of the 4DOF model, pairs, and both networks.
pub(crate) fn quick(datasets: &Path) -> Result<Vec<Found>, Box<dyn Error>> {
    Ok(vec![
        impact(&datasets.join("fea"))?,
        four_dof(datasets)?,
        force(datasets)?,
        pairs(&datasets.join("pairs"))?,
        response::of_cars_held_out(datasets)?,
    ])
}

pub(crate) fn answer<Q: Question>(question: &Q) -> Result<Q::Answer, Box<dyn Error>> {
    let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
    let answer = question.answer(&Library::default(), &mut go_on)?;
    Ok(answer.complete().ok_or("cancelled")?)
}

/// Errors of the impulse with the default surface, and with the one that fits best where restitution acts
/// on the common velocity.
fn impact(path: &Path) -> Result<Found, Box<dyn Error>> {
    let cases = cases(path)?;
    let split = split(&cases, 0, TEST_SHARE);
    let of = |indices: &[usize]| -> Vec<&ForceCase> {
        indices.iter().filter_map(|&idx| cases.get(idx)).collect()
    };
    let train: Vec<&ForceCase> =
        of(&split.train).into_iter().filter(|case| case.is_clean()).collect();
    let test = of(&split.test);
    let forms = [
        (RestitutionForm::Normal, "restitution on the normal component", DEFAULT_FRICTION_LIMIT),
        (RestitutionForm::CommonVelocity, "restitution from the common velocity", 0.31),
    ];
    let mut rows = Vec::new();
    for (form, name, friction_limit) in forms {
        let of_default = if form == RestitutionForm::Normal { " (the default)" } else { "" };
        let error = |case: &&ForceCase| {
            let restitution = DEFAULT_RESTITUTION;
            let law = ContactLaw::at_closing_speed(0.0);
            let mut impact =
                case.scenario.impact(ContactLaw { restitution, friction_limit, ..law })?;
            impact.surface.restitution_form = form;
            let ([px, py], [qx, qy]) = (impact.solve().ok()?.impulse_world_n_s, case.impulse_n_s);
            Some(100.0 * (px - qx).hypot(py - qy) / qx.hypot(qy))
        };
        let share = |cases: &[&ForceCase]| {
            let errors = Summary::from_values(cases.iter().filter_map(error));
            errors.map_or_else(String::new, |of| format!("{:.1} ({:.1})", of.median, of.mean))
        };
        let surface = format!("{DEFAULT_RESTITUTION:.2}, {friction_limit:.2}{of_default}");
        rows.push(Row::new(&[name.to_owned(), surface, share(&train), share(&test)], 1));
    }
    Ok(Found {
        subject: Measured::Impact,
        tables: vec![rows],
        held: Vec::new(),
        held_in_all: Vec::new(),
    })
}

/// Errors of each of both sets of the reference car.
fn four_dof(datasets: &Path) -> Result<Found, Box<dyn Error>> {
    let mut rows = Vec::new();
    for set in ["trajectories-fea", "trajectories-pulse"] {
        let question = SimulateDatasetRequest {
            dataset: datasets.join(set),
            case: None,
            vehicle: VehicleChoice::Automatic,
            equations: None,
            integrator: Integrator::default(),
        };
        let cases = answer(&question)?.report.report.cases;
        let path = cases.iter().map(|case| case.error.average_error_m);
        let path = Summary::from_values(path).ok_or("no cases")?;
        let ends = cases.iter().map(|case| case.error.final_error_m);
        let ends = Summary::from_values(ends).ok_or("no cases")?;
        let violations: usize = cases.iter().filter_map(|case| case.violations).sum();
        let numbers = [path.mean, path.std, path.median].map(|error| format!("{error:.3}"));
        let mut cells = vec![format!("{set}, all"), path.n.to_string()];
        cells.extend(numbers);
        cells.extend([format!("{:.2}", ends.median), violations.to_string()]);
        rows.push(Row::new(&cells, 1));
    }
    Ok(Found {
        subject: Measured::FourDof,
        tables: vec![rows],
        held: Vec::new(),
        held_in_all: Vec::new(),
    })
}

/// Scores of both vehicles of recorded pairs.
const OF_CARS: [fn(&EvaluatedPair) -> &VehicleScore; 2] =
    [|case| &case.struck, |case| &case.striking];

/// How often the regions of one vehicle held its place at the end.
fn ends_held<'a>(
    cases: impl Iterator<Item = &'a EvaluatedPair> + Clone,
    score: fn(&EvaluatedPair) -> &VehicleScore,
    (quantity, of): (String, Option<TriedMotion>),
) -> HeldIntervals {
    let count =
        |holds: fn(&VehicleScore) -> bool| cases.clone().filter(|case| holds(score(case))).count();
    let n = cases.clone().count();
    HeldIntervals { quantity, in_50: count(|of| of.end_50), in_90: count(|of| of.end_90), n, of }
}

/// Errors of both vehicles of recorded pairs, and how often their regions held, of the half that the
/// contact law was fitted to and of the other one; and of impacts of both halves that are no push on a flank.
fn pairs(path: &Path) -> Result<Found, Box<dyn Error>> {
    let (mut rows, mut held, mut others) = (Vec::new(), Vec::new(), Vec::new());
    for (split, name) in [(PairSplit::Reported, "not fitted to"), (PairSplit::Fitted, "fitted to")]
    {
        let question = EvaluatePairsRequest { split, ..EvaluatePairsRequest::new(path) };
        let report = answer(&question)?.report.report;
        let struck = report.overall.as_ref().map(|overall| &overall.vehicle);
        let summaries = [struck, report.striking.as_ref()];
        for ((summary, car), score) in
            summaries.into_iter().zip(["struck", "striking"]).zip(OF_CARS)
        {
            let summary = summary.ok_or("no cases")?;
            let share = |share: f64| format!("{:.0} %", 100.0 * share);
            let path_m = &summary.average_error_m;
            rows.push(Row::new(
                &[
                    name.to_owned(),
                    car.to_owned(),
                    report.cases.len().to_string(),
                    format!("{:.2}", path_m.mean),
                    format!("{:.2}", path_m.median),
                    format!("{:.1}", summary.end_error_m.median),
                    share(summary.quarter_turn_right),
                    share(summary.half_turn_right),
                    share(summary.coverage.of_50),
                    share(summary.coverage.of_90),
                    share(summary.end_coverage.of_50),
                    share(summary.end_coverage.of_90),
                ],
                2,
            ));
            if split == PairSplit::Reported {
                let quantity = format!("place of the {car} vehicle at the end");
                held.push(ends_held(report.cases.iter(), score, (quantity, None)));
            }
        }
        let is_other = |case: &&EvaluatedPair| matches!(&*case.kind, "rear-end" | "t-bone");
        others.extend(report.cases.iter().filter(is_other).cloned());
    }
    for (does, score) in ["is hit", "hits"].into_iter().zip(OF_CARS) {
        let quantity = format!("place at the end of the vehicle that {does} from behind or across");
        let of = Some(TriedMotion::AcrossOrBehind);
        held.push(ends_held(others.iter(), score, (quantity, of)));
    }
    Ok(Found { subject: Measured::Pairs, tables: vec![rows], held, held_in_all: Vec::new() })
}

/// A number of a report by its place.
fn number(report: &Value, place: &str) -> Result<f64, Box<dyn Error>> {
    let number = report.pointer(place).and_then(Value::as_f64);
    Ok(number.ok_or_else(|| format!("no number {place}"))?)
}

/// Quantities of a force whose intervals are counted, with their keys in a report.
const COUNTED: [(&str, &str); 3] =
    [("impulse", "impulse_n_s"), ("peak", "peak_n"), ("duration", "duration_s")];

/// Errors of the shipped force network and of two of its baselines on the test cases of slow PITs, and how often
/// its intervals held there. What answers tell is how often they held on cases of the whole range that the
/// network applies to, which nothing was fitted to.
fn force(datasets: &Path) -> Result<Found, Box<dyn Error>> {
    let question = EvaluateForceRequest::new(ModelChoice::default(), datasets.join("fea"));
    let report = serde_json::to_value(answer(&question)?.report)?;
    let number = |place: &str| number(&report, place);
    let models = [
        ("force network", "/overall"),
        ("classic pulse", "/baselines/pulse/overall"),
        ("Gaussian processes", "/baselines/statistical/overall"),
    ];
    let errors =
        ["history_error", "rmse_over_peak", "impulse_error", "peak_error", "duration_error"];
    let mut rows = Vec::new();
    for (name, place) in models {
        let mut cells = vec![name.to_owned()];
        for error in errors {
            let [median, mean] = ["median", "mean"].map(|of| format!("{place}/{error}/{of}"));
            cells.push(format!("{:.1} ({:.1})", 100.0 * number(&median)?, 100.0 * number(&mean)?));
        }
        rows.push(Row::new(&cells, 1));
    }
    let n = number("/n_test")? as usize;
    let mut shares = Vec::new();
    for (name, key) in [("F(t)", "force_n")].into_iter().chain(COUNTED) {
        let mut cells = vec![name.to_owned()];
        for level in 0..4 {
            let share = 100.0 * number(&format!("/overall/{key}/{level}/share"))?;
            let error = 100.0 * number(&format!("/overall/{key}/{level}/standard_error"))?;
            let lowest = 100.0 * wilson_interval(n, n)[0];
            cells.push(match share > 99.999 {
                true => format!("100 (≥ {lowest:.0})"),
                false => format!("{share:.0} ± {error:.0}"),
            });
        }
        shares.push(Row::new(&cells, 1));
    }
    Ok(Found {
        subject: Measured::ForceNetwork,
        tables: vec![rows, shares],
        held: forces_held(&datasets.join("fea-road-held-out"))?,
        held_in_all: Vec::new(),
    })
}

/// How often intervals of the shipped force network held on a set that nothing was fitted to.
fn forces_held(path: &Path) -> Result<Vec<HeldIntervals>, Box<dyn Error>> {
    let question = EvaluateForceRequest {
        split: EvaluatedCases::All,
        bad_cases: BadCases::LeaveOut,
        ..EvaluateForceRequest::new(ModelChoice::default(), path)
    };
    let report = serde_json::to_value(answer(&question)?.report)?;
    let n = number(&report, "/n_test")? as usize;
    let held = COUNTED.map(|(name, key)| -> Result<HeldIntervals, Box<dyn Error>> {
        let count = |level: usize| -> Result<usize, Box<dyn Error>> {
            let share = number(&report, &format!("/overall/{key}/{level}/share"))?;
            Ok((n as f64 * share).round() as usize)
        };
        let quantity = name.to_owned();
        Ok(HeldIntervals { quantity, in_50: count(0)?, in_90: count(2)?, n, of: None })
    });
    held.into_iter().collect()
}

/// A quantity of a case beside its true value.
struct Scored {
    case: String,
    median: f64,
    truth: f64,
    crps: f64,
    intervals: Vec<[f64; 2]>,
}

/// Quantities of reconstructions: the name in the tables, the quantity, and how many of the unit of the
/// table a unit of SI is.
const QUANTITIES: [(&str, ReconstructedQuantity, f64); 6] = [
    ("struck car [km/h]", ReconstructedQuantity::StruckSpeed, 3.6),
    ("closing speed [km/h]", ReconstructedQuantity::ClosingSpeed, 3.6),
    ("striking car [km/h]", ReconstructedQuantity::StrikingSpeed, 3.6),
    ("Δv of the struck car [km/h]", ReconstructedQuantity::DeltaVStruck, 3.6),
    (
        "relative heading [°]",
        ReconstructedQuantity::HeadingDifference,
        180.0 / std::f64::consts::PI,
    ),
    ("yaw rate after [°/s]", ReconstructedQuantity::StruckYawRate, 180.0 / std::f64::consts::PI),
];

/// The tables of a file of `impactlab evaluate reconstruction`, for each part of the evidence in it.
pub(crate) fn reconstructions(path: &Path, datasets: &Path) -> Result<Vec<Found>, Box<dyn Error>> {
    let report: Value = serde_json::from_str(&fs::read_to_string(path)?)?;
    let text = |value: &Value, key: &str| -> Result<String, Box<dyn Error>> {
        Ok(value[key].as_str().ok_or_else(|| format!("no {key}"))?.to_owned())
    };
    let staged = StagedCollisions::open(Path::new(&text(&report, "data")?))?;
    let scores = report["cases"].as_array().ok_or("no cases")?;
    let parts = [
        (staged.names_in(StagedSplit::Reported), "reported"),
        (staged.names_in(StagedSplit::Tuning), "tuning"),
        (names_of_other_runs(&staged, datasets)?, "other runs"),
    ];
    let mut found = Vec::new();
    for known in KnownEvidence::ALL {
        let word = serde_json::to_value(known)?;
        let is_of = |score: &&Value| score["known"] == word && score["method"] == "reconstruction";
        let scores: Vec<&Value> = scores.iter().filter(is_of).collect();
        if scores.is_empty() {
            continue;
        }
        let (mut rows, mut held, mut held_in_all) = (Vec::new(), Vec::new(), Vec::new());
        for (name, quantity, unit) in QUANTITIES {
            let of_case = |score: &&Value| {
                let all = score["quantities"].as_array()?;
                let of = all.iter().find(|of| of["name"] == quantity.key())?;
                let number = |key: &str| of[key].as_f64();
                let ends = |of: &Value| Some([of["low"].as_f64()?, of["high"].as_f64()?]);
                Some(Scored {
                    case: score["case"].as_str()?.to_owned(),
                    median: number("median")?,
                    truth: number("truth")?,
                    crps: number("crps")?,
                    intervals: of["intervals"].as_array()?.iter().filter_map(ends).collect(),
                })
            };
            let scored: Vec<Scored> = scores.iter().filter_map(of_case).collect();
            if !scored.is_empty() {
                let [in_50, _, in_90, _] = held_by_level(&scored.iter().collect::<Vec<_>>())?;
                let (quantity, n) = (quantity.label().to_owned(), scored.len());
                held_in_all.push(HeldIntervals { quantity, in_50, in_90, n, of: None });
            }
            for (names, part) in &parts {
                let scored: Vec<&Scored> =
                    scored.iter().filter(|of| names.contains(&of.case)).collect();
                if scored.is_empty() {
                    continue;
                }
                let counts = held_by_level(&scored)?;
                let n = scored.len();
                let labels = [name, "reconstruction", *part].map(str::to_owned);
                let cells = counts.map(|count| share(count, n));
                let cells = labels.into_iter().chain(cells).chain(errors(&scored, unit)?);
                rows.push(Row::new(&cells.collect::<Vec<_>>(), 3));
                if *part == "reported" {
                    let quantity = quantity.label().to_owned();
                    let [in_50, _, in_90, _] = counts;
                    held.push(HeldIntervals { quantity, in_50, in_90, n, of: None });
                }
            }
        }
        let subject = Measured::reconstruction_of(KnownEvidence::deserialize(word)?);
        found.push(Found { subject, tables: vec![rows], held, held_in_all });
    }
    Ok(found)
}

/// The cases whose finite-element run is not among those that the prior of restitution and friction was
/// fitted to, the training cases of `fea`.
fn names_of_other_runs(
    staged: &StagedCollisions,
    datasets: &Path,
) -> Result<Vec<String>, Box<dyn Error>> {
    let cases = cases(&datasets.join("fea"))?;
    let train = split(&cases, 0, TEST_SHARE).train;
    let fitted: Vec<String> = train.iter().map(|idx| format!("fea/{}", cases[*idx].name)).collect();
    let mut names = Vec::new();
    for name in staged.names() {
        let truth: toml::Table = toml::from_str(&fs::read_to_string(staged.truth_file(name))?)?;
        let run = truth["fea_case"].as_str().ok_or("no fea_case")?;
        if !fitted.iter().any(|of| of == run) {
            names.push(name.clone());
        }
    }
    Ok(names)
}

fn cases(path: &Path) -> Result<Vec<ForceCase>, Box<dyn Error>> {
    let mut go_on = |_| ControlFlow::Continue(());
    let dataset = Dataset::load(path, &mut go_on)?.complete().ok_or("cancelled")?;
    Ok(ForceCase::from_dataset(&dataset).0)
}

/// How many intervals of 50, 80, 90 and 95 % hold the truth.
fn held_by_level(scored: &[&Scored]) -> Result<[usize; 4], Box<dyn Error>> {
    if scored.iter().any(|of| of.intervals.len() != 4) {
        return Err("expected intervals of four levels".into());
    }
    let holds = |level: usize| {
        let held = |of: &&&Scored| {
            let [low, high] = of.intervals[level];
            (low..=high).contains(&of.truth)
        };
        scored.iter().filter(held).count()
    };
    Ok([0, 1, 2, 3].map(holds))
}

/// A share with its bounds of 95 % confidence, in per cent.
fn share(count: usize, n: usize) -> String {
    let [from, to] = wilson_interval(count, n).map(|end| 100.0 * end);
    format!("{:.0} ({from:.0}–{to:.0})", 100.0 * count as f64 / n as f64)
}

/// Median size of the error, bias, width of 90 % and CRPS.
fn errors(scored: &[&Scored], unit: f64) -> Result<[String; 4], Box<dyn Error>> {
    let median = |value: fn(&Scored) -> f64| -> Result<f64, Box<dyn Error>> {
        Ok(median(scored.iter().map(|of| unit * value(of))).ok_or("no cases")?)
    };
    let bias = median(|of| of.median - of.truth)?;
    let bias = format!("{}{:.1}", if bias < 0.0 { "−" } else { "+" }, bias.abs());
    let crps = scored.iter().map(|of| unit * of.crps).sum::<f64>() / scored.len() as f64;
    Ok([
        format!("{:.1}", median(|of| (of.median - of.truth).abs())?),
        bias,
        format!("{:.1}", median(|of| of.intervals[2][1] - of.intervals[2][0])?),
        format!("{crps:.2}"),
    ])
}
