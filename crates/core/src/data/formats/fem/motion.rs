//! The motion of a car by that of a node, of two nodes or of a rigid body, and what makes it doubtful.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::data::formats::fem::deck::{Dimension, shown};
use crate::data::formats::fem::results::{History, ROTATION, ROTATION_ABOUT_Z};
use crate::numerics::{counted_turns_rad, wrap_angle_rad};

/// Largest change of the distance of two nodes that are taken for an axis of the car, as a share.
const RIGID: f64 = 0.02;

/// Rotation of a rigid body about other axes than z from which its yaw angle is in doubt, rad.
const TILTED_RAD: f64 = 0.2;

/// Cosine of the angle between heading and first velocity below which the heading is in doubt, and the least
/// velocity that is looked at, as a share of the largest.
const AHEAD: f64 = 0.7;
const MOVING: f64 = 0.1;

/// A column of the table.
pub(super) type Shown = (&'static str, Dimension, Vec<f64>);

/// Which way a car heads at the first instant, along the axes of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Along {
    X,
    MinusX,
    Y,
    MinusY,
}

impl Along {
    pub(super) const ALL: [Self; 4] = [Self::X, Self::MinusX, Self::Y, Self::MinusY];

    /// Its name in the text of a map.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::X => "along x",
            Self::MinusX => "along -x",
            Self::Y => "along y",
            Self::MinusY => "along -y",
        }
    }

    /// The heading of the car, rad.
    pub(super) fn heading_rad(self) -> f64 {
        match self {
            Self::X => 0.0,
            Self::MinusX => PI,
            Self::Y => FRAC_PI_2,
            Self::MinusY => -FRAC_PI_2,
        }
    }
}

