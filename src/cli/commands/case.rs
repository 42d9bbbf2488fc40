//! `impactlab case`: asks a case its questions, and hands it over with its files.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_json, shown_path, under_bar, within_line};
use crate::cli::options::{OverwriteArg, TrustArg, UNITS, one_value_of};
use crate::cli::text::print_answer;
use impactlab_core::units::UnitSystem;
use impactlab_study::Report;
use impactlab_study::case_file::{
    AnsweredQuestion, CaseFile, CaseOnDisk, CaseReport, Change, PackedFile, Reach, UsedFile,
    VariantReport, pack, unpack,
};

/// Run, check, pack or unpack a case, as the window saves it
#[derive(Debug, Args)]
pub(in crate::cli) struct CaseArgs {
    #[command(subcommand)]
    command: CaseCommand,
}

#[derive(Debug, Subcommand)]
enum CaseCommand {
    Run(RunArgs),
    Check(CheckArgs),
    Pack(PackArgs),
    Unpack(UnpackArgs),
}

/// Answer every question of a case
#[derive(Debug, Args)]
#[command(after_help = RUN_EXAMPLES)]
struct RunArgs {
    /// The case
    #[arg(value_name = "CASE.impactlab")]
    case: PathBuf,
    /// Only this variant; several if given again
    #[arg(long, value_name = "NAME")]
    variant: Vec<String>,
    #[command(flatten)]
    trust: TrustArg,
    /// Units of the text
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

const RUN_EXAMPLES: &str = "\
Example:
  impactlab case run assets/examples/pit.impactlab
  impactlab case run assets/examples/pit.impactlab --variant \"brakes\" --json

JSON: impactlab schema case --answer says every key with its unit

Exit code 1 if a question has no answer, or one that its own command ends with 1 for too, or if the case,
a file or a network is not what it was when the case was saved.";

/// Say what is in a case, and whether its files are what they were
#[derive(Debug, Args)]
#[command(after_help = "\
JSON: name, notes, shown, variants [{name, notes, questions [..]}], files [{path, bytes, sha256}], models
  [{network, name, sha256}], log [{time, event}], unused [..] (what is filled in and not asked), sha256 (of
  the file itself), is_as_saved (whether nobody has edited it since; null without a seal), changes [{kind,
  path}], reach {reads [..], writes [..], trains}

What the case does beyond reading files in its own folder is reach. None of its files is read then, and
nothing is said of changes of theirs, unless --trust is given.

Exit code 1 if a file is missing or has changed, if the case itself was edited since it was saved, or if
the case does more than read files in its own folder.")]
struct CheckArgs {
    /// The case
    #[arg(value_name = "CASE.impactlab")]
    case: PathBuf,
    #[command(flatten)]
    trust: TrustArg,
}

/// Write one zip of a case and every file that its questions use, and list them
#[derive(Debug, Args)]
#[command(after_help = "\
JSON: out, files [{name, path}]: the name of each file in the zip, and where it was read;
  networks_in_no_file [..], which the zip does not have")]
struct PackArgs {
    /// The case
    #[arg(value_name = "CASE.impactlab")]
    case: PathBuf,
    #[command(flatten)]
    trust: TrustArg,
    /// Pack what is asked alone, such as for the other side: nothing that is filled in and not asked, nothing of
    /// how the window draws it
    #[arg(long)]
    asked: bool,
    /// The zip
    #[arg(long, value_name = "FILE.zip")]
    out: PathBuf,
    #[command(flatten)]
    overwrite: OverwriteArg,
}

/// Make a new folder of a zip that `case pack` has written
#[derive(Debug, Args)]
#[command(after_help = "\
Exit code 1 if a file is not what was packed; it is unpacked then too, and named.")]
struct UnpackArgs {
    /// The zip
    #[arg(value_name = "FILE.zip")]
    package: PathBuf,
    /// The folder, which must not be there yet
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl CaseArgs {
    /// Whether the command asks questions.
    pub(in crate::cli) fn asks(&self) -> bool {
        matches!(self.command, CaseCommand::Run(_))
    }
}

/// Carries out the command.
pub(in crate::cli) fn run(args: &CaseArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    match &args.command {
        CaseCommand::Run(args) => run_case(args, console),
        CaseCommand::Check(args) => check_case(args, console),
        CaseCommand::Pack(args) => pack_case(args, console),
        CaseCommand::Unpack(args) => unpack_case(args, console),
    }
}

fn unpack_case(args: &UnpackArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let path = unpack(&args.package, &args.out)?;
    let case = CaseFile::load(&path)?;
    // Nothing elsewhere is looked at for a case of somebody else.
    let of_files = if case.reach(&path).is_empty() { case.changes() } else { Vec::new() };
    let own = CaseOnDisk::read(&path)?.change();
    let changes: Vec<Change> = of_files.into_iter().chain(own).collect();
    writeln!(console.out, "{}", shown_path(&path))?;
    print_changes(console.out, &changes)?;
    Ok(Verdict::from_problems(!changes.is_empty()))
}

fn run_case(args: &RunArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let case = CaseFile::load(&args.case)?;
    if console.print_request {
        print_json(console.out, &case.variants)?;
        return Ok(Verdict::Clean);
    }
    args.trust.check(&case, &args.case)?;
    let report = under_bar(|observer| case.ask(&args.variant, &console.library, observer))?;
    let mut report = report.complete().ok_or(CliError::Cancelled)?;
    report.changes.extend(CaseOnDisk::read(&args.case)?.change());
    console.print(&report, |out| print_case(out, &report, args.units))?;
    Ok(Verdict::from_problems(!report.is_clean()))
}

/// What `case pack` tells.
#[derive(Serialize)]
struct Package<'a> {
    out: &'a Path,
    files: &'a [PackedFile],
    #[serde(skip_serializing_if = "<[&str]>::is_empty")]
    networks_in_no_file: &'a [&'a str],
}

