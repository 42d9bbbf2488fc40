//! `binout` of LS-DYNA: the text files of results in one binary container (`lsda`), in one part or
//! many.
//!
//! ```text
//! /rcforc/metadata    ids, side (0 slave, 1 master), legend (70 or 80 letters each), legend_ids
//! /rcforc/d000001     time, x_force, y_force, z_force, z_moment: one number for each id and side
//! /secforc/d000001    time, x_force, y_force, z_force
//! /nodout/d000001     time, x_coordinate, y_coordinate, x_velocity, y_velocity
//! /rbdout/d000001     time, ids, num_nodal (how many of them, the last ones, are made of nodes), global_x, …
//! /matsum/d000001     time, x_momentum, y_momentum, x_rbvelocity, y_rbvelocity of each part
//! ```
//!
//! The ids of rbdout stand in its metadata or in each state; bodies that are rigid for a while only are left out
//! with the reason. A contact that has no sides has the id 0 and no numbers. Other folders are skipped. A state whose time is not later than that of one before it counts
//! in its place, as after a restart.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use crate::data::budget::MAX_TABLE_BYTES;
use crate::data::formats::fem::deck::Dimension;
use crate::data::formats::fem::legend::plain_title;
use crate::data::formats::fem::lsda::{self, Array};
use crate::data::formats::fem::momenta::{Momenta, PartMomentum};
use crate::data::formats::fem::parts::parts;
use crate::data::formats::fem::rbdout;
use crate::data::formats::fem::results::{FORCE, History, Kind, MOMENT, NODE, Results, columns};
use crate::data::formats::fem::states::{cut_state, written_again};
use crate::data::{DataError, Place};

/// The folders that are read, with the arrays of a state after the time. The first of them must be there.
const CONTACTS: (&str, &[&str]) = ("rcforc", &["x_force", "y_force", "z_force", "z_moment"]);
const SECTIONS: (&str, &[&str]) = ("secforc", &["x_force", "y_force", "z_force"]);
const NODES: (&str, &[&str]) =
    ("nodout", &["x_coordinate", "y_coordinate", "x_velocity", "y_velocity"]);
const PARTS: (&str, &[&str]) =
    ("matsum", &["x_momentum", "y_momentum", "x_rbvelocity", "y_rbvelocity"]);
const BODIES: (&str, &[&str]) = ("rbdout", &rbdout::ARRAYS);
const READ: [(&str, &[&str]); 5] = [CONTACTS, SECTIONS, NODES, PARTS, BODIES];

/// Arrays of the metadata that are read.
const METADATA: [&str; 5] = ["ids", "side", "legend", "legend_ids", "num_nodal"];

/// Those of them that a state of rigid bodies may have of its own.
const OF_STATE: [&str; 2] = ["ids", "num_nodal"];

/// A folder as it is read.
#[derive(Default)]
struct Folder {
    ids: Vec<f64>,
    sides: Vec<f64>,
    legend: Vec<u8>,
    legend_ids: Vec<f64>,
    states: Vec<State>,
    /// How many of the ids, the last ones, are bodies that are made of nodes.
    n_nodal: usize,
    /// Whether there are others at another instant.
    ids_change: bool,
}

/// Arrays of one instant, by their names.
struct State {
    /// The part and the folder in which they stand.
    place: (usize, String),
    arrays: BTreeMap<String, Vec<f64>>,
}

/// The states of a folder in the order of time.
struct Table {
    ids: Vec<i64>,
    time: Vec<f64>,
    /// For each array a row of numbers, one for each id, at each instant; `None` if it is not there.
    arrays: Vec<Option<Vec<Vec<f64>>>>,
}

