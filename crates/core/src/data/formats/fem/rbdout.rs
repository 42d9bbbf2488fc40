//! `rbdout` of LS-DYNA: the motion of rigid bodies, as text and in a `binout`.
//!
//! ```text
//!   r i g i d   b o d y   m o t i o n   a t  cycle=%8d    time=%15.6E
//!
//!  rigid body%8d                           or  nodal rigid body%8d
//!    global             x           y           z          x-rot       y-rot       z-rot
//!    coordinates:  %12.4E three times
//!  displacements:  %12.4E six times
//!     velocities:  %12.4E six times
//!  accelerations:  %12.4E six times
//!
//! principal or user defined local coordinate direction vectors
//!                      a           b           c
//!      row 1%15.4E three times, and so rows 2 and 3
//!
//!  output in principal or user defined local coordinate directions
//!  … the same in these directions, which is not read
//! ```
//!
//! Coordinates are those of the centre of gravity; the last three numbers of a line are a rotation about x, y
//! and z of the model, in rad. In a `binout` the numbers have names of their own ([`ARRAYS`]).
//!
//! The yaw angle is the rotation about z since the first state. Which way the car headed there is not in the
//! file and has to be said. The direction vectors tell how far the body has turned about any axis:
//!
//! ```text
//! θ = arccos((Σ d_ij(t) d_ij(0) − 1) / 2)
//! ```
//!
//! Source: `l2a` of LSTC, which writes these texts from a `binout`.

use std::sync::Arc;

use crate::data::formats::fem::results::{BODY, History, Kind, Results, columns};
use crate::data::formats::fem::states::States;
use crate::data::formats::fem::tokens::{Token, tokens, whole_lines};

/// Numbers of a body at an instant that are read: those of [`BODY`] but the last, and the direction vectors.
pub(super) const N_NUMBERS: usize = 17;

/// Where the direction vectors begin among them.
const VECTORS_AT: usize = 8;

/// Lines of a body that are read.
const N_LINES: usize = 7;

/// The same numbers in a `binout`.
pub(super) const ARRAYS: [&str; N_NUMBERS] = [
    "global_x",
    "global_y",
    "global_vx",
    "global_vy",
    "global_ax",
    "global_ay",
    "global_rvz",
    "global_rdz",
    "dircos_11",
    "dircos_12",
    "dircos_13",
    "dircos_21",
    "dircos_22",
    "dircos_23",
    "dircos_31",
    "dircos_32",
    "dircos_33",
];

/// A line of a body: how it begins, how many numbers follow, and which of them go where.
struct Line {
    name: &'static str,
    n_numbers: usize,
    taken: &'static [(usize, usize)],
}

static LINES: [Line; N_LINES] = [
    Line { name: "coordinates:", n_numbers: 3, taken: &[(0, 0), (1, 1)] },
    Line { name: "displacements:", n_numbers: 6, taken: &[(5, 7)] },
    Line { name: "velocities:", n_numbers: 6, taken: &[(0, 2), (1, 3), (5, 6)] },
    Line { name: "accelerations:", n_numbers: 6, taken: &[(0, 4), (1, 5)] },
    Line { name: "row 1", n_numbers: 3, taken: &[(0, 8), (1, 9), (2, 10)] },
    Line { name: "row 2", n_numbers: 3, taken: &[(0, 11), (1, 12), (2, 13)] },
    Line { name: "row 3", n_numbers: 3, taken: &[(0, 14), (1, 15), (2, 16)] },
];

/// A body: whether it is made of nodes, and its number.
type Key = (bool, i64);

type BodyStates = States<Key, N_NUMBERS>;

/// Whether a line begins a state.
pub(super) fn is_title(line: &str) -> bool {
    let letters = || line.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    let is_one = |letters: String| {
        let letters = letters.to_ascii_lowercase();
        letters.starts_with("rigidbodymotionat") && letters.contains("time=")
    };
    line.trim_start().starts_with(['r', 'R']) && is_one(letters())
}

