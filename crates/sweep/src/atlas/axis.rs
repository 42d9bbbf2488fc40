//! The axes of an atlas: which inputs of a sweep its cells are laid out over, and where a cell ends.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::atlas::AtlasError;
use impactlab_core::data::TomlFile;
use impactlab_core::units::{NumberFormat, Quantity, Unit, UnitSystem, significant, trimmed};

/// Most bins of an axis, and most letters of a name or label.
const MAX_BINS: usize = 1000;
const MAX_LETTERS: usize = 200;

/// A value lies in the outermost bins up to this share of the axis beyond their ends: the limits of a
/// plan and the edges of an axis are converted from other units, each with its rounding.
const END_TOLERANCE: f64 = 1e-9;

/// An axis: intervals of a number, or the values of a choice.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Column of the rows, such as `target_speed_m_s`.
    pub name: String,
    /// The same on the command line, such as `speed`.
    pub word: String,
    /// The same for a person.
    pub label: String,
    /// SI unit of the column; `1` if it has none.
    pub unit: String,
    /// Ends of the intervals, rising, in SI units; empty for a choice.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edges: Vec<f64>,
    /// What the values 0, 1, 2, … of a choice mean; empty for a number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<String>,
}

/// Why an axis is none.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AxisError {
    /// Neither or both of edges and labels.
    #[error("expected either edges or labels")]
    Kind,
    /// Too few or too many bins.
    #[error("it has {n_bins} bins, expected 1 to {MAX_BINS}")]
    Bins {
        /// Bins.
        n_bins: usize,
    },
    /// Edges that do not rise.
    #[error("the edges do not rise, or one is not finite")]
    Edges,
    /// A unit that nothing is measured in.
    #[error("{unit:?} is no unit")]
    Unit {
        /// The unit.
        unit: String,
    },
    /// A label by which two values could be meant.
    #[error("label {label:?} is there twice, or is the number of another one")]
    Label {
        /// The label.
        label: String,
    },
    /// A name or label without or with too many letters.
    #[error("a name or label has {n} letters, expected 1 to {MAX_LETTERS}")]
    Text {
        /// Letters.
        n: usize,
    },
}

/// An axis as a file says it: its edges in any unit of the quantity.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct AxisFile {
    axis: Vec<Axis>,
}

impl Axis {
    /// The axes of the shipped atlas of the PIT manoeuvre.
    ///
    /// # Errors
    /// As [`Axis::from_toml`]; a test reads them.
    pub fn pit() -> Result<Vec<Self>, AtlasError> {
        let text = include_str!("../../../../assets/atlas/axes.toml");
        Self::from_toml(text, Path::new("assets/atlas/axes.toml"))
    }

    /// Reads a file of axes.
    ///
    /// # Errors
    /// As [`Axis::from_toml`].
    pub fn read_all(path: &Path) -> Result<Vec<Self>, AtlasError> {
        Self::from_toml(&TomlFile::read(path)?, path)
    }

    /// The axes that a text says. Its edges may be in any unit of their quantity; they become SI units.
    ///
    /// # Errors
    /// [`AtlasError::Axes`], [`AtlasError::Axis`], [`AtlasError::SameAxis`],
    /// [`AtlasError::NoAxes`].
    pub fn from_toml(text: &str, path: &Path) -> Result<Vec<Self>, AtlasError> {
        let file: AxisFile = TomlFile { path, text }.to()?;
        let axes = file.axis.into_iter().map(Self::in_si).collect::<Result<Vec<_>, _>>()?;
        check_all(&axes)?;
        Ok(axes)
    }

    /// The same with its edges in SI units.
    fn in_si(self) -> Result<Self, AtlasError> {
        let Some(unit) = unit_of(&self.unit) else {
            let source = AxisError::Unit { unit: self.unit };
            return Err(AtlasError::Axis { name: self.name, source });
        };
        let edges = self.edges.iter().map(|edge| unit.to_si(*edge)).collect();
        let si = unit.quantity.si_unit().symbol;
        let unit = if si.is_empty() { "1" } else { si }.to_owned();
        Ok(Self { unit, edges, ..self })
    }

    /// Number of bins.
    pub fn n_bins(&self) -> usize {
        if self.is_choice() { self.labels.len() } else { self.edges.len().saturating_sub(1) }
    }

    /// Whether its values are those of a choice.
    pub fn is_choice(&self) -> bool {
        !self.labels.is_empty()
    }

    /// What is measured along it.
    pub fn quantity(&self) -> Quantity {
        Quantity::from_si_symbol(&self.unit).unwrap_or(Quantity::Ratio)
    }

