//! Reads an evidence file. Its key names contain the units; another unit of the same quantity may
//! stand in a key, such as `speed_before_km_h`.
//!
//! ```toml
//! case = "B 27"
//!
//! [road]                            # optional, as everything but struck_car, striking_car, damage
//! friction = 0.72
//! friction_sigma = 0.04
//! drag_factor = 0.66                # of locked wheels, instead of a peak friction or beside it
//! grade_percent = 4                 # uphill along X; and cross_slope_percent, rising to the left
//!
//! [struck_car]                      # mass_kg, or a data sheet (--vehicle)
//! mass_kg = 1520
//! mass_sigma_kg = 30
//! cg_to_front_axle_m = 1.25         # and cg_to_rear_axle_m, track_m, cg_height_m, length_m,
//! cg_to_rear_axle_m = 1.45          # width_m, yaw_inertia_kg_m2
//!
//! [striking_car]
//! mass_kg = 1900
//!
//! [weighing]                        # if one scale weighed both cars: its error as a share; the
//! shared_scale_sigma = 0.01         # mass_sigma_kg are those of the other errors
//!
//! [damage]
//! side = "right"                    # left, right, front, rear
//! x_m = -1.7                        # along the side, from the CG; y_m at front and rear
//! x_sigma_m = 0.1
//! y_m = -0.9                        # the other coordinate, optional
//! angle_deg = 20                    # heading of the striking car against the struck car
//! angle_sigma_deg = 10
//!
//! [skid_before]                     # and [striking_skid_before]
//! length_m = 18.5                   # to first contact
//! locked_wheels = ["FL", "FR"]      # all four if not given
//! # drag_factor = 0.7               # of this skid, else by the road; grade = 0.03
//!
//! [rest]                            # and [striking_rest]
//! x_m = 41.2
//! y_m = -6.3
//! position_sigma_m = 0.15
//! heading_rad = 2.9                 # whole turns do not count
//! heading_sigma_rad = 0.035
//! # known = false                   # the car was moved
//! # stopped_by = "obstacle"         # a pole, a kerb, a third car: the rest is left out
//!
//! [after]                           # and [striking_after]
//! blocked_wheels = ["RR"]           # locked: FL, FR, RL, RR; [] if all turn
//! dragging_wheels = ["RL"]          # turn, but are held back by the damage
//! driver_braked = "unknown"         # yes, no: the car coasts
//! anti_lock = "unknown"             # yes, no: wheels that are braked too hard lock
//!
//! [[mark]]                          # and [[striking_mark]]
//! wheel = "RR"
//! kind = "locked"                   # side-slip
//! points_m = [[1.0, -0.7], [6.0, -0.8], [11.0, -1.6]]   # from start to end
//! sigma_m = 0.1
//!
//! [edr]                             # and [striking_edr]
//! delta_v_y_min_m_s = 1.0           # and delta_v_x_…, heading axes of the car
//! delta_v_y_max_m_s = 1.3
//! speed_before_m_s = 21.4
//! speed_before_sigma_m_s = 0.9
//! sensor_x_m = 0.2                  # from the CG; and sensor_y_m
//! ends_s = 0.25                     # where the record is cut off
//!
//! [[position]]                      # from a video
//! time_s = 1.2
//! x_m = 20.1
//! y_m = -2.0
//! sigma_m = 0.3
//!
//! [prior]                           # ranges, each value inside equally likely
//! target_speed_m_s = [5, 45]
//! bullet_brake_start_s = [0, 0.1]   # and brake_start_s, brake_share, bullet_brake_share
//! ```
//!
//! A single car that struck nothing has `[car]` for `[struck_car]`, `[wheels]` for `[after]`, nothing of an
//! impact or of another car, and
//!
//! ```toml
//! kind = "single_car"
//!
//! [start]                           # time 0; by the mark that begins first if not given
//! x_m = 0.0
//! y_m = 0.0
//! heading_deg = 0
//! speed_m_s = [5, 45]               # ranges: and sideslip_deg, yaw_rate_deg_s, road_wheel_deg,
//! brake_start_s = [0, 0.1]          # brake_share, braked_before_s, braked_before_share
//!
//! [[recorded_speed]]
//! time_s = 0.0                      # after the start
//! speed_km_h = 92
//! ```

use std::path::Path;

use impactlab_core::data::{TomlError, TomlFile, TomlTable};

use crate::evidence::complete::{lack_of, twice};
use crate::evidence::start;
use crate::evidence::{
    Bounds, Choice, Evidence, EvidenceKind, Field, Fields, Item, Items, PointsMut, Section, Sigma,
    Word,
};

/// What stands in place of an item of a collision in the evidence of a single car.
const NOT_OF_SINGLE_CAR: [(&str, &str); 13] = [
    ("struck_car", "[car]"),
    ("after", "[wheels]"),
    ("prior", "[start], which has the ranges of a single car"),
    ("edr", "[[recorded_speed]] for a speed, and no Δv without an impact"),
    ("striking_edr", NOTHING),
    ("damage", NOTHING),
    ("striking_car", NOTHING),
    ("weighing", NOTHING),
    ("skid_before", "[[mark]], [rest] and [wheels], since there is no impact to end the skid"),
    ("striking_skid_before", NOTHING),
    ("striking_rest", NOTHING),
    ("striking_after", NOTHING),
    ("striking_mark", NOTHING),
];
const NOTHING: &str = "nothing: a single car strikes nothing and is struck by nothing";

