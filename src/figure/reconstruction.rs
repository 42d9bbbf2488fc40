//! Figures of a reconstruction: the paths of its particles over the evidence, a quantity before and after
//! the evidence, and what further evidence would bring.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_distr::StandardNormal;
use rayon::prelude::*;

use crate::collision::{Footprint, Pose};
use crate::figure::scene::vehicle_outline;
use crate::figure::{Axis, Band, Figure, FigureElement, LineStyle, Path, Role, Series};
use crate::nn::random_stream;
use crate::reconstruct::evidence::{Evidence, RestPose};
use crate::reconstruct::{
    BudgetItem, QuantityEstimate, ReconstructedQuantity, ReconstructionTarget,
};
use crate::study::{ReconstructAnswer, Trust};
use crate::units::{Quantity, UnitSystem};
use crate::vehicle::{Path as VehiclePath, PathPoint};

/// Paths that are drawn.
const N_PATHS: usize = 40;
/// Draws of the prior that stand behind the posterior.
const N_PRIOR: usize = 4000;
/// Classes of a histogram over its range.
const N_CLASSES: usize = 50;
/// Points of an ellipse.
const N_ELLIPSE: usize = 48;
/// Half axis of an ellipse that holds 90 % of a plane normal distribution, standard deviations.
const NINETY: f64 = 2.1460;

/// Motions that go with the evidence, to be drawn.
#[derive(Debug, Clone)]
pub struct ReconstructedPaths {
    /// Paths of the struck car, some of the particles.
    pub drawn: Vec<VehiclePath>,
    /// Path of the particle whose speed of the struck car is nearest to the median.
    pub median: Option<VehiclePath>,
    footprint: Footprint,
}

impl ReconstructedPaths {
    /// Simulates paths of an answer's particles.
    pub fn of(answer: &ReconstructAnswer) -> Self {
        let (target, z) = (&answer.target, &answer.particles.z);
        let every = z.len().div_ceil(N_PATHS).max(1);
        let mut chosen: Vec<Vec<f64>> = z.iter().step_by(every).cloned().collect();
        let speeds = answer.posterior.of_quantity(ReconstructedQuantity::TargetSpeed);
        let named = |of: &&QuantityEstimate| of.name == ReconstructedQuantity::TargetSpeed.key();
        let median = answer.report.quantities.iter().find(named).map(|of| of.median);
        let nearest = median.and_then(|median| {
            let off = |speed: &f64| (speed - median).abs();
            let nearest = speeds.iter().enumerate().min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
            z.get(nearest?.0)
        });
        chosen.extend(nearest.cloned());
        let mut drawn = target.model().motions(&chosen, |motion| motion.path);
        let median = if nearest.is_some() { drawn.pop() } else { None };
        let footprint = Footprint::from(&target.model().cars().struck.parameters.geometry);
        Self { drawn, median, footprint }
    }
}

/// The paths of the struck car from above, over what was found.
pub fn reconstruction_scene_figure(
    (answer, paths): (&ReconstructAnswer, &ReconstructedPaths),
    trust: &Trust,
    units: UnitSystem,
) -> Figure {
    let x = Axis::shown("X, along the heading before the impact", Quantity::Length, units);
    let y = Axis::shown("Y, to the left", Quantity::Length, units);
    let shown = |[px, py]: [f64; 2]| [x.unit.from_si(px), y.unit.from_si(py)];
    let path = |(name, role): (&str, Role), path: &VehiclePath| {
        let of = |point: &PathPoint| shown([point.x_m, point.y_m]);
        FigureElement::Path(Path {
            series: Series {
                name: name.to_owned(),
                role,
                style: LineStyle::Solid,
                points: path.points.iter().map(of).collect(),
            },
            time_s: path.points.iter().map(|point| point.time_s).collect(),
            yaw_rad: path.points.iter().map(|point| point.yaw_rad).collect(),
        })
    };
    let drawn = paths.drawn.iter().map(|of| path(("particles", Role::Muted), of));
    let mut elements: Vec<FigureElement> = drawn.collect();
    let evidence = answer.target.evidence();
    elements.extend(evidence_elements(evidence, &paths.footprint, &shown, units));
    if let Some(median) = &paths.median {
        elements.push(path(("a particle of median speed", Role::Model), median));
        if let Some(last) = median.points.last() {
            let pose = Pose { x_m: last.x_m, y_m: last.y_m, yaw_rad: last.yaw_rad };
            let named = ("a particle of median speed", Role::Model, LineStyle::Solid);
            elements.extend(vehicle_outline(named, (&paths.footprint, &pose), x.unit));
        }
    }
    let title = format!("{}: where the struck car went", answer.report.case);
    Figure::new(title, [x, y], elements).plan().with_trust(trust)
}