    /// The bin in which a value lies; `None` outside of all.
    ///
    /// - `value_si`: in the unit of the axis; of a choice the number of its label.
    pub fn locate(&self, value_si: f64) -> Option<usize> {
        if !value_si.is_finite() {
            return None;
        }
        if self.is_choice() {
            let is_whole = value_si >= 0.0 && value_si.fract() == 0.0;
            return Some(value_si as usize).filter(|at| is_whole && *at < self.labels.len());
        }
        let (first, last) = (*self.edges.first()?, *self.edges.last()?);
        let beyond = END_TOLERANCE * (last - first);
        if value_si < first - beyond || value_si > last + beyond {
            return None;
        }
        let n_below = self.edges.partition_point(|edge| *edge <= value_si);
        Some(n_below.saturating_sub(1).min(self.n_bins().saturating_sub(1)))
    }

    /// The ends of a bin, in the unit of the axis; of a choice half a step around its number.
    pub fn ends(&self, bin: usize) -> Option<[f64; 2]> {
        if self.is_choice() {
            return (bin < self.labels.len()).then_some([bin as f64 - 0.5, bin as f64 + 0.5]);
        }
        Some([*self.edges.get(bin)?, *self.edges.get(bin + 1)?])
    }

    /// A bin for a person: `56 to 68 km/h`, `with ESC`.
    pub fn bin_text(&self, bin: usize, units: UnitSystem) -> String {
        if let Some(label) = self.labels.get(bin) {
            return label.clone();
        }
        let Some(ends) = self.ends(bin) else { return String::new() };
        let unit = self.quantity().display_unit(units);
        let [low, high] = ends.map(|end| trimmed(significant(unit.from_si(end))));
        NumberFormat::english(units).with_unit(&format!("{low} to {high}"), unit.symbol)
    }

    /// Whether the axis is one.
    ///
    /// # Errors
    /// [`AxisError`].
    pub fn check(&self) -> Result<(), AxisError> {
        if self.edges.is_empty() == self.labels.is_empty() {
            return Err(AxisError::Kind);
        }
        let n_bins = self.n_bins();
        if !(1..=MAX_BINS).contains(&n_bins) {
            return Err(AxisError::Bins { n_bins });
        }
        let rises = |pair: &[f64]| matches!(pair, [low, high] if low < high);
        let is_finite = self.edges.iter().all(|edge| edge.is_finite());
        if !is_finite || !self.edges.windows(2).all(rises) {
            return Err(AxisError::Edges);
        }
        if self.unit != "1" && Quantity::from_si_symbol(&self.unit).is_none() {
            return Err(AxisError::Unit { unit: self.unit.clone() });
        }
        for text in [&self.name, &self.word, &self.label].into_iter().chain(&self.labels) {
            let n = text.chars().count();
            if !(1..=MAX_LETTERS).contains(&n) {
                return Err(AxisError::Text { n });
            }
        }
        match self.ambiguous_label() {
            Some(label) => Err(AxisError::Label { label: label.clone() }),
            None => Ok(()),
        }
    }

    /// A label that names two values: small and large letters are the same, and a value is named by its number,
    /// too.
    fn ambiguous_label(&self) -> Option<&String> {
        let lower: Vec<String> = self.labels.iter().map(|label| label.to_lowercase()).collect();
        let is_other = |bin: usize, label: &String| {
            let is_there = lower.iter().take(bin).any(|earlier| earlier == label);
            let number = label.trim().parse::<usize>();
            is_there || number.is_ok_and(|number| number != bin && number < lower.len())
        };
        let found = lower.iter().enumerate().position(|(bin, label)| is_other(bin, label));
        found.and_then(|bin| self.labels.get(bin))
    }
}

/// Checks every axis, and that no name stands twice.
///
/// # Errors
/// [`AtlasError::NoAxes`], [`AtlasError::Axis`], [`AtlasError::SameAxis`].
pub(super) fn check_all(axes: &[Axis]) -> Result<(), AtlasError> {
    if axes.is_empty() {
        return Err(AtlasError::NoAxes);
    }
    for (idx, axis) in axes.iter().enumerate() {
        let wrong = |source| AtlasError::Axis { name: axis.name.clone(), source };
        axis.check().map_err(wrong)?;
        let names = |other: &Axis| [other.name.clone(), other.word.clone()];
        let mut earlier = axes.iter().take(idx).flat_map(names);
        if earlier.any(|name| name == axis.name || name == axis.word) {
            return Err(AtlasError::SameAxis { name: axis.name.clone() });
        }
    }
    Ok(())
}

