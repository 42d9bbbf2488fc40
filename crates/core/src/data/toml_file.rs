//! TOML files written by a user, and the errors in them with their place.
//!
//! A file is read in one of two ways, which share the errors:
//!
//! - [`TomlFile::to`] reads a whole file whose keys are the fields of a type;
//! - [`TomlFile::parse`] gives the tables of a file, which a [`TomlTable`](crate::data::TomlTable)
//!   reads key by key where a quantity may be written in several units.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::data::{DataError, MAX_SETTINGS_BYTES, read_utf8};

/// The reason why a TOML file is refused. All messages but those of [`TomlError::File`] start with
/// `file:line:column`, both counted from 1.
#[derive(Debug, thiserror::Error)]
pub enum TomlError {
    /// The file cannot be opened, is too large or is not text.
    #[error(transparent)]
    File(Box<DataError>),
    /// The text is not TOML, or a key or the kind of a value is not the expected one.
    #[error("{}:{line}:{column}: {message}", path.display())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// Line of the error, counted from 1.
        line: usize,
        /// Column of the error in characters, counted from 1.
        column: usize,
        /// The message of the parser.
        message: String,
    },
    /// A value is of the wrong kind or outside its range.
    #[error("{}:{line}:{column}: {key} is {value}, expected {expected}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line of the value.
        line: usize,
        /// Column of the value.
        column: usize,
        /// The key, preceded by the name of its table.
        key: Box<str>,
        /// The value as written in the file.
        value: Box<str>,
        /// The range in the unit of the key, or the expected kind, in words.
        expected: Box<str>,
    },
    /// The table has no such key; the key is probably misspelt or in an unknown unit.
    #[error("{}:{line}:{column}: {key} is not known here", path.display())]
    UnknownKey {
        /// The file.
        path: PathBuf,
        /// Line of the key.
        line: usize,
        /// Column of the key.
        column: usize,
        /// The key, preceded by the name of its table.
        key: Box<str>,
    },
    /// A required key is missing.
    #[error("{}:{line}:{column}: {key} is missing", path.display())]
    MissingKey {
        /// The file.
        path: PathBuf,
        /// Line of the table.
        line: usize,
        /// Column of the table.
        column: usize,
        /// The key, preceded by the name of its table.
        key: Box<str>,
    },
    /// Two keys give the same quantity.
    #[error("{}:{line}:{column}: {key} and {other} say the same thing, expected one", path.display())]
    Conflict {
        /// The file.
        path: PathBuf,
        /// Line of the second key.
        line: usize,
        /// Column of the second key.
        column: usize,
        /// The second key, preceded by the name of its table.
        key: Box<str>,
        /// The first key.
        other: Box<str>,
    },
}

/// The path and the text of a TOML file.
#[derive(Debug, Clone, Copy)]
pub struct TomlFile<'a> {
    /// Path of the file, for errors.
    pub path: &'a Path,
    /// The whole text of the file.
    pub text: &'a str,
}

impl<'a> TomlFile<'a> {
    /// Reads the text of a file.
    ///
    /// # Errors
    /// [`TomlError::File`] if the file cannot be read, has more than [`MAX_SETTINGS_BYTES`] or is
    /// not UTF-8.
    pub fn read(path: &Path) -> Result<String, TomlError> {
        read_utf8(path, MAX_SETTINGS_BYTES).map_err(|error| TomlError::File(Box::new(error)))
    }

    /// What the file is called, without its folders, where it does not say its name: it stands in titles and
    /// tables of files that go to others.
    pub fn name(self) -> String {
        let name = self.path.file_name().unwrap_or(self.path.as_os_str());
        name.to_string_lossy().into_owned()
    }

    /// Parses the file into a value whose fields are the keys of the file.
    ///
    /// # Errors
    /// [`TomlError::Syntax`] if the text is not TOML, if a key is unknown to `T` or missing, or if
    /// a value is of the wrong kind.
    pub fn to<T: DeserializeOwned>(self) -> Result<T, TomlError> {
        toml::from_str(self.text).map_err(|error| self.syntax(&error))
    }

    /// Parses the file into its tables, with the place of each key and value.
    ///
    /// # Errors
    /// [`TomlError::Syntax`] if the text is not TOML.
    pub fn parse(self) -> Result<Spanned<DeTable<'a>>, TomlError> {
        DeTable::parse(self.text).map_err(|error| self.syntax(&error))
    }

    /// The names of the keys and tables at the top of the file, also of a text with slips, in which
    /// some of them may be missing.
    pub fn top_level_keys(self) -> Vec<String> {
        let (root, _) = DeTable::parse_recoverable(self.text);
        root.get_ref().keys().map(|key| key.get_ref().to_string()).collect()
    }

    /// Builds the error for a value that is not permitted, at its place in the file.
    ///
    /// - `key`: the key, preceded by the names of its tables, such as `mass.mass_kg`. If the file
    ///   does not contain the key because the value was derived from others, the place is the start
    ///   of the file.
    /// - `value`: the value, which the message shows if the file does not contain the key.
    /// - `expected`: the permitted values, in words.
    pub fn wrong_value(self, key: &str, value: &str, expected: &str) -> TomlError {
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
            value: written.unwrap_or_else(|| value.to_owned()).into(),
            expected: expected.into(),
        }
    }

    /// Whether the file has a key, preceded by the names of its tables, such as `mass.mass_kg`.
    pub fn contains(self, key: &str) -> bool {
        let root = DeTable::parse(self.text);
        root.is_ok_and(|root| find(root.get_ref(), key).is_some())
    }

    fn syntax(self, error: &toml::de::Error) -> TomlError {
        let (line, column) = self.line_column(error.span().map_or(0, |span| span.start));
        let (path, message) = (self.path.to_owned(), error.message().to_owned());
        TomlError::Syntax { path, line, column, message }
    }

    /// Line and column of a byte offset, both counted from 1; columns are counted in characters.
    pub(super) fn line_column(self, at: usize) -> (usize, usize) {
        let before = self.text.get(..at).unwrap_or(self.text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let column = before[line_start..].chars().count() + 1;
        (before.matches('\n').count() + 1, column)
    }
}

/// The value of a key that is preceded by the names of its tables, such as `table.key`.
fn find<'t, 'a>(table: &'t DeTable<'a>, key: &str) -> Option<&'t Spanned<DeValue<'a>>> {
    match key.split_once('.') {
        None => table.iter().find(|(name, _)| *name.get_ref() == key).map(|(_, value)| value),
        Some((first, rest)) => find(find(table, first)?.get_ref().as_table()?, rest),
    }
}
