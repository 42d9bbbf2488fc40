//! Figures of a reconstruction: a quantity before and after the evidence, two quantities against each
//! other, and what further evidence would bring.

use rand::RngExt;
use rand_distr::StandardNormal;

use crate::figure::{Axis, Band, Figure, FigureElement, LineStyle, Role, Series};
use impactlab_core::numerics::random_stream;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_reconstruct::{
    BudgetItem, Posterior, QuantityEstimate, ReconstructedQuantity, ReconstructionTarget,
};
use impactlab_study::ReconstructAnswer;

/// Draws of the prior that stand behind the posterior.
const N_PRIOR: usize = 4000;
/// Classes of a histogram over its range.
const N_CLASSES: usize = 50;
/// Draws of the prior in a figure of two quantities.
const N_PAIRS: usize = 600;
/// Half the height of a bar, as a share of the distance between two.
const HALF_BAR: f64 = 0.32;

/// Values of a quantity before the evidence is looked at: draws of the prior.
pub fn prior_values(target: &ReconstructionTarget, quantity: ReconstructedQuantity) -> Vec<f64> {
    let model = target.model();
    let n = model.prior().components().len();
    let draw = |number: usize| -> Vec<f64> {
        let mut rng = random_stream(0, "prior of a reconstruction", number as u64);
        (0..n).map(|_| rng.sample(StandardNormal)).collect()
    };
    let z: Vec<Vec<f64>> = (0..N_PRIOR).map(draw).collect();
    Posterior::from_points(model, &z).values(quantity)
}

