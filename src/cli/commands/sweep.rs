//! `impactlab sweep`: one question many times, on one machine or on many.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, ValueEnum};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, shown_path, under_bar, within_line};
use crate::cli::options::OverwriteArg;
use impactlab_core::jobs::Progress;
use impactlab_study::Event;
use impactlab_sweep::{
    PLAN_FILE, Plan, RunReport, SweepStatus, chunk_path, chunks_of_task, merge, n_tasks,
    parse_array, run_chunks, slurm_script,
};

/// Ask one question many times, with inputs that vary
///
/// A plan says what is asked, what varies and how; it is resolved into a folder. Its rows are computed in
/// chunks, each a Parquet file, in any order and on any machine: row i depends on the plan alone.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct SweepArgs {
    #[command(subcommand)]
    what: SweepCommand,
}

const EXAMPLES: &str = "\
Examples:
  impactlab sweep plan pit.toml --out pit
  impactlab sweep run pit
  impactlab sweep status pit
  impactlab sweep merge pit --out pit.parquet

On a cluster:
  impactlab sweep script slurm pit > pit.sh
  bash pit.sh

JSON:
  plan    {plan, plan_sha256, rows, chunks, inputs, outcomes}
  run     {computed, kept, replaced: [[chunk, reason], …], rows, failed}
  status  {name, plan_sha256, rows, chunks, chunks_done, rows_done, rows_failed, missing, broken,
           reasons: [[reason, rows], …]}; with --missing the array expression alone
  merge   {chunks, rows, failed}
  script  {tasks, script}";

#[derive(Debug, Subcommand)]
enum SweepCommand {
    /// Resolve a plan into a folder
    Plan(PlanArgs),
    /// Compute chunks; those that are there are kept
    Run(RunArgs),
    /// Say what is done, missing and failed
    Status(StatusArgs),
    /// Write all chunks into one table, after checking each
    Merge(MergeArgs),
    /// Print the batch file for a cluster
    Script(ScriptArgs),
}

