//! `impactlab evaluate reconstruction`: how well the speeds of staged collisions are reconstructed.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::files::{RECONSTRUCTION_EVALUATION_FILES, write_reconstruction_evaluation};
use crate::cli::options::{OverwriteArg, UNITS, Values, count, one_value_of};
use crate::cli::text::print_answer;
use impactlab_core::ranges::RECONSTRUCTION_PARTICLES;
use impactlab_core::units::UnitSystem;
use impactlab_reconstruct::evaluate::{KnownEvidence, StagedSplit};
use impactlab_study::{EvaluateReconstructionRequest, Question, ReconstructRequest};

/// How much of the evidence is used.
const KNOWN: Values<KnownEvidence> = &[
    (KnownEvidence::Everything, "All of it"),
    (KnownEvidence::WithoutEdr, "All but the event data recorder"),
    (KnownEvidence::RestOnly, "The rest poses, with damage, masses and friction"),
];

/// Which cases of the folder.
const CASES: Values<StagedSplit> = &[
    (StagedSplit::All, "All of them"),
    (StagedSplit::Tuning, "The first half in the order of the SHA-256 of their names"),
    (StagedSplit::Reported, "The other half"),
];

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct EvaluateReconstructionArgs {
    /// A folder of staged collisions: evidence/CASE.toml and truth/CASE.toml
    #[arg(value_name = "DIR")]
    data: PathBuf,
    /// How much of the evidence is used; may be given several times; all three without
    #[arg(long, value_parser = one_value_of(KNOWN), value_name = "WHAT")]
    known: Vec<KnownEvidence>,
    /// Which of the cases
    #[arg(long, value_parser = one_value_of(CASES), default_value = "all")]
    cases: StagedSplit,
    /// Only those of them that have these names
    #[arg(long, num_args = 1.., value_name = "NAME")]
    only: Vec<String>,
    /// Number of particles
    #[arg(long, value_name = "N", default_value_t = ReconstructRequest::DEFAULT_PARTICLES,
        value_parser = count::<usize>(RECONSTRUCTION_PARTICLES))]
    particles: usize,
    /// Seed of all draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Leave out the most probable point, found by a particle swarm
    #[arg(long)]
    without_swarm: bool,
    /// Folder for evaluation.json and evaluation.csv; each case that is finished is kept in finished/
    /// there, and taken from there when the same program is asked again
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Units of the text (JSON and CSV are always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

const EXAMPLES: &str = "\
Examples:
  impactlab evaluate reconstruction datasets/staged --only s00 s01 --known everything
  impactlab evaluate reconstruction datasets/staged --cases reported --out evaluation

The truth is read after the last reconstruction. The calculation by hand knows no speed of the striking
car, and its closing speed is that across the struck side. The swarm's intervals are those of the
curvature at its optimum.

JSON: impactlab schema evaluate-reconstruction --answer says every key with its unit";

/// Evaluates.
pub(in crate::cli) fn run(
    args: &EvaluateReconstructionArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let out = args.out.as_deref();
    let usual = EvaluateReconstructionRequest::new(&args.data);
    let request = EvaluateReconstructionRequest {
        known: if args.known.is_empty() { usual.known } else { args.known.clone() },
        split: args.cases,
        only: args.only.clone(),
        particles: args.particles,
        seed: args.seed,
        swarm: !args.without_swarm,
        finished: out.map(|folder| folder.join("finished")),
        ..usual
    };
    let known = &RECONSTRUCTION_EVALUATION_FILES[..];
    let out = out.map(|folder| (folder, args.overwrite.into(), known));
    let answer = console.ask_into(&request, out, |output, answer| {
        write_reconstruction_evaluation(output.staging(), &answer.report)?;
        Ok(answer.report.provenance.clone())
    })?;
    let Some(answer) = answer else { return Ok(Verdict::Clean) };
    let units = args.units;
    console.print(&answer.report, |out| print_answer(out, &answer.report, units))?;
    Ok(Verdict::from_problems(EvaluateReconstructionRequest::has_problems(&answer.report)))
}
