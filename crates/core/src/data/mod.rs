//! Reads and writes files. Everything foreign becomes checked time series in SI units here, and
//! time series become files.
//!
//! - A delimited text file becomes a [`Table`], whose [`Dialect`] is determined from its first
//!   lines; its columns become the channels of a [`TimeSeries`] by their headers or by a
//!   [`ColumnMap`].
//! - [`read_force_file`], [`read_trajectory_file`], [`read_motion_log`] and [`read_steer_file`]
//!   read single files, [`Dataset`] reads a folder of cases, and [`open`](open()) decides what a
//!   path holds.
//! - [`ForceHistory`], [`contact_interval`] and [`check_case`] give impulse, contact and quality of
//!   what was read.
//! - [`TomlFile`] and [`TomlTable`] read settings; [`mod@write`] writes files and folders.

mod antenna;
mod attributes;
mod budget;
mod case_attributes;
mod case_braking;
mod case_steering;
mod channel;
mod clock;
mod column_map;
mod columns;
mod computed;
mod consistency;
mod contact;
mod correction;
mod corrections;
mod course;
mod dataset;
mod degree_text;
mod degrees;
mod dialect;
mod doubts;
mod error;
mod file;
mod force_history;
mod foreign;
mod formats;
mod formula;
mod geographic;
mod header;
mod impulse;
mod json;
mod letters;
mod loose;
mod mapped_column;
mod marks;
mod no_samples;
mod note;
mod open;
mod path_speed;
mod placeholders;
mod proposals;
mod quality;
mod quality_jumps;
mod quality_motion;
mod quality_phrase;
mod read_settings;
#[cfg(test)]
mod read_tests;
mod refused;
mod rows;
mod series;
mod si_values;
mod signals;
mod slow_columns;
mod spelling;
mod stated_side;
mod steering;
mod table;
mod text;
mod time_columns;
mod time_of_day;
mod toml_file;
mod toml_table;
mod vbo;
mod velocity_fit;
mod workbook;
pub mod write;
mod yaw_rate;

pub use attributes::{Attributes, Value};
pub use budget::{
    MAX_CASE_CELLS, MAX_CASES, MAX_CASES_BYTES, MAX_CELL_BYTES, MAX_CLOUD_BYTES, MAX_COLUMNS,
    MAX_DATASET_BYTES, MAX_DRAWING_BYTES, MAX_DRAWING_OBJECTS, MAX_DRAWING_POINTS, MAX_LINE_BYTES,
    MAX_MODEL_BYTES, MAX_PICTURE_BYTES, MAX_PICTURE_PIXELS, MAX_PICTURE_SIDE, MAX_RASTER_PIXELS,
    MAX_RESULTS_BYTES, MAX_SETTINGS_BYTES, MAX_SURVEY_BYTES, MAX_TABLE_BYTES, MAX_WORKBOOK_BYTES,
};
pub use case_attributes::{AttributeColumn, ForceAttributes, StruckSide, TrajectoryAttributes};
pub use case_braking::CaseBraking;
pub use case_steering::CaseSteering;
pub use channel::Channel;
pub use column_map::{ColumnMap, ColumnRef, ColumnSource, MapError, SignedColumn};
pub(crate) use columns::Columns;
pub use columns::{ColumnUse, Term};
pub use consistency::{Contradiction, contradictions};
pub use contact::{
    CONTACT_SHARE_OF_PEAK, ContactOutside, MIN_GAP_S, TIME_TOLERANCE_S, check_contact_within,
    contact_interval, contact_pulses, cut_at_s,
};
pub use correction::Correction;
pub use dataset::{CASES_FILE, Case, Dataset, DatasetKind, Outcome};
pub(crate) use dataset::{named_cases, names_a_file};
pub use dialect::{Dialect, Separator};
pub use error::{DataError, Place};
pub use file::{list_folder, open_file, read_bytes, read_utf8, without_byte_order_mark};
pub use force_history::{CumulativeImpulse, ForceAxes, ForceHistory, Sampling};
pub use foreign::is_gltf;
pub use formats::{
    BarrierForce, BarrierMomentum, CrashTest, RecordedControls, RecordedDeltaV, RecordedSide,
    RecordedSides, RecordedSpeed, RecorderRecord, TestChannel, TestVehicle,
};
pub use formats::{DeckUnits, ModelStart, parts_beside};
pub use formula::{Formula, FormulaPart};
pub use geographic::GeographicPlace;
pub use json::{finite_or_null, finite_or_nulls, null_as_nan, nulls_as_nan};
pub use loose::{
    FileKind, Loaded, read_any_series, read_force_file, read_motion_log, read_series,
    read_steer_file, read_trajectory_file, read_wheels_file, series_of_table,
};
pub use marks::Thousands;
pub use note::Note;
pub use open::{Opened, open};
pub use path_speed::{PathSpeed, path_speed};
pub use proposals::{ColumnProposal, map_from_proposals, proposals, propose_columns};
pub use quality::{Flag, FlagKind, Severity, check_case, check_file, check_series};
pub use read_settings::{HeaderLine, ReadSettings, SheetRef, VelocityAxes};
pub use series::{SeriesError, TimeSeries};
pub use table::Table;
pub use toml_file::{TomlError, TomlFile};
pub use toml_table::{TomlTable, key_with_unit};
pub use velocity_fit::{VelocityFit, velocity_fit};
pub use workbook::{ARCHIVE_START, Sheet};
pub use write::{
    Existing, RESTRICTIONS_COLUMN, check_target, write_atomically, write_bytes,
    write_restricted_series_csv, write_restricted_series_parquet, write_restricted_table,
    write_series_csv,
};
