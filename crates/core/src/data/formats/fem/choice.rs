//! Which history of a file is read: the one that is asked for, or else the contact of the largest
//! impulse.
//!
//! ```text
//! sheet=contact 3 master                 the force on one side of a contact
//! sheet=contact 3 master + contact 5 master   the sum of several
//! sheet=node 101                         the path of a node
//! sheet=node 101 to node 102             with the yaw angle: the line from the first to the second
//! sheet=body 5                           the path of a rigid body
//! sheet=body 5 along -x                  with the yaw angle of a car that begins with this heading
//! ```

use std::path::Path;

use crate::data::formats::fem::deck::{DeckUnits, Dimension, shown};
use crate::data::formats::fem::motion::{
    Along, Shown, bent, motion_of, motion_of_body, not_ahead, path_of, tilted,
};
use crate::data::formats::fem::results::{History, Kind, MOMENT, Results};
use crate::data::formats::fem::start::ModelStart;
use crate::data::{DataError, Sheet, SheetRef};

/// Largest disagreement of both sides of a contact, as a share.
const OPPOSITE: f64 = 0.02;

/// Most histories that are listed.
const MAX_LISTED: usize = 1000;

/// What is read.
pub(super) struct Chosen<'a> {
    what: What<'a>,
    /// Whether somebody has asked for it.
    is_said: bool,
}

