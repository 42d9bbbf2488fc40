//! How far an acceleration that the equations of motion leave out may keep up the motion of a vehicle which
//! nothing drives.
//!
//! With the power P that tires and resistance take from the planar motion, looked at every h = 10 ms, the
//! work W of the acceleration over the coming interval is bounded by an account E:
//!
//! ```text
//! W ≤ E + κ P h        E' = min(E + κ P h − W, κ P T)        κ = 0.5, T = 1 s
//! ```
//!
//! So what the equations miss may halve how fast a vehicle slows down, and does not drive it. Noise, which
//! gives and takes, is hardly changed.

use crate::vehicle::frames::Heading;
use crate::vehicle::{
    N_ACCELERATION, OUTPUT_INTERVAL_S, VehicleConstants, VehicleEvaluation, VehicleState,
};

/// κ: largest share of the energy which tires and resistance take that the acceleration gives back.
const GIVEN_BACK_SHARE: f64 = 0.5;

/// T: time over which what may be given back is kept, s.
const GIVEN_BACK_TIME_S: f64 = 1.0;

/// The account of a vehicle.
#[derive(Debug, Default)]
pub(super) struct ResidualBound {
    /// Energy that the acceleration may still give to the planar motion, J.
    account_j: f64,
}

impl ResidualBound {
    /// Share of the acceleration that acts over the coming output interval.
    ///
    /// - `given_w`: power of the whole acceleration;
    /// - `taken_w`: power that tires and resistance take, 0 or more.
    pub fn share(&mut self, given_w: f64, taken_w: f64) -> f64 {
        let work_j = given_w * OUTPUT_INTERVAL_S;
        let per_time_w = GIVEN_BACK_SHARE * taken_w;
        let available_j = self.account_j + per_time_w * OUTPUT_INTERVAL_S;
        let left_j = available_j - work_j.min(available_j);
        self.account_j = left_j.min(per_time_w * GIVEN_BACK_TIME_S);
        if work_j > available_j { available_j / work_j } else { 1.0 }
    }
}

impl VehicleConstants<f64> {
    /// Power of accelerations on the planar motion, W.
    ///
    /// - `acceleration`: along and across the body, m/s², in yaw and in roll, rad/s².
    pub(super) fn planar_power_w(
        &self,
        x: &VehicleState<f64>,
        [ax, ay, yaw, _]: [f64; N_ACCELERATION],
    ) -> f64 {
        let along = x.vx_body_m_s * ax + x.vy_body_m_s * ay;
        2.0 * (self.body.half_mass_kg * along
            + self.body.half_yaw_inertia_kg_m2 * x.yaw_rate_rad_s * yaw)
    }

    /// Accelerations by tires and resistance, without the weight along a slope: of the CG along and across
    /// the body, m/s², in yaw and in roll, rad/s².
    ///
    /// - `now`: what the equations of motion say at the state, without a collision force.
    pub(super) fn acceleration_by_tires(
        &self,
        x: &VehicleState<f64>,
        now: &VehicleEvaluation<f64>,
    ) -> [f64; N_ACCELERATION] {
        let [down_x, down_y] = self.with_weight_along(Heading::new(x.yaw_rad), [0.0; 2]);
        let [ax, ay] = now.acceleration_body_m_s2;
        let VehicleState { yaw_rate_rad_s, roll_rate_rad_s, .. } = now.derivative;
        [ax - down_x, ay - down_y, yaw_rate_rad_s, roll_rate_rad_s]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::{Preset, RoadSlope, VehicleInput, VehicleParameters};

    /// Powers between 0 and 1, the same in every run.
    fn powers() -> impl Iterator<Item = f64> {
        (1..=2000_u32).map(|i| f64::from(i.wrapping_mul(2_654_435_761) >> 8) / 16_777_216.0)
    }

    #[test]
    fn what_is_given_is_at_most_half_of_what_is_taken() {
        for offset_w in [0.5, 0.0, -0.5] {
            let mut bound = ResidualBound::default();
            let [mut given_j, mut taken_j] = [0.0; 2];
            for (given, taken) in powers().zip(powers().skip(1000)) {
                let [given_w, taken_w] = [1e5 * (given - offset_w), 2e4 * taken];
                let share = bound.share(given_w, taken_w);
                assert!((0.0..=1.0).contains(&share), "{share}");
                given_j += share * given_w * OUTPUT_INTERVAL_S;
                taken_j += taken_w * OUTPUT_INTERVAL_S;
                assert!(given_j <= 0.5 * taken_j + 1e-6, "{given_j} J of {taken_j} J");
            }
        }
    }

    #[test]
    fn what_was_taken_may_be_given_again_within_a_second() {
        let mut bound = ResidualBound::default();
        for given_w in [-8e3, 8e3, -8e3, 8e3] {
            assert_eq!(bound.share(given_w, 1e4), 1.0);
        }
        let of_drive: Vec<f64> = (0..300).map(|_| bound.share(2e4, 1e4)).collect();
        assert_eq!(of_drive.last(), Some(&0.25));
        // After it has taken for long there are κ P T to be given, here for a third of a second.
        (0..1000).for_each(|_| assert_eq!(bound.share(-2e4, 1e4), 1.0));
        let n_whole = (0..300).take_while(|_| bound.share(2e4, 1e4) == 1.0).count();
        assert!((32..=34).contains(&n_whole), "{n_whole} intervals of 10 ms");
    }

    /// A share is a number for a vehicle at rest, too, whatever rounding has left on the account.
    #[test]
    fn at_rest_nothing_is_scaled() {
        for (given, taken) in powers().zip(powers().skip(1000)) {
            let mut bound = ResidualBound::default();
            bound.share(1e5 * (1.0 + given), 2e4 * taken);
            assert_eq!(bound.share(0.0, 0.0), 1.0);
            assert_eq!(bound.share(1.0, 0.0), 0.0);
        }
    }

    #[test]
    fn the_weight_along_a_slope_is_not_of_the_tires() {
        let level = Preset::Reference.parameters();
        let slope = RoadSlope { grade: 0.1, ..RoadSlope::default() };
        let steep = VehicleParameters { slope, ..level.clone() };
        let x = VehicleState { vx_body_m_s: 20.0, ..VehicleState::default() };
        let [level, steep] = [level, steep].map(|vehicle| {
            let constants = vehicle.constants();
            let now = constants.evaluate(&x, &VehicleInput::released());
            constants.planar_power_w(&x, constants.acceleration_by_tires(&x, &now))
        });
        // The wheels press by the cosine of the slope.
        assert!(level < 0.0 && (steep / level - 1.0).abs() < 0.01, "{steep} W, {level} W");
    }
}
