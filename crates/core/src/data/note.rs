//! Remarks on a file that was read.

use std::fmt;
use std::path::PathBuf;

use crate::data::correction::one_of;
use crate::data::error::quoted;
use crate::data::{
    Channel, ColumnUse, Contradiction, Correction, PathSpeed, VelocityAxes, VelocityFit, clock,
    spelling,
};

/// Number of columns without a channel that a remark names.
const SHOWN_IGNORED: usize = 100;

/// Number of characters of a header that a remark shows.
const SHOWN_CHARS: usize = 60;

/// A remark on a file that was read, shown to the user.
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// The unit of a column is not stated, so that the SI unit was assumed.
    UnitAssumed(ColumnUse),
    /// A column was left out because its unit does not measure the channel. The channel is not
    /// needed; otherwise the file is refused.
    WrongUnit {
        /// The channel that the header names.
        channel: Channel,
        /// The number of the column, counted from 1.
        number: usize,
        /// The header of the column.
        name: String,
        /// The unit as written in the file.
        unit: String,
    },
    /// Columns whose headers name no channel were left out.
    Ignored {
        /// The headers of these columns.
        names: Vec<String>,
    },
    /// What the file says restricts its numbers: it was written by this program.
    Restrictions {
        /// The text of the column [`RESTRICTIONS_COLUMN`](crate::data::RESTRICTIONS_COLUMN).
        text: String,
    },
    /// Text to the right of the last column was left out.
    TextBeyond {
        /// The number of rows with such text.
        n_rows: usize,
    },
    /// The two components of a vector are stated in different units.
    MixedUnits {
        /// The component along x.
        x: ColumnUse,
        /// The component along y.
        y: ColumnUse,
    },
    /// The velocities do not fit the path in the axes in which they were read.
    Velocities {
        /// How they fit.
        fit: VelocityFit,
        /// The axes in which they were read.
        read_as: VelocityAxes,
        /// Changes of the map of which each makes them fit.
        corrections: Vec<Correction>,
    },
    /// Columns of a motion contradict each other.
    Contradiction {
        /// What contradicts what.
        found: Contradiction,
        /// Changes of the map of which each removes it.
        corrections: Vec<Correction>,
    },
    /// The speed that a file records is not that at which its path goes on.
    Speed {
        /// The file.
        path: PathBuf,
        /// Line of the row where they differ most, counted from 1.
        line: u64,
        /// The column of the speed, or that of v_x if the file gives components; counted from 1.
        column: usize,
        /// The header of this column.
        name: String,
        /// How they differ.
        found: PathSpeed,
        /// Changes of the map of which each removes the difference.
        corrections: Vec<Correction>,
    },
    /// The speed that a file records could not be compared with its path.
    SpeedUnchecked {
        /// Why, in words.
        why: String,
    },
    /// The file is of a format of its own.
    Format {
        /// What it is and how it is read, in words.
        text: String,
    },
    /// The file says, or its numbers say, that not all of it can be relied on.
    Doubt {
        /// What is in doubt, in words.
        text: String,
    },
    /// Positions follow from latitude and longitude.
    Places {
        /// Latitude and longitude of the first row, degrees.
        origin_deg: [f64; 2],
    },
    /// The seconds of the time begin again at 0, and were let go on.
    GoesOn {
        /// After so many of them, s.
        period_s: f64,
        /// How often they do.
        n_turns: usize,
    },
    /// The record begins at another instant than zero.
    Begins {
        /// Its first instant, s.
        first_s: f64,
    },
}

impl Note {
    /// Whether numbers that were read may be wrong, so that the user should be asked.
    pub fn is_doubt(&self) -> bool {
        match self {
            Self::UnitAssumed(_)
            | Self::MixedUnits { .. }
            | Self::Speed { .. }
            | Self::Doubt { .. } => true,
            Self::Begins { first_s } => clock::is_since_1970(*first_s),
            _ => self.is_contradiction(),
        }
    }

