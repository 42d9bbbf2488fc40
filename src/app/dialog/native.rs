//! The desktop's dialogs for files, and the commands that follow from a path.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rfd::AsyncFileDialog;

use crate::app::command::Command;
use crate::app::dialog::purpose::Purpose;
use crate::app::sweep::SweepCommand;
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::jobs::ProgressCallback;
use impactlab_study::{ATLAS_ENDING, MODEL_ENDING};

/// File extensions of site files, orthophotos, surveyed lines and points, and point clouds.
const GROUNDS: [&str; 13] = [
    "toml", "png", "jpg", "jpeg", "tif", "tiff", "kml", "kmz", "geojson", "csv", "las", "laz",
    "e57",
];

impl Purpose {
    /// The command that follows once paths are known.
    ///
    /// - `is_confirmed`: whether a native dialog has asked already if that file is to be replaced. It has
    ///   not asked about a file with the ending that is added to a name without one.
    pub(in crate::app) fn command(
        &self,
        paths: Vec<PathBuf>,
        is_confirmed: bool,
    ) -> Option<Command> {
        let path = paths.first().cloned()?;
        if matches!(self, Self::SweepFolder) {
            return Some(Command::Sweep(SweepCommand::Folder(path)));
        }
        let Some(output) = self.output().cloned() else { return Some(Command::Open(paths)) };
        let endings = output.endings();
        Some(match endings.first() {
            Some(ending) if !has_ending(&path) => {
                let mut name = path.file_name().unwrap_or_default().to_owned();
                name.push(format!(".{ending}"));
                Command::Write(output, path.with_file_name(name))
            }
            Some(_) if is_confirmed => Command::Replace(output, path),
            _ => Command::Write(output, path),
        })
    }
}

/// Whether a name ends as that of a file does: “Smith v. Jones” and “Miller 12.03.2026” do not.
fn has_ending(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    ending.chars().all(char::is_alphanumeric) && ending.chars().any(char::is_alphabetic)
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

async fn ask(purpose: &Purpose) -> Vec<PathBuf> {
    let dialog = AsyncFileDialog::new().set_title(purpose.title());
    let one = match purpose {
        Purpose::Folder | Purpose::SweepFolder => dialog.pick_folder().await,
        Purpose::Files => {
            let files = dialog
                .add_filter(
                    "cases, tables, scenarios and evidence",
                    &[
                        "impactlab",
                        "csv",
                        "txt",
                        "tsv",
                        "dat",
                        "asc",
                        "xlsx",
                        "xlsm",
                        "toml",
                        "atlas",
                    ],
                )
                .add_filter("all files", &["*"])
                .pick_files()
                .await;
            return files.unwrap_or_default().iter().map(|file| file.path().to_owned()).collect();
        }
        Purpose::OpenComparison => {
            dialog.add_filter("comparison.json", &["json"]).pick_file().await
        }
        Purpose::Ground => dialog.add_filter("site", &GROUNDS).pick_file().await,
        Purpose::OpenModel => dialog.add_filter("model", &[MODEL_ENDING]).pick_file().await,
        Purpose::OpenAtlas => dialog.add_filter("atlas", &[ATLAS_ENDING]).pick_file().await,
        Purpose::OpenPlan => dialog.add_filter("plan", &["toml", "json"]).pick_file().await,
        Purpose::Save(output) => {
            let (endings, [_, kind]) = (output.endings(), output.texts());
            match endings.is_empty() {
                true => dialog.pick_folder().await,
                false => {
                    let dialog = dialog.set_file_name(output.usual_name());
                    dialog.add_filter(kind, &endings).save_file().await
                }
            }
        }
    };
    one.iter().map(|file| file.path().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::output::Output;

    /// A case that was called by its date was written without its ending, which the dialog to open one looks for,
    /// and went on as “Miller 12.03”.
    #[test]
    fn a_name_with_a_point_gets_the_ending_of_what_is_saved() {
        for (typed, written, is_replaced) in [
            ("a/Miller 12.03.2026", "a/Miller 12.03.2026.impactlab", false),
            ("a/Smith v. Jones", "a/Smith v. Jones.impactlab", false),
            ("a/typed", "a/typed.impactlab", false),
            ("a/folder/", "a/folder.impactlab", false),
            ("a/typed.impactlab", "a/typed.impactlab", true),
            ("a/typed.json", "a/typed.json", true),
        ] {
            let saves = Purpose::Save(Output::Case);
            let found = match saves.command(vec![PathBuf::from(typed)], true) {
                Some(Command::Write(_, path)) => (path, false),
                Some(Command::Replace(_, path)) => (path, true),
                other => panic!("{other:?}"),
            };
            assert_eq!(found, (PathBuf::from(written), is_replaced), "{typed}");
        }
    }

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