/// The same of an item of a single car in the evidence of a collision.
const NOT_OF_COLLISION: [(&str, &str); 4] = [
    ("car", "[struck_car], or kind = \"single_car\" at the top of the file"),
    ("start", ONLY_SINGLE),
    ("wheels", "[after], or kind = \"single_car\" at the top of the file"),
    ("recorded_speed", ONLY_SINGLE),
];
const ONLY_SINGLE: &str = "it with kind = \"single_car\" at the top of the file only";

/// Distance from the first point of a mark within which its start may be repeated, m.
const START_REACH_M: f64 = 0.5;

impl Evidence {
    /// Reads an evidence file.
    ///
    /// # Errors
    /// [`TomlError`] with file, line, key and what is expected.
    pub fn load(path: &Path) -> Result<Self, TomlError> {
        let text = TomlFile::read(path)?;
        Self::from_toml(TomlFile { path, text: &text })
    }

    /// Reads an evidence file that may still lack what nothing can stand in for, such as one with the record of a
    /// recorder alone; [`Evidence::missing`] says what that is.
    ///
    /// # Errors
    /// As for [`Evidence::load`], but not for a key or a table that is missing.
    pub fn load_draft(path: &Path) -> Result<Self, TomlError> {
        let text = TomlFile::read(path)?;
        Self::read(TomlFile { path, text: &text }, true)
    }

    /// Reads the text of an evidence file.
    ///
    /// # Errors
    /// The errors of [`Evidence::load`] except [`TomlError::File`].
    pub fn from_toml(file: TomlFile<'_>) -> Result<Self, TomlError> {
        Self::read(file, false)
    }

    /// - `is_draft`: whether it may lack what nothing can stand in for.
    fn read(file: TomlFile<'_>, is_draft: bool) -> Result<Self, TomlError> {
        let root = file.parse()?;
        let mut top = TomlTable::root(file, &root);
        let case = top.string("case")?.unwrap_or_else(|| file.name());
        let kind = kind_of(file, &mut top)?;
        let mut evidence = Self { case, kind, ..Self::default() };
        let mut reader = Reader { table: top, error: None, is_draft };
        evidence.items(&mut reader);
        let top = reader.end()?;
        if !is_draft && evidence.lacks_start() {
            return Err(top.missing(&format!("{}.x_m", start::SECTION.key)));
        }
        top.finish().map(|()| evidence)
    }
}

/// What the evidence is of.
///
/// # Errors
/// That of a table which evidence of that kind does not have.
fn kind_of(file: TomlFile<'_>, top: &mut TomlTable<'_>) -> Result<EvidenceKind, TomlError> {
    let words = EvidenceKind::ALL.map(EvidenceKind::word);
    let chosen = top.choice("kind", &words)?.and_then(|idx| EvidenceKind::ALL.get(idx).copied());
    let kind = chosen.unwrap_or_default();
    let foreign = match kind {
        EvidenceKind::Collision => &NOT_OF_COLLISION[..],
        EvidenceKind::SingleCar => &NOT_OF_SINGLE_CAR[..],
    };
    let keys = file.top_level_keys();
    match foreign.iter().find(|(key, _)| keys.iter().any(|of| of == key)) {
        Some((key, expected)) => {
            // Whatever it is, it is the value that was read last.
            let _ = top.optional_table(key);
            Err(top.refuse_last(expected))
        }
        None => Ok(kind),
    }
}

/// Reads a file or the table of an item until the first error.
struct Reader<'a> {
    table: TomlTable<'a>,
    error: Option<TomlError>,
    /// Whether it may lack what nothing can stand in for.
    is_draft: bool,
}

impl<'a> Reader<'a> {
    /// What a step gives unless there has been an error.
    fn step<T>(
        &mut self,
        step: impl FnOnce(&mut TomlTable<'a>) -> Result<Option<T>, TomlError>,
    ) -> Option<T> {
        if self.error.is_some() {
            return None;
        }
        step(&mut self.table).unwrap_or_else(|error| {
            self.error = Some(error);
            None
        })
    }

    /// The table, unless there has been an error.
    fn end(self) -> Result<TomlTable<'a>, TomlError> {
        self.error.map_or(Ok(self.table), Err)
    }
}

