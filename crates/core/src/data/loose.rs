//! Reads single files of a contact force, a motion or the controls over time, from any program
//! that writes delimited text. The columns are found by their headers or by a mapping of the user
//! and converted to SI units.

use std::path::Path;

use crate::data::refused::Refused;
use crate::data::si_values::{instants_s, si_values};
use crate::data::velocity_fit::in_body_axes;
use crate::data::{
    Channel, ColumnMap, ColumnRef, ColumnUse, Columns, DataError, Dialect, ModelStart, Note,
    ReadSettings, Sampling, Table, Thousands, TimeSeries, VelocityAxes, antenna, clock, computed,
    corrections, degrees, doubts, impulse, no_samples, slow_columns, steering,
};

/// Smallest number of rows of a time series.
const MIN_ROWS: usize = 2;

/// The content of a time-series file, which decides the channels that it must have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// A contact force: time with `fx` and `fy`, or with `fx_body` and `fy_body`.
    Force,
    /// A motion: time, `x` and `y`. It may contain a contact force too.
    Trajectory,
    /// Steering: time with `steer`, with `steer_fl` and `steer_fr`, or with `steering_wheel`.
    Steer,
    /// Brakes and drive: time with the torque of one wheel or more.
    Wheels,
}

/// A file that was read, with the interpretation of its columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The kind of the file.
    pub kind: FileKind,
    /// The columns of the file, SI units.
    pub series: TimeSeries,
    /// The columns that were read, with their channels and units; the time comes first.
    pub columns: Vec<ColumnUse>,
    /// Remarks on columns that were left out or whose unit was assumed.
    pub notes: Vec<Note>,
    /// Separator and decimal sign of the file.
    pub dialect: Dialect,
    /// Character encoding of the file, such as `UTF-8`.
    pub encoding: &'static str,
    /// Of a force of a finite-element run: the velocities with which its cars begin, where the file says them.
    pub model_start: Option<ModelStart>,
}

impl Loaded {
    /// What a sample of the contact force in the file stands for. Files of the program's own
    /// finite-element simulations, recognised by the velocity of the struck vehicle, hold means
    /// over centred intervals. A motion with a force in heading axes holds means over the coming
    /// interval. In any other file the samples are values at an instant.
    pub fn force_sampling(&self) -> Sampling {
        if self.series.get(Channel::StruckVx).is_some() {
            Sampling::CentredMean
        } else if self.kind == FileKind::Trajectory && self.series.get(Channel::FxBody).is_some() {
            Sampling::ComingMean
        } else {
            Sampling::Instant
        }
    }
}

impl Loaded {
    /// Checks that the columns of a motion do not contradict each other, before anything is made of it.
    ///
    /// # Errors
    /// [`DataError::Contradiction`] with what contradicts what, and what would mend it.
    pub fn check_consistent(&self, path: &Path) -> Result<(), DataError> {
        let found: Vec<String> =
            self.notes.iter().filter(|note| note.is_contradiction()).map(Note::to_string).collect();
        match found.is_empty() {
            true => Ok(()),
            false => {
                Err(DataError::Contradiction { path: path.to_owned(), what: found.join("; ") })
            }
        }
    }
}

impl FileKind {
    /// All kinds, the most specific first, in the order in which a file of unknown kind is tried.
    const ALL: [Self; 4] = [Self::Trajectory, Self::Force, Self::Steer, Self::Wheels];

