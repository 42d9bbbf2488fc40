//! `matsum` of LS-DYNA beside an `rcforc`: the momentum of each part.
//!
//! ```text
//! {BEGIN LEGEND} … {END LEGEND}
//!
//!  time =%13.4E
//!  mat.#=%5d             inten=%13.4E     kinen=%13.4E     eroded_ie=%13.4E     eroded_ke=%13.4E
//!  x-mom=%13.4E     y-mom=%13.4E     z-mom=%13.4E
//!  x-rbv=%13.4E     y-rbv=%13.4E     z-rbv=%13.4E
//!                          hgeng=%13.4E     +mass=%13.4E     eroded_he=%13.4E
//! ```
//!
//! Lines begin with their keyword and are known by it, so that others and their numbers may be there or not.
//! Part 0 is the kinetic energy of lumped masses, which has no momentum; it is left out.
//!
//! Source: `l2a` of LSTC, which writes this text from a `binout`.

use std::path::{Path, PathBuf};

use crate::data::DataError;
use crate::data::budget::MAX_TABLE_BYTES;
use crate::data::formats::fem::momenta::{Momenta, PartMomentum};
use crate::data::formats::fem::results::Results;
use crate::data::formats::fem::states::States;
use crate::data::formats::fem::tokens::{Token, damaged_line, tokens, whole_lines};
use crate::data::text::read_text;

/// How the file with the forces is called, and the one with the momenta of the same run.
const FORCES: &str = "rcforc";
const MOMENTA: &str = "matsum";

/// Momentum along x and y, and velocity likewise.
type PartStates = States<i64, 4>;

/// Whether a line belongs to such a file.
pub(super) fn is_part(line: &str) -> bool {
    line.trim_start().starts_with("mat.#=")
}

/// The `matsum` that is beside an `rcforc`, if there is one: `matsum` beside `rcforc`, `a.matsum` beside
/// `a.rcforc`.
///
/// - `path`: that of an `rcforc`.
pub(super) fn beside(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let at = name.to_ascii_lowercase().rfind(FORCES)?;
    let (before, rest) = name.split_at_checked(at)?;
    let (word, after) = rest.split_at_checked(FORCES.len())?;
    let is_upper = word.chars().all(|letter| letter.is_ascii_uppercase());
    let momenta = if is_upper { MOMENTA.to_ascii_uppercase() } else { MOMENTA.to_owned() };
    Some(path.with_file_name(format!("{before}{momenta}{after}"))).filter(|path| path.is_file())
}

/// Adds the momenta in the `matsum` beside an `rcforc`, or why they are not used.
///
/// - `text`: that of the `rcforc`.
pub(super) fn add_beside(path: &Path, text: &str, results: &mut Results) {
    let Some(beside) = beside(path) else { return };
    let name = beside.file_name().unwrap_or_default().to_string_lossy().into_owned();
    match momenta(&beside, title(text)) {
        Ok((momenta, doubts)) => {
            results.momenta = Some(momenta);
            results.notes.push(format!("momenta of the parts: {name} beside it"));
            results.doubts.extend(doubts.into_iter().map(|doubt| format!("{name}: {doubt}")));
        }
        Err(why) => results.doubts.push(format!("the momenta of the parts are not used: {why}")),
    }
}

/// The momenta in a file, and what a person should look at.
///
/// - `run`: the title of the run.
///
/// The error is why they are not used, in words.
fn momenta(path: &Path, run: &str) -> Result<(Momenta, Vec<String>), String> {
    let in_words = |error: DataError| crate::error_chain(&error);
    let text = read_text(path, MAX_TABLE_BYTES).map_err(in_words)?.text;
    let (states, doubts) = read(&text).map_err(|at| in_words(damaged_line(path, at)))?;
    if states.time.is_empty() || states.rows.is_empty() {
        return Err(format!("{} has no states with momenta", path.display()));
    }
    let own = title(&text);
    if own != run {
        let path = path.display();
        return Err(format!("{path} is of another run, {own:?} and not {run:?}"));
    }
    let part = |rows: &Vec<[f64; 4]>| {
        let column = |at| PartStates::column(rows, at);
        let first =
            |at: usize| rows.first().and_then(|row| row.get(at)).copied().unwrap_or(f64::NAN);
        PartMomentum { start: [first(2), first(3)], momentum: [column(0), column(1)] }
    };
    let parts = states.rows.values().map(part).collect();
    Ok((Momenta { time: states.time, parts }, doubts))
}

/// The title of the run, which stands in the first line.
fn title(text: &str) -> &str {
    text.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default()
}

