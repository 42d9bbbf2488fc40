//! `impactlab reconstruct`: from the evidence to the speeds.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::files::write_reconstruction;
use crate::cli::options::{EvidenceArgs, OverwriteArg, UNITS, one_value_of};
use crate::cli::text::print_answer;
use impactlab_core::units::UnitSystem;
use impactlab_study::{Answer, ReconstructReport, ReconstructRequest};

/// From the evidence to the speeds before the impact, or of a single car at the start, as a distribution
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct ReconstructArgs {
    #[command(flatten)]
    evidence: EvidenceArgs,
    /// Save the run in this file as it goes; another one that exists is not replaced
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Go on from the checkpoint, if it is there
    #[arg(long, requires = "checkpoint")]
    resume: bool,
    /// Folder for the report and the particles
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

const EXAMPLES: &str = "\
Example:
  impactlab reconstruct case.toml --out case-result

World axes: origin at the CG of the struck car at first contact, X along its heading, Y to the left;
those of a single car (kind = \"single_car\") are free.
A site file has the same axes; its friction is known within 15 %, in all zones alike.
How often the intervals hold was tried on simulated collisions only: docs/guide/limits.md.
Whoever hit a flank behind the CG is taken to have matched the speed, as in a PIT manoeuvre; [prior] in
the evidence file says otherwise.

JSON: impactlab schema reconstruct --answer says every key with its unit;
  and out, the folder of the files";

/// Files that are written.
const KNOWN_FILES: [&str; 2] = ["particles.csv", "reconstruction.json"];

/// The report, and where its files are.
#[derive(Debug, Serialize)]
struct PrintedReconstruction<'a> {
    #[serde(flatten)]
    report: &'a Answer<ReconstructReport>,
    out: Option<&'a Path>,
}

/// Reconstructs a case.
pub(in crate::cli) fn run(
    args: &ReconstructArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = ReconstructRequest {
        checkpoint: args.checkpoint.clone(),
        resume: args.resume,
        ..args.evidence.request()
    };
    console.keeps(args.checkpoint.as_deref());
    let out = args.out.as_deref();
    let into = out.map(|folder| (folder, args.overwrite.into(), &KNOWN_FILES[..]));
    let answer = console.ask_into(&request, into, |output, answer| {
        // What lies in the folder does not say where the folder is.
        let printed = PrintedReconstruction { report: &answer.report, out: None };
        write_reconstruction(output.staging(), answer, &printed)?;
        Ok(answer.report.provenance.clone())
    })?;
    let Some(answer) = answer else { return Ok(Verdict::Clean) };
    let printed = PrintedReconstruction { report: &answer.report, out };
    console.print(&printed, |out| print_answer(out, &answer.report, args.units))?;
    Ok(Verdict::Clean)
}
