//! The parts of a figure.

use std::sync::Arc;

use crate::units::{Quantity, Unit, UnitSystem};

/// A plot: axes and what stands in them, all numbers already in the units of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What it shows, in a line.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Whether a metre is as long upwards as sideways: plans, not time histories.
    pub equal_aspect: bool,
    /// Whether the vertical axis is logarithmic: every y is positive then.
    pub log_y: bool,
    /// From back to front.
    pub elements: Vec<FigureElement>,
}

/// Name and unit of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What runs along it.
    pub label: String,
    /// Its unit.
    pub unit: Unit,
    /// What stands at 0, 1, 2 and so on instead of numbers; none on an axis of numbers.
    pub names: Vec<String>,
}

impl Axis {
    /// An axis of numbers in a unit.
    pub fn new(label: impl Into<String>, unit: Unit) -> Self {
        Self { label: label.into(), unit, names: Vec::new() }
    }

    /// An axis in the unit in which the quantity is shown.
    pub fn shown(label: impl Into<String>, quantity: Quantity, units: UnitSystem) -> Self {
        Self::new(label, quantity.display_unit(units))
    }

    /// An axis of names at 0, 1, 2 and so on.
    pub fn named(label: impl Into<String>, names: Vec<String>) -> Self {
        let unit = Quantity::Ratio.display_unit(UnitSystem::Si);
        Self { names, ..Self::new(label, unit) }
    }

    /// “Label [unit]”.
    pub fn text(&self) -> String {
        match self.unit.symbol {
            "" => self.label.clone(),
            symbol => format!("{} [{symbol}]", self.label),
        }
    }
}

/// What a colour stands for; the theme knows the colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Role {
    /// The 4DOF simulation.
    Simulation,
    /// What it is compared with.
    Reference,
    /// The struck vehicle.
    Target,
    /// The striking vehicle.
    Bullet,
    /// A component along x.
    ComponentX,
    /// A component along y.
    ComponentY,
    /// A resultant.
    Resultant,
    /// A classic pulse.
    Pulse,
    /// What a network says, or does while it learns.
    Model,
    /// The same on what it has not learned from.
    Validation,
    /// What stands back: raw data behind filtered, the road.
    Muted,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LineStyle {
    /// Full.
    #[default]
    Solid,
    /// Dashed: a reference, or a computed curve beside a measured one.
    Dashed,
    /// Dotted: a help line.
    Dotted,
}

/// A named row of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// As in the legend; several elements of one name are switched together.
    pub name: String,
    /// Meaning of the colour.
    pub role: Role,
    /// How it is drawn.
    pub style: LineStyle,
    /// Points in the axes' units.
    pub points: Vec<[f64; 2]>,
}

/// A named area between two curves over x.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// As in the legend.
    pub name: String,
    /// Meaning of the colour.
    pub role: Role,
    /// How much of the ground it hides, 0 to 1: nested bands add up.
    pub opacity: f32,
    /// Abscissae.
    pub x: Vec<f64>,
    /// Lower edge.
    pub low: Vec<f64>,
    /// Upper edge.
    pub high: Vec<f64>,
}

/// Values at the points of a grid, shown by how much they hide the ground.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// As in the legend.
    pub name: String,
    /// Meaning of the colour.
    pub role: Role,
    /// First point, in the axes' units.
    pub low: [f64; 2],
    /// Between neighbouring points.
    pub step: [f64; 2],
    /// Points along x and y.
    pub size: [usize; 2],
    /// Row by row from the lowest y on, each from the lowest x on; zero is not seen.
    pub values: Arc<Vec<f64>>,
}

/// Something in a figure.
#[derive(Debug, Clone, PartialEq)]
pub enum FigureElement {
    /// Values on a grid.
    HeatMap(HeatMap),
    /// A polyline.
    Line(Series),
    /// Points without a line.
    Points(Series),
    /// A closed outline, filled lightly.
    Polygon(Series),
    /// An arrow from the first point to the second.
    Arrow(Series),
    /// An area between two curves.
    Band(Band),
    /// A vertical line at x with a word beside it.
    VerticalLine {
        /// As in the legend.
        name: String,
        /// Meaning of the colour.
        role: Role,
        /// Where.
        x: f64,
    },
}

impl FigureElement {
    /// A full line.
    pub fn line(name: impl Into<String>, role: Role, points: Vec<[f64; 2]>) -> Self {
        Self::Line(Series { name: name.into(), role, style: LineStyle::Solid, points })
    }

    /// A dashed line.
    pub fn dashed(name: impl Into<String>, role: Role, points: Vec<[f64; 2]>) -> Self {
        Self::Line(Series { name: name.into(), role, style: LineStyle::Dashed, points })
    }

    /// Points without a line.
    pub fn points(name: impl Into<String>, role: Role, points: Vec<[f64; 2]>) -> Self {
        Self::Points(Series { name: name.into(), role, style: LineStyle::Solid, points })
    }

    /// A closed outline.
    pub fn polygon(name: impl Into<String>, role: Role, points: Vec<[f64; 2]>) -> Self {
        Self::Polygon(Series { name: name.into(), role, style: LineStyle::Solid, points })
    }

    /// An arrow.
    pub fn arrow(name: impl Into<String>, role: Role, from: [f64; 2], to: [f64; 2]) -> Self {
        let (name, points) = (name.into(), vec![from, to]);
        Self::Arrow(Series { name, role, style: LineStyle::Solid, points })
    }

    /// Its name in the legend.
    pub fn name(&self) -> &str {
        match self {
            Self::Line(series)
            | Self::Points(series)
            | Self::Polygon(series)
            | Self::Arrow(series) => &series.name,
            Self::HeatMap(map) => &map.name,
            Self::Band(band) => &band.name,
            Self::VerticalLine { name, .. } => name,
        }
    }

    /// Meaning of its colour.
    pub fn role(&self) -> Role {
        match self {
            Self::Line(series)
            | Self::Points(series)
            | Self::Polygon(series)
            | Self::Arrow(series) => series.role,
            Self::HeatMap(map) => map.role,
            Self::Band(band) => band.role,
            Self::VerticalLine { role, .. } => *role,
        }
    }
}
