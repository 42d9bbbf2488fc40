//! The native file dialogs, and the dialog in which the user assigns channels to the columns of a
//! file.

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::{ComboBox, Grid, Ui};
use rfd::AsyncFileDialog;

use crate::app::command::{Command, ComparisonCommand};
use crate::app::network::Network;
use crate::case_file::{CASE_ENDING, file_stem};
use crate::data::{
    Channel, ColumnMap, ColumnProposal, ColumnRef, ColumnSource, DataError, propose_columns,
};
use crate::figure::Figure;
use crate::jobs::{Job, Update};

/// File extension of model files.
pub const MODEL_ENDING: &str = "safetensors";

/// The purpose for which the user is asked for a path.
#[derive(Debug, Clone)]
pub enum Purpose {
    /// A data set or a folder of data sets to open.
    Folder,
    /// Single files to open.
    Files,
    /// A PNG file for the picture of a figure.
    Picture(Box<Figure>),
    /// A CSV file for the numbers of a figure.
    Numbers(Box<Figure>),
    /// A TOML file for the scenario.
    Scenario,
    /// A model file to open.
    OpenModel,
    /// A file for the current model of a network.
    SaveModel(Network),
    /// A `comparison.json` file to open.
    OpenComparison,
    /// A folder for the comparison of response models.
    SaveComparison,
    /// A file for the case.
    SaveCase,
    /// A zip for the case and its files.
    PackCase,
}

impl Purpose {
    /// What is asked for.
    pub(in crate::app) fn title(&self) -> &'static str {
        match self {
            Self::Folder => "Open a data set",
            Self::Files => "Open files",
            Self::Picture(_) => "Save the picture",
            Self::Numbers(_) => "Save the numbers",
            Self::Scenario => "Save the scenario",
            Self::OpenModel => "Open a model",
            Self::SaveModel(_) => "Save the model",
            Self::OpenComparison => "Open a comparison",
            Self::SaveComparison => "A folder for the comparison",
            Self::SaveCase => "Save the case",
            Self::PackCase => "Pack the case and its files",
        }
    }

    /// The name that is proposed.
    pub(in crate::app) fn usual_name(&self) -> String {
        let fixed = match self {
            Self::Folder | Self::Files | Self::OpenModel | Self::OpenComparison => "",
            Self::Picture(figure) => return file_stem(&figure.title) + ".png",
            Self::Numbers(figure) => return file_stem(&figure.title) + ".csv",
            Self::Scenario => "scenario.toml",
            Self::SaveModel(network) => network.file_name(),
            Self::SaveComparison => "comparison",
            Self::SaveCase => "case.impactlab",
            Self::PackCase => "case.zip",
        };
        fixed.to_owned()
    }

    /// Whether something is written at the path.
    pub(in crate::app) fn writes(&self) -> bool {
        !matches!(self, Self::Folder | Self::Files | Self::OpenModel | Self::OpenComparison)
    }

    /// The commands that follow once paths are known.
    ///
    /// - `was_asked`: whether the user was asked already if a file of that name is to be replaced.
    pub(in crate::app) fn commands(&self, paths: Vec<PathBuf>, was_asked: bool) -> Vec<Command> {
        let Some(first) = paths.first().cloned() else {
            return Vec::new();
        };
        let written = |ending: &str, command: &dyn Fn(PathBuf) -> Command| {
            written((&first, ending), was_asked, command)
        };
        vec![match self {
            Self::Folder | Self::Files | Self::OpenModel | Self::OpenComparison => {
                Command::Open(paths)
            }
            Self::SaveComparison => Command::Compare(ComparisonCommand::Save(first)),
            Self::Picture(figure) => written("png", &|path| Command::Export(figure.clone(), path)),
            Self::Numbers(figure) => written("csv", &|path| Command::Export(figure.clone(), path)),
            Self::Scenario => written("toml", &Command::SaveScenario),
            Self::SaveModel(network) => {
                written(MODEL_ENDING, &|path| Command::SaveModel(*network, path))
            }
            Self::SaveCase => written(CASE_ENDING, &Command::SaveCaseAs),
            Self::PackCase => written("zip", &Command::PackCase),
        }]
    }
}