/// A unit by its symbol; that of a ratio is `1`.
fn unit_of(symbol: &str) -> Option<Unit> {
    if symbol == "1" {
        return Some(Quantity::Ratio.si_unit());
    }
    let mut all = Quantity::ALL.iter().flat_map(|quantity| quantity.units());
    all.find(|unit| unit.symbol == symbol && !symbol.is_empty()).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speed() -> Axis {
        let text = "[[axis]]\nname = \"speed_m_s\"\nword = \"speed\"\nlabel = \"Speed\"\n\
                    unit = \"mph\"\nedges = [35, 50, 70]\n";
        Axis::from_toml(text, Path::new("axes.toml")).unwrap().remove(0)
    }

    #[test]
    fn edges_become_si_units_and_the_ends_belong_to_the_axis() {
        let axis = speed();
        assert_eq!((axis.n_bins(), axis.unit.as_str()), (2, "m/s"));
        let mph = |speed: f64| axis.locate(speed * 0.447_04);
        assert_eq!([35.0, 49.9, 50.0, 70.0].map(mph), [Some(0), Some(0), Some(1), Some(1)]);
        assert_eq!([34.9, 70.1, f64::NAN, f64::INFINITY].map(mph), [None; 4]);
        assert_eq!(axis.bin_text(0, UnitSystem::Us), "35 to 50 mph");
    }

    #[test]
    fn a_choice_is_located_by_its_number() {
        let labels = vec!["without".to_owned(), "with".to_owned()];
        let axis = Axis { edges: Vec::new(), labels, unit: "1".to_owned(), ..speed() };
        let expected = [Some(0), Some(1), None, None, None];
        assert_eq!([0.0, 1.0, 2.0, 0.5, -1.0].map(|value| axis.locate(value)), expected);
        assert_eq!(axis.bin_text(1, UnitSystem::Si), "with");
    }

    /// `--set esc=1` was the value of number 0, as that had the label 1.
    #[test]
    fn a_label_names_one_value() {
        let check = |labels: [&str; 2]| {
            let labels = labels.map(str::to_owned).to_vec();
            Axis { edges: Vec::new(), labels, unit: "1".to_owned(), ..speed() }.check()
        };
        assert_eq!(check(["0", "with"]), Ok(()));
        assert_eq!(check(["2018", "2019"]), Ok(()));
        for (labels, label) in [(["1", "0"], "1"), (["With", "with"], "with")] {
            assert_eq!(check(labels), Err(AxisError::Label { label: label.to_owned() }));
        }
    }

    #[test]
    fn an_axis_that_is_none_is_refused() {
        let edges = |edges: &[f64]| Axis { edges: edges.to_vec(), ..speed() }.check();
        assert_eq!(edges(&[]), Err(AxisError::Kind));
        assert_eq!(edges(&[1.0]), Err(AxisError::Bins { n_bins: 0 }));
        assert_eq!(edges(&[1.0, 1.0]), Err(AxisError::Edges));
        assert_eq!(edges(&[1.0, f64::NAN]), Err(AxisError::Edges));
        assert!(edges(&[0.0; 2000]).is_err());
        let unit = Axis { unit: "mph".to_owned(), ..speed() };
        assert_eq!(unit.check(), Err(AxisError::Unit { unit: "mph".to_owned() }));
        assert!(matches!(check_all(&[speed(), speed()]), Err(AtlasError::SameAxis { .. })));
    }

    /// “says no axes: TOML parse error at line 2, column 1 | 2 | edgez = [1, 2]” was the message.
    #[test]
    fn what_a_file_of_axes_has_wrong_is_told_by_its_place() {
        let said =
            |text: &str| Axis::from_toml(text, Path::new("axes.toml")).unwrap_err().to_string();
        let unknown = said("[[axis]]\nedgez = [1, 2]\n");
        assert!(unknown.starts_with("axes.toml:2:1: unknown field `edgez`"), "{unknown}");
        let open = said("[[axis]]\nedges = [1, 2\n");
        assert!(open.starts_with("axes.toml:2:"), "{open}");
    }

    #[test]
    fn the_axes_of_the_shipped_atlas_are_axes() {
        let axes = Axis::pit().unwrap();
        let n_cells: usize = axes.iter().map(Axis::n_bins).product();
        // Few rows are in a cell by itself; maps average over most axes.
        assert!((10_000..=40_000).contains(&n_cells), "{n_cells}");
    }
}
