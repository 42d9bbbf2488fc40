//! `nodout` of LS-DYNA: the motion of nodes.
//!
//! ```text
//!  n o d a l   p r i n t   o u t   f o r   t i m e  s t e p%8d                 ( at time%14.7E )
//!
//!  nodal point  x-disp     y-disp      z-disp      x-vel  …  x-accl …  x-coor      y-coor      z-coor
//! %9d%13.4E and eleven times %12.4E
//! ```
//!
//! Where rotations were asked for, a second block of the same time follows with `x-rot` in its heading;
//! it is not read. Numbers may touch each other.

use std::sync::Arc;

use crate::data::formats::fem::legend::Legend;
use crate::data::formats::fem::results::{History, Kind, NODE, Results, columns};
use crate::data::formats::fem::states::States;
use crate::data::formats::fem::tokens::{Token, tokens, whole_lines};

/// Numbers of a row after that of the node: displacement, velocity, acceleration and coordinates.
const N_NUMBERS: usize = 12;

/// Places of x and y of coordinates and velocity among them.
const READ: [usize; 4] = [9, 10, 3, 4];

/// What the lines belong to.
#[derive(Clone, Copy, PartialEq)]
enum Block {
    /// Neither, such as the heading of a state.
    Other,
    /// Rows of displacements, velocities, accelerations and coordinates.
    Translations,
}

/// Whether a line begins a state.
pub(super) fn is_title(line: &str) -> bool {
    let letters = || line.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    line.trim_start().starts_with(['n', 'N'])
        && letters().to_ascii_lowercase().contains("nodalprintoutfortimestep")
}

/// Reads a file. The error is a line with what is wrong with it.
pub(super) fn read(text: &str) -> Result<Results, (u64, String)> {
    let mut states = States::<i64, 4>::default();
    let (mut legend, mut block, mut time) = (Legend::default(), Block::Other, None);
    let (lines, cut) = whole_lines(text);
    for (number, line) in lines {
        let wrong = |why: String| (number, why);
        if legend.takes(line) || line.trim().is_empty() {
            continue;
        }
        if line.trim_start().starts_with(char::is_alphabetic) {
            block = Block::Other;
            if is_title(line) {
                let at = time_of(line).ok_or_else(|| wrong("has no time".to_owned()))?;
                time = Some(at);
            } else if let Some(time) = time.filter(|_| is_heading(line)) {
                states.begin(time).map_err(wrong)?;
                block = Block::Translations;
            }
            continue;
        }
        if block == Block::Translations
            && let Some((id, numbers)) = row(line).map_err(wrong)?
        {
            states.push(id, numbers).map_err(|why| wrong(format!("node {id}: {why}")))?;
        }
    }
    states.end();
    let shared = Arc::new(states.time.clone());
    let history = |(id, rows): (&i64, &Vec<[f64; 4]>)| {
        let values = (0..NODE.len()).map(|at| States::<i64, 4>::column(rows, at));
        let name = (format!("node {id}"), legend.title(*id));
        History::new(Kind::Node, name, &shared, columns(&NODE, values))
    };
    let histories = states.rows.iter().map(history).collect();
    let doubts = states.doubts().into_iter().chain(cut).collect();
    Ok(Results { format: "an LS-DYNA nodout file", histories, doubts, ..Results::default() })
}

/// Whether a line stands above rows of displacements, velocities, accelerations and coordinates.
fn is_heading(line: &str) -> bool {
    let lower = line.to_ascii_lowercase();
    lower.contains("nodal point") && lower.contains("x-disp")
}

/// The time in the heading of a state.
fn time_of(line: &str) -> Option<f64> {
    let at = line.to_ascii_lowercase().find("at time")?;
    let after = line.get(at + "at time".len()..)?;
    let number = tokens(after).find_map(Token::number);
    number.filter(|time| time.is_finite())
}

/// Node and numbers of a row; `None` for a line that begins with a word.
///
/// The error is what is wrong, in words.
fn row(line: &str) -> Result<Option<(i64, [f64; 4])>, String> {
    let mut parts = tokens(line);
    let Some(first @ Token::Number(..)) = parts.next() else { return Ok(None) };
    let id = first.whole().ok_or("does not begin with the number of a node")?;
    let numbers: Option<Vec<f64>> = parts.map(Token::number).collect();
    let numbers = numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite()));
    let numbers = numbers.ok_or_else(|| format!("node {id}: not all of its numbers are finite"))?;
    if numbers.len() != N_NUMBERS {
        let n = numbers.len();
        return Err(format!("node {id}: has {n} numbers, expected {N_NUMBERS}"));
    }
    Ok(Some((id, READ.map(|at| numbers.get(at).copied().unwrap_or(f64::NAN)))))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TITLE: &str = " n o d a l   p r i n t   o u t   f o r   t i m e  s t e p       1";
    const HEADING: &str = " nodal point  x-disp     y-disp      z-disp      x-vel       y-vel";

    #[test]
    fn numbers_that_touch_are_read_and_rotations_are_not() {
        let numbers = "   1.0000E+00-2.0000E+00 0.0E+00 3.0E+00 4.0E+00-5.0000E-100 0. 0. 0.  7.0E+01-8.0E+00 1.";
        let text = format!(
            "run\n{TITLE}  ( at time 0.0000000E+00 )\n\n{HEADING}\n      101{numbers}\n\n\
             {TITLE}  ( at time 0.0000000E+00 )\n\n nodal point  x-rot\n      101 9. 9. 9.\n\n\
             {TITLE}  ( at time 1.0000000E-03 )\n\n{HEADING}\n      101{numbers}\n"
        );
        let results = read(&text).unwrap();
        let [node] = results.histories.as_slice() else { panic!("one node") };
        assert_eq!((node.name.as_str(), node.kind), ("node 101", Kind::Node));
        assert_eq!(*node.time, [0.0, 1e-3]);
        assert_eq!(node.values("x"), [70.0, 70.0]);
        assert_eq!(node.values("y"), [-8.0, -8.0]);
        assert_eq!(node.values("vy"), [4.0, 4.0]);
        let short = text.replacen(" 1.\n", "\n", 1);
        let (line, why) = read(&short).unwrap_err();
        assert_eq!((line, why.as_str()), (5, "node 101: has 11 numbers, expected 12"));
    }
}
