//! What a force model knows of a collision before it happens, θ, and its canonical form.
//!
//! Two symmetries hold: a mirrored scenario has the mirrored force, and a common velocity of both
//! vehicles changes nothing (the tyres play no part during contact).

use serde::{Deserialize, Serialize};

use crate::collision::{Scenario, ScenarioError};
use crate::data::{Case, DataError, ForceAttributes, Side, Value};
use crate::numerics::wrap_angle_rad;

/// Two vehicles at first contact. World axes with X along the target's heading; neither turns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForceScenario {
    /// Masses of target and bullet, kg.
    pub mass_kg: [f64; 2],
    /// Velocity `[x, y]` of the target's CG, m/s.
    pub target_velocity_m_s: [f64; 2],
    /// Velocity `[x, y]` of the bullet's CG, m/s.
    pub bullet_velocity_m_s: [f64; 2],
    /// Heading of the bullet against the target's, rad, −π to π.
    pub theta_b_rad: f64,
    /// The struck side of the target.
    pub side: Side,
    /// First contact `[x, y]` in the target's body axes from its CG, m, where it is known.
    pub contact_m: Option<[f64; 2]>,
    /// The bullet's CG `[x, y]` from the target's CG, m, where it is known.
    pub bullet_position_m: Option<[f64; 2]>,
    /// Kind of bullet body, where it is known.
    pub bullet_body: Option<String>,
    /// Yaw inertias of target and bullet, kg m², where they are known.
    pub yaw_inertia_kg_m2: [Option<f64>; 2],
}

impl ForceScenario {
    /// Of a case of a force data set.
    ///
    /// # Errors
    /// [`DataError`] at a column that is needed.
    pub fn from_case(case: &Case) -> Result<Self, DataError> {
        let attributes = ForceAttributes::read(&case.attributes)?;
        let number = |name| case.attributes.number(name);
        let position = number("bullet_x0_m").zip(number("bullet_y0_m"));
        let bullet_body = case.attributes.get("bullet_body").map(|value| match value {
            Value::Text(text) => text.clone(),
            Value::Number(number) => number.to_string(),
        });
        let bullet_position_m = position.map(|(x, y)| [x, y]);
        Ok(Self { bullet_position_m, bullet_body, ..Self::from_attributes(&attributes) })
    }

    /// Of the attributes of a case; neither the bullet's position nor its body is among them.
    pub fn from_attributes(attributes: &ForceAttributes) -> Self {
        let [_, contact_y_m] = attributes.contact_m;
        let theta = attributes.theta_b_rad;
        let approach = attributes.bullet_velocity_m_s[1] - attributes.target_velocity_m_s[1];
        let side = || struck_side(Some(contact_y_m), theta, approach);
        Self {
            mass_kg: attributes.mass_kg,
            target_velocity_m_s: attributes.target_velocity_m_s,
            bullet_velocity_m_s: attributes.bullet_velocity_m_s,
            theta_b_rad: theta,
            side: attributes.side.unwrap_or_else(side),
            contact_m: Some(attributes.contact_m),
            bullet_position_m: None,
            bullet_body: None,
            yaw_inertia_kg_m2: attributes.yaw_inertia_kg_m2,
        }
    }

    /// Of a scenario, turned so that the target heads along X. Yaw rates before the contact are
    /// left out: no force model here knows them.
    ///
    /// # Errors
    /// [`ScenarioError`] if the vehicles do not meet.
    pub fn from_scenario(scenario: &Scenario) -> Result<Self, ScenarioError> {
        let geometry = scenario.geometry()?;
        let (target, bullet) = (&scenario.target, &scenario.bullet);
        let (sin, cos) = target.heading_rad.sin_cos();
        let turned = |[x, y]: [f64; 2]| [x * cos + y * sin, y * cos - x * sin];
        let target_velocity_m_s = turned([target.vx_m_s, target.vy_m_s]);
        let bullet_velocity_m_s = turned([bullet.vx_m_s, bullet.vy_m_s]);
        let contact_m = geometry.target.body_from_world(geometry.contact_point_m);
        let theta_b_rad = wrap_angle_rad(bullet.heading_rad - target.heading_rad);
        let approach = bullet_velocity_m_s[1] - target_velocity_m_s[1];
        Ok(Self {
            mass_kg: [target.mass_kg, bullet.mass_kg],
            target_velocity_m_s,
            bullet_velocity_m_s,
            theta_b_rad,
            side: struck_side(Some(contact_m[1]), theta_b_rad, approach),
            contact_m: Some(contact_m),
            bullet_position_m: Some(
                geometry.target.body_from_world([geometry.bullet.x_m, geometry.bullet.y_m]),
            ),
            bullet_body: None,
            yaw_inertia_kg_m2: [Some(target.yaw_inertia_kg_m2), Some(bullet.yaw_inertia_kg_m2)],
        })
    }

    /// Velocity of the bullet relative to the target `v_b − v_t`, m/s.
    pub fn relative_velocity_m_s(&self) -> [f64; 2] {
        [0, 1].map(|i| self.bullet_velocity_m_s[i] - self.target_velocity_m_s[i])
    }

