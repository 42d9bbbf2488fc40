//! Tables of facts as plain data, and as text.

use std::path::PathBuf;

use impactlab_core::numerics::share_standard_error;
use impactlab_core::units::{Estimate, IntervalText, Quantity};

use crate::facts::{FactWriter, Term};

/// The value of a fact.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A word of this table.
    Term(Term),
    /// A label of the program, which a report translates.
    Phrase(String),
    /// A name, which a report translates if it is one of the program.
    Name(String),
    /// A text that stays as it is.
    Text(String),
    /// A text that the program has in English only.
    English(String),
    /// A file.
    File(PathBuf),
    /// A count.
    Count(usize),
    /// A count out of a number.
    CountOf(usize, usize),
    /// A share of 1, written in per cent.
    Share(f64),
    /// A probability, with its standard error where it comes from draws. It is never written as
    /// certain.
    Chance(f64, Option<f64>),
    /// A share of a number of draws.
    ShareOfDraws(f64, usize),
    /// A probability that may be small: three decimals, and never written as nothing.
    Probability(f64),
    /// An upper bound of a probability: that of 1 bounds nothing, and is no certainty.
    ProbabilityBound(f64),
    /// A pure number with a fixed number of decimals.
    Fixed(f64, usize),
    /// A number without an interval, SI units.
    Number(Quantity, f64),
    /// The same with a fixed number of decimals.
    Decimals(Quantity, f64, usize),
    /// The same without zeros at the end of its decimals.
    Rounded(Quantity, f64),
    /// A number of draws that has no interval, SI units, see
    /// [`NumberFormat`](impactlab_core::units::NumberFormat).
    Rough(Quantity, f64),
    /// The same of the components of a vector.
    RoughVector(Quantity, [f64; 2], [&'static str; 2]),
    /// A number that was given, SI units: written with all its digits.
    Given(Quantity, f64),
    /// A standard deviation, SI units.
    Sigma(Quantity, f64),
    /// A number with its standard deviation, SI units.
    Measured(Quantity, f64, f64),
    /// The same of what is added, with its sign.
    Change(Quantity, f64, f64),
    /// A median with its intervals, SI units.
    Estimate(Quantity, Estimate),
    /// Components of a vector, SI units, with their names.
    Vector(Quantity, [f64; 2], [&'static str; 2]),
    /// A place, SI units, to a tenth of the unit that is shown.
    Place([f64; 2]),
    /// A place that is drawn, or compared with such a one, SI units: two significant digits, but whole units.
    RoughPlace([f64; 2]),
    /// An area that holds a place with a probability, m²: two significant digits.
    Area(f64),
    /// An hour of the clock.
    Clock(u8),
    /// Values one after the other, with a text between them.
    Joined(Vec<Value>, &'static str),
}

/// A row of a table of facts.
#[derive(Debug, Clone, PartialEq)]
pub struct Fact {
    /// What it is.
    pub name: Value,
    /// What is known of it, a value for each column.
    pub values: Vec<Value>,
    /// Whether the row is one to be looked at before the answer is used.
    pub is_warning: bool,
}

/// A table of facts: a name and its values in each row.
#[derive(Debug, Clone, PartialEq)]
pub struct FactTable {
    /// What the table is about.
    pub title: Value,
    /// What the rows are.
    pub rows: Value,
    /// Names of the columns of values.
    pub columns: Vec<Value>,
    /// Probabilities of the intervals that are shown, ascending.
    pub levels: &'static [f64],
    /// The facts.
    pub facts: Vec<Fact>,
}

/// A table of facts as text. Every row has as many cells as the header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextTable {
    /// What the table is about.
    pub title: String,
    /// Titles of the columns; all empty where the rows speak for themselves.
    pub header: Vec<String>,
    /// What the columns mean, where their titles do not say it.
    pub header_hints: Vec<Option<&'static str>>,
    /// The rows.
    pub rows: Vec<TextRow>,
}

/// A row of a [`TextTable`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextRow {
    /// The cells.
    pub cells: Vec<String>,
    /// What the row means, where its name does not say it.
    pub hint: Option<&'static str>,
    /// Whether it is one to be looked at before the answer is used.
    pub is_warning: bool,
}

/// Levels of the intervals of a predicted quantity.
pub(super) const PREDICTED: &[f64] = &[0.5, 0.9];

/// Levels of the intervals of a reconstructed quantity.
pub(super) const RECONSTRUCTED: &[f64] = &[0.5, 0.9, 0.95];

impl Fact {
    /// A fact with one value.
    pub(super) fn new(term: Term, value: Value) -> Self {
        Self::row(Value::Term(term), vec![value])
    }

    /// A fact that is a text in English.
    pub fn text(term: Term, text: impl Into<String>) -> Self {
        Self::new(term, Value::English(text.into()))
    }

    /// A fact with a value for each column of its table.
    pub(super) fn row(name: Value, values: Vec<Value>) -> Self {
        Self { name, values, is_warning: false }
    }

    /// A number without an interval.
    pub(super) fn number(term: Term, quantity: Quantity, value_si: f64) -> Self {
        Self::new(term, Value::Number(quantity, value_si))
    }

    /// A number of a distribution without an interval.
    pub(super) fn rough(term: Term, quantity: Quantity, value_si: f64) -> Self {
        Self::new(term, Value::Rough(quantity, value_si))
    }

    /// A number of draws with its intervals, where they can be told.
    pub(super) fn drawn(term: Term, quantity: Quantity, estimate: &Estimate) -> Self {
        Self::new(term, Value::drawn(quantity, estimate))
    }

    /// A number with its intervals.
    pub(super) fn estimate(term: Term, quantity: Quantity, estimate: &Estimate) -> Self {
        Self::new(term, Value::Estimate(quantity, estimate.clone()))
    }

    /// A vector of something that has no interval.
    pub(super) fn rough_vector(term: Term, quantity: Quantity, components_si: [f64; 2]) -> Self {
        Self::new(term, Value::RoughVector(quantity, components_si, ["x", "y"]))
    }

    /// A vector.
    pub(super) fn vector(term: Term, quantity: Quantity, components_si: [f64; 2]) -> Self {
        Self::new(term, Value::Vector(quantity, components_si, ["x", "y"]))
    }
}

impl From<Term> for Value {
    fn from(term: Term) -> Self {
        Self::Term(term)
    }
}

impl Value {
    /// Values with their names, one after the other.
    pub(super) fn named<'a>(values: impl IntoIterator<Item = (&'a str, Self)>) -> Self {
        let named = |(name, value): (&str, Self)| {
            Self::Joined(vec![Self::Phrase(name.to_owned()), value], " ")
        };
        Self::Joined(values.into_iter().map(named).collect(), ", ")
    }

    /// What it means, where it is a word that does not say it.
    fn hint(&self) -> Option<&'static str> {
        match self {
            Self::Term(term) => term.hint(),
            _ => None,
        }
    }

    /// A median of draws with its intervals; rough where these cannot be told.
    pub(super) fn drawn(quantity: Quantity, estimate: &Estimate) -> Self {
        match estimate.has_interval() {
            true => Self::Estimate(quantity, estimate.clone()),
            false => Self::Rough(quantity, estimate.median),
        }
    }

    /// A probability by the share of some draws, with its standard error; of a single draw, which has none,
    /// what it did.
    pub(super) fn chance_of_draws(share: f64, n_draws: usize) -> Self {
        match n_draws {
            1 => Self::ShareOfDraws(share, n_draws),
            n => Self::Chance(share, Some(share_standard_error(share, n as f64))),
        }
    }

    /// From one number to another.
    pub(super) fn span([from, to]: [Self; 2]) -> Self {
        Self::Joined(vec![from, to], " – ")
    }
}

