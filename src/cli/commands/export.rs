//! `impactlab export`: the scene or the motion of a case for other programs.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::commands::render_film::{SampledArgs, reconstruction};
use crate::cli::commands::render_reconstruction::{ExportedReconstruction, exported};
use crate::cli::commands::render_scene::{BuiltScene, CaseArgs, build};
use crate::cli::console::{Console, Verdict, print_json, shown_path};
use crate::cli::options::{OverwriteArg, UNITS, number, one_value_of};
use impactlab_core::data::write::check_ending;
use impactlab_core::data::{
    write_bytes, write_restricted_series_csv, write_restricted_series_parquet,
    write_restricted_table,
};
use impactlab_core::ranges::INSTANT;
use impactlab_core::site::MapFormat;
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::PathPoint;
use impactlab_document::exchange::{
    DxfOptions, ExchangeError, GltfFrame, dxf, glb, hve_motion, hve_pulse, map,
};
use impactlab_document::scene::{FilmTiming, Scene};
use impactlab_study::ReconstructRequest;

/// Write the scene or the motion of a case, or a reconstruction, for other programs: DXF, KML, glTF, CSV, tables
/// for HVE
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct ExportArgs {
    #[command(flatten)]
    case: CaseArgs,
    #[command(flatten)]
    sampled: SampledArgs,
    /// What is written; if not given, it follows from the ending of the file
    #[arg(long, value_enum)]
    format: Option<FormatArg>,
    /// Into a drawing, the outlines of the cars at this moment; several times for several moments; the
    /// first and the last moment if not given
    #[arg(long, value_name = "TIME", value_parser = number(INSTANT))]
    at: Vec<f64>,
    /// The file
    #[arg(
        long,
        value_name = "FILE.dxf|FILE.kml|FILE.geojson|FILE.glb|FILE.csv|FILE.parquet|FILE.txt"
    )]
    out: PathBuf,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Units of labels and restrictions; coordinates and columns keep those of their format
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

const EXAMPLES: &str = "\
Examples:
  impactlab export datasets/trajectories-fea --case FE_c002 --at 0 --at 1 --at 2 --out paths.dxf
  impactlab export pit-right-rear --out scene.glb
  impactlab export datasets/trajectories-fea --case FE_c002 --format hve-pulse --out pulse.txt
  impactlab export assets/examples/reconstruction.toml --out found.dxf

Formats: dxf is in metres, a layer for each role, restrictions as text; kml and geojson have ground, paths
and marks on a map, if [origin] of the site file has latitude and longitude; glb has the cars with their
animation, Y up, for Blender and browsers; motion is CSV in SI units, parquet the
same in columns of 64 bits; hve-pulse and hve-motion are rows
with tabs between them in the units and axes of HVE, to be pasted into its tables.
Of evidence: what was found, and the car on the path of a particle of median speed, one of each course of
events; in CSV these paths. A reconstruction has no table for HVE.

JSON: out, format, title, notes";

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
enum FormatArg {
    /// A drawing in metres: paths, outlines, lines and points (.dxf)
    Dxf,
    /// Ground, paths, marks and points on a map (.kml)
    Kml,
    /// The same with the times of paths (.geojson)
    Geojson,
    /// The scene with its animation in 3D (.glb)
    Glb,
    /// The motion of the struck car over time, SI units (.csv)
    Motion,
    /// The same as Parquet (.parquet)
    Parquet,
    /// The force on the struck car over time, for a collision pulse of HVE
    HvePulse,
    /// The motion of the struck car over time, in the units and axes of HVE
    HveMotion,
}

#[derive(Debug, Serialize)]
struct Exported<'a> {
    out: &'a Path,
    format: FormatArg,
    title: &'a str,
    notes: &'a [String],
}

/// Builds the scene, writes the file and says so.
pub(in crate::cli) fn run(
    args: &ExportArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let format = match args.format {
        Some(format) => {
            check_name(&args.out, format)?;
            format
        }
        None => format_of(&args.out)?,
    };
    if format != FormatArg::Dxf && !args.at.is_empty() {
        return Err(CliError::OutlinesOfDrawing);
    }
    console.check_target(Some(&args.out), args.overwrite.into())?;
    if let Some(request) = reconstruction(&args.case, &args.sampled)? {
        return export_reconstruction(args, (format, &request), console);
    }
    let built = build(&args.case, None, args.units, console)?;
    for time_s in &args.at {
        built.check_time("--at", *time_s)?;
    }
    write(args, (format, &built))?;
    written(args, (format, &built.scene), built.notes.clone(), console)
}

/// Says what was written.
fn written(
    args: &ExportArgs,
    (format, scene): (FormatArg, &Scene),
    mut notes: Vec<String>,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    if format == FormatArg::Glb {
        notes.extend(GltfFrame::new(scene).notes());
    }
    let (out, title, notes) = (&args.out, &scene.title, notes.as_slice());
    if console.json {
        print_json(console.out, &Exported { out, format, title, notes })?;
        return Ok(Verdict::Clean);
    }
    writeln!(console.out, "{}: {title}", shown_path(out))?;
    for note in notes {
        writeln!(console.out, "note: {note}")?;
    }
    Ok(Verdict::Clean)
}

