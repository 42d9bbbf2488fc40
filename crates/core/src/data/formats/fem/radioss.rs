//! `T01` of OpenRadioss and Radioss: time histories in records of Fortran.
//!
//! ```text
//! record   i32 bytes, payload, i32 bytes; everything is big endian, reals are of 4 bytes
//! title    i32 code of the format (3040, 3041, 3050, 4021), 80 letters
//! date     80 letters
//! extra    from 3050: i32 number of records; i32 length of titles; 3 reals, factors of mass, length, time
//! counts   6 i32: parts, materials, properties, subsets, groups, global variables
//!          i32 codes of the global variables
//! part     i32 id, title, 4 i32 of which the last is the number of variables; then their i32 codes
//! material, property   i32 id, title
//! subset   5 i32: id, parent, n children, n parts, n variables; title; then children, parts, codes
//! group    5 i32: id, type, 0, n entities, n variables; title; then i32 id and title of each entity; codes
//! state    real time; global variables; variables of all parts; of all subsets; of each group
//! ```
//!
//! Forces of contacts, walls, rigid bodies and sections are **impulses** from the start of the run; those of
//! springs are forces. The former are differentiated here. A title has 40 letters in format 3040, 80 in 3041,
//! 100 from 3050, or as many as the extra record says.
//!
//! Layout and codes: the converter `th_to_csv` of OpenRadioss and the writers that it belongs to.

use std::path::Path;
use std::sync::Arc;

use crate::data::budget::MAX_TABLE_BYTES;
use crate::data::formats::fem::deck::{DeckUnits, Dimension};
use crate::data::formats::fem::fortran::{Record, Records, Wrong, float, word};
use crate::data::formats::fem::momenta::{Momenta, PartMomentum};
use crate::data::formats::fem::results::{FORCE, History, Kind, NODE, Results, columns};
use crate::data::formats::fem::states::{cut_state, written_again};
use crate::data::{DataError, Place, impulse, read_bytes};

/// Bytes of the first record.
const TITLE_BYTES: i32 = 84;

/// Longest title, bytes.
const MAX_TITLE_BYTES: usize = 1000;

/// Codes of the variables of a part that are read: momentum along x and y, mass.
const PART: [i32; 3] = [3, 4, 6];

/// Share of its largest size to which a stored impulse may come back.
const COMES_BACK: f64 = 0.05;

/// Whether the first bytes of a file are those of this format.
pub(super) fn is_history(head: &[u8]) -> bool {
    let number = |at| word(head, at).map(i32::from_be_bytes);
    number(0) == Some(TITLE_BYTES)
        && number(88) == Some(TITLE_BYTES)
        && number(4).is_some_and(|code| (3000..10_000).contains(&code))
}

/// Something whose numbers are read: which record of a state holds them, and where in it.
struct Source {
    kind: Kind,
    name: (String, String),
    is_impulse: bool,
    /// The place of the group among all groups.
    group: usize,
    /// For each column the places in the record that are added up.
    places: Vec<Vec<usize>>,
    values: Vec<Vec<f64>>,
}

/// A part whose momentum is read.
struct Part {
    /// Places of momentum along x and y and of the mass in the record of all parts.
    places: [usize; 3],
    /// Momentum along x and y.
    momentum: [Vec<f64>; 2],
    first_mass: f64,
}

/// What stands in front of the states.
#[derive(Default)]
struct Head {
    n_global: usize,
    n_of_parts: usize,
    n_of_subsets: usize,
    /// Numbers of each group in a state.
    groups: Vec<usize>,
    sources: Vec<Source>,
    parts: Vec<Part>,
    stated: Option<DeckUnits>,
    doubts: Vec<String>,
}

/// Reads a file.
pub(super) fn read(path: &Path) -> Result<Results, DataError> {
    let bytes = read_bytes(path, MAX_TABLE_BYTES)?;
    let damaged = |(at, why): Wrong| {
        let place = Place::Byte(at as u64);
        DataError::DamagedAt { path: path.to_owned(), place, why }
    };
    let mut records = Records { bytes: &bytes, at: 0 };
    let mut head = Head::read(&mut records).map_err(damaged)?;
    let (time, doubts) = head.read_states(&mut records).map_err(damaged)?;
    if time.is_empty() || head.sources.is_empty() {
        let names = "a contact, wall, rigid body, section, spring or node with its components along x and y";
        let why =
            format!("is a time history of Radioss without states of {names}; ask for one with /TH");
        return Err(DataError::DamagedAt { path: path.to_owned(), place: Place::Whole, why });
    }
    Ok(head.results(time, doubts))
}

