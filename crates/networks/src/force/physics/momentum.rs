//! The momentum solution of a force scenario: rigid bodies whose contact normal lies nearly across
//! the struck vehicle.
//!
//! What a scenario leaves open, or must not be used (the position of the striking vehicle's CG, yaw
//! inertias, the contact point), is replaced by an average over the training cases. Restitution, friction limit
//! and the angle of the normal are fitted to the impulses of these cases. All scenarios are
//! canonical.

use std::f64::consts::FRAC_PI_2;

use serde::{Deserialize, Serialize};

use crate::force::{ForceCase, ForceScenario};
use crate::nn::{Expected, NnError, check_number, check_numbers};
use impactlab_core::collision::{
    ContactSurface, FrictionModel, Impact, ImpactBody, ImpactError, ImpactSolution, RestitutionForm,
};
use impactlab_core::numerics::Summary;

/// Parameters of the momentum solution, fitted to training cases.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MomentumModel {
    /// Restitution e.
    pub restitution: f64,
    /// Friction limit μ_c.
    pub friction_limit: f64,
    /// Angle of the contact normal from the struck vehicle's +y axis, rad, counter-clockwise.
    pub normal_turn_rad: f64,
    /// Contact point from the struck vehicle's CG, m, for scenarios that leave it open or if it
    /// must not be used.
    pub contact_m: [f64; 2],
    /// From the striking vehicle's CG to the contact point, in the striking vehicle's own axes, m.
    #[serde(rename = "bullet_arm_m")]
    pub striking_arm_m: [f64; 2],
    /// Yaw inertia over mass of the struck and the striking vehicle, m².
    pub inertia_per_mass_m2: [f64; 2],
    /// Whether the contact point of a scenario is used.
    pub uses_contact: bool,
    /// Whether place and yaw inertias of a scenario are used where it tells them, beside its contact point.
    /// They are if any training case turns: then the arms decide how fast the points of contact meet.
    #[serde(default)]
    pub uses_place: bool,
}

impl MomentumModel {
    /// Checks a model from a file.
    ///
    /// - `name`: its place in the metadata.
    ///
    /// # Errors
    /// [`NnError::StoredNumber`].
    pub(crate) fn check(&self, name: &str) -> Result<(), NnError> {
        check_number(&format!("{name}.restitution"), self.restitution, Expected::Share)?;
        let friction = format!("{name}.friction_limit");
        check_number(&friction, self.friction_limit, Expected::NotNegative)?;
        let inertia = format!("{name}.inertia_per_mass_m2");
        check_numbers(&inertia, &self.inertia_per_mass_m2, Expected::Positive)
    }

    /// Values without any training case, for a push on the right rear wheel by a corner of the
    /// striking vehicle's front. They fit the shipped finite-element runs
    /// (`tests/library/validation_collision.rs`).
    pub fn prior(uses_contact: bool) -> Self {
        Self {
            restitution: 0.3,
            friction_limit: 0.4,
            normal_turn_rad: 0.0,
            contact_m: [-1.5, -0.925],
            striking_arm_m: [1.9, 0.93],
            inertia_per_mass_m2: [1.8, 1.9],
            uses_contact,
            uses_place: false,
        }
    }

    /// Averages positions and inertias over the cases, then chooses e, μ_c and the angle of the normal
    /// with the smallest mean error `|P̂ − P| / |P|` of the impulse, on a grid that is refined twice
    /// about its best point.
    ///
    /// - `uses_contact`: whether the contact point of a scenario is used, in the fit and in predictions.
    pub fn fit(cases: &[&ForceCase], uses_contact: bool) -> Self {
        let mut model = Self::prior(uses_contact);
        let scenarios = || cases.iter().map(|case| &case.scenario);
        let turns = |scenario: &ForceScenario| scenario.yaw_rate_rad_s != [0.0; 2];
        model.uses_place = uses_contact && scenarios().any(turns);
        let mean = |values: &mut dyn Iterator<Item = f64>| {
            Summary::from_values(values).map(|summary| summary.mean)
        };
        for axis in [0, 1] {
            let contacts = &mut scenarios().filter_map(|s| Some(s.contact_m?[axis]));
            model.contact_m[axis] = mean(contacts).unwrap_or(model.contact_m[axis]);
            let arms = &mut scenarios().filter_map(|s| Some(striking_arm_m(s)?[axis]));
            model.striking_arm_m[axis] = mean(arms).unwrap_or(model.striking_arm_m[axis]);
            let ratio = |s: &ForceScenario| Some(s.yaw_inertia_kg_m2[axis]? / s.mass_kg[axis]);
            let ratios = &mut scenarios().filter_map(ratio);
            model.inertia_per_mass_m2[axis] =
                mean(ratios).unwrap_or(model.inertia_per_mass_m2[axis]);
        }
        let mut best = (model.mean_error(cases), model);
        let (mut centre, mut half_width) = ([0.4, 0.5, -0.1], [0.4, 0.5, 0.4]);
        for _ in 0..3 {
            for candidate in grid(centre, half_width) {
                let model = model.with_surface(candidate);
                let error = model.mean_error(cases);
                if error < best.0 {
                    best = (error, model);
                }
            }
            let found = &best.1;
            centre = [found.restitution, found.friction_limit, found.normal_turn_rad];
            half_width = half_width.map(|width| width / GRID_POINTS as f64 * 2.0);
        }
        best.1
    }

