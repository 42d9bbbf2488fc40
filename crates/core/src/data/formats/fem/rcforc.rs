//! `rcforc` of LS-DYNA: the resultant force of each contact on both of its sides.
//!
//! ```text
//! {BEGIN LEGEND} … {END LEGEND}
//!   master%11d time%12.5E  x %12.5E  y %12.5E  z %12.5E mass %12.5E mx %12.5E my %12.5E mz %12.5E
//!   slave %11d time%12.5E  x …
//! ```
//!
//! The sides are called `SURFA` (slave) and `SURFB` (master) by newer versions. A number may touch its
//! keyword. Older versions have no mass and no moments; a row of a tied contact ends with
//! `tied %10d  tied area %12.5E`. The force is in the axes of the model; the moment is about their origin.
//!
//! A contact of a single surface has no row, but in each state the line
//! `interface number, %9d,is single surface-resultants are undefined`.
//!
//! Source: `l2a` of LSTC, which writes these texts from a `binout`.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::data::formats::fem::legend::Legend;
use crate::data::formats::fem::results::{FORCE, History, Kind, MOMENT, Results, columns};
use crate::data::formats::fem::states::States;
use crate::data::formats::fem::tokens::{Token, tokens, whole_lines};

/// The keywords of the numbers that are read.
const NAMES: [&str; 4] = ["x", "y", "z", "mz"];

/// Most contacts that are named in a sentence.
const MOST_NAMED: usize = 6;

/// A side of a contact, in the order in which sides are proposed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Side {
    Slave,
    Master,
    SurfA,
    SurfB,
}

impl Side {
    const ALL: [Self; 4] = [Self::Slave, Self::Master, Self::SurfA, Self::SurfB];

    fn name(self) -> &'static str {
        match self {
            Self::Slave => "slave",
            Self::Master => "master",
            Self::SurfA => "surfa",
            Self::SurfB => "surfb",
        }
    }

    fn other(self) -> Self {
        match self {
            Self::Slave => Self::Master,
            Self::Master => Self::Slave,
            Self::SurfA => Self::SurfB,
            Self::SurfB => Self::SurfA,
        }
    }
}

/// One side of a contact at an instant.
struct Row {
    key: (i64, Side),
    time: f64,
    /// The force, and the moment about z; `None` where the file has none.
    force: [f64; 3],
    moment: Option<f64>,
}

/// Whether a line is a row of such a file.
pub(super) fn is_row(line: &str) -> bool {
    matches!(row(line), Some(Ok(_)))
}

/// Reads a file. The error is a line with what is wrong with it.
pub(super) fn read(text: &str) -> Result<Results, (u64, String)> {
    let mut states = States::<(i64, Side), 4>::default();
    let (mut legend, mut has_moments, mut n_other) = (Legend::default(), true, 0);
    let mut single = BTreeSet::new();
    let (lines, cut) = whole_lines(text);
    for (number, line) in lines {
        if legend.takes(line) {
            continue;
        }
        if let Some(id) = single_surface(line) {
            single.insert(id);
            continue;
        }
        let Some(row) = row(line) else {
            n_other += usize::from(!states.time.is_empty() && !line.trim().is_empty());
            continue;
        };
        let row = row.map_err(|why| (number, why))?;
        has_moments &= row.moment.is_some();
        let [x, y, z] = row.force;
        let numbers = [x, y, z, row.moment.unwrap_or(0.0)];
        let added = states.begin(row.time).and_then(|()| states.push(row.key, numbers));
        let (id, side) = row.key;
        added.map_err(|why| (number, format!("contact {id} {}: {why}", side.name())))?;
    }
    states.end();
    let mut doubts = states.doubts();
    doubts.extend(cut);
    doubts.extend(without_force(&single));
    if n_other > 0 {
        doubts.push(format!("{n_other} lines among the states are not understood and left out"));
    }
    let histories = histories(&states, &legend, has_moments);
    Ok(Results { format: "an LS-DYNA rcforc file", histories, doubts, ..Results::default() })
}

fn histories(states: &States<(i64, Side), 4>, legend: &Legend, has_moments: bool) -> Vec<History> {
    let time = Arc::new(states.time.clone());
    let mut names = FORCE.to_vec();
    names.extend(has_moments.then_some(MOMENT));
    let places: BTreeMap<(i64, Side), usize> =
        states.rows.keys().enumerate().map(|(at, key)| (*key, at)).collect();
    let history = |((id, side), rows): (&(i64, Side), &Vec<[f64; 4]>)| {
        let name = format!("contact {id} {}", side.name());
        let values = (0..4).map(|at| States::<(i64, Side), 4>::column(rows, at));
        let new =
            History::new(Kind::Contact, (name, legend.title(*id)), &time, columns(&names, values));
        History { other_side: places.get(&(*id, side.other())).copied(), ..new }
    };
    states.rows.iter().map(history).collect()
}

/// The contact of which a line says that it is a single surface.
fn single_surface(line: &str) -> Option<i64> {
    let lower = line.trim().to_ascii_lowercase();
    let rest = lower.strip_prefix("interface number")?;
    rest.contains("single surface").then(|| tokens(rest).find_map(Token::whole))?
}