impl Head {
    fn read(records: &mut Records<'_>) -> Result<Self, Wrong> {
        let mut head = Self::default();
        let code = records.needed("the title")?.integer(0)?;
        let mut n_title = match code {
            ..=3040 => 40,
            3041..=3049 => 80,
            _ => 100,
        };
        records.needed("the date")?;
        if code >= 3050 {
            let n_extra = records.needed("the number of extra records")?.count(0)?;
            for idx in 0..n_extra {
                let extra = records.needed("an extra record")?;
                match (idx, extra.bytes.len()) {
                    (0, 4) => n_title = extra.count(0)?,
                    (_, 12) => head.stated = DeckUnits::from_factors(factors(extra)),
                    _ => {}
                }
            }
        }
        if n_title > MAX_TITLE_BYTES {
            return Err((records.at, format!("titles of {n_title} bytes")));
        }
        let counts = records.needed("the counts")?;
        let count = |idx| counts.count(idx);
        let [n_parts, n_plain, n_subsets, n_groups] =
            [count(0)?, count(1)?.saturating_add(count(2)?), count(3)?, count(4)?];
        head.n_global = count(5)?;
        if head.n_global > 0 {
            records.needed("the global variables")?;
        }
        for _ in 0..n_parts {
            head.add_part(records, n_title)?;
        }
        for _ in 0..n_plain {
            records.needed("a material or property")?;
        }
        for _ in 0..n_subsets {
            let subset = records.needed("a subset")?;
            for idx in 2..5 {
                if subset.count(idx)? > 0 {
                    records.needed("the content of a subset")?;
                }
            }
            head.n_of_subsets = head.n_of_subsets.saturating_add(subset.count(4)?);
        }
        for _ in 0..n_groups {
            head.add_group(records, n_title)?;
        }
        Ok(head)
    }

    fn add_part(&mut self, records: &mut Records<'_>, n_title: usize) -> Result<(), Wrong> {
        let part = records.needed("a part")?;
        let n = part.count_at(4 + n_title + 12)?;
        if n == 0 {
            return Ok(());
        }
        let codes = records.needed("the variables of a part")?.codes();
        let place = |code: i32| codes.iter().position(|of| *of == code);
        if let [Some(x), Some(y), Some(mass)] = PART.map(place) {
            let places = [x, y, mass].map(|at| self.n_of_parts + at);
            self.parts.push(Part { places, momentum: Default::default(), first_mass: 0.0 });
        }
        self.n_of_parts = self.n_of_parts.saturating_add(n);
        Ok(())
    }

    fn add_group(&mut self, records: &mut Records<'_>, n_title: usize) -> Result<(), Wrong> {
        let group = records.needed("a group")?;
        let (kind, n_entities, n) = (group.integer(1)?, group.count(3)?, group.count(4)?);
        let mut entities = Vec::new();
        for _ in 0..n_entities {
            let entity = records.needed("an entity of a group")?;
            entities.push((entity.integer(0)?, entity.title(4, n_title)));
        }
        let codes =
            if n > 0 { records.needed("the variables of a group")?.codes() } else { Vec::new() };
        let at = self.groups.len();
        self.groups.push(n_entities.saturating_mul(n));
        let Some((kind, word, is_impulse, wanted)) = read_of(kind) else { return Ok(()) };
        let place = |code: &i32| codes.iter().position(|of| of == code);
        let places: Vec<Vec<usize>> =
            wanted.iter().map(|codes| codes.iter().filter_map(place).collect()).collect();
        let n_needed = if kind == Kind::Node { NODE.len() } else { 2 };
        if places.iter().take(n_needed).any(Vec::is_empty) {
            return Ok(());
        }
        if places.iter().zip(wanted).take(n_needed).any(|(places, all)| places.len() < all.len()) {
            let title = group.title(20, n_title);
            self.doubts.push(format!(
                "the group {title:?} of a {word} has its normal or its tangential force only"
            ));
        }
        for (idx, (id, title)) in entities.into_iter().enumerate() {
            let name = (format!("{word} {id}"), title);
            let moved = |places: &Vec<usize>| places.iter().map(|at| idx * n + at).collect();
            let places: Vec<Vec<usize>> = places.iter().map(moved).collect();
            let values = vec![Vec::new(); places.len()];
            self.sources.push(Source { kind, name, is_impulse, group: at, places, values });
        }
        Ok(())
    }