    /// The sets of channels of which one must be complete, in addition to the time.
    fn alternatives(self) -> &'static [&'static [Channel]] {
        match self {
            Self::Force => &[&[Channel::Fx, Channel::Fy], &[Channel::FxBody, Channel::FyBody]],
            Self::Trajectory => &[&[Channel::X, Channel::Y]],
            Self::Steer => &[
                &[Channel::Steer],
                &[Channel::SteerFl, Channel::SteerFr],
                &[Channel::SteeringWheel],
            ],
            Self::Wheels => &[
                &[Channel::BrakeFl],
                &[Channel::BrakeFr],
                &[Channel::BrakeRl],
                &[Channel::BrakeRr],
                &[Channel::DriveFl],
                &[Channel::DriveFr],
                &[Channel::DriveRl],
                &[Channel::DriveRr],
            ],
        }
    }

    fn needed(self) -> &'static str {
        match self {
            Self::Force => "time, fx and fy (or fx_body and fy_body)",
            Self::Trajectory => "time, x and y",
            Self::Steer => "time and steer (or steer_fl and steer_fr, or steering_wheel)",
            Self::Wheels => "time and torques of wheels (brake_fl … brake_rr, drive_fl … drive_rr)",
        }
    }

    fn example_map(self) -> &'static str {
        match self {
            Self::Force => "time=1:ms,fx=2:kN,fy=3:kN",
            Self::Trajectory => "time=1:s,x=2:m,y=3:m",
            Self::Steer => "time=1:s,steer=2:deg",
            Self::Wheels => "time=1:s,brake_fl=2:N m,brake_fr=3:N m",
        }
    }

    /// The first needed channel that no column holds, of the set of channels that lacks fewest;
    /// `None` if none is missing.
    fn first_missing(self, columns: &Columns) -> Option<Channel> {
        let is_missing = |channel: &&Channel| !columns.by_channel.contains_key(*channel);
        let n_missing = |needed: &&&[Channel]| needed.iter().filter(is_missing).count();
        let best = self.alternatives().iter().min_by_key(n_missing)?;
        let needed = [Channel::Time];
        needed.iter().chain(*best).find(is_missing).copied()
    }
}

/// Reads a contact force: time and the force ON the struck vehicle, in world or body axes.
///
/// - `map`: columns that the user has chosen; the others are found by their headers.
///
/// # Errors
/// [`DataError`] if the file cannot be read, a needed column is missing or ambiguous, its unit does
/// not measure it, or a value is not a plausible finite number. It states the place in the file and
/// the remedy.
pub fn read_force_file(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    read_series(path, map, FileKind::Force)
}

/// Reads a motion: time, position, and all other channels that are recognised.
///
/// - `map`: columns that the user has chosen; the others are found by their headers.
///
/// # Errors
/// [`DataError`] as for [`read_force_file`].
pub fn read_trajectory_file(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    read_series(path, map, FileKind::Trajectory)
}

/// Reads a motion with its heading: time, position, yaw angle, and all other channels that are
/// recognised.
///
/// - `map`: columns that the user has chosen; the others are found by their headers.
///
/// # Errors
/// [`DataError`] as for [`read_force_file`]; [`DataError::MissingColumn`] also if there is no yaw
/// angle.
pub fn read_motion_log(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    let table = read_table(path, map)?;
    let columns = columns_of(&table, map)?;
    let has_position = FileKind::Trajectory.first_missing(&columns).is_none();
    if has_position && !columns.by_channel.contains_key(&Channel::Yaw) {
        return Err(table.placed(columns.missing(&table, Channel::Yaw, "time, x, y and yaw")));
    }
    let loaded = load(&table, columns, FileKind::Trajectory, map)?;
    loaded.check_consistent(path)?;
    Ok(loaded)
}

/// Reads the torques of brakes and drive at the wheels over time.
///
/// - `map`: columns that the user has chosen; the others are found by their headers.
///
/// # Errors
/// [`DataError`] as for [`read_force_file`].
pub fn read_wheels_file(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    read_series(path, map, FileKind::Wheels)
}

/// Reads angles of the road wheels or of the steering wheel over time.
///
/// - `map`: columns that the user has chosen; the others are found by their headers.
///
/// # Errors
/// [`DataError`] as for [`read_force_file`].
pub fn read_steer_file(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    read_series(path, map, FileKind::Steer)
}