/// Reads a file with its other parts.
pub(super) fn read(path: &Path) -> Result<Results, DataError> {
    let mut folders: BTreeMap<&'static str, Folder> = BTreeMap::new();
    let (mut left, mut doubts) = (MAX_TABLE_BYTES, Vec::new());
    let parts = parts(path)?;
    for (at, part) in parts.iter().enumerate() {
        let mut take = |array: Array<'_>| keep(&mut folders, at, array);
        if lsda::read(part, &is_read, &mut left, &mut take)? {
            let name = part.file_name().unwrap_or_default().to_string_lossy().into_owned();
            doubts.push(format!("{name} ends within a record, as that of a run that was ended"));
        }
    }
    let notes = match parts.len() {
        1 => Vec::new(),
        n => vec![format!("read from {n} files")],
    };
    let damaged = |why: String| {
        let place = Place::Whole;
        DataError::DamagedAt { path: path.to_owned(), place, why }
    };
    let mut results =
        Results { format: "an LS-DYNA binout file", notes, doubts, ..Results::default() };
    results.add(&mut folders).map_err(&damaged)?;
    if results.histories.is_empty() {
        let names = "rcforc, secforc, nodout or rbdout with states";
        let seen = results.doubts.last().map_or_else(String::new, |seen| format!(" ({seen})"));
        let why = format!("is a binout of LS-DYNA without {names}; write one of them{seen}");
        return Err(damaged(why));
    }
    Ok(results)
}

/// Whether an array is one that is read.
fn is_read(folder: &[String], name: &str) -> bool {
    let [database, inner] = folder else { return false };
    let found = READ.into_iter().find(|(of, _)| *of == database.as_str());
    let Some((database, arrays)) = found else { return false };
    let is_of_state = database == BODIES.0 && OF_STATE.contains(&name);
    match inner.as_str() {
        "metadata" => METADATA.contains(&name),
        _ => is_state(inner) && (name == "time" || is_of_state || arrays.contains(&name)),
    }
}

fn is_state(folder: &str) -> bool {
    let digits = folder.strip_prefix('d').unwrap_or_default();
    !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
}

/// Keeps an array.
///
/// The error is what is wrong with it.
fn keep(
    folders: &mut BTreeMap<&'static str, Folder>,
    part: usize,
    Array { folder, name, values }: Array<'_>,
) -> Result<(), String> {
    let [database, inner] = folder else { return Ok(()) };
    let found = READ.into_iter().find(|(of, _)| *of == database.as_str());
    let Some((database, _)) = found else { return Ok(()) };
    let of = folders.entry(database).or_default();
    match (inner.as_str(), name) {
        ("metadata", "legend") => of.legend = values.into_bytes(),
        ("metadata", "legend_ids") => of.legend_ids = values.into_numbers(),
        ("metadata", "side") => of.sides = values.into_numbers(),
        (_, "num_nodal") => {
            of.n_nodal = values.into_numbers().first().map_or(0, |n| *n as usize);
        }
        (_, "ids") => {
            let ids = values.into_numbers();
            let is_other = !of.ids.is_empty() && of.ids != ids;
            if is_other && !ids.is_empty() && database != BODIES.0 {
                return Err(format!("the ids of {database} are others than before"));
            }
            of.ids_change |= is_other;
            if !ids.is_empty() {
                of.ids = ids;
            }
        }
        (state, _) => {
            let is_same = |last: &State| last.place.0 == part && last.place.1 == state;
            if !of.states.last().is_some_and(is_same) {
                let place = (part, state.to_owned());
                of.states.push(State { place, arrays: BTreeMap::new() });
            }
            if let Some(last) = of.states.last_mut() {
                last.arrays.insert(name.to_owned(), values.into_numbers());
            }
        }
    }
    Ok(())
}

impl Results {
    /// Adds what the folders hold. The error is what is wrong with them.
    fn add(&mut self, folders: &mut BTreeMap<&'static str, Folder>) -> Result<(), String> {
        if let Some((table, folder)) = self.table(CONTACTS, folders)? {
            self.histories.extend(table.contacts(&folder));
        }
        if let Some((table, folder)) = self.table(SECTIONS, folders)? {
            self.histories.extend(table.histories((Kind::Section, "section"), &FORCE, &folder));
            let note = "the force of a section is in the axes of the section, where it has some";
            self.notes.push(note.to_owned());
        }
        if let Some((table, folder)) = self.table(NODES, folders)? {
            self.histories.extend(table.histories((Kind::Node, "node"), &NODE, &folder));
        }
        if let Some((table, _)) = self.table(PARTS, folders)? {
            self.momenta = table.momenta();
        }
        // Bodies that become deformable are no reason to refuse the forces.
        let bodies = self.table(BODIES, folders).and_then(|found| match found {
            Some((table, folder)) => table.bodies(&folder),
            None => Ok(Vec::new()),
        });
        match bodies {
            Ok(bodies) => self.histories.extend(bodies),
            Err(why) => self.doubts.push(format!("rigid bodies are left out: {why}")),
        }
        Ok(())
    }

