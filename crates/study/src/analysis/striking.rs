//! The motion of the striking vehicle in a finite-element case: as recorded, then coasting.

use crate::analysis::{AnalysisError, Settings, StruckVehicle, VehicleTrack};
use impactlab_core::collision::{Footprint, Pose};
use impactlab_core::data::{Case, Channel, ForceAttributes, SeriesError, TimeSeries};
use impactlab_core::vehicle::frames::body_from_world;
use impactlab_core::vehicle::{
    ContactPoint, Controls, Manoeuvre, Motion, MotionFlag, OUTPUT_INTERVAL_S, VehicleParameters,
    VehicleState,
};

/// Position at each recorded sample, m, and state of the vehicle at the last one.
struct Recorded {
    x_m: Vec<f64>,
    y_m: Vec<f64>,
    end: VehicleState<f64>,
}

/// Outline and motion of the striking vehicle. During the recording its position is the integral of
/// the recorded velocities from its initial position; after it the striking vehicle coasts as a
/// 4DOF vehicle without steering, drive or braking, until the duration of the settings. `None` if
/// the case does not record the striking vehicle.
///
/// # Errors
/// [`AnalysisError::Simulation`] if the simulation of the coasting diverges.
pub(super) fn striking_track(
    case: &Case,
    attributes: &ForceAttributes,
    settings: &Settings,
) -> Result<Option<VehicleTrack>, AnalysisError> {
    let start = [case.attributes.number("bullet_x0_m"), case.attributes.number("bullet_y0_m")];
    let ([Some(x), Some(y)], Some(yaw_rad)) = (start, case.series.get(Channel::StrikingYaw)) else {
        return Ok(None);
    };
    let Some(recorded) = integrate(&case.series, [x, y]) else {
        return Ok(None);
    };
    let [_, mass_kg] = attributes.mass_kg;
    let [_, yaw_inertia] = attributes.yaw_inertia_kg_m2;
    let vehicle = settings.striking.clone().with_mass(mass_kg, yaw_inertia);
    let footprint = Footprint::from(&vehicle.geometry);
    let (motion, flags) = append_coasting(&case.series, yaw_rad, recorded, &vehicle, settings)?;
    let yaw_rad = yaw_rad.first().copied().unwrap_or(attributes.theta_b_rad);
    let pose = Pose { x_m: x, y_m: y, yaw_rad };
    // The struck vehicle heads along X from the origin.
    let [x_body_m, y_body_m] = pose.body_from_world(attributes.contact_m);
    let [vx_body_m_s, vy_body_m_s] = body_from_world(yaw_rad, attributes.striking_velocity_m_s);
    let height_m = attributes.contact_height_m.unwrap_or(vehicle.geometry.cg_height_m);
    let start = StruckVehicle {
        vehicle,
        initial: VehicleState {
            vx_body_m_s,
            vy_body_m_s,
            yaw_rad,
            x_m: x,
            y_m: y,
            ..VehicleState::default()
        },
        contact: ContactPoint { x_body_m, y_body_m, height_m },
        controls: Controls::default(),
        friction_zones: settings.friction_zones.clone(),
    };
    Ok(Some(VehicleTrack { footprint, start, motion, controls: Controls::default(), flags }))
}

/// Integrates the recorded world velocities by the trapezoidal rule from a start [x, y], m. `None`
/// if a channel of the striking vehicle is missing.
fn integrate(series: &TimeSeries, start_m: [f64; 2]) -> Option<Recorded> {
    let time_s = series.time_s();
    let (vx, vy) = (series.get(Channel::StrikingVx)?, series.get(Channel::StrikingVy)?);
    let yaw_rad = *series.get(Channel::StrikingYaw)?.last()?;
    let yaw_rate_rad_s = *series.get(Channel::StrikingYawRate)?.last()?;
    let path = |start: f64, velocity: &[f64]| -> Vec<f64> {
        let steps = time_s.windows(2).zip(velocity.windows(2));
        let moved = steps.scan(start, |position, (time, velocity)| {
            *position += (velocity[0] + velocity[1]) / 2.0 * (time[1] - time[0]);
            Some(*position)
        });
        std::iter::once(start).chain(moved).collect()
    };
    let (x_m, y_m) = (path(start_m[0], vx), path(start_m[1], vy));
    let [vx_body_m_s, vy_body_m_s] = body_from_world(yaw_rad, [*vx.last()?, *vy.last()?]);
    let end = VehicleState {
        vx_body_m_s,
        vy_body_m_s,
        yaw_rad,
        yaw_rate_rad_s,
        x_m: *x_m.last()?,
        y_m: *y_m.last()?,
        ..VehicleState::default()
    };
    Some(Recorded { x_m, y_m, end })
}

/// Appends the coasting to the recorded positions and yaw angles, and returns what is flagged in it as well.
fn append_coasting(
    series: &TimeSeries,
    yaw_rad: &[f64],
    recorded: Recorded,
    vehicle: &VehicleParameters,
    settings: &Settings,
) -> Result<(TimeSeries, Vec<MotionFlag>), AnalysisError> {
    let recorded_end_s = series.time_s().last().copied().unwrap_or(0.0);
    let manoeuvre = Manoeuvre {
        initial: recorded.end,
        duration_s: (settings.duration_s - recorded_end_s).max(OUTPUT_INTERVAL_S),
        friction_zones: settings.friction_zones.clone(),
        ..Manoeuvre::default()
    };
    let Motion { series: coasting, flags, .. } =
        vehicle.simulate(&manoeuvre, settings.integrator)?;
    let later = coasting.time_s().iter().skip(1).map(|t| t + recorded_end_s);
    let mut motion = TimeSeries::new(series.time_s().iter().copied().chain(later).collect())?;
    let mut join = |channel, before: &[f64]| -> Result<(), SeriesError> {
        let after = coasting.require(channel)?.iter().skip(1);
        motion.insert(channel, before.iter().chain(after).copied().collect())
    };
    join(Channel::X, &recorded.x_m)?;
    join(Channel::Y, &recorded.y_m)?;
    join(Channel::Yaw, yaw_rad)?;
    Ok((motion, flags.into_iter().map(|flag| flag.later_by(recorded_end_s)).collect()))
}