/// Reads a time-series file of a given kind.
///
/// - `map`: columns that the user has chosen; the others are found by their headers.
///
/// # Errors
/// [`DataError`] as for [`read_force_file`].
pub fn read_series(
    path: &Path,
    map: Option<&ColumnMap>,
    kind: FileKind,
) -> Result<Loaded, DataError> {
    let table = read_table(path, map)?;
    let columns = columns_of(&table, map)?;
    load(&table, columns, kind, map)
}

/// Reads a time-series file whose kind is determined from its columns: a motion if it has
/// positions, otherwise a contact force, otherwise steering.
///
/// - `map`: columns that the user has chosen; the others are found by their headers.
///
/// # Errors
/// [`DataError`] as for [`read_force_file`]; a file that is of no kind gives the error for a force
/// file.
pub fn read_any_series(path: &Path, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    series_of_table(&read_table(path, map)?, map)
}

/// The time series in a table, of the kind that its columns give.
///
/// - `map`: columns that the user has chosen; the others are found by their headers. The table has
///   been read with its settings.
///
/// # Errors
/// The same as for [`read_any_series`].
pub fn series_of_table(table: &Table, map: Option<&ColumnMap>) -> Result<Loaded, DataError> {
    let columns = columns_of(table, map)?;
    let is_complete = |kind: &FileKind| kind.first_missing(&columns).is_none();
    // Of a file of no kind, the one that a column makes it which is left out for its unit.
    let has_wrong_unit = |kind: &FileKind| {
        let needed: Vec<Channel> = kind.alternatives().concat();
        let mut wrong = columns.notes.iter().filter_map(|note| match note {
            Note::WrongUnit { channel, .. } => Some(channel),
            _ => None,
        });
        wrong.any(|channel| needed.contains(channel))
    };
    let all = || FileKind::ALL.into_iter();
    let kind = all().find(is_complete).or_else(|| all().find(has_wrong_unit));
    load(table, columns, kind.unwrap_or(FileKind::Force), map)
}

fn read_table(path: &Path, map: Option<&ColumnMap>) -> Result<Table, DataError> {
    Table::read_as(path, map.map_or(&ReadSettings::default(), |map| &map.settings))
}

fn columns_of(table: &Table, map: Option<&ColumnMap>) -> Result<Columns, DataError> {
    Columns::from_table(table, map).map_err(|error| table.placed(error))
}

fn load(
    table: &Table,
    columns: Columns,
    kind: FileKind,
    map: Option<&ColumnMap>,
) -> Result<Loaded, DataError> {
    no_samples::check(table, &columns.by_channel).map_err(|error| table.placed(error))?;
    let settings = map.map(|map| (*map.settings).clone()).unwrap_or_default();
    let read = match load_columns(table, columns.clone(), kind, map) {
        Err(error) if error.is_of_blank_cell() => {
            match slow_columns::filled(table, &columns.by_channel, &settings) {
                Some((filled, note)) => {
                    let mut columns = columns;
                    columns.notes.push(note);
                    load_columns(&filled, columns, kind, map)
                }
                None => Err(error),
            }
        }
        read => read,
    };
    read.map_err(|error| table.placed(error))
}