    /// The impact of a canonical scenario.
    pub fn impact(&self, scenario: &ForceScenario) -> Impact {
        let known = scenario.contact_m.filter(|_| self.uses_contact);
        let (sin, cos) = scenario.theta_b_rad.sin_cos();
        let own_arm = striking_arm_m(scenario).filter(|_| self.uses_place);
        let [x, y] = own_arm.unwrap_or(self.striking_arm_m);
        let inertia_of = |i: usize| {
            let own = scenario.yaw_inertia_kg_m2[i].filter(|_| self.uses_place);
            own.unwrap_or(self.inertia_per_mass_m2[i] * scenario.mass_kg[i])
        };
        let body = |i: usize, heading_rad, velocity_world_m_s, contact_arm_world_m| ImpactBody {
            mass_kg: scenario.mass_kg[i],
            yaw_inertia_kg_m2: inertia_of(i),
            heading_rad,
            velocity_world_m_s,
            yaw_rate_rad_s: scenario.yaw_rate_rad_s[i],
            contact_arm_world_m,
        };
        let striking_arm = [x * cos - y * sin, x * sin + y * cos];
        let (v_t, v_b) = (scenario.struck_velocity_m_s, scenario.striking_velocity_m_s);
        Impact {
            struck: body(0, 0.0, v_t, known.unwrap_or(self.contact_m)),
            striking: body(1, scenario.theta_b_rad, v_b, striking_arm),
            surface: ContactSurface {
                normal_angle_world_rad: FRAC_PI_2 + self.normal_turn_rad,
                restitution: self.restitution,
                restitution_form: RestitutionForm::Normal,
                friction_limit: self.friction_limit,
                friction_model: FrictionModel::Limit,
            },
        }
    }

    /// The impact of a canonical scenario: its impulse and the velocities after it. Where the vehicles do not
    /// approach each other along the fitted normal, that across the struck vehicle is taken. Of a model that
    /// must not use the place of contact the yaw rates are left out if they do not approach along this one
    /// either: they would turn points that are nobody's.
    ///
    /// # Errors
    /// [`ImpactError`] for masses or velocities out of range.
    pub fn solve(&self, scenario: &ForceScenario) -> Result<ImpactSolution, ImpactError> {
        let solution = self.impact(scenario).solve()?;
        if solution.impulse_world_n_s != [0.0; 2] {
            return Ok(solution);
        }
        // The tilt of the normal can have vehicles part that slide along each other.
        let straight = Self { normal_turn_rad: 0.0, ..*self };
        let solution = straight.impact(scenario).solve()?;
        // Points of contact that are known and part are no collision.
        if solution.impulse_world_n_s != [0.0; 2] || self.uses_contact {
            return Ok(solution);
        }
        straight.impact(&ForceScenario { yaw_rate_rad_s: [0.0; 2], ..scenario.clone() }).solve()
    }

    /// Mean over cases of `|P̂ − P| / |P|`; infinite where one cannot be solved.
    pub fn mean_error(&self, cases: &[&ForceCase]) -> f64 {
        let error = |case: &&ForceCase| {
            let [px, py] = case.impulse_n_s;
            self.solve(&case.scenario).map_or(f64::INFINITY, |solution| {
                let [qx, qy] = solution.impulse_world_n_s;
                (qx - px).hypot(qy - py) / px.hypot(py)
            })
        };
        cases.iter().map(error).sum::<f64>() / cases.len().max(1) as f64
    }

