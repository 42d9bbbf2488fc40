//! The filter of the case table: what its words mean, and which cases match all of them.
//!
//! A word compares a column with a value (`speed_m_s>=20`, `side=left`, `side!=left`), names a column of
//! yes and no (`hooked`), or is a part of the name of a case, of a text or of a flag (`c012`, `drift`).
//! Upper and lower case are not distinguished in texts. A column that does not exist, and a comparison
//! that makes no sense, are errors: a list that is empty for a misspelt word would look like an answer.

use crate::app::case_row::{AVERAGE_ERROR, CaseRow};
use impactlab_core::data::{Case, Value};

/// A filter that was understood.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CaseFilter {
    words: Vec<Word>,
}

/// A filter that cannot be applied to a data set.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FilterError {
    /// No case has the column.
    #[error("`{word}`: there is no column {column}; the columns are {columns}")]
    UnknownColumn {
        /// The word of the filter.
        word: String,
        /// The column that it names.
        column: String,
        /// The columns that there are.
        columns: String,
    },
    /// A column of numbers is compared with a text.
    #[error("`{word}`: {column} holds numbers, `{text}` is none")]
    NotANumber {
        /// The word of the filter.
        word: String,
        /// The column.
        column: String,
        /// What it is compared with.
        text: String,
    },
    /// Texts are compared by size.
    #[error("`{word}`: {column} holds texts, which can only be compared with = and !=")]
    OrderOfTexts {
        /// The word of the filter.
        word: String,
        /// The column.
        column: String,
    },
}

#[derive(Debug, Clone, PartialEq)]
enum Word {
    Number { column: String, comparison: Comparison, wanted: f64 },
    Text { column: String, is_equal: bool, wanted: String },
    Yes { column: String },
    Part(String),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Comparison {
    LessOrEqual,
    GreaterOrEqual,
    NotEqual,
    Less,
    Greater,
    Equal,
}

/// The signs; those of two characters come first, so that `<=` is not taken for `<`.
const SIGNS: [(&str, Comparison); 6] = [
    ("<=", Comparison::LessOrEqual),
    (">=", Comparison::GreaterOrEqual),
    ("!=", Comparison::NotEqual),
    ("<", Comparison::Less),
    (">", Comparison::Greater),
    ("=", Comparison::Equal),
];

impl Comparison {
    fn holds(self, value: f64, wanted: f64) -> bool {
        match self {
            Self::LessOrEqual => value <= wanted,
            Self::GreaterOrEqual => value >= wanted,
            Self::NotEqual => value != wanted,
            Self::Less => value < wanted,
            Self::Greater => value > wanted,
            Self::Equal => value == wanted,
        }
    }
}

impl CaseFilter {
    /// Understands a filter for the cases of a data set.
    ///
    /// # Errors
    /// [`FilterError`] for the first word that makes no sense.
    pub fn new(text: &str, cases: &[Case]) -> Result<Self, FilterError> {
        let words = text.split_whitespace().map(|word| Word::new(word, cases));
        Ok(Self { words: words.collect::<Result<_, _>>()? })
    }

    /// Whether a case matches all words.
    pub fn matches(&self, row: &CaseRow<'_>) -> bool {
        self.words.iter().all(|word| word.matches(row))
    }
}

impl Word {
    fn new(word: &str, cases: &[Case]) -> Result<Self, FilterError> {
        let found = SIGNS.iter().find_map(|(sign, comparison)| {
            let (column, wanted) = word.split_once(sign)?;
            Some((column.to_owned(), *comparison, wanted.to_owned()))
        });
        let Some((column, comparison, wanted)) = found else {
            let is_flag = cases.iter().any(|case| case.attributes.flag(word).is_some());
            return Ok(match is_flag {
                true => Self::Yes { column: word.to_owned() },
                false => Self::Part(word.to_lowercase()),
            });
        };
        let word = word.to_owned();
        if column != AVERAGE_ERROR && !columns(cases).contains(&column.as_str()) {
            let columns = columns(cases).join(", ");
            return Err(FilterError::UnknownColumn { word, column, columns });
        }
        let holds_texts = cases.iter().any(|case| case.attributes.text(&column).is_some());
        match (wanted.parse::<f64>(), comparison) {
            (Ok(wanted), _) if !holds_texts => Ok(Self::Number { column, comparison, wanted }),
            (_, Comparison::Equal | Comparison::NotEqual) if holds_texts => {
                Ok(Self::Text { column, is_equal: comparison == Comparison::Equal, wanted })
            }
            _ if holds_texts => Err(FilterError::OrderOfTexts { word, column }),
            _ => Err(FilterError::NotANumber { word, column, text: wanted }),
        }
    }

    fn matches(&self, row: &CaseRow<'_>) -> bool {
        let attributes = &row.case.attributes;
        match self {
            Self::Number { column, comparison, wanted } => {
                row.number(column).is_some_and(|value| comparison.holds(value, *wanted))
            }
            Self::Text { column, is_equal, wanted } => {
                let is_wanted = match attributes.get(column) {
                    Some(Value::Text(text)) => text.eq_ignore_ascii_case(wanted),
                    Some(Value::Number(number)) => wanted.parse() == Ok(*number),
                    None => return false,
                };
                is_wanted == *is_equal
            }
            Self::Yes { column } => attributes.flag(column) == Some(true),
            Self::Part(part) => {
                let contains = |text: &str| text.to_lowercase().contains(part);
                let in_attribute = |(_, value): (&str, Option<&Value>)| match value {
                    Some(Value::Text(text)) => contains(text),
                    _ => false,
                };
                contains(row.name)
                    || attributes.iter().any(in_attribute)
                    || row.flags.iter().any(|flag| {
                        // As the table shows it, or as its sentence says it.
                        contains(flag.kind.label()) || contains(&flag.to_string())
                    })
            }
        }
    }
}

/// The columns of the cases of a data set, which all have the same.
fn columns(cases: &[Case]) -> Vec<&str> {
    cases
        .first()
        .map_or_else(Vec::new, |case| case.attributes.iter().map(|(name, _)| name).collect())
}
