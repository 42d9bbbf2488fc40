//! The scenario θ of a collision, which is the input of a force model, and its canonical form.
//!
//! Two symmetries hold: a mirrored scenario has the mirrored force, and a common velocity of both
//! vehicles does not change the force, since tire forces during the contact are neglected.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::ContactLaw;
use impactlab_core::collision::{Impact, ImpactCase, Scenario, ScenarioError};
use impactlab_core::data::{Case, DataError, ForceAttributes, StruckSide, Value};
use impactlab_core::numerics::wrap_angle_rad;
use impactlab_core::ranges::{
    BODY_MASS, BODY_YAW_INERTIA, CONTACT_X, CONTACT_Y, FRICTION_LIMIT, HEADING, RESTITUTION, Range,
    SPEED, STRIKING_OFFSET, YAW_RATE,
};

/// No flank of a car is nearer to its middle line, m.
const NARROWEST_HALF_WIDTH_M: f64 = 0.65;
/// No end of a car is nearer to its CG, m.
const SHORTEST_END_M: f64 = 1.6;

/// Two vehicles at first contact, in world axes with X along the struck vehicle's heading.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForceScenario {
    /// Masses of the struck and the striking vehicle, kg.
    pub mass_kg: [f64; 2],
    /// Velocity `[x, y]` of the struck vehicle's CG, m/s.
    #[serde(rename = "target_velocity_m_s")]
    pub struck_velocity_m_s: [f64; 2],
    /// Velocity `[x, y]` of the striking vehicle's CG, m/s.
    #[serde(rename = "bullet_velocity_m_s")]
    pub striking_velocity_m_s: [f64; 2],
    /// Yaw rates of the struck and the striking vehicle before the contact, rad/s.
    #[serde(default, skip_serializing_if = "turns_not")]
    pub yaw_rate_rad_s: [f64; 2],
    /// Heading of the striking vehicle against the struck vehicle's, rad, −π to π.
    pub theta_b_rad: f64,
    /// The side on which the struck vehicle is hit.
    pub side: StruckSide,
    /// First contact `[x, y]` in the struck vehicle's body axes from its CG, m, where it is known.
    pub contact_m: Option<[f64; 2]>,
    /// Direction of the contact normal, which points into the struck vehicle, from the struck
    /// vehicle's heading, rad, −π to π, where it is known. The cases of a data set are blows
    /// against the side: π/2 on the right.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal_rad: Option<f64>,
    /// The striking vehicle's CG `[x, y]` from the struck vehicle's CG, m, where it is known.
    #[serde(rename = "bullet_position_m")]
    pub striking_position_m: Option<[f64; 2]>,
    /// Kind of body of the striking vehicle, where it is known.
    #[serde(rename = "bullet_body")]
    pub striking_body: Option<String>,
    /// Kind of body of the struck vehicle, where it is known.
    #[serde(default, rename = "target_body", skip_serializing_if = "Option::is_none")]
    pub struck_body: Option<String>,
    /// Yaw inertias of the struck and the striking vehicle, kg m², where they are known.
    pub yaw_inertia_kg_m2: [Option<f64>; 2],
    /// Restitution and friction at the contact, where they are known. The network does not use them;
    /// the momentum solution that takes over outside of what it has learned from does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_law: Option<ContactLaw>,
}

fn turns_not(yaw_rate_rad_s: &[f64; 2]) -> bool {
    *yaw_rate_rad_s == [0.0; 2]
}

impl ForceScenario {
    /// The scenario of a case of a force data set.
    ///
    /// # Errors
    /// [`DataError`] for a required column that is missing or wrong.
    pub fn from_case(case: &Case) -> Result<Self, DataError> {
        let attributes = ForceAttributes::read(&case.attributes)?;
        let number = |name| case.attributes.number(name);
        let position = number("bullet_x0_m").zip(number("bullet_y0_m"));
        let body = |name| {
            case.attributes.get(name).map(|value| match value {
                Value::Text(text) => text.clone(),
                Value::Number(number) => number.to_string(),
            })
        };
        Ok(Self {
            striking_position_m: position.map(|(x, y)| [x, y]),
            striking_body: body("bullet_body"),
            struck_body: body("target_body"),
            ..Self::from_attributes(&attributes)
        })
    }