fn pack_case(args: &PackArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let mut case = CaseFile::load(&args.case)?;
    if args.asked {
        case = case.asked(&[])?;
    }
    args.trust.check(&case, &args.case)?;
    console.check_target(Some(&args.out), args.overwrite.into())?;
    console.reads(std::slice::from_ref(&args.case))?;
    let edited = CaseOnDisk::read(&args.case)?.change();
    if edited.is_some() {
        case.note("packed; edited since it was saved");
    }
    let files = pack(&case, &args.out, args.overwrite.into())?;
    let networks = case.networks_in_no_file();
    let packed = Package { out: &args.out, files: &files, networks_in_no_file: &networks };
    console.print(&packed, |out| {
        for PackedFile { name, path } in &files {
            writeln!(out, "{name}: {}", shown_path(path))?;
        }
        writeln!(out, "{} written", shown_path(&args.out))?;
        for unused in case.unused() {
            writeln!(out, "note: {}", within_line(&unused))?;
        }
        for name in &networks {
            let name = within_line(name);
            writeln!(
                out,
                "warning: the network {name} is in no file and so not in the package; save it in the window that trained it"
            )?;
        }
        print_changes(out, edited.as_slice())
    })?;
    Ok(Verdict::Clean)
}

/// What `case check` tells.
#[derive(Serialize)]
struct CheckedCase<'a> {
    #[serde(flatten)]
    case: &'a CaseFile,
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    unused: &'a [String],
    sha256: &'a str,
    is_as_saved: Option<bool>,
    changes: &'a [Change],
    #[serde(skip_serializing_if = "Reach::is_empty")]
    reach: &'a Reach,
}

fn check_case(args: &CheckArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let case = CaseFile::load(&args.case)?;
    let reach = case.reach(&args.case);
    let is_untrusted = args.trust.check(&case, &args.case).is_err();
    let own = CaseOnDisk::read(&args.case)?;
    let of_files = if is_untrusted { Vec::new() } else { case.changes() };
    let changes: Vec<Change> = of_files.into_iter().chain(own.change()).collect();
    let unused = case.unused();
    let checked = CheckedCase {
        case: &case,
        unused: &unused,
        sha256: &own.file.sha256,
        is_as_saved: own.is_as_saved,
        changes: &changes,
        reach: &reach,
    };
    console.print(&checked, |out| {
        writeln!(out, "{}", case.name)?;
        writeln!(out, "the case itself, {} bytes, SHA-256 {}", own.file.bytes, own.file.sha256)?;
        if !case.notes.is_empty() {
            writeln!(out, "{}", case.notes)?;
        }
        for variant in &case.variants {
            let mark = if variant.name == case.shown { " (shown)" } else { "" };
            let n = variant.questions.len();
            let noun = if n == 1 { "question" } else { "questions" };
            writeln!(out, "variant {}{mark}: {n} {noun}", variant.name)?;
            for line in variant.notes.lines() {
                writeln!(out, "  {}", within_line(line))?;
            }
        }
        for unused in &unused {
            writeln!(out, "note: {}", within_line(unused))?;
        }
        for UsedFile { path, bytes, sha256 } in &case.files {
            writeln!(out, "file {}, {bytes} bytes, SHA-256 {sha256}", shown_path(path))?;
        }
        for model in &case.models {
            writeln!(out, "{} network {}, SHA-256 {}", model.network, model.name, model.sha256)?;
        }
        for entry in &case.log {
            writeln!(out, "{} {}", entry.time, entry.event)?;
        }
        for phrase in reach.phrases() {
            writeln!(out, "warning: {}", within_line(&phrase))?;
        }
        if is_untrusted {
            writeln!(out, "none of its files was looked at; --trust does")?;
        }
        print_changes(out, &changes)
    })?;
    Ok(Verdict::from_problems(is_untrusted || !changes.is_empty()))
}

fn print_changes(out: &mut dyn Write, changes: &[Change]) -> io::Result<()> {
    changes.iter().try_for_each(|change| writeln!(out, "warning: {change}"))
}

fn print_case(out: &mut dyn Write, report: &CaseReport, units: UnitSystem) -> io::Result<()> {
    writeln!(out, "{}", report.name)?;
    for VariantReport { name, answers } in &report.variants {
        writeln!(out, "\n== {name}")?;
        for answer in answers {
            writeln!(out)?;
            print_question(out, answer, units)?;
        }
    }
    print_changes(out, &report.changes)
}

fn print_question(
    out: &mut dyn Write,
    answer: &AnsweredQuestion,
    units: UnitSystem,
) -> io::Result<()> {
    match (&answer.report, &answer.error) {
        (Some(Report::Check(report)), _) => print_answer(out, &**report, units),
        (Some(Report::Impact(report)), _) => print_answer(out, &**report, units),
        (Some(Report::Hand(report)), _) => print_answer(out, &**report, units),
        (Some(Report::Replay(report)), _) => print_answer(out, &**report, units),
        (Some(Report::Simulate(report)), _) => print_answer(out, &**report, units),
        (Some(Report::PredictForce(report)), _) => print_answer(out, &**report, units),
        (Some(Report::PredictMotion(report)), _) => print_answer(out, &**report, units),
        (Some(Report::Reconstruct(report)), _) => print_answer(out, &**report, units),
        (Some(_), _) => writeln!(out, "answered; --json prints it"),
        (None, error) => writeln!(out, "no answer: {}", error.as_deref().unwrap_or_default()),
    }
}