    /// The states of a folder, and the folder; `None` if there is none.
    fn table(
        &mut self,
        (name, arrays): (&str, &[&str]),
        folders: &mut BTreeMap<&'static str, Folder>,
    ) -> Result<Option<(Table, Folder)>, String> {
        let Some(mut folder) = folders.remove(name) else { return Ok(None) };
        let table = Table::new((name, arrays), &mut folder, &mut self.doubts)?;
        Ok(table.map(|table| (table, folder)))
    }
}

impl Table {
    /// The states of a folder in the order of time; `None` if it has none.
    ///
    /// The error is what is wrong with them.
    fn new(
        (name, wanted): (&str, &[&str]),
        folder: &mut Folder,
        doubts: &mut Vec<String>,
    ) -> Result<Option<Self>, String> {
        let mut states = std::mem::take(&mut folder.states);
        let is_complete = |state: &State, before: Option<&State>| {
            let first = wanted.first().copied().unwrap_or_default();
            let arrays = &state.arrays;
            let lacks = |of: &State| {
                let mut had = wanted.iter().filter(|array| of.arrays.contains_key(**array));
                had.any(|array| !arrays.contains_key(*array))
            };
            arrays.contains_key("time") && arrays.contains_key(first) && !before.is_some_and(lacks)
        };
        let before = states.len().checked_sub(2).and_then(|at| states.get(at));
        if states.last().is_some_and(|last| !is_complete(last, before)) {
            states.pop();
            doubts.push(format!("{name}: {}", cut_state()));
        }
        let (mut time, mut kept): (Vec<f64>, Vec<State>) = (Vec::new(), Vec::new());
        let mut n_again = 0;
        for mut state in states {
            let at = state.arrays.remove("time").and_then(|time| time.first().copied());
            let folder = &state.place.1;
            let at = at.filter(|at| at.is_finite());
            let at = at.ok_or_else(|| format!("{name}/{folder}: has no finite time"))?;
            let n = time.iter().rposition(|earlier| *earlier < at).map_or(0, |last| last + 1);
            n_again += time.len() - n;
            time.truncate(n);
            kept.truncate(n);
            time.push(at);
            kept.push(state);
        }
        if n_again > 0 {
            doubts.push(format!("{name}: {}", written_again(n_again)));
        }
        let n_zeros = folder.leave_out_zeros(n_values(&kept, wanted));
        if n_zeros > 0 {
            doubts.push(format!(
                "{name}: {n_zeros} ids are 0 and have no numbers; they are left out"
            ));
        }
        let ids: Vec<i64> = folder.ids.iter().map(|id| *id as i64).collect();
        if kept.is_empty() || ids.is_empty() {
            return Ok(None);
        }
        let arrays = wanted.iter().map(|array| rows(name, array, ids.len(), &mut kept));
        let arrays = arrays.collect::<Result<Vec<_>, _>>()?;
        Ok(Some(Self { ids, time, arrays }))
    }

    /// A number of one id at all instants.
    fn column(&self, array: usize, id_idx: usize) -> Option<Vec<f64>> {
        let rows = self.arrays.get(array)?.as_ref()?;
        rows.iter().map(|row| row.get(id_idx).copied()).collect()
    }

    /// The columns of one id up to the first that is not there.
    fn columns(&self, id_idx: usize) -> Vec<Vec<f64>> {
        (0..self.arrays.len()).map_while(|array| self.column(array, id_idx)).collect()
    }

