//! What `impactlab simulate` says about one vehicle.

use std::io::{self, Write};
use std::path::PathBuf;

use serde::Serialize;

use crate::cli::output::{print_facts, shown, shown_vector, word};
use crate::cli::simulate::SingleArgs;
use crate::compare::largest_yaw_change_rad;
use crate::data::{Channel, SeriesError, TimeSeries, contact_interval};
use crate::numerics::interpolate;
use crate::units::{Quantity, UnitSystem};
use crate::vehicle::frames::world_from_body;
use crate::vehicle::{Manoeuvre, Motion, MotionFlag};

/// What is said about a simulation.
#[derive(Debug, Serialize)]
pub(super) struct Answer {
    pub(super) vehicle: String,
    pub(super) equations: String,
    pub(super) integrator: String,
    pub(super) friction: f64,
    pub(super) duration_s: f64,
    pub(super) force: Option<ForceAnswer>,
    pub(super) delta_v_m_s: Option<[f64; 2]>,
    pub(super) delta_v_magnitude_m_s: Option<f64>,
    pub(super) end: End,
    pub(super) distance_m: f64,
    pub(super) largest_yaw_change_rad: f64,
    pub(super) flags: Vec<FlagAnswer>,
    pub(super) out: Option<PathBuf>,
}

#[derive(Debug, Serialize)]
pub(super) struct ForceAnswer {
    path: PathBuf,
    sampling: String,
    axes: String,
    impulse_n_s: [f64; 2],
    contact_start_s: Option<f64>,
    contact_end_s: Option<f64>,
    yaw_moment: &'static str,
}

/// State at the last sample.
#[derive(Debug, Serialize)]
pub(super) struct End {
    x_m: f64,
    y_m: f64,
    yaw_rad: f64,
    roll_rad: f64,
    vx_m_s: f64,
    vy_m_s: f64,
    yaw_rate_rad_s: f64,
    speed_m_s: f64,
}

/// A [`MotionFlag`] for machines and, as `message`, for a person.
#[derive(Debug, Serialize)]
pub(super) struct FlagAnswer {
    kind: &'static str,
    time_s: f64,
    wheel: Option<String>,
    roll_rad: Option<f64>,
    pub(super) message: String,
}

impl From<&MotionFlag> for FlagAnswer {
    fn from(flag: &MotionFlag) -> Self {
        let message = flag.to_string();
        match flag {
            MotionFlag::WheelLift { wheel, time_s } => Self {
                kind: "wheel_lift",
                time_s: *time_s,
                wheel: Some(word(wheel)),
                roll_rad: None,
                message,
            },
            MotionFlag::RollLimit { time_s, roll_rad } => Self {
                kind: "roll_limit",
                time_s: *time_s,
                wheel: None,
                roll_rad: Some(*roll_rad),
                message,
            },
        }
    }
}

/// What follows from the motion; name, equations, integrator, friction and files are filled in by the caller.
pub(super) fn answer(
    args: &SingleArgs,
    manoeuvre: &Manoeuvre,
    motion: &Motion,
) -> Result<Answer, SeriesError> {
    let series = &motion.series;
    let load = manoeuvre.contact_load.as_ref();
    let interval = load.and_then(|load| contact_interval(&load.force));
    let delta_v = interval.map(|interval| delta_v_m_s(series, interval));
    let delta_v = delta_v.transpose()?;
    let force = args.force.clone().zip(load).map(|(path, load)| ForceAnswer {
        path,
        sampling: word(&load.force.sampling),
        axes: word(&load.force.axes),
        impulse_n_s: load.force.impulse_n_s(),
        contact_start_s: interval.map(|(start, _)| start),
        contact_end_s: interval.map(|(_, end)| end),
        yaw_moment: if load.recorded_moment { "recorded" } else { "contact_point" },
    });
    Ok(Answer {
        vehicle: String::new(),
        equations: String::new(),
        integrator: String::new(),
        friction: 0.0,
        duration_s: 0.0,
        force,
        delta_v_m_s: delta_v,
        delta_v_magnitude_m_s: delta_v.map(|[x, y]| x.hypot(y)),
        end: end(series)?,
        distance_m: distance_m(series)?,
        largest_yaw_change_rad: largest_yaw_change_rad(series)?,
        flags: motion.flags.iter().map(FlagAnswer::from).collect(),
        out: None,
    })
}