/// A quantity before and after the evidence, as densities, with the 90 % interval.
///
/// - `prior`: values of [`prior_values`].
pub fn marginal_figure(
    answer: &ReconstructAnswer,
    quantity: ReconstructedQuantity,
    prior: &[f64],
    caveats: &Caveats,
    units: UnitSystem,
) -> Figure {
    let label = quantity.label();
    let x = Axis::shown(label, quantity.quantity(), units);
    let y = Axis::shown("Probability density", Quantity::Ratio, units);
    let shown = |values: Vec<f64>| -> Vec<f64> {
        values.into_iter().map(|value| x.unit.from_si(value)).collect()
    };
    let posterior = shown(answer.posterior.values(quantity));
    let prior = shown(prior.to_vec());
    let range = range_of(&posterior, &prior);
    let mut elements = vec![
        FigureElement::Line(Series {
            name: "before the evidence".to_owned(),
            role: Role::Muted,
            style: LineStyle::Solid,
            points: frequency_polygon(&prior, range),
        }),
        FigureElement::Band(band("after it", &histogram(&posterior, range))),
    ];
    let estimate = answer.report.quantities.iter().find(|found| found.name == quantity.key());
    if let Some(QuantityEstimate { estimate, .. }) = estimate {
        let end = |i: usize| Some(("90 % interval", estimate.interval(0.9)?[i]));
        let lines = [end(0), Some(("median", estimate.median)), end(1)];
        for (name, value) in lines.into_iter().flatten() {
            let role = if name == "median" { Role::Model } else { Role::Muted };
            let name = name.to_owned();
            elements.push(FigureElement::VerticalLine { name, role, x: x.unit.from_si(value) });
        }
    }
    let title = format!("{}: {label}", answer.report.case);
    Figure::new(title, [x, y], elements).with_caveats(&caveats.in_units(units))
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

/// Densities of equal classes over a range, and the width of a class.
fn densities(values: &[f64], [low, high]: [f64; 2]) -> (Vec<f64>, f64) {
    let step = (high - low) / N_CLASSES as f64;
    let mut counts = vec![0_usize; N_CLASSES];
    for value in values {
        let class = ((value - low) / step).floor();
        if (0.0..=N_CLASSES as f64).contains(&class) {
            counts[(class as usize).min(N_CLASSES - 1)] += 1;
        }
    }
    let density = |count: usize| count as f64 / (values.len() as f64 * step);
    (counts.into_iter().map(density).collect(), step)
}

/// Densities as a line of steps.
fn histogram(values: &[f64], range: [f64; 2]) -> Vec<[f64; 2]> {
    let (densities, step) = densities(values, range);
    let steps = densities.iter().enumerate();
    steps
        .flat_map(|(i, density)| {
            let left = range[0] + step * i as f64;
            [[left, *density], [left + step, *density]]
        })
        .collect()
}

/// Densities as a line through the middles of the classes. Steps of less than a pixel would be drawn as
/// spots.
fn frequency_polygon(values: &[f64], range: [f64; 2]) -> Vec<[f64; 2]> {
    let (densities, step) = densities(values, range);
    let middles = densities.iter().enumerate();
    middles.map(|(i, density)| [range[0] + step * (i as f64 + 0.5), *density]).collect()
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

/// Two quantities of each particle against each other, over draws of the prior.
///
/// - `priors`: values of [`prior_values`] of both.
pub fn pair_figure(
    answer: &ReconstructAnswer,
    quantities: [ReconstructedQuantity; 2],
    priors: [&[f64]; 2],
    caveats: &Caveats,
    units: UnitSystem,
) -> Figure {
    let axes = quantities.map(|quantity| Axis::shown(quantity.label(), quantity.quantity(), units));
    let shown = |i: usize, values: &[f64]| -> Vec<f64> {
        values.iter().map(|value| axes[i].unit.from_si(*value)).collect()
    };
    let posterior: [Vec<f64>; 2] =
        [0, 1].map(|i| shown(i, &answer.posterior.values(quantities[i])));
    let prior: [Vec<f64>; 2] = [0, 1].map(|i| shown(i, priors[i]));
    let ranges = [0, 1].map(|i| range_of(&posterior[i], &prior[i]));
    let points = |[x, y]: &[Vec<f64>; 2]| -> Vec<[f64; 2]> {
        x.iter().zip(y).map(|(x, y)| [*x, *y]).collect()
    };
    let is_inside = |point: &[f64; 2]| {
        point.iter().zip(&ranges).all(|(value, [low, high])| (*low..=*high).contains(value))
    };
    let before = points(&prior).into_iter().filter(is_inside).take(N_PAIRS).collect();
    let elements = vec![
        FigureElement::points("before the evidence", Role::Muted, before),
        FigureElement::points("after it", Role::Model, points(&posterior)),
    ];
    let [first, second] = quantities.map(ReconstructedQuantity::label);
    let title = format!("{}: {second} over {first}", answer.report.case);
    Figure::new(title, axes, elements).with_caveats(&caveats.in_units(units))
}

/// How much narrower the speed of the struck or single car would be with each further measurement: a bar for half
/// the width of its 90 % interval then, and a line for the same now.
pub fn budget_figure(answer: &ReconstructAnswer, caveats: &Caveats, units: UnitSystem) -> Figure {
    let label = match answer.report.kind.is_collision() {
        true => "± speed of the struck car, 90 %",
        false => "± speed of the car, 90 %",
    };
    let x = Axis::shown(label, Quantity::Speed, units);
    let believable = answer.report.budget.iter().filter(|item| item.believable);
    let mut items: Vec<_> = believable.collect();
    items.sort_by(|a, b| b.then_m_s.total_cmp(&a.then_m_s));
    let name = |item: &&BudgetItem| item.shown(units);
    let y = Axis::named("", items.iter().map(name).collect());
    let bar = |(row, item): (usize, &&BudgetItem)| {
        let (end, middle) = (x.unit.from_si(item.then_m_s), row as f64);
        let [low, high] = [middle - HALF_BAR, middle + HALF_BAR];
        let corners = vec![[0.0, low], [end, low], [end, high], [0.0, high]];
        FigureElement::polygon("with the measurement", Role::Model, corners)
    };
    let mut elements: Vec<FigureElement> = items.iter().enumerate().map(bar).collect();
    if let Some(item) = items.first() {
        let (name, role) = ("now".to_owned(), Role::Reference);
        elements.push(FigureElement::VerticalLine { name, role, x: x.unit.from_si(item.now_m_s) });
    }
    let title = format!("{}: what further evidence would bring", answer.report.case);
    Figure::new(title, [x, y], elements).with_caveats(&caveats.in_units(units))
}