/// Shortest time after which a user can have cancelled a dialog. A dialog that returns nothing in
/// less time was not displayed, because the desktop provides none.
const UNSEEN: Duration = Duration::from_millis(300);

/// A native file dialog that waits for the user on its own thread.
pub struct FileDialog {
    purpose: Purpose,
    job: Job<Vec<PathBuf>>,
}

impl FileDialog {
    /// Opens a dialog.
    ///
    /// - `purpose`: decides which dialog is opened and which command follows;
    /// - `wake`: called when the user has answered.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn open(purpose: Purpose, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let asked = purpose.clone();
        let job = Job::spawn("file dialog", wake, move |_| pollster::block_on(ask(&asked)))?;
        Ok(Self { purpose, job })
    }

    /// Returns the commands that follow from the user's answer; `None` while the dialog is open.
    ///
    /// The list is empty if the user cancelled. If the desktop has no file dialog, it asks for the path
    /// within the window.
    pub fn poll(&mut self) -> Option<Vec<Command>> {
        match self.job.poll() {
            Update::Running => None,
            Update::Finished(paths) if paths.is_empty() && self.job.elapsed() < UNSEEN => {
                Some(vec![Command::AskPath(self.purpose.clone())])
            }
            Update::Finished(paths) => Some(self.purpose.commands(paths, true)),
            Update::Panicked(_) | Update::Gone => {
                Some(vec![Command::AskPath(self.purpose.clone())])
            }
        }
    }
}

/// Returns the command that writes a file which the user has chosen in a dialog. A native dialog has
/// asked already whether that file is to be replaced, but not a file with the ending that is added
/// to a name without one.
fn written(
    (chosen, ending): (&Path, &str),
    was_asked: bool,
    command: &dyn Fn(PathBuf) -> Command,
) -> Command {
    match chosen.extension() {
        Some(_) if was_asked => Command::Replace(Box::new(command(chosen.to_owned()))),
        Some(_) => command(chosen.to_owned()),
        None => command(chosen.with_extension(ending)),
    }
}

async fn ask(purpose: &Purpose) -> Vec<PathBuf> {
    let (dialog, name) = (AsyncFileDialog::new().set_title(purpose.title()), purpose.usual_name());
    let save = |dialog: AsyncFileDialog, name: String| dialog.set_file_name(name).save_file();
    let one = match purpose {
        Purpose::Folder => dialog.pick_folder().await,
        Purpose::Files => {
            let files = dialog
                .add_filter(
                    "cases, tables and scenarios",
                    &["impactlab", "csv", "txt", "tsv", "dat", "asc", "toml"],
                )
                .add_filter("all files", &["*"])
                .pick_files()
                .await;
            return files.unwrap_or_default().iter().map(|file| file.path().to_owned()).collect();
        }
        Purpose::SaveComparison => dialog.pick_folder().await,
        Purpose::OpenComparison => {
            dialog.add_filter("comparison.json", &["json"]).pick_file().await
        }
        Purpose::OpenModel => dialog.add_filter("model", &[MODEL_ENDING]).pick_file().await,
        Purpose::SaveModel(_) => save(dialog.add_filter("model", &[MODEL_ENDING]), name).await,
        Purpose::Picture(_) => save(dialog.add_filter("picture", &["png"]), name).await,
        Purpose::Numbers(_) => save(dialog.add_filter("table", &["csv"]), name).await,
        Purpose::Scenario => save(dialog.add_filter("scenario", &["toml"]), name).await,
        Purpose::SaveCase => save(dialog.add_filter("case", &[CASE_ENDING]), name).await,
        Purpose::PackCase => save(dialog.add_filter("package", &["zip"]), name).await,
    };
    one.iter().map(|file| file.path().to_owned()).collect()
}

/// The dialog in which the user says which column of a file holds which channel in which unit.
pub struct MappingDialog {
    path: PathBuf,
    proposals: Vec<ColumnProposal>,
    choices: Vec<Option<Channel>>,
    units: Vec<usize>,
}