    /// Reads the states to the end of the file, and returns their times and what is doubtful.
    fn read_states(&mut self, records: &mut Records<'_>) -> Result<(Vec<f64>, Vec<String>), Wrong> {
        let (mut time, mut n_again) = (Vec::<f64>::new(), 0);
        let mut doubts = std::mem::take(&mut self.doubts);
        loop {
            let start = records.at;
            let Some(record) = records.next()? else {
                if start < records.bytes.len() {
                    doubts.push(cut_state());
                }
                break;
            };
            if record.len() != 4 {
                return Err((start, format!("a time of {} bytes", record.len())));
            }
            let at = float(record, 0);
            if !at.is_finite() {
                return Err((start, "a time that is not finite".to_owned()));
            }
            let Some(state) = self.state(records)? else {
                doubts.push(cut_state());
                break;
            };
            let n = time.iter().rposition(|earlier| *earlier < at).map_or(0, |last| last + 1);
            if n < time.len() {
                n_again += time.len() - n;
                time.truncate(n);
                self.truncate(n);
            }
            time.push(at);
            self.take(&state);
        }
        if n_again > 0 {
            doubts.push(written_again(n_again));
        }
        Ok((time, doubts))
    }

    /// The numbers of parts and groups of a state; `None` if the file ends within it.
    fn state<'a>(&self, records: &mut Records<'a>) -> Result<Option<State<'a>>, Wrong> {
        let mut next = |n: usize| -> Result<Option<&'a [u8]>, Wrong> {
            let start = records.at;
            match records.next()? {
                // An empty group has an empty record or none.
                next if n == 0 => {
                    if next.is_none_or(|record| !record.is_empty()) {
                        records.at = start;
                    }
                    Ok(Some(&[]))
                }
                Some(record) if record.len() / 4 == n && record.len() % 4 == 0 => Ok(Some(record)),
                Some(record) => {
                    let length = record.len();
                    Err((
                        start,
                        format!("a record of {length} bytes in a state, expected {n} numbers"),
                    ))
                }
                None => Ok(None),
            }
        };
        let mut parts: &[u8] = &[];
        for (n, is_parts) in
            [(self.n_global, false), (self.n_of_parts, true), (self.n_of_subsets, false)]
        {
            if n == 0 {
                continue;
            }
            let Some(record) = next(n)? else { return Ok(None) };
            if is_parts {
                parts = record;
            }
        }
        let mut groups = Vec::new();
        for n in &self.groups {
            let Some(record) = next(*n)? else { return Ok(None) };
            groups.push(record);
        }
        Ok(Some(State { parts, groups }))
    }

    /// Takes the numbers of a state.
    fn take(&mut self, state: &State<'_>) {
        for source in &mut self.sources {
            let record = state.groups.get(source.group).copied().unwrap_or_default();
            for (places, values) in source.places.iter().zip(&mut source.values) {
                values.push(places.iter().map(|at| float(record, *at)).sum());
            }
        }
        for part in &mut self.parts {
            let [x, y, mass] = part.places.map(|at| float(state.parts, at));
            if part.momentum[0].is_empty() {
                part.first_mass = mass;
            }
            part.momentum[0].push(x);
            part.momentum[1].push(y);
        }
    }

    fn truncate(&mut self, n: usize) {
        let values = self.sources.iter_mut().flat_map(|source| &mut source.values);
        let momenta = self.parts.iter_mut().flat_map(|part| &mut part.momentum);
        values.chain(momenta).for_each(|values| values.truncate(n));
    }

    fn results(self, time: Vec<f64>, mut doubts: Vec<String>) -> Results {
        let shared = Arc::new(time);
        let (mut histories, mut notes) = (Vec::new(), Vec::new());
        let has_impulses = self.sources.iter().any(|source| source.is_impulse);
        if has_impulses {
            notes.push(
                "the forces of contacts, walls, rigid bodies and sections are stored as impulses and \
                 were differentiated, those of springs are forces"
                    .to_owned(),
            );
        }
        for Source { kind, name, is_impulse, values, .. } in self.sources {
            doubts.extend(unlike(&name.0, is_impulse, &values));
            let rates = |values: Vec<f64>| match is_impulse {
                true => impulse::rate_n(&values, &shared),
                false => values,
            };
            let names: &[(&'static str, Dimension)] =
                if kind == Kind::Node { &NODE } else { &FORCE };
            let columns = columns(names, values.into_iter().map(rates));
            let history = History::new(kind, name, &shared, columns);
            match kind {
                Kind::Contact | Kind::Wall => {
                    histories.extend(both_sides(history, histories.len()))
                }
                _ => histories.push(history),
            }
        }
        let parts = self.parts.into_iter().map(|Part { momentum, first_mass, .. }| {
            let first = |axis: &Vec<f64>| axis.first().copied().unwrap_or(0.0) / first_mass;
            let start = momentum.each_ref().map(first);
            PartMomentum { start, momentum }
        });
        let parts: Vec<PartMomentum> = parts.collect();
        let momenta = (!parts.is_empty()).then(|| Momenta { time: shared.to_vec(), parts });
        let format = "a time history of OpenRadioss (T01)";
        Results { format, histories, notes, doubts, momenta, stated: self.stated }
    }
}

/// The records of a state that are read.
struct State<'a> {
    parts: &'a [u8],
    groups: Vec<&'a [u8]>,
}

