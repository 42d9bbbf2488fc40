//! The choices of the import dialog, and what was read with them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::command::Command;
use crate::app::found::Found;
use crate::app::import::answer::{ImportAnswer, ReadPreview};
use crate::app::import::choices::Choices;
use crate::app::import::preview::{Preview, Refusal};
use crate::app::import::said::SaidOfFile;
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::data::{
    ColumnMap, ColumnProposal, Correction, ReadSettings, Table, VelocityAxes, VelocityFit,
    proposals,
};
use impactlab_core::error_chain;
use impactlab_core::units::UnitSystem;

/// The dialog in which the user says how a file is read.
pub struct ImportDialog {
    pub(super) path: PathBuf,
    /// The map with which the file was opened before.
    first_map: Option<ColumnMap>,
    /// Whether the choices are still those of `first_map`, or what the headers suggest.
    is_untouched: bool,
    pub(super) settings: ReadSettings,
    /// The table, and the settings with which it was read.
    pub(super) table: Option<(ReadSettings, Result<Arc<Table>, String>)>,
    /// The first lines of the last table that could be read.
    pub(super) beginning: Vec<(u64, String)>,
    pub(super) choices: Choices,
    /// The curve, and the map with which it was read.
    pub(super) preview: Option<(ColumnMap, ReadPreview)>,
    /// The corrections that were made, each with the map before it.
    pub(super) corrected: Vec<(Correction, ColumnMap)>,
    is_reading: bool,
    /// Whether the user has said in which axes the velocities are.
    pub(super) says_velocities: bool,
    /// System of units of the curve.
    pub(super) units: UnitSystem,
    /// What is said of the vehicle of the file, with what it was before; `None` for a file about which the
    /// variant asks, where the variant says it.
    pub(super) said: Option<[SaidOfFile; 2]>,
}

impl ImportDialog {
    /// Opens the dialog for a file, which is read in the background.
    ///
    /// - `map`: the choices with which it was opened before;
    /// - `said`: what the variant says of its vehicle; `None` if the variant asks about the file.
    pub fn open(path: PathBuf, map: Option<ColumnMap>, said: Option<SaidOfFile>) -> Self {
        let settings = map.as_ref().map(|map| (*map.settings).clone()).unwrap_or_default();
        Self {
            path,
            says_velocities: settings.velocities.is_some(),
            settings,
            first_map: map,
            is_untouched: true,
            table: None,
            beginning: Vec::new(),
            choices: Choices::default(),
            preview: None,
            corrected: Vec::new(),
            is_reading: false,
            units: UnitSystem::default(),
            said: said.map(|said| [said.clone(), said]),
        }
    }