/// Reads a file, and says what a person should look at. The error is a line with what is wrong with it.
fn read(text: &str) -> Result<(PartStates, Vec<String>), (u64, String)> {
    let mut states = PartStates::default();
    let mut part = None::<Part>;
    let (lines, cut) = whole_lines(text);
    for (number, line) in lines {
        let wrong = |why: String| (number, why);
        let line = line.trim_start();
        if is_time(line) {
            finish(part.take(), &mut states)?;
            let time = named(line, "time =").ok_or_else(|| wrong("has no time".to_owned()))?;
            states.begin(time).map_err(wrong)?;
        } else if is_part(line) && !states.time.is_empty() {
            finish(part.take(), &mut states)?;
            let id = line.get("mat.#=".len()..).and_then(|rest| tokens(rest).next()?.whole());
            let id = id.ok_or_else(|| wrong("has no number of a part".to_owned()))?;
            part = Some(Part { line: number, id, momentum: None, velocity: None });
        } else if let Some(part) = &mut part {
            for (keys, vector) in [
                (["x-mom=", "y-mom="], &mut part.momentum),
                (["x-rbv=", "y-rbv="], &mut part.velocity),
            ] {
                if line.starts_with(keys[0]) {
                    let [x, y] = keys.map(|key| named(line, key));
                    let both = x.zip(y).ok_or_else(|| {
                        wrong(format!(
                            "{} and {} are not followed by finite numbers",
                            keys[0], keys[1]
                        ))
                    })?;
                    *vector = Some(both);
                }
            }
        }
    }
    // A part that is not complete is that of a run that was ended.
    if let Some(part) = part.filter(|part| part.row().is_some()) {
        finish(Some(part), &mut states)?;
    }
    states.end();
    let doubts = states.doubts().into_iter().chain(cut).collect();
    Ok((states, doubts))
}

/// Whether a line begins a state.
fn is_time(line: &str) -> bool {
    line.starts_with("time =")
}

/// The finite number after a keyword.
fn named(line: &str, key: &str) -> Option<f64> {
    let (_, after) = line.split_once(key)?;
    tokens(after).next().and_then(Token::number).filter(|number| number.is_finite())
}

/// A part of which lines are read.
struct Part {
    /// The line in which it begins.
    line: u64,
    id: i64,
    momentum: Option<(f64, f64)>,
    velocity: Option<(f64, f64)>,
}

impl Part {
    /// Momentum and velocity; `None` if a line is missing.
    fn row(&self) -> Option<[f64; 4]> {
        let ((px, py), (vx, vy)) = self.momentum.zip(self.velocity)?;
        Some([px, py, vx, vy])
    }
}

/// Adds a part to its state.
///
/// The error is the line of the part with what is wrong with it.
fn finish(part: Option<Part>, states: &mut PartStates) -> Result<(), (u64, String)> {
    let Some(part) = part else { return Ok(()) };
    let Some(row) = part.row() else {
        // The energy of lumped masses.
        if part.id == 0 {
            return Ok(());
        }
        return Err((part.line, format!("part {}: lacks its momentum or its velocity", part.id)));
    };
    states.push(part.id, row).map_err(|why| (part.line, format!("part {}: {why}", part.id)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(time: &str, momenta: [f64; 2]) -> String {
        let part = |id: i32, x: f64| {
            format!(
                " mat.#={id:5}             inten=   0.0000E+00     kinen=   1.0000E+00     eroded_ie=   0.0000E+00\n \
                 x-mom={x:13.4E}     y-mom=  -2.0000E+00     z-mom=   0.0000E+00\n \
                 x-rbv={:13.4E}     y-rbv=   1.0000E+00     z-rbv=   0.0000E+00\n                         \
                 hgeng=   0.0000E+00     +mass=   0.0000E+00\n\n\n",
                x / 1000.0
            )
        };
        let lumped = " mat.#=    0             inten=   0.0000E+00     kinen=   3.0000E+00\n";
        format!(
            "\n\n time =   {time}\n{lumped}{}{}",
            part(7, momenta[0]),
            part(12_345_678, momenta[1])
        )
    }

    #[test]
    fn the_momenta_of_parts_are_read_and_lumped_masses_are_not() {
        let text = "a run\n".to_owned()
            + &state("0.0000E+00", [0.0, 9000.0])
            + &state("1.0000E-03", [100.0, 8900.0]);
        let (states, doubts) = read(&text).unwrap();
        assert_eq!(states.time, [0.0, 1e-3]);
        assert_eq!(states.rows.keys().copied().collect::<Vec<_>>(), [7, 12_345_678]);
        assert_eq!(states.rows[&12_345_678], [[9000.0, -2.0, 9.0, 1.0], [8900.0, -2.0, 8.9, 1.0]]);
        assert!(doubts.is_empty(), "{doubts:?}");
        let (line, why) = read(&text.replacen(" x-rbv=", " q-rbv=", 1)).unwrap_err();
        assert_eq!((line, why.as_str()), (6, "part 7: lacks its momentum or its velocity"));
        let (line, _) = read(&text.replacen("y-mom=  -2.0000E+00", "y-mom=  NaN", 1)).unwrap_err();
        assert_eq!(line, 7);
        let cut = &text[..text.len() - 100];
        let (states, doubts) = read(cut).unwrap();
        assert_eq!(states.time, [0.0]);
        assert!(doubts[0].contains("the last state is not complete"), "{doubts:?}");
    }

    #[test]
    fn the_momenta_of_the_same_run_are_beside_its_forces() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["matsum", "a.matsum", "MATSUM"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let name = |of: &str| {
            let found = beside(&folder.path().join(of))?;
            Some(found.file_name()?.to_str()?.to_owned())
        };
        assert_eq!(name("rcforc").as_deref(), Some("matsum"));
        assert_eq!(name("RCFORC").as_deref(), Some("MATSUM"));
        assert_eq!(name("a.rcforc").as_deref(), Some("a.matsum"));
        assert_eq!(name("b.rcforc"), None);
        assert_eq!(name("forces.csv"), None);
    }
}
