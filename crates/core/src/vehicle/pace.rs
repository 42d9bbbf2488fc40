//! How fast a vehicle moves and turns along a motion that is known at equal steps, and since when it
//! is at rest.

use crate::vehicle::{REST_DURATION_S, REST_SPEED_M_S, REST_YAW_RATE_RAD_S, VehicleState};

/// How fast a vehicle moves and turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Speed of the CG, m/s.
    pub speed_m_s: f64,
    /// Size of the yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
}

impl Pace {
    /// Means over several paths at each instant; the mean of the velocities themselves would be zero
    /// where two paths turn to opposite sides.
    pub fn mean_of(paths: &[Vec<VehicleState<f64>>]) -> Vec<Self> {
        let n_instants = paths.first().map_or(0, Vec::len);
        let at = |i: usize| {
            let states = || paths.iter().filter_map(move |path| path.get(i));
            let mean = |quantity: fn(&VehicleState<f64>) -> f64| {
                states().map(quantity).sum::<f64>() / paths.len() as f64
            };
            Self {
                speed_m_s: mean(|state| state.vx_body_m_s.hypot(state.vy_body_m_s)),
                yaw_rate_rad_s: mean(|state| state.yaw_rate_rad_s.abs()),
            }
        };
        (0..n_instants).map(at).collect()
    }

    fn is_below_limits(self) -> bool {
        self.speed_m_s < REST_SPEED_M_S && self.yaw_rate_rad_s < REST_YAW_RATE_RAD_S
    }
}

/// The first instant after the end of the force from which on speed and yaw rate stay below their
/// limits; `None` if they do not to the end of the motion.
///
/// - `motion`: every `step_s` from t = 0;
/// - `force_end_s`: end of the last contact.
pub fn rest_instant(motion: &[Pace], step_s: f64, force_end_s: f64) -> Option<usize> {
    let first = motion.iter().rposition(|pace| !pace.is_below_limits()).map_or(0, |last| last + 1);
    let released = (force_end_s / step_s).ceil().max(0.0) as usize;
    let rest = first.max(released);
    let n_held = (REST_DURATION_S / step_s).round() as usize;
    (rest + n_held < motion.len()).then_some(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 0.01;

    fn motion(speed_and_yaw_rate: impl Fn(f64) -> [f64; 2]) -> Vec<Pace> {
        let at = |i: i32| {
            let [speed_m_s, yaw_rate_rad_s] = speed_and_yaw_rate(f64::from(i) * STEP_S);
            Pace { speed_m_s, yaw_rate_rad_s }
        };
        (0..=400).map(at).collect()
    }

    #[test]
    fn a_parked_car_that_is_struck_is_not_at_rest_before_it_has_stopped() {
        let struck = motion(|t| [if t < 0.05 { 0.0 } else { (5.0 - 2.0 * t).max(0.0) }, 0.0]);
        let rest = rest_instant(&struck, STEP_S, 0.1).unwrap();
        assert!((247..=249).contains(&rest), "{rest}");
    }

    #[test]
    fn a_car_that_nothing_has_pushed_yet_or_that_turns_on_the_spot_is_not_at_rest() {
        assert_eq!(rest_instant(&motion(|_| [0.0, 0.0]), STEP_S, 3.0), Some(300));
        assert_eq!(rest_instant(&motion(|_| [0.0, 0.5]), STEP_S, 0.1), None);
        assert_eq!(rest_instant(&motion(|_| [0.0, 0.0]), STEP_S, 5.0), None);
    }

    #[test]
    fn a_moment_of_standstill_is_not_rest() {
        let swings = motion(|t| [(2.0 * (t - 2.0)).abs(), 0.0]);
        assert_eq!(rest_instant(&swings, STEP_S, 0.1), None);
        let at_the_very_end = motion(|t| [5.0 * (4.0 - t), 0.0]);
        assert_eq!(rest_instant(&at_the_very_end, STEP_S, 0.1), None);
    }

    #[test]
    fn opposite_turns_do_not_cancel() {
        let path = |sign: f64| {
            let state = VehicleState {
                vy_body_m_s: 3.0 * sign,
                yaw_rate_rad_s: sign,
                ..VehicleState::default()
            };
            vec![state; 401]
        };
        let pace = Pace::mean_of(&[path(1.0), path(-1.0)]);
        assert_eq!(pace[7], Pace { speed_m_s: 3.0, yaw_rate_rad_s: 1.0 });
        assert_eq!(rest_instant(&pace, STEP_S, 0.1), None);
    }
}