/// Change of the CG's velocity over the contact, world axes, m/s: tyres included.
fn delta_v_m_s(series: &TimeSeries, (start_s, end_s): (f64, f64)) -> Result<[f64; 2], SeriesError> {
    let [vx, vy, yaw] = [Channel::Vx, Channel::Vy, Channel::Yaw].map(|c| series.require(c));
    let (vx, vy, yaw) = (vx?, vy?, yaw?);
    let velocity = |time_s| {
        let at = |values| interpolate(series.time_s(), values, time_s).unwrap_or(f64::NAN);
        world_from_body(at(yaw), [at(vx), at(vy)])
    };
    let ([x0, y0], [x1, y1]) = (velocity(start_s), velocity(end_s));
    Ok([x1 - x0, y1 - y0])
}

/// Length of the CG's path, m.
fn distance_m(series: &TimeSeries) -> Result<f64, SeriesError> {
    let (x, y) = (series.require(Channel::X)?, series.require(Channel::Y)?);
    let steps = x.windows(2).zip(y.windows(2));
    Ok(steps.map(|(x, y)| (x[1] - x[0]).hypot(y[1] - y[0])).sum())
}

fn end(series: &TimeSeries) -> Result<End, SeriesError> {
    let last = |channel| -> Result<f64, SeriesError> {
        let values = series.require(channel)?;
        Ok(values.last().copied().unwrap_or(f64::NAN))
    };
    let (vx_m_s, vy_m_s) = (last(Channel::Vx)?, last(Channel::Vy)?);
    Ok(End {
        x_m: last(Channel::X)?,
        y_m: last(Channel::Y)?,
        yaw_rad: last(Channel::Yaw)?,
        roll_rad: last(Channel::Roll)?,
        vx_m_s,
        vy_m_s,
        yaw_rate_rad_s: last(Channel::YawRate)?,
        speed_m_s: vx_m_s.hypot(vy_m_s),
    })
}

/// Prints the answer for a person.
pub(super) fn print_text(
    out: &mut dyn Write,
    answer: &Answer,
    units: UnitSystem,
) -> io::Result<()> {
    let number = |quantity, value| shown(quantity, value, units);
    let vector = |quantity, value| shown_vector(quantity, value, ["x", "y"], units);
    let end = &answer.end;
    let mut facts = vec![
        ("vehicle", answer.vehicle.clone()),
        (
            "simulation",
            format!(
                "{} s, {} equations, {}, friction {}",
                answer.duration_s, answer.equations, answer.integrator, answer.friction
            ),
        ),
    ];
    if let Some(force) = &answer.force {
        let (sampling, axes) = (force.sampling.replace('_', " "), &force.axes);
        let path = force.path.display();
        let moment = force.yaw_moment.replace('_', " ");
        facts.push(("force", format!("{path} ({axes} axes, {sampling})")));
        facts.push(("yaw moment", format!("from the {moment}")));
        facts.push(("impulse", vector(Quantity::Impulse, force.impulse_n_s)));
        if let (Some(start), Some(end)) = (force.contact_start_s, force.contact_end_s) {
            facts.push(("contact", format!("{start:.4} s to {end:.4} s")));
        }
    }
    if let Some(delta_v) = answer.delta_v_m_s {
        facts.push(("Δv over contact", vector(Quantity::Speed, delta_v)));
    }
    facts.extend([
        ("end position", vector(Quantity::Length, [end.x_m, end.y_m])),
        ("distance", number(Quantity::Length, answer.distance_m)),
        ("final heading", number(Quantity::Angle, end.yaw_rad)),
        ("largest yaw change", number(Quantity::Angle, answer.largest_yaw_change_rad)),
        ("final speed", number(Quantity::Speed, end.speed_m_s)),
    ]);
    facts.extend(answer.flags.iter().map(|flag| ("flag", flag.message.clone())));
    if let Some(path) = &answer.out {
        facts.push(("written", path.display().to_string()));
    }
    print_facts(out, &facts)
}
