//! `impactlab atlas`: what a PIT leads to over the space of its conditions.

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::PathBuf;

use clap::{Args, Subcommand};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::commands::atlas_make::{self, MakeArgs};
use crate::cli::commands::atlas_slice::{self, SliceArgs};
use crate::cli::console::{Console, Verdict, print_table};
use crate::cli::options::{UNITS, one_value_of};
use impactlab_core::units::{NumberFormat, Quantity, Unit, UnitSystem, percent};
use impactlab_sweep::Outcome;
use impactlab_sweep::atlas::{Atlas, Axis, Corridor, Measure, Sensitivity, SliceCell};

/// What every answer of the atlas says of itself.
const NOTE: &str = "a model study, checked against no measured PIT; no speed in it is a safe speed";

/// Read the atlas of the PIT manoeuvre: what it leads to over speed, angle, contact, friction and cars
///
/// Without a command it says of what rows the atlas is made and what its axes are. A cell with fewer than 20
/// rows has no mean, and every number has its Monte Carlo standard error.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct AtlasArgs {
    #[command(subcommand)]
    command: Option<AtlasCommand>,
    /// Another atlas than the one that comes with the program
    #[arg(long, global = true, value_name = "FILE.atlas")]
    atlas: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  impactlab atlas
  impactlab atlas cell --set speed=45mph --set closing=6mph --set esc=1
  impactlab atlas slice --x speed --y closing --outcome turns_90 --out map.png
  impactlab atlas sensitivity

JSON: {note, n_rows, n_failed, n_outside, n_cells, plan_sha256, program, networks, axes [{name, word, label, unit,
  edges | labels}], outcomes [{name, label, unit, is_probability}], has_sensitivity}";

#[derive(Debug, Subcommand)]
enum AtlasCommand {
    /// All outcomes of one place of the atlas, or of many together
    #[command(after_help = "\
Examples:\n  impactlab atlas cell --set speed=45mph --set closing=6mph --set friction=0.7\n  \
impactlab atlas cell --set esc=1 --json\n\n\
An axis that is not set is averaged over, as often as the plan has each of its values.\n\n\
JSON: {note, held [{axis, bin, text}], n_rows, n_failed, inside, outcomes [{name, unit, mean, standard_error, \
n_applies, is_sound}], corridor {length_m {value, error}, length_more_than_m, width_m {value, error}, \
width_more_than_m}}; a corridor beyond what is counted has no value, and what it is more than")]
    Cell(CellArgs),
    /// A map over two axes, as a table, a picture or CSV
    #[command(after_help = "\
Examples:\n  impactlab atlas slice --x speed --y closing --outcome turns_90 --out map.png\n  \
impactlab atlas slice --x speed --y overlap --outcome corridor_length_m --set esc=1 --out map.csv\n\n\
JSON: {note, out, outcome, unit, held [{axis, bin, text}], x, y, cells [{n_rows, n_failed, n_applies, mean, \
more_than, error, inside, at_rest}], row by row from the lowest y; x and y as in `impactlab atlas --json`}")]
    Slice(SliceArgs),
    /// Which input moves an outcome: Sobol indices, alone and with the others
    #[command(after_help = "\
Examples:\n  impactlab atlas sensitivity\n  impactlab atlas sensitivity --outcome turns_90\n\n\
JSON: {note, outcomes [{outcome, n_bases, indices [{name, first, first_error, total, total_error}]}]}")]
    Sensitivity(SensitivityArgs),
    /// Make an atlas of the rows of a sweep
    #[command(after_help = "\
Examples:\n  impactlab atlas make rows.parquet --out my.atlas\n  \
impactlab atlas make rows.parquet --saltelli indices.parquet --out my.atlas\n\n\
JSON: {out, bytes, sha256, n_rows, n_failed, n_outside, n_cells, n_outcomes_with_indices}")]
    Make(MakeArgs),
}

/// What is held.
#[derive(Debug, Args)]
pub(super) struct HeldArgs {
    /// Hold an axis at the interval in which a value lies, such as speed=45mph, closing=8mph, esc=1; several if
    /// given again
    #[arg(long = "set", value_name = "AXIS=VALUE", value_parser = named_value)]
    set: Vec<(String, String)>,
}