/// That the force of single surfaces is not in a file.
fn without_force(contacts: &BTreeSet<i64>) -> Option<String> {
    let ids: Vec<String> = contacts.iter().take(MOST_NAMED).map(i64::to_string).collect();
    let more = match contacts.len().saturating_sub(ids.len()) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!ids.is_empty()).then(|| {
        format!(
            "contacts of a single surface, whose forces are not in the file: {}{more}; a force transducer in the \
             model would write them",
            ids.join(", ")
        )
    })
}

/// The row in a line; `None` for any other line.
///
/// The error is what is wrong with a row, in words.
fn row(line: &str) -> Option<Result<Row, String>> {
    let mut parts = tokens(line);
    let Token::Word(first) = parts.next()? else { return None };
    let side = Side::ALL.into_iter().find(|side| first.eq_ignore_ascii_case(side.name()))?;
    let id = parts.next()?.whole()?;
    Some(numbers(parts).map(|(time, force, moment)| Row { key: (id, side), time, force, moment }))
}

/// Instant, force and moment in the rest of a row.
fn numbers<'a>(
    mut parts: impl Iterator<Item = Token<'a>>,
) -> Result<(f64, [f64; 3], Option<f64>), String> {
    let mut time = None;
    let mut found: [Option<f64>; 4] = [None; 4];
    while let Some(part) = parts.next() {
        let Token::Word(name) = part else {
            return Err("has a number without a keyword".to_owned());
        };
        let mut value = parts.next();
        // The area of a tied contact has a keyword of two words, `tied area`.
        if name.eq_ignore_ascii_case("tied") && matches!(value, Some(Token::Word(_))) {
            value = parts.next();
        }
        let value = value.and_then(Token::number).filter(|value| value.is_finite());
        let value =
            value.ok_or_else(|| format!("{name:.20} is not followed by a finite number"))?;
        let place = NAMES.iter().position(|of| name.eq_ignore_ascii_case(of));
        match place.and_then(|place| found.get_mut(place)) {
            Some(found) => *found = Some(value),
            None if name.eq_ignore_ascii_case("time") => time = Some(value),
            None => {}
        }
    }
    let [Some(x), Some(y), Some(z), moment] = found else {
        return Err("lacks x, y or z".to_owned());
    };
    let time = time.ok_or("lacks the time")?;
    Ok((time, [x, y, z], moment))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_are_read_with_their_titles() {
        let text = "\
 a run
{BEGIN LEGEND}
 Entity #        Title
        7     bumper to door
{END LEGEND}
  master          7 time 0.00000E+00  x  0.00000E+00  y  0.00000E+00  z  0.00000E+00 mass  0.00000E+00
  slave           7 time 0.00000E+00  x  0.00000E+00  y  0.00000E+00  z  0.00000E+00 mass  0.00000E+00
  master          7 time 1.00000E-03  x -1.20000E+05  y  3.00000E+02  z  0.00000E+00 mass  0.00000E+00
  slave           7 time 1.00000E-03  x+1.20000E+05  y -3.00000E+02  z  0.00000E+00 mass  0.00000E+00
  master          7 time 2.00000E-03  x -1.0";
        let results = read(text).unwrap();
        assert_eq!(
            results.labels(),
            ["contact 7 slave: bumper to door", "contact 7 master: bumper to door",]
        );
        let [slave, master] = results.histories.as_slice() else { panic!("two sides") };
        assert_eq!(slave.values("fx"), [0.0, 1.2e5]);
        assert_eq!(master.values("fy"), [0.0, 300.0]);
        assert_eq!((slave.other_side, master.other_side), (Some(1), Some(0)));
        assert!(slave.values(MOMENT.0).is_empty());
        assert_eq!(*slave.time, [0.0, 1e-3]);
    }

    #[test]
    fn tied_contacts_are_read_and_single_surfaces_named() {
        let state = |time: &str, force: &str| {
            format!(
                "  slave           7 time {time}  x {force}  y  0.00000E+00  z  0.00000E+00 mass  0.00000E+00  mx  \
                 0.00000E+00  my  0.00000E+00  mz  5.00000E+00  tied         12  tied area  3.45500E+02\n \
                 interface number,         9,is single surface-resultants are undefined\n"
            )
        };
        let text = state("0.00000E+00", " 0.00000E+00") + &state("1.00000E-03", "-1.20000E+05");
        let results = read(&text).unwrap();
        let [slave] = results.histories.as_slice() else { panic!("one side") };
        assert_eq!(slave.values("fx"), [0.0, -1.2e5]);
        assert_eq!(slave.values(MOMENT.0), [5.0, 5.0]);
        let [said] = results.doubts.as_slice() else { panic!("{:?}", results.doubts) };
        assert!(said.contains("not in the file: 9; a force transducer"), "{said}");
        let bad = text.replacen("tied area  3.45500E+02", "tied area  nan", 1);
        assert_eq!(
            read(&bad).unwrap_err(),
            (1, "tied is not followed by a finite number".to_owned())
        );
    }

    #[test]
    fn a_bad_row_is_named_by_its_line() {
        let row = "slave 7 time 0.0 x 1.0 y 2.0 z 3.0\n";
        let (line, why) = read(&format!("{row}slave 7 time 1.0 x nan y 2.0 z 3.0\n")).unwrap_err();
        assert_eq!((line, why.as_str()), (2, "x is not followed by a finite number"));
        let (line, _) = read(&format!("{row}master 7 time 1.0 x 1 y 2.0 z 3.0\n")).unwrap_err();
        assert_eq!(line, 2);
    }
}
