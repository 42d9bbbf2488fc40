//! What a car of a recorded pair leaves after the first contact: where it comes to rest, the marks of its
//! wheels, and what its event data recorder writes.

use impactlab_core::collision::Pose;
use impactlab_core::compare::PairCase;
use impactlab_core::data::{Channel, SeriesError, TimeSeries};
use impactlab_core::numerics::interpolate;
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::{
    ControlledVehicle, Controls, Path, PathEnd, PathPoint, TireMark, VehicleParameters, Wheel,
    WheelEffort, WheelHistory, tire_marks,
};

use crate::likelihood::Track;

/// Speed below which a car at the end of a record is at rest, m/s: it is so within 2 cm.
const REST_SPEED_M_S: f64 = 0.1;
/// The same of its yaw rate, rad/s.
const REST_YAW_RATE_RAD_S: f64 = 0.05;

/// Least length of a mark that is found, m.
const LEAST_MARK_M: f64 = 1.0;

/// Least time for which a brake asks for more than the road holds until its wheel is locked, s: longer
/// than a cycle of an anti-lock system.
const LEAST_LOCK_S: f64 = 0.25;

/// Time before the end of a record within which a mark has not ended, s.
const CUT_OFF_S: f64 = 0.05;

/// A car of a recorded pair from the first contact on, in the axes of the evidence.
pub(super) struct RecordedCar<'a> {
    pub vehicle: &'a VehicleParameters,
    /// Its path, whose time begins with the contact.
    pub path: Path,
    controls: &'a Controls,
    /// Time of the first contact in the record, s.
    first_s: f64,
}

impl<'a> RecordedCar<'a> {
    /// A car of a pair; `None` if the record ends before the contact.
    ///
    /// - `idx`: 0 of the struck car, 1 of the striking car;
    /// - `first_s`: time of the first contact, s;
    /// - `origin`: the struck car then, in the axes of the record.
    pub fn new(
        case: &'a PairCase,
        idx: usize,
        first_s: f64,
        origin: &Pose,
    ) -> Result<Option<Self>, SeriesError> {
        let motion = &case.motions[idx];
        let times = motion.time_s();
        let later = times.iter().copied().filter(|time_s| *time_s > first_s);
        let mut points = Vec::new();
        for time_s in std::iter::once(first_s).chain(later) {
            let mut values = [0.0; 6];
            for (value, channel) in values.iter_mut().zip(COLUMNS) {
                let column = motion.require(channel)?;
                *value = interpolate(times, column, time_s).unwrap_or(f64::NAN);
            }
            let [x_m, y_m, yaw_rad, vx_body_m_s, vy_body_m_s, yaw_rate_rad_s] = values;
            let [x_m, y_m] = origin.body_from_world([x_m, y_m]);
            points.push(PathPoint {
                time_s: time_s - first_s,
                x_m,
                y_m,
                yaw_rad: yaw_rad - origin.yaw_rad,
                vx_body_m_s,
                vy_body_m_s,
                yaw_rate_rad_s,
            });
        }
        let is_at_rest = |last: &PathPoint| {
            last.vx_body_m_s.hypot(last.vy_body_m_s) < REST_SPEED_M_S
                && last.yaw_rate_rad_s.abs() < REST_YAW_RATE_RAD_S
        };
        let end = match points.last().is_some_and(is_at_rest) {
            true => PathEnd::Rest,
            false => PathEnd::Time,
        };
        let (vehicle, controls) = (&case.vehicles[idx], &case.manoeuvres[idx].controls);
        let path = Path { points, end };
        Ok((path.points.len() > 1).then_some(Self { vehicle, path, controls, first_s }))
    }

    /// Pose at the end of the record, x, y, m, and heading with whole turns, rad; `None` if it still moves
    /// then.
    pub fn rest(&self) -> Option<[f64; 3]> {
        let last = self.path.points.last().filter(|_| self.path.end == PathEnd::Rest)?;
        Some([last.x_m, last.y_m, last.yaw_rad])
    }

    /// Velocity at the first contact in the axes of the evidence, m/s, and heading, rad.
    pub fn before(&self) -> ([f64; 2], f64) {
        let first = self.path.points[0];
        let heading = Pose { x_m: 0.0, y_m: 0.0, yaw_rad: first.yaw_rad };
        (heading.world_from_body([first.vx_body_m_s, first.vy_body_m_s]), first.yaw_rad)
    }

    /// What a recorder at its CG integrates until a time after the first contact, heading axes, m/s.
    pub fn recorded_delta_v_m_s(&self, end_s: f64) -> Option<[f64; 2]> {
        Track::from_path(&self.path)?.recorded_delta_v_m_s([0.0; 2], end_s)
    }

