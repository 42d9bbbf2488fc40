//! Samples and flags of a simulated motion.

use crate::data::{Channel, TimeSeries};
use crate::vehicle::rest::RestWatch;
use crate::vehicle::{
    Motion, MotionFlag, ROLL_LIMIT_RAD, SimulationError, VehicleEvaluation, VehicleInput,
    VehicleParameters, VehicleState, Wheel,
};

/// What is recorded of the equations of motion at an instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Forces<T> {
    /// Acceleration `[a_x, a_y]` of the CG in body axes, m/s².
    pub acceleration_body_m_s2: [T; 2],
    /// Vertical loads of the wheels, N, in the order of [`Wheel::ALL`].
    pub vertical_loads_n: [T; 4],
    /// Collision force in body axes, N.
    pub collision_force_body_n: [T; 2],
    /// Yaw moment of the collision force about the CG, N m.
    pub collision_yaw_moment_n_m: T,
}

impl<T> Forces<T> {
    /// Converts every component to another type.
    #[inline(always)]
    pub fn map<U>(self, convert: impl Fn(T) -> U) -> Forces<U> {
        let [ax, ay] = self.acceleration_body_m_s2;
        let [fl, fr, rl, rr] = self.vertical_loads_n;
        let [fx, fy] = self.collision_force_body_n;
        Forces {
            acceleration_body_m_s2: [convert(ax), convert(ay)],
            vertical_loads_n: [convert(fl), convert(fr), convert(rl), convert(rr)],
            collision_force_body_n: [convert(fx), convert(fy)],
            collision_yaw_moment_n_m: convert(self.collision_yaw_moment_n_m),
        }
    }
}

impl<T> From<VehicleEvaluation<T>> for Forces<T> {
    #[inline(always)]
    fn from(evaluation: VehicleEvaluation<T>) -> Self {
        Self {
            acceleration_body_m_s2: evaluation.acceleration_body_m_s2,
            vertical_loads_n: evaluation.vertical_loads_n,
            collision_force_body_n: evaluation.collision_force_body_n,
            collision_yaw_moment_n_m: evaluation.collision_yaw_moment_n_m,
        }
    }
}

/// Collects the samples and the flags of a simulation.
pub(super) struct Recorder<'a> {
    vehicle: &'a VehicleParameters,
    time_s: Vec<f64>,
    columns: Vec<(Channel, Vec<f64>)>,
    lift: Option<MotionFlag>,
    roll: Option<MotionFlag>,
    pub(super) energy: Option<MotionFlag>,
}

/// Channels of a simulated motion, in the order in which [`Recorder::record`] lists their values.
const RECORDED: [Channel; 20] = {
    use Channel as C;
    [
        C::X,
        C::Y,
        C::Yaw,
        C::Roll,
        C::Vx,
        C::Vy,
        C::YawRate,
        C::RollRate,
        C::Ax,
        C::Ay,
        C::FxBody,
        C::FyBody,
        C::Mz,
        C::Mx,
        C::SteerFl,
        C::SteerFr,
        C::FzFl,
        C::FzFr,
        C::FzRl,
        C::FzRr,
    ]
};

impl<'a> Recorder<'a> {
    pub(super) fn new(vehicle: &'a VehicleParameters, n_samples: usize) -> Self {
        let column = |channel| (channel, Vec::with_capacity(n_samples));
        let columns = RECORDED.map(column).into();
        Self {
            vehicle,
            time_s: Vec::with_capacity(n_samples),
            columns,
            lift: None,
            roll: None,
            energy: None,
        }
    }

    /// Records an instant.
    ///
    /// - `u`: input over the interval that begins; `forces`: under it.
    pub(super) fn record(
        &mut self,
        time_s: f64,
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
        forces: &Forces<f64>,
    ) {
        let contact_arm_m =
            u.collision.map_or(0.0, |c| c.contact.height_m - self.vehicle.geometry.cg_height_m);
        let [ax, ay] = forces.acceleration_body_m_s2;
        let [fx, fy] = forces.collision_force_body_n;
        let [fl, fr, rl, rr] = forces.vertical_loads_n;
        let mx = -contact_arm_m * fy;
        let sample = [
            x.x_m,
            x.y_m,
            x.yaw_rad,
            x.roll_rad,
            x.vx_body_m_s,
            x.vy_body_m_s,
            x.yaw_rate_rad_s,
            x.roll_rate_rad_s,
            ax,
            ay,
            fx,
            fy,
            forces.collision_yaw_moment_n_m,
            mx,
            u.steer_rad,
            u.steer_rad,
            fl,
            fr,
            rl,
            rr,
        ];
        self.time_s.push(time_s);
        for ((_, column), value) in self.columns.iter_mut().zip(sample) {
            column.push(value);
        }
        let lifted =
            Wheel::ALL.into_iter().zip(forces.vertical_loads_n).find(|(_, load)| *load <= 0.0);
        if let Some((wheel, _)) = lifted {
            self.lift.get_or_insert(MotionFlag::WheelLift { wheel, time_s });
        }
        if x.roll_rad.abs() > ROLL_LIMIT_RAD {
            self.roll.get_or_insert(MotionFlag::RollLimit { time_s, roll_rad: x.roll_rad });
        }
    }

    /// The recorded motion.
    ///
    /// # Errors
    /// [`SimulationError::Series`] if the samples do not form a valid time series.
    pub(super) fn finish(self, rest: &RestWatch) -> Result<Motion, SimulationError> {
        let rest_s = self.time_s.last().and_then(|&end_s| rest.since_s(end_s));
        let mut series = TimeSeries::new(self.time_s)?;
        for (channel, column) in self.columns {
            series.insert(channel, column)?;
        }
        Ok(Motion {
            series,
            flags: self.lift.into_iter().chain(self.roll).chain(self.energy).collect(),
            rest_s,
            applied_controls: None,
        })
    }
}