    /// The scenario of a case's attributes, without bodies and the position of the striking
    /// vehicle, which they do not contain.
    pub fn from_attributes(attributes: &ForceAttributes) -> Self {
        let [_, contact_y_m] = attributes.contact_m;
        let theta = attributes.theta_b_rad;
        let approach = attributes.striking_velocity_m_s[1] - attributes.struck_velocity_m_s[1];
        let side = || struck_side(Some(contact_y_m), theta, approach);
        Self {
            mass_kg: attributes.mass_kg,
            struck_velocity_m_s: attributes.struck_velocity_m_s,
            striking_velocity_m_s: attributes.striking_velocity_m_s,
            yaw_rate_rad_s: attributes.yaw_rate_rad_s,
            theta_b_rad: theta,
            side: attributes.side.unwrap_or_else(side),
            contact_m: Some(attributes.contact_m),
            normal_rad: attributes.contact_normal_rad.or_else(|| end_normal_rad(attributes)),
            striking_position_m: None,
            striking_body: None,
            struck_body: None,
            yaw_inertia_kg_m2: attributes.yaw_inertia_kg_m2,
            contact_law: None,
        }
    }

    /// The scenario of an impact, turned so that the struck vehicle heads along X.
    ///
    /// # Errors
    /// [`ScenarioError`] if the vehicles do not meet, or slide whatever the friction although it is
    /// given as a share of the critical impulse ratio.
    pub fn from_scenario(scenario: &Scenario) -> Result<Self, ScenarioError> {
        let geometry = scenario.geometry()?;
        let surface = scenario.impact()?.surface;
        let (struck, striking) = (&scenario.struck, &scenario.striking);
        let (sin, cos) = struck.heading_rad.sin_cos();
        let turned = |[x, y]: [f64; 2]| [x * cos + y * sin, y * cos - x * sin];
        let struck_velocity_m_s = turned([struck.vx_world_m_s, struck.vy_world_m_s]);
        let striking_velocity_m_s = turned([striking.vx_world_m_s, striking.vy_world_m_s]);
        let contact_m = geometry.struck.body_from_world(geometry.contact_point_world_m);
        let theta_b_rad = wrap_angle_rad(striking.heading_rad - struck.heading_rad);
        let approach = striking_velocity_m_s[1] - struck_velocity_m_s[1];
        Ok(Self {
            mass_kg: [struck.mass_kg, striking.mass_kg],
            struck_velocity_m_s,
            striking_velocity_m_s,
            yaw_rate_rad_s: [struck.yaw_rate_rad_s, striking.yaw_rate_rad_s],
            theta_b_rad,
            side: struck_side(Some(contact_m[1]), theta_b_rad, approach),
            contact_m: Some(contact_m),
            normal_rad: Some(wrap_angle_rad(geometry.normal_angle_world_rad - struck.heading_rad)),
            striking_position_m: Some(
                geometry.struck.body_from_world([geometry.striking.x_m, geometry.striking.y_m]),
            ),
            striking_body: None,
            struck_body: None,
            yaw_inertia_kg_m2: [Some(struck.yaw_inertia_kg_m2), Some(striking.yaw_inertia_kg_m2)],
            contact_law: Some(ContactLaw {
                restitution: surface.restitution,
                restitution_form: surface.restitution_form,
                friction_limit: surface.friction_limit,
            }),
        })
    }

