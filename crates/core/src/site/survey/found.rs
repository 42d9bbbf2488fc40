//! What a file of lines and points has, before it is turned into a ground.

use std::collections::BTreeMap;
use std::path::Path;

use crate::data::{MAX_DRAWING_OBJECTS, MAX_DRAWING_POINTS};
use crate::site::{LengthUnit, MapShape, SiteError};

/// What was found in a file.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// Lines, areas and points, in their order.
    pub things: Vec<Thing>,
    /// Whether their coordinates are `[longitude, latitude]`, degrees; else `[easting, northing]`, m.
    pub is_geographic: bool,
    /// Whether nothing but their size says so, and they may be lengths of a local grid as well.
    pub may_be_grid: bool,
    /// Whether easting and northing were turned into metres already.
    pub is_in_metres: bool,
    /// How much of each kind is left out.
    pub left_out: BTreeMap<String, usize>,
    /// What whoever reads the file has to know.
    pub notes: Vec<String>,
    pub(super) n_points: usize,
}

/// A line, an area or a point of a file.
#[derive(Debug, Default)]
pub(super) struct Thing {
    pub name: String,
    pub shape: MapShape,
    /// In the coordinates of the file; of an area without the repeated last corner.
    pub at: Vec<[f64; 2]>,
    /// Of a point, m; of a file in a grid in its unit until its frame is known.
    pub height_m: Option<f64>,
    /// Properties that say what it is, by their names in small letters.
    pub properties: BTreeMap<String, String>,
    /// Line of the file, from 1, if that is known.
    pub line: Option<u64>,
}

/// Properties that are kept.
pub(super) const PROPERTIES: [&str; 7] =
    ["impactlab", "friction", "n_left", "left", "right", "code", "layer"];

/// Longest name or property that is kept, characters.
const MAX_TEXT: usize = 200;

impl Found {
    /// Adds a thing; an empty one is left out and counted.
    ///
    /// # Errors
    /// [`SiteError::TooManyPoints`], [`SiteError::TooManyObjects`].
    pub fn add(&mut self, path: &Path, mut thing: Thing) -> Result<(), SiteError> {
        self.n_points += thing.at.len();
        if self.n_points > MAX_DRAWING_POINTS {
            let (path, limit) = (path.to_owned(), MAX_DRAWING_POINTS);
            return Err(SiteError::TooManyPoints { path, limit });
        }
        if self.things.len() >= MAX_DRAWING_OBJECTS {
            let (path, got) = (path.to_owned(), self.things.len() + 1);
            return Err(SiteError::TooManyObjects { path, got, limit: MAX_DRAWING_OBJECTS });
        }
        thing.name = kept_text(&thing.name);
        if thing.shape == MapShape::Area
            && thing.at.len() > 1
            && thing.at.first() == thing.at.last()
        {
            thing.at.pop();
        }
        if thing.shape != MapShape::Area {
            thing.at.dedup();
        }
        match thing.at.len() {
            0 => self.leave_out("without coordinates"),
            _ => self.things.push(thing),
        }
        Ok(())
    }

    /// Counts something that is left out.
    pub fn leave_out(&mut self, kind: &str) {
        *self.left_out.entry(kind.to_owned()).or_default() += 1;
    }
}

/// A text without blanks at its ends and control characters, and not longer than a person reads.
pub(super) fn kept_text(text: &str) -> String {
    text.trim().chars().filter(|letter| !letter.is_control()).take(MAX_TEXT).collect()
}

/// A message of a reader that may quote the file, cut to what a person reads.
pub(super) fn wrong(path: &Path, line: Option<u64>, message: &dyn std::fmt::Display) -> SiteError {
    let place = line.map(|line| format!(":{line}")).unwrap_or_default();
    let message = message.to_string().chars().take(400).collect();
    SiteError::Survey { path: path.to_owned(), place, message }
}

/// Other spellings of units at the end of a header.
const SPELLINGS: [(&str, &str); 8] = [
    ("us survey feet", "us_survey_ft"),
    ("us survey ft", "us_survey_ft"),
    ("us feet", "us_survey_ft"),
    ("us ft", "us_survey_ft"),
    ("usft", "us_survey_ft"),
    ("feet", "ft"),
    ("metres", "m"),
    ("meters", "m"),
];

/// The unit of a word at the end of a header, such as `E [m]` or `northing_ft`, and what stands before it.
pub(super) fn name_and_unit(header: &str) -> (String, Option<LengthUnit>) {
    let mut header = header.trim().trim_matches('"').to_lowercase();
    let bare = header.trim_end_matches([']', ')']);
    let other = SPELLINGS.iter().find_map(|(end, word)| Some((bare.strip_suffix(end)?, word)));
    if let Some((before, word)) = other {
        header = format!("{before}{word}");
    }
    let ends = LengthUnit::WORDS.iter().zip(LengthUnit::ALL).filter_map(|(word, unit)| {
        let bare = header.trim_end_matches([']', ')']);
        let before = bare.strip_suffix(word)?;
        let name = before.trim_end_matches(['[', '(', '_', ' ']);
        (name.len() < before.len()).then(|| (name.to_owned(), unit))
    });
    // The longest word: `us_survey_ft` ends with `ft`, too.
    match ends.min_by_key(|(name, _)| name.len()) {
        Some((name, unit)) => (name.trim().to_owned(), Some(unit)),
        None => (header, None),
    }
}
