//! The curve as a file will be read with the choices of the import dialog, and its main numbers.

use impactlab_core::data::{
    Channel, ColumnMap, Correction, DataError, FileKind, Flag, ForceHistory, Loaded, Severity,
    Table, TimeSeries, VelocityFit, check_file, contact_interval, series_of_table, velocity_fit,
};
use impactlab_core::error_chain;
use impactlab_core::numerics::median;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Quantity, UnitSystem, significant};
use impactlab_document::figure::{Axis, Figure, FigureElement, ForceFigure, Role, force_figure};

/// Time from the first row over which the first speed of a path is taken, s.
const FIRST_SPEED_OVER_S: f64 = 0.1;

/// Force from which it is shown in kN, N.
const SHOWN_IN_KN: f64 = 1e3;

/// What a file holds if it is read as the user has chosen.
pub struct Preview {
    pub kind: FileKind,
    /// The curve: force over time, path from above, or angle over time.
    pub figure: Figure,
    /// The main numbers, by their names.
    pub numbers: Vec<(&'static str, String)>,
    /// What makes the numbers doubtful, and what else can be corrected.
    pub remarks: Vec<Remark>,
    /// The axes in which the velocities fit the path, as they stand in the file.
    pub fit: Option<VelocityFit>,
    /// The first instant, with the shift of the map, s.
    pub first_s: f64,
    /// The impulse of a force that has no yaw moment of its own, along the heading at the start, N s.
    pub impulse_n_s: Option<[f64; 2]>,
    /// Velocity with which the car of a finite-element run begins, if the file says it, m/s.
    pub begins_m_s: Option<[f64; 2]>,
}

/// A remark on what was read.
pub struct Remark {
    pub text: String,
    /// Whether the numbers may be wrong.
    pub is_doubt: bool,
    /// Changes of the map of which each corrects it.
    pub corrections: Vec<Correction>,
}

/// Why a table cannot be read with a map.
pub struct Refusal {
    pub text: String,
    /// Changes of the map of which each answers what is open.
    pub corrections: Vec<Correction>,
}

impl Refusal {
    pub fn new(error: &DataError, map: &ColumnMap) -> Self {
        Self { text: error_chain(error), corrections: error.corrections(Some(map)) }
    }
}

impl Preview {
    /// Reads a table with a map.
    ///
    /// # Errors
    /// [`DataError`] if the map does not make a time series of it.
    pub fn new(table: &Table, map: &ColumnMap, units: UnitSystem) -> Result<Self, DataError> {
        let loaded = series_of_table(table, Some(map))?;
        let mut as_recorded = map.clone();
        as_recorded.settings.velocities = None;
        let fit = series_of_table(table, Some(&as_recorded)).ok();
        let fit = fit.and_then(|loaded| velocity_fit(&loaded.series));
        let flags = check_file(&loaded).into_iter().filter(|of| of.severity > Severity::Info);
        let flags = flags.map(|flag: Flag| Remark {
            text: flag.to_string(),
            is_doubt: true,
            corrections: Vec::new(),
        });
        let notes = loaded.notes.iter().map(|note| Remark {
            text: note.to_string(),
            is_doubt: note.is_doubt(),
            corrections: note.corrections(),
        });
        let notes = notes.filter(|note| note.is_doubt || !note.corrections.is_empty());
        Ok(Self {
            kind: loaded.kind,
            figure: figure(&loaded, units),
            numbers: numbers(&loaded, units),
            remarks: flags.chain(notes).collect(),
            fit,
            first_s: loaded.series.time_s().first().copied().unwrap_or(0.0),
            impulse_n_s: impulse_n_s(&loaded),
            begins_m_s: loaded.model_start.as_ref().and_then(|start| start.of_force_m_s),
        })
    }
}

/// The impulse of a file of a force, whose vehicle heads along x at the start.
fn impulse_n_s(loaded: &Loaded) -> Option<[f64; 2]> {
    let force = ForceHistory::from_series(&loaded.series, loaded.force_sampling()).ok()?;
    (loaded.kind == FileKind::Force && force.mz_n_m.is_none()).then(|| force.impulse_n_s())
}

fn figure(loaded: &Loaded, units: UnitSystem) -> Figure {
    let series = &loaded.series;
    match (loaded.kind, ForceHistory::from_series(series, loaded.force_sampling())) {
        (FileKind::Trajectory, _) => path_figure(series, units),
        (_, Ok(force)) => {
            let contact_s = contact_interval(&force);
            force_figure(&ForceFigure {
                name: "as it will be read",
                force: &force,
                raw: None,
                contact_s,
                pulses: &[],
                units,
                caveats: &Caveats::default(),
            })
        }
        _ => channel_figure(series, units),
    }
}

fn path_figure(series: &TimeSeries, units: UnitSystem) -> Figure {
    let x = Axis::shown("x", Quantity::Length, units);
    let y = Axis::shown("y", Quantity::Length, units);
    let column = |channel| series.get(channel).unwrap_or_default();
    let points = column(Channel::X).iter().zip(column(Channel::Y));
    let points: Vec<[f64; 2]> =
        points.map(|(at_x, at_y)| [x.unit.from_si(*at_x), y.unit.from_si(*at_y)]).collect();
    let start = points.first().copied().into_iter().collect();
    let elements = vec![
        FigureElement::line("path", Role::Reference, points),
        FigureElement::points("first row", Role::Reference, start),
    ];
    Figure::new("path, from above", [x, y], elements).plan()
}

/// The first channel of a file of controls over time.
fn channel_figure(series: &TimeSeries, units: UnitSystem) -> Figure {
    let channel = series.channels().next().unwrap_or(Channel::Time);
    let x = Axis::new("Time", Quantity::Time.si_unit());
    let y = Axis::shown(channel.label(), channel.quantity(), units);
    let values = series.get(channel).unwrap_or_default();
    let points = series.time_s().iter().zip(values).map(|(t, v)| [*t, y.unit.from_si(*v)]);
    let elements = vec![FigureElement::line(channel.label(), Role::Reference, points.collect())];
    Figure::new(channel.label(), [x, y], elements)
}

fn numbers(loaded: &Loaded, units: UnitSystem) -> Vec<(&'static str, String)> {
    let series = &loaded.series;
    let time_s = series.time_s();
    let duration_s = time_s.last().zip(time_s.first()).map_or(0.0, |(last, first)| last - first);
    let mut numbers = vec![
        ("Rows", format!("{}, {}", series.n_samples(), sampling(time_s))),
        ("Duration", duration(duration_s)),
    ];
    if loaded.kind == FileKind::Trajectory {
        numbers.extend(path_numbers(series, units).into_iter().flatten());
    }
    if let Ok(force) = ForceHistory::from_series(series, loaded.force_sampling()) {
        let [px, py] = force.impulse_n_s();
        if let Some((peak_n, at_s)) = force.peak() {
            // A force of some newtons is to be seen as such.
            let peak = match peak_n < SHOWN_IN_KN && units == UnitSystem::Si {
                true => format!("{} N", significant(peak_n)),
                false => Quantity::Force.shown(peak_n, units),
            };
            numbers.push(("Peak |F|", format!("{peak} at {}", duration(at_s))));
        }
        numbers.push(("|Impulse|", Quantity::Impulse.shown(px.hypot(py), units)));
        if let Some((start_s, end_s)) = contact_interval(&force) {
            let (start, end) = (duration(start_s), duration(end_s));
            let text = format!("{} ({start} to {end})", duration(end_s - start_s));
            numbers.push(("Contact", text));
        }
    }
    numbers
}

fn path_numbers(series: &TimeSeries, units: UnitSystem) -> Option<[(&'static str, String); 2]> {
    let (x, y) = (series.get(Channel::X)?, series.get(Channel::Y)?);
    let steps = x.windows(2).zip(y.windows(2));
    let length_m: f64 = steps.map(|(x, y)| (x[1] - x[0]).hypot(y[1] - y[0])).sum();
    let time_s = series.time_s();
    let first_s = time_s.first()?;
    let later = time_s.iter().position(|t| t - first_s >= FIRST_SPEED_OVER_S)?;
    let moved_m = (x.get(later)? - x.first()?).hypot(y.get(later)? - y.first()?);
    let speed_m_s = moved_m / (time_s.get(later)? - first_s);
    Some([
        ("Path", Quantity::Length.shown(length_m, units)),
        ("First speed", Quantity::Speed.shown(speed_m_s, units)),
    ])
}

/// The usual time between two rows and the rate.
fn sampling(time_s: &[f64]) -> String {
    let step_s = median(time_s.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or(0.0);
    let rate_hz = 1.0 / step_s;
    let decimals = if rate_hz < 10.0 { 2 } else { 0 };
    format!("every {} ({rate_hz:.decimals$} Hz)", duration(step_s))
}

fn duration(time_s: f64) -> String {
    match time_s.abs() < 1.0 {
        true => format!("{} ms", significant(time_s * 1e3)),
        false => format!("{} s", significant(time_s)),
    }
}