#[derive(Debug, Args)]
struct PlanArgs {
    /// The plan
    #[arg(value_name = "PLAN.toml")]
    plan: PathBuf,
    /// Folder of the sweep; it is made if it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Debug, Args)]
struct RunArgs {
    /// Folder of the sweep
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// This chunk alone, from 0
    #[arg(long, value_name = "I", conflicts_with_all = ["chunks", "array"])]
    chunk: Option<u64>,
    /// These chunks: from A up to before B, as A..B, or a list such as 7,19-23
    #[arg(long, value_name = "A..B", value_parser = chunk_list, conflicts_with = "array")]
    chunks: Option<ChunkList>,
    /// The chunks of this task of a Slurm job array
    #[arg(long)]
    array: bool,
    /// Task t of the array has every N-th chunk from t on, whichever other tasks there are
    #[arg(long, value_name = "N", requires = "array", conflicts_with_all = ["chunk", "chunks"])]
    #[arg(value_parser = clap::value_parser!(u64).range(1..))]
    stride: Option<u64>,
}

#[derive(Debug, Args)]
struct StatusArgs {
    /// Folder of the sweep
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Print nothing but the missing chunks, as an array expression
    #[arg(long)]
    missing: bool,
    /// The tasks that have the missing chunks, where each has every N-th chunk
    #[arg(long, value_name = "N", requires = "missing")]
    #[arg(value_parser = clap::value_parser!(u64).range(1..))]
    stride: Option<u64>,
}

#[derive(Debug, Args)]
struct MergeArgs {
    /// Folder of the sweep
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The table
    #[arg(long, value_name = "FILE.parquet")]
    out: PathBuf,
    #[command(flatten)]
    overwrite: OverwriteArg,
}

#[derive(Debug, Args)]
struct ScriptArgs {
    /// For which system
    #[arg(value_enum)]
    system: BatchSystem,
    /// Folder of the sweep, as the nodes find it
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The program, as the nodes find it; this one if not given
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum BatchSystem {
    /// Slurm
    Slurm,
}

/// Numbers of chunks.
#[derive(Debug, Clone)]
struct ChunkList(Vec<u64>);

/// Most chunks that are listed in an argument.
const MOST_LISTED: u64 = impactlab_sweep::MOST_CHUNKS;

fn chunk_list(text: &str) -> Result<ChunkList, String> {
    let expected = || "expected A..B with A < B, or a list such as 7,19-23".to_owned();
    let Some((first, end)) = text.split_once("..") else {
        let chunks = parse_array(text).filter(|chunks| !chunks.is_empty());
        return chunks.map(ChunkList).ok_or_else(expected);
    };
    match (first.parse::<u64>(), end.parse::<u64>()) {
        (Ok(first), Ok(end)) if first < end && end - first <= MOST_LISTED => {
            Ok(ChunkList((first..end).collect()))
        }
        _ => Err(expected()),
    }
}

/// Does what was asked for.
pub(in crate::cli) fn run(
    args: &SweepArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    match &args.what {
        SweepCommand::Plan(args) => plan(args, console),
        SweepCommand::Run(args) => run_some(args, console),
        SweepCommand::Status(args) => status(args, console),
        SweepCommand::Merge(args) => merge_all(args, console),
        SweepCommand::Script(args) => script(args, console),
    }
}

/// What is told of a plan.
#[derive(Debug, Serialize)]
struct PlannedReport {
    plan: PathBuf,
    plan_sha256: String,
    rows: u64,
    chunks: u64,
    inputs: Vec<String>,
    outcomes: Vec<String>,
}

fn plan(args: &PlanArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let plan = Plan::read(&args.plan, &console.library)?;
    plan.write(&args.out)?;
    let report = PlannedReport {
        plan: args.out.join(PLAN_FILE),
        plan_sha256: plan.sha256(),
        rows: plan.n_rows(),
        chunks: plan.n_chunks(),
        inputs: plan.vary.iter().map(|vary| vary.name.clone()).collect(),
        outcomes: plan.outcomes().into_iter().map(|(name, _)| name).collect(),
    };
    console.print(&report, |out| {
        writeln!(
            out,
            "{}: {} rows in {} chunks, {} inputs that vary, {} outcomes",
            shown_path(&report.plan),
            report.rows,
            report.chunks,
            report.inputs.len(),
            report.outcomes.len()
        )?;
        writeln!(out, "plan {}", report.plan_sha256)
    })?;
    Ok(Verdict::Clean)
}

fn run_some(args: &RunArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let n_chunks = Plan::stored(&args.folder)?.n_chunks();
    let chunks = match (args.chunk, &args.chunks, args.array) {
        (Some(chunk), _, _) => vec![chunk],
        (None, Some(list), _) => list.0.clone(),
        (None, None, true) => {
            chunks_of_task(n_chunks, args.stride, |name| std::env::var(name).ok())?
        }
        (None, None, false) => (0..n_chunks).collect(),
    };
    let library = &console.library;
    let report = under_bar(|observer| {
        let mut progress = |progress: Progress| observer(Event::Progress(progress));
        run_chunks(&args.folder, &chunks, library, &mut progress)
    })?;
    console.print(&report, |out| {
        let RunReport { computed, kept, replaced, rows, failed } = &report;
        for (chunk, what) in replaced {
            let path = chunk_path(&args.folder, *chunk);
            writeln!(out, "{}: computed anew: {}", shown_path(&path), within_line(what))?;
        }
        writeln!(
            out,
            "{} chunks computed, {rows} rows, {failed} of them failed; {} chunks were there",
            computed.len(),
            kept.len()
        )
    })?;
    Ok(Verdict::Clean)
}

fn status(args: &StatusArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let (_, status) = SweepStatus::read(&args.folder)?;
    if args.missing {
        let missing = match args.stride {
            Some(stride) => status.missing_tasks(stride),
            None => status.missing.clone(),
        };
        console.print(&missing, |out| writeln!(out, "{missing}"))?;
        return Ok(Verdict::Clean);
    }
    console.print(&status, |out| {
        writeln!(out, "{}", within_line(&status.name))?;
        writeln!(out, "chunks   {} of {}", status.chunks_done, status.chunks)?;
        writeln!(out, "rows     {} of {}", status.rows_done, status.rows)?;
        writeln!(out, "failed   {}", status.rows_failed)?;
        for (reason, n) in &status.reasons {
            writeln!(out, "         {n} × {}", within_line(reason))?;
        }
        for (chunk, what) in &status.broken {
            let path = chunk_path(&args.folder, *chunk);
            writeln!(out, "broken   {}: {}", shown_path(&path), within_line(what))?;
        }
        let missing: &str = if status.missing.is_empty() { "none" } else { &status.missing };
        writeln!(out, "missing  {missing}")
    })?;
    Ok(Verdict::from_problems(!status.broken.is_empty()))
}

fn merge_all(args: &MergeArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let existing = args.overwrite.into();
    let n_chunks = Plan::stored(&args.folder)?.n_chunks();
    console.check_target(Some(&args.out), existing)?;
    let chunks = (0..n_chunks).map(|chunk| chunk_path(&args.folder, chunk));
    let read: Vec<PathBuf> = chunks.chain([args.folder.join(PLAN_FILE)]).collect();
    console.reads(&read)?;
    let report = under_bar(|observer| {
        let mut progress = |progress: Progress| observer(Event::Progress(progress));
        merge(&args.folder, &args.out, existing, &mut progress)
    })?;
    console.print(&report, |out| {
        let (rows, chunks) = (report.rows, report.chunks);
        let path = shown_path(&args.out);
        writeln!(out, "{path}: {rows} rows of {chunks} chunks, {} failed", report.failed)
    })?;
    Ok(Verdict::Clean)
}

fn script(args: &ScriptArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let BatchSystem::Slurm = args.system;
    let plan = Plan::stored(&args.folder)?;
    let folder = absolute(&args.folder);
    let program = match &args.program {
        Some(program) => program.clone(),
        None => std::env::current_exe().unwrap_or_else(|_| PathBuf::from("impactlab")),
    };
    let text = slurm_script(&plan, &folder, &program)?;
    console.print(&PrintedScript { tasks: n_tasks(&plan), script: &text }, |out| {
        out.write_all(text.as_bytes())
    })?;
    Ok(Verdict::Clean)
}

/// A batch file.
#[derive(Debug, Serialize)]
struct PrintedScript<'a> {
    tasks: u64,
    script: &'a str,
}

/// The path from the root of the file system, where there is one.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}
