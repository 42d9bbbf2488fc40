//! Figures that compare motion models: rankings by error, distributions of errors, errors by
//! horizon, and the predictions of one case.

use crate::figure::scene::vehicle_outline;
use crate::figure::{Axis, Figure, FigureElement, LineStyle, Role, Series};
use impactlab_core::collision::Pose;
use impactlab_core::compare::HORIZONS_S;
use impactlab_core::numerics::quantile_of_sorted;
use impactlab_core::units::{Quantity, Unit, UnitSystem};
use impactlab_networks::response::evaluate::{ComparedModel, Comparison, MeanStd, MotionModelKind};

/// Half the height of a box and of a median tick, as shares of the height of a row.
const BOX_HALF: f64 = 0.28;
const TICK_HALF: f64 = 0.22;

/// Name of a model followed by the number of trajectories that it was fine-tuned on, if any.
pub fn model_name(name: &str, trajectories: usize) -> String {
    if trajectories == 0 { name.to_owned() } else { format!("{name}, {trajectories}") }
}

/// Role that defines the colour of a kind of model.
fn role(kind: MotionModelKind) -> Role {
    match kind {
        MotionModelKind::Untuned => Role::Pulse,
        MotionModelKind::Tuned => Role::Target,
        MotionModelKind::Plain => Role::Validation,
        MotionModelKind::Network => Role::Model,
    }
}