/// Reconstructs from evidence, writes the file and says so.
fn export_reconstruction(
    args: &ExportArgs,
    (format, request): (FormatArg, &ReconstructRequest),
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let unknown = |what| {
        let name = args.case.source.path.display().to_string();
        ExchangeError::Unknown { name, what }
    };
    match format {
        FormatArg::HvePulse => return Err(unknown("contact force over time").into()),
        FormatArg::HveMotion | FormatArg::Parquet => {
            return Err(unknown("motion without its uncertainty").into());
        }
        FormatArg::Dxf
        | FormatArg::Kml
        | FormatArg::Geojson
        | FormatArg::Glb
        | FormatArg::Motion => {}
    }
    let ExportedReconstruction { scene, paths, notes } = exported(request, args.units, console)?;
    let existing = args.overwrite.into();
    let mut bytes = Vec::new();
    match format {
        FormatArg::Dxf => {
            let outlines_s = match args.at.is_empty() {
                true => vec![FilmTiming::from_scene(&scene).from_s, scene.end_s],
                false => args.at.clone(),
            };
            dxf(&scene, &DxfOptions { outlines_s }, &mut bytes)?;
        }
        FormatArg::Kml => map(&scene, MapFormat::Kml, &mut bytes)?,
        FormatArg::Geojson => map(&scene, MapFormat::GeoJson, &mut bytes)?,
        FormatArg::Glb => glb(&scene, &mut bytes)?,
        _ => {
            let header = PATH_COLUMNS.map(str::to_owned);
            let rows = paths
                .iter()
                .flat_map(|path| path.path.points.iter().map(|at| path_row(&path.name, at)));
            let restrictions = scene.caveats.in_units(scene.units).text();
            write_restricted_table(&args.out, existing, &header, rows, restrictions.as_deref())?;
            return written(args, (format, &scene), notes, console);
        }
    }
    write_bytes(&args.out, existing, &bytes)?;
    written(args, (format, &scene), notes, console)
}

/// Columns of the paths of a reconstruction.
const PATH_COLUMNS: [&str; 8] =
    ["course", "time_s", "x_m", "y_m", "yaw_rad", "vx_body_m_s", "vy_body_m_s", "yaw_rate_rad_s"];

fn path_row(name: &str, at: &PathPoint) -> Vec<String> {
    let PathPoint { time_s, x_m, y_m, yaw_rad, vx_body_m_s, vy_body_m_s, yaw_rate_rad_s } = *at;
    let numbers = [time_s, x_m, y_m, yaw_rad, vx_body_m_s, vy_body_m_s, yaw_rate_rad_s];
    std::iter::once(name.to_owned()).chain(numbers.map(|number| number.to_string())).collect()
}

/// The format that belongs to the ending of a file.
fn format_of(path: &Path) -> Result<FormatArg, CliError> {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_deref().and_then(|ending| ending.to_str()) {
        Some("dxf") => Ok(FormatArg::Dxf),
        Some("kml") => Ok(FormatArg::Kml),
        Some("geojson") => Ok(FormatArg::Geojson),
        Some("glb") => Ok(FormatArg::Glb),
        Some("csv") => Ok(FormatArg::Motion),
        Some("parquet") => Ok(FormatArg::Parquet),
        _ => Err(CliError::ExportKind { path: path.to_owned() }),
    }
}

/// Returns an error if a file would have the name of another format than that of its content.
fn check_name(path: &Path, format: FormatArg) -> Result<(), CliError> {
    let ending = match format {
        FormatArg::Dxf => "dxf",
        FormatArg::Kml => "kml",
        FormatArg::Geojson => "geojson",
        FormatArg::Glb => "glb",
        FormatArg::Motion => "csv",
        FormatArg::Parquet => "parquet",
        FormatArg::HvePulse | FormatArg::HveMotion => "txt",
    };
    match format_of(path) {
        // Those for HVE are tables, too.
        Ok(FormatArg::Motion) if ending == "txt" => Ok(()),
        Ok(named) if named != format => Ok(check_ending(path, ending)?),
        _ => Ok(()),
    }
}

fn write(args: &ExportArgs, (format, built): (FormatArg, &BuiltScene)) -> Result<(), CliError> {
    let BuiltScene { scene, analysis, .. } = built;
    let (path, existing) = (&args.out, args.overwrite.into());
    let restrictions = scene.caveats.in_units(scene.units).text();
    let mut bytes = Vec::new();
    match format {
        FormatArg::Dxf => {
            let outlines_s = match args.at.is_empty() {
                true => vec![built.start_s(), scene.end_s],
                false => args.at.clone(),
            };
            dxf(scene, &DxfOptions { outlines_s }, &mut bytes)?;
        }
        FormatArg::Kml => map(scene, MapFormat::Kml, &mut bytes)?,
        FormatArg::Geojson => map(scene, MapFormat::GeoJson, &mut bytes)?,
        FormatArg::Glb => glb(scene, &mut bytes)?,
        FormatArg::HvePulse => hve_pulse(analysis, restrictions.as_deref(), &mut bytes)?,
        FormatArg::HveMotion => hve_motion(analysis, restrictions.as_deref(), &mut bytes)?,
        FormatArg::Motion | FormatArg::Parquet => {
            let simulated = analysis.written_motion()?;
            let unknown = || ExchangeError::Unknown { name: analysis.name.clone(), what: "motion" };
            let series = simulated.as_ref().or(analysis.reference.as_ref()).ok_or_else(unknown)?;
            let write = match format {
                FormatArg::Parquet => write_restricted_series_parquet,
                _ => write_restricted_series_csv,
            };
            return Ok(write(path, existing, series, restrictions.as_deref())?);
        }
    }
    write_bytes(path, existing, &bytes)?;
    Ok(())
}
