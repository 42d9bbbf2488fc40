//! Tables for HVE of Engineering Dynamics Corporation: the force on a vehicle over time for a collision
//! pulse, and the motion of a vehicle.
//!
//! HVE has no published file format for either. Since version 5.20 its tables, the collision pulse among
//! them, take rows that are copied from a table (EDC Technical Newsletter, summer 2006), so what is
//! written is text with tabs between the columns: lines that begin with `#` say what it is, one line
//! names the columns with their units, and the rows are to be copied. That HVE takes these very columns
//! in this order was not tried; compare them with the table before they are pasted.
//!
//! Units are those that HVE has by default (lb, ft, degrees, seconds). Axes are those of SAE J670, which
//! HVE uses: of the vehicle, x forward, y to the right, z down; of the ground, X as here, Y to the
//! right. Signs of y, yaw and yaw moment are therefore turned round.

use std::io::Write;

use crate::exchange::ExchangeError;
use impactlab_core::data::{Channel, ForceAxes, ForceHistory, Sampling, TimeSeries};
use impactlab_core::numerics::interpolate;
use impactlab_core::units::{Quantity, STANDARD_GRAVITY_M_S2};
use impactlab_core::vehicle::ContactPoint;
use impactlab_core::vehicle::frames::body_from_world;
use impactlab_study::analysis::Analysis;

/// Columns of the force on a vehicle.
const PULSE_COLUMNS: [&str; 5] =
    ["Time (sec)", "Fx (lb)", "Fy (lb)", "Forward accel (g)", "Side accel (g)"];
/// Columns of the motion of a vehicle.
const MOTION_COLUMNS: [&str; 8] = [
    "Time (sec)",
    "X (ft)",
    "Y (ft)",
    "Yaw (deg)",
    "Forward velocity (ft/sec)",
    "Side velocity (ft/sec)",
    "Yaw velocity (deg/sec)",
    "Roll (deg)",
];

/// Axes of the force on a vehicle.
const PULSE_AXES: &str =
    "axes of SAE J670, of the vehicle: x forward, y right, Mz clockwise from above";
/// Axes of the motion of a vehicle.
const MOTION_AXES: &str = "axes of SAE J670: X and Y of the ground, Y to the right of X; yaw clockwise from above; \
                           velocities along x forward and y right of the vehicle; roll to the right";

/// Writes the contact force on the struck vehicle over time, with the acceleration that it alone causes
/// at the centre of gravity, and its yaw moment if it is recorded.
///
/// # Errors
/// [`ExchangeError::Unknown`] without a force; the error of the operating system.
pub fn hve_pulse(
    analysis: &Analysis,
    restrictions: Option<&str>,
    out: &mut dyn Write,
) -> Result<(), ExchangeError> {
    let unknown =
        || ExchangeError::Unknown { name: analysis.name.clone(), what: "contact force over time" };
    let force = analysis.force.as_ref().ok_or_else(unknown)?;
    let mass_kg = analysis.vehicle.mass.mass_kg;
    let what = ["collision force on the struck vehicle", PULSE_AXES];
    head(out, &analysis.name, what, restrictions)?;
    writeln!(out, "# mass {:.1} lb", to("lb", Quantity::Mass, mass_kg))?;
    writeln!(out, "# each row has {}", sampling_text(force.sampling))?;
    writeln!(out, "# accelerations are those by this force alone, without the tires")?;
    let moment = force.mz_n_m.as_ref();
    for line in moment_lines(analysis, moment.is_some()) {
        writeln!(out, "# {line}")?;
    }
    let mut columns = PULSE_COLUMNS.to_vec();
    columns.extend(moment.map(|_| "Mz (ft-lb)"));
    writeln!(out, "{}", columns.join("\t"))?;
    for (idx, time_s) in force.time_s.iter().enumerate() {
        let Some([fx_n, fy_n]) = body_force_n(analysis, force, idx) else { continue };
        let accelerations = [fx_n, -fy_n].map(|f| f / mass_kg / STANDARD_GRAVITY_M_S2);
        let forces = [fx_n, -fy_n].map(|f| to("lbf", Quantity::Force, f));
        let mut row = vec![format!("{time_s:.5}")];
        row.extend(forces.iter().map(|value| format!("{:.2}", value + 0.0)));
        row.extend(accelerations.iter().map(|value| format!("{:.5}", value + 0.0)));
        if let Some(mz_n_m) = moment.and_then(|values| values.get(idx)) {
            row.push(format!("{:.2}", -to("lbf ft", Quantity::Moment, *mz_n_m) + 0.0));
        }
        writeln!(out, "{}", row.join("\t"))?;
    }
    Ok(())
}

