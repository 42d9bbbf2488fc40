//! Figure of a predicted force over time: bands, mean curve, drawn curves, and curves for
//! comparison.

use serde::{Deserialize, Serialize};

use crate::figure::{Axis, Band, Figure, FigureElement, LineStyle, Role, Series, milliseconds};
use impactlab_core::collision::PulseShape;
use impactlab_core::uncertainty::{Caveats, CurveBand, ForceCurve};
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_study::analysis::ForceForecast;

/// Opacity of the widest and of the narrowest band; the opacities of the others lie between at even
/// steps.
const OPACITY: [f32; 2] = [0.13, 0.28];
/// Share of its largest value above which a curve counts as non-zero for the time axis.
const SHOWN_SHARE: f64 = 0.03;
/// The end of the time axis is a multiple of this, s, so that the axis does not change with every
/// small change of the scenario.
const END_STEP_S: f64 = 0.025;

/// Component of a force that a figure shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ForceComponent {
    /// The component along x.
    X,
    /// The component along y.
    Y,
    /// The magnitude.
    Magnitude,
}

/// Data that the figure of a predicted force shows.
#[derive(Debug, Clone, Copy)]
pub struct ForecastFigure<'a> {
    /// Name of the scenario, for the title.
    pub name: &'a str,
    /// Prediction with bands, mean and drawn curves.
    pub forecast: &'a ForceForecast,
    /// Levels whose bands are shown, each 0 to 1; others are left out.
    pub levels: &'a [f64],
    /// The recorded force.
    pub recorded: Option<RecordedCurve<'a>>,
    /// Force curve of the physics and regressions, which the network corrects: its centre.
    pub physics: Option<&'a ForceCurve>,
    /// Classic pulses with their shapes.
    pub pulses: &'a [(PulseShape, ForceCurve)],
    /// System of units of the axes.
    pub units: UnitSystem,
    /// What restricts the prediction.
    pub caveats: &'a Caveats,
}

/// A recorded force beside a predicted one.
#[derive(Debug, Clone, Copy)]
pub struct RecordedCurve<'a> {
    /// Name in the legend.
    pub name: &'a str,
    /// The force, which is zero where nothing was recorded.
    pub curve: &'a ForceCurve,
    /// Time of the last sample, s, of a record that ends during the contact: the curve is drawn up to
    /// there. `None` for a force that has come to zero.
    pub cut_at_s: Option<f64>,
}

impl ForceComponent {
    /// All components.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Magnitude];

    /// Name of the component in a legend.
    pub fn label(self) -> &'static str {
        match self {
            Self::X => "F_x",
            Self::Y => "F_y",
            Self::Magnitude => "|F|",
        }
    }

    /// Values of the component in a force curve, N.
    pub fn values_n(self, curve: &ForceCurve) -> Vec<f64> {
        match self {
            Self::X => curve.fx_n.clone(),
            Self::Y => curve.fy_n.clone(),
            Self::Magnitude => curve.magnitude_n(),
        }
    }

    /// Bands of the component in a prediction.
    fn bands(self, forecast: &ForceForecast) -> &[CurveBand] {
        match self {
            Self::X => &forecast.bands.fx,
            Self::Y => &forecast.bands.fy,
            Self::Magnitude => &forecast.bands.magnitude,
        }
    }

    /// Role that defines the colour of the component.
    fn role(self) -> Role {
        match self {
            Self::X => Role::ComponentX,
            Self::Y => Role::ComponentY,
            // The recorded curve has the colour of the resultant, so that the bands need another
            // one.
            Self::Magnitude => Role::Target,
        }
    }
}

