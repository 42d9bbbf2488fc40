//! What is being read, on disk: a file on which the program ends without a word is not opened unasked at
//! each later start.

use std::fs;
use std::path::{Path, PathBuf};

use egui::Ui;

use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::state::State;
use impactlab_core::data::{MAX_SETTINGS_BYTES, read_bytes};

/// Name of the file in the user's data folder.
const FILE: &str = "reading.json";

/// The file that says what is being read.
#[derive(Default)]
pub struct ReadingRecord {
    /// `None` writes nothing down.
    file: Option<PathBuf>,
    /// What stands in the file.
    written: Vec<PathBuf>,
}

impl ReadingRecord {
    /// Opens the record, and returns what was being read when the program last ended.
    pub fn open(data_folder: &Path) -> (Self, Vec<PathBuf>) {
        let file = data_folder.join(FILE);
        let text = read_bytes(&file, MAX_SETTINGS_BYTES).unwrap_or_default();
        let left: Vec<PathBuf> = serde_json::from_slice(&text).unwrap_or_default();
        (Self { file: Some(file), written: left.clone() }, left)
    }

    /// Writes down what is being read now. It need not outlast a failure of the machine, so that nothing
    /// waits for the disk. A path that is not Unicode cannot be written down.
    pub fn write<'a>(&mut self, paths: impl Iterator<Item = &'a Path>) {
        let Some(file) = &self.file else { return };
        let paths: Vec<PathBuf> =
            paths.filter(|path| path.to_str().is_some()).map(Path::to_owned).collect();
        if paths == self.written {
            return;
        }
        // Where nothing can be written, files are read all the same.
        let _ = match serde_json::to_vec(&paths) {
            Ok(text) if !paths.is_empty() => fs::write(file, text),
            _ => fs::remove_file(file),
        };
        self.written = paths;
    }
}

impl State {
    /// Leaves out of what is opened at the start what was being read when the program last ended, and asks
    /// about it.
    ///
    /// - `to_open`: what would be opened;
    /// - `unread`: what was being read.
    pub(super) fn leave_unread(
        &mut self,
        to_open: Vec<PathBuf>,
        unread: &[PathBuf],
    ) -> Vec<PathBuf> {
        let (mut left, to_open): (Vec<PathBuf>, Vec<PathBuf>) =
            to_open.into_iter().partition(|path| unread.contains(path));
        if let Some(site) = self.project.simulate.site.clone().filter(|site| unread.contains(site))
        {
            self.project.put_on_site(None);
            if !left.contains(&site) {
                left.push(site);
            }
        }
        if !left.is_empty() {
            self.session.dialogs.open(Dialog::Unread(left));
        }
        to_open
    }
}

/// Draws the question whether to open what was being read when the program last ended.
pub fn unread_ui(ui: &mut Ui, paths: &[PathBuf], commands: &mut Vec<Command>) {
    ui.heading("Not opened again");
    ui.label("These were being read when impactlab last ended without closing its window:");
    for path in paths {
        ui.label(path.display().to_string());
    }
    ui.separator();
    ui.horizontal(|ui| {
        if ui.button("Open all the same").clicked() {
            commands.push(Command::CloseDialog);
            commands.push(Command::Open(paths.to_vec()));
        }
        if ui.button("Leave closed").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_being_read_at_the_end_is_known_at_the_next_start() {
        let folder = tempfile::tempdir().unwrap();
        let (mut record, left) = ReadingRecord::open(folder.path());
        assert!(left.is_empty());
        let paths = ["/data/a.csv", "/data/b.xlsx"].map(PathBuf::from);
        record.write(paths.iter().map(PathBuf::as_path));
        record.write(std::iter::once(paths[1].as_path()));
        let (mut record, left) = ReadingRecord::open(folder.path());
        assert_eq!(left, paths[1..]);
        let mut state = State::default();
        state.project.simulate.site = Some(paths[1].clone());
        assert_eq!(state.leave_unread(paths.to_vec(), &left), paths[..1]);
        assert_eq!(state.project.simulate.site, None);
        let asked = state.session.dialogs.iter().any(|dialog| match dialog {
            Dialog::Unread(left) => left[..] == paths[1..],
            _ => false,
        });
        assert!(asked);
        record.write(std::iter::empty());
        assert!(ReadingRecord::open(folder.path()).1.is_empty());
        assert!(!folder.path().join(FILE).exists());
        assert!(State::default().leave_unread(paths.to_vec(), &[]) == paths);
    }
}
