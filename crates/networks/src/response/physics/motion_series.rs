//! A motion as the time series that files, plots and error metrics are made of.

use crate::response::STEP_S;
use impactlab_core::data::{Channel, SeriesError, TimeSeries};
use impactlab_core::vehicle::frames::body_from_world;
use impactlab_core::vehicle::{VehicleInput, VehicleState};

/// States every 10 ms and the force over the coming step as a time series; the last sample has no
/// force.
///
/// # Errors
/// [`SeriesError`] where a state is not finite.
pub fn motion_series(
    states: &[VehicleState<f64>],
    inputs: &[VehicleInput<f64>],
) -> Result<TimeSeries, SeriesError> {
    let mut series = TimeSeries::new((0..states.len()).map(|i| i as f64 * STEP_S).collect())?;
    let column =
        |value: fn(&VehicleState<f64>) -> f64| states.iter().map(value).collect::<Vec<f64>>();
    let columns = [
        (Channel::X, column(|x| x.x_m)),
        (Channel::Y, column(|x| x.y_m)),
        (Channel::Yaw, column(|x| x.yaw_rad)),
        (Channel::Roll, column(|x| x.roll_rad)),
        (Channel::Vx, column(|x| x.vx_body_m_s)),
        (Channel::Vy, column(|x| x.vy_body_m_s)),
        (Channel::YawRate, column(|x| x.yaw_rate_rad_s)),
        (Channel::RollRate, column(|x| x.roll_rate_rad_s)),
    ];
    for (channel, values) in columns {
        series.insert(channel, values)?;
    }
    let force = |axis: usize| -> Vec<f64> {
        let component = |(state, input): (&VehicleState<f64>, &VehicleInput<f64>)| {
            input.collision.map_or(0.0, |collision| match collision.in_world_axes {
                true => body_from_world(state.yaw_rad, collision.force_n)[axis],
                false => collision.force_n[axis],
            })
        };
        let forces = states.iter().zip(inputs).map(component);
        let rest = states.len().saturating_sub(inputs.len());
        forces.chain(std::iter::repeat_n(0.0, rest)).collect()
    };
    series.insert(Channel::FxBody, force(0))?;
    series.insert(Channel::FyBody, force(1))?;
    Ok(series)
}
