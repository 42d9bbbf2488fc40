//! `impactlab report`: the report that an expert signs.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_json, shown_path, under_bar};
use crate::cli::options::{OverwriteArg, TrustArg, UNITS, Values, count, one_value_of};
use impactlab_core::data::write_bytes;
use impactlab_core::ranges::RECONSTRUCTION_PARTICLES;
use impactlab_core::units::UnitSystem;
use impactlab_document::report::{
    Drawing, Language, Paper, ReportDate, ReportFormat, ReportSettings, report_case,
};
use impactlab_study::case_file::{CaseFile, CaseOnDisk, Change, Variant};
use impactlab_study::{EvidenceChoice, InputKind, ReconstructRequest};

/// Write the report of a case: answers, inputs, evidence, method, validity, sources
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct ReportArgs {
    /// The case, or the evidence of a collision, which is reconstructed with the usual settings
    #[arg(value_name = "CASE.impactlab|EVIDENCE.toml")]
    case: PathBuf,
    /// The file: .pdf, .md or .json
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    overwrite: OverwriteArg,
    #[command(flatten)]
    trust: TrustArg,
    /// Of an evidence file: number of particles; a case says it itself
    #[arg(long, value_name = "N", value_parser = count::<usize>(RECONSTRUCTION_PARTICLES))]
    particles: Option<usize>,
    /// Of an evidence file: seed of all draws; a case says it itself
    #[arg(long)]
    seed: Option<u64>,
    /// Of an evidence file: the ground, in whose friction zones the wheels stand; a case says it itself
    #[arg(long, value_name = "SITE.toml")]
    site: Option<PathBuf>,
    /// Only this variant; several if given again
    #[arg(long, value_name = "NAME")]
    variant: Vec<String>,
    /// Language
    #[arg(long, value_parser = one_value_of(LANGUAGES), default_value = "en")]
    language: Language,
    /// Units of the numbers
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
    /// Size of the pages; letter with US units and A4 with others if not given
    #[arg(long, value_parser = one_value_of(PAPERS))]
    paper: Option<Paper>,
    /// The date that the report bears; today in UTC if not given
    #[arg(long, value_name = "YYYY-MM-DD")]
    date: Option<ReportDate>,
}

const EXAMPLES: &str = "\
Examples:
  impactlab report assets/examples/pit.impactlab --out report.pdf
  impactlab report case.toml --out bericht.pdf --language de --paper a4
  impactlab report assets/examples/pit.impactlab --out report.md --units us --date 2026-11-24

Every question of the case is asked, as `impactlab case run` does. The same case, files and date give the
same bytes.

JSON: out, title, date, sections, pictures, unanswered, changes [{kind, path | network and name}]

Exit code 1 if a question has no answer, or if the case, a file or a network is not what it was when the
case was saved. The report is written then too, and says so.";

const LANGUAGES: Values<Language> = &[(Language::En, "English"), (Language::De, "German")];

const PAPERS: Values<Paper> = &[(Paper::A4, "210 mm × 297 mm"), (Paper::Letter, "8.5 in × 11 in")];

/// What was written.
#[derive(Debug, Serialize)]
struct WrittenReport<'a> {
    out: &'a Path,
    title: &'a str,
    date: &'a str,
    sections: usize,
    pictures: usize,
    unanswered: usize,
    changes: &'a [Change],
}

/// Asks the questions and writes the report.
pub(in crate::cli) fn run(
    args: &ReportArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let format = ReportFormat::from_path(&args.out)?;
    if console.print_request {
        print_json(console.out, &args.case()?.variants)?;
        return Ok(Verdict::Clean);
    }
    console.check_target(Some(&args.out), args.overwrite.into())?;
    let case = args.case()?;
    if InputKind::from_path(&args.case) == InputKind::Case {
        args.trust.check(&case, &args.case)?;
    }
    console.reads(std::slice::from_ref(&args.case))?;
    console.reads(&case.input_files())?;
    let settings = args.settings()?;
    let is_case = InputKind::from_path(&args.case) == InputKind::Case;
    let on_disk = is_case.then(|| CaseOnDisk::read(&args.case)).transpose()?;
    let outcome = under_bar(|observer| {
        let (on_disk, variants) = (on_disk.as_ref(), args.variant.as_slice());
        report_case(&case, on_disk, variants, &settings, &console.library, observer)
    })?;
    let (document, report) = outcome.complete().ok_or(CliError::Cancelled)?;
    let bytes = document
        .bytes(format, DRAWING)
        .map_err(|source| CliError::Report { path: args.out.clone(), source })?;
    write_bytes(&args.out, args.overwrite.into(), &bytes)?;
    let answers = report.variants.iter().flat_map(|variant| &variant.answers);
    let written = WrittenReport {
        out: &args.out,
        title: &document.title,
        date: &document.date_iso,
        sections: document.sections.len(),
        pictures: document.pictures().count(),
        unanswered: answers.filter(|answer| answer.error.is_some()).count(),
        changes: &report.changes,
    };
    console.print(&written, |out| {
        writeln!(out, "{}: {}", shown_path(&args.out), document.title)?;
        if written.unanswered > 0 {
            writeln!(out, "warning: questions without an answer: {}", written.unanswered)?;
        }
        report.changes.iter().try_for_each(|change| writeln!(out, "warning: {change}"))
    })?;
    Ok(Verdict::from_problems(!report.is_clean()))
}

impl ReportArgs {
    /// The case; of evidence alone, one that asks for its reconstruction.
    fn case(&self) -> Result<CaseFile, CliError> {
        let path = &self.case;
        if InputKind::from_path(path) == InputKind::Case {
            return match (self.particles, self.seed, &self.site) {
                (None, None, None) => Ok(CaseFile::load(path)?),
                _ => Err(CliError::ReportOfCase { path: path.clone() }),
            };
        }
        let io = |source| CliError::ReportInput { path: path.clone(), source };
        let absolute = |path: &PathBuf| std::path::absolute(path).map_err(io);
        let choice = EvidenceChoice::File(absolute(path)?);
        let name = choice.load()?.case;
        let question = ReconstructRequest {
            particles: self.particles.unwrap_or(ReconstructRequest::DEFAULT_PARTICLES),
            seed: self.seed.unwrap_or_default(),
            site: self.site.as_ref().map(absolute).transpose()?,
            ..ReconstructRequest::new(choice)
        };
        let questions = vec![question.into()];
        Ok(CaseFile::new(name.clone(), Variant { name, questions, ..Variant::default() }))
    }

    fn settings(&self) -> Result<ReportSettings, CliError> {
        let (language, units) = (self.language, self.units);
        let paper = self.paper.unwrap_or_else(|| Paper::usual(units));
        let today = || ReportDate::from_instant(SystemTime::now());
        let date = self.date.or_else(today).ok_or(CliError::NoClock)?;
        Ok(ReportSettings { language, units, paper, date })
    }
}

/// Draws the pictures.
const DRAWING: Option<&Drawing<'static>> = Some(&impactlab_draw::report_drawing);
