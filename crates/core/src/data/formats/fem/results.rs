//! What a file of results holds, in the units of its model.

use std::sync::Arc;

use crate::data::formats::fem::deck::{DeckUnits, Dimension, Magnitudes, OpenUnits};
use crate::data::formats::fem::momenta::Momenta;
use crate::data::{ForceAxes, ForceHistory, Sampling};

/// The histories of a file.
#[derive(Debug, Default)]
pub(super) struct Results {
    /// What the file is, in words.
    pub format: &'static str,
    pub histories: Vec<History>,
    /// What is said of how all of it was read.
    pub notes: Vec<String>,
    /// What a person should look at.
    pub doubts: Vec<String>,
    /// The momenta of the parts of the model.
    pub momenta: Option<Momenta>,
    /// The units that the file states.
    pub stated: Option<DeckUnits>,
}

/// What a history belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Contact,
    Wall,
    /// The force on a rigid body.
    Body,
    Section,
    Spring,
    Node,
    /// The motion of a rigid body.
    RigidBody,
}

impl Kind {
    /// Whether it is a motion and not a force.
    pub(super) fn is_motion(self) -> bool {
        matches!(self, Self::Node | Self::RigidBody)
    }
}

/// A force or a motion over time.
#[derive(Debug, Clone)]
pub(super) struct History {
    /// Its name in the text of a map, such as `contact 3 master`.
    pub name: String,
    /// Its title in the model; empty if it has none.
    pub title: String,
    pub kind: Kind,
    pub time: Arc<Vec<f64>>,
    pub columns: Arc<Vec<Column>>,
    /// Whether the numbers count with the other sign: the force on the other side.
    pub is_reversed: bool,
    /// The index of the same force on the other side.
    pub other_side: Option<usize>,
}

/// Numbers over time.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub name: &'static str,
    pub dimension: Dimension,
    pub values: Vec<f64>,
}

/// Names and dimensions of the columns of a force, of a node and of a rigid body.
pub(super) const FORCE: [(&str, Dimension); 3] =
    [("fx", Dimension::Force), ("fy", Dimension::Force), ("fz", Dimension::Force)];
pub(super) const NODE: [(&str, Dimension); 4] = [
    ("x", Dimension::Length),
    ("y", Dimension::Length),
    ("vx", Dimension::Velocity),
    ("vy", Dimension::Velocity),
];

pub(super) const BODY: [(&str, Dimension); 9] = [
    ("x", Dimension::Length),
    ("y", Dimension::Length),
    ("vx", Dimension::Velocity),
    ("vy", Dimension::Velocity),
    ("ax", Dimension::Acceleration),
    ("ay", Dimension::Acceleration),
    ("yaw_rate", Dimension::AngularVelocity),
    ROTATION_ABOUT_Z,
    ROTATION,
];

/// Rotation of a rigid body about z, and about any axis since the first instant.
pub(super) const ROTATION_ABOUT_Z: (&str, Dimension) = ("rotation about z", Dimension::Angle);
pub(super) const ROTATION: (&str, Dimension) = ("rotation", Dimension::Angle);

/// The moment that a contact or section has about a point that is not the centre of gravity of a car.
pub(super) const MOMENT: (&str, Dimension) = ("moment about the origin, z", Dimension::Moment);

/// Columns of these names.
pub(super) fn columns(
    names: &[(&'static str, Dimension)],
    values: impl IntoIterator<Item = Vec<f64>>,
) -> Arc<Vec<Column>> {
    let column = |(&(name, dimension), values): (&(&'static str, Dimension), Vec<f64>)| Column {
        name,
        dimension,
        values,
    };
    Arc::new(names.iter().zip(values).map(column).collect())
}

impl History {
    /// A history without another side.
    pub(super) fn new(
        kind: Kind,
        (name, title): (String, String),
        time: &Arc<Vec<f64>>,
        columns: Arc<Vec<Column>>,
    ) -> Self {
        let time = Arc::clone(time);
        Self { name, title, kind, time, columns, is_reversed: false, other_side: None }
    }

    /// Its name with its title.
    pub(super) fn label(&self) -> String {
        match self.title.is_empty() {
            true => self.name.clone(),
            false => format!("{}: {}", self.name, self.title),
        }
    }

    /// A column by its name; without numbers if there is none.
    pub(super) fn values(&self, name: &str) -> &[f64] {
        self.columns.iter().find(|column| column.name == name).map_or(&[], |of| &of.values)
    }

    /// The force along x and y; `None` for a motion.
    pub(super) fn force(&self) -> Option<ForceHistory> {
        let sign = if self.is_reversed { -1.0 } else { 1.0 };
        let signed =
            |name| self.values(name).iter().map(|value| sign * value).collect::<Vec<f64>>();
        (!self.kind.is_motion()).then(|| ForceHistory {
            axes: ForceAxes::World,
            sampling: Sampling::Instant,
            time_s: self.time.to_vec(),
            fx_n: signed("fx"),
            fy_n: signed("fy"),
            mz_n_m: None,
        })
    }

    /// The magnitude of the impulse in the plane; 0 for a motion and where a number is not finite.
    pub(super) fn impulse(&self) -> f64 {
        let [x, y] = self.force().map_or([0.0; 2], |force| force.impulse_n_s());
        Some(x.hypot(y)).filter(|size| size.is_finite()).unwrap_or(0.0)
    }
}

impl Results {
    /// The names of all histories with their titles.
    pub(super) fn labels(&self) -> Vec<String> {
        self.histories.iter().map(History::label).collect()
    }

    /// The units that are asked for.
    pub(super) fn open_units(&self) -> OpenUnits {
        self.magnitudes().propose(self.stated)
    }

    fn magnitudes(&self) -> Magnitudes {
        let of = |names: [&'static str; 2]| {
            let columns = self.histories.iter().flat_map(|history| history.columns.iter());
            let named = columns.filter(|column| names.contains(&column.name));
            largest(named.flat_map(|column| column.values.iter().copied()))
        };
        let duration = |history: &History| Some(history.time.last()? - history.time.first()?);
        Magnitudes {
            duration: largest(self.histories.iter().filter_map(duration)),
            force: of(["fx", "fy"]),
            impulse: largest(self.histories.iter().map(History::impulse)),
            speed: of(["vx", "vy"]),
            distance: of(["x", "y"]),
        }
    }
}

/// The largest magnitude of numbers that are finite.
fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.map(f64::abs).filter(|value| value.is_finite()).reduce(f64::max)
}