/// What was found: marks, positions, the rest pose with its 90 % ellipse.
fn evidence_elements(
    evidence: &Evidence,
    footprint: &Footprint,
    shown: &impl Fn([f64; 2]) -> [f64; 2],
    units: UnitSystem,
) -> Vec<FigureElement> {
    let mut elements = Vec::new();
    for mark in &evidence.marks {
        let points: Vec<[f64; 2]> = mark.points_m.iter().map(|at| shown(*at)).collect();
        elements.push(FigureElement::dashed("tyre marks", Role::Bullet, points.clone()));
        elements.push(FigureElement::points("tyre marks", Role::Bullet, points));
    }
    let positions: Vec<[f64; 2]> =
        evidence.positions.iter().map(|at| shown([at.x_m, at.y_m])).collect();
    if !positions.is_empty() {
        elements.push(FigureElement::points("video", Role::Pulse, positions));
    }
    if let Some(rest) = &evidence.rest {
        let ellipse = (0..=N_ELLIPSE).map(|i| {
            let (sin, cos) = (TAU * i as f64 / N_ELLIPSE as f64).sin_cos();
            let radius = NINETY * rest.position_sigma_m;
            shown([rest.x_m + radius * cos, rest.y_m + radius * sin])
        });
        let name = "found at rest, with its 90 % ellipse";
        elements.push(FigureElement::line(name, Role::Reference, ellipse.collect()));
        if let Some(pose) = pose_of(rest) {
            let unit = Quantity::Length.display_unit(units);
            let named = (name, Role::Reference, LineStyle::Dashed);
            elements.extend(vehicle_outline(named, (footprint, &pose), unit));
        }
    }
    elements
}

/// The pose at rest, where the heading is known.
fn pose_of(rest: &RestPose) -> Option<Pose> {
    let heading = rest.heading_rad?;
    Some(Pose { x_m: rest.x_m, y_m: rest.y_m, yaw_rad: heading.value })
}

/// Values of a quantity before the evidence is looked at: draws of the prior.
pub fn prior_values(target: &ReconstructionTarget, quantity: ReconstructedQuantity) -> Vec<f64> {
    let model = target.model();
    let n = model.prior().components().len();
    let value = |number: usize| {
        let mut rng = random_stream(0, "prior of a reconstruction", number as u64);
        let z: Vec<f64> = (0..n).map(|_| rng.sample(StandardNormal)).collect();
        let values = model.prior().values(&z);
        quantity.of(&values, &model.impact(&values))
    };
    (0..N_PRIOR).into_par_iter().map(value).collect()
}