#[derive(Debug, Args)]
struct CellArgs {
    #[command(flatten)]
    held: HeldArgs,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

#[derive(Debug, Args)]
struct SensitivityArgs {
    /// Only this outcome
    #[arg(long, value_name = "NAME")]
    outcome: Option<String>,
}

fn named_value(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected AXIS=VALUE, such as speed=45mph")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

/// Reads or makes an atlas.
pub(in crate::cli) fn run(
    args: &AtlasArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    if let Some(AtlasCommand::Make(args)) = &args.command {
        return atlas_make::run(args, console);
    }
    let atlas: Cow<'_, Atlas> = match &args.atlas {
        Some(path) => {
            console.reads(std::slice::from_ref(path))?;
            Cow::Owned(Atlas::read(path)?)
        }
        None => Cow::Borrowed(Atlas::shipped().ok_or(CliError::NoAtlas)?),
    };
    let note = note_of(&atlas, console)?;
    match &args.command {
        None | Some(AtlasCommand::Make(_)) => describe(&atlas, &note, console)?,
        Some(AtlasCommand::Cell(args)) => cell(&atlas, &note, args, console)?,
        Some(AtlasCommand::Slice(of)) => {
            atlas_slice::run((&*atlas, note.as_str()), args.atlas.as_deref(), of, console)?;
        }
        Some(AtlasCommand::Sensitivity(args)) => sensitivity(&atlas, &note, args, console)?,
    }
    Ok(Verdict::Clean)
}

/// What the atlas is, and by which networks it was not computed.
fn note_of(atlas: &Atlas, console: &Console<'_>) -> Result<String, CliError> {
    let others = atlas.other_networks_in(&console.library)?;
    Ok(match others.is_empty() {
        true => NOTE.to_owned(),
        false => {
            let others = others.join(", ");
            format!("{NOTE}; computed with other networks than those of this program: {others}")
        }
    })
}

#[derive(Debug, Serialize)]
struct Described<'a> {
    note: &'a str,
    n_rows: u64,
    n_failed: u64,
    n_outside: u64,
    n_cells: usize,
    plan_sha256: &'a str,
    program: &'a str,
    networks: &'a std::collections::BTreeMap<String, String>,
    axes: &'a [Axis],
    outcomes: Vec<DescribedOutcome>,
    has_sensitivity: bool,
}

#[derive(Debug, Serialize)]
struct DescribedOutcome {
    name: &'static str,
    label: &'static str,
    unit: &'static str,
    is_probability: bool,
}

fn describe(atlas: &Atlas, note: &str, console: &mut Console<'_>) -> Result<(), CliError> {
    let outcome = |measure: Measure| DescribedOutcome {
        name: measure.name(),
        label: measure.label(),
        unit: measure.unit(),
        is_probability: measure.is_probability(),
    };
    let described = Described {
        note,
        n_rows: atlas.n_rows,
        n_failed: atlas.n_failed,
        n_outside: atlas.n_outside,
        n_cells: atlas.n_cells(),
        plan_sha256: &atlas.plan_sha256,
        program: &atlas.program,
        networks: &atlas.networks,
        axes: &atlas.axes,
        outcomes: Measure::all().map(outcome).collect(),
        has_sensitivity: !atlas.sensitivity.is_empty(),
    };
    console.print(&described, |out| {
        writeln!(out, "{} rows in {} cells: {note}", described.n_rows, described.n_cells)?;
        if described.n_failed + described.n_outside > 0 {
            let (failed, outside) = (described.n_failed, described.n_outside);
            writeln!(out, "{failed} rows have no answer, {outside} lie outside of the axes")?;
        }
        writeln!(out, "computed by {}, plan {}\n", described.program, described.plan_sha256)?;
        let axis = |axis: &Axis| {
            let bins = (0..axis.n_bins()).map(|bin| axis.bin_text(bin, UnitSystem::default()));
            let bins = bins.collect::<Vec<_>>().join("; ");
            vec![axis.word.clone(), axis.label.clone(), bins]
        };
        let axes: Vec<_> = described.axes.iter().map(axis).collect();
        print_table(out, &["axis", "", "cells"], &axes)?;
        writeln!(out)?;
        let outcome = |of: &DescribedOutcome| vec![of.name.to_owned(), of.label.to_owned()];
        let outcomes: Vec<_> = described.outcomes.iter().map(outcome).collect();
        print_table(out, &["outcome", ""], &outcomes)
    })
}

/// An axis that is held.
#[derive(Debug, Serialize)]
pub(super) struct Held {
    axis: String,
    #[serde(skip)]
    label: String,
    bin: usize,
    text: String,
}

impl Held {
    /// For a person: `Stability control: with ESC`.
    pub(super) fn told(&self) -> String {
        format!("{}: {}", self.label, self.text)
    }
}

