//! Single force, trajectory and steer files of whatever origin.

use std::path::Path;

use crate::data::{
    Channel, ColumnMap, ColumnUse, Columns, DataError, Dialect, Note, Sampling, SeriesError, Table,
    TimeSeries,
};
use crate::units::Quantity;

/// Rows that a time series needs at least.
const MIN_ROWS: usize = 2;

/// What a file of time series is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// Contact force: time and `fx`, `fy`, or `fx_body`, `fy_body`.
    Force,
    /// Motion: time, `x` and `y`; a force beside them is welcome.
    Trajectory,
    /// Steering: time and `steer`, or `steer_fl` and `steer_fr`.
    Steer,
}

/// A file that was read, and how it was understood.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// What the file is about.
    pub kind: FileKind,
    /// Its columns in SI units.
    pub series: TimeSeries,
    /// Which column was taken for what, the time first.
    pub columns: Vec<ColumnUse>,
    /// What a person should know.
    pub notes: Vec<Note>,
    /// Separator and decimal sign of the file.
    pub dialect: Dialect,
    /// Its character encoding, such as `UTF-8`.
    pub encoding: &'static str,
}

impl Loaded {
    /// What a force sample of the file stands for. Our own finite-element files, known by the
    /// target's velocities, hold centred means; a trajectory's heading-axis force is the mean over
    /// the coming interval; anything else is taken as instants.
    pub fn force_sampling(&self) -> Sampling {
        if self.series.get(Channel::TargetVx).is_some() {
            Sampling::CentredMean
        } else if self.kind == FileKind::Trajectory && self.series.get(Channel::FxBody).is_some() {
            Sampling::ComingMean
        } else {
            Sampling::Instant
        }
    }
}

impl FileKind {
    /// From the most to the least specific.
    const ALL: [Self; 3] = [Self::Trajectory, Self::Force, Self::Steer];

    /// The pairs of channels of which one must be complete, beside the time.
    fn alternatives(self) -> &'static [&'static [Channel]] {
        match self {
            Self::Force => &[&[Channel::Fx, Channel::Fy], &[Channel::FxBody, Channel::FyBody]],
            Self::Trajectory => &[&[Channel::X, Channel::Y]],
            Self::Steer => &[&[Channel::Steer], &[Channel::SteerFl, Channel::SteerFr]],
        }
    }

    fn needed(self) -> &'static str {
        match self {
            Self::Force => "time, fx and fy (or fx_body and fy_body)",
            Self::Trajectory => "time, x and y",
            Self::Steer => "time and steer (or steer_fl and steer_fr)",
        }
    }

    fn example_map(self) -> &'static str {
        match self {
            Self::Force => "time=1:ms,fx=2:kN,fy=3:kN",
            Self::Trajectory => "time=1:s,x=2:m,y=3:m",
            Self::Steer => "time=1:s,steer=2:deg",
        }
    }

    /// The first needed channel that the columns lack, in the alternative that lacks least.
    fn first_missing(self, columns: &Columns) -> Option<Channel> {
        let is_missing = |channel: &&Channel| !columns.by_channel.contains_key(*channel);
        let n_missing = |needed: &&&[Channel]| needed.iter().filter(is_missing).count();
        let best = self.alternatives().iter().min_by_key(n_missing)?;
        let needed = [Channel::Time];
        needed.iter().chain(*best).find(is_missing).copied()
    }
}

/// Reads a contact force: time and the force ON the target, in world or body axes.
///
/// # Errors
/// [`DataError`], with the place in the file and what to do.
pub fn read_force_file(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    read_series(path, map, FileKind::Force)
}

/// Reads a motion: time, position, and whatever else is recognised.
///
/// # Errors
/// [`DataError`], with the place in the file and what to do.
pub fn read_trajectory_file(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    read_series(path, map, FileKind::Trajectory)
}

/// Reads a motion of which the heading is known too: time, position, yaw, and whatever else is
/// recognised.
///
/// # Errors
/// [`DataError`], with the place in the file and what to do.
pub fn read_motion_log(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    let table = Table::read(path)?;
    let columns = Columns::of(&table, map)?;
    let has_position = FileKind::Trajectory.first_missing(&columns).is_none();
    if has_position && !columns.by_channel.contains_key(&Channel::Yaw) {
        return Err(columns.missing(&table, Channel::Yaw, "time, x, y and yaw"));
    }
    load(&table, columns, FileKind::Trajectory, map.is_some())
}

