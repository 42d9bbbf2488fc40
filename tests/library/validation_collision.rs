//! The collision layer compared with published numbers and with the shipped finite-element runs.

use std::path::Path;

use impactlab_core::collision::{
    ContactDistribution, ContactSurface, Footprint, FrictionModel, Impact, ImpactBody, ImpactCase,
    ImpactSolution, PrincipalDirectionOfForce, Regime, RestitutionForm, Scenario,
};
use impactlab_core::units::{Quantity, Unit};

fn unit(quantity: Quantity, symbol: &str) -> Unit {
    *quantity.units().iter().find(|unit| unit.symbol == symbol).expect("a unit of the table")
}

/// Barrier example of Carpenter and Welcher, SAE 2019-01-0422.
///
/// The source's axes are x forward and y right with angles clockwise, so that the values here are
/// its mirror image. Its masses are weights over 32.2 ft/s². With the standard 32.174 ft/s², every
/// quantity that is proportional to the mass is 0.08 % larger.
#[test]
fn carpenter_welcher_barrier() {
    let mass = unit(Quantity::Mass, "slug");
    let inertia = unit(Quantity::MomentOfInertia, "slug ft²");
    let length = unit(Quantity::Length, "ft");
    let speed = unit(Quantity::Speed, "mph");
    let impulse = unit(Quantity::Impulse, "lbf s");
    let energy = unit(Quantity::Energy, "ft lbf");
    let arm = |x: f64, y: f64| [length.to_si(x), length.to_si(-y)];
    let impact = Impact {
        struck: ImpactBody {
            mass_kg: mass.to_si(3574.2 / 32.2),
            yaw_inertia_kg_m2: inertia.to_si(2336.3),
            heading_rad: 0.0,
            velocity_world_m_s: [speed.to_si(39.9545), 0.0],
            yaw_rate_rad_s: 0.0,
            contact_arm_world_m: arm(3.620925, -2.007083),
        },
        striking: ImpactBody {
            mass_kg: mass.to_si(1e7 / 32.2),
            yaw_inertia_kg_m2: inertia.to_si(173_611_111.111),
            heading_rad: std::f64::consts::PI,
            velocity_world_m_s: [0.0, 0.0],
            yaw_rate_rad_s: 0.0,
            // The heading is 180°, so that the arm in the vehicle's own axes has the opposite
            // signs.
            contact_arm_world_m: arm(-4.166667, 4.166667),
        },
        surface: ContactSurface {
            normal_angle_world_rad: (-74.6_f64 - 90.0).to_radians(),
            restitution: 0.0,
            restitution_form: RestitutionForm::Normal,
            friction_limit: 0.82,
            friction_model: FrictionModel::Limit,
        },
    };
    let solution = impact.solve().unwrap();
    let got = [
        impulse.from_si(solution.impulse_tangential_n_s),
        impulse.from_si(solution.impulse_normal_n_s),
        speed.from_si(solution.struck.delta_v_world_m_s[0]),
        -speed.from_si(solution.struck.delta_v_world_m_s[1]),
        -solution.struck.delta_yaw_rate_rad_s.to_degrees(),
        energy.from_si(solution.dissipated_energy_j),
    ];
    let printed = [-351.773, 5936.161, -35.7275, 7.5998, -176.430, 170_421.5];
    // The tolerances are half of the last printed digit. The last digit of P_n is truncated in the
    // source, not rounded.
    let tolerances = [5e-4, 1e-3, 5e-5, 5e-5, 5e-3, 0.05];
    for ((got, printed), tolerance) in got.into_iter().zip(printed).zip(tolerances) {
        assert!((got - printed).abs() < tolerance, "{got}, printed {printed}");
    }
}

/// The shipped scenario file of the same example gives the same numbers.
#[test]
fn carpenter_welcher_scenario_file() {
    let solution = solve_scenario("carpenter_welcher_barrier.toml");
    let energy = unit(Quantity::Energy, "ft lbf");
    let impulse = unit(Quantity::Impulse, "lbf s");
    let normal = impulse.from_si(solution.impulse_normal_n_s);
    assert!((normal - 5936.161).abs() < 1e-3, "{normal}");
    let lost = energy.from_si(solution.dissipated_energy_j);
    assert!((lost - 170_421.5).abs() < 0.05, "{lost}");
    assert_eq!(solution.regime, Regime::NoSlide);
}

/// A PIT manoeuvre turns the tail of the struck vehicle away from the striking vehicle. A push from
/// the right at the rear turns the nose to the right, and the principal direction of force is from
/// the right and behind.
#[test]
fn a_pit_turns_the_struck_towards_the_striking() {
    let solution = solve_scenario("pit_right_rear.toml");
    assert!(solution.impulse_world_n_s[1] > 1000.0, "{solution:?}");
    assert!(solution.struck.yaw_rate_rad_s < -0.2, "{solution:?}");
    assert!(solution.dissipated_energy_j > 0.0, "{solution:?}");
    let clock = solution.struck.pdof.map(PrincipalDirectionOfForce::clock);
    assert!(matches!(clock, Some(3 | 4)), "{solution:?}");
}