/// Writes the motion of the struck vehicle: simulated, or recorded if it is not simulated.
///
/// # Errors
/// [`ExchangeError::Unknown`] without a motion; the error of the operating system.
pub fn hve_motion(
    analysis: &Analysis,
    restrictions: Option<&str>,
    out: &mut dyn Write,
) -> Result<(), ExchangeError> {
    let unknown = || ExchangeError::Unknown { name: analysis.name.clone(), what: "motion" };
    let series = motion(analysis).ok_or_else(unknown)?;
    let what = ["motion of the struck vehicle, centre of gravity", MOTION_AXES];
    head(out, &analysis.name, what, restrictions)?;
    writeln!(out, "{}", MOTION_COLUMNS.join("\t"))?;
    let value = |channel: Channel, idx: usize| {
        series.get(channel).and_then(|values| values.get(idx)).copied().unwrap_or(f64::NAN)
    };
    for (idx, time_s) in series.time_s().iter().enumerate() {
        let feet = |channel, sign: f64| sign * to("ft", Quantity::Length, value(channel, idx));
        let speed = |channel, sign: f64| sign * to("ft/s", Quantity::Speed, value(channel, idx));
        let degrees = |channel, sign: f64| sign * value(channel, idx).to_degrees();
        let numbers = [
            feet(Channel::X, 1.0),
            feet(Channel::Y, -1.0),
            degrees(Channel::Yaw, -1.0),
            speed(Channel::Vx, 1.0),
            speed(Channel::Vy, -1.0),
            degrees(Channel::YawRate, -1.0),
            degrees(Channel::Roll, 1.0),
        ];
        // What is not known has no number.
        let cells = numbers.iter().map(|value| match value.is_finite() {
            true => format!("{:.4}", value + 0.0),
            false => String::new(),
        });
        let row: Vec<String> = std::iter::once(format!("{time_s:.5}")).chain(cells).collect();
        writeln!(out, "{}", row.join("\t"))?;
    }
    Ok(())
}

/// Says what a table is, its axes, and what restricts it.
fn head(
    out: &mut dyn Write,
    name: &str,
    [what, axes]: [&str; 2],
    restrictions: Option<&str>,
) -> Result<(), ExchangeError> {
    writeln!(out, "# {}: {what}", one_line(name))?;
    writeln!(out, "# {axes}")?;
    if let Some(restrictions) = restrictions {
        writeln!(out, "# the restrictions have the units that they say, and y and Y to the left")?;
        writeln!(out, "# restrictions: {}", one_line(restrictions))?;
    }
    Ok(())
}

/// What there is to say of yaw moment and point of contact, of which HVE needs one.
fn moment_lines(analysis: &Analysis, has_moment: bool) -> Vec<String> {
    if has_moment {
        return vec![
            "the yaw moment Mz is about the centre of gravity; no point of contact is needed"
                .to_owned(),
        ];
    }
    let (missing, place) = match &analysis.struck {
        None => (
            "the yaw moment Mz is missing: nothing says it",
            "the point of contact is missing".to_owned(),
        ),
        Some(struck) => {
            let ContactPoint { x_body_m, y_body_m, height_m } = struck.contact;
            let [x, y, z] =
                [x_body_m, -y_body_m, height_m].map(|m| to("ft", Quantity::Length, m) + 0.0);
            let place = format!(
                "point of contact: x {x:.3} ft, y {y:.3} ft from the centre of gravity, {z:.3} ft above the \
                 ground"
            );
            (
                "the yaw moment Mz is missing as a column: it follows from the point of contact",
                place,
            )
        }
    };
    vec![missing.to_owned(), place]
}

fn sampling_text(sampling: Sampling) -> &'static str {
    match sampling {
        Sampling::Instant => "the force at its time",
        Sampling::CentredMean => "the mean force around its time",
        Sampling::ComingMean => "the mean force from its time to that of the next row",
    }
}

fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// The force of a sample in the axes of the struck vehicle, N; `None` where its heading is not known.
fn body_force_n(analysis: &Analysis, force: &ForceHistory, idx: usize) -> Option<[f64; 2]> {
    let own = [*force.fx_n.get(idx)?, *force.fy_n.get(idx)?];
    match force.axes {
        ForceAxes::Body => Some(own),
        ForceAxes::World => {
            let series = motion(analysis)?;
            let yaw = series.get(Channel::Yaw)?;
            let yaw_rad = interpolate(series.time_s(), yaw, *force.time_s.get(idx)?)?;
            Some(body_from_world(yaw_rad, own))
        }
    }
}

fn motion(analysis: &Analysis) -> Option<&TimeSeries> {
    let simulated = analysis.simulation.as_ref().map(|motion| &motion.series);
    simulated.or(analysis.reference.as_ref())
}

/// A value in a unit of its quantity.
fn to(symbol: &str, quantity: Quantity, value_si: f64) -> f64 {
    let unit = quantity.units().iter().find(|unit| unit.symbol == symbol);
    unit.map_or(f64::NAN, |unit| unit.from_si(value_si))
}