    /// Every number of the scenario with its name and its range.
    pub fn ranges(&self) -> Vec<(String, f64, Range)> {
        let mut numbers = Vec::new();
        let mut add = |name: &str, value: Option<f64>, range| {
            numbers.extend(value.map(|value| (name.to_owned(), value, range)));
        };
        for (i, body) in ["target", "bullet"].into_iter().enumerate() {
            add(&format!("mass_kg of the {body}"), Some(self.mass_kg[i]), BODY_MASS);
            let rate = self.yaw_rate_rad_s[i];
            add(&format!("yaw_rate_rad_s of the {body}"), Some(rate), YAW_RATE);
            let inertia = self.yaw_inertia_kg_m2[i];
            add(&format!("yaw_inertia_kg_m2 of the {body}"), inertia, BODY_YAW_INERTIA);
        }
        for (i, axis) in ["x", "y"].into_iter().enumerate() {
            let [struck, striking] = [self.struck_velocity_m_s[i], self.striking_velocity_m_s[i]];
            add(&format!("target_velocity_m_s, {axis}"), Some(struck), SPEED);
            add(&format!("bullet_velocity_m_s, {axis}"), Some(striking), SPEED);
            let range = [CONTACT_X, CONTACT_Y][i];
            add(&format!("contact_m, {axis}"), self.contact_m.map(|at| at[i]), range);
            let position = self.striking_position_m.map(|at| at[i]);
            add(&format!("bullet_position_m, {axis}"), position, STRIKING_OFFSET);
        }
        add("theta_b_rad", Some(self.theta_b_rad), HEADING);
        add("normal_rad", self.normal_rad, HEADING);
        let law = self.contact_law;
        add("contact_law.restitution", law.map(|law| law.restitution), RESTITUTION);
        add("contact_law.friction_limit", law.map(|law| law.friction_limit), FRICTION_LIMIT);
        numbers
    }

    /// The planar impact of the collision, with the normal across the struck vehicle; `None` if
    /// contact point, position of the striking vehicle or a yaw inertia is open, or if the contact
    /// lies on neither side of the struck vehicle.
    ///
    /// - `law`: restitution and friction.
    pub fn impact(&self, law: ContactLaw) -> Option<Impact> {
        let ([m_t_kg, m_b_kg], [izz_t, izz_b]) = (self.mass_kg, self.yaw_inertia_kg_m2);
        let case = ImpactCase {
            m_t_kg,
            m_b_kg,
            v_t_m_s: self.struck_velocity_m_s,
            v_b_m_s: self.striking_velocity_m_s,
            theta_b_rad: self.theta_b_rad,
            izz_t_kg_m2: izz_t?,
            izz_b_kg_m2: izz_b?,
            contact_m: self.contact_m?,
            striking_m: self.striking_position_m?,
        };
        let mut impact = case.to_impact(law.restitution, law.friction_limit).ok()?;
        [impact.struck.yaw_rate_rad_s, impact.striking.yaw_rate_rad_s] = self.yaw_rate_rad_s;
        impact.surface.restitution_form = law.restitution_form;
        Some(impact)
    }

    /// The same with the restitution and friction that are known, or those of the closing speed.
    pub fn likely_impact(&self) -> Option<Impact> {
        let impact = self.impact(ContactLaw::at_closing_speed(0.0))?;
        let law = ContactLaw::at_closing_speed(impact.closing_speed_m_s());
        self.impact(self.contact_law.unwrap_or(law))
    }

    /// Whether a flank is hit by a vehicle that travels much the same way, as in a PIT manoeuvre: the contact
    /// normal points across the struck vehicle, and the headings differ by up to 45°.
    pub fn is_push_on_flank(&self) -> bool {
        let is_across = |normal_rad: f64| normal_rad.sin().abs() > FRAC_PI_4.sin();
        self.normal_rad.is_none_or(is_across) && self.theta_b_rad.abs() <= FRAC_PI_4
    }

    /// Whether the front of the struck vehicle is hit: the contact normal points backwards into it.
    pub fn is_hit_in_front(&self) -> bool {
        self.normal_rad.is_some_and(|normal_rad| normal_rad.cos() < -FRAC_PI_4.cos())
    }

    /// Angle of the contact normal of a canonical scenario from across the struck vehicle, rad; zero where
    /// the scenario leaves it open.
    pub(crate) fn normal_turn_rad(&self) -> f64 {
        self.normal_rad.map_or(0.0, |normal| wrap_angle_rad(normal - FRAC_PI_2))
    }

    /// Velocity of the contact point of the striking vehicle relative to that of the struck vehicle by
    /// their turning alone, `r_b × a_b − r_t × a_t`, m/s.
    ///
    /// - `contact_m`: contact point, or one that is tried;
    /// - `striking_arm_m`: from the CG of the striking vehicle to it, in that vehicle's axes.
    pub(crate) fn turning_velocity_m_s(
        &self,
        [x, y]: [f64; 2],
        striking_arm_m: [f64; 2],
    ) -> [f64; 2] {
        let [of_struck, of_striking] = self.yaw_rate_rad_s;
        let (sin, cos) = self.theta_b_rad.sin_cos();
        let [ahead, left] = striking_arm_m;
        let arm = match self.striking_position_m {
            Some([at_x, at_y]) => [x - at_x, y - at_y],
            None => [ahead * cos - left * sin, ahead * sin + left * cos],
        };
        [of_struck * y - of_striking * arm[1], of_striking * arm[0] - of_struck * x]
    }

