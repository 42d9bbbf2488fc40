//! The parts of a figure: axes, elements, and the roles that define their colours.

use std::sync::Arc;

use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Language, Quantity, Unit, UnitSystem};

/// A plot: axes and elements, all numbers in the units of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Title in one line.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Whether both axes have the same scale, as a plan from above needs; false for time histories.
    pub equal_aspect: bool,
    /// Whether the vertical axis is logarithmic; every y must then be positive.
    pub log_y: bool,
    /// Elements in drawing order, from back to front.
    pub elements: Vec<FigureElement>,
    /// Places that the axes reach beside the elements, in their units: those of figures with which this one is
    /// compared.
    pub included: Vec<[f64; 2]>,
    /// What restricts the answer that is shown and what it rests on: in every picture and every table
    /// of the figure.
    pub caveats: Caveats,
    /// Language of its names and of what a picture says beside them.
    pub language: Language,
}

impl Figure {
    /// A figure with linear axes, of nothing that is restricted.
    pub fn new(title: impl Into<String>, [x, y]: [Axis; 2], elements: Vec<FigureElement>) -> Self {
        let (equal_aspect, log_y, caveats) = (false, false, Caveats::default());
        let (title, included, language) = (title.into(), Vec::new(), Language::default());
        Self { title, x, y, equal_aspect, log_y, elements, included, caveats, language }
    }

    /// The same as a plan from above, whose axes have the same scale.
    #[must_use]
    pub fn plan(self) -> Self {
        Self { equal_aspect: true, ..self }
    }

    /// The same with what restricts it.
    #[must_use]
    pub fn with_caveats(self, caveats: &Caveats) -> Self {
        Self { caveats: caveats.clone(), ..self }
    }
}

impl Figure {
    /// Draws what another variant of the case computes over this figure: the lines and outlines that are
    /// simulated or predicted, and the components of its force, with what restricts them.
    ///
    /// - `name`, `idx`: name of the variant and its number among the others, which gives its colour.
    pub fn overlay(&mut self, name: &str, idx: usize, other: &Self) {
        let is_computed = |role| {
            matches!(
                role,
                Role::Simulation | Role::Model | Role::Target | Role::ComponentX | Role::ComponentY
            )
        };
        let of_variant = |series: &Series| Series {
            name: format!("{}, {name}", series.name),
            role: Role::Variant(idx),
            style: if series.role == Role::ComponentY {
                LineStyle::Dotted
            } else {
                LineStyle::Dashed
            },
            points: series.points.clone(),
        };
        let overlaid = other.elements.iter().filter_map(|element| match element {
            FigureElement::Line(series) if is_computed(series.role) => {
                Some(FigureElement::Line(of_variant(series)))
            }
            FigureElement::Path(path) if is_computed(path.series.role) => {
                Some(FigureElement::Path(Path { series: of_variant(&path.series), ..path.clone() }))
            }
            FigureElement::Polygon(series) if is_computed(series.role) => {
                Some(FigureElement::Polygon(of_variant(series)))
            }
            _ => None,
        });
        self.elements.extend(overlaid);
        self.caveats.add_variant(name, &other.caveats);
    }
}

/// Label and unit of an axis, and the names at its ticks if it has any.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity that the axis shows.
    pub label: String,
    /// What the quantity acts on, which the title of a picture says: “the struck vehicle”.
    pub acts_on: Option<&'static str>,
    /// Unit of the numbers along the axis.
    pub unit: Unit,
    /// Names at the positions 0, 1, 2, … instead of numbers; empty for an axis of numbers.
    pub names: Vec<String>,
}

impl Axis {
    /// An axis of numbers in a given unit.
    pub fn new(label: impl Into<String>, unit: Unit) -> Self {
        Self { label: label.into(), acts_on: None, unit, names: Vec::new() }
    }

    /// An axis in the unit in which the system of units shows the quantity.
    pub fn shown(label: impl Into<String>, quantity: Quantity, units: UnitSystem) -> Self {
        Self::new(label, quantity.display_unit(units))
    }

    /// An axis with names at the positions 0, 1, 2, ….
    pub fn named(label: impl Into<String>, names: Vec<String>) -> Self {
        let unit = Quantity::Ratio.display_unit(UnitSystem::Si);
        Self { names, ..Self::new(label, unit) }
    }

    /// Adds what the quantity acts on.
    pub fn with_acts_on(self, acts_on: &'static str) -> Self {
        Self { acts_on: Some(acts_on), ..self }
    }

