//! The way in which a text file writes a table: separator, decimal sign and comments. It is
//! determined from the first lines of the file, because programs differ in it.

use std::borrow::Cow;

use csv::{ReaderBuilder, StringRecord, Trim};
use serde::{Deserialize, Serialize};

use crate::data::marks::{Marks, Signs, Thousands, has_groups};
use crate::data::{ReadSettings, spelling};

/// The separator between two fields of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Separator {
    /// One tab.
    Tab,
    /// One semicolon, `;`.
    Semicolon,
    /// One vertical bar, `|`.
    Bar,
    /// Any number of spaces and tabs.
    Blanks,
    /// One comma, `,`.
    Comma,
}

/// Separator and decimal sign of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Dialect {
    /// The separator between two fields of a line.
    pub separator: Separator,
    /// Whether the decimal sign is a comma, as in `0,5`, instead of a point.
    pub decimal_comma: bool,
    /// What stands between the thousands of its numbers; `None` if nothing does.
    pub thousands: Option<Thousands>,
}

impl Separator {
    /// All separators, in the order of preference if several fit equally well.
    pub const ALL: [Self; 5] = [Self::Tab, Self::Semicolon, Self::Bar, Self::Blanks, Self::Comma];

    /// Its name in the text of a map.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tab => "tab",
            Self::Semicolon => "semicolon",
            Self::Bar => "bar",
            Self::Blanks => "space",
            Self::Comma => "comma",
        }
    }

    pub(crate) fn byte(self) -> u8 {
        match self {
            Self::Tab => b'\t',
            Self::Semicolon => b';',
            Self::Bar => b'|',
            Self::Blanks => b' ',
            Self::Comma => b',',
        }
    }

    /// Splits a line into its fields, without surrounding blanks and quotation marks. A separator
    /// inside quotation marks divides a field as well.
    pub(crate) fn fields(self, line: &str) -> impl Iterator<Item = &str> {
        let separator = char::from(self.byte());
        let is_separator = move |c: char| match self {
            Self::Blanks => c.is_whitespace(),
            _ => c == separator,
        };
        line.split(is_separator)
            .filter(move |field| self != Self::Blanks || !field.is_empty())
            .map(|field| field.trim().trim_matches('"'))
    }
}

/// Splits a line into its fields. A separator inside quotation marks does not divide a field.
pub(super) fn split(line: &str, separator: Separator) -> Vec<Cow<'_, str>> {
    if !line.contains('"') {
        return separator.fields(line).map(Cow::Borrowed).collect();
    }
    let line = match separator {
        Separator::Blanks => line.replace('\t', " "),
        _ => line.to_owned(),
    };
    let mut reader = ReaderBuilder::new()
        .delimiter(separator.byte())
        .has_headers(false)
        .trim(Trim::All)
        .buffer_capacity(line.len() + 1)
        .from_reader(line.as_bytes());
    let mut record = StringRecord::new();
    // Reading from memory fails for invalid UTF-8 only, which a `str` cannot contain.
    let _ = reader.read_record(&mut record);
    let is_cell = |cell: &&str| separator != Separator::Blanks || !cell.is_empty();
    record.iter().filter(is_cell).map(|cell| Cow::Owned(cell.to_owned())).collect()
}

