//! How a text file writes a table: separator, decimal sign, comments. Found by looking, since no
//! two programs agree.

use serde::{Deserialize, Serialize};

/// What stands between two fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Separator {
    /// A tab.
    Tab,
    /// `;`
    Semicolon,
    /// Any number of blanks and tabs.
    Blanks,
    /// `,`
    Comma,
}

/// How a file writes its table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Dialect {
    /// What stands between two fields.
    pub separator: Separator,
    /// Whether numbers are written `0,5` instead of `0.5`.
    pub decimal_comma: bool,
}

impl Separator {
    /// In the order in which a tie is decided.
    const ALL: [Self; 4] = [Self::Tab, Self::Semicolon, Self::Blanks, Self::Comma];

    pub(crate) fn byte(self) -> u8 {
        match self {
            Self::Tab => b'\t',
            Self::Semicolon => b';',
            Self::Blanks => b' ',
            Self::Comma => b',',
        }
    }

    /// The fields of a line, quotes not regarded.
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

impl Dialect {
    /// The separator that makes the most numbers of these lines, or, where there are no numbers,
    /// the most fields of the first line; and the decimal sign that these numbers have.
    pub(crate) fn sniff(lines: &[&str]) -> Self {
        let score = |separator: &Separator| {
            let decimal_comma = *separator != Separator::Comma;
            let fields = lines.iter().flat_map(|line| separator.fields(line));
            let numbers = fields.filter(|field| parse_number(field, decimal_comma).is_some());
            let first = lines.first().map_or(0, |line| separator.fields(line).count());
            // Words have blanks between them, fields need not.
            let blanks = *separator == Separator::Blanks;
            (numbers.count(), if blanks { (2 * first.min(2)).saturating_sub(1) } else { 2 * first })
        };
        // At a tie, `max_by_key` takes the last one.
        let last_to_first = Separator::ALL.into_iter().rev();
        let separator = last_to_first.max_by_key(score).unwrap_or(Separator::Comma);
        let fields = || lines.iter().flat_map(|line| separator.fields(line));
        let written_with = |sign: char| {
            fields().any(|field| field.contains(sign) && parse_number(field, sign == ',').is_some())
        };
        Self {
            separator,
            decimal_comma: separator != Separator::Comma && written_with(',') && !written_with('.'),
        }
    }

    /// The number in a cell, if there is a finite one.
    pub(crate) fn number(self, cell: &str) -> Option<f64> {
        parse_number(cell.trim(), self.decimal_comma)
    }
}

/// The line without its comment sign, if it is a comment.
pub(crate) fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    ["//", "#", "%", "!", "$"]
        .iter()
        .find_map(|sign| line.strip_prefix(sign))
        .map(|rest| rest.trim_start_matches(['#', '%', '!', '$', '/']).trim())
}

/// A finite number; with `decimal_comma` as `0,5` or `0.5`, never with both signs. Fortran's
/// `1.5D+03` is understood.
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
            let plain = plain.replace(['d', 'D'], "e");
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
            ("  t   fx\n  0.1  2.5\n", Separator::Blanks, false),
            ("t fx\n0,1 2,5\n", Separator::Blanks, true),
            ("\"t\",\"fx\"\n\"0.1\",\"2.5\"\n", Separator::Comma, false),
            ("name of case,side\na b,left\n", Separator::Comma, false),
            ("case;side\na;left\n", Separator::Semicolon, false),
        ] {
            let lines: Vec<&str> = text.lines().collect();
            let expected = Dialect { separator, decimal_comma };
            assert_eq!(Dialect::sniff(&lines), expected, "{text:?}");
        }
    }
}