/// The path of a node or a rigid body.
pub(super) fn path_of(node: &History) -> Vec<Shown> {
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
pub(super) fn motion_of([rear, front]: &[&History; 2]) -> Vec<Shown> {
    let apart = |name: &str| -> Vec<f64> {
        front.values(name).iter().zip(rear.values(name)).map(|(a, b)| a - b).collect()
    };
    let [dx, dy, ux, uy] = ["x", "y", "vx", "vy"].map(apart);
    let headings: Vec<f64> = dx.iter().zip(&dy).map(|(x, y)| y.atan2(*x)).collect();
    let rates = dx.iter().zip(&dy).zip(ux.iter().zip(&uy));
    let rates = rates.map(|((x, y), (u, v))| (x * v - y * u) / (x * x + y * y)).collect();
    let (along, across) = along_heading([rear.values("vx"), rear.values("vy")], &headings);
    vec![
        ("x", Dimension::Length, rear.values("x").to_vec()),
        ("y", Dimension::Length, rear.values("y").to_vec()),
        ("yaw", Dimension::Angle, counted_turns_rad(headings)),
        ("vx", Dimension::Velocity, along),
        ("vy", Dimension::Velocity, across),
        ("yaw_rate", Dimension::AngularVelocity, rates),
    ]
}

/// The motion of a rigid body that begins with a heading ψ₀.
///
/// ```text
/// ψ(t) = ψ₀ + φ_z(t) − φ_z(0)
/// ```
pub(super) fn motion_of_body(body: &History, along: Along) -> Vec<Shown> {
    let headings: Vec<f64> =
        turns_rad(body).iter().map(|turn| along.heading_rad() + turn).collect();
    let of = |name| body.values(name);
    let (vx, vy) = along_heading([of("vx"), of("vy")], &headings);
    let (ax, ay) = along_heading([of("ax"), of("ay")], &headings);
    vec![
        ("x", Dimension::Length, of("x").to_vec()),
        ("y", Dimension::Length, of("y").to_vec()),
        ("yaw", Dimension::Angle, headings),
        ("vx", Dimension::Velocity, vx),
        ("vy", Dimension::Velocity, vy),
        ("yaw_rate", Dimension::AngularVelocity, of("yaw_rate").to_vec()),
        ("ax", Dimension::Acceleration, ax),
        ("ay", Dimension::Acceleration, ay),
    ]
}

/// The rotation of a rigid body about z since the first instant, rad.
fn turns_rad(body: &History) -> Vec<f64> {
    let angles = counted_turns_rad(body.values(ROTATION_ABOUT_Z.0).to_vec());
    let first = angles.first().copied().unwrap_or(0.0);
    angles.iter().map(|angle| angle - first).collect()
}

/// Vectors along headings and to the left of them.
fn along_heading([x, y]: [&[f64]; 2], headings: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let turned = |((x, y), heading): ((&f64, &f64), &f64)| {
        let (sin, cos) = heading.sin_cos();
        (cos * x + sin * y, cos * y - sin * x)
    };
    x.iter().zip(y).zip(headings).map(turned).unzip()
}

/// By how far a rigid body that has turned about z and in all by two angles has turned about other axes, rad:
///
/// ```text
/// cos(θ/2) = cos(φ_z/2) cos(τ/2)
/// ```
///
/// Where φ_z is near half a turn, this tells nothing; there, and where φ_z is the larger one, it is their difference.
fn tilt_rad(turn_rad: f64, whole_rad: f64) -> f64 {
    let turn_rad = wrap_angle_rad(turn_rad).abs();
    let [of_turn, of_whole] = [turn_rad, whole_rad].map(|angle| (angle / 2.0).cos());
    let tilt_rad =
        if of_turn > 0.5 { 2.0 * (of_whole / of_turn).clamp(0.0, 1.0).acos() } else { 0.0 };
    tilt_rad.max((turn_rad - whole_rad).abs())
}

/// What is said of a rigid body that turns about other axes than z.
pub(super) fn tilted(body: &History) -> Option<String> {
    let turns = turns_rad(body);
    let tilt = |(turn, whole): (&f64, &f64)| tilt_rad(*turn, *whole);
    let largest = turns.iter().zip(body.values(ROTATION.0)).map(tilt).fold(0.0, f64::max);
    (largest > TILTED_RAD).then(|| {
        format!(
            "{} turns about z and in all by angles that do not go together: it rolls or pitches by up to {}°, or \
             its rotation about z is no angle in rad, so its yaw angle may be wrong",
            body.name,
            shown(largest.to_degrees())
        )
    })
}

/// What is said of a rigid body that does not begin in the direction in which it is said to head.
pub(super) fn not_ahead(body: &History, along: Along) -> Option<String> {
    let velocities = body.values("vx").iter().zip(body.values("vy"));
    let (x, y) = velocities.clone().next()?;
    let largest = velocities.map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max);
    let (sin, cos) = along.heading_rad().sin_cos();
    let speed = x.hypot(*y);
    let is_off = speed > MOVING * largest && cos * x + sin * y < AHEAD * speed;
    is_off.then(|| {
        format!(
            "{} begins with the velocity ({}, {}) along the axes of the model, which is not {}: is that how the \
             car heads?",
            body.name,
            shown(*x),
            shown(*y),
            along.name()
        )
    })
}

/// What is said of two nodes whose distance changes.
pub(super) fn bent([rear, front]: &[&History; 2]) -> Option<String> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A roll of 0.4 rad adds 0.07 rad to a turn of 1 rad.
    #[test]
    fn a_roll_within_a_turn_is_told_from_it() {
        let whole = |turn: f64, tilt: f64| 2.0 * ((turn / 2.0).cos() * (tilt / 2.0).cos()).acos();
        for turn in [-1.5, 0.0, 1.0, 7.0_f64] {
            let turned = wrap_angle_rad(turn);
            assert!(tilt_rad(turn, turned.abs()) < 1e-6);
            assert!((tilt_rad(turn, whole(turned, 0.4)) - 0.4).abs() < 1e-6);
        }
        // A turn in degrees, of which a third of one is all there is.
        assert!(tilt_rad(20.0, 0.35) > TILTED_RAD);
        assert!(tilt_rad(3.1, 3.1) < 1e-6);
    }
}