enum What<'a> {
    Forces(Vec<&'a History>),
    /// The path of a node or a rigid body.
    Path(&'a History),
    Axis([&'a History; 2]),
    /// The motion of a rigid body that begins with a heading.
    Body(&'a History, Along),
}

impl<'a> Chosen<'a> {
    /// Finds what is read.
    ///
    /// # Errors
    /// [`DataError::NoSheet`] if nothing of the file is what was asked for.
    pub(super) fn new(
        path: &Path,
        results: &'a Results,
        wanted: Option<&SheetRef>,
    ) -> Result<Self, DataError> {
        let found = match wanted {
            None => default(results),
            Some(SheetRef::Number(number)) => {
                number.checked_sub(1).and_then(|at| numbered(results, at))
            }
            Some(SheetRef::Name(name)) => named(results, name),
        };
        let Some(what) = found else {
            let text = || "a force or a motion".to_owned();
            let wanted = wanted.map_or_else(text, SheetRef::to_string);
            let found = listed(results);
            return Err(DataError::NoSheet { path: path.to_owned(), wanted, found });
        };
        Ok(Self { what, is_said: wanted.is_some() })
    }

    fn parts(&self) -> &[&'a History] {
        match &self.what {
            What::Forces(parts) => parts,
            What::Path(of) | What::Body(of, _) => std::slice::from_ref(of),
            What::Axis(nodes) => nodes,
        }
    }

    fn name(&self) -> String {
        let between = if matches!(self.what, What::Axis(_)) { " to " } else { " + " };
        if let What::Body(body, along) = self.what {
            return named_along(body, along);
        }
        match self.parts() {
            [only] => only.label(),
            parts => {
                let names: Vec<&str> = parts.iter().map(|part| part.name.as_str()).collect();
                names.join(between)
            }
        }
    }

    /// The part of the file that is read, and all that there are.
    pub(super) fn sheet(&self, results: &Results) -> Sheet {
        Sheet { name: self.name(), all: listed(results) }
    }

    /// What is read and how, in words.
    pub(super) fn description(&self, results: &Results, deck: Option<DeckUnits>) -> String {
        let mut text = format!("{}, read: {}", results.format, self.name());
        if let Some(deck) = deck {
            text += &format!("; units of the model: {}", deck.name());
        }
        if let Some((share, false)) = self.disagreement(results) {
            let percent = shown(100.0 * share);
            text += &format!("; both sides of the contact agree to {percent} % of the peak");
        }
        if let Some((checked, false)) = self.momentum(results, deck) {
            text += &format!("; {checked}");
        }
        if self.parts().iter().any(|part| !part.values(MOMENT.0).is_empty()) {
            text += "; the moment is about the origin of the model and is not taken for the yaw \
                     moment about the centre of gravity of a car";
        }
        match &self.what {
            What::Forces(parts) if parts.iter().any(|part| part.kind == Kind::Spring) => {
                text += "; the force of a spring is in the axes of the spring";
            }
            What::Forces(_) => {
                text +=
                    "; x and y are the axes of the model, taken as the plane of the road with z up";
            }
            What::Path(of) if of.kind == Kind::RigidBody => text += OF_BODY,
            What::Body(..) => text += OF_BODY,
            What::Path(_) | What::Axis(_) => {
                text += "; the first node stands for the centre of gravity";
            }
        }
        if let Some(open) = self.open_sign().filter(|_| self.is_said) {
            text += &format!("; {open}");
        }
        results.notes.iter().fold(text, |text, note| format!("{text}; {note}"))
    }

    /// What a person should look at.
    pub(super) fn doubts(&self, results: &Results, deck: Option<DeckUnits>) -> Vec<String> {
        let mut doubts = results.doubts.clone();
        doubts.extend(deck.and_then(|deck| other_units(results, deck)));
        if !self.is_said {
            doubts.extend(self.open_choice(results));
            doubts.extend(self.open_sign());
        }
        if let Some((share, true)) = self.disagreement(results) {
            doubts.push(format!(
                "both sides of the contact differ by {} % of the peak, though one is the reaction of \
                 the other",
                shown(100.0 * share)
            ));
        }
        if let Some((checked, true)) = self.momentum(results, deck) {
            doubts.push(checked);
        }
        match &self.what {
            What::Axis(nodes) => doubts.extend(bent(nodes)),
            What::Body(body, along) => {
                doubts.extend(tilted(body));
                doubts.extend(not_ahead(body, *along));
            }
            What::Forces(_) | What::Path(_) => {}
        }
        doubts.extend(self.off_plane());
        doubts
    }

    /// What the default leaves open.
    fn open_choice(&self, results: &Results) -> Option<String> {
        match &self.what {
            What::Forces(parts) => {
                let part = parts.first()?;
                let n = results.histories.iter().filter(|of| of.kind == part.kind).count();
                if n == 1 {
                    return None;
                }
                let other = part.other_side.and_then(|at| results.histories.get(at));
                let side = match other {
                    Some(other) => format!(
                        "; which side is the struck car is not in the file: map sheet={} is the force on \
                         the other side",
                        other.name
                    ),
                    None => String::new(),
                };
                Some(format!(
                    "{} is read, which has the largest impulse of {n}; map sheet={} says so{side}",
                    part.name, part.name
                ))
            }
            What::Path(of) => {
                let remedy = match of.kind {
                    Kind::RigidBody => format!(
                        "which way the car heads at the start is not in the file; say it, e.g. map sheet={}",
                        named_along(of, Along::X)
                    ),
                    _ => axis_remedy(of, results),
                };
                let n = results.histories.len();
                Some(format!(
                    "{} is read, the first of {n}, without a yaw angle; {remedy}",
                    of.name
                ))
            }
            What::Axis(_) | What::Body(..) => None,
        }
    }

    /// That a force acts on one of two sides, and the file says neither on which nor what acts on the other.
    fn open_sign(&self) -> Option<String> {
        let What::Forces(parts) = &self.what else { return None };
        let part = parts.iter().find(|part| part.other_side.is_none())?;
        Some(format!(
            "on which of its two sides {} acts is not in the file; for the other one its columns take a minus in the \
             map, fx=-2,fy=-3",
            part.name
        ))
    }

    /// That most of an impulse is along z, where it should be in the plane of the road.
    fn off_plane(&self) -> Option<String> {
        let What::Forces(parts) = &self.what else { return None };
        let columns = sum(parts);
        let time = parts.first()?.time.as_slice();
        let impulse = |name: &str| {
            let values = &columns.iter().find(|(of, ..)| *of == name)?.2;
            let steps = time.windows(2).zip(values.windows(2));
            let area = |(t, f): (&[f64], &[f64])| match (t, f) {
                ([t0, t1], [f0, f1]) => (t1 - t0) * (f0 + f1) / 2.0,
                _ => 0.0,
            };
            Some(steps.map(area).sum::<f64>())
        };
        let (x, y, z) = (impulse("fx")?, impulse("fy")?, impulse("fz")?);
        (z.abs() > x.hypot(y)).then(|| {
            "most of the impulse is along z: x and y may not be the plane of the road in this model".to_owned()
        })
    }

    /// By how much both sides of a contact differ, as a share of the peak, and whether that is too much.
    fn disagreement(&self, results: &Results) -> Option<(f64, bool)> {
        let What::Forces(parts) = &self.what else { return None };
        let share = |part: &&History| {
            let other = results.histories.get(part.other_side?)?;
            if other.is_reversed != part.is_reversed {
                return None;
            }
            let (one, two) = (part.force()?, other.force()?);
            let (peak, _) = one.peak()?;
            let sums = one.fx_n.iter().zip(&two.fx_n).zip(one.fy_n.iter().zip(&two.fy_n));
            let apart = sums.map(|((a, b), (c, d))| (a + b).hypot(c + d)).fold(0.0, f64::max);
            (peak > 0.0).then_some(apart / peak)
        };
        let share = parts.iter().filter_map(share).reduce(f64::max)?;
        Some((share, share > OPPOSITE))
    }

    /// What the momenta of the parts say of the impulse, and whether they contradict it.
    fn momentum(&self, results: &Results, deck: Option<DeckUnits>) -> Option<(String, bool)> {
        let What::Forces(parts) = &self.what else { return None };
        let momenta = results.momenta.as_ref()?;
        match parts.as_slice() {
            [only] if only.kind == Kind::Contact => momenta.check(&only.force()?, deck),
            _ => None,
        }
    }

    /// The velocities with which the cars of the model begin, if a force is read and its units are known.
    pub(super) fn start(&self, results: &Results, deck: Option<DeckUnits>) -> Option<ModelStart> {
        let What::Forces(parts) = &self.what else { return None };
        ModelStart::new(results, parts, deck?)
    }

    /// The text of the table, in SI units if those of the model are known.
    pub(super) fn table(&self, deck: Option<DeckUnits>) -> String {
        let columns = match &self.what {
            What::Forces(parts) => sum(parts),
            What::Path(of) => path_of(of),
            What::Axis(nodes) => motion_of(nodes),
            What::Body(body, along) => motion_of_body(body, *along),
        };
        let times = self.parts().first().map_or(&[][..], |part| part.time.as_slice());
        let per_unit = |dimension| deck.map_or(1.0, |deck| deck.si_per_unit(dimension));
        let header = |name: &str, dimension: Dimension| match deck {
            None if dimension != Dimension::Angle => name.to_owned(),
            _ => format!("{name} [{}]", dimension.symbol()),
        };
        let mut text = header("time", Dimension::Time);
        for (name, dimension, _) in &columns {
            text += &format!("\t{}", header(name, *dimension));
        }
        for (row, time) in times.iter().enumerate() {
            text += &format!("\n{:e}", time * per_unit(Dimension::Time));
            for (_, dimension, values) in &columns {
                let value = values.get(row).copied().unwrap_or(f64::NAN);
                text += &format!("\t{:e}", value * per_unit(*dimension));
            }
        }
        text + "\n"
    }
}

/// That a file states other units than those that were said, and its numbers are those of a collision in them.
fn other_units(results: &Results, deck: DeckUnits) -> Option<String> {
    let stated = results.stated.filter(|stated| *stated != deck)?;
    (results.open_units().proposed == stated).then(|| {
        format!(
            "the file has the factors of {}, and its numbers are taken in {}, as was said: is that on purpose?",
            stated.name(),
            deck.name()
        )
    })
}

/// How the yaw angle of a path of a node is had.
fn axis_remedy(node: &History, results: &Results) -> String {
    let is_other = |of: &&History| of.kind == node.kind && of.name != node.name;
    match results.histories.iter().find(is_other) {
        Some(other) => format!(
            "name two nodes on the axis of the car, the rear one first, e.g. map sheet={} to {}",
            node.name, other.name
        ),
        None => {
            "it needs a second node on the axis of the car, which the file does not have".to_owned()
        }
    }
}

/// What is said of the motion of a rigid body.
const OF_BODY: &str = "; the centre of gravity of the rigid body stands for that of the car";

fn single(history: &History) -> What<'_> {
    match history.kind.is_motion() {
        true => What::Path(history),
        false => What::Forces(vec![history]),
    }
}

/// A rigid body with each heading that can be said.
fn bodies(results: &Results) -> impl Iterator<Item = (&History, Along)> {
    let bodies = results.histories.iter().filter(|history| history.kind == Kind::RigidBody);
    bodies.flat_map(|body| Along::ALL.map(|along| (body, along)))
}

fn named_along(body: &History, along: Along) -> String {
    format!("{} {}", body.name, along.name())
}

/// What a person can choose, in the order of its numbers.
fn listed(results: &Results) -> Vec<String> {
    let bodies = bodies(results).map(|(body, along)| named_along(body, along));
    results.labels().into_iter().chain(bodies).take(MAX_LISTED).collect()
}

/// What stands at a place in the list.
fn numbered(results: &Results, at: usize) -> Option<What<'_>> {
    match at.checked_sub(results.histories.len()) {
        None => results.histories.get(at).map(single),
        Some(at) => bodies(results).nth(at).map(|(body, along)| What::Body(body, along)),
    }
}

/// The contact of the largest impulse, or else another force, or else the first motion.
fn default(results: &Results) -> Option<What<'_>> {
    let of_kind = |kinds: &[Kind]| {
        let mut found: Option<(&History, f64)> = None;
        for history in results.histories.iter().filter(|of| kinds.contains(&of.kind)) {
            let impulse = history.impulse();
            // Of two sides that differ by rounding the first one is read.
            if found.is_none_or(|(_, largest)| impulse > largest * (1.0 + OPPOSITE)) {
                found = Some((history, impulse));
            }
        }
        found.map(|(history, _)| history)
    };
    let forces = [Kind::Wall, Kind::Body, Kind::Section, Kind::Spring];
    let found = of_kind(&[Kind::Contact]).or_else(|| of_kind(&forces));
    found.or_else(|| results.histories.first()).map(single)
}

/// What a text names.
fn named<'a>(results: &'a Results, text: &str) -> Option<What<'a>> {
    let find = |name: &str| {
        let name = name.trim();
        let is = |history: &&History| history.name.eq_ignore_ascii_case(name);
        let labelled = |history: &&History| history.label() == name;
        results.histories.iter().find(is).or_else(|| results.histories.iter().find(labelled))
    };
    if let Some(history) = find(text) {
        return Some(single(history));
    }
    let is_named = |(body, along): &(&History, Along)| {
        named_along(body, *along).eq_ignore_ascii_case(text.trim())
    };
    if let Some((body, along)) = bodies(results).find(is_named) {
        return Some(What::Body(body, along));
    }
    if let Some((rear, front)) = text.split_once(" to ") {
        let nodes = [find(rear)?, find(front)?];
        let are_nodes = nodes.iter().all(|node| node.kind.is_motion());
        return (are_nodes && nodes[0].name != nodes[1].name).then_some(What::Axis(nodes));
    }
    let parts: Vec<&History> = text.split('+').map(find).collect::<Option<_>>()?;
    let first = parts.first()?;
    let are_forces = parts.iter().all(|part| !part.kind.is_motion() && part.time == first.time);
    are_forces.then_some(What::Forces(parts))
}

