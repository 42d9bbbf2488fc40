//! The marks within the numbers of a table: the decimal sign, and what stands between groups of thousands.
//!
//! One number may leave open which is which, `1.860` as well as `1,860`; the others of the table mostly say
//! it. Where none does, the user is asked.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::data::dialect::Separator;

/// What stands between groups of three digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Thousands {
    /// A point, `1.860`.
    Point,
    /// A comma, `1,860`.
    Comma,
    /// An apostrophe, `1'860`.
    Apostrophe,
    /// A space, `1 860`.
    Space,
}

impl Thousands {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Point, Self::Comma, Self::Apostrophe, Self::Space];

    /// Its name in the text of a map.
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Comma => "comma",
            Self::Apostrophe => "apostrophe",
            Self::Space => "space",
        }
    }

    /// What it is called in sentences and lists.
    pub fn label(self) -> &'static str {
        match self {
            Self::Point => "Points",
            Self::Comma => "Commas",
            Self::Apostrophe => "Apostrophes",
            Self::Space => "Spaces",
        }
    }

    fn from_char(mark: char) -> Option<Self> {
        Self::ALL.into_iter().find(|of| of.is(mark))
    }

    fn is(self, mark: char) -> bool {
        match self {
            Self::Point => mark == '.',
            Self::Comma => mark == ',',
            Self::Apostrophe => matches!(mark, '\'' | '\u{2019}'),
            Self::Space => matches!(mark, ' ' | '\u{a0}' | '\u{202f}'),
        }
    }

    /// A number without this mark between its groups; `None` if it stands elsewhere.
    pub(super) fn removed(self, number: &str, decimal_comma: bool) -> Option<Cow<'_, str>> {
        if !number.contains(|c: char| self.is(c)) {
            return Some(Cow::Borrowed(number));
        }
        let decimal = if decimal_comma { ',' } else { '.' };
        let end = number.find([decimal, 'e', 'E', 'd', 'D']).unwrap_or(number.len());
        let (whole, rest) = number.split_at(end);
        let is_grouped = are_groups(unsigned(whole), |c| self.is(c));
        (is_grouped && !rest.contains(|c: char| self.is(c)))
            .then(|| Cow::Owned(whole.replace(|c: char| self.is(c), "") + rest))
    }
}

/// How a text uses marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Use {
    /// It is no number, or one of digits alone.
    Nothing,
    /// As a decimal sign.
    Decimal(Thousands),
    /// Between groups, with a decimal sign behind them or without one.
    Grouped(Thousands, Option<Thousands>),
    /// One point or comma before three digits, which may be either.
    Open(Thousands),
}

fn use_of(text: &str) -> Use {
    let text = unsigned(text.trim());
    let (digits, exponent) = match text.find(['e', 'E', 'd', 'D']) {
        Some(at) => text.split_at(at),
        None => (text, ""),
    };
    let is_part = |c: char| c.is_ascii_digit() || Thousands::from_char(c).is_some();
    if !digits.chars().all(is_part) || !digits.contains(|c: char| c.is_ascii_digit()) {
        return Use::Nothing;
    }
    let mut marks = digits.chars().filter_map(Thousands::from_char);
    let Some(first) = marks.next() else { return Use::Nothing };
    let last = marks.next_back();
    let is_sign = |mark: Thousands| matches!(mark, Thousands::Point | Thousands::Comma);
    let grouped_by = |text: &str, mark: Thousands| are_groups(text, |c| mark.is(c));
    match last {
        None if grouped_by(digits, first) && exponent.is_empty() => match is_sign(first) {
            true => Use::Open(first),
            false => Use::Grouped(first, None),
        },
        None if is_sign(first) => Use::Decimal(first),
        Some(last) if last == first && grouped_by(digits, first) => Use::Grouped(first, None),
        Some(last) if last != first && is_sign(last) => {
            let whole = digits.rfind(|c: char| last.is(c)).and_then(|at| digits.get(..at));
            match whole.is_some_and(|whole| grouped_by(whole, first)) {
                true => Use::Grouped(first, Some(last)),
                false => Use::Nothing,
            }
        }
        _ => Use::Nothing,
    }
}