/// Reads road-wheel angles over time.
///
/// # Errors
/// [`DataError`], with the place in the file and what to do.
pub fn read_steer_file(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    read_series(path, map, FileKind::Steer)
}

/// Reads a file of a known kind.
///
/// # Errors
/// [`DataError`], with the place in the file and what to do.
pub fn read_series(
    path: &Path,
    map: Option<&ColumnMap>,
    kind: FileKind,
) -> Result<Loaded, DataError> {
    let table = Table::read(path)?;
    let columns = Columns::of(&table, map)?;
    load(&table, columns, kind, map.is_some())
}

/// Reads a file of the kind that its columns make it.
///
/// # Errors
/// [`DataError`]; a file that is of no kind gives the error for a force file.
pub fn read_any_series(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    let table = Table::read(path)?;
    let columns = Columns::of(&table, map)?;
    let is_complete = |kind: &FileKind| kind.first_missing(&columns).is_none();
    let kind = FileKind::ALL.into_iter().find(is_complete);
    load(&table, columns, kind.unwrap_or(FileKind::Force), map.is_some())
}

fn load(
    table: &Table,
    columns: Columns,
    kind: FileKind,
    is_mapped: bool,
) -> Result<Loaded, DataError> {
    let (path, line) = (|| table.path().to_owned(), table.header_line());
    if !table.has_header() && !is_mapped {
        let example = kind.example_map();
        return Err(DataError::NoHeader { path: path(), line, example });
    }
    if let Some(channel) = kind.first_missing(&columns) {
        return Err(columns.missing(table, channel, kind.needed()));
    }
    if table.n_rows() < MIN_ROWS {
        let (expected, got) = (MIN_ROWS, table.n_rows());
        return Err(DataError::TooFewRows { path: path(), line, expected, got });
    }
    let mut series = TimeSeries::default();
    for column in columns.by_channel.values() {
        let values = si_values(table, column)?;
        match column.channel {
            Channel::Time => {
                let time = TimeSeries::new(values);
                series = time.map_err(|error| out_of_order(table, column, error))?;
            }
            channel => series
                .insert(channel, values)
                .map_err(|source| DataError::Series { path: path(), source })?,
        }
    }
    let Columns { by_channel, notes } = columns;
    let columns = by_channel.into_values().collect();
    Ok(Loaded {
        kind,
        series,
        columns,
        notes,
        dialect: table.dialect(),
        encoding: table.encoding(),
    })
}

fn si_values(table: &Table, column: &ColumnUse) -> Result<Vec<f64>, DataError> {
    let mut values = table.numbers(column.number - 1, column.unit.symbol)?;
    let limit = largest_plausible(column.channel.quantity());
    for (row_idx, value) in values.iter_mut().enumerate() {
        *value = column.unit.to_si(*value);
        if value.abs() > limit {
            return Err(DataError::ImplausibleValue {
                path: table.path().to_owned(),
                line: table.line(row_idx),
                column: column.number,
                name: column.name.clone(),
                value: *value,
                limit,
                unit: column.channel.quantity().si_unit().symbol,
            });
        }
    }
    Ok(values)
}

/// The largest magnitude, in SI units, that is taken for real; beyond it the unit is wrong. Wide on
/// purpose: what is merely unusual is for [`crate::data::check_series`].
fn largest_plausible(quantity: Quantity) -> f64 {
    match quantity {
        // Heavy trucks against rigid barriers reach a few MN; newtons read as kN exceed this.
        Quantity::Force => 2e7,
        Quantity::Moment => 1e8,
        // Faster than any road vehicle; a test track's 200 km/h read as m/s exceeds it.
        Quantity::Speed => 150.0,
        Quantity::Acceleration => 1e6,
        Quantity::AngularVelocity => 200.0,
        Quantity::Angle => 1e4,
        // National grids count up to 10⁷ m.
        Quantity::Length => 2e7,
        // Clocks that count seconds since 1970.
        Quantity::Time => 1e10,
        _ => f64::MAX,
    }
}

fn out_of_order(table: &Table, time: &ColumnUse, error: SeriesError) -> DataError {
    let path = table.path().to_owned();
    match error {
        SeriesError::TimeOrder { sample_idx, before, after } => DataError::TimeOrder {
            path,
            line: table.line(sample_idx),
            column: time.number,
            before_s: before,
            after_s: after,
        },
        source => DataError::Series { path, source },
    }
}