fn load_columns(
    table: &Table,
    columns: Columns,
    kind: FileKind,
    map: Option<&ColumnMap>,
) -> Result<Loaded, DataError> {
    let (path, line) = (|| table.path().to_owned(), table.header_line());
    if !table.has_header() && map.is_none_or(|map| map.iter().next().is_none()) {
        let example = kind.example_map();
        return Err(DataError::NoHeader { path: path(), line, example });
    }
    if let Some(channel) = kind.first_missing(&columns) {
        return Err(columns.missing(table, channel, kind.needed()));
    }
    check_deck(table, &columns, map)?;
    if table.n_rows() < MIN_ROWS {
        let (expected, got) = (MIN_ROWS, table.n_rows());
        return Err(DataError::TooFewRows { path: path(), line, expected, got });
    }
    check_numbers(table, &columns, map)?;
    computed::check_places(table, &columns.by_channel)?;
    let settings = map.map(|map| (*map.settings).clone()).unwrap_or_default();
    if let Some(time) = columns.by_channel.get(&Channel::Time) {
        clock::check_unit(table, time, map)?;
    }
    let mut series = TimeSeries::default();
    let mut goes_on = None;
    for column in columns.by_channel.values() {
        if column.channel == Channel::Time {
            let (time_s, note) = instants_s(table, column, &settings)?;
            goes_on = note;
            clock::second_record(table, column, &time_s).map_or(Ok(()), Err)?;
            let time = TimeSeries::new(time_s);
            series = time.map_err(|error| clock::out_of_order(table, column, error))?;
            clock::check_steps(table, column, series.time_s())?;
            continue;
        }
        let values = si_values(table, column, series.time_s(), &settings);
        let values = values.map_err(|error| {
            let shift_s = clock::controls_shift_s(&series, kind, map);
            let refused = Refused { table, column, map, shift_s };
            steering::asked(&refused, degrees::asked(&refused, error))
        })?;
        insert(&mut series, column.channel, values, table)?;
    }
    let used: Vec<&ColumnUse> = columns.by_channel.values().collect();
    impulse::check_force(table, &series, &used, map)?;
    impulse::check_zero(table, &series, &used, map)?;
    clock::check_controls(table, &series, kind, map)?;
    let read_as = settings.velocities.unwrap_or(VelocityAxes::Body);
    let found = corrections::notes(table, &columns.by_channel, &settings, &series);
    if read_as == VelocityAxes::World {
        let needed = [Channel::Yaw, Channel::Vx, Channel::Vy];
        if let Some(channel) = needed.into_iter().find(|channel| series.get(*channel).is_none()) {
            let needed = "velocities in world axes: vx, vy and yaw";
            return Err(columns.missing(table, channel, needed));
        }
        if let Some([vx, vy]) = in_body_axes(&series) {
            insert(&mut series, Channel::Vx, vx, table)?;
            insert(&mut series, Channel::Vy, vy, table)?;
        }
    }
    check_antenna(table, &columns, &series, &settings)?;
    let Columns { by_channel, mut notes } = columns;
    notes.extend(table.format_notes());
    notes.extend(goes_on);
    let is_shifted = settings.time_shift_s.is_some();
    let begins_s = clock::offered_shift_s(&series).filter(|_| !is_shifted);
    notes.extend(begins_s.map(|shift_s| Note::Begins { first_s: 0.0 - shift_s }));
    notes.extend(computed::notes(table, &by_channel));
    notes.extend(antenna::open_note(&by_channel, &settings));
    notes.extend(found);
    notes.extend(doubts::of_numbers(table, &by_channel, &series, map));
    // What is checked above is what the receiver has measured.
    notes.extend(move_to_cg(&mut series, &settings, table)?);
    let model_start = table.model_start().filter(|_| kind == FileKind::Force && is_as_written(map));
    let model_start = model_start.map(|start| start.along_axes(settings.y_to_right));
    let columns = by_channel.into_values().collect();
    Ok(Loaded {
        kind,
        series,
        columns,
        notes,
        dialect: table.dialect(),
        encoding: table.encoding(),
        model_start,
    })
}

/// Whether a map takes the force of a finite-element run as it was written: neither that on the other car nor
/// along other axes.
fn is_as_written(map: Option<&ColumnMap>) -> bool {
    let is_own = |channel: Channel, column: usize| {
        let source = map.and_then(|map| map.get(channel)).map(|source| &source.column);
        source.is_none_or(|source| match source {
            ColumnRef::Number(number) => *number == column,
            ColumnRef::Name(name) => name.starts_with(channel.short_name()),
            ColumnRef::Sum(_) | ColumnRef::Computed(..) | ColumnRef::Zero => false,
        })
    };
    is_own(Channel::Fx, 2) && is_own(Channel::Fy, 3)
}