    /// The text beside the axis: “Label [unit]”, without the bracket for a unit that has no symbol.
    pub fn text(&self) -> String {
        with_unit(self.label.clone(), self.unit)
    }

    /// The name of its column in a table, which has no title beside it: “Label on … [unit]”.
    pub fn column(&self) -> String {
        let acts_on = self.acts_on.map(|whom| format!(" on {whom}"));
        with_unit(format!("{}{}", self.label, acts_on.unwrap_or_default()), self.unit)
    }
}

fn with_unit(label: String, unit: Unit) -> String {
    match unit.symbol {
        "" => label,
        symbol => format!("{label} [{symbol}]"),
    }
}

/// Meaning of an element's colour. The theme assigns a colour to each role.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Role {
    /// The 4DOF simulation.
    Simulation,
    /// The reference with which a result is compared, such as a recording.
    Reference,
    /// The struck vehicle.
    Target,
    /// The striking vehicle.
    Striking,
    /// The component of a vector along x.
    ComponentX,
    /// The component of a vector along y.
    ComponentY,
    /// The resultant of a vector.
    Resultant,
    /// A classic force pulse, or the 4DOF model beside a forecast.
    Pulse,
    /// A prediction of a network, or its loss on training cases.
    Model,
    /// The second of two kinds of cases or curves, such as validation cases beside training cases.
    Validation,
    /// The same quantity in another variant of the case; the number counts the variants.
    Variant(usize),
    /// A wheel on the left side of a vehicle.
    LeftWheel,
    /// A wheel on its right side.
    RightWheel,
    /// An element in the background: raw data behind filtered data, grid and help lines.
    Muted,
}

/// Style in which a line is drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LineStyle {
    /// A continuous line.
    #[default]
    Solid,
    /// A dashed line: a reference, or a computed curve beside a measured one.
    Dashed,
    /// A dotted line: an auxiliary line.
    Dotted,
}

/// A named sequence of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend; elements of the same name are shown and hidden together.
    pub name: String,
    /// Meaning of the colour.
    pub role: Role,
    /// Style of the line.
    pub style: LineStyle,
    /// Points [x, y] in the units of the axes.
    pub points: Vec<[f64; 2]>,
}

/// The path of a vehicle in a plan from above: where its CG is, when, and which way it points.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The line that is drawn; its points are those of the CG.
    pub series: Series,
    /// Time of each point, s.
    pub time_s: Vec<f64>,
    /// Heading at each point, rad, counter-clockwise from the x axis; empty if it is not known.
    pub yaw_rad: Vec<f64>,
}

/// A named area between two curves over x, in the units of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Name in the legend.
    pub name: String,
    /// Meaning of the colour.
    pub role: Role,
    /// Opacity of the fill, 0 to 1. Nested bands are drawn over each other.
    pub opacity: f32,
    /// Abscissae of both curves.
    pub x: Vec<f64>,
    /// Ordinates of the lower curve.
    pub low: Vec<f64>,
    /// Ordinates of the upper curve.
    pub high: Vec<f64>,
}

/// A probability density at the points of a grid, shown by the opacity of a single colour.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// Name in the legend.
    pub name: String,
    /// Meaning of the colour.
    pub role: Role,
    /// Point of the lowest x and y, in the units of the axes.
    pub low: [f64; 2],
    /// Distance between neighbouring points along x and y, in the units of the axes.
    pub step: [f64; 2],
    /// Number of points along x and y.
    pub size: [usize; 2],
    /// Density, 1/m² also where the axes have other units, row by row from the lowest y upwards, each row
    /// from the lowest x onwards. A cell of value zero is transparent.
    pub values: Arc<Vec<f64>>,
}

/// Values of cells over two axes, shown by a scale of colours. Cells of which the value is not to be
/// relied upon are hatched.
#[derive(Debug, Clone, PartialEq)]
pub struct CellMap {
    /// Name in the legend, in front of the scale.
    pub name: String,
    /// Ends of the cells along x and y, rising, in the units of the axes.
    pub edges: [Vec<f64>; 2],
    /// Values row by row from the lowest y upwards, each row from the lowest x onwards; `None` for a cell
    /// that has none.
    pub values: Vec<Option<f64>>,
    /// Whether each cell is hatched.
    pub is_hatched: Vec<bool>,
    /// Values at both ends of the scale.
    pub scale: [f64; 2],
    /// Unit of the values and of the scale.
    pub unit: Unit,
}

