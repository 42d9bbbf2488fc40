//! Changes of one quantity of a collision, with the changes of other quantities that follow from
//! it.

use impactlab_core::collision::Scenario;
use impactlab_core::data::StruckSide;
use impactlab_networks::force::ForceScenario;

/// Position of the first contact along the struck vehicle, from its CG, that is proposed when the
/// contact point becomes known, m. It is near the rear axle, where a PIT manoeuvre begins.
const USUAL_CONTACT_X_M: f64 = -1.5;

/// Sets the mass of a vehicle.
///
/// A known yaw inertia belonged to the old mass and is dropped; the model then assumes one that is
/// proportional to the mass.
///
/// - `vehicle`: 0 for the struck vehicle, 1 for the striking vehicle;
/// - `mass_kg`: the new mass, kg.
pub fn set_mass(scenario: &mut ForceScenario, vehicle: usize, mass_kg: f64) {
    scenario.mass_kg[vehicle] = mass_kg;
    scenario.yaw_inertia_kg_m2[vehicle] = None;
}

/// Sets the heading of the striking vehicle relative to the struck vehicle, rad. The position of
/// its CG, which depends on it, is no longer known then.
pub fn set_striking_heading(scenario: &mut ForceScenario, theta_b_rad: f64) {
    scenario.theta_b_rad = theta_b_rad;
    scenario.striking_position_m = None;
}

/// Moves the first contact to `x_m` along the struck vehicle, from its CG, and moves the striking
/// vehicle by the same distance. Nothing changes if the contact point is unknown.
pub fn set_contact_x(scenario: &mut ForceScenario, x_m: f64) {
    if let Some([old_m, _]) = scenario.contact_m
        && let Some([striking_m, _]) = &mut scenario.striking_position_m
    {
        *striking_m += x_m - old_m;
    }
    if let Some([contact_m, _]) = &mut scenario.contact_m {
        *contact_m = x_m;
    }
}

/// Marks the contact point, its normal and the position of the striking vehicle as unknown.
pub fn forget_contact(scenario: &mut ForceScenario) {
    (scenario.contact_m, scenario.striking_position_m) = (None, None);
    scenario.normal_rad = None;
}

/// Proposes a contact point on the struck side, 1.5 m behind the CG and at half the width of the
/// example scenario's struck vehicle.
pub fn know_contact(scenario: &mut ForceScenario) {
    let half_width_m = Scenario::example().struck.width_m / 2.0;
    let y_m = if scenario.side == StruckSide::Left { half_width_m } else { -half_width_m };
    scenario.contact_m = Some([USUAL_CONTACT_X_M, y_m]);
}

/// Sets the struck side. If it changes, the whole scenario is mirrored left to right.
pub fn set_side(scenario: &mut ForceScenario, side: StruckSide) {
    if scenario.side != side {
        *scenario = scenario.mirrored();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scenario() -> ForceScenario {
        ForceScenario::from_scenario(&Scenario::example()).unwrap()
    }

    #[test]
    fn the_striking_moves_with_the_contact() {
        let (before, mut after) = (scenario(), scenario());
        let [x, y] = before.contact_m.unwrap();
        set_contact_x(&mut after, x + 0.3);
        assert_eq!(after.contact_m, Some([x + 0.3, y]));
        let [before_x, _] = before.striking_position_m.unwrap();
        assert!((after.striking_position_m.unwrap()[0] - before_x - 0.3).abs() < 1e-12);
        forget_contact(&mut after);
        set_contact_x(&mut after, 1.0);
        assert_eq!((after.contact_m, after.striking_position_m), (None, None));
    }

    #[test]
    fn the_other_side_is_the_mirror_image() {
        let (before, mut after) = (scenario(), scenario());
        set_side(&mut after, before.side);
        assert_eq!(after, before);
        set_side(&mut after, StruckSide::Left);
        assert_eq!(after, before.mirrored());
        forget_contact(&mut after);
        know_contact(&mut after);
        assert!(after.contact_m.unwrap()[1] > 0.5, "{after:?}");
    }

    #[test]
    fn what_belonged_to_the_old_numbers_is_forgotten() {
        let mut scenario = scenario();
        set_mass(&mut scenario, 1, 3000.0);
        assert!(scenario.yaw_inertia_kg_m2[0].is_some());
        assert_eq!((scenario.mass_kg[1], scenario.yaw_inertia_kg_m2[1]), (3000.0, None));
        set_striking_heading(&mut scenario, 0.5);
        assert_eq!((scenario.theta_b_rad, scenario.striking_position_m), (0.5, None));
    }
}
