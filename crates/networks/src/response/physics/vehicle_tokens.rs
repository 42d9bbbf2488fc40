//! The vehicle as the response network sees it: a token for each group of parameters.

use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::VehicleParameters;

/// Groups of parameters: mass and inertia, geometry, tires, suspension.
pub const N_TOKENS: usize = 4;

/// Numbers of a group.
pub const N_TOKEN_NUMBERS: usize = 5;

/// The parameters Θ, free of the vehicle's size and of the order of one about a saloon car.
///
/// ```text
/// mass and inertia   ln(m/2000 kg), m_s/m, I_zz/(m l_f l_r), I_xx/(m w²/4), I_xz/I_zz
/// geometry           ln(L/2.7 m), l_r/L, w/L, h/L, 0
/// tires              c_f, c_r, μ, μ_s/μ, 100 f_R
/// suspension         K_φ/(m_s g h), B/√(K_φ I_xx), front share, h_ra/h, arm/h
/// ```
pub fn vehicle_tokens(vehicle: &VehicleParameters) -> [[f64; N_TOKEN_NUMBERS]; N_TOKENS] {
    let VehicleParameters { mass, geometry, suspension, tires, .. } = vehicle;
    let wheelbase = geometry.wheelbase_m();
    let (front, rear) = (geometry.cg_to_front_axle_m, geometry.cg_to_rear_axle_m);
    let half_track = geometry.track_width_m / 2.0;
    let stiffness = suspension.roll_stiffness_n_m_rad;
    let weight_moment = mass.sprung_mass_kg * STANDARD_GRAVITY_M_S2 * suspension.roll_arm_m;
    [
        [
            (mass.mass_kg / 2000.0).ln(),
            4.0 * (mass.sprung_mass_kg / mass.mass_kg - 0.8),
            2.0 * (mass.yaw_inertia_kg_m2 / (mass.mass_kg * front * rear) - 1.0),
            mass.roll_inertia_kg_m2 / (mass.mass_kg * half_track * half_track) - 1.0,
            10.0 * mass.roll_yaw_product_kg_m2 / mass.yaw_inertia_kg_m2,
        ],
        [
            (wheelbase / 2.7).ln(),
            4.0 * (rear / wheelbase - 0.5),
            4.0 * (geometry.track_width_m / wheelbase - 0.57),
            10.0 * (geometry.cg_height_m / wheelbase - 0.2),
            0.0,
        ],
        [
            (tires.cornering_coefficient_front_per_rad - 15.0) / 5.0,
            (tires.cornering_coefficient_rear_per_rad - 15.0) / 5.0,
            5.0 * (tires.friction - 0.7),
            5.0 * (tires.sliding_friction_ratio - 0.8),
            100.0 * tires.rolling_resistance - 1.0,
        ],
        [
            stiffness / weight_moment.max(1e-9) / 10.0 - 1.0,
            suspension.roll_damping_n_m_s_rad
                / (stiffness * mass.roll_inertia_kg_m2).max(1e-9).sqrt()
                - 1.5,
            5.0 * (suspension.front_roll_stiffness_share - 0.5),
            5.0 * (suspension.roll_axis_height_m / geometry.cg_height_m - 0.2),
            suspension.roll_arm_m / geometry.cg_height_m - 0.9,
        ],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::Preset;

    #[test]
    fn every_preset_is_of_the_order_of_one_whatever_its_size() {
        for preset in Preset::ALL {
            let tokens = vehicle_tokens(&preset.parameters());
            assert!(
                tokens.iter().flatten().all(|value| value.abs() < 5.0),
                "{preset:?} {tokens:?}"
            );
        }
    }
}