impl Dialect {
    /// Determines separator and decimal sign from the first lines of a table.
    ///
    /// The separator is the one with which most fields are numbers. At equality, in particular if
    /// there are no numbers, it is the one with most fields in the first line. The signs within
    /// numbers follow from [`Marks`].
    ///
    /// - `converted`: the separator of lines that were written by this program, from another format;
    /// - `settings`: what the user has said.
    pub(crate) fn sniff(
        lines: &[&str],
        converted: Option<Separator>,
        settings: &ReadSettings,
    ) -> Self {
        let is_number = |field: &Cow<'_, str>| {
            parse_number(field, true).is_some() || has_groups(field) || has_unit(field)
        };
        let score = |separator: &Separator| {
            let fields = lines.iter().flat_map(|line| split(line, *separator));
            let numbers = fields.filter(is_number);
            let first = lines.first().map_or(0, |line| split(line, *separator).len());
            // Words contain blanks between them, so that a second field by blanks is weak evidence:
            // blanks score less than another separator that gives two fields.
            let blanks = *separator == Separator::Blanks;
            (numbers.count(), if blanks { (2 * first.min(2)).saturating_sub(1) } else { 2 * first })
        };
        // `max_by_key` returns the last of several maxima, therefore the order is reversed.
        let last_to_first = Separator::ALL.into_iter().rev();
        let found = || last_to_first.max_by_key(score).unwrap_or(Separator::Comma);
        let separator = converted.or(settings.separator).unwrap_or_else(found);
        let mut marks = Marks::default();
        for field in lines.iter().flat_map(|line| split(line, separator)) {
            marks.add(&field);
        }
        Self::with_marks(separator, marks, converted.is_some(), settings).0
    }

    /// A separator with the signs that follow from the marks within numbers, and whether a number may mean
    /// two things.
    ///
    /// - `is_converted`: whether the lines were written by this program, with decimal points.
    pub(super) fn with_marks(
        separator: Separator,
        marks: Marks,
        is_converted: bool,
        settings: &ReadSettings,
    ) -> (Self, bool) {
        let marks = if is_converted { marks.with_decimal_points() } else { marks };
        let signs = marks.signs(separator, settings.decimal_comma, settings.thousands);
        let Signs { decimal_comma, thousands, is_open } = signs;
        (Self { separator, decimal_comma, thousands }, is_open)
    }

    /// The number in a cell; `None` if the cell does not hold a finite number.
    pub(crate) fn number(self, cell: &str) -> Option<f64> {
        let cell = cell.trim();
        match self.thousands {
            None => parse_number(cell, self.decimal_comma),
            Some(mark) => {
                let plain = mark.removed(cell, self.decimal_comma)?;
                parse_number(&plain, self.decimal_comma)
            }
        }
    }
}

/// The text of a comment line without its sign (`//`, `#`, `%`, `!` or `$`); `None` if the line is
/// no comment.
pub(crate) fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    ["//", "#", "%", "!", "$"]
        .iter()
        .find_map(|sign| line.strip_prefix(sign))
        .map(|rest| rest.trim_start_matches(['#', '%', '!', '$', '/']).trim())
}

/// Whether a cell holds a number with its unit, such as `12.3 m/s`.
pub(super) fn has_unit(cell: &str) -> bool {
    let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',');
    let cell = cell.trim();
    let at = cell.find(|c: char| !is_of_number(c)).unwrap_or(cell.len());
    let (number, unit) = cell.split_at(at);
    parse_number(number, true).is_some() && spelling::is_known_unit(unit.trim())
}

/// A number whose exponent of three digits has no letter before it, as Fortran writes `1.0-103`, with the
/// letter.
fn with_exponent(text: &str) -> String {
    let at = text.len().saturating_sub(4);
    match text.get(..at).zip(text.get(at..)) {
        Some((mantissa, exponent))
            if mantissa.contains('.')
                && mantissa.ends_with(|c: char| c.is_ascii_digit() || c == '.')
                && exponent.starts_with(['+', '-'])
                && exponent.get(1..).is_some_and(|e| e.bytes().all(|b| b.is_ascii_digit())) =>
        {
            format!("{mantissa}e{exponent}")
        }
        _ => text.to_owned(),
    }
}