/// A quantity before and after the evidence, as densities, with the 90 % interval.
///
/// - `prior`: values of [`prior_values`].
pub fn marginal_figure(
    answer: &ReconstructAnswer,
    (quantity, prior): (ReconstructedQuantity, &[f64]),
    trust: &Trust,
    units: UnitSystem,
) -> Figure {
    let label = quantity.label();
    let x = Axis::shown(label, quantity.quantity(), units);
    let y = Axis::shown("Probability density", Quantity::Ratio, units);
    let shown = |values: Vec<f64>| -> Vec<f64> {
        values.into_iter().map(|value| x.unit.from_si(value)).collect()
    };
    let posterior = shown(answer.posterior.of_quantity(quantity));
    let prior = shown(prior.to_vec());
    let range = range_of(&posterior, &prior);
    let mut elements = vec![
        FigureElement::Line(Series {
            name: "before the evidence".to_owned(),
            role: Role::Muted,
            style: LineStyle::Solid,
            points: histogram(&prior, range),
        }),
        FigureElement::Band(band("after it", &histogram(&posterior, range))),
    ];
    let estimate = answer.report.quantities.iter().find(|of| of.name == quantity.key());
    if let Some(QuantityEstimate { median, interval_90: [low, high], .. }) = estimate {
        for (name, value) in [("90 % interval", low), ("median", median), ("90 % interval", high)] {
            let role = if name == "median" { Role::Model } else { Role::Muted };
            let name = name.to_owned();
            elements.push(FigureElement::VerticalLine { name, role, x: x.unit.from_si(*value) });
        }
    }
    let title = format!("{}: {label}", answer.report.case);
    Figure::new(title, [x, y], elements).with_trust(trust)
}

/// Ends of the axis: all of the posterior, and of the prior what lies within three of its widths.
fn range_of(posterior: &[f64], prior: &[f64]) -> [f64; 2] {
    let ends = |values: &[f64]| {
        let finite = values.iter().copied().filter(|value| value.is_finite());
        finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
    };
    let [low, high] = ends(posterior);
    let [prior_low, prior_high] = ends(prior);
    let width = (high - low).max(1e-6 * high.abs()).max(1e-9);
    let room = |from: f64, to: f64| from.max(to - 1.5 * width);
    [room(prior_low, low).min(low), -room(-prior_high, -high).min(-high)]
}

/// Densities as a line of steps.
fn histogram(values: &[f64], [low, high]: [f64; 2]) -> Vec<[f64; 2]> {
    let step = (high - low) / N_CLASSES as f64;
    let mut counts = vec![0_usize; N_CLASSES];
    for value in values {
        let class = ((value - low) / step).floor();
        if (0.0..=N_CLASSES as f64).contains(&class) {
            counts[(class as usize).min(N_CLASSES - 1)] += 1;
        }
    }
    let density = |count: usize| count as f64 / (values.len() as f64 * step);
    let steps = counts.iter().enumerate();
    steps
        .flat_map(|(i, count)| {
            let left = low + step * i as f64;
            [[left, density(*count)], [left + step, density(*count)]]
        })
        .collect()
}

fn band(name: &str, line: &[[f64; 2]]) -> Band {
    Band {
        name: name.to_owned(),
        role: Role::Model,
        opacity: 0.45,
        x: line.iter().map(|[x, _]| *x).collect(),
        low: vec![0.0; line.len()],
        high: line.iter().map(|[_, y]| *y).collect(),
    }
}

/// How much narrower the speed of the struck car would be with each further measurement: half the width
/// of its 90 % interval now (right) and then (left end).
pub fn budget_figure(answer: &ReconstructAnswer, trust: &Trust, units: UnitSystem) -> Figure {
    let x = Axis::shown("± speed of the struck car, 90 %", Quantity::Speed, units);
    let believable = answer.report.budget.iter().filter(|item| item.believable);
    let mut items: Vec<_> = believable.collect();
    items.sort_by(|a, b| b.then_m_s.total_cmp(&a.then_m_s));
    let name = |item: &&BudgetItem| format!("{} ± {}", item.known, item.sigma);
    let y = Axis::named("", items.iter().map(name).collect());
    let rows = items.iter().enumerate().flat_map(|(row, item)| {
        let [then, now] = [item.then_m_s, item.now_m_s].map(|m_s| x.unit.from_si(m_s));
        let row = row as f64;
        [
            FigureElement::line("would narrow to", Role::Model, vec![[then, row], [now, row]]),
            FigureElement::points("would narrow to", Role::Model, vec![[then, row]]),
            FigureElement::points("now", Role::Reference, vec![[now, row]]),
        ]
    });
    let elements = rows.collect();
    let title = format!("{}: what further evidence would bring", answer.report.case);
    Figure::new(title, [x, y], elements).with_trust(trust)
}