fn unsigned(number: &str) -> &str {
    number.strip_prefix(['+', '-']).unwrap_or(number)
}

/// Whether a text is one to three digits, without a zero in front, and groups of three after marks.
fn are_groups(text: &str, is_mark: impl Fn(char) -> bool) -> bool {
    let is_digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let mut groups = text.split(is_mark);
    let is_first =
        |group: &str| (1..=3).contains(&group.len()) && is_digits(group) && !group.starts_with('0');
    groups.next().is_some_and(is_first) && groups.all(|group| group.len() == 3 && is_digits(group))
}

/// Whether a number has groups of thousands beyond doubt.
pub(super) fn has_groups(text: &str) -> bool {
    matches!(use_of(text), Use::Grouped(..))
}

/// Whether a number has one mark that may be a decimal sign or stand between thousands.
pub(super) fn is_open(text: &str) -> bool {
    matches!(use_of(text), Use::Open(_))
}

/// What the numbers of a table say of their marks.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Marks {
    decimal: [bool; 4],
    grouped: [bool; 4],
    open: [bool; 4],
}

/// The decimal sign of a table, and what stands between its thousands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Signs {
    pub decimal_comma: bool,
    pub thousands: Option<Thousands>,
    /// Whether a number may mean two things.
    pub is_open: bool,
}

impl Marks {
    /// Takes in what a text says.
    pub(super) fn add(&mut self, text: &str) {
        match use_of(text) {
            Use::Nothing => {}
            Use::Decimal(mark) => self.decimal[mark as usize] = true,
            Use::Open(mark) => self.open[mark as usize] = true,
            Use::Grouped(mark, decimal) => {
                self.grouped[mark as usize] = true;
                if let Some(decimal) = decimal {
                    self.decimal[decimal as usize] = true;
                }
            }
        }
    }

    /// The same, where one point before three digits is a decimal sign.
    pub(super) fn with_decimal_points(mut self) -> Self {
        let point = Thousands::Point as usize;
        self.decimal[point] |= self.open[point];
        self
    }

    /// Whether a mark is a decimal sign.
    pub(super) fn is_decimal(&self, mark: Thousands) -> bool {
        self.decimal[mark as usize]
    }

