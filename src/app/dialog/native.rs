//! The desktop's dialogs for files, and the commands that follow from a path.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use rfd::AsyncFileDialog;

use crate::app::command::{Command, ComparisonCommand};
use crate::app::dialog::purpose::Purpose;
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::jobs::ProgressCallback;
use impactlab_study::MODEL_ENDING;
use impactlab_study::case_file::CASE_ENDING;

/// File extensions of site files and orthophotos.
const GROUNDS: [&str; 6] = ["toml", "png", "jpg", "jpeg", "tif", "tiff"];

impl Purpose {
    /// The command that follows once paths are known.
    ///
    /// - `was_asked`: whether the user was asked already if a file of that name is to be replaced.
    pub(in crate::app) fn command(
        &self,
        paths: Vec<PathBuf>,
        is_confirmed: bool,
    ) -> Option<Command> {
        let first = paths.first().cloned()?;
        let written = |ending: &str, command: &dyn Fn(PathBuf) -> Command| {
            written(&first, ending, is_confirmed, command)
        };
        Some(match self {
            Self::Folder | Self::Files | Self::Ground | Self::OpenModel | Self::OpenComparison => {
                Command::Open(paths)
            }
            Self::Site => written("toml", &Command::SaveSite),
            Self::SaveComparison => Command::Compare(ComparisonCommand::Save(first)),
            Self::Picture(figure) => written("png", &|path| Command::Export(figure.clone(), path)),
            Self::ScenePicture(picture) => {
                written("png", &|path| Command::ExportScene(picture.clone(), path))
            }
            Self::Exchange(of) => {
                written(of.format.ending(), &|path| Command::ExportExchange(of.clone(), path))
            }
            Self::Film(film) => written("mp4", &|path| Command::SaveFilm(film.clone(), path)),
            Self::Numbers(figure) => written("csv", &|path| Command::Export(figure.clone(), path)),
            Self::Scenario => written("toml", &Command::SaveScenario),
            Self::Vehicle(sheet) => {
                written("toml", &|path| Command::SaveVehicle(sheet.clone(), path))
            }
            Self::Evidence(evidence) => {
                written("toml", &|path| Command::SaveEvidence(evidence.clone(), path))
            }
            Self::SaveModel(network) => {
                written(MODEL_ENDING, &|path| Command::SaveModel(*network, path))
            }
            Self::SaveArchived(_, model) => {
                written(MODEL_ENDING, &|path| Command::SaveArchived(model.clone(), path))
            }
            Self::SaveCase => written(CASE_ENDING, &Command::SaveCaseAs),
            Self::PackCase => written("zip", &Command::PackCase),
            Self::Report(document) => {
                written("pdf", &|path| Command::SaveReport(Arc::clone(document), path))
            }
        })
    }
}

/// A dialog that returns nothing in less time is taken as one that was not displayed, because the
/// desktop provides none: the search for one that fails takes milliseconds, and a dialog takes about
/// as long as this to appear and to be cancelled. If a user is faster, the window asks for the path,
/// which can be cancelled once more; the other error, a command *Save* that does nothing, is worse.
const UNSEEN: Duration = Duration::from_secs(1);

/// What a native dialog returned.
struct Answer {
    /// The chosen paths; none if the user cancelled or no dialog could be displayed.
    paths: Vec<PathBuf>,
    /// Time from the request to the answer, taken on the thread of the dialog, so that a window that
    /// is late to read the answer does not add to it.
    took: Duration,
}

impl Answer {
    /// Whether no dialog was displayed.
    fn is_unseen(&self) -> bool {
        self.paths.is_empty() && self.took < UNSEEN
    }
}

/// Opens a dialog, which waits for the user on a thread of its own. If the desktop has none, the path is
/// asked for within the window.
///
/// - `purpose`: decides which dialog is opened and which command follows.
pub fn ask_for_path(purpose: Purpose, tasks: &mut Tasks) {
    let of_dialog = purpose.clone();
    let work = move |_: &mut ProgressCallback<'_>| {
        let start = Instant::now();
        let paths = pollster::block_on(ask(&of_dialog));
        Ok(Answer { paths, took: start.elapsed() })
    };
    tasks.start(TaskKey::FileDialog, work, move |answer| match answer {
        Ok(answer) if !answer.is_unseen() => purpose.command(answer.paths, true),
        _ => Some(Command::AskPath(purpose)),
    });
}

/// Returns the command that writes a file which the user has chosen in a dialog. A native dialog has
/// asked already whether that file is to be replaced, but not a file with the ending that is added
/// to a name without one.
fn written(
    chosen: &Path,
    ending: &str,
    is_confirmed: bool,
    command: &dyn Fn(PathBuf) -> Command,
) -> Command {
    match chosen.extension() {
        Some(_) if is_confirmed => Command::Replace(Box::new(command(chosen.to_owned()))),
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
                    "cases, tables, scenarios and evidence",
                    &["impactlab", "csv", "txt", "tsv", "dat", "asc", "xlsx", "xlsm", "toml"],
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
        Purpose::Ground => dialog.add_filter("site file or orthophoto", &GROUNDS).pick_file().await,
        Purpose::Site => save(dialog.add_filter("site file", &["toml"]), name).await,
        Purpose::OpenModel => dialog.add_filter("model", &[MODEL_ENDING]).pick_file().await,
        Purpose::SaveModel(_) | Purpose::SaveArchived(..) => {
            save(dialog.add_filter("model", &[MODEL_ENDING]), name).await
        }
        Purpose::Picture(_) | Purpose::ScenePicture(_) => {
            save(dialog.add_filter("picture", &["png"]), name).await
        }
        Purpose::Exchange(of) => {
            save(dialog.add_filter("scene", &[of.format.ending()]), name).await
        }
        Purpose::Film(_) => save(dialog.add_filter("film", &["mp4"]), name).await,
        Purpose::Numbers(_) => save(dialog.add_filter("table", &["csv"]), name).await,
        Purpose::Vehicle(_) => save(dialog.add_filter("vehicle", &["toml"]), name).await,
        Purpose::Evidence(_) => save(dialog.add_filter("evidence", &["toml"]), name).await,
        Purpose::Scenario => save(dialog.add_filter("scenario", &["toml"]), name).await,
        Purpose::SaveCase => save(dialog.add_filter("case", &[CASE_ENDING]), name).await,
        Purpose::PackCase => save(dialog.add_filter("package", &["zip"]), name).await,
        Purpose::Report(_) => save(dialog.add_filter("report", &["pdf", "md", "json"]), name).await,
    };
    one.iter().map(|file| file.path().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dialog_that_ends_at_once_without_a_path_was_never_seen() {
        let answer = |paths: &[&str], millis| Answer {
            paths: paths.iter().map(PathBuf::from).collect(),
            took: Duration::from_millis(millis),
        };
        assert!(answer(&[], 5).is_unseen(), "the desktop has no dialog");
        assert!(!answer(&[], 4000).is_unseen(), "cancelled");
        assert!(!answer(&["case.toml"], 5).is_unseen(), "a path was chosen");
    }
}