/// A figure with one row for each model, the first model at the top.
///
/// - `elements`: elements of a model, given the y coordinate of its row.
fn rows_figure<'a>(
    title: String,
    x: Axis,
    models: impl DoubleEndedIterator<Item = &'a ComparedModel> + Clone,
    elements: impl Fn(&ComparedModel, f64) -> Vec<FigureElement>,
) -> Figure {
    let from_below = models.rev();
    let names = from_below.clone().map(|model| model_name(&model.name, model.trajectories));
    let y = Axis::named("", names.collect());
    let of_row = |(row, model): (usize, &'a ComparedModel)| elements(model, row as f64);
    let elements = from_below.enumerate().flat_map(of_row).collect();
    Figure::new(title, [x, y], elements)
}

/// A vertical line at x through the row, which extends by `half` to either side.
fn vertical(name: &str, role: Role, x: f64, row: f64, half: f64) -> FigureElement {
    FigureElement::line(name, role, vec![[x, row - half], [x, row + half]])
}

/// Ranking of the models by an error metric, smallest mean first: mean (point), mean ± standard
/// deviation (bar, cut at zero) and median (tick). A model whose mean or standard deviation is not
/// finite has an empty row.
///
/// - `unit`: unit of the metric and of the axis.
/// - `of`: the metric of a model.
pub fn ranking_figure(
    comparison: &Comparison,
    title: &str,
    label: &str,
    unit: Unit,
    statistic: impl Fn(&ComparedModel) -> MeanStd,
) -> Figure {
    let mut models: Vec<&ComparedModel> = comparison.models.iter().collect();
    models.sort_by(|a, b| statistic(a).mean.total_cmp(&statistic(b).mean));
    let elements = |model: &ComparedModel, row: f64| {
        let MeanStd { mean, std, median } = statistic(model);
        if !(mean.is_finite() && std.is_finite()) {
            return Vec::new();
        }
        let (role, name) = (role(model.kind), model_name(&model.name, model.trajectories));
        let [low, high] = [(mean - std).max(0.0), mean + std];
        vec![
            FigureElement::line(&name, role, vec![[low, row], [high, row]]),
            vertical(&name, role, median, row, TICK_HALF),
            FigureElement::points(&name, role, vec![[mean, row]]),
        ]
    };
    rows_figure(title.to_owned(), Axis::new(label, unit), models.into_iter(), elements)
}

/// Box plot of the average error over the cases of a cluster, for each model: the box extends from
/// the lower to the upper quartile with a line at the median, the whiskers to the smallest and the
/// largest error. Models fine-tuned on different choices of trajectories are pooled.
///
/// - `cluster`: index of the cluster.
pub fn cluster_figure(comparison: &Comparison, cluster: usize, units: UnitSystem) -> Figure {
    let unit = Quantity::Length.display_unit(units);
    let elements = |model: &ComparedModel, row: f64| {
        let of_model = comparison.cases.iter().filter(|case| {
            case.cluster == cluster
                && case.kind == model.kind
                && case.trajectories == model.trajectories
        });
        let mut errors: Vec<f64> =
            of_model.map(|case| unit.from_si(case.metrics.error.average_error_m)).collect();
        errors.sort_by(f64::total_cmp);
        let quantile = |share| quantile_of_sorted(&errors, share).filter(|value| value.is_finite());
        let quantiles = [0.0, 0.25, 0.5, 0.75, 1.0].map(quantile);
        let [Some(least), Some(low), Some(median), Some(high), Some(most)] = quantiles else {
            return Vec::new();
        };
        let (role, name) = (role(model.kind), model_name(&model.name, model.trajectories));
        let (below, above) = (row - BOX_HALF, row + BOX_HALF);
        let outline = vec![[low, below], [high, below], [high, above], [low, above]];
        vec![
            FigureElement::line(&name, role, vec![[least, row], [low, row]]),
            FigureElement::line(&name, role, vec![[high, row], [most, row]]),
            FigureElement::polygon(&name, role, outline),
            vertical(&name, role, median, row, BOX_HALF),
        ]
    };
    let title = match comparison.clusters.get(cluster) {
        Some(row) => {
            let impulse = row.impulse_n_s.map_or(String::new(), |impulse| {
                format!(", about {}", Quantity::Impulse.shown(impulse, units))
            });
            format!("{}: {} cases{impulse}", row.name, row.n)
        }
        None => String::new(),
    };
    let x = Axis::new("Average error", unit);
    rows_figure(title, x, comparison.models.iter(), elements)
}

/// Mean position error of each model at the horizons [`HORIZONS_S`]. Lines of models that were
/// fine-tuned on fewer trajectories than others are dashed.
pub fn horizon_figure(comparison: &Comparison, units: UnitSystem) -> Figure {
    let x = Axis::shown("Time since the impact", Quantity::Time, units);
    let y = Axis::shown("Distance, mean", Quantity::Length, units);
    let line = |model: &ComparedModel| {
        let points = HORIZONS_S.iter().zip(&model.metrics.horizon_error_m);
        let points: Vec<[f64; 2]> = points
            .filter(|(_, error)| error.mean.is_finite())
            .map(|(time_s, error)| [*time_s, y.unit.from_si(error.mean)])
            .collect();
        FigureElement::Line(Series {
            name: model_name(&model.name, model.trajectories),
            role: role(model.kind),
            style: style(comparison, model.trajectories),
            points,
        })
    };
    let elements = comparison.models.iter().map(line).collect();
    let title = "Error by horizon".to_owned();
    Figure::new(title, [x, y], elements)
}

/// Dashed for a model that was fine-tuned on fewer trajectories than others, else solid.
fn style(comparison: &Comparison, trajectories: usize) -> LineStyle {
    let most = comparison.models.iter().map(|model| model.trajectories).max().unwrap_or(0);
    if trajectories == 0 || trajectories == most { LineStyle::Solid } else { LineStyle::Dashed }
}

/// Recorded path of a test case and the path that each model predicts, with vehicle outlines at the
/// end. `None` if the comparison has no such case.
///
/// - `name`: name of the case.
/// - `choice`: seed of the choice of fine-tuning trajectories whose models are shown.
pub fn compared_case_figure(
    comparison: &Comparison,
    name: &str,
    choice: u64,
    units: UnitSystem,
) -> Option<Figure> {
    let case = comparison.test.iter().find(|case| case.name == name)?;
    let x = Axis::shown("X, along the road", Quantity::Length, units);
    let y = Axis::shown("Y, to the left", Quantity::Length, units);
    let curve = |name: &str, role, style, path: &[[f64; 3]]| -> Vec<FigureElement> {
        let points = path.iter().map(|[px, py, _]| [x.unit.from_si(*px), x.unit.from_si(*py)]);
        let line = Series { name: name.to_owned(), role, style, points: points.collect() };
        let end = path.last().map(|&[x_m, y_m, yaw_rad]| Pose { x_m, y_m, yaw_rad });
        let outline =
            end.map(|pose| vehicle_outline(name, role, style, &case.footprint, &pose, x.unit));
        std::iter::once(FigureElement::Line(line)).chain(outline.into_iter().flatten()).collect()
    };
    let mut elements = Vec::new();
    for model in comparison.cases.iter().filter(|model| model.case == name) {
        // A model that was not fine-tuned does not depend on the choice.
        if model.trajectories > 0 && model.choice != choice {
            continue;
        }
        let style = style(comparison, model.trajectories);
        let name = model_name(&model.model, model.trajectories);
        elements.extend(curve(&name, role(model.kind), style, &model.path));
    }
    elements.extend(curve("recorded", Role::Reference, LineStyle::Solid, &case.path));
    let title = format!("{name}, {}", if case.spins { "spins" } else { "does not spin" });
    Some(Figure::new(title, [x, y], elements).plan())
}
