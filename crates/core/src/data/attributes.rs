//! The attributes of one case: one row of the table of cases (`cases.csv`), with every column in
//! the order of the file.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::data::{AttributeColumn, DataError, Table};

/// The content of a cell that is not blank.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A finite number.
    Number(f64),
    /// Any text that is not a finite number.
    Text(String),
}

/// One row of a table of cases, with the names of its columns and its place in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Attributes {
    path: Arc<Path>,
    line: u64,
    names: Arc<[String]>,
    values: Vec<Option<Value>>,
}

impl Attributes {
    /// Takes all rows of a table, in the order of the file.
    pub(crate) fn from_table(table: &Table) -> Vec<Self> {
        let (path, names) = (Arc::from(table.path()), Arc::from(table.header()));
        let value = |cell: Cow<'_, str>| match (table.dialect().number(&cell), cell) {
            (Some(number), _) => Some(Value::Number(number)),
            (None, cell) if cell.is_empty() => None,
            (None, text) => Some(Value::Text(text.into_owned())),
        };
        let row = |(line, cells): (u64, Vec<Cow<'_, str>>)| Self {
            path: Arc::clone(&path),
            line,
            names: Arc::clone(&names),
            values: cells.into_iter().map(value).collect(),
        };
        table.rows().map(row).collect()
    }

    /// Returns the name and the content of every column in the order of the file; a blank cell is
    /// `None`.
    pub fn iter(&self) -> impl Iterator<Item = (&str, Option<&Value>)> {
        let values = self.values.iter().map(Option::as_ref);
        self.names.iter().map(String::as_str).zip(values)
    }

    /// The content of a cell; `None` if the cell is blank or the table has no column of this name.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.iter().find(|(column, _)| *column == name)?.1
    }

    /// The number in a cell; `None` if the cell is blank or holds text, or if there is no such
    /// column.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(number) => Some(*number),
            Value::Text(_) => None,
        }
    }

    /// The text in a cell; `None` if the cell is blank or holds a number, or if there is no such
    /// column.
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            Value::Number(_) => None,
            Value::Text(text) => Some(text),
        }
    }

    /// The value of a yes-or-no column, which is written as a number (0 is no, any other number is
    /// yes), as `true` or `false`, or as `yes` or `no`, in upper or lower case. Any other text, a
    /// blank cell and a missing column are `None`.
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

    /// The number in a column that the computation cannot do without.
    ///
    /// - `consequence`: what cannot be computed without the number, in words; it becomes part of
    ///   the error.
    ///
    /// # Errors
    /// [`DataError::MissingAttribute`] if there is no such column, and [`DataError::Attribute`] if
    /// the cell is blank or holds text or a number out of range.
    pub fn require(
        &self,
        column: &AttributeColumn,
        consequence: &'static str,
    ) -> Result<f64, DataError> {
        if self.column(column.name) == 0 {
            return Err(DataError::MissingAttribute {
                path: self.path(),
                line: self.line,
                name: column.name.to_owned(),
                consequence,
            });
        }
        self.optional(column)?.ok_or_else(|| self.wrong(column, "blank".to_owned()))
    }

    /// The number in a column that a case may leave out; `None` if the cell is blank or there is no
    /// such column.
    ///
    /// # Errors
    /// [`DataError::Attribute`] if the cell holds text or a number out of range.
    pub fn optional(&self, column: &AttributeColumn) -> Result<Option<f64>, DataError> {
        match self.get(column.name) {
            None => Ok(None),
            Some(Value::Text(text)) => Err(self.wrong(column, format!("{text:?}"))),
            Some(Value::Number(number)) => match column.range.check(*number) {
                Ok(number) => Ok(Some(number)),
                Err(_) => Err(self.wrong(column, column.range.shown(*number))),
            },
        }
    }

    /// Builds the error for a cell that does not hold what its column needs.
    ///
    /// - `got`: what the cell holds, in words.
    fn wrong(&self, column: &AttributeColumn, got: String) -> DataError {
        self.refused(column.name, got, column.range.explained())
    }

    /// Builds the error for a cell whose content cannot be used.
    pub(crate) fn refused(&self, name: &str, got: String, expected: String) -> DataError {
        DataError::Attribute {
            path: self.path(),
            line: self.line,
            column: self.column(name),
            name: name.to_owned(),
            got,
            expected,
        }
    }

    /// Path of the table of cases.
    pub fn path(&self) -> PathBuf {
        self.path.to_path_buf()
    }

    /// Line of the row in the table of cases, counted from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Number of a column, counted from 1; 0 if there is no column of this name.
    pub(crate) fn column(&self, name: &str) -> usize {
        self.names.iter().position(|column| column == name).map_or(0, |idx| idx + 1)
    }
}