    /// What the user has said of the vehicle of the file; `None` if it is what the variant says.
    pub fn said(&self) -> Option<&SaidOfFile> {
        self.said.as_ref().filter(|[said, before]| said != before).map(|[said, _]| said)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the curve is that of the choices as they are.
    pub fn is_settled(&self) -> bool {
        !self.is_reading && !self.is_table_stale() && !self.is_preview_stale()
    }

    /// The map of the choices as they are.
    pub fn map(&self) -> ColumnMap {
        self.choices.map(&self.settings)
    }

    /// Reads the file anew, with the choices that the dialog began with.
    pub(super) fn reset(&mut self) {
        let units = self.units;
        let before = self.said.take().map(|[_, before]| before);
        *self = Self::open(self.path.clone(), self.first_map.take(), before);
        self.units = units;
    }

    /// Makes a correction.
    pub(super) fn correct(&mut self, correction: Correction) {
        let before = self.map();
        let mut map = before.clone();
        correction.apply(&mut map);
        self.take_map(&map);
        self.corrected.push((correction, before));
    }

    /// Takes a correction back, and with it those that were made after it to the same columns.
    ///
    /// - `idx`: its place in the list.
    pub(super) fn take_back(&mut self, idx: usize) {
        let Some((wanted, _)) = self.corrected.get(idx).cloned() else { return };
        let later = self.corrected.split_off(idx);
        let (undone, kept): (Vec<_>, Vec<_>) =
            later.into_iter().partition(|(correction, _)| correction.overlaps(&wanted));
        let mut map = self.map();
        for (correction, before) in undone.iter().rev() {
            correction.undo(&mut map, before);
        }
        self.corrected.extend(kept);
        self.take_map(&map);
    }

    /// Takes the choices and settings of a map.
    fn take_map(&mut self, map: &ColumnMap) {
        let columns = std::mem::take(&mut self.choices.columns);
        let proposals = columns.into_iter().map(|column| column.proposal).collect();
        self.choices = Choices::from_map(proposals, map);
        self.says_velocities |= self.settings.velocities != map.settings.velocities;
        self.settings = (*map.settings).clone();
    }

    /// Starts to read what has changed.
    pub fn update(&mut self, units: UnitSystem, tasks: &mut Tasks) {
        if self.units != units {
            (self.units, self.preview) = (units, None);
        }
        if self.is_reading {
            return;
        }
        if self.is_table_stale() {
            let (path, settings) = (self.path.clone(), self.settings.clone());
            self.start(tasks, move || {
                let table = Table::read_as(&path, &settings).map(Arc::new);
                ImportAnswer::Table(settings, table.map_err(|error| error_chain(&error)))
            });
        } else if self.is_preview_stale()
            && let Some((_, Ok(table))) = &self.table
        {
            let (table, map) = (Arc::clone(table), self.map());
            self.start(tasks, move || {
                let preview = Preview::new(&table, &map, units).map(Arc::new);
                let preview = preview.map_err(|error| Arc::new(Refusal::new(&error, &map)));
                ImportAnswer::Preview(map, preview)
            });
        }
    }

    fn start(&mut self, tasks: &mut Tasks, read: impl FnOnce() -> ImportAnswer + Send + 'static) {
        self.is_reading = true;
        let path = self.path.clone();
        let take = |result| Command::ImportRead(path, result);
        tasks.start(TaskKey::Import, |_| Ok(Found::new(read())), take);
    }

    /// Whether the table was read with another sheet, header or row of units, or with other signs.
    fn is_table_stale(&self) -> bool {
        let signs = |of: &ReadSettings| (of.separator, of.decimal_comma, of.thousands);
        let place =
            |of: &ReadSettings| (signs(of), of.sheet.clone(), of.deck, of.header, of.units_line);
        let read = self.table.as_ref().map(|(settings, _)| place(settings));
        read != Some(place(&self.settings))
    }

    fn is_preview_stale(&self) -> bool {
        let is_read = matches!(self.table, Some((_, Ok(_))));
        let shown = self.preview.as_ref().map(|(map, _)| map);
        is_read && self.choices.open_questions().is_empty() && shown != Some(&self.map())
    }

    /// Takes the columns of a table. What was chosen stays for columns of the same names.
    fn take_columns(&mut self, found: Vec<ColumnProposal>) {
        let before = self.choices.columns.iter().map(|column| &column.proposal.name);
        let is_same = before.eq(found.iter().map(|proposal| &proposal.name));
        let first = self.first_map.as_ref().filter(|_| self.is_untouched);
        self.choices = match first {
            // A map of settings alone leaves the columns to their headers.
            Some(map) if map.iter().next().is_none() => Choices::suggested(found),
            Some(map) => Choices::from_map(found, map),
            None if is_same => Choices::from_map(found, &self.map()),
            None => Choices::suggested(found),
        };
        self.is_untouched = false;
        if !is_same {
            self.corrected.clear();
        }
    }

    /// Takes what was read, or why the reading broke off.
    pub fn receive(&mut self, answer: Result<ImportAnswer, String>) {
        self.is_reading = false;
        match answer {
            Err(why) => self.table = Some((self.settings.clone(), Err(why))),
            Ok(ImportAnswer::Table(settings, table)) => {
                if let Ok(table) = &table {
                    self.take_columns(proposals(table));
                    self.beginning = table.beginning().to_vec();
                }
                self.table = Some((settings, table));
                self.preview = None;
            }
            Ok(ImportAnswer::Preview(map, preview)) => {
                // Velocities that fit the path in world axes only are proposed as such.
                let fit = preview.as_ref().ok().and_then(|preview| preview.fit);
                if !self.says_velocities {
                    self.settings.velocities =
                        (fit == Some(VelocityFit::World)).then_some(VelocityAxes::World);
                }
                self.preview = Some((map, preview));
            }
        }
    }
}
