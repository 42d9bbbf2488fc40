//! Where a command asks and prints, and how it ended.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{print_json, under_bar};
use crate::study::{Assumption, Library, Question, Request};

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

/// Prints what an answer rests on that nobody said.
pub(in crate::cli) fn print_assumptions(
    out: &mut dyn Write,
    assumptions: &[Assumption],
) -> io::Result<()> {
    for assumption in assumptions {
        writeln!(out, "assumed {assumption}")?;
    }
    Ok(())
}

/// Makes a folder for files.
pub(in crate::cli) fn folder(path: &Path) -> Result<(), CliError> {
    fs::create_dir_all(path).map_err(|source| CliError::Folder { path: path.to_owned(), source })
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