/// The force as it is written, and that on the other side.
fn both_sides(history: History, at: usize) -> [History; 2] {
    let name = |word: &str| format!("{} {word}", history.name);
    let reversed = History {
        name: name("reversed"),
        is_reversed: true,
        other_side: Some(at),
        ..history.clone()
    };
    [History { name: name("as written"), other_side: Some(at + 1), ..history }, reversed]
}

/// Says of a force that it does not look like what the format says that it is.
fn unlike(name: &str, is_impulse: bool, values: &[Vec<f64>]) -> Option<String> {
    let [x, y, ..] = values else { return None };
    let sizes = || x.iter().zip(y).map(|(x, y)| x.hypot(*y));
    let (largest, last) = (sizes().fold(0.0, f64::max), sizes().next_back()?);
    let comes_back = largest > 0.0 && last < COMES_BACK * largest;
    match is_impulse {
        true if comes_back => Some(format!(
            "{name} comes back to zero, as a force does; it was differentiated as the impulse that the \
             format stores"
        )),
        false if !name.starts_with("node") && impulse::is_impulse(x, y) => Some(format!(
            "{name} rises to a value at which it stays, as an impulse does; it is read as a force"
        )),
        _ => None,
    }
}

/// What is read of a group of a type: kind, word, whether its forces are stored as impulses, and the codes
/// of variables that are added up for each column.
type Read = (Kind, &'static str, bool, &'static [&'static [i32]]);

/// What is read of a group; `None` for a type that has no force and no motion.
fn read_of(group_type: i32) -> Option<Read> {
    // Normal and tangential force: FNX, FNY, FNZ, FTX, FTY, FTZ.
    const BOTH: &[&[i32]] = &[&[1, 4], &[2, 5], &[3, 6]];
    // FX, FY, FZ of a rigid body, and of a spring, whose first variable is OFF.
    const BODY: &[&[i32]] = &[&[1], &[2], &[3]];
    const SPRING: &[&[i32]] = &[&[2], &[3], &[4]];
    // X, Y, VX, VY.
    const MOTION: &[&[i32]] = &[&[16], &[17], &[4], &[5]];
    Some(match group_type {
        0 => (Kind::Node, "node", false, MOTION),
        6 => (Kind::Spring, "spring", false, SPRING),
        101 => (Kind::Contact, "contact", true, BOTH),
        102 => (Kind::Wall, "wall", true, BOTH),
        103 => (Kind::Body, "rigid body", true, BODY),
        104 => (Kind::Section, "section", true, BOTH),
        _ => return None,
    })
}

/// The factors of mass, length and time.
fn factors(extra: Record<'_>) -> [f64; 3] {
    [0, 1, 2].map(|at| float(extra.bytes, at))
}
