//! A skid of a vehicle of a scenario that ends at the first contact.
//!
//! ```text
//! v₀² = v₁² + 2 a s        a = g (f + G)/√(1 + G²)        t = 2 s/(v₀ + v₁)
//! ```
//!
//! G: grade in the direction of travel, positive uphill.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::collision::{Role, Scenario};
use crate::ranges::{ROAD_FRICTION, Range, SKID_LENGTH};
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::RoadSlope;

/// A skid of a vehicle that ends at the first contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScenarioSkid {
    /// Distance over which the vehicle skids, m, 0.1 to 500.
    pub length_m: f64,
    /// Deceleration on a level road over that of gravity, 0.01 to 2.
    pub drag_factor: f64,
}

/// A vehicle before its skid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeforeSkid {
    /// The skid.
    pub skid: ScenarioSkid,
    /// Speed at its start, m/s.
    pub speed_m_s: f64,
    /// How long it lasts, s.
    pub duration_s: f64,
}

impl ScenarioSkid {
    /// Both numbers with their names and ranges.
    pub(super) fn ranges(&self) -> [(&'static str, f64, Range); 2] {
        [
            ("skid_length_m", self.length_m, SKID_LENGTH),
            ("skid_drag_factor", self.drag_factor, ROAD_FRICTION),
        ]
    }

    /// Change of the square of the speed over the skid, m²/s².
    fn lost_m2_s2(&self, grade: f64) -> f64 {
        let deceleration_m_s2 =
            STANDARD_GRAVITY_M_S2 * (self.drag_factor + grade) / (1.0 + grade * grade).sqrt();
        2.0 * deceleration_m_s2 * self.length_m
    }

    /// Speed at the end of the skid, m/s; `None` if the vehicle stops before.
    ///
    /// - `grade`: in the direction of travel, positive uphill.
    pub(super) fn speed_after_m_s(&self, before_m_s: f64, grade: f64) -> Option<f64> {
        let squared = before_m_s * before_m_s - self.lost_m2_s2(grade);
        (squared > 0.0).then(|| squared.sqrt())
    }

    /// The vehicle at the start of the skid.
    fn before(&self, speed_m_s: f64, grade: f64) -> BeforeSkid {
        let before_m_s = (speed_m_s * speed_m_s + self.lost_m2_s2(grade)).max(0.0).sqrt();
        let duration_s = 2.0 * self.length_m / (before_m_s + speed_m_s);
        BeforeSkid { skid: *self, speed_m_s: before_m_s, duration_s }
    }
}

impl Scenario {
    /// A vehicle before the skid that ends at the first contact; `None` without one.
    ///
    /// - `slope`: of the road.
    pub fn before_skid(&self, role: Role, slope: &RoadSlope) -> Option<BeforeSkid> {
        let vehicle = self.vehicle(role);
        let [vx, vy] = [vehicle.vx_world_m_s, vehicle.vy_world_m_s];
        let speed_m_s = vx.hypot(vy);
        let course_rad = if speed_m_s > 0.0 { vy.atan2(vx) } else { vehicle.heading_rad };
        Some(vehicle.skid?.before(speed_m_s, slope.along(course_rad)))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::data::TomlError;

    const PIT: &str = include_str!("../../../../assets/scenarios/pit_right_rear.toml");

    fn read(speed: &str, road: &str) -> Result<Scenario, TomlError> {
        let text = PIT.replacen("speed_km_h = 54", speed, 1) + road;
        Scenario::from_toml(&text, Path::new("s.toml"))
    }

    /// `v² = 2 a s`, both ways.
    #[test]
    fn the_speed_at_the_contact_follows_from_that_before_the_skid_and_back() {
        let skid = "\nskid_length_m = 20\nskid_drag_factor = 0.7";
        for (road, grade) in [("", 0.0), ("\n[road]\ngrade = 0.05\n", 0.05)] {
            let scenario = read(&format!("speed_before_skid_m_s = 25{skid}"), road).unwrap();
            let at_m_s = scenario.struck.vx_world_m_s;
            let lost = 2.0 * STANDARD_GRAVITY_M_S2 * (0.7 + grade) * 20.0 / f64::hypot(1.0, grade);
            assert!((at_m_s * at_m_s - (625.0 - lost)).abs() < 1e-9, "{at_m_s}");
            let slope = scenario.road.unwrap_or_default();
            let before = scenario.before_skid(Role::Struck, &slope).unwrap();
            assert!((before.speed_m_s - 25.0).abs() < 1e-9, "{before:?}");
            let mean_m_s = (25.0 + at_m_s) / 2.0;
            assert!((before.duration_s - 20.0 / mean_m_s).abs() < 1e-9, "{before:?}");
            assert_eq!(scenario.before_skid(Role::Striking, &slope), None);
            let text = scenario.to_toml();
            assert_eq!(
                Scenario::from_toml(&text, Path::new("s.toml")).unwrap(),
                scenario,
                "{text}"
            );
        }
    }

    #[test]
    fn half_a_skid_and_one_that_ends_before_the_contact_are_refused() {
        let refused = |speed: &str| read(speed, "").unwrap_err().to_string();
        for (speed, expected) in [
            ("speed_m_s = 15\nskid_length_m = 20", "target.skid_drag_factor is missing"),
            ("speed_m_s = 15\nskid_drag_factor = 0.7", "target.skid_length_m is missing"),
            (
                "speed_before_skid_m_s = 10\nskid_length_m = 20\nskid_drag_factor = 0.7",
                "target.speed_before_skid_m_s is 10, expected a speed with which",
            ),
            (
                "speed_m_s = 9\nspeed_before_skid_m_s = 25\nskid_length_m = 2\nskid_drag_factor = 0.7",
                "say the same thing",
            ),
            ("speed_m_s = 9\nspeed_before_skid_m_s = 25", "is not known here"),
        ] {
            let error = refused(speed);
            assert!(error.contains(expected), "{speed}: {error}");
        }
    }
}