impl FactTable {
    /// A table with one column of values that have no intervals.
    pub(super) fn new(title: impl Into<Value>, facts: Vec<Fact>) -> Self {
        let (rows, columns) = (Term::Quantity.into(), vec![Term::Value.into()]);
        Self { title: title.into(), rows, columns, levels: &[], facts }
    }

    /// A table of texts that the program has in English only, one a row; none without any.
    pub(super) fn lines(title: impl Into<Value>, texts: &[String]) -> Option<Self> {
        let row = |text: &String| Fact::row(Value::English(text.clone()), Vec::new());
        let table = Self::new(title, texts.iter().map(row).collect());
        table.with_columns(&[]).unless_empty()
    }

    /// A table of names and values that are texts already.
    pub fn from_texts<'a>(
        title: Term,
        texts: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Self {
        let text = |text: &str| Value::Text(text.to_owned());
        let row = |(name, value)| Fact::row(text(name), vec![text(value)]);
        Self::new(title, texts.into_iter().map(row).collect())
    }

    /// The same with another name for what the rows are.
    #[must_use]
    pub(super) fn with_rows(self, rows: Term) -> Self {
        Self { rows: rows.into(), ..self }
    }

    /// The same with intervals.
    #[must_use]
    pub(super) fn with_levels(self, levels: &'static [f64]) -> Self {
        Self { levels, ..self.with_columns(&[Term::Median]) }
    }

    /// The same with other columns.
    #[must_use]
    pub(super) fn with_columns(self, columns: &[Term]) -> Self {
        Self { columns: columns.iter().copied().map(Value::Term).collect(), ..self }
    }

    /// The table, unless it is empty.
    pub(super) fn unless_empty(self) -> Option<Self> {
        (!self.facts.is_empty()).then_some(self)
    }

