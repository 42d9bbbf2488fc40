//! The start of the motion of a single car: where it is at time 0, and how it moves there.
//!
//! ```text
//! x_CG = x − R(ψ) ρ        ψ = χ − β where the heading is not stated
//! ```
//!
//! x: where the earliest mark begins, ρ: its wheel from the CG; or a stated place, and ρ = 0. χ: course, β:
//! sideslip angle.
//!
//! Braking before the start, where there are no marks, tells the speed at which it began:
//!
//! ```text
//! v₀ = v + a t        a = g (p μ + G)/√(1 + G²)
//! ```
//!
//! v: speed at the start, t: how long the driver braked before, p: share of the friction, μ: peak friction of the
//! tires along their planes, G: grade uphill along χ.
//!
//! Source: [`Brach2011`](impactlab_core::bibliography::Brach2011), braking on a grade.

use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::VehicleState;

use crate::evidence::{Evidence, Mark};
use crate::{Cars, ForwardModel, Latent, LatentValues};

/// Standard deviation of the course by the first piece of a mark, rad: a car that turns, and points that are
/// measured from each other. Assumed.
const COURSE_BY_MARK_RAD: f64 = 0.15;

/// That of the course by the way to rest, rad. Assumed.
const COURSE_BY_REST_RAD: f64 = 0.4;

/// Length by which the first point of a mark is told from the next, m.
const LEAST_PIECE_M: f64 = 1e-6;

/// Where a single car is at the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StartPlace {
    /// Point of the car whose place is known, from its CG in its axes, m.
    arm_m: [f64; 2],
    /// Its place, m.
    pub place_m: [f64; 2],
    /// Standard deviation of it along each axis, m.
    pub sigma_m: f64,
    /// Direction of motion, rad.
    pub course_rad: f64,
    /// Standard deviation of it, rad.
    pub course_sigma_rad: f64,
}

impl StartPlace {
    /// The start of a single car; `None` for a collision.
    pub fn of(evidence: &Evidence, cars: &Cars) -> Option<Self> {
        evidence.is_single_car().then(|| Self::by_evidence(evidence, cars))
    }

    fn by_evidence(evidence: &Evidence, cars: &Cars) -> Self {
        let by_mark = Self::by_earliest_mark(&evidence.marks, cars);
        let start = &evidence.start;
        let sigma_m = start.position_sigma_m();
        let Some(place_m) = start.place_m() else {
            return match by_mark {
                Some(mark) => Self { sigma_m: sigma_m.hypot(mark.sigma_m), ..mark },
                // The form is not filled in yet.
                None => Self::at([0.0; 2], sigma_m, evidence),
            };
        };
        let stated = Self::at(place_m, sigma_m, evidence);
        match by_mark {
            Some(mark) => {
                let (course_rad, course_sigma_rad) = (mark.course_rad, mark.course_sigma_rad);
                Self { course_rad, course_sigma_rad, ..stated }
            }
            None => stated,
        }
    }

    /// A stated place of the CG, from which the car moves towards where it came to rest.
    fn at(place_m: [f64; 2], sigma_m: f64, evidence: &Evidence) -> Self {
        let rest_m = evidence.rest.and_then(|rest| rest.place_m());
        let [x_m, y_m] = rest_m.map_or([1.0, 0.0], |at| [at[0] - place_m[0], at[1] - place_m[1]]);
        let (course_rad, course_sigma_rad) = (y_m.atan2(x_m), COURSE_BY_REST_RAD);
        Self { arm_m: [0.0; 2], place_m, sigma_m, course_rad, course_sigma_rad }
    }

