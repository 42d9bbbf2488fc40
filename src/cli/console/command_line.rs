//! Where a command asks and prints, and how it ended.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{print_json, under_bar, within_line};
use crate::data::write::{FileDigest, OutputFolder, RunRecord};
use crate::data::{Existing, check_target};
use crate::study::{Assumption, Library, Provenance, Question, Request};
use crate::uncertainty::Badge;

/// How a command that did not fail ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum Verdict {
    /// All is well.
    Clean,
    /// The work was done and found problems, which were printed.
    Problems,
}

impl Verdict {
    /// The verdict on a list of problems.
    pub(in crate::cli) fn of(problems: bool) -> Self {
        if problems { Self::Problems } else { Self::Clean }
    }
}

/// Where a command asks its question and prints the answer.
pub(in crate::cli) struct Console<'a> {
    /// JSON instead of text.
    pub(in crate::cli) json: bool,
    /// The question as JSON instead of an answer.
    pub(in crate::cli) print_request: bool,
    /// What has been read already.
    pub(in crate::cli) library: Library,
    /// Standard output.
    pub(in crate::cli) out: &'a mut dyn Write,
}

impl Console<'_> {
    /// Answers a question under a progress bar; `None` if only the question was to be printed.
    pub(in crate::cli) fn ask<Q>(&mut self, question: &Q) -> Result<Option<Q::Answer>, CliError>
    where
        Q: Question + Into<Request>,
    {
        if self.print_request {
            let request: Request = question.clone().into();
            print_json(self.out, &request)?;
            return Ok(None);
        }
        self.answer(question).map(Some)
    }

    /// Answers a question under a progress bar.
    pub(in crate::cli) fn answer<Q: Question>(
        &mut self,
        question: &Q,
    ) -> Result<Q::Answer, CliError> {
        let outcome = under_bar(|observer| question.answer(&self.library, observer))?;
        // Nobody cancels here: Ctrl-C ends the whole program.
        outcome.complete().ok_or(CliError::Cancelled)
    }

    /// Says before the work begins what stands in the way of a file; of nothing if only the question
    /// is to be printed.
    pub(in crate::cli) fn check_target(
        &self,
        path: Option<&Path>,
        existing: Existing,
    ) -> Result<(), CliError> {
        match path {
            Some(path) if !self.print_request => Ok(check_target(path, existing)?),
            _ => Ok(()),
        }
    }

    /// Answers a question and writes files of the answer into a folder, which is prepared before
    /// the work begins; `None` if only the question was to be printed.
    ///
    /// - `out`: the folder, if there is to be one;
    /// - `known`: names of files that will be written;
    /// - `write`: writes the files into the output folder's staging folder.
    pub(in crate::cli) fn ask_into<Q>(
        &mut self,
        question: &Q,
        out: Option<(&Path, Existing, &[&str])>,
        write: impl FnOnce(&OutputFolder, &Q::Answer) -> Result<Provenance, CliError>,
    ) -> Result<Option<Q::Answer>, CliError>
    where
        Q: Question + Into<Request>,
    {
        let Some((folder, existing, known)) = out.filter(|_| !self.print_request) else {
            return self.ask(question);
        };
        let output = OutputFolder::begin(folder, existing, known)?;
        let request: Request = question.clone().into();
        let inputs = digests(&request.input_files());
        let answer = self.answer(question)?;
        let Provenance { seed, model_digests, .. } = write(&output, &answer)?;
        output.finish(RunRecord {
            command: std::env::args_os().map(|arg| arg.to_string_lossy().into_owned()).collect(),
            request: serde_json::to_value(&request).map_err(io::Error::from)?,
            seed,
            models: model_digests,
            inputs,
        })?;
        Ok(Some(answer))
    }

    /// Prints a report: JSON if that was asked for, else what `text` prints.
    pub(in crate::cli) fn print(
        &mut self,
        report: &impl Serialize,
        text: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), CliError> {
        if self.json {
            return print_json(self.out, report);
        }
        Ok(text(self.out)?)
    }
}

/// The content of files. One that cannot be read is left out: the question that names it says why.
fn digests(files: &[PathBuf]) -> Vec<FileDigest> {
    let digest = |path: &PathBuf| FileDigest::of(path.to_string_lossy(), path).ok();
    files.iter().filter_map(digest).collect()
}

/// Prints what an answer rests on that nobody said.
pub(in crate::cli) fn print_assumptions(
    out: &mut dyn Write,
    assumptions: &[Assumption],
) -> io::Result<()> {
    for assumption in assumptions {
        writeln!(out, "{assumption}")?;
    }
    Ok(())
}

/// Prints the badges of an answer, and its assumptions in place of those badges that stand for them,
/// one line each.
pub(in crate::cli) fn print_badges(
    out: &mut dyn Write,
    badges: &[Badge],
    assumptions: &[Assumption],
) -> io::Result<()> {
    for badge in badges.iter().filter(|badge| !badge.kind.is_assumption()) {
        writeln!(out, "{}", within_line(&badge.to_string()))?;
    }
    print_assumptions(out, assumptions)
}

/// Prints the settings of a training as TOML.
pub(in crate::cli) fn print_settings(
    settings: &impl Serialize,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let text = toml::to_string_pretty(settings).map_err(io::Error::other)?;
    write!(console.out, "{text}")?;
    Ok(Verdict::Clean)
}
