//! `secforc` of LS-DYNA: the force and the moment that a cross section transmits.
//!
//! ```text
//!  line#1  section#     time         x-force     y-force     z-force    magnitude
//!  line#2  resultant  moments        x-moment    y-moment    z-moment   magnitude
//!  line#3  centroids                 x           y           z          area
//! ```
//!
//! Three lines of numbers for each section and instant. The force is in the axes of the section where it
//! has some of its own, else in those of the model.

use std::sync::Arc;

use crate::data::formats::fem::legend::Legend;
use crate::data::formats::fem::results::{FORCE, History, Kind, Results, columns};
use crate::data::formats::fem::states::States;
use crate::data::formats::fem::tokens::{Token, tokens, whole_lines};

/// Numbers of the first line of a section after its number: time, force and magnitude. The other two
/// lines have at least the three components.
const FIRST: usize = 5;
const OTHERS: usize = 3;

/// Lines of a section after the first.
const MORE_LINES: usize = 2;

/// Whether a line is the heading of such a file.
pub(super) fn is_title(line: &str) -> bool {
    let closed: String = line.chars().filter(|c| !c.is_whitespace()).collect();
    closed.to_ascii_lowercase().starts_with("line#1section#time")
}

/// Reads a file. The error is a line with what is wrong with it.
pub(super) fn read(text: &str) -> Result<Results, (u64, String)> {
    let mut states = States::<i64, 3>::default();
    let (mut legend, mut n_expected, mut has_heading) = (Legend::default(), 0_usize, false);
    let (lines, cut) = whole_lines(text);
    for (number, line) in lines {
        let wrong = |why: String| (number, why);
        has_heading |= is_title(line);
        let is_heading = line.trim_start().to_ascii_lowercase().starts_with("line#");
        if legend.takes(line) || is_heading || !has_heading {
            continue;
        }
        let parts: Vec<Token<'_>> =
            tokens(line).filter(|part| matches!(part, Token::Number(..))).collect();
        if parts.is_empty() {
            continue;
        }
        if n_expected > 0 {
            if parts.len() < OTHERS {
                return Err(wrong(format!("has {} numbers, expected {OTHERS}", parts.len())));
            }
            n_expected -= 1;
            continue;
        }
        let id = parts.first().and_then(|part| part.whole());
        let numbers: Vec<f64> = parts.iter().skip(1).filter_map(|part| part.number()).collect();
        let (Some(id), [time, x, y, z, _]) = (id, numbers.as_slice()) else {
            let n = numbers.len();
            let why = format!("has {n} numbers, expected a section with {FIRST} numbers");
            return Err(wrong(why));
        };
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(wrong(format!("section {id}: not all of its numbers are finite")));
        }
        let added = states.begin(*time).and_then(|()| states.push(id, [*x, *y, *z]));
        added.map_err(|why| wrong(format!("section {id}: {why}")))?;
        n_expected = MORE_LINES;
    }
    states.end();
    let time = Arc::new(states.time.clone());
    let history = |(id, rows): (&i64, &Vec<[f64; 3]>)| {
        let values = (0..FORCE.len()).map(|at| States::<i64, 3>::column(rows, at));
        let name = (format!("section {id}"), legend.title(*id));
        History::new(Kind::Section, name, &time, columns(&FORCE, values))
    };
    let histories = states.rows.iter().map(history).collect();
    let doubts = states.doubts().into_iter().chain(cut).collect();
    let notes =
        vec!["the force of a section is in the axes of the section, where it has some".into()];
    Ok(Results {
        format: "an LS-DYNA secforc file",
        histories,
        notes,
        doubts,
        ..Results::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_lines_make_a_section() {
        let heading = " line#1  section#     time         x-force     y-force     z-force    magnitude\n \
            line#2  resultant  moments        x-moment    y-moment    z-moment   magnitude\n \
            line#3  centroids                 x           y           z          area\n\n";
        let state = |time: &str, x: &str| {
            format!(
                "           2  {time}  {x}  2.0E+00  3.0E+00  4.0E+00\n\
                 \x20   resultant  moments  1.0E+00 1.0E+00 1.0E+00 1.0E+00\n\
                 \x20   centroids  0.0E+00 0.0E+00 0.0E+00 5.0E+00\n\n"
            )
        };
        let text =
            heading.to_owned() + &state("0.0000E+00", "1.0") + &state("1.0000E-03", "-9.0E+01");
        let results = read(&text).unwrap();
        let [section] = results.histories.as_slice() else { panic!("one section") };
        assert_eq!(section.values("fx"), [1.0, -90.0]);
        assert_eq!(section.values("fz"), [3.0, 3.0]);
        assert_eq!(*section.time, [0.0, 1e-3]);
        let (line, _) = read(&(heading.to_owned() + "  2 0.0 1.0\n")).unwrap_err();
        assert_eq!(line, 5);
    }
}
