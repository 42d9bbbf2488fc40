//! How a report is written: language, units, paper, date.

use std::fmt;
use std::str::FromStr;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use impactlab_core::units::{Language, UnitSystem};

/// Size of the pages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Paper {
    /// 210 mm × 297 mm.
    #[default]
    A4,
    /// 8.5 in × 11 in.
    Letter,
}

/// A day of the calendar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct ReportDate {
    year: u16,
    month: u8,
    day: u8,
}

/// How a report is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReportSettings {
    /// Language.
    pub language: Language,
    /// Units of the numbers.
    pub units: UnitSystem,
    /// Size of the pages.
    pub paper: Paper,
    /// The date that it bears.
    pub date: ReportDate,
}

/// A text that is no day of the calendar.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{text:?} is no day, expected YYYY-MM-DD")]
pub struct DateError {
    text: String,
}

impl Paper {
    /// The paper that is usual where the units are.
    pub fn usual(units: UnitSystem) -> Self {
        match units {
            UnitSystem::Si => Self::A4,
            UnitSystem::Us => Self::Letter,
        }
    }

    /// Width and height, points of 1/72 in.
    pub fn size_pt(self) -> [f32; 2] {
        match self {
            Self::A4 => [595.276, 841.89],
            Self::Letter => [612.0, 792.0],
        }
    }
}

impl ReportDate {
    /// A day; `None` if there is none such.
    pub fn new(year: u16, month: u8, day: u8) -> Option<Self> {
        let is_leap =
            (year.is_multiple_of(4) && !year.is_multiple_of(100)) || year.is_multiple_of(400);
        let days = match month {
            2 if is_leap => 29,
            2 => 28,
            4 | 6 | 9 | 11 => 30,
            1..=12 => 31,
            _ => 0,
        };
        let is_day = (1..=9999).contains(&year) && (1..=days).contains(&day);
        is_day.then_some(Self { year, month, day })
    }

    /// The day of an instant, in UTC; `None` outside of the years 1 to 9999.
    pub fn from_instant(instant: SystemTime) -> Option<Self> {
        instant.duration_since(SystemTime::UNIX_EPOCH).ok()?;
        humantime::format_rfc3339_seconds(instant).to_string().get(..10)?.parse().ok()
    }

    /// Year, month and day.
    pub fn parts(self) -> (u16, u8, u8) {
        (self.year, self.month, self.day)
    }

    /// The day as a language writes it.
    pub(super) fn written(self, language: Language) -> String {
        let Self { year, month, day } = self;
        match language {
            Language::En => self.to_string(),
            Language::De => format!("{day:02}.{month:02}.{year:04}"),
        }
    }
}

impl fmt::Display for ReportDate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { year, month, day } = self;
        write!(f, "{year:04}-{month:02}-{day:02}")
    }
}

impl FromStr for ReportDate {
    type Err = DateError;

    fn from_str(text: &str) -> Result<Self, DateError> {
        let parse = || {
            let mut parts = text.splitn(3, '-');
            let (year, month, day) = (parts.next()?, parts.next()?, parts.next()?);
            let is_plain = [(year, 4), (month, 2), (day, 2)]
                .iter()
                .all(|(part, n)| part.len() == *n && part.bytes().all(|b| b.is_ascii_digit()));
            let day = Self::new(year.parse().ok()?, month.parse().ok()?, day.parse().ok()?)?;
            is_plain.then_some(day)
        };
        parse().ok_or_else(|| DateError { text: text.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_days_of_the_calendar_are_days() {
        let date: ReportDate = "2026-11-24".parse().unwrap();
        assert_eq!(date.to_string(), "2026-11-24");
        assert_eq!(date.written(Language::De), "24.11.2026");
        assert!("2024-02-29".parse::<ReportDate>().is_ok());
        let second = std::time::Duration::from_secs(1_782_000_000);
        let of_instant = ReportDate::from_instant(SystemTime::UNIX_EPOCH + second).unwrap();
        assert_eq!(of_instant.to_string(), "2026-06-21");
        assert_eq!(ReportDate::from_instant(SystemTime::UNIX_EPOCH - second), None);
        for text in [
            "2026-02-29",
            "2026-13-01",
            "2026-1-1",
            "0000-01-01",
            "heute",
            "2026-11-24Z",
            "+026-01-01",
        ] {
            assert!(text.parse::<ReportDate>().is_err(), "{text}");
        }
    }
}