    fn with_surface(self, [restitution, friction_limit, normal_turn_rad]: [f64; 3]) -> Self {
        Self { restitution, friction_limit, normal_turn_rad, ..self }
    }
}

/// Points of the grid along each parameter.
const GRID_POINTS: usize = 11;

/// Points about a centre, with e from 0 to 1 and μ_c from 0.
fn grid(centre: [f64; 3], half_width: [f64; 3]) -> impl Iterator<Item = [f64; 3]> {
    let at = move |axis: usize, i: usize| {
        let value = i as f64 / (GRID_POINTS - 1) as f64 * 2.0 - 1.0;
        centre[axis] + half_width[axis] * value
    };
    let range = 0..GRID_POINTS;
    range.clone().flat_map(move |i| {
        let range = range.clone();
        range.clone().flat_map(move |j| {
            range.clone().map(move |k| [at(0, i).clamp(0.0, 1.0), at(1, j).max(0.0), at(2, k)])
        })
    })
}

/// From the striking vehicle's CG to the contact point in the striking vehicle's axes, m, where
/// both are known.
fn striking_arm_m(scenario: &ForceScenario) -> Option<[f64; 2]> {
    let ([cx, cy], [bx, by]) = (scenario.contact_m?, scenario.striking_position_m?);
    let (sin, cos) = scenario.theta_b_rad.sin_cos();
    let (x, y) = (cx - bx, cy - by);
    Some([x * cos + y * sin, y * cos - x * sin])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::input::{example, shipped};
    use crate::learning::{TEST_SHARE, split};
    use impactlab_core::data::StruckSide;

    #[test]
    fn fitted_on_training_cases_it_meets_their_impulses_better() {
        let cases = shipped("fea");
        let train: Vec<&ForceCase> =
            split(&cases, 0, TEST_SHARE).train.into_iter().map(|idx| &cases[idx]).collect();
        for (uses_contact, bound) in [(false, 0.20), (true, 0.17)] {
            let model = MomentumModel::fit(&train, uses_contact);
            let (fitted, before) =
                (model.mean_error(&train), MomentumModel::prior(uses_contact).mean_error(&train));
            assert!(fitted < bound && fitted < before, "{fitted}, before {before}: {model:?}");
        }
    }

    #[test]
    fn impulses_of_the_model_itself_are_fitted() {
        let truth = MomentumModel { restitution: 0.2, ..MomentumModel::prior(true) };
        let mut cases = shipped("fea");
        for case in &mut cases {
            case.scenario.striking_position_m = None;
            case.scenario.yaw_inertia_kg_m2 = [None; 2];
            case.impulse_n_s = truth.solve(&case.scenario).unwrap().impulse_world_n_s;
        }
        let fitted = MomentumModel::fit(&cases.iter().collect::<Vec<_>>(), true);
        assert!((fitted.restitution - 0.2).abs() < 0.03, "{fitted:?}");
        assert!(fitted.mean_error(&cases.iter().collect::<Vec<_>>()) < 0.02, "{fitted:?}");
    }

    /// Vehicles that slide along each other and are parted by the tilt of the normal collide; points of
    /// contact that turning parts do not, unless nobody knows where they are.
    #[test]
    fn what_the_tilt_parts_collides_and_what_turning_parts_does_not() {
        let along = ForceScenario {
            struck_velocity_m_s: [20.0, 0.0],
            striking_velocity_m_s: [14.0, 0.4],
            ..example(StruckSide::Right)
        };
        let impulse = |model: MomentumModel, scenario: &ForceScenario| {
            model.solve(scenario).unwrap().impulse_world_n_s[1]
        };
        let tilted =
            |normal_turn_rad| MomentumModel { normal_turn_rad, ..MomentumModel::prior(true) };
        let is_parted = |model: &MomentumModel| {
            model.impact(&along).solve().unwrap().impulse_world_n_s == [0.0; 2]
        };
        let parted: Vec<MomentumModel> =
            [-0.2, 0.2].map(tilted).into_iter().filter(is_parted).collect();
        assert_eq!(parted.len(), 1, "one of both tilts parts them");
        assert!(impulse(parted[0], &along) > 0.0);
        let turning = ForceScenario { yaw_rate_rad_s: [0.0, -1.0], ..along };
        assert_eq!(impulse(MomentumModel::prior(true), &turning), 0.0);
        assert!(impulse(MomentumModel::prior(false), &turning) > 0.0);
    }
}