    /// Velocity of the striking vehicle relative to the struck vehicle `v_b − v_t`, m/s.
    pub fn relative_velocity_m_s(&self) -> [f64; 2] {
        [0, 1].map(|i| self.striking_velocity_m_s[i] - self.struck_velocity_m_s[i])
    }

    /// The mirror image left to right.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mirror = |[x, y]: [f64; 2]| [x, -y];
        Self {
            struck_velocity_m_s: mirror(self.struck_velocity_m_s),
            striking_velocity_m_s: mirror(self.striking_velocity_m_s),
            yaw_rate_rad_s: self.yaw_rate_rad_s.map(|rate| -rate),
            theta_b_rad: -self.theta_b_rad,
            side: match self.side {
                StruckSide::Left => StruckSide::Right,
                StruckSide::Right => StruckSide::Left,
            },
            contact_m: self.contact_m.map(mirror),
            normal_rad: self.normal_rad.map(|normal| wrap_angle_rad(-normal)),
            striking_position_m: self.striking_position_m.map(mirror),
            ..self.clone()
        }
    }

    /// The canonical form of this scenario, and whether it is mirrored. Of all equivalent scenarios
    /// it is the one with the striking vehicle on the right of the struck vehicle, so that it
    /// mostly pushes along +y, and with the struck vehicle at rest.
    #[must_use]
    pub fn canonical(&self) -> (Self, bool) {
        let mirrored = self.side == StruckSide::Left;
        let right = if mirrored { self.mirrored() } else { self.clone() };
        let striking_velocity_m_s = right.relative_velocity_m_s();
        (Self { struck_velocity_m_s: [0.0; 2], striking_velocity_m_s, ..right }, mirrored)
    }
}

/// The contact normal of a case that does not state it, where it touches the front or the rear between the
/// flanks; `None` for a blow against a flank, or one that may be.
fn end_normal_rad(attributes: &ForceAttributes) -> Option<f64> {
    let [x, y] = attributes.contact_m;
    let is_end = y.abs() < NARROWEST_HALF_WIDTH_M && x.abs() > SHORTEST_END_M;
    is_end.then_some(if x < 0.0 { 0.0 } else { PI })
}