impl HeldArgs {
    /// The bin of every axis.
    ///
    /// - `units`: in which it is told what an axis has.
    ///
    /// # Errors
    /// [`CliError::NoAxis`], [`CliError::AxisValue`], [`CliError::OutsideAtlas`],
    /// [`CliError::AxisSetTwice`].
    pub(super) fn bins(
        &self,
        atlas: &Atlas,
        units: UnitSystem,
    ) -> Result<Vec<Option<usize>>, CliError> {
        let mut bins = vec![None; atlas.axes.len()];
        for (name, text) in &self.set {
            let idx = axis_idx(atlas, name)?;
            let (Some(axis), Some(slot)) = (atlas.axes.get(idx), bins.get_mut(idx)) else {
                continue;
            };
            if slot.replace(bin_of(axis, text, units)?).is_some() {
                return Err(CliError::AxisSetTwice { name: axis.word.clone() });
            }
        }
        Ok(bins)
    }
}

/// The bins that are held, for a person.
pub(super) fn listed(atlas: &Atlas, bins: &[Option<usize>], units: UnitSystem) -> Vec<Held> {
    let held = |(axis, bin): (&Axis, &Option<usize>)| {
        let bin = (*bin)?;
        let (name, label) = (axis.name.clone(), axis.label.clone());
        Some(Held { axis: name, label, bin, text: axis.bin_text(bin, units) })
    };
    atlas.axes.iter().zip(bins).filter_map(held).collect()
}

/// Prints what is held.
pub(super) fn print_held(out: &mut dyn Write, held: &[Held]) -> io::Result<()> {
    held.iter().try_for_each(|held| writeln!(out, "{}", held.told()))
}

/// The axis that a name or a word names.
pub(super) fn axis_idx(atlas: &Atlas, name: &str) -> Result<usize, CliError> {
    atlas.axis(name).ok_or_else(|| {
        let known: Vec<&str> = atlas.axes.iter().map(|axis| axis.word.as_str()).collect();
        CliError::NoAxis { name: name.to_owned(), known: known.join(", ") }
    })
}

/// The bin in which a value lies that a person has typed; of a choice its number or its label.
fn bin_of(axis: &Axis, text: &str, units: UnitSystem) -> Result<usize, CliError> {
    let is_label = |label: &String| label.to_lowercase() == text.to_lowercase();
    if let Some(bin) = axis.labels.iter().position(is_label) {
        return Ok(bin);
    }
    let quantity = axis.quantity();
    let value = quantity.parse(text, &quantity.si_unit());
    let (name, text) = (axis.word.clone(), text.to_owned());
    let value = match value {
        Ok(value) => value,
        Err(source) => return Err(CliError::AxisValue { name, text, source }),
    };
    axis.locate(value).ok_or_else(|| {
        let ends = axis.edges.first().zip(axis.edges.last());
        let expected = match ends {
            Some((low, high)) => {
                let [low, high] = [low, high].map(|end| quantity.shown(*end, units));
                format!("{low} to {high}")
            }
            None => {
                let labels = axis.labels.iter().enumerate();
                labels.map(|(n, label)| format!("{n}: {label}")).collect::<Vec<_>>().join(", ")
            }
        };
        CliError::OutsideAtlas { name, text, expected }
    })
}

/// The measure that a name names.
pub(super) fn measure_of(name: &str) -> Result<Measure, CliError> {
    Measure::all().find(|measure| measure.name() == name).ok_or_else(|| {
        let known: Vec<&str> = Measure::all().map(Measure::name).collect();
        CliError::NoOutcome { name: name.to_owned(), known: known.join(", ") }
    })
}

/// A measure of a cell for a person: `62.3 % ± 1.4 %`, `31.2 m ± 0.6 m`.
pub(super) fn measure_text(measure: Measure, cell: &SliceCell, units: UnitSystem) -> String {
    let Some(mean) = cell.mean else {
        let limit = cell.more_than.zip(Quantity::from_si_symbol(measure.unit()));
        let told = limit.map(|(limit, of)| format!("more than {}", of.shown(limit, units)));
        return told.unwrap_or_else(|| "too few rows".to_owned());
    };
    let Some(quantity) = Quantity::from_si_symbol(measure.unit()) else {
        return NumberFormat::english(units).chance(mean, Some(cell.error));
    };
    let unit: Unit = quantity.display_unit(units);
    let [mean, error] = [mean, cell.error].map(|value| unit.from_si(value));
    // Two digits of the error.
    let decimals = if error > 0.0 { (1.0 - error.log10().floor()).clamp(0.0, 6.0) } else { 3.0 };
    let decimals = decimals as usize;
    format!("{mean:.decimals$} ± {error:.decimals$} {}", unit.symbol)
}