impl CellMap {
    /// Each cell: lowest and highest [x, y], its value, and whether it is hatched.
    pub fn cells(&self) -> impl Iterator<Item = ([[f64; 2]; 2], Option<f64>, bool)> + '_ {
        let [x, y] = &self.edges;
        let ends = |edges: &[f64], idx: usize| Some([*edges.get(idx)?, *edges.get(idx + 1)?]);
        let width = x.len().saturating_sub(1).max(1);
        self.values.iter().zip(&self.is_hatched).enumerate().filter_map(
            move |(idx, (value, is_hatched))| {
                let ([x0, x1], [y0, y1]) = (ends(x, idx % width)?, ends(y, idx / width)?);
                Some(([[x0, y0], [x1, y1]], *value, *is_hatched))
            },
        )
    }

    /// Where a value lies on the scale, 0 to 1.
    pub fn share(&self, value: f64) -> f64 {
        let [low, high] = self.scale;
        if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 }
    }
}

/// An element of a figure.
#[derive(Debug, Clone, PartialEq)]
pub enum FigureElement {
    /// Values on a grid, shown as a picture.
    HeatMap(HeatMap),
    /// Values of cells, shown by a scale of colours.
    CellMap(CellMap),
    /// A polyline.
    Line(Series),
    /// The path of a vehicle in a plan from above.
    Path(Path),
    /// Points that are not connected.
    Points(Series),
    /// A closed outline with a translucent fill.
    Polygon(Series),
    /// An arrow from the first point to the second.
    Arrow(Series),
    /// An area between two curves.
    Band(Band),
    /// A vertical line with a name.
    VerticalLine {
        /// Name in the legend.
        name: String,
        /// Meaning of the colour.
        role: Role,
        /// Position on the horizontal axis, in its unit.
        x: f64,
    },
}

impl FigureElement {
    /// A solid line through points.
    pub fn line(name: impl Into<String>, role: Role, points: Vec<[f64; 2]>) -> Self {
        Self::Line(Series { name: name.into(), role, style: LineStyle::Solid, points })
    }

    /// A dashed line through points.
    pub fn dashed(name: impl Into<String>, role: Role, points: Vec<[f64; 2]>) -> Self {
        Self::Line(Series { name: name.into(), role, style: LineStyle::Dashed, points })
    }

    /// Points that are not connected.
    pub fn points(name: impl Into<String>, role: Role, points: Vec<[f64; 2]>) -> Self {
        Self::Points(Series { name: name.into(), role, style: LineStyle::Solid, points })
    }

    /// A closed outline with a solid border.
    pub fn polygon(name: impl Into<String>, role: Role, points: Vec<[f64; 2]>) -> Self {
        Self::Polygon(Series { name: name.into(), role, style: LineStyle::Solid, points })
    }

    /// An arrow from one point to another.
    pub fn arrow(name: impl Into<String>, role: Role, from: [f64; 2], to: [f64; 2]) -> Self {
        let (name, points) = (name.into(), vec![from, to]);
        Self::Arrow(Series { name, role, style: LineStyle::Solid, points })
    }

    /// Name of the element in the legend.
    pub fn name(&self) -> &str {
        match self {
            Self::Line(series)
            | Self::Points(series)
            | Self::Polygon(series)
            | Self::Path(Path { series, .. })
            | Self::Arrow(series) => &series.name,
            Self::HeatMap(map) => &map.name,
            Self::CellMap(map) => &map.name,
            Self::Band(band) => &band.name,
            Self::VerticalLine { name, .. } => name,
        }
    }

    /// The same, to be replaced.
    pub(crate) fn name_mut(&mut self) -> &mut String {
        match self {
            Self::Line(series)
            | Self::Points(series)
            | Self::Polygon(series)
            | Self::Path(Path { series, .. })
            | Self::Arrow(series) => &mut series.name,
            Self::HeatMap(map) => &mut map.name,
            Self::CellMap(map) => &mut map.name,
            Self::Band(band) => &mut band.name,
            Self::VerticalLine { name, .. } => name,
        }
    }

    /// Meaning of the element's colour.
    pub fn role(&self) -> Role {
        match self {
            Self::Line(series)
            | Self::Points(series)
            | Self::Polygon(series)
            | Self::Path(Path { series, .. })
            | Self::Arrow(series) => series.role,
            Self::HeatMap(map) => map.role,
            Self::CellMap(_) => Role::Model,
            Self::Band(band) => band.role,
            Self::VerticalLine { role, .. } => *role,
        }
    }
}
