//! What a table of cases says about one case: every column, in order.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::data::{DataError, Table};

/// The content of a cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A finite number.
    Number(f64),
    /// Anything else that is not blank.
    Text(String),
}

/// One row of a table of cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Attributes {
    path: Arc<Path>,
    line: u64,
    names: Arc<[String]>,
    values: Vec<Option<Value>>,
}

impl Attributes {
    /// Every row of a table.
    pub(crate) fn of(table: &Table) -> Vec<Self> {
        let (path, names) = (Arc::from(table.path()), Arc::from(table.header()));
        let value = |row, column| match (table.number(row, column), table.cell(row, column)) {
            (Some(number), _) => Some(Value::Number(number)),
            (None, "") => None,
            (None, text) => Some(Value::Text(text.to_owned())),
        };
        let row = |row_idx| Self {
            path: Arc::clone(&path),
            line: table.line(row_idx),
            names: Arc::clone(&names),
            values: (0..table.header().len()).map(|column| value(row_idx, column)).collect(),
        };
        (0..table.n_rows()).map(row).collect()
    }

    /// All columns in the order of the file; `None` is a blank cell.
    pub fn iter(&self) -> impl Iterator<Item = (&str, Option<&Value>)> {
        let values = self.values.iter().map(Option::as_ref);
        self.names.iter().map(String::as_str).zip(values)
    }

    /// The cell in a column; `None` if it is blank or there is no such column.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.iter().find(|(column, _)| *column == name)?.1
    }

    /// The number in a column.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(number) => Some(*number),
            Value::Text(_) => None,
        }
    }

    /// The text in a column.
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            Value::Number(_) => None,
            Value::Text(text) => Some(text),
        }
    }

    /// A yes or no, written 1 or 0, true or false, yes or no.
    pub fn flag(&self, name: &str) -> Option<bool> {
        match self.get(name)? {
            Value::Number(number) => Some(*number != 0.0),
            Value::Text(text) => match text.to_ascii_lowercase().as_str() {
                "true" | "yes" => Some(true),
                "false" | "no" => Some(false),
                _ => None,
            },
        }
    }

    /// The number in a column that must have one.
    ///
    /// # Errors
    /// [`DataError::MissingAttribute`] with the `consequence`, or [`DataError::Cell`].
    pub fn require(&self, name: &str, consequence: &'static str) -> Result<f64, DataError> {
        match self.get(name) {
            Some(Value::Number(number)) => Ok(*number),
            Some(Value::Text(text)) => Err(self.not_a_number(name, text)),
            None => Err(DataError::MissingAttribute {
                path: self.path(),
                line: self.line,
                name: name.to_owned(),
                consequence,
            }),
        }
    }

    /// The table of cases.
    pub fn path(&self) -> PathBuf {
        self.path.to_path_buf()
    }

    /// The row's line, from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Number of a column, from 1; 0 if there is none of this name.
    pub(crate) fn column(&self, name: &str) -> usize {
        self.names.iter().position(|column| column == name).map_or(0, |idx| idx + 1)
    }

    /// The error for text where a number is needed.
    pub(crate) fn not_a_number(&self, name: &str, text: &str) -> DataError {
        DataError::Cell {
            path: self.path(),
            line: self.line,
            column: self.column(name),
            name: name.to_owned(),
            text: text.to_owned(),
            unit: "",
        }
    }
}