/// The channels that can be assigned to a column of a single file, in the order of the dialog's
/// lists.
const CHOICES: [Channel; 14] = [
    Channel::Time,
    Channel::Fx,
    Channel::Fy,
    Channel::FxBody,
    Channel::FyBody,
    Channel::Mz,
    Channel::X,
    Channel::Y,
    Channel::Yaw,
    Channel::Roll,
    Channel::Vx,
    Channel::Vy,
    Channel::YawRate,
    Channel::Steer,
];

impl MappingDialog {
    /// Reads the header and the first rows of a file and proposes a channel and a unit for each
    /// column.
    ///
    /// # Errors
    /// [`DataError`] if the file cannot be read as a table.
    pub fn open(path: PathBuf) -> Result<Self, DataError> {
        let proposals = propose_columns(&path)?;
        let choices = proposals.iter().map(|p| p.guess.map(|(channel, _)| channel)).collect();
        let unit_index = |proposal: &ColumnProposal| {
            let (channel, unit) = proposal.guess?;
            channel.quantity().units().iter().position(|known| Some(*known) == unit)
        };
        let units = proposals.iter().map(|p| unit_index(p).unwrap_or(0)).collect();
        Ok(Self { path, proposals, choices, units })
    }

    /// Draws the dialog and adds a command when the user confirms or cancels.
    pub fn ui(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        ui.heading("Which column is which?");
        ui.label(self.path.display().to_string());
        ui.weak("Force columns make it a force file; X, Y and yaw a trajectory; a steer angle a steer file.");
        ui.separator();
        egui::ScrollArea::both().max_height(360.0).show(ui, |ui| {
            Grid::new("mapping").striped(true).show(ui, |ui| {
                for title in ["Column", "First values", "holds", "in"] {
                    ui.strong(title);
                }
                ui.end_row();
                for index in 0..self.proposals.len() {
                    self.row_ui(ui, index);
                    ui.end_row();
                }
            });
        });
        ui.separator();
        ui.horizontal(|ui| {
            if ui.button("Open with these columns").clicked() {
                let (path, map) = (self.path.clone(), self.map());
                commands.push(Command::OpenMapped(path, map));
            }
            if ui.button("Cancel").clicked() {
                commands.push(Command::CancelMapping);
            }
        });
    }

    fn row_ui(&mut self, ui: &mut Ui, index: usize) {
        let (Some(proposal), Some(choice), Some(unit_idx)) =
            (self.proposals.get(index), self.choices.get_mut(index), self.units.get_mut(index))
        else {
            return;
        };
        let name = ui.label(format!("{}: {}", proposal.number, proposal.name));
        ui.weak(proposal.samples.join("  "));
        let label = |choice: Option<Channel>| choice.map_or("not used", Channel::label);
        let channels = ComboBox::from_id_salt(("channel", index)).selected_text(label(*choice));
        let shown = channels.show_ui(ui, |ui| {
            for option in std::iter::once(None).chain(CHOICES.map(Some)) {
                if ui.selectable_value(choice, option, label(option)).clicked() {
                    *unit_idx = 0;
                }
            }
        });
        shown.response.labelled_by(name.id);
        let Some(channel) = *choice else { return };
        let units = channel.quantity().units();
        let selected = units.get(*unit_idx).map_or("", |unit| unit.symbol);
        let combo = ComboBox::from_id_salt(("unit", index)).selected_text(selected).width(64.0);
        let shown = combo.show_ui(ui, |ui| {
            for (idx, unit) in units.iter().enumerate() {
                ui.selectable_value(unit_idx, idx, unit.symbol);
            }
        });
        shown.response.labelled_by(name.id);
    }

    fn map(&self) -> ColumnMap {
        let rows = self.proposals.iter().zip(&self.choices).zip(&self.units);
        rows.filter_map(|((proposal, choice), unit_idx)| {
            let channel = (*choice)?;
            let unit = channel.quantity().units().get(*unit_idx).copied();
            let column = ColumnRef::Number(proposal.number);
            Some((channel, ColumnSource { column, unit }))
        })
        .collect()
    }
}
