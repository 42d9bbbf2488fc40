//! How a vehicle that is struck in a side is approached, in the words of a driver: from where on its
//! side, how much faster, and how fast across.

use crate::collision::{ContactLocation, Scenario, ScenarioGeometry, Side};
use crate::vehicle::TurnSide;

/// Distance from the middle line of the striking vehicle within which a contact lies on neither side, m.
const MIDDLE_M: f64 = 1e-6;

/// The approach to a vehicle that is struck in its left or right side, in axes along its heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideApproach {
    /// Distance of the contact ahead of the rear end of the struck vehicle, m.
    pub ahead_of_rear_m: f64,
    /// By how much the striking vehicle is faster along the heading of the struck one, m/s.
    pub faster_m_s: f64,
    /// Speed of the striking vehicle across that heading, relative to the struck one and towards it, m/s.
    pub closing_m_s: f64,
}

impl ScenarioGeometry {
    /// The side of the striking vehicle on which it touches the other one; `None` for a contact on its middle
    /// line.
    pub fn side_of_struck(&self) -> Option<TurnSide> {
        let [_, left_m] = self.striking.body_from_world(self.contact_point_world_m);
        match left_m {
            _ if left_m.abs() < MIDDLE_M => None,
            _ if left_m > 0.0 => Some(TurnSide::Left),
            _ => Some(TurnSide::Right),
        }
    }
}

impl Scenario {
    /// The approach; `None` where the contact is not given by a side, or the striking object does not move.
    pub fn side_approach(&self) -> Option<SideApproach> {
        let (towards, offset_m) = self.struck_from_beside()?;
        let [along, across] = self.velocity_beside_m_s();
        Some(SideApproach {
            ahead_of_rear_m: self.struck.length_m / 2.0 + offset_m,
            faster_m_s: along,
            closing_m_s: towards * across,
        })
    }

    /// Moves the contact and the striking vehicle, whose heading stays, to an approach. Does nothing where
    /// there is none.
    pub fn approach_beside(&mut self, approach: SideApproach) {
        let Some((towards, _)) = self.struck_from_beside() else { return };
        if let ContactLocation::Side { offset_m, .. } = &mut self.contact.location {
            *offset_m = approach.ahead_of_rear_m - self.struck.length_m / 2.0;
        }
        let (sin, cos) = self.struck.heading_rad.sin_cos();
        let [along, across] = [approach.faster_m_s, towards * approach.closing_m_s];
        self.striking.vx_world_m_s = self.struck.vx_world_m_s + along * cos - across * sin;
        self.striking.vy_world_m_s = self.struck.vy_world_m_s + along * sin + across * cos;
    }

    /// 1 if a vehicle strikes the right side of the struck one, so that it moves to the latter's left, −1 if it
    /// strikes the left side, and the contact's offset from the middle of the side, m; `None` if neither.
    pub fn struck_from_beside(&self) -> Option<(f64, f64)> {
        match self.contact.location {
            _ if self.striking.fixed.is_some() => None,
            ContactLocation::Side { side: Side::Right, offset_m } => Some((1.0, offset_m)),
            ContactLocation::Side { side: Side::Left, offset_m } => Some((-1.0, offset_m)),
            _ => None,
        }
    }

    /// Velocity of the striking vehicle relative to the struck one, along and to the left of the latter's
    /// heading, m/s.
    fn velocity_beside_m_s(&self) -> [f64; 2] {
        let (sin, cos) = self.struck.heading_rad.sin_cos();
        let x = self.striking.vx_world_m_s - self.struck.vx_world_m_s;
        let y = self.striking.vy_world_m_s - self.struck.vy_world_m_s;
        [x * cos + y * sin, y * cos - x * sin]
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn an_approach_is_read_back_whatever_the_heading_and_the_side() {
        let approach = SideApproach { ahead_of_rear_m: 1.1, faster_m_s: 2.0, closing_m_s: 3.0 };
        for (side, towards) in [(Side::Right, 1.0), (Side::Left, -1.0)] {
            let mut scenario = Scenario::example();
            scenario.struck.heading_rad = 0.7;
            scenario.contact.location = ContactLocation::Side { side, offset_m: 0.0 };
            scenario.approach_beside(approach);
            let got = scenario.side_approach().unwrap();
            assert_relative_eq!(got.ahead_of_rear_m, 1.1, epsilon = 1e-12);
            assert_relative_eq!(got.faster_m_s, 2.0, epsilon = 1e-12);
            assert_relative_eq!(got.closing_m_s, 3.0, epsilon = 1e-12);
            let ContactLocation::Side { offset_m, .. } = scenario.contact.location else {
                unreachable!("a side was set");
            };
            assert_relative_eq!(offset_m, 1.1 - scenario.struck.length_m / 2.0);
            // From the right it moves to the left of the struck vehicle's heading.
            let left = [-f64::sin(0.7), f64::cos(0.7)];
            let relative = [
                scenario.striking.vx_world_m_s - scenario.struck.vx_world_m_s,
                scenario.striking.vy_world_m_s - scenario.struck.vy_world_m_s,
            ];
            let across = relative[0] * left[0] + relative[1] * left[1];
            assert_relative_eq!(across, 3.0 * towards, epsilon = 1e-12);
        }
    }

    #[test]
    fn the_other_car_is_where_it_is_touched_whatever_the_frame_and_the_mirror() {
        for turn_rad in [0.0, 0.8, -2.5] {
            for (side, mirror) in [(Side::Right, 1.0), (Side::Left, -1.0)] {
                for (between_deg, expected) in [(18.0, 1.0), (-8.0, 1.0), (165.0, -1.0)] {
                    let mut scenario = Scenario::example();
                    scenario.struck.heading_rad = turn_rad;
                    scenario.striking.heading_rad =
                        turn_rad + mirror * f64::to_radians(between_deg);
                    scenario.contact.location = ContactLocation::Side { side, offset_m: -0.4 };
                    let found = scenario.geometry().unwrap().side_of_struck().unwrap();
                    assert_eq!(
                        found.sign(),
                        mirror * expected,
                        "{turn_rad} {side:?} {between_deg}"
                    );
                }
            }
        }
        let mut head_on = Scenario::example();
        head_on.striking.heading_rad = std::f64::consts::FRAC_PI_2;
        assert_eq!(head_on.geometry().unwrap().side_of_struck(), None, "flush with the flank");
    }

    #[test]
    fn only_a_blow_into_a_side_has_an_approach() {
        let mut scenario = Scenario::example();
        scenario.contact.location = ContactLocation::Side { side: Side::Rear, offset_m: 0.0 };
        assert_eq!(scenario.side_approach(), None);
        let before = scenario.clone();
        scenario.approach_beside(SideApproach {
            ahead_of_rear_m: 0.0,
            faster_m_s: 0.0,
            closing_m_s: 0.0,
        });
        assert_eq!(scenario, before);
    }
}