    /// Whether a column holds intervals.
    fn has_intervals(&self, column: usize) -> bool {
        let value = |fact: &Fact| match fact.values.get(column) {
            Some(Value::Estimate(_, estimate)) => !estimate.intervals.is_empty(),
            _ => false,
        };
        !self.levels.is_empty() && self.facts.iter().any(value)
    }

    /// The table as text.
    pub fn to_text(&self, writer: &FactWriter<'_>) -> TextTable {
        let (mut header, mut header_hints) =
            (vec![writer.value(&self.rows)], vec![self.rows.hint()]);
        for (idx, column) in self.columns.iter().enumerate() {
            header.push(writer.value(column));
            header_hints.push(column.hint());
            for level in self.levels.iter().filter(|_| self.has_intervals(idx)) {
                header.push(format!("{:.0} %", 100.0 * level));
                header_hints.push(interval_hint(*level));
            }
        }
        let row = |fact: &Fact| {
            let mut cells = vec![writer.value(&fact.name)];
            for (idx, value) in fact.values.iter().enumerate() {
                match value {
                    Value::Estimate(quantity, estimate) if self.has_intervals(idx) => {
                        cells.extend(self.estimate_cells(*quantity, estimate, writer));
                    }
                    value => {
                        cells.push(writer.value(value));
                        let n_empty = if self.has_intervals(idx) { self.levels.len() } else { 0 };
                        cells.extend(std::iter::repeat_n(String::new(), n_empty));
                    }
                }
            }
            TextRow { cells, hint: fact.name.hint(), is_warning: fact.is_warning }
        };
        let rows = self.facts.iter().map(row).collect();
        TextTable { title: writer.value(&self.title), header, header_hints, rows }
    }

    /// Name and interval of each fact that has an interval of a level.
    pub fn intervals(&self, level: f64, writer: &FactWriter<'_>) -> Vec<(String, IntervalText)> {
        let interval = |fact: &Fact| {
            let Some(Value::Estimate(quantity, estimate)) = fact.values.first() else {
                return None;
            };
            let text = writer.format.estimate(*quantity, estimate);
            Some((writer.value(&fact.name), text.at(level)?.clone()))
        };
        self.facts.iter().filter_map(interval).collect()
    }

    /// The value of a fact as text, with its interval of 90 % in brackets if it has one; none if the
    /// table has no such fact.
    pub fn value_text(&self, term: Term, writer: &FactWriter<'_>) -> Option<String> {
        let fact = self.facts.iter().find(|fact| fact.name == Value::Term(term))?;
        fact.values.first().map(|value| writer.value(value))
    }

    /// Median and intervals at the levels of the table.
    fn estimate_cells(
        &self,
        quantity: Quantity,
        estimate: &Estimate,
        writer: &FactWriter<'_>,
    ) -> Vec<String> {
        let text = writer.format.estimate(quantity, estimate);
        let range = |level: &f64| text.at(*level).map_or_else(String::new, |of| of.range.clone());
        std::iter::once(text.median.clone()).chain(self.levels.iter().map(range)).collect()
    }
}

/// What an interval of a level holds.
fn interval_hint(level: f64) -> Option<&'static str> {
    match level {
        0.5 => Some("Interval that holds half of what may happen"),
        0.9 => Some("Interval that holds nine tenths of what may happen"),
        0.95 => Some("Interval that leaves out one case of twenty"),
        _ => None,
    }
}

impl TextTable {
    /// Whether each row is a name and a value, which needs no titles.
    pub fn is_list(&self) -> bool {
        self.header.len() <= 2
    }

    /// The table in Markdown.
    pub(super) fn to_markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | ").replace('\n', " "));
        let rule: String = (1..self.header.len()).map(|_| " ---: |").collect();
        let rows: String = self.rows.iter().map(|row| line(&row.cells)).collect();
        format!("**{}**\n\n{}| --- |{rule}\n{rows}", self.title, line(&self.header))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::UnitSystem;

    #[test]
    fn a_row_has_a_cell_for_each_title_whether_it_has_intervals_or_not() {
        let estimate = Estimate::new(32.209, [30.11, 34.52], [26.789, 37.193]);
        let facts = vec![
            Fact::estimate(Term::EndX, Quantity::Length, &estimate),
            Fact::new(Term::Region90, Value::Area(90.7)),
        ];
        let table = FactTable::new(Term::Forecast, facts).with_levels(PREDICTED);
        let text = table.to_text(&FactWriter::english(UnitSystem::Si));
        assert_eq!(text.header, ["quantity", "median", "50 %", "90 %"]);
        assert_eq!(text.rows[0].cells, ["X at the end", "32 m", "30 to 35 m", "26 to 38 m"]);
        assert_eq!(text.rows[1].cells[1..], ["91 m²", "", ""]);
        assert_eq!(text.rows[0].hint, Some("Of the CG, along the road from the impact"));
    }
}