    /// Whether numbers that were read contradict each other, so that nothing can be made of them.
    pub fn is_contradiction(&self) -> bool {
        matches!(self, Self::Velocities { .. } | Self::Contradiction { .. })
    }

    /// Changes of the map of which each corrects what the remark says; the likeliest comes first.
    pub fn corrections(&self) -> Vec<Correction> {
        match self {
            Self::Velocities { corrections, .. }
            | Self::Contradiction { corrections, .. }
            | Self::Speed { corrections, .. } => corrections.clone(),
            Self::Begins { first_s } => vec![clock::shift_to_zero(*first_s)],
            _ => Vec::new(),
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnitAssumed(column) => write!(
                f,
                "column {} {:?} names no unit; taken as {}",
                column.number, column.name, column.unit.symbol
            ),
            Self::WrongUnit { channel, number, name, unit } => write!(
                f,
                "column {number} {name:?} is left out: {unit:?} is no unit of {}",
                spelling::quantity_name(channel.quantity())
            ),
            Self::Ignored { names } => {
                let shown: Vec<&str> =
                    names.iter().take(SHOWN_IGNORED).map(|name| beginning(name)).collect();
                write!(f, "not recognised: {}", shown.join(", "))?;
                match names.len().saturating_sub(SHOWN_IGNORED) {
                    0 => Ok(()),
                    more => write!(f, " and {more} more"),
                }
            }
            Self::MixedUnits { x, y } => write!(
                f,
                "column {} {:?} is read in {} and column {} {:?} in {}: two components of one \
                 vector are rarely recorded in different units; check the header",
                x.number, x.name, x.unit.symbol, y.number, y.name, y.unit.symbol
            ),
            Self::Restrictions { text } => write!(f, "the file says of itself: {text}"),
            Self::TextBeyond { n_rows } => {
                write!(f, "{n_rows} rows have text to the right of the last column; it is not read")
            }
            Self::Velocities { fit, read_as, corrections } => {
                fit.explain(*read_as, f)?;
                write_remedy(f, corrections, fit.advice())
            }
            Self::Contradiction { found, corrections } => {
                found.fmt(f)?;
                write_remedy(f, corrections, found.advice())
            }
            Self::Speed { path, line, column, name, found, corrections } => {
                write!(f, "{}:{line}:{column}: {} {found}", path.display(), quoted(name))?;
                write_remedy(f, corrections, "check its unit and the clock")
            }
            Self::SpeedUnchecked { why } => {
                write!(f, "the speed was not compared with the path: {why}")
            }
            Self::Format { text } | Self::Doubt { text } => f.write_str(text),
            Self::Places { origin_deg: [latitude, longitude] } => write!(
                f,
                "x and y are metres to the east and to the north of the first row (latitude {latitude}°, \
                 longitude {longitude}°), in the plane that touches the ellipsoid WGS 84 there"
            ),
            Self::GoesOn { period_s, n_turns } => {
                let times =
                    if *n_turns == 1 { "once".to_owned() } else { format!("{n_turns} times") };
                write!(
                    f,
                    "the seconds of the time begin again at 0 after {period_s} s, {times}; they were let go on"
                )
            }
            Self::Begins { first_s } => f.write_str(&clock::shift_text(*first_s)),
        }
    }
}

/// Writes the maps of which one helps, or what to do if none is known.
fn write_remedy(
    f: &mut fmt::Formatter<'_>,
    corrections: &[Correction],
    advice: &str,
) -> fmt::Result {
    match corrections {
        [] => write!(f, "; {advice}"),
        _ => write!(f, "; map {}", one_of(corrections)),
    }
}

/// The beginning of a header, as long as a remark shows it.
fn beginning(name: &str) -> &str {
    let end = name.char_indices().nth(SHOWN_CHARS).map(|(at, _)| at);
    end.and_then(|end| name.get(..end)).unwrap_or(name)
}