fn solve_scenario(name: &str) -> ImpactSolution {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/");
    let scenario = Scenario::load(&Path::new(folder).join(name)).expect(name);
    scenario.solve().expect(name)
}

/// Reads a number from a column of `cases.csv`.
fn cell(headers: &csv::StringRecord, row: &csv::StringRecord, name: &str) -> f64 {
    let column = headers.iter().position(|header| header == name);
    let text = column.and_then(|column| row.get(column)).expect(name);
    text.parse().expect(name)
}

fn impact_case(headers: &csv::StringRecord, row: &csv::StringRecord) -> ImpactCase {
    let cell = |name: &str| cell(headers, row, name);
    ImpactCase {
        m_t_kg: cell("m_t_kg"),
        m_b_kg: cell("m_b_kg"),
        v_t_m_s: [cell("v_tx_m_s"), cell("v_ty_m_s")],
        v_b_m_s: [cell("v_bx_m_s"), cell("v_by_m_s")],
        theta_b_rad: cell("theta_b_rad"),
        izz_t_kg_m2: cell("izz_t_kg_m2"),
        izz_b_kg_m2: cell("izz_b_kg_m2"),
        contact_m: [cell("contact_x_m"), cell("contact_y_m")],
        striking_m: [cell("bullet_x0_m"), cell("bullet_y0_m")],
    }
}

fn finite_element_cases() -> (csv::StringRecord, Vec<csv::StringRecord>) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea/cases.csv");
    let mut reader = csv::Reader::from_path(path).expect(path);
    let headers = reader.headers().expect("a header").clone();
    let rows = reader.records().map(|row| row.expect("a row"));
    (headers, rows.collect())
}

const OUTLINE: Footprint = Footprint { length_m: 4.8, width_m: 1.85, cg_from_front_m: 2.3 };

/// Momentum solution for the shipped finite-element runs with e = 0.3, μ_c = 0.4 and the normal
/// across the struck vehicle. The median errors over all 100 runs are 16.3 % for the impulse
/// vector, 12.6 % for its magnitude and 10.4 % for its component across the struck vehicle. The
/// bounds are the next whole percent, because the solution is deterministic.
#[test]
fn finite_element_impulses() {
    let (headers, rows) = finite_element_cases();
    let mut errors: [Vec<f64>; 3] = Default::default();
    for row in rows {
        let case = impact_case(&headers, &row);
        let scenario = case.to_scenario([OUTLINE; 2], 0.3, 0.4).expect("a side");
        let impact = case.to_impact(0.3, 0.4).expect("a side");
        assert_eq!(scenario.impact().expect("a contact"), impact);
        let [px, py] = impact.solve().expect("a solution").impulse_world_n_s;
        let [fx, fy] = ["impulse_x_n_s", "impulse_y_n_s"].map(|name| cell(&headers, &row, name));
        let total = fx.hypot(fy);
        errors[0].push((px - fx).hypot(py - fy) / total);
        errors[1].push((px.hypot(py) - total).abs() / total);
        errors[2].push(((py - fy) / fy).abs());
    }
    let bounds = [("vector", 0.17), ("magnitude", 0.13), ("across", 0.11)];
    for (mut errors, (name, bound)) in errors.into_iter().zip(bounds) {
        assert_eq!(errors.len(), 100);
        errors.sort_by(f64::total_cmp);
        let median = (errors[49] + errors[50]) / 2.0;
        assert!(median < bound, "{name}: median impulse error {median}");
    }
}

/// Restitution and impulse ratio that the runs without hooking imply. For 90 % of them, e is
/// between 0.24 and 0.63 and the impulse ratio between 0.06 and 0.55.
///
/// The restitution is that of a rigid model with a fixed contact point, fitted to 0.1 s of contact.
/// It is above the range from 0 to 0.3 that is usual in reconstruction.
#[test]
fn finite_element_restitution_and_friction() {
    let (headers, rows) = finite_element_cases();
    let mut samples = Vec::new();
    for row in &rows {
        if cell(&headers, row, "hooked") == 1.0 {
            continue;
        }
        let impact = impact_case(&headers, row).to_impact(0.0, 0.0).expect("a side");
        let impulse = ["impulse_x_n_s", "impulse_y_n_s"].map(|name| cell(&headers, row, name));
        samples.push(impact.implied_contact(impulse).expect("a push"));
    }
    assert_eq!(samples.len(), 88);
    let fit = ContactDistribution::fit(&samples).expect("samples");
    let [low, high] = fit.restitution;
    assert!((low - 0.24).abs() < 0.01 && (high - 0.63).abs() < 0.02, "{fit:?}");
    let [low, high] = fit.friction_limit;
    assert!((low - 0.06).abs() < 0.01 && (high - 0.55).abs() < 0.02, "{fit:?}");
}