/// Reads a file. The error is a line with what is wrong with it.
pub(super) fn read(text: &str) -> Result<Results, (u64, String)> {
    let mut states = BodyStates::default();
    let (mut has_state, mut body) = (false, None::<Body>);
    let (lines, cut) = whole_lines(text);
    for (number, line) in lines {
        let wrong = |why: String| (number, why);
        if is_title(line) {
            finish(body.take(), &mut states)?;
            let time = time_of(line).ok_or_else(|| wrong("has no time".to_owned()))?;
            states.begin(time).map_err(wrong)?;
            has_state = true;
        } else if let Some(key) = key_of(line).filter(|_| has_state) {
            finish(body.take(), &mut states)?;
            body = Some(Body::new(number, key));
        } else if let Some(body) = &mut body {
            body.take(line).map_err(wrong)?;
        }
    }
    // A body that is not complete is that of a run that was ended.
    if let Some(body) = body.filter(Body::is_complete) {
        finish(Some(body), &mut states)?;
    }
    states.end();
    let time = Arc::new(states.time.clone());
    let of_body = |(key, rows): (&Key, &Vec<[f64; N_NUMBERS]>)| {
        let numbers = (0..N_NUMBERS).map(|at| BodyStates::column(rows, at)).collect();
        history(*key, &time, numbers)
    };
    let histories = states.rows.iter().map(of_body).collect();
    let doubts = states.doubts().into_iter().chain(cut).collect();
    Ok(Results { format: "an LS-DYNA rbdout file", histories, doubts, ..Results::default() })
}

/// The motion of a body.
///
/// - `numbers`: those of [`ARRAYS`] over time.
pub(super) fn history(
    (is_nodal, id): (bool, i64),
    time: &Arc<Vec<f64>>,
    mut numbers: Vec<Vec<f64>>,
) -> History {
    let vectors = numbers.split_off(VECTORS_AT.min(numbers.len()));
    numbers.push(turned_rad(&vectors, time.len()));
    let name = format!("{}body {id}", if is_nodal { "nodal " } else { "" });
    History::new(Kind::RigidBody, (name, String::new()), time, columns(&BODY, numbers))
}

/// By how far direction vectors have turned since the first instant, rad.
fn turned_rad(vectors: &[Vec<f64>], n_instants: usize) -> Vec<f64> {
    let product = |values: &Vec<f64>, at: usize| Some(values.first()? * values.get(at)?);
    let angle = |at: usize| {
        let trace: Option<f64> = vectors.iter().map(|values| product(values, at)).sum();
        trace.map_or(f64::NAN, |trace| ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos())
    };
    (0..n_instants).map(angle).collect()
}

/// A body of which lines are read.
struct Body {
    /// The line in which it begins.
    line: u64,
    key: Key,
    numbers: [f64; N_NUMBERS],
    has: [bool; N_LINES],
    /// Whether the lines in its own directions have begun.
    is_local: bool,
}

impl Body {
    fn new(line: u64, key: Key) -> Self {
        let has = [false; N_LINES];
        Self { line, key, numbers: [f64::NAN; N_NUMBERS], has, is_local: false }
    }

    fn is_complete(&self) -> bool {
        self.has.iter().all(|has| *has)
    }

    /// Takes the numbers of a line, if it is one that is read.
    ///
    /// The error is what is wrong with it, in words.
    fn take(&mut self, line: &str) -> Result<(), String> {
        let line = line.trim_start();
        self.is_local |= line.starts_with("output in");
        let rest = |of: &Line| line.strip_prefix(of.name);
        let found =
            LINES.iter().zip(&mut self.has).find_map(|(of, has)| Some((of, has, rest(of)?)));
        let Some((of, has, rest)) = found.filter(|_| !self.is_local) else { return Ok(()) };
        let name = of.name;
        if std::mem::replace(has, true) {
            return Err(format!("{name} stands here a second time for this body"));
        }
        let numbers: Option<Vec<f64>> = tokens(rest).map(Token::number).collect();
        let is_whole = |numbers: &Vec<f64>| {
            numbers.len() == of.n_numbers && numbers.iter().all(|number| number.is_finite())
        };
        let numbers = numbers.filter(is_whole).ok_or_else(|| {
            format!("{name} is not followed by {} finite numbers and nothing else", of.n_numbers)
        })?;
        for (from, to) in of.taken {
            if let (Some(number), Some(place)) = (numbers.get(*from), self.numbers.get_mut(*to)) {
                *place = *number;
            }
        }
        Ok(())
    }
}

/// Adds a body to its state.
///
/// The error is the line of the body with what is wrong with it.
fn finish(body: Option<Body>, states: &mut BodyStates) -> Result<(), (u64, String)> {
    let Some(body) = body else { return Ok(()) };
    let id = body.key.1;
    let lacking = LINES.iter().zip(body.has).find(|(_, has)| !has);
    if let Some((line, _)) = lacking {
        return Err((body.line, format!("body {id}: lacks the line {:?}", line.name)));
    }
    let added = states.push(body.key, body.numbers);
    added.map_err(|why| (body.line, format!("body {id}: {why}; is it rigid for a while only?")))
}

