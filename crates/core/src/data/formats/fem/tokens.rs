//! Words and numbers of the fixed columns that solvers write.
//!
//! A number may touch the word or the number before it: `x-1.2E+05`, `1.0E+00-2.0E+00`. An exponent of
//! three digits may stand without its letter, `1.0-103`.

use std::path::Path;

use crate::data::{DataError, Place};

/// A part of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Token<'a> {
    /// Anything but a number.
    Word(&'a str),
    /// A number, as it is written and what it is.
    Number(&'a str, f64),
}

impl Token<'_> {
    /// The number; `None` for a word.
    pub(super) fn number(self) -> Option<f64> {
        match self {
            Self::Number(_, value) => Some(value),
            Self::Word(_) => None,
        }
    }

    /// The whole number that is written without point and exponent.
    pub(super) fn whole(self) -> Option<i64> {
        match self {
            Self::Number(text, _) => text.parse().ok(),
            Self::Word(_) => None,
        }
    }
}

/// The words and numbers of a line, in their order.
pub(super) fn tokens(line: &str) -> impl Iterator<Item = Token<'_>> {
    let mut rest = line;
    std::iter::from_fn(move || {
        rest = rest.trim_start();
        let first = rest.chars().next()?;
        let (length, value) = match number(rest) {
            Some((length, value)) => (length, Some(value)),
            None => {
                let is_end = |c: char| c.is_whitespace() || c.is_ascii_digit() || "+-.".contains(c);
                let after = rest.get(first.len_utf8()..).unwrap_or_default();
                (first.len_utf8() + after.find(is_end).unwrap_or(after.len()), None)
            }
        };
        let (token, after) = rest.split_at_checked(length)?;
        rest = after;
        Some(match value {
            Some(value) => Token::Number(token, value),
            None => Token::Word(token),
        })
    })
}

/// The number at the start of a text, with its length in bytes.
fn number(text: &str) -> Option<(usize, f64)> {
    let bytes = text.as_bytes();
    let byte = |at: usize| bytes.get(at).copied().unwrap_or(0);
    let is_sign = |at: usize| matches!(byte(at), b'+' | b'-');
    let digits =
        |from: usize| bytes.iter().skip(from).take_while(|byte| byte.is_ascii_digit()).count();
    let mut end = usize::from(is_sign(0));
    let n_whole = digits(end);
    end += n_whole;
    let has_point = byte(end) == b'.';
    let n_broken = if has_point { digits(end + 1) } else { 0 };
    end += usize::from(has_point) + n_broken;
    if n_whole + n_broken == 0 {
        return None;
    }
    let mantissa = text.get(..end)?;
    let letter = matches!(byte(end), b'e' | b'E' | b'd' | b'D');
    let at = end + usize::from(letter);
    let n_exponent = digits(at + usize::from(is_sign(at)));
    let has_exponent = match letter {
        true => n_exponent > 0,
        false => has_point && is_sign(at) && n_exponent == 3 && byte(at + 4) != b'.',
    };
    let value = match has_exponent {
        true => {
            end = at + usize::from(is_sign(at)) + n_exponent;
            format!("{mantissa}e{}", text.get(at..end)?).parse().ok()?
        }
        false => mantissa.parse().ok()?,
    };
    Some((end, value))
}

/// The lines of a text with their numbers, and what is said of a last line without its end, which is left
/// out: its last number may be cut.
pub(super) fn whole_lines(text: &str) -> (impl Iterator<Item = (u64, &str)>, Option<String>) {
    let end = text.rfind('\n').map_or(0, |at| at + 1);
    let (whole, rest) = text.split_at(end);
    let is_cut = !rest.trim().is_empty();
    let doubt = "the last line has no end and is left out; was the run ended?";
    ((1..).zip(whole.lines()), is_cut.then(|| doubt.to_owned()))
}

/// The error for a line that does not follow its format.
pub(super) fn damaged_line(path: &Path, (line, why): (u64, String)) -> DataError {
    let place = if line == 0 { Place::Whole } else { Place::Line(line) };
    DataError::DamagedAt { path: path.to_owned(), place, why }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_touch_are_told_apart() {
        use Token::{Number, Word};
        let read = |line| tokens(line).collect::<Vec<_>>();
        assert_eq!(
            read(" master   12 time 1.0E-03  x-1.2E+05y 3."),
            [
                Word("master"),
                Number("12", 12.0),
                Word("time"),
                Number("1.0E-03", 1e-3),
                Word("x"),
                Number("-1.2E+05", -1.2e5),
                Word("y"),
                Number("3.", 3.0),
            ]
        );
        assert_eq!(
            read("1.0E+00-2.0E+00-3.5-103 4d2"),
            [
                Number("1.0E+00", 1.0),
                Number("-2.0E+00", -2.0),
                Number("-3.5-103", -3.5e-103),
                Number("4d2", 400.0),
            ]
        );
        assert_eq!(
            read("- .e5 ä5 nan"),
            [Word("-"), Word(".e"), Number("5", 5.0), Word("ä"), Number("5", 5.0), Word("nan"),]
        );
        assert_eq!(read("  "), []);
    }
}