    /// What follows from them.
    ///
    /// - `decimal_comma`, `thousands`: what the user has said.
    pub(super) fn signs(
        &self,
        separator: Separator,
        decimal_comma: Option<bool>,
        thousands: Option<Thousands>,
    ) -> Signs {
        use Thousands::{Apostrophe, Comma, Point, Space};
        let [decimal, grouped, open] = [self.decimal, self.grouped, self.open]
            .map(|of| move |mark: Thousands| of[mark as usize]);
        let by_numbers = || {
            let says_point = decimal(Point) || grouped(Comma);
            let says_comma = decimal(Comma) || grouped(Point);
            // Where commas divide the fields, those in a quoted number may divide its thousands.
            let may_be_comma = open(Comma) && !open(Point) && separator != Separator::Comma;
            !says_point && (says_comma || may_be_comma)
        };
        let by_thousands = match thousands {
            Some(Point) => Some(true),
            Some(Comma) => Some(false),
            Some(Apostrophe | Space) | None => None,
        };
        let is_comma = decimal_comma.or(by_thousands).unwrap_or_else(by_numbers);
        let is_known = decimal(Point) || decimal(Comma) || Thousands::ALL.into_iter().any(grouped);
        let is_said = decimal_comma.is_some() || thousands.is_some();
        // Who divides fields by commas writes decimals with points.
        let is_point_open = open(Point) && separator != Separator::Comma;
        let is_open = !is_known && !is_said && (is_point_open || open(Comma));
        let other = if is_comma { Point } else { Comma };
        let found = || match () {
            () if grouped(Apostrophe) => Some(Apostrophe),
            () if grouped(Space) => Some(Space),
            // A point is not read as a decimal sign where the user has said that a comma is.
            () if decimal_comma == Some(true) => Some(Point),
            () if grouped(other) || (open(other) && (is_known || is_said)) => Some(other),
            () => None,
        };
        Signs { decimal_comma: is_comma, thousands: thousands.or_else(found), is_open }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_number_says_what_its_marks_are() {
        use Thousands::{Apostrophe, Comma, Point, Space};
        for (text, expected) in [
            ("1.860", Use::Open(Point)),
            ("-1,860", Use::Open(Comma)),
            ("0.860", Use::Decimal(Point)),
            ("1860.125", Use::Decimal(Point)),
            ("1.86", Use::Decimal(Point)),
            ("1.860e3", Use::Decimal(Point)),
            (",5", Use::Decimal(Comma)),
            ("1.860,5", Use::Grouped(Point, Some(Comma))),
            ("1,860,000.25", Use::Grouped(Comma, Some(Point))),
            ("12.345.678", Use::Grouped(Point, None)),
            ("1'860", Use::Grouped(Apostrophe, None)),
            ("1\u{a0}860,5", Use::Grouped(Space, Some(Comma))),
            ("17.03.2026", Use::Nothing),
            ("12:59:59.9", Use::Nothing),
            ("1.000,5.1", Use::Nothing),
            ("2026", Use::Nothing),
            (".", Use::Nothing),
            ("", Use::Nothing),
        ] {
            assert_eq!(use_of(text), expected, "{text:?}");
        }
    }

    #[test]
    fn marks_between_thousands_are_removed_and_nowhere_else() {
        let removed = |mark: Thousands, text: &str, comma: bool| {
            mark.removed(text, comma).map(Cow::into_owned)
        };
        let is = |text: &str| Some(text.to_owned());
        assert_eq!(removed(Thousands::Point, "-1.860,5", true), is("-1860,5"));
        assert_eq!(removed(Thousands::Comma, "1,860,000.5", false), is("1860000.5"));
        assert_eq!(removed(Thousands::Apostrophe, "1\u{2019}860", false), is("1860"));
        assert_eq!(removed(Thousands::Point, "860,5", true), is("860,5"));
        assert_eq!(removed(Thousands::Point, "0.5", true), None);
        assert_eq!(removed(Thousands::Point, "1860.5", true), None);
    }

    #[test]
    fn a_table_says_its_signs_or_leaves_them_open() {
        use Thousands::{Apostrophe, Comma, Point};
        for (numbers, decimal_comma, thousands, is_open) in [
            (&["0", "1.860"][..], false, None, true),
            (&["0", "1,860"], true, None, true),
            (&["0.5", "1.860"], false, None, false),
            (&["0,5", "1.860"], true, Some(Point), false),
            (&["0.5", "1,860"], false, Some(Comma), false),
            (&["1.860.000", "1.860"], true, Some(Point), false),
            (&["1'860", "1.860"], false, Some(Apostrophe), false),
            (&["7", "8"], false, None, false),
        ] {
            let mut marks = Marks::default();
            numbers.iter().for_each(|number| marks.add(number));
            let signs = marks.signs(Separator::Semicolon, None, None);
            assert_eq!(signs, Signs { decimal_comma, thousands, is_open }, "{numbers:?}");
        }
        let mut marks = Marks::default();
        marks.add("1.860");
        let between_commas = marks.signs(Separator::Comma, None, None);
        let points = Signs { decimal_comma: false, thousands: None, is_open: false };
        assert_eq!(between_commas, points);
        let said =
            |decimal_comma, thousands| marks.signs(Separator::Semicolon, decimal_comma, thousands);
        let read = |decimal_comma, thousands| Signs { decimal_comma, thousands, is_open: false };
        assert_eq!(said(Some(false), None), read(false, None));
        assert_eq!(said(Some(true), None), read(true, Some(Point)));
        assert_eq!(said(None, Some(Point)), read(true, Some(Point)));
    }
}
