//! `impactlab export`: the scene or the motion of a case for other programs.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::commands::render_scene::{BuiltScene, CaseArgs, build};
use crate::cli::console::{Console, Verdict, print_json, shown_path};
use crate::cli::options::{OverwriteArg, number};
use impactlab_core::data::{write_atomically, write_restricted_series_csv};
use impactlab_core::ranges::INSTANT;
use impactlab_core::units::UnitSystem;
use impactlab_document::exchange::{
    DxfOptions, ExchangeError, GltfFrame, dxf, glb, hve_motion, hve_pulse,
};

/// Write the scene or the motion of a case for other programs: DXF, glTF, CSV, tables for HVE
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct ExportArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// What is written; if not given, it follows from the ending of the file
    #[arg(long, value_enum)]
    format: Option<FormatArg>,
    /// Into a drawing, the outlines of the cars at this moment; several times for several moments; the
    /// first and the last moment if not given
    #[arg(long, value_name = "TIME", value_parser = number(INSTANT))]
    at: Vec<f64>,
    /// The file
    #[arg(long, value_name = "FILE.dxf|FILE.glb|FILE.csv|FILE.txt")]
    out: PathBuf,
    #[command(flatten)]
    overwrite: OverwriteArg,
}

const EXAMPLES: &str = "\
Examples:
  impactlab export datasets/trajectories-fea --case FE_c002 --at 0 --at 1 --at 2 --out paths.dxf
  impactlab export pit-right-rear --out scene.glb
  impactlab export datasets/trajectories-fea --case FE_c002 --format hve-pulse --out pulse.txt

Formats: dxf is in metres, a layer for each role, restrictions as text; glb has the cars with their
animation, Y up, for Blender and browsers; motion is CSV in SI units; hve-pulse and hve-motion are rows
with tabs between them in the units and axes of HVE, to be pasted into its tables.

JSON: out, format, title, notes";

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
enum FormatArg {
    /// A drawing in metres: paths, outlines, lines and points (.dxf)
    Dxf,
    /// The scene with its animation in 3D (.glb)
    Glb,
    /// The motion of the struck car over time, SI units (.csv)
    Motion,
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
        Some(format) => format,
        None => format_of(&args.out)?,
    };
    if format != FormatArg::Dxf && !args.at.is_empty() {
        return Err(CliError::OutlinesOfDrawing);
    }
    console.check_target(Some(&args.out), args.overwrite.into())?;
    let built = build(&args.case, None, UnitSystem::Si, console)?;
    for time_s in &args.at {
        built.check_time("--at", *time_s)?;
    }
    write(args, (format, &built))?;
    let mut notes = built.notes.clone();
    if format == FormatArg::Glb {
        notes.extend(GltfFrame::new(&built.scene).notes());
    }
    let (out, title, notes) = (&args.out, &built.scene.title, notes.as_slice());
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

/// The format that belongs to the ending of a file.
fn format_of(path: &Path) -> Result<FormatArg, CliError> {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_deref().and_then(|ending| ending.to_str()) {
        Some("dxf") => Ok(FormatArg::Dxf),
        Some("glb") => Ok(FormatArg::Glb),
        Some("csv") => Ok(FormatArg::Motion),
        _ => Err(CliError::ExportKind { path: path.to_owned() }),
    }
}

fn write(args: &ExportArgs, (format, built): (FormatArg, &BuiltScene)) -> Result<(), CliError> {
    let BuiltScene { scene, analysis, .. } = built;
    let (path, existing) = (&args.out, args.overwrite.into());
    let restrictions = scene.caveats.text();
    let mut bytes = Vec::new();
    match format {
        FormatArg::Dxf => {
            let outlines_s = match args.at.is_empty() {
                true => vec![built.start_s(), scene.end_s],
                false => args.at.clone(),
            };
            dxf(scene, &DxfOptions { outlines_s }, &mut bytes)?;
        }
        FormatArg::Glb => glb(scene, &mut bytes)?,
        FormatArg::HvePulse => hve_pulse(analysis, restrictions.as_deref(), &mut bytes)?,
        FormatArg::HveMotion => hve_motion(analysis, restrictions.as_deref(), &mut bytes)?,
        FormatArg::Motion => {
            let simulated = analysis.simulation.as_ref().map(|motion| &motion.series);
            let unknown = || ExchangeError::Unknown { name: analysis.name.clone(), what: "motion" };
            let series = simulated.or(analysis.reference.as_ref()).ok_or_else(unknown)?;
            return Ok(write_restricted_series_csv(
                path,
                existing,
                series,
                restrictions.as_deref(),
            )?);
        }
    }
    write_atomically(path, existing, |out: &mut dyn Write| -> io::Result<()> {
        out.write_all(&bytes)
    })?;
    Ok(())
}
