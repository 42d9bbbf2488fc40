//! Where a command asks and prints, and how it ended.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Targets, print_json, under_bar, within_line};
use impactlab_core::data::Existing;
use impactlab_core::data::write::OutputFolder;
use impactlab_core::site::Site;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::LoadedGround;
use impactlab_study::{Library, Provenance, Question, Request, SimulateRequest};

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
    pub(in crate::cli) fn from_problems(problems: bool) -> Self {
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
    /// What will be written.
    pub(in crate::cli) targets: Targets,
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

    /// Answers a question under a progress bar. If a file that it reads is to be written, that is an
    /// error before any work.
    pub(in crate::cli) fn answer<Q>(&mut self, question: &Q) -> Result<Q::Answer, CliError>
    where
        Q: Question + Into<Request>,
    {
        self.targets.ask(&question.clone().into())?;
        self.answer_reading(question, &[])
    }

    /// Answers a question of which no [`Request`] is made, likewise.
    ///
    /// - `files`: which it reads.
    pub(in crate::cli) fn answer_reading<Q: Question>(
        &mut self,
        question: &Q,
        files: &[PathBuf],
    ) -> Result<Q::Answer, CliError> {
        self.reads(files)?;
        let outcome = under_bar(|observer| question.answer(&self.library, observer))?;
        // Nobody cancels here: Ctrl-C ends the whole program.
        outcome.complete().ok_or(CliError::Cancelled)
    }

    /// Gives the scenario of a question mass, yaw inertia and outline of the vehicles that are chosen, and says
    /// on standard error what is another value than in its file.
    pub(in crate::cli) fn take_vehicles(
        &mut self,
        question: &mut SimulateRequest,
    ) -> Result<(), CliError> {
        let files = Request::from(question.clone()).files_read();
        let told = question.take_vehicles()?;
        self.targets.make_from(&files)?;
        for line in told {
            // Nobody is left to tell if standard error is closed.
            let _ = writeln!(io::stderr(), "note: {}", within_line(&line));
        }
        Ok(())
    }

    /// Says before the work begins what stands in the way of a file; of nothing if only the question
    /// is to be printed. What is read from then on, by a question or as [`Console::reads`] says, must
    /// not be this file, whether it may be replaced or not.
    pub(in crate::cli) fn check_target(
        &mut self,
        path: Option<&Path>,
        existing: Existing,
    ) -> Result<(), CliError> {
        match path {
            Some(path) if !self.print_request => self.targets.add(path, existing),
            _ => Ok(()),
        }
    }

    /// The same for a file that a question writes itself, and checks, while it is answered.
    pub(in crate::cli) fn keeps(&mut self, path: Option<&Path>) {
        if let Some(path) = path {
            self.targets.add_unchecked(path);
        }
    }

    /// Says which files are about to be read without a question.
    ///
    /// # Errors
    /// [`WriteError::IsInput`](impactlab_core::data::write::WriteError::IsInput) if one of them is to be written.
    pub(in crate::cli) fn reads(&mut self, files: &[PathBuf]) -> Result<(), CliError> {
        self.targets.read(files)
    }

    /// Takes seed and networks of an answer into the manifest of the folder that is expected.
    pub(in crate::cli) fn answered(&mut self, provenance: &Provenance) {
        self.targets.answered(provenance);
    }

    /// Reads the ground of a scene, with everything that its site names.
    pub(in crate::cli) fn ground(&mut self, site: &Path) -> Result<LoadedGround, CliError> {
        let mut files = vec![site.to_owned()];
        files.extend(Site::files_named_by(site));
        self.reads(&files)?;
        Ok(LoadedGround::load(site)?)
    }

    /// Says that there will be a folder of results ([`Console::begin_folder`]).
    pub(in crate::cli) fn expect_folder(&mut self) {
        self.targets.expect_folder();
    }

    /// Begins a folder of results.
    ///
    /// - returns the folder, and what its manifest says: what was asked and read since
    ///   [`Console::expect_folder`].
    pub(in crate::cli) fn begin_folder(
        &self,
        folder: &Path,
        existing: Existing,
    ) -> Result<(OutputFolder, impactlab_core::data::write::RunRecord), CliError> {
        let (record, read) = self.targets.run_record();
        Ok((OutputFolder::begin(folder, existing, &[], read)?, record))
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
        self.targets.expect_folder();
        let request: Request = question.clone().into();
        let read = [&request.files_read()[..], self.targets.made_from()].concat();
        let output = OutputFolder::begin(folder, existing, known, read)?;
        self.targets.refuse_results(folder, known)?;
        let answer = self.answer(question)?;
        self.targets.answered(&write(&output, &answer)?);
        let (record, _) = self.targets.run_record();
        output.finish(record)?;
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

/// Prints notes, what restricts an answer and what it rests on, one line each.
pub(in crate::cli) fn print_caveats(
    out: &mut dyn Write,
    caveats: &Caveats,
    units: UnitSystem,
) -> io::Result<()> {
    let caveats = caveats.in_units(units);
    for note in caveats.notes() {
        writeln!(out, "note: {}", within_line(note))?;
    }
    for caveat in caveats.restrictions() {
        writeln!(out, "{}", within_line(&caveat.to_string()))?;
    }
    for assumption in caveats.assumptions() {
        writeln!(out, "{assumption}")?;
    }
    Ok(())
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