/// Parses a finite number; `None` for any other text. With `decimal_comma` both `0,5` and `0.5` are
/// read, but no number that contains both signs. The exponent of Fortran, as in `1.5D+03`, is
/// understood.
fn parse_number(text: &str, decimal_comma: bool) -> Option<f64> {
    let first = text.bytes().next()?;
    if !first.is_ascii_digit() && !matches!(first, b'+' | b'-' | b'.' | b',') {
        return None;
    }
    let number = match text.parse::<f64>() {
        Ok(number) => number,
        Err(_) => {
            let (whole, fraction) = match text.split_once(',') {
                Some((whole, fraction)) if decimal_comma => (whole, Some(fraction)),
                _ => (text, None),
            };
            let fits = fraction.is_none_or(|fraction| {
                !whole.contains('.') && fraction.starts_with(|c: char| c.is_ascii_digit())
            });
            let plain = match fraction {
                Some(fraction) => format!("{whole}.{fraction}"),
                None => whole.to_owned(),
            };
            let plain = with_exponent(&plain.replace(['d', 'D'], "e"));
            plain.parse().ok().filter(|_| fits)?
        }
    };
    number.is_finite().then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_and_nothing_else() {
        for (text, number) in [
            ("1,5", Some(1.5)),
            ("-,5", Some(-0.5)),
            ("1.5", Some(1.5)),
            ("1.5D+03", Some(1500.0)),
            ("1,5E-3", Some(1.5e-3)),
            ("1.5-103", Some(1.5e-103)),
            ("-1.5+103", Some(-1.5e103)),
            ("2026-103", None),
            ("1.5-1033", None),
            ("1.000,5", None),
            ("1,000,5", None),
            ("1,", None),
            ("nan", None),
            ("inf", None),
            ("-inf", None),
            ("1e999", None),
            ("", None),
            ("dad", None),
        ] {
            assert_eq!(parse_number(text, true), number, "{text:?}");
        }
        assert_eq!(parse_number("1,5", false), None);
    }

    #[test]
    fn separators_and_decimal_signs_are_found() {
        for (text, separator, decimal_comma) in [
            ("t,fx\n0.1,2\n", Separator::Comma, false),
            ("t, fx, fy\n0, 1, 2\n", Separator::Comma, false),
            ("t;fx\n0,1;2,5\n", Separator::Semicolon, true),
            ("t;fx\n0.1;2.5\n", Separator::Semicolon, false),
            ("t\tfx\n0,1\t2,5\n", Separator::Tab, true),
            ("t|fx|fy\n0.1|2|3\n", Separator::Bar, false),
            ("t | fx | fy\n0,1 | 2,5 | 3\n", Separator::Bar, true),
            ("  t   fx\n  0.1  2.5\n", Separator::Blanks, false),
            ("t fx\n0,1 2,5\n", Separator::Blanks, true),
            ("\"t\",\"fx\"\n\"0.1\",\"2.5\"\n", Separator::Comma, false),
            ("\"t\",\"fx\"\n\"0,1\",\"2,5\"\n", Separator::Comma, true),
            ("\"t\",\"fx\"\n\"0,001\",\"2,500\"\n", Separator::Comma, true),
            ("t,fx\n1,\"2,500\"\n2,\"12,500\"\n", Separator::Comma, false),
            ("name of case,side\na b,left\n", Separator::Comma, false),
            ("case;side\na;left\n", Separator::Semicolon, false),
        ] {
            let lines: Vec<&str> = text.lines().collect();
            let expected = Dialect { separator, decimal_comma, thousands: None };
            let found = Dialect::sniff(&lines, None, &ReadSettings::default());
            assert_eq!(found, expected, "{text:?}");
        }
    }

    #[test]
    fn numbers_with_thousands_are_read_by_the_signs_of_the_table() {
        let lines = ["t;fx", "0,001;1.860,5", "0,002;2.340,75"];
        let dialect = Dialect::sniff(&lines, None, &ReadSettings::default());
        assert_eq!(dialect.separator, Separator::Semicolon);
        assert_eq!(dialect.thousands, Some(Thousands::Point));
        for (cell, number) in [
            ("1.860", Some(1860.0)),
            ("-1.860,5", Some(-1860.5)),
            ("0.5", None),
            ("0,5", Some(0.5)),
        ] {
            assert_eq!(dialect.number(cell), number, "{cell}");
        }
    }
}