/// The struck side of a case that does not state it: the side of the contact point, else the side
/// from which the striking vehicle heads towards the struck vehicle, else the side from which it
/// moves.
///
/// - `approach_m_s`: lateral velocity of the striking vehicle relative to the struck vehicle.
fn struck_side(contact_y_m: Option<f64>, theta_b_rad: f64, approach_m_s: f64) -> StruckSide {
    let signs = [contact_y_m.unwrap_or(0.0), -theta_b_rad, -approach_m_s];
    match signs.into_iter().find(|sign| *sign != 0.0) {
        Some(sign) if sign > 0.0 => StruckSide::Left,
        _ => StruckSide::Right,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::force::ForceCase;
    use crate::force::input::shipped;
    use crate::learning::{TEST_SHARE, split};
    use impactlab_core::collision::{
        ContactLocation, DEFAULT_FRICTION_LIMIT, DEFAULT_RESTITUTION, RESTITUTION_SPEEDS_M_S,
    };

    pub(crate) fn example(side: StruckSide) -> ForceScenario {
        let right = ForceScenario {
            mass_kg: [2000.0, 1500.0],
            struck_velocity_m_s: [15.0, 0.25],
            striking_velocity_m_s: [16.0, 3.5],
            yaw_rate_rad_s: [0.0; 2],
            theta_b_rad: 0.5,
            side: StruckSide::Right,
            contact_m: Some([-1.5, -0.925]),
            normal_rad: None,
            striking_position_m: Some([-2.75, -2.5]),
            striking_body: Some("A".to_owned()),
            struck_body: None,
            yaw_inertia_kg_m2: [Some(3600.0), None],
            contact_law: None,
        };
        if side == StruckSide::Right { right } else { right.mirrored() }
    }

    #[test]
    fn mirrored_twice_is_the_same() {
        for side in [StruckSide::Left, StruckSide::Right] {
            let scenario = example(side);
            assert_eq!(scenario.mirrored().mirrored(), scenario);
            assert_ne!(scenario.mirrored(), scenario);
        }
    }

    #[test]
    fn a_blow_from_behind_has_its_normal_along_the_car() {
        let end = |x: f64, y: f64, stated: Option<f64>| {
            let attributes = ForceAttributes {
                mass_kg: [2000.0, 1500.0],
                yaw_inertia_kg_m2: [None; 2],
                struck_velocity_m_s: [10.0, 0.0],
                striking_velocity_m_s: [16.0, 0.0],
                yaw_rate_rad_s: [0.0; 2],
                theta_b_rad: 0.0,
                contact_m: [x, y],
                contact_height_m: None,
                contact_normal_rad: stated,
                side: None,
                hooked: None,
                separated: None,
            };
            ForceScenario::from_attributes(&attributes).normal_rad
        };
        assert_eq!(end(-2.6, 0.3, None), Some(0.0));
        assert_eq!(end(2.2, -0.1, None), Some(PI));
        assert_eq!([end(-2.3, 0.92, None), end(0.1, 0.3, None)], [None; 2]);
        assert_eq!(end(-2.5, -0.8, Some(0.1)), Some(0.1));
    }

    /// The velocity by turning is that of the points of contact less that of the CGs, and it is mirrored
    /// with the scenario.
    #[test]
    fn turning_moves_the_points_of_contact() {
        let yaw_rate_rad_s = [0.2, -0.4];
        let turning = ForceScenario { yaw_rate_rad_s, ..example(StruckSide::Right) };
        let (contact, no_arm) = (turning.contact_m.unwrap(), [f64::NAN; 2]);
        let [x, y] = turning.turning_velocity_m_s(contact, no_arm);
        let law = ContactLaw::at_closing_speed(1.0);
        let whole = ForceScenario { yaw_inertia_kg_m2: [Some(3600.0); 2], ..turning.clone() };
        let [of_points_x, of_points_y] = whole.impact(law).unwrap().relative_velocity_m_s();
        let [of_cgs_x, of_cgs_y] = turning.relative_velocity_m_s();
        assert!((of_points_x - of_cgs_x - x).abs() < 1e-12, "{x}");
        assert!((of_points_y - of_cgs_y - y).abs() < 1e-12, "{y}");
        let mirror = turning.mirrored();
        let of_mirror = mirror.turning_velocity_m_s(mirror.contact_m.unwrap(), no_arm);
        assert_eq!(of_mirror, [x, -y]);
        assert_eq!(mirror.mirrored(), turning);
        // Without a known place the arm turns with the heading.
        let open = ForceScenario { striking_position_m: None, ..turning };
        let (sin, cos) = open.theta_b_rad.sin_cos();
        let [dx, dy] = [contact[0] + 2.75, contact[1] + 2.5];
        let arm = [dx * cos + dy * sin, dy * cos - dx * sin];
        let [open_x, open_y] = open.turning_velocity_m_s(contact, arm);
        assert!((open_x - x).abs() < 1e-12 && (open_y - y).abs() < 1e-12);
    }

    #[test]
    fn mirror_images_and_moving_observers_share_one_canonical_form() {
        let (canonical, mirrored) = example(StruckSide::Right).canonical();
        assert!(!mirrored);
        assert_eq!(canonical.relative_velocity_m_s(), [1.0, 3.25]);
        assert_eq!(example(StruckSide::Left).canonical(), (canonical.clone(), true));
        assert_eq!(canonical.canonical(), (canonical.clone(), false));
        let mut faster = example(StruckSide::Right);
        for velocity in [&mut faster.struck_velocity_m_s, &mut faster.striking_velocity_m_s] {
            *velocity = [velocity[0] + 8.0, velocity[1] - 0.5];
        }
        assert_eq!(faster.canonical().0, canonical);
    }

    #[test]
    fn the_side_follows_from_contact_heading_and_motion() {
        for (contact_y_m, theta_b_rad, approach_m_s, side) in [
            (Some(-0.9), -0.3, -1.0, StruckSide::Right),
            (Some(0.9), 0.3, 1.0, StruckSide::Left),
            (None, 0.3, -1.0, StruckSide::Right),
            (None, -0.3, 1.0, StruckSide::Left),
            (None, 0.0, 1.0, StruckSide::Right),
            (None, 0.0, -1.0, StruckSide::Left),
            (None, 0.0, 0.0, StruckSide::Right),
        ] {
            let got = struck_side(contact_y_m, theta_b_rad, approach_m_s);
            assert_eq!(got, side, "{contact_y_m:?} {theta_b_rad} {approach_m_s}");
        }
    }

    #[test]
    fn a_scenario_is_seen_from_the_struck() {
        let scenario = Scenario::example();
        let seen = ForceScenario::from_scenario(&scenario).unwrap();
        assert_eq!(seen.side, StruckSide::Right);
        assert!(seen.contact_m.unwrap()[0] < -1.0, "{seen:?}");
        // Turn the whole scene by a quarter: nothing changes.
        let mut turned = scenario;
        let turn = |[x, y]: [f64; 2]| [-y, x];
        [turned.struck_x_world_m, turned.struck_y_world_m] =
            turn([turned.struck_x_world_m, turned.struck_y_world_m]);
        for vehicle in [&mut turned.struck, &mut turned.striking] {
            vehicle.heading_rad += FRAC_PI_2;
            [vehicle.vx_world_m_s, vehicle.vy_world_m_s] =
                turn([vehicle.vx_world_m_s, vehicle.vy_world_m_s]);
        }
        if let ContactLocation::Footprints { striking_x_world_m, striking_y_world_m } =
            &mut turned.contact.location
        {
            [*striking_x_world_m, *striking_y_world_m] =
                turn([*striking_x_world_m, *striking_y_world_m]);
        }
        let again = ForceScenario::from_scenario(&turned).unwrap();
        let numbers = |s: &ForceScenario| {
            let pairs = [s.struck_velocity_m_s, s.striking_velocity_m_s, s.contact_m.unwrap()];
            [pairs.concat(), s.striking_position_m.unwrap().to_vec(), vec![s.theta_b_rad]].concat()
        };
        for (a, b) in numbers(&seen).into_iter().zip(numbers(&again)) {
            assert!((a - b).abs() < 1e-9, "{seen:?}\n{again:?}");
        }
    }

    /// Restitution and friction limit of the momentum solution are those that fit the training cases
    /// best, to the hundredth.
    #[test]
    fn the_defaults_of_the_contact_are_fitted_to_the_training_cases() {
        let cases = shipped("fea");
        let train = split(&cases, 0, TEST_SHARE).train.into_iter().map(|idx| &cases[idx]);
        let train: Vec<&ForceCase> = train.filter(|case| case.is_clean()).collect();
        let mean_error = |restitution, friction_limit| {
            let error = |case: &&ForceCase| {
                let slow = ContactLaw::at_closing_speed(0.0);
                let law = ContactLaw { restitution, friction_limit, ..slow };
                let impact = case.scenario.impact(law).unwrap();
                let ([px, py], [qx, qy]) =
                    (impact.solve().unwrap().impulse_world_n_s, case.impulse_n_s);
                (px - qx).hypot(py - qy) / qx.hypot(qy)
            };
            train.iter().map(error).sum::<f64>() / train.len() as f64
        };
        let fitted = mean_error(DEFAULT_RESTITUTION, DEFAULT_FRICTION_LIMIT);
        assert!((fitted - 0.171).abs() < 1e-3, "{fitted}");
        for (e, mu) in (0..=10).flat_map(|i| (0..=10).map(move |j| (i, j))) {
            let [e, mu] = [f64::from(e) / 10.0, f64::from(mu) / 10.0];
            let (e, mu) = (DEFAULT_RESTITUTION * 2.0 * e, DEFAULT_FRICTION_LIMIT * 2.0 * mu);
            assert!(mean_error(e, mu) > fitted - 5e-4, "{e} {mu}");
        }
        let closing =
            train.iter().map(|case| case.scenario.likely_impact().unwrap().closing_speed_m_s());
        let fastest_m_s = closing.fold(0.0_f64, f64::max);
        assert!((fastest_m_s - RESTITUTION_SPEEDS_M_S[0]).abs() < 0.3, "{fastest_m_s}");
    }
}
