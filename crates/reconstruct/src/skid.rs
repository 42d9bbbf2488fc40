//! The speed of a car before a skid that ended at the first contact.
//!
//! ```text
//! v₀² = v₁² + 2 a s        a = g (f + G)/√(1 + G²)
//! f   = μ (c_f l_r + c_r l_f)/(l_f + l_r − μ h (c_f − c_r))
//! ```
//!
//! v₁: speed at first contact; G: grade uphill; μ: drag factor of locked wheels on this road; c_f, c_r:
//! share of the wheels of each axle that are locked, while the others roll freely; h: height of the CG. With
//! four locked wheels f = μ. Where the other wheels were braked, v₀ was higher.
//!
//! Source: [`Brach2011`](impactlab_core::bibliography::Brach2011), braking on a grade.

use crate::evidence::{Evidence, SkidBefore};
use crate::{ForwardModel, Latent, LatentValues};
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::VehicleParameters;

/// A skid with the quantities of a particle that it depends on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Skid {
    locked_shares: [f64; 2],
    grade: Option<f64>,
    length: Latent,
    drag: Latent,
}

impl Skid {
    /// The skids of the struck and of the striking car.
    pub(crate) fn of_both_cars(evidence: &Evidence) -> [Option<Self>; 2] {
        let skid = |skid: &Option<SkidBefore>, length, drag| {
            let skid = skid.as_ref()?;
            let (locked_shares, grade) = (skid.locked_shares(), skid.grade);
            Some(Self { locked_shares, grade, length, drag })
        };
        [
            skid(&evidence.skid_before, Latent::SkidLength, Latent::SkidDrag),
            skid(
                &evidence.striking_skid_before,
                Latent::StrikingSkidLength,
                Latent::StrikingSkidDrag,
            ),
        ]
    }

    /// Speed at the start of the skid, m/s.
    ///
    /// - `speed_m_s`: at its end;
    /// - `course_rad`: direction in which the car moves, world axes, rad;
    /// - `locked_drag`: drag factor of locked wheels of this car.
    fn speed_before_m_s(
        &self,
        speed_m_s: f64,
        course_rad: f64,
        car: &VehicleParameters,
        (locked_drag, values): (f64, &LatentValues),
    ) -> f64 {
        let stated = values.get(self.drag);
        let drag = match stated.is_nan() {
            true => drag_of_locked(self.locked_shares, locked_drag, car),
            false => stated,
        };
        let grade = self.grade.unwrap_or_else(|| car.slope.along(course_rad));
        let deceleration_m_s2 =
            STANDARD_GRAVITY_M_S2 * (drag + grade) / (1.0 + grade * grade).sqrt();
        let squared = speed_m_s * speed_m_s + 2.0 * deceleration_m_s2 * values.get(self.length);
        squared.max(0.0).sqrt()
    }
}

/// Deceleration over that of gravity of a car of which some wheels are locked on a level road.
fn drag_of_locked([front, rear]: [f64; 2], locked_drag: f64, car: &VehicleParameters) -> f64 {
    let geometry = &car.geometry;
    let held_m = front * geometry.cg_to_rear_axle_m + rear * geometry.cg_to_front_axle_m;
    let shifted_m = locked_drag * geometry.cg_height_m * (front - rear);
    locked_drag * held_m / (geometry.wheelbase_m() - shifted_m)
}

impl ForwardModel {
    /// Speeds of the struck and of the striking car before their skids, m/s; `None` of a car without one.
    ///
    /// - `speeds_m_s`: at first contact;
    /// - `striking_course_rad`: direction in which the striking car moves, world axes, rad.
    pub(crate) fn speeds_before_skid_m_s(
        &self,
        values: &LatentValues,
        speeds_m_s: [f64; 2],
        striking_course_rad: f64,
    ) -> [Option<f64>; 2] {
        let cars = [&self.cars.struck, &self.cars.striking];
        let drags = [values.locked_drag(), values.striking_locked_drag()];
        let courses_rad = [0.0, striking_course_rad];
        std::array::from_fn(|i| {
            let car = &cars[i].parameters;
            let of_particle = (drags[i], values);
            let skid = self.skids[i].as_ref()?;
            Some(skid.speed_before_m_s(speeds_m_s[i], courses_rad[i], car, of_particle))
        })
    }
}

#[cfg(test)]
#[path = "skid_tests.rs"]
mod tests;