/// The sum of forces at the same instants. A column that one of them lacks is left out.
fn sum(parts: &[&History]) -> Vec<Shown> {
    let Some((&first, others)) = parts.split_first() else { return Vec::new() };
    let sign = |part: &History| if part.is_reversed { -1.0 } else { 1.0 };
    let mut columns: Vec<Shown> = Vec::new();
    for column in first.columns.iter() {
        let mut values: Vec<f64> =
            column.values.iter().map(|value| sign(first) * value + 0.0).collect();
        if others.iter().any(|part| part.values(column.name).len() != values.len()) {
            continue;
        }
        for &part in others {
            let added = part.values(column.name);
            values.iter_mut().zip(added).for_each(|(sum, value)| *sum += sign(part) * value);
        }
        columns.push((column.name, column.dimension, values));
    }
    columns
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::data::formats::fem::results::{FORCE, columns};

    /// A map of another model took 300 kN over 100 ms as 300 N over 100 s.
    #[test]
    fn units_that_contradict_the_file_are_told() {
        let time = Arc::new(vec![0.0, 50.0, 100.0]);
        let force = [vec![0.0, 300.0, 0.0], vec![0.0; 3], vec![0.0; 3]];
        let name = ("spring 8".to_owned(), String::new());
        let history = History::new(Kind::Spring, name, &time, columns(&FORCE, force));
        let stated = Some(DeckUnits::KgMmMs);
        let results = Results { histories: vec![history], stated, ..Results::default() };
        let chosen = Chosen::new(Path::new("runT01"), &results, None).unwrap();
        let doubts = |deck| chosen.doubts(&results, deck).join("; ");
        let other = doubts(Some(DeckUnits::TMmS));
        assert!(
            other.contains("factors of kg-mm-ms, and its numbers are taken in t-mm-s"),
            "{other}"
        );
        for deck in [None, stated] {
            assert!(!doubts(deck).contains("factors"), "{deck:?}");
        }
    }
}