    /// The marks of its wheels that an investigator finds: those of at least 1 m, without those that the
    /// end of the record cuts off.
    pub fn marks(&self) -> Result<Vec<TireMark>, SeriesError> {
        let series = self.series()?;
        let (vehicle, controls) = (self.vehicle, &self.locked_wheels());
        let marks =
            tire_marks(&series, ControlledVehicle { vehicle, controls, friction_zones: &[] });
        let end_s = series.time_s().last().copied().unwrap_or(0.0);
        let is_found = |mark: &TireMark| {
            let has_ended = mark.ends().is_some_and(|[_, last]| last.time_s < end_s - CUT_OFF_S);
            mark.length_m() >= LEAST_MARK_M && has_ended
        };
        Ok(marks.into_iter().filter(is_found).collect())
    }

    /// The motion with the angles of the front wheels and the loads of the wheels, over the time of the
    /// record.
    fn series(&self) -> Result<TimeSeries, SeriesError> {
        let points = &self.path.points;
        let later = |at: &PathPoint| PathPoint { time_s: at.time_s + self.first_s, ..*at };
        let mut series = PathPoint::series(&points.iter().map(later).collect::<Vec<_>>())?;
        if let Some(steer) = &self.controls.steer {
            let at = |time_s: &f64| interpolate(&steer.time_s, &steer.steer_rad, *time_s);
            let times_s = series.time_s().iter();
            let steer_rad: Vec<f64> = times_s.map(|it| at(it).unwrap_or(0.0)).collect();
            series.insert(Channel::SteerFl, steer_rad.clone())?;
            series.insert(Channel::SteerFr, steer_rad)?;
        }
        let loads: Vec<[f64; 4]> = points.iter().map(|point| self.loads_n(point)).collect();
        for wheel in Wheel::ALL {
            let of_wheel = loads.iter().map(|loads| loads[wheel.index()]).collect();
            series.insert(LOADS[wheel.index()], of_wheel)?;
        }
        Ok(series)
    }

    /// Which wheels are locked over the time of the record. A brake that asks for more than the road holds
    /// for a moment only is one of an anti-lock system, whose wheels go on turning.
    fn locked_wheels(&self) -> Controls {
        let points = &self.path.points;
        let time_s: Vec<f64> = points.iter().map(|point| point.time_s + self.first_s).collect();
        let mut wheels = vec![[WheelEffort::FREE; 4]; points.len()];
        for wheel in Wheel::ALL {
            let held: Vec<bool> = points.iter().map(|point| self.is_held(wheel, point)).collect();
            let mut from = 0;
            for run in held.chunk_by(|a, b| a == b) {
                let until = from + run.len();
                if run[0] && time_s[until - 1] - time_s[from] >= LEAST_LOCK_S {
                    for efforts in &mut wheels[from..until] {
                        efforts[wheel.index()].locked = 1.0;
                    }
                }
                from = until;
            }
        }
        Controls { wheels: Some(WheelHistory { time_s, wheels }), ..Controls::default() }
    }

    /// Whether the brake of a wheel asks for more than the road holds.
    fn is_held(&self, wheel: Wheel, point: &PathPoint) -> bool {
        let time_s = point.time_s + self.first_s;
        let [x_m, y_m] = self.vehicle.geometry.wheel_place_m(wheel);
        let r = point.yaw_rate_rad_s;
        let velocity_m_s = [point.vx_body_m_s - r * y_m, point.vy_body_m_s + r * x_m];
        let load_n = self.loads_n(point)[wheel.index()];
        self.controls.is_locked(time_s, wheel, velocity_m_s, load_n, &self.vehicle.tires)
    }

    /// Loads of the wheels, N: those at rest and what braking shifts to the front axle. A brake that asks
    /// for more than the road holds brakes with what the road holds.
    fn loads_n(&self, point: &PathPoint) -> [f64; 4] {
        let VehicleParameters { mass, geometry, tires, .. } = self.vehicle;
        let wheels = self.controls.wheels.as_ref();
        let efforts = wheels.and_then(|wheels| wheels.at(point.time_s + self.first_s));
        let efforts = efforts.unwrap_or([WheelEffort::FREE; 4]);
        let braking_n: f64 = efforts.iter().map(|effort| effort.braking_n).sum();
        let speed_m_s = point.vx_body_m_s.hypot(point.vy_body_m_s);
        let along = point.vx_body_m_s / (speed_m_s + 1e-6);
        let held_n = tires.friction * mass.mass_kg * STANDARD_GRAVITY_M_S2;
        let shifted_n =
            braking_n.min(held_n) * along * geometry.cg_height_m / geometry.wheelbase_m() / 2.0;
        let at_rest_n = self.vehicle.static_loads_n();
        let load = |wheel: Wheel| {
            let shift = if wheel.is_front() { shifted_n } else { -shifted_n };
            (at_rest_n[wheel.index()] + shift).max(0.0)
        };
        Wheel::ALL.map(load)
    }
}

const COLUMNS: [Channel; 6] =
    [Channel::X, Channel::Y, Channel::Yaw, Channel::Vx, Channel::Vy, Channel::YawRate];
const LOADS: [Channel; 4] = [Channel::FzFl, Channel::FzFr, Channel::FzRl, Channel::FzRr];
