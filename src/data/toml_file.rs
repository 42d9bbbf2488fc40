//! The text of a TOML file that a person writes, and what can be wrong with it.
//!
//! A file is read in one of two ways, which share places and errors:
//!
//! - [`TomlFile::to`] takes a whole file whose keys are the fields of a type;
//! - [`TomlFile::parse`] gives a [`TomlTable`](crate::data::TomlTable), which is read key by key
//!   where a quantity may be written in several units.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A TOML file that cannot be used. All but the first read `file:line:column: …`, from 1.
#[derive(Debug, thiserror::Error)]
pub enum TomlError {
    /// The file cannot be opened or is not text.
    #[error("{}: cannot be read", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
    },
    /// Not TOML, or not the keys and kinds of values that are expected.
    #[error("{}:{line}:{column}: {message}", path.display())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// Line.
        line: usize,
        /// Column.
        column: usize,
        /// The parser's message.
        message: String,
    },
    /// A value of the wrong kind or outside its range.
    #[error("{}:{line}:{column}: {key} is {value}, expected {expected}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line of the value.
        line: usize,
        /// Column of the value.
        column: usize,
        /// The key with its table.
        key: Box<str>,
        /// The value as written.
        value: Box<str>,
        /// The range, in the key's own unit, or the kind.
        expected: Box<str>,
    },
    /// A key that this table does not have, most likely misspelt or in an unknown unit.
    #[error("{}:{line}:{column}: {key} is not known here", path.display())]
    UnknownKey {
        /// The file.
        path: PathBuf,
        /// Line of the key.
        line: usize,
        /// Column of the key.
        column: usize,
        /// The key with its table.
        key: Box<str>,
    },
    /// A required key that is not there.
    #[error("{}:{line}:{column}: {key} is missing", path.display())]
    MissingKey {
        /// The file.
        path: PathBuf,
        /// Line of the table.
        line: usize,
        /// Column of the table.
        column: usize,
        /// The key with its table, and the keys that may be given instead.
        key: Box<str>,
    },
    /// Two keys that say the same thing.
    #[error("{}:{line}:{column}: {key} and {other} say the same thing, expected one", path.display())]
    Conflict {
        /// The file.
        path: PathBuf,
        /// Line of the second key.
        line: usize,
        /// Column of the second key.
        column: usize,
        /// The second key with its table.
        key: Box<str>,
        /// The first key.
        other: Box<str>,
    },
}

/// Name and text of a file.
#[derive(Debug, Clone, Copy)]
pub struct TomlFile<'a> {
    /// Named in errors.
    pub path: &'a Path,
    /// The whole text.
    pub text: &'a str,
}

impl<'a> TomlFile<'a> {
    /// Reads the text of a file.
    ///
    /// # Errors
    /// [`TomlError::Read`].
    pub fn read(path: &Path) -> Result<String, TomlError> {
        std::fs::read_to_string(path)
            .map_err(|source| TomlError::Read { path: path.to_owned(), source })
    }

    /// Reads a value whose fields are the keys of the file.
    ///
    /// # Errors
    /// [`TomlError::Syntax`] for text that is not TOML, unknown and missing keys, and values of the
    /// wrong kind.
    pub fn to<T: DeserializeOwned>(self) -> Result<T, TomlError> {
        toml::from_str(self.text).map_err(|error| self.syntax(&error))
    }

    /// Reads the tables of the file.
    ///
    /// # Errors
    /// [`TomlError::Syntax`].
    pub fn parse(self) -> Result<Spanned<DeTable<'a>>, TomlError> {
        DeTable::parse(self.text).map_err(|error| self.syntax(&error))
    }

    /// The error for a number outside its range, at the place of the value.
    ///
    /// - `key`: with its table, such as `mass.mass_kg`. A value that stands in no line of the file,
    ///   because it was derived from others, is reported at the start of the file.
    pub fn out_of_range(self, key: &str, value: f64, [low, high]: [f64; 2]) -> TomlError {
        let root = DeTable::parse(self.text).ok();
        let table = root.as_ref().map(Spanned::get_ref);
        let span = table.and_then(|table| find(table, key)).map(Spanned::span);
        let (line, column) = self.line_column(span.as_ref().map_or(0, |span| span.start));
        let written = span.and_then(|span| self.text.get(span)).map(str::to_owned);
        TomlError::Value {
            path: self.path.to_owned(),
            line,
            column,
            key: key.into(),
            value: written.unwrap_or_else(|| value.to_string()).into(),
            expected: format!("{low} to {high}").into(),
        }
    }

    fn syntax(self, error: &toml::de::Error) -> TomlError {
        let (line, column) = self.line_column(error.span().map_or(0, |span| span.start));
        let (path, message) = (self.path.to_owned(), error.message().to_owned());
        TomlError::Syntax { path, line, column, message }
    }

    /// Line and column of a byte, both from 1, columns in characters.
    pub(super) fn line_column(self, at: usize) -> (usize, usize) {
        let before = self.text.get(..at).unwrap_or(self.text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let column = before[line_start..].chars().count() + 1;
        (before.matches('\n').count() + 1, column)
    }
}

/// The value of a key with its tables, `table.key`.
fn find<'t, 'a>(table: &'t DeTable<'a>, key: &str) -> Option<&'t Spanned<DeValue<'a>>> {
    match key.split_once('.') {
        None => table.iter().find(|(name, _)| *name.get_ref() == key).map(|(_, value)| value),
        Some((first, rest)) => find(find(table, first)?.get_ref().as_table()?, rest),
    }
}