    /// The start of the mark with which the car is farthest back: front and rear wheels that lock together
    /// begin their marks at one place of the car.
    fn by_earliest_mark(marks: &[Mark], cars: &Cars) -> Option<Self> {
        let is_before = |a: &Self, b: &Self| {
            let ([a_x, a_y], [b_x, b_y]) = (a.cg_m(), b.cg_m());
            let (sin, cos) = b.course_rad.sin_cos();
            (a_x - b_x) * cos + (a_y - b_y) * sin < 0.0
        };
        let starts = marks.iter().filter_map(|mark| Self::by_mark(mark, cars));
        starts.reduce(|earliest, next| if is_before(&next, &earliest) { next } else { earliest })
    }

    fn by_mark(mark: &Mark, cars: &Cars) -> Option<Self> {
        let place_m = *mark.points_m.first()?;
        let mut ahead = mark.points_m.iter().map(|[x, y]| [x - place_m[0], y - place_m[1]]);
        let [x_m, y_m] = ahead.find(|[x, y]| x.hypot(*y) > LEAST_PIECE_M)?;
        Some(Self {
            arm_m: cars.struck.parameters.geometry.wheel_place_m(mark.wheel),
            place_m,
            sigma_m: mark.sigma_m(),
            course_rad: y_m.atan2(x_m),
            course_sigma_rad: COURSE_BY_MARK_RAD,
        })
    }

    /// Place of the CG of a car that moves along its heading, m.
    pub fn cg_m(&self) -> [f64; 2] {
        self.cg_of(self.place_m, self.course_rad)
    }

    fn cg_of(&self, [x_m, y_m]: [f64; 2], heading_rad: f64) -> [f64; 2] {
        let (sin, cos) = heading_rad.sin_cos();
        let [along_m, across_m] = self.arm_m;
        [x_m - along_m * cos + across_m * sin, y_m - along_m * sin - across_m * cos]
    }

    /// The state of the car of a particle.
    pub fn state(&self, values: &LatentValues) -> VehicleState<f64> {
        let (speed_m_s, sideslip_rad) =
            (values.get(Latent::CarSpeed), values.get(Latent::CarSideslip));
        let stated_rad = values.get(Latent::StartHeading);
        let yaw_rad = match stated_rad.is_nan() {
            true => values.get(Latent::StartCourse) - sideslip_rad,
            false => stated_rad,
        };
        let place_m = [values.get(Latent::StartX), values.get(Latent::StartY)];
        let [x_m, y_m] = self.cg_of(place_m, yaw_rad);
        VehicleState {
            vx_body_m_s: speed_m_s * sideslip_rad.cos(),
            vy_body_m_s: speed_m_s * sideslip_rad.sin(),
            yaw_rad,
            yaw_rate_rad_s: values.get(Latent::CarYawRate),
            x_m,
            y_m,
            ..VehicleState::default()
        }
    }
}

/// Direction in which the car of a particle moves at the start, rad.
fn course_rad(values: &LatentValues) -> f64 {
    let heading_rad = values.get(Latent::StartHeading);
    match heading_rad.is_nan() {
        true => values.get(Latent::StartCourse),
        false => heading_rad + values.get(Latent::CarSideslip),
    }
}

impl ForwardModel {
    /// Speed at which the single car of a particle began to brake, m/s; NaN where nothing is said of braking
    /// before the start.
    pub(crate) fn speed_before_braking_m_s(&self, values: &LatentValues) -> f64 {
        let [friction, tires, along] =
            [Latent::RoadFriction, Latent::TireFrictionFactor, Latent::LongitudinalFrictionRatio]
                .map(|latent| values.get(latent));
        let drag = values.get(Latent::BrakedBeforeShare) * friction * tires * along;
        let grade = self.cars.struck.parameters.slope.along(course_rad(values));
        let deceleration_m_s2 =
            STANDARD_GRAVITY_M_S2 * (drag + grade) / (1.0 + grade * grade).sqrt();
        values.get(Latent::CarSpeed) + deceleration_m_s2 * values.get(Latent::BrakedBefore)
    }
}

#[cfg(test)]
#[path = "single_car_tests.rs"]
mod tests;
