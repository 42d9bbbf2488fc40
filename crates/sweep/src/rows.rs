//! A table of rows as it stands in a file.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::row::Row;
use crate::{Plan, SweptQuestion};
use impactlab_core::numerics::sha256_hex;

/// Rows of a sweep, in columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// The varied inputs.
    pub inputs: Vec<Column>,
    /// The outcomes; NaN where one does not apply and where the row failed.
    pub outcomes: Vec<Column>,
    /// Numbers of the rows.
    pub index: Vec<u64>,
    /// Of each row what restricts its answer, as [`Row::caveats`] has it; `None` of a pit, whose outcomes say it,
    /// and in tables of programs that did not keep it.
    pub caveats: Option<Vec<String>>,
    /// Why a row failed; empty if it did not.
    pub reasons: Vec<String>,
    /// Where the rows come from.
    pub meta: RowsMeta,
}

/// A column of numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its SI unit; "1" for a pure number.
    pub unit: String,
    /// A number for each row.
    pub values: Vec<f64>,
}

/// Where rows come from.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RowsMeta {
    /// SHA-256 of the plan, hexadecimal.
    pub plan_sha256: String,
    /// Version of the program that answered.
    pub program: String,
    /// Number of the chunk; `None` for all chunks together.
    pub chunk: Option<u64>,
    /// Digests of the networks that answered.
    pub networks: BTreeMap<String, String>,
}

impl Rows {
    /// Rows of a plan as a table.
    ///
    /// - `chunk`: of which they are.
    pub fn new(plan: &Plan, chunk: u64, rows: &[Row]) -> Self {
        let outcomes = plan.outcomes();
        let input = |idx: usize| rows.iter().map(|row| number(&row.inputs, idx)).collect();
        let outcome = |idx: usize| {
            let of = |row: &Row| row.outcomes.as_ref().map_or(f64::NAN, |it| number(it, idx));
            rows.iter().map(of).collect()
        };
        let inputs = plan.vary.iter().enumerate().map(|(idx, vary)| Column {
            name: vary.name.clone(),
            unit: vary.unit.clone(),
            values: input(idx),
        });
        let outcomes = outcomes.into_iter().enumerate();
        let outcomes =
            outcomes.map(|(idx, (name, unit))| Column { name, unit, values: outcome(idx) });
        let caveats = match plan.question {
            SweptQuestion::Pit(_) => None,
            SweptQuestion::Request(_) => Some(rows.iter().map(|row| row.caveats.clone()).collect()),
        };
        let reason = |row: &Row| row.outcomes.as_ref().err().cloned().unwrap_or_default();
        Self {
            inputs: inputs.collect(),
            outcomes: outcomes.collect(),
            index: rows.iter().map(|row| row.index).collect(),
            caveats,
            reasons: rows.iter().map(reason).collect(),
            meta: RowsMeta {
                plan_sha256: plan.sha256(),
                program: plan.program.clone(),
                chunk: Some(chunk),
                networks: plan.networks.clone(),
            },
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.index.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.index.is_empty()
    }

    /// Number of rows that failed.
    pub fn n_failed(&self) -> usize {
        self.reasons.iter().filter(|reason| !reason.is_empty()).count()
    }

    /// A column by its name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns().find(|column| column.name == name)
    }

    /// SHA-256 of some of the rows, and of the names and units of their columns, hexadecimal.
    ///
    /// - `places`: of the rows in the table.
    pub(crate) fn sha256(&self, places: Range<usize>) -> String {
        let mut bytes = (self.inputs.len() as u64).to_le_bytes().to_vec();
        let mut text = |text: &str| {
            bytes.extend((text.len() as u64).to_le_bytes());
            bytes.extend(text.as_bytes());
        };
        self.columns().for_each(|column| {
            text(&column.name);
            text(&column.unit);
        });
        for texts in self.caveats.iter().chain([&self.reasons]) {
            texts.get(places.clone()).unwrap_or_default().iter().for_each(|it| text(it));
        }
        let index = self.index.get(places.clone()).unwrap_or_default();
        bytes.extend(index.iter().flat_map(|row| row.to_le_bytes()));
        for column in self.columns() {
            let values = column.values.get(places.clone()).unwrap_or_default();
            bytes.extend(values.iter().flat_map(|value| value.to_bits().to_le_bytes()));
        }
        sha256_hex([bytes.as_slice()])
    }

    /// All columns of numbers, inputs first.
    pub(crate) fn columns(&self) -> impl Iterator<Item = &Column> {
        self.inputs.iter().chain(&self.outcomes)
    }
}

fn number(values: &[f64], idx: usize) -> f64 {
    values.get(idx).copied().unwrap_or(f64::NAN)
}