    /// A history for each id.
    fn histories(
        &self,
        (kind, word): (Kind, &str),
        names: &[(&'static str, Dimension)],
        folder: &Folder,
    ) -> Vec<History> {
        let (time, titles) = (Arc::new(self.time.clone()), folder.titles());
        let history = |(at, id): (usize, &i64)| {
            let values = self.columns(at);
            let title = titles.get(id).cloned().unwrap_or_default();
            let name = (format!("{word} {id}"), title);
            // A file may hold less than what is read of it.
            let is_whole = values.len() >= names.len();
            is_whole.then(|| History::new(kind, name, &time, columns(names, values)))
        };
        self.ids.iter().enumerate().filter_map(history).collect()
    }

    /// The motion of each rigid body. The error is why they cannot be read.
    fn bodies(&self, folder: &Folder) -> Result<Vec<History>, String> {
        let name = BODIES.0;
        if folder.ids_change {
            return Err(format!("{name} has other bodies at other instants"));
        }
        let lacking = BODIES.1.iter().zip(&self.arrays).find(|(_, rows)| rows.is_none());
        if let Some((array, _)) = lacking {
            return Err(format!("{name} has no {array}"));
        }
        let time = Arc::new(self.time.clone());
        let n_rigid = self.ids.len().saturating_sub(folder.n_nodal);
        let body = |(at, id): (usize, &i64)| {
            rbdout::history((at >= n_rigid, *id), &time, self.columns(at))
        };
        Ok(self.ids.iter().enumerate().map(body).collect())
    }

    /// The force on each side of each contact.
    fn contacts(&self, folder: &Folder) -> Vec<History> {
        let mut names = FORCE.to_vec();
        if self.arrays.last().is_some_and(Option::is_some) {
            names.push(MOMENT);
        }
        let mut histories = self.histories((Kind::Contact, "contact"), &names, folder);
        let count = |id: &i64, ids: &[i64]| ids.iter().filter(|of| *of == id).count();
        let sides = (folder.sides.len() == self.ids.len()).then_some(&folder.sides);
        for (at, (id, history)) in self.ids.iter().zip(&mut histories).enumerate() {
            let before = self.ids.get(..at).unwrap_or_default();
            let side = match sides.and_then(|sides| sides.get(at)) {
                Some(side) if *side == 0.0 => " slave".to_owned(),
                Some(_) => " master".to_owned(),
                None if count(id, &self.ids) > 1 => format!(" side {}", count(id, before) + 1),
                None => String::new(),
            };
            history.name += &side;
        }
        for at in 0..histories.len() {
            let others = self.ids.iter().enumerate();
            let mut others = others.filter(|(of, id)| *of != at && Some(*id) == self.ids.get(at));
            let other = others.next().map(|(of, _)| of).filter(|_| others.next().is_none());
            if let Some(history) = histories.get_mut(at) {
                history.other_side = other;
            }
        }
        histories
    }

    /// The momenta of the parts; `None` if they or the first velocities are not there.
    fn momenta(&self) -> Option<Momenta> {
        let part = |at: usize| {
            let [px, py, vx, vy] = <[Vec<f64>; 4]>::try_from(self.columns(at)).ok()?;
            let start = [*vx.first()?, *vy.first()?];
            Some(PartMomentum { start, momentum: [px, py] })
        };
        let parts: Option<Vec<PartMomentum>> = (0..self.ids.len()).map(part).collect();
        Some(Momenta { time: self.time.clone(), parts: parts? })
    }
}

/// The rows of an array at all instants; `None` if it is in none of the states.
///
/// The error says which state lacks it or has another number of values.
fn rows(
    name: &str,
    array: &str,
    n_ids: usize,
    states: &mut [State],
) -> Result<Option<Vec<Vec<f64>>>, String> {
    if states.iter().all(|state| !state.arrays.contains_key(array)) {
        return Ok(None);
    }
    let row = |state: &mut State| {
        let row = state.arrays.remove(array).unwrap_or_default();
        match row.len() == n_ids {
            true => Ok(row),
            false => {
                let (folder, n) = (&state.place.1, row.len());
                Err(format!("{name}/{folder}/{array}: has {n} values, expected {n_ids}"))
            }
        }
    };
    states.iter_mut().map(row).collect::<Result<Vec<_>, _>>().map(Some)
}

/// How many values the first state has of the first array.
fn n_values(states: &[State], arrays: &[&str]) -> usize {
    let array = states.first().zip(arrays.first());
    array.and_then(|(state, array)| state.arrays.get(*array)).map_or(0, Vec::len)
}

impl Folder {
    /// Leaves out the ids that are 0, if the states have numbers of the others alone.
    ///
    /// - `n_values`: how many numbers a state has;
    /// - returns how many ids were left out.
    fn leave_out_zeros(&mut self, n_values: usize) -> usize {
        let is_id: Vec<bool> = self.ids.iter().map(|id| *id != 0.0).collect();
        let n_ids = is_id.iter().filter(|is_id| **is_id).count();
        if n_ids == is_id.len() || n_ids != n_values {
            return 0;
        }
        if self.legend_ids.is_empty() {
            // The titles belong to all ids.
            self.legend_ids.clone_from(&self.ids);
        }
        for of_ids in [&mut self.ids, &mut self.sides] {
            if of_ids.len() == is_id.len() {
                let mut is_id = is_id.iter();
                of_ids.retain(|_| is_id.next() == Some(&true));
            }
        }
        is_id.len() - n_ids
    }

    /// The titles by id: letters of one length for each of them.
    fn titles(&self) -> BTreeMap<i64, String> {
        let ids = if self.legend_ids.is_empty() { &self.ids } else { &self.legend_ids };
        let length = self.legend.len().checked_div(ids.len()).unwrap_or(0);
        if length == 0 {
            return BTreeMap::new();
        }
        let title = |letters: &[u8]| plain_title(&String::from_utf8_lossy(letters));
        let titles = self.legend.chunks_exact(length).map(title);
        ids.iter().map(|id| *id as i64).zip(titles).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run that is ended while it writes a state leaves some of its arrays.
    #[test]
    fn a_last_state_without_some_of_its_arrays_is_left_out() {
        let state = |at: f64, arrays: &[&str]| {
            let arrays = arrays.iter().map(|array| ((*array).to_owned(), vec![at; 2]));
            let time = ("time".to_owned(), vec![at]);
            State { place: (0, format!("d{at}")), arrays: arrays.chain([time]).collect() }
        };
        let both = ["x_force", "y_force"];
        let read = |states: Vec<State>| {
            let mut folder = Folder { ids: vec![3.0, 3.0], states, ..Folder::default() };
            let mut doubts = Vec::new();
            let table = Table::new((CONTACTS.0, both.as_slice()), &mut folder, &mut doubts);
            table.map(|table| (table.unwrap().time, doubts))
        };
        let cut = vec![state(0.0, &both), state(1.0, &both), state(2.0, &both[..1])];
        let (time, doubts) = read(cut).unwrap();
        assert_eq!(time, [0.0, 1.0]);
        assert!(doubts[0].contains("the last state is not complete"), "{doubts:?}");
        let damaged = vec![state(0.0, &both), state(1.0, &both[..1]), state(2.0, &both)];
        let error = read(damaged).unwrap_err();
        assert!(error.contains("d1/y_force: has 0 values"), "{error}");
    }

    #[test]
    fn a_contact_without_sides_has_no_numbers() {
        let folder = || Folder {
            ids: vec![3.0, 3.0, 0.0, 0.0, 8.0, 8.0],
            sides: vec![0.0, 1.0, 0.0, 1.0, 1.0, 0.0],
            ..Folder::default()
        };
        let mut without = folder();
        assert_eq!(without.leave_out_zeros(4), 2);
        assert_eq!(without.ids, [3.0, 3.0, 8.0, 8.0]);
        assert_eq!(without.sides, [0.0, 1.0, 1.0, 0.0]);
        let mut titled = Folder { legend: b"A A     B B ".to_vec(), ..folder() };
        assert_eq!(titled.leave_out_zeros(4), 2);
        let titles = titled.titles();
        assert_eq!([&titles[&3], &titles[&8]], ["A", "B"]);
        let mut whole = folder();
        assert_eq!(whole.leave_out_zeros(6), 0);
        assert_eq!(whole.ids.len(), 6);
    }
}
