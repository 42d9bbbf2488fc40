//! Asks before a file or a folder of results that exists already is replaced.

use std::path::{Path, PathBuf};

use egui::Ui;

use crate::app::atlas::SHIPPED_PLAN;
use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::export;
use crate::app::model::file_name;
use crate::app::output::Output;
use crate::app::state::State;
use crate::app::tasks::TaskKey;
use impactlab_core::data::write::{MANIFEST_FILE, check_inputs};
use impactlab_core::data::{
    DataError, Existing, MAX_MODEL_BYTES, Severity, read_bytes, write_bytes,
};
use impactlab_core::error_chain;
use impactlab_study::{CompareReport, InputKind};

/// Whether something would be replaced at a path. A folder is replaced if it holds results.
fn is_taken(path: &Path) -> bool {
    let is_there = |name: &&str| path.join(name).exists();
    path.is_file() || [MANIFEST_FILE, CompareReport::FILES[0]].iter().any(is_there)
}

impl State {
    /// Writes something to a path. If that would replace something and that was not said to be wanted, the
    /// user is asked first.
    pub(super) fn write(&mut self, output: Output, path: PathBuf, existing: Existing) {
        self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Replace(..)));
        if let Err(error) = self.check_inputs(&output, &path) {
            return self.say(Severity::Error, error_chain(&error));
        }
        if existing == Existing::Refuse && is_taken(&path) {
            return self.session.dialogs.open(Dialog::Replace(output, path));
        }
        match output {
            Output::Picture(figure) | Output::Numbers(figure) => {
                let dark = self.view.dark;
                self.start_writing(path, move |to| {
                    export::write_figure(&figure, to, existing, dark)
                });
            }
            Output::ScenePicture(picture) => {
                let dark = self.view.dark;
                self.start_writing(path, move |to| {
                    export::write_scene(&picture, to, existing, dark)
                });
            }
            Output::Exchange(scene) => {
                self.start_writing(path, move |to| export::write_exchange(*scene, to, existing));
            }
            Output::Film(film) => self.make_film(*film, path, existing),
            Output::Scenario => {
                if let Some(scenario) = self.project.scenario() {
                    self.write_text(&scenario.to_toml(), &path, existing);
                }
            }
            Output::Vehicle(sheet) => {
                self.write_text(&sheet.to_toml(), &path, existing);
            }
            Output::Evidence(evidence) => {
                self.write_text(&evidence.to_toml(), &path, existing);
            }
            Output::Site => self.save_site(&path, existing),
            Output::Case => self.save_case(path, existing),
            Output::PackedCase => self.pack_case(path, existing),
            Output::Report(document) => {
                self.start_writing(path, move |to| export::write_report(&document, to, existing));
            }
            Output::Model(network) => self.save_model(network, path, existing),
            Output::Archived(_, model) => self.start_writing(path, move |to| {
                let bytes =
                    read_bytes(&model, MAX_MODEL_BYTES).map_err(|error| error_chain(&error))?;
                write_bytes(to, existing, &bytes).map_err(|error| error_chain(&error))
            }),
            Output::Comparison => self.save_comparison(path, existing),
            Output::ExamplePlan => self.write_text(SHIPPED_PLAN, &path, existing),
            Output::SweepRows => self.merge_sweep(path, existing),
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
    fn check_inputs(&self, output: &Output, path: &Path) -> Result<(), DataError> {
        let own = match output {
            Output::Scenario => Some(InputKind::Scenario),
            Output::Vehicle(_) => Some(InputKind::Vehicle),
            Output::Evidence(_) => Some(InputKind::Evidence),
            Output::Site => Some(InputKind::Site),
            Output::Model(_) | Output::Archived(..) => Some(InputKind::Network),
            Output::Case => Some(InputKind::Case),
            _ => None,
        };
        let is_own = own == Some(InputKind::from_path(path));
        if is_own { Ok(()) } else { check_inputs(path, &self.files_in_use()) }
    }

    /// Writes a short text and tells the user that it has been written, or why it could not be.
    fn write_text(&mut self, text: &str, path: &Path, existing: Existing) {
        let written = write_bytes(path, existing, text.as_bytes());
        match written {
            Ok(()) => self.say(Severity::Info, format!("{} written", path.display())),
            Err(error) => self.say(Severity::Error, error_chain(&error)),
        }
    }
}

/// Draws the question whether something is to be replaced, and adds a command when the user has
/// answered.
///
/// - `output`, `path`: what would be written, and where.
pub fn replace_ui(ui: &mut Ui, (output, path): (&Output, &Path), commands: &mut Vec<Command>) {
    let name = file_name(path);
    ui.heading(format!("Replace {name}?"));
    ui.label(path.display().to_string());
    ui.weak(match path.is_dir() {
        true => "This folder holds results already. Other files in it stay.",
        false => "This file exists already.",
    });
    ui.separator();
    ui.horizontal(|ui| {
        if ui.button("Replace").clicked() {
            commands.push(Command::Replace(output.clone(), path.to_owned()));
        }
        if ui.button("Keep it").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}
