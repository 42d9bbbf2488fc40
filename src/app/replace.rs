//! Asks before a file or a folder of results that exists already is replaced.

use std::path::{Path, PathBuf};

use egui::{Context, Ui};

use crate::app::command::{Command, ComparisonCommand};
use crate::app::dialog::Dialog;
use crate::app::export;
use crate::app::state::State;
use crate::app::tasks::TaskKey;
use impactlab_core::data::write::{MANIFEST_FILE, check_inputs};
use impactlab_core::data::{
    DataError, Existing, MAX_MODEL_BYTES, Severity, read_bytes, write_atomically,
};
use impactlab_core::error_chain;
use impactlab_study::InputKind;

impl Command {
    /// The file or folder that the command writes; `None` for all other commands.
    fn target(&self) -> Option<&Path> {
        match self {
            Self::Export(_, path)
            | Self::ExportScene(_, path)
            | Self::ExportExchange(_, path)
            | Self::SaveFilm(_, path)
            | Self::SaveScenario(path)
            | Self::SaveVehicle(_, path)
            | Self::SaveEvidence(_, path)
            | Self::SaveSite(path)
            | Self::SaveModel(_, path)
            | Self::SaveArchived(_, path)
            | Self::SaveCaseAs(path)
            | Self::PackCase(path)
            | Self::SaveReport(_, path)
            | Self::Compare(ComparisonCommand::Save(path)) => Some(path),
            _ => None,
        }
    }

    /// Whether the command would replace something. A folder is replaced if it holds results.
    fn replaces_something(&self) -> bool {
        let holds_results = |folder: &Path| {
            [MANIFEST_FILE, "comparison.json"].iter().any(|name| folder.join(name).exists())
        };
        self.target().is_some_and(|path| path.is_file() || path.is_dir() && holds_results(path))
    }
}

impl State {
    /// Carries out a command that writes a file. If it would replace something and that was not
    /// said to be wanted, the user is asked first.
    pub(super) fn write(&mut self, command: Command, existing: Existing, context: &Context) {
        self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Replace(_)));
        if let Some(Err(error)) = command.target().map(|path| self.check_inputs(&command, path)) {
            return self.say(Severity::Error, error_chain(&error));
        }
        if existing == Existing::Refuse && command.replaces_something() {
            self.session.dialogs.open(Dialog::Replace(Box::new(command)));
            return;
        }
        match command {
            Command::Export(figure, path) => {
                let dark = self.view.dark;
                self.start_writing(path, move |to| {
                    export::write_figure(&figure, to, existing, dark)
                });
            }
            Command::ExportScene(picture, path) => {
                let dark = self.view.dark;
                self.start_writing(path, move |to| {
                    export::write_scene(&picture, to, existing, dark)
                });
            }
            Command::ExportExchange(scene, path) => {
                self.start_writing(path, move |to| export::write_exchange(*scene, to, existing));
            }
            Command::SaveFilm(film, path) => self.make_film(*film, path, existing),
            Command::SaveScenario(path) => {
                if let Some(scenario) = self.project.scenario() {
                    self.write_text(&scenario.to_toml(), &path, existing);
                }
            }
            Command::SaveVehicle(sheet, path) => {
                self.write_text(&sheet.to_toml(), &path, existing);
            }
            Command::SaveEvidence(evidence, path) => {
                self.write_text(&evidence.to_toml(), &path, existing);
            }
            Command::SaveSite(path) => self.save_site(&path, existing),
            Command::SaveCaseAs(path) => self.save_case(path, existing),
            Command::PackCase(path) => self.pack_case(path, existing),
            Command::SaveReport(document, path) => {
                self.start_writing(path, move |to| export::write_report(&document, to, existing));
            }
            Command::SaveModel(network, path) => self.save_model(network, path, existing),
            Command::SaveArchived(model, path) => self.start_writing(path, move |to| {
                let bytes =
                    read_bytes(&model, MAX_MODEL_BYTES).map_err(|error| error_chain(&error))?;
                write_atomically(to, existing, |out| out.write_all(&bytes))
                    .map_err(|error| error_chain(&error))
            }),
            Command::Compare(ComparisonCommand::Save(folder)) => {
                self.save_comparison(folder, existing);
            }
            other => self.apply(other, context),
        }
    }

    /// Starts to write a file or folder.
    pub(in crate::app) fn start_writing(
        &mut self,
        path: PathBuf,
        write: impl FnOnce(&Path) -> Result<(), String> + Send + 'static,
    ) {
        let key = TaskKey::Write(path.clone());
        self.session.tasks.start(key, move |_| write(&path).map(|()| path), Command::Written);
    }

    /// Tells the user that a file has been written, or why it could not be.
    pub(in crate::app) fn say_of_file(&mut self, written: Result<PathBuf, String>) {
        match written {
            Ok(path) => self.say(Severity::Info, format!("{} written", path.display())),
            Err(problem) => self.say(Severity::Error, problem),
        }
    }

    /// Refuses to write over a file that the case rests on. A document that is edited in the window, or a
    /// network, may go back to its own file.
    fn check_inputs(&self, command: &Command, path: &Path) -> Result<(), DataError> {
        let own = match command {
            Command::SaveScenario(_) => Some(InputKind::Scenario),
            Command::SaveVehicle(..) => Some(InputKind::Vehicle),
            Command::SaveEvidence(..) => Some(InputKind::Evidence),
            Command::SaveSite(_) => Some(InputKind::Site),
            Command::SaveModel(..) | Command::SaveArchived(..) => Some(InputKind::Network),
            Command::SaveCaseAs(_) => Some(InputKind::Case),
            _ => None,
        };
        let is_own = own == Some(InputKind::from_path(path));
        if is_own { Ok(()) } else { check_inputs(path, &self.files_in_use()) }
    }

    /// Writes a short text and tells the user that it has been written, or why it could not be.
    fn write_text(&mut self, text: &str, path: &Path, existing: Existing) {
        let written = write_atomically(path, existing, |out| out.write_all(text.as_bytes()));
        match written {
            Ok(()) => self.say(Severity::Info, format!("{} written", path.display())),
            Err(error) => self.say(Severity::Error, error_chain(&error)),
        }
    }
}

/// Draws the question whether something is to be replaced, and adds a command when the user has
/// answered.
///
/// - `command`: the command that would replace it.
pub fn replace_ui(ui: &mut Ui, command: &Command, commands: &mut Vec<Command>) {
    let Some(path) = command.target() else { return };
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    ui.heading(format!("Replace {name}?"));
    ui.label(path.display().to_string());
    ui.weak(match path.is_dir() {
        true => "This folder holds results already. Other files in it stay.",
        false => "This file exists already.",
    });
    ui.separator();
    ui.horizontal(|ui| {
        if ui.button("Replace").clicked() {
            commands.push(Command::Replace(Box::new(command.clone())));
        }
        if ui.button("Keep it").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}