/// One component of a predicted force over time in ms.
pub fn forecast_figure(component: ForceComponent, input: &ForecastFigure<'_>) -> Figure {
    let x = Axis::new("Time", milliseconds());
    let y = Axis::shown(component.label(), Quantity::Force, input.units)
        .with_acts_on("the struck vehicle");
    let n_shown =
        (shown_until_s(input) / impactlab_core::uncertainty::CURVE_INTERVAL_S).round() as usize;
    let time: Vec<f64> =
        input.forecast.mean.time_s().iter().take(n_shown).map(|t| x.unit.from_si(*t)).collect();
    let shown = |values: &[f64]| -> Vec<f64> {
        values.iter().take(n_shown).map(|value| y.unit.from_si(*value)).collect()
    };
    let points = |curve: &ForceCurve| -> Vec<[f64; 2]> {
        let values = shown(&component.values_n(curve));
        let times = curve.time_s().into_iter().map(|t| x.unit.from_si(t));
        times.zip(values).map(|(t, value)| [t, value]).collect()
    };
    let mut bands: Vec<&CurveBand> = component
        .bands(input.forecast)
        .iter()
        .filter(|b| input.levels.contains(&b.level))
        .collect();
    bands.sort_by(|a, b| b.level.total_cmp(&a.level));
    let steps = bands.len().saturating_sub(1).max(1) as f32;
    let mut elements: Vec<FigureElement> = Vec::new();
    for (rank, band) in bands.into_iter().enumerate() {
        let [widest, narrowest] = OPACITY;
        elements.push(FigureElement::Band(Band {
            name: format!("{:.0} %", band.level * 100.0),
            role: component.role(),
            opacity: widest + (narrowest - widest) * rank as f32 / steps,
            x: time.clone(),
            low: shown(&band.lower_n),
            high: shown(&band.upper_n),
        }));
    }
    for curve in &input.forecast.curves {
        elements.push(FigureElement::line("drawn curves", Role::Muted, points(curve)));
    }
    for (shape, curve) in input.pulses {
        let (name, role, points) = (shape.label().to_owned(), Role::Pulse, points(curve));
        elements.push(FigureElement::Line(Series {
            name,
            role,
            style: pulse_style(*shape),
            points,
        }));
    }
    if let Some(physics) = input.physics {
        elements.push(FigureElement::dashed("centre alone", Role::Reference, points(physics)));
    }
    let mean = points(&input.forecast.mean);
    elements.push(FigureElement::line("mean", component.role(), mean));
    if let Some(RecordedCurve { name, curve, cut_at_s }) = input.recorded {
        let mut points = points(curve);
        let name = match cut_at_s.map(|at_s| x.unit.from_si(at_s)) {
            Some(cut_at) => {
                points.retain(|[at, _]| *at <= cut_at);
                format!("{name}, cut at {cut_at:.1} ms")
            }
            None => name.to_owned(),
        };
        elements.push(FigureElement::line(name, Role::Reference, points));
    }
    let title = format!("{}: predicted {} on the struck vehicle", input.name, component.label());
    Figure::new(title, [x, y], elements).with_caveats(&input.caveats.in_units(input.units))
}

/// Line style of a pulse shape.
fn pulse_style(shape: PulseShape) -> LineStyle {
    match shape {
        PulseShape::HalfSine => LineStyle::Solid,
        PulseShape::Haversine => LineStyle::Dashed,
        PulseShape::Triangle | PulseShape::Square => LineStyle::Dotted,
    }
}

/// End of the time axis, s, the same for all components. It lies after the last time at which the
/// magnitude of a recorded force, a pulse or the widest band is above [`SHOWN_SHARE`] of its
/// maximum.
fn shown_until_s(input: &ForecastFigure<'_>) -> f64 {
    let widest = input.forecast.bands.magnitude.iter().max_by(|a, b| a.level.total_cmp(&b.level));
    let pulses = input.pulses.iter().map(|(_, curve)| curve);
    let curves = input.recorded.iter().map(|recorded| recorded.curve).chain(pulses);
    let magnitudes = curves.map(ForceCurve::magnitude_n);
    let rows = magnitudes.chain(widest.map(|band| band.upper_n.clone()));
    let last = rows.map(|row| {
        let largest = row.iter().copied().fold(0.0, f64::max);
        row.iter().rposition(|value| *value > SHOWN_SHARE * largest).unwrap_or(0)
    });
    let end_s = last.max().unwrap_or(0) as f64 * impactlab_core::uncertainty::CURVE_INTERVAL_S;
    let grid_s =
        input.forecast.mean.n_instants() as f64 * impactlab_core::uncertainty::CURVE_INTERVAL_S;
    (((end_s / END_STEP_S).floor() + 1.0) * END_STEP_S).min(grid_s)
}