/// The body whose lines follow a line.
fn key_of(line: &str) -> Option<Key> {
    let lower = line.trim().to_ascii_lowercase();
    let (is_nodal, rest) = match lower.strip_prefix("nodal") {
        Some(rest) => (true, rest.trim_start()),
        None => (false, lower.as_str()),
    };
    let id = rest.strip_prefix("rigid body")?.trim();
    Some((is_nodal, id.parse().ok()?))
}

/// The time in the heading of a state.
fn time_of(line: &str) -> Option<f64> {
    let lower = line.to_ascii_lowercase();
    let (_, after) = lower.split_once("time=")?;
    let number = tokens(after).next().and_then(Token::number);
    number.filter(|time| time.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A state with a body that drives at 10 along x and has turned by an angle about z.
    fn state(id: &str, time: f64, angle: f64) -> String {
        let (sin, cos) = f64::sin_cos(angle);
        let x = 10.0 * time;
        format!(
            "1\n\n  r i g i d   b o d y   m o t i o n   a t  cycle=       1    time=   {time:.6E}\n\n \
             {id}\n   global             x           y           z          x-rot       y-rot       z-rot\n   \
             coordinates:   {x:.4E}-3.0000E+00 0.0E+00\n displacements:   {x:.4E} 0. 0. 0. 0. {angle:.4E}\n    \
             velocities:   1.0E+01 0. 0. 0. 0. 2.0E+00\n accelerations:   5. 6. 0. 0. 0. 0.\n\n\
             principal or user defined local coordinate direction vectors\n                     a  b  c\n     \
             row 1     {cos:.4E}     {:.4E}     0.0000E+00\n     row 2     {sin:.4E}     {cos:.4E} 0.\n     \
             row 3     0. 0. 1.0000E+00\n\n output in principal or user defined local coordinate directions\n \
             displacements:   9. 9. 9. 9. 9. 9.\n    velocities:   9. 9. 9. 9. 9. 9.\n \
             accelerations:   9. 9. 9. 9. 9. 9.\n",
            -sin
        )
    }

    #[test]
    fn the_lines_along_the_axes_of_the_model_are_read() {
        let text = "rigid body 3 is a sledge\n".to_owned()
            + &state("rigid body       5", 0.0, 0.0)
            + &state("rigid body       5", 0.5, 1.0);
        let results = read(&text).unwrap();
        let [body] = results.histories.as_slice() else { panic!("one body") };
        assert_eq!((body.name.as_str(), body.kind), ("body 5", Kind::RigidBody));
        assert_eq!(*body.time, [0.0, 0.5]);
        for (name, expected) in [
            ("x", [0.0, 5.0]),
            ("y", [-3.0, -3.0]),
            ("vx", [10.0, 10.0]),
            ("vy", [0.0, 0.0]),
            ("ax", [5.0, 5.0]),
            ("ay", [6.0, 6.0]),
            ("yaw_rate", [2.0, 2.0]),
            ("rotation about z", [0.0, 1.0]),
        ] {
            assert_eq!(body.values(name), expected, "{name}");
        }
        let turned = body.values("rotation");
        assert!(turned[0].abs() < 1e-6 && (turned[1] - 1.0).abs() < 1e-3, "{turned:?}");
    }

    #[test]
    fn what_is_not_understood_is_named_with_its_line() {
        let one = state("nodal rigid body12345678", 0.0, 0.0);
        let two = one.clone() + &state("nodal rigid body12345678", 0.1, 0.0);
        assert_eq!(read(&two).unwrap().histories[0].name, "nodal body 12345678");
        let error = |text: &str| read(text).unwrap_err();
        let lost = two.replacen("    velocities:   1.0E+01 0. 0. 0. 0. 2.0E+00\n", "", 1);
        let (line, why) = error(&lost);
        assert_eq!(line, 5);
        assert!(why.contains("lacks the line \"velocities:\""), "{why}");
        let (line, why) = error(&two.replacen("1.0E+01 0. 0.", "1.0E+01 nan 0.", 1));
        assert_eq!(line, 9);
        assert!(why.contains("6 finite numbers"), "{why}");
        let (_, why) = error(&two.replacen("time=   0.0", "time=   x", 1));
        assert_eq!(why, "has no time");
        let other = one.clone() + &state("rigid body 7", 0.1, 0.0);
        let (_, why) = error(&other);
        assert!(why.contains("body 7: is not in the states before"), "{why}");
        // A run that was killed within a body.
        let cut = &two[..two.len() - 400];
        let results = read(cut).unwrap();
        assert_eq!(*results.histories[0].time, [0.0]);
        assert!(
            results.doubts[0].contains("the last state is not complete"),
            "{:?}",
            results.doubts
        );
    }
}