impl Items for Reader<'_> {
    fn item(&mut self, section: &'static Section, _: Option<usize>, item: &mut impl Item) {
        let is_draft = self.is_draft;
        let found = self.step(|top| {
            let table = match section.is_required && !is_draft {
                true => Some(top.table(section.key)?),
                false => top.optional_table(section.key)?,
            };
            table.map_or(Ok(None), |table| read_item(table, is_draft))
        });
        if let Some(found) = found {
            *item = found;
        }
    }

    fn optional<T: Item>(&mut self, section: &'static Section, item: &mut Option<T>) {
        let is_draft = self.is_draft;
        *item = self.step(|top| {
            let table = top.optional_table(section.key)?;
            table.map_or(Ok(None), |table| read_item(table, is_draft))
        });
        *item = item.take().filter(|item| !item.is_empty());
    }

    fn many<T: Item>(&mut self, section: &'static Section, items: &mut Vec<T>) {
        let is_draft = self.is_draft;
        let found = self.step(|top| {
            let tables = top.tables(section.key)?.into_iter();
            let found = tables.map(|table| read_item(table, is_draft));
            let found: Vec<T> = found.filter_map(Result::transpose).collect::<Result<_, _>>()?;
            match twice(&found) {
                None => Ok(Some(found)),
                Some([first, second]) => Err(top.refuse_last(&format!(
                    "each of them once: number {second} is number {first} again, and would count as found by itself"
                ))),
            }
        });
        *items = found.unwrap_or_default();
    }
}

/// Reads an item; `None` if the table says that it is not known.
///
/// - `is_draft`: whether it may lack what nothing can stand in for.
fn read_item<T: Item>(mut table: TomlTable<'_>, is_draft: bool) -> Result<Option<T>, TomlError> {
    let is_known = table.flag("known")?.unwrap_or(true);
    let mut item = T::default();
    let mut reader = Reader { table, error: None, is_draft };
    item.fields(&mut reader);
    let table = reader.end()?;
    if !is_known {
        return table.finish().map(|()| None);
    }
    if let Some(lack) = lack_of(&item).filter(|_| !is_draft) {
        return Err(table.missing(&lack.key));
    }
    table.finish().map(|()| Some(item))
}

impl Fields for Reader<'_> {
    fn number(&mut self, field: &Field, value: &mut Option<f64>) {
        *value = self.step(|table| {
            table.number(field.key, &field.range).map_err(|error| match (field.expected, error) {
                ("", error) => error,
                (_, TomlError::Value { .. }) => table.refuse_last(field.expected),
                (_, error) => error,
            })
        });
    }

    fn points(&mut self, field: &Field, sigma: &Sigma, points: PointsMut<'_>) {
        let found = self.step(|table| {
            let start_m = table.point("start_m", &field.range)?;
            let key = field.si_key();
            let Some(points_m) = table.points(&key, &field.range)? else {
                return Err(table.missing(&key));
            };
            let is_near = |start: [f64; 2]| {
                points_m.first().is_some_and(|first| {
                    (start[0] - first[0]).hypot(start[1] - first[1]) < START_REACH_M
                })
            };
            let expected = match points_m.len() {
                0 | 1 => "at least two points [x, y], the start and the end",
                _ if points_m.windows(2).all(|pair| pair[0] == pair[1]) => {
                    "points that differ, the start and the end"
                }
                _ if start_m.is_some_and(|start| !is_near(start)) => "points that begin at start_m",
                _ => return Ok(Some(points_m)),
            };
            Err(table.refuse_last(expected))
        });
        *points.points_m = found.unwrap_or_default();
        self.number(&sigma.field, points.sigma_m);
    }

    fn bounds(&mut self, field: &Field, bounds: &mut Option<Bounds>) {
        *bounds = self.step(|table| {
            let low = table.number(&format!("{}_min", field.key), &field.range)?;
            let high = table.number(&format!("{}_max", field.key), &field.range)?;
            match (low, high) {
                (None, None) => Ok(None),
                (Some(low), Some(high)) if low > high => {
                    Err(table.refuse_last(&format!("{}_min or more", field.key)))
                }
                ends => Ok(Some(ends.into())),
            }
        });
    }

    fn interval(&mut self, field: &Field, interval: &mut Option<Bounds>) {
        let found = self.step(|table| table.interval(field.key, &field.range));
        *interval = found.map(|ends| ends.map(Some));
    }

    fn choice<W: Word>(&mut self, choice: &Choice, word: &mut W) {
        let mut chosen = None;
        self.optional_choice(choice, &mut chosen);
        *word = chosen.unwrap_or(*word);
    }

    fn optional_choice<W: Word>(&mut self, choice: &Choice, word: &mut Option<W>) {
        let words: Vec<&str> = W::ALL.iter().map(|word| word.word()).collect();
        let is_required = choice.is_required && !self.is_draft;
        *word = self.step(|table| match table.choice(choice.key, &words)? {
            None if is_required => Err(table.missing(choice.key)),
            idx => Ok(idx.map(|idx| W::ALL[idx])),
        });
    }

    fn choices<W: Word>(&mut self, choice: &Choice, chosen: &mut Option<Vec<W>>) {
        let words: Vec<&str> = W::ALL.iter().map(|word| word.word()).collect();
        let found = self.step(|table| table.choices(choice.key, &words));
        *chosen = found.map(|found| found.into_iter().map(|idx| W::ALL[idx]).collect());
    }
}

#[cfg(test)]
#[path = "read_tests.rs"]
mod tests;
