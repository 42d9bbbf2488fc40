//! Which history of a file is read: the one that is asked for, or else the contact of the largest
//! impulse.
//!
//! ```text
//! sheet=contact 3 master                 the force on one side of a contact
//! sheet=contact 3 master + contact 5 master   the sum of several
//! sheet=node 101                         the path of a node
//! sheet=node 101 to node 102             with the yaw angle: the line from the first to the second
//! ```

use std::path::Path;

use crate::data::formats::fem::deck::{DeckUnits, Dimension, shown};
use crate::data::formats::fem::results::{History, Kind, MOMENT, Results};
use crate::data::formats::fem::start::ModelStart;
use crate::data::{DataError, Sheet, SheetRef};
use crate::numerics::counted_turns_rad;

/// Largest change of the distance of two nodes that are taken for an axis of the car, and largest
/// disagreement of both sides of a contact, as shares.
const RIGID: f64 = 0.02;
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
    Node(&'a History),
    Axis([&'a History; 2]),
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
                number.checked_sub(1).and_then(|at| results.histories.get(at)).map(single)
            }
            Some(SheetRef::Name(name)) => named(results, name),
        };
        let Some(what) = found else {
            let text = || "a force or the motion of a node".to_owned();
            let wanted = wanted.map_or_else(text, SheetRef::to_string);
            let found = results.labels();
            return Err(DataError::NoSheet { path: path.to_owned(), wanted, found });
        };
        Ok(Self { what, is_said: wanted.is_some() })
    }

    fn parts(&self) -> &[&'a History] {
        match &self.what {
            What::Forces(parts) => parts,
            What::Node(node) => std::slice::from_ref(node),
            What::Axis(nodes) => nodes,
        }
    }

    fn name(&self) -> String {
        let between = if matches!(self.what, What::Axis(_)) { " to " } else { " + " };
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
        let all = results.labels().into_iter().take(MAX_LISTED).collect();
        Sheet { name: self.name(), all }
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
            What::Node(_) | What::Axis(_) => {
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
        if let What::Axis(nodes) = &self.what {
            doubts.extend(bent(nodes));
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
            What::Node(node) => Some(format!(
                "{} is read, the first of {}, without a yaw angle; name two nodes on the axis of the car, \
                 the rear one first, e.g. map sheet=node 101 to node 102",
                node.name,
                results.histories.len()
            )),
            What::Axis(_) => None,
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
            What::Node(node) => path_of(node),
            What::Axis(nodes) => motion_of(nodes),
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

fn single(history: &History) -> What<'_> {
    match history.kind {
        Kind::Node => What::Node(history),
        _ => What::Forces(vec![history]),
    }
}

/// The contact of the largest impulse, or else another force, or else the first node.
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
    if let Some((rear, front)) = text.split_once(" to ") {
        let nodes = [find(rear)?, find(front)?];
        let are_nodes = nodes.iter().all(|node| node.kind == Kind::Node);
        return (are_nodes && nodes[0].name != nodes[1].name).then_some(What::Axis(nodes));
    }
    let parts: Vec<&History> = text.split('+').map(find).collect::<Option<_>>()?;
    let first = parts.first()?;
    let are_forces = parts.iter().all(|part| part.kind != Kind::Node && part.time == first.time);
    are_forces.then_some(What::Forces(parts))
}

/// A column of the table.
type Shown = (&'static str, Dimension, Vec<f64>);

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

/// The path of a node.
fn path_of(node: &History) -> Vec<Shown> {
    let of = |name| node.values(name).to_vec();
    let speeds = node.values("vx").iter().zip(node.values("vy"));
    let speeds = speeds.map(|(x, y)| x.hypot(*y)).collect();
    vec![
        ("x", Dimension::Length, of("x")),
        ("y", Dimension::Length, of("y")),
        ("speed", Dimension::Velocity, speeds),
    ]
}

/// The motion of the first node, with the heading and the yaw rate of the line to the second.
///
/// ```text
/// ψ = atan2(d_y, d_x),  r = (d_x ḋ_y − d_y ḋ_x) / |d|²,  d from the first node to the second
/// ```
fn motion_of([rear, front]: &[&History; 2]) -> Vec<Shown> {
    let apart = |name: &str| -> Vec<f64> {
        front.values(name).iter().zip(rear.values(name)).map(|(a, b)| a - b).collect()
    };
    let [dx, dy, ux, uy] = ["x", "y", "vx", "vy"].map(apart);
    let headings: Vec<f64> = dx.iter().zip(&dy).map(|(x, y)| y.atan2(*x)).collect();
    let rates = dx.iter().zip(&dy).zip(ux.iter().zip(&uy));
    let rates = rates.map(|((x, y), (u, v))| (x * v - y * u) / (x * x + y * y)).collect();
    let velocities = rear.values("vx").iter().zip(rear.values("vy")).zip(&headings);
    let (along, across) = velocities
        .map(|((x, y), heading)| {
            let (sin, cos) = heading.sin_cos();
            (cos * x + sin * y, cos * y - sin * x)
        })
        .unzip();
    vec![
        ("x", Dimension::Length, rear.values("x").to_vec()),
        ("y", Dimension::Length, rear.values("y").to_vec()),
        ("yaw", Dimension::Angle, counted_turns_rad(headings)),
        ("vx", Dimension::Velocity, along),
        ("vy", Dimension::Velocity, across),
        ("yaw_rate", Dimension::AngularVelocity, rates),
    ]
}

/// What is said of two nodes whose distance changes.
fn bent([rear, front]: &[&History; 2]) -> Option<String> {
    let apart = |name: &str| front.values(name).iter().zip(rear.values(name)).map(|(a, b)| a - b);
    let distances: Vec<f64> = apart("x").zip(apart("y")).map(|(x, y)| x.hypot(y)).collect();
    let first = *distances.first()?;
    let change = distances.iter().map(|distance| (distance - first).abs()).fold(0.0, f64::max);
    (change > RIGID * first).then(|| {
        format!(
            "the distance of {} and {} in the plane changes by {} %: they are no rigid axis of the car, so \
             its yaw angle may be wrong",
            rear.name,
            front.name,
            shown(100.0 * change / first)
        )
    })
}