/// What is said of a number that maps hatch.
pub(super) fn doubt_text(cell: &SliceCell) -> &'static str {
    if cell.is_told() && !cell.is_sound() { "not to be relied upon" } else { "" }
}

#[derive(Debug, Serialize)]
struct PrintedCell<'a> {
    note: &'a str,
    held: Vec<Held>,
    n_rows: u64,
    n_failed: u64,
    inside: f64,
    outcomes: Vec<PrintedOutcome>,
    corridor: Corridor,
}

#[derive(Debug, Serialize)]
struct PrintedOutcome {
    name: &'static str,
    unit: &'static str,
    mean: Option<f64>,
    standard_error: Option<f64>,
    n_applies: u64,
    is_sound: bool,
}

fn cell(
    atlas: &Atlas,
    note: &str,
    args: &CellArgs,
    console: &mut Console<'_>,
) -> Result<(), CliError> {
    let units = args.units;
    let bins = args.held.bins(atlas, units)?;
    let cell = atlas.cell(&bins);
    let outcome = |measure: Measure| {
        let told = cell.measure(measure);
        PrintedOutcome {
            name: measure.name(),
            unit: measure.unit(),
            mean: told.mean,
            standard_error: told.mean.map(|_| told.error),
            n_applies: told.n_applies,
            is_sound: told.is_sound(),
        }
    };
    let printed = PrintedCell {
        note,
        held: listed(atlas, &bins, units),
        n_rows: cell.n_rows(),
        n_failed: cell.n_failed(),
        inside: cell.inside(),
        outcomes: Outcome::ALL.iter().copied().map(Measure::Mean).map(outcome).collect(),
        corridor: cell.corridor(),
    };
    console.print(&printed, |out| {
        writeln!(out, "{note}")?;
        print_held(out, &printed.held)?;
        let (rows, failed) = (printed.n_rows, printed.n_failed);
        let inside = percent(printed.inside);
        writeln!(
            out,
            "{rows} rows, {failed} without an answer; in {inside} both networks apply\n"
        )?;
        let row = |measure: Measure| {
            let told = cell.measure(measure);
            let part = match told.n_applies == rows {
                true => String::new(),
                false => format!("of {} rows", told.n_applies),
            };
            let doubt = doubt_text(&told).to_owned();
            vec![measure.label().to_owned(), measure_text(measure, &told, units), part, doubt]
        };
        let table: Vec<_> = Measure::all().map(row).collect();
        print_table(out, &["outcome", "± standard error", "", ""], &table)
    })
}

#[derive(Debug, Serialize)]
struct PrintedSensitivity<'a> {
    note: &'a str,
    outcomes: Vec<OutcomeIndices>,
}

#[derive(Debug, Serialize)]
struct OutcomeIndices {
    outcome: &'static str,
    #[serde(skip)]
    label: &'static str,
    n_bases: u64,
    indices: Vec<Sensitivity>,
}

fn sensitivity(
    atlas: &Atlas,
    note: &str,
    args: &SensitivityArgs,
    console: &mut Console<'_>,
) -> Result<(), CliError> {
    let wanted = args.outcome.as_deref().map(measure_of).transpose()?;
    let is_wanted =
        |outcome: &&Outcome| wanted.is_none_or(|wanted| wanted == Measure::Mean(**outcome));
    let indices = |outcome: &Outcome| {
        let indices = atlas.sensitivity(*outcome)?;
        let (outcome, label) = (outcome.name(), outcome.label());
        let n_bases = atlas.sensitivity.iter().find(|of| of.outcome == outcome)?.n_bases;
        Some(OutcomeIndices { outcome, label, n_bases, indices })
    };
    let outcomes: Vec<_> = Outcome::ALL.iter().filter(is_wanted).filter_map(indices).collect();
    if outcomes.is_empty() {
        return Err(CliError::NoIndices);
    }
    let printed = PrintedSensitivity { note, outcomes };
    console.print(&printed, |out| {
        writeln!(out, "{note}")?;
        for of in &printed.outcomes {
            writeln!(out, "\n{}, of {} base points", of.label, of.n_bases)?;
            let row = |index: &Sensitivity| {
                let Sensitivity { name, first, first_error, total, total_error } = index;
                vec![
                    format!("  {name}"),
                    format!("{first:.3} ± {first_error:.3}"),
                    format!("{total:.3} ± {total_error:.3}"),
                ]
            };
            let rows: Vec<_> = of.indices.iter().map(row).collect();
            print_table(out, &["  input", "alone", "with others"], &rows)?;
        }
        Ok(())
    })
}