fn insert(
    series: &mut TimeSeries,
    channel: Channel,
    values: Vec<f64>,
    table: &Table,
) -> Result<(), DataError> {
    let path = || table.path().to_owned();
    series.insert(channel, values).map_err(|source| DataError::Series { path: path(), source })
}

/// Refuses the place of an antenna for a file without the positions and the yaw angle that it takes.
///
/// # Errors
/// [`DataError::MissingColumn`].
fn check_antenna(
    table: &Table,
    columns: &Columns,
    series: &TimeSeries,
    settings: &ReadSettings,
) -> Result<(), DataError> {
    let needed = settings.antenna_m.map(|_| [Channel::X, Channel::Y, Channel::Yaw]);
    let is_missing = |channel: &Channel| series.get(*channel).is_none();
    match needed.into_iter().flatten().find(is_missing) {
        Some(channel) => {
            let needed = "x, y and yaw, by which an antenna is moved";
            Err(columns.missing(table, channel, needed))
        }
        None => Ok(()),
    }
}

/// Moves positions of an antenna to the CG, and says so.
fn move_to_cg(
    series: &mut TimeSeries,
    settings: &ReadSettings,
    table: &Table,
) -> Result<Option<Note>, DataError> {
    let Some(place_m) = settings.antenna_m else { return Ok(None) };
    let Some([x, y]) = antenna::of_cg(series, place_m) else { return Ok(None) };
    insert(series, Channel::X, x, table)?;
    insert(series, Channel::Y, y, table)?;
    Ok(Some(antenna::note(place_m)))
}

/// Asks for the units of a finite-element model, which its results do not state.
///
/// # Errors
/// [`DataError::Open`] with a proposal; [`DataError::Contradiction`] if units of a model are said of another
/// file.
fn check_deck(table: &Table, columns: &Columns, map: Option<&ColumnMap>) -> Result<(), DataError> {
    let path = || table.path().to_owned();
    let said = map.and_then(|map| map.settings.deck).filter(|_| !table.is_of_model());
    if let Some(deck) = said {
        let deck = deck.name();
        let what = format!(
            "deck={deck} says the units of a finite-element model, and the file holds no results of one; \
             name the unit of each column instead"
        );
        return Err(DataError::Contradiction { path: path(), what });
    }
    let is_open = |column: &ColumnUse| !column.unit_is_stated && !column.terms.is_empty();
    match table.proposed_deck() {
        Some((deck, why)) if columns.by_channel.values().any(is_open) => {
            let mut map = map.cloned().unwrap_or_default();
            map.settings.deck = Some(deck);
            let (line, map) = (table.header_line(), Box::new(map));
            let what =
                format!("the units of the model are not in the file and have to be said; {why}");
            Err(DataError::Open { path: path(), line, what, map })
        }
        _ => Ok(()),
    }
}

/// Asks for the marks within the numbers that are read, if one of them may mean two things.
///
/// # Errors
/// [`DataError::AmbiguousNumber`].
fn check_numbers(
    table: &Table,
    columns: &Columns,
    map: Option<&ColumnMap>,
) -> Result<(), DataError> {
    let terms = columns.by_channel.values().flat_map(|column| &column.terms);
    let read: Vec<usize> = terms.filter_map(|term| term.number.checked_sub(1)).collect();
    let Some((row_idx, column_idx)) = table.ambiguous_number(&read) else { return Ok(()) };
    let text = table.cell(row_idx, column_idx).into_owned();
    let mark = if text.contains(',') { Thousands::Comma } else { Thousands::Point };
    let mut maps = [map.cloned().unwrap_or_default(), map.cloned().unwrap_or_default()];
    maps[0].settings.decimal_comma = Some(mark == Thousands::Comma);
    maps[1].settings.thousands = Some(mark);
    Err(DataError::AmbiguousNumber {
        path: table.path().to_owned(),
        line: table.line(row_idx),
        column: column_idx + 1,
        name: table.header().get(column_idx).cloned().unwrap_or_default(),
        text,
        maps: Box::new(maps),
    })
}