    /// The mirror image left to right.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mirror = |[x, y]: [f64; 2]| [x, -y];
        Self {
            target_velocity_m_s: mirror(self.target_velocity_m_s),
            bullet_velocity_m_s: mirror(self.bullet_velocity_m_s),
            theta_b_rad: -self.theta_b_rad,
            side: match self.side {
                Side::Left => Side::Right,
                Side::Right => Side::Left,
            },
            contact_m: self.contact_m.map(mirror),
            bullet_position_m: self.bullet_position_m.map(mirror),
            ..self.clone()
        }
    }

    /// The one of all equivalent scenarios that models see: the bullet on the target's right (so
    /// that it mostly pushes along +y), the target at rest; and whether it was mirrored for that.
    #[must_use]
    pub fn canonical(&self) -> (Self, bool) {
        let mirrored = self.side == Side::Left;
        let right = if mirrored { self.mirrored() } else { self.clone() };
        let bullet_velocity_m_s = right.relative_velocity_m_s();
        (Self { target_velocity_m_s: [0.0; 2], bullet_velocity_m_s, ..right }, mirrored)
    }
}

/// The struck side where no attribute tells: that of the contact, else the one from which the bullet
/// heads towards the target, else the one from which it moves.
///
/// - `approach_m_s`: lateral velocity of the bullet relative to the target.
fn struck_side(contact_y_m: Option<f64>, theta_b_rad: f64, approach_m_s: f64) -> Side {
    let signs = [contact_y_m.unwrap_or(0.0), -theta_b_rad, -approach_m_s];
    match signs.into_iter().find(|sign| *sign != 0.0) {
        Some(sign) if sign > 0.0 => Side::Left,
        _ => Side::Right,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::collision::ContactLocation;

    pub(crate) fn example(side: Side) -> ForceScenario {
        let right = ForceScenario {
            mass_kg: [2000.0, 1500.0],
            target_velocity_m_s: [15.0, 0.25],
            bullet_velocity_m_s: [16.0, 3.5],
            theta_b_rad: 0.5,
            side: Side::Right,
            contact_m: Some([-1.5, -0.925]),
            bullet_position_m: Some([-2.75, -2.5]),
            bullet_body: Some("A".to_owned()),
            yaw_inertia_kg_m2: [Some(3600.0), None],
        };
        if side == Side::Right { right } else { right.mirrored() }
    }

    #[test]
    fn mirrored_twice_is_the_same() {
        for side in [Side::Left, Side::Right] {
            let scenario = example(side);
            assert_eq!(scenario.mirrored().mirrored(), scenario);
            assert_ne!(scenario.mirrored(), scenario);
        }
    }

    #[test]
    fn mirror_images_and_moving_observers_share_one_canonical_form() {
        let (canonical, mirrored) = example(Side::Right).canonical();
        assert!(!mirrored);
        assert_eq!(canonical.relative_velocity_m_s(), [1.0, 3.25]);
        assert_eq!(example(Side::Left).canonical(), (canonical.clone(), true));
        assert_eq!(canonical.canonical(), (canonical.clone(), false));
        let mut faster = example(Side::Right);
        for velocity in [&mut faster.target_velocity_m_s, &mut faster.bullet_velocity_m_s] {
            *velocity = [velocity[0] + 8.0, velocity[1] - 0.5];
        }
        assert_eq!(faster.canonical().0, canonical);
    }

    #[test]
    fn the_side_follows_from_contact_heading_and_motion() {
        for (contact_y_m, theta_b_rad, approach_m_s, side) in [
            (Some(-0.9), -0.3, -1.0, Side::Right),
            (Some(0.9), 0.3, 1.0, Side::Left),
            (None, 0.3, -1.0, Side::Right),
            (None, -0.3, 1.0, Side::Left),
            (None, 0.0, 1.0, Side::Right),
            (None, 0.0, -1.0, Side::Left),
            (None, 0.0, 0.0, Side::Right),
        ] {
            let got = struck_side(contact_y_m, theta_b_rad, approach_m_s);
            assert_eq!(got, side, "{contact_y_m:?} {theta_b_rad} {approach_m_s}");
        }
    }

    #[test]
    fn a_scenario_is_seen_from_the_target() {
        let scenario = Scenario::example();
        let seen = ForceScenario::from_scenario(&scenario).unwrap();
        assert_eq!(seen.side, Side::Right);
        assert!(seen.contact_m.unwrap()[0] < -1.0, "{seen:?}");
        // Turn the whole scene by a quarter: nothing changes.
        let mut turned = scenario;
        let turn = |[x, y]: [f64; 2]| [-y, x];
        [turned.target_x_m, turned.target_y_m] = turn([turned.target_x_m, turned.target_y_m]);
        for vehicle in [&mut turned.target, &mut turned.bullet] {
            vehicle.heading_rad += FRAC_PI_2;
            [vehicle.vx_m_s, vehicle.vy_m_s] = turn([vehicle.vx_m_s, vehicle.vy_m_s]);
        }
        if let ContactLocation::Footprints { bullet_x_m, bullet_y_m } = &mut turned.contact.location
        {
            [*bullet_x_m, *bullet_y_m] = turn([*bullet_x_m, *bullet_y_m]);
        }
        let again = ForceScenario::from_scenario(&turned).unwrap();
        let numbers = |s: &ForceScenario| {
            let pairs = [s.target_velocity_m_s, s.bullet_velocity_m_s, s.contact_m.unwrap()];
            [pairs.concat(), s.bullet_position_m.unwrap().to_vec(), vec![s.theta_b_rad]].concat()
        };
        for (a, b) in numbers(&seen).into_iter().zip(numbers(&again)) {
            assert!((a - b).abs() < 1e-9, "{seen:?}\n{again:?}");
        }
    }
}
