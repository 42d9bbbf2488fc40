//! `impactlab atlas slice`: a map over two axes of the atlas.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::commands::atlas::{
    Held, HeldArgs, axis_idx, doubt_text, listed, measure_of, measure_text, print_held,
};
use crate::cli::console::{Console, print_table, shown_path};
use crate::cli::options::{OverwriteArg, UNITS, one_value_of, size_px};
use impactlab_core::data::write_atomically;
use impactlab_core::units::{UnitSystem, percent};
use impactlab_document::figure::{AtlasFigure, atlas_figure, write_slice_csv};
use impactlab_draw::Canvas;
use impactlab_sweep::atlas::{Atlas, Axis, Measure, Slice, SliceCell};

/// What a map shows and where it goes.
#[derive(Debug, Args)]
pub(super) struct SliceArgs {
    /// The horizontal axis
    #[arg(long, value_name = "AXIS")]
    x: String,
    /// The vertical axis
    #[arg(long, value_name = "AXIS")]
    y: String,
    /// What is shown, as `impactlab atlas` lists it
    #[arg(long, value_name = "NAME", default_value = "turns_90")]
    outcome: String,
    #[command(flatten)]
    held: HeldArgs,
    /// The file: .png for a picture, .csv for the numbers in SI units; a table is printed if not given
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Units of text and picture
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
    /// Dark ground
    #[arg(long)]
    dark: bool,
    /// Width x height of the picture, pixels
    #[arg(long, value_parser = size_px, default_value = "1920x1080")]
    size: [u32; 2],
}

#[derive(Debug, Serialize)]
struct PrintedSlice<'a> {
    note: &'a str,
    out: Option<&'a Path>,
    outcome: &'static str,
    unit: &'static str,
    held: Vec<Held>,
    x: &'a Axis,
    y: &'a Axis,
    cells: &'a [SliceCell],
}

/// Whether a file is a picture.
///
/// # Errors
/// [`CliError::OutputKind`].
fn is_picture(path: &Path) -> Result<bool, CliError> {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_deref().and_then(|ending| ending.to_str()) {
        Some("png") => Ok(true),
        Some("csv") => Ok(false),
        _ => Err(CliError::OutputKind { path: path.to_owned() }),
    }
}

/// Makes the map.
///
/// - `atlas`: with what it is;
/// - `file`: where the atlas was read, if it is not the shipped one.
pub(super) fn run(
    (atlas, note): (&Atlas, &str),
    file: Option<&Path>,
    args: &SliceArgs,
    console: &mut Console<'_>,
) -> Result<(), CliError> {
    let picture = args.out.as_deref().map(is_picture).transpose()?;
    console.check_target(args.out.as_deref(), args.overwrite.into())?;
    console.reads(&file.map(Path::to_owned).into_iter().collect::<Vec<_>>())?;
    let [x, y] = [axis_idx(atlas, &args.x)?, axis_idx(atlas, &args.y)?];
    if x == y {
        return Err(CliError::AxisTwice { name: args.x.clone() });
    }
    let (measure, held) = (measure_of(&args.outcome)?, args.held.bins(atlas, args.units)?);
    for (axis, name) in [(x, &args.x), (y, &args.y)] {
        if held.get(axis).is_some_and(Option::is_some) {
            return Err(CliError::AxisOfMapSet { name: name.clone() });
        }
    }
    let slice = atlas.slice(x, y, &held, measure);
    match (&args.out, picture) {
        (Some(out), Some(true)) => {
            let other_networks = &atlas.other_networks_in(&console.library)?;
            let (held, units) = (held.as_slice(), args.units);
            let axes = [x, y];
            let of = AtlasFigure { atlas, axes, held, measure, case: None, units, other_networks };
            write_picture(&of, args, out)?;
        }
        (Some(out), _) => write_atomically(out, args.overwrite.into(), |file| {
            let told = restrictions(note, &listed(atlas, &held, args.units));
            write_slice_csv(&slice, measure, &told, file).map_err(std::io::Error::other)
        })?,
        (None, _) => {}
    }
    let units = args.units;
    let printed = PrintedSlice {
        note,
        out: args.out.as_deref(),
        outcome: measure.name(),
        unit: measure.unit(),
        held: listed(atlas, &held, units),
        x: &slice.x,
        y: &slice.y,
        cells: &slice.cells,
    };
    console.print(&printed, |out| {
        if let Some(path) = printed.out {
            writeln!(out, "{}: {}", shown_path(path), measure.label())?;
            return writeln!(out, "note: {note}");
        }
        writeln!(out, "{}\n{note}", measure.label())?;
        print_held(out, &printed.held)?;
        writeln!(out)?;
        let [x, y] = [&slice.x.label, &slice.y.label].map(String::as_str);
        let header = [x, y, "± standard error", "rows", "inside", ""];
        print_table(out, &header, &table(&slice, measure, args.units))
    })
}

/// What a table of cells is, and what is held in it.
fn restrictions(note: &str, held: &[Held]) -> String {
    let held: Vec<String> = held.iter().map(Held::told).collect();
    let all = if held.is_empty() { "all rows".to_owned() } else { held.join(", ") };
    format!("{note}; {all}; every other axis is averaged over")
}

/// A row for each cell.
fn table(slice: &Slice, measure: Measure, units: UnitSystem) -> Vec<Vec<String>> {
    let width = slice.x.n_bins().max(1);
    let row = |(idx, cell): (usize, &SliceCell)| {
        vec![
            slice.x.bin_text(idx % width, units),
            slice.y.bin_text(idx / width, units),
            measure_text(measure, cell, units),
            rows_text(cell),
            percent(cell.inside),
            doubt_text(cell).to_owned(),
        ]
    };
    slice.cells.iter().enumerate().map(row).collect()
}

/// The rows of a cell, and of how many of them the measure is.
fn rows_text(cell: &SliceCell) -> String {
    match cell.n_applies == cell.n_rows {
        true => cell.n_rows.to_string(),
        false => format!("{} of {}", cell.n_applies, cell.n_rows),
    }
}

fn write_picture(of: &AtlasFigure<'_>, args: &SliceArgs, out: &Path) -> Result<(), CliError> {
    let figure = atlas_figure(of);
    let canvas = Canvas { size_px: args.size, dark: args.dark, ..Canvas::default() };
    let image = impactlab_draw::figure_image(&figure, canvas)?;
    impactlab_draw::save_png(&image, out, args.overwrite.into())?;
    Ok(())
}
