//! Tests of the impact solution: identities and limits for random cases, and known special cases.

use num_dual::Dual64;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::collision::{
    ContactSurface, FrictionModel, Impact, ImpactBody, ImpactError, ImpactSolution, Regime,
    RestitutionForm, contact_work_j,
};

fn bodies() -> impl Strategy<Value = ImpactBody> {
    let pair = |most: f64| [-most..most, -most..most];
    let numbers = (500.0..5000.0, 0.5..3.0, -4.0..4.0, pair(40.0), -3.0..3.0, pair(3.0));
    numbers.prop_map(|(mass_kg, gyration, heading_rad, velocity_world_m_s, rate, arm)| ImpactBody {
        mass_kg,
        yaw_inertia_kg_m2: mass_kg * gyration,
        heading_rad,
        velocity_world_m_s,
        yaw_rate_rad_s: rate,
        contact_arm_world_m: arm,
    })
}

fn impacts(friction_model: FrictionModel) -> impl Strategy<Value = Impact> {
    let surface = (-4.0..4.0, 0.0..=1.0, 0.0..2.0);
    (bodies(), bodies(), surface).prop_map(move |(struck, striking, (gamma, e, mu))| Impact {
        struck,
        striking,
        surface: ContactSurface {
            normal_angle_world_rad: gamma,
            restitution: e,
            restitution_form: RestitutionForm::Normal,
            friction_limit: mu,
            friction_model,
        },
    })
}

/// Linear momentum along x and y, angular momentum about the contact point and kinetic energy of
/// both bodies together, before and after the impact.
fn totals(impact: &Impact, solution: &ImpactSolution) -> [[f64; 4]; 2] {
    let [struck, striking] = after(impact, solution);
    [[impact.struck, impact.striking], [struck, striking]].map(|bodies| {
        let mut sum = [0.0; 4];
        for body in bodies {
            let [px, py] = body.velocity_world_m_s.map(|v| body.mass_kg * v);
            // The position of the CG relative to the contact point is the negative of the arm.
            let [x, y] = body.contact_arm_world_m.map(|r| -r);
            let spin = body.yaw_inertia_kg_m2 * body.yaw_rate_rad_s;
            let terms = [px, py, spin + x * py - y * px, body.kinetic_energy_j()];
            sum = [0, 1, 2, 3].map(|i| sum[i] + terms[i]);
        }
        sum
    })
}

fn after(impact: &Impact, solution: &ImpactSolution) -> [ImpactBody; 2] {
    let moved = |body: ImpactBody, to: &crate::collision::BodyAfter| ImpactBody {
        velocity_world_m_s: to.velocity_world_m_s,
        yaw_rate_rad_s: to.yaw_rate_rad_s,
        ..body
    };
    [moved(impact.struck, &solution.struck), moved(impact.striking, &solution.striking)]
}

/// Relative velocity of the contact points after the impact along normal and tangent, m/s.
fn closing_after(impact: &Impact, solution: &ImpactSolution) -> [f64; 2] {
    let [struck, striking] = after(impact, solution);
    let ([tx, ty], [bx, by]) = (struck.contact_velocity_m_s(), striking.contact_velocity_m_s());
    let (sin, cos) = impact.surface.normal_angle_world_rad.sin_cos();
    let (x, y) = (bx - tx, by - ty);
    [x * cos + y * sin, y * cos - x * sin]
}

/// Momentum, N s, and energy, J, relative to which rounding errors are judged.
fn scales(impact: &Impact) -> (f64, f64) {
    let energy = impact.struck.kinetic_energy_j() + impact.striking.kinetic_energy_j();
    let mass = impact.struck.mass_kg + impact.striking.mass_kg;
    ((2.0 * energy * mass).sqrt() + 1.0, energy + 1.0)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn momentum_is_kept_and_the_work_is_the_energy_lost(
        impact in prop_oneof![impacts(FrictionModel::Limit), impacts(FrictionModel::Paper)],
    ) {
        match impact.solve() {
            Err(error) => prop_assert!(matches!(error, ImpactError::Jammed { .. }), "{error}"),
            Ok(solution) => {
                let [before, after] = totals(&impact, &solution);
                let (momentum, energy) = scales(&impact);
                let [px, py] = solution.impulse_world_n_s;
                // In the paper's model the impulse may be far larger than the momentum before the
                // impact.
                let momentum = momentum + px.hypot(py);
                for i in 0..3 {
                    let drift = (after[i] - before[i]).abs();
                    prop_assert!(drift < 1e-11 * momentum, "{i}: {before:?} {after:?}");
                }
                let energy = energy + after[3];
                let lost = before[3] - after[3];
                let off = (lost - solution.dissipated_energy_j).abs();
                prop_assert!(off < 1e-10 * energy, "{lost} {}", solution.dissipated_energy_j);
            }
        }
    }

    #[test]
    fn energy_never_grows_and_restitution_and_friction_hold(
        impact in impacts(FrictionModel::Limit),
    ) {
        let solution = impact.solve().unwrap();
        let (_, energy) = scales(&impact);
        prop_assert!(solution.dissipated_energy_j > -1e-10 * energy, "{solution:?}");
        let [before_n, before_t] = solution.closing_velocity_m_s;
        let [after_n, after_t] = closing_after(&impact, &solution);
        let (p_n, p_t) = (solution.impulse_normal_n_s, solution.impulse_tangential_n_s);
        let speed = before_n.hypot(before_t) + 1.0;
        if solution.regime == Regime::NotApproaching {
            prop_assert!(before_n <= 0.0 && p_n == 0.0 && p_t == 0.0, "{solution:?}");
            return Ok(());
        }
        let rebound = after_n + impact.surface.restitution * before_n;
        prop_assert!(rebound.abs() < 1e-9 * speed, "{rebound} {solution:?}");
        prop_assert!(p_n > 0.0, "{solution:?}");
        let bound = impact.surface.friction_limit * p_n;
        prop_assert!(p_t.abs() <= bound * (1.0 + 1e-12), "{solution:?}");
        match solution.regime {
            Regime::NoSlide => prop_assert!(after_t.abs() < 1e-9 * speed, "{after_t}"),
            Regime::Sliding => {
                prop_assert!((p_t.abs() - bound).abs() < 1e-9 * bound, "{solution:?}");
                // Friction opposes the sliding that remains at the end.
                prop_assert!(after_t * p_t >= -1e-9 * speed * bound, "{after_t} {solution:?}");
            }
            _ => prop_assert!(solution.dissipated_energy_j < 1e-9 * energy, "{solution:?}"),
        }
    }

    #[test]
    fn restitution_from_the_common_velocity_returns_both_components(
        impact in impacts(FrictionModel::Limit),
    ) {
        let impact = with_form(impact, RestitutionForm::CommonVelocity);
        let solution = impact.solve().unwrap();
        let (_, energy) = scales(&impact);
        prop_assert!(solution.dissipated_energy_j > -1e-10 * energy, "{solution:?}");
        let [before_n, before_t] = solution.closing_velocity_m_s;
        let [after_n, after_t] = closing_after(&impact, &solution);
        let speed = before_n.hypot(before_t) + 1.0;
        let (e, mu) = (impact.surface.restitution, impact.surface.friction_limit);
        if solution.regime == Regime::NotApproaching {
            return Ok(());
        }
        prop_assert!((after_n + e * before_n).abs() < 1e-9 * speed, "{solution:?}");
        let ratio = solution.impulse_tangential_n_s.abs() / solution.impulse_normal_n_s;
        match solution.regime {
            Regime::CommonVelocity => {
                prop_assert!((after_t + e * before_t).abs() < 1e-9 * speed, "{solution:?}");
                prop_assert!(ratio <= mu * (1.0 + 1e-9), "{solution:?}");
                let lost = (1.0 - e * e) * common_velocity_work_j(&impact);
                prop_assert!((solution.dissipated_energy_j - lost).abs() < 1e-9 * energy);
            }
            Regime::Sliding => prop_assert!((ratio - mu).abs() < 1e-9 * (1.0 + mu), "{ratio}"),
            other => prop_assert!(false, "{other:?}"),
        }
    }

    #[test]
    fn without_restitution_both_forms_agree(impact in impacts(FrictionModel::Limit)) {
        let surface = ContactSurface { restitution: 0.0, ..impact.surface };
        let [one, other] = RestitutionForm::ALL
            .map(|form| with_form(Impact { surface, ..impact }, form).solve().unwrap());
        prop_assert_eq!(one.impulse_world_n_s, other.impulse_world_n_s);
    }

    #[test]
    fn at_the_critical_impulse_ratio_sliding_just_ends(
        impact in impacts(FrictionModel::Limit),
        share in 0.1..0.9,
        form in prop_oneof![Just(RestitutionForm::Normal), Just(RestitutionForm::CommonVelocity)],
    ) {
        let impact = with_form(impact, form);
        let Some(critical) = impact.critical_impulse_ratio() else { return Ok(()) };
        let at = |friction_limit: f64| {
            let surface = ContactSurface { friction_limit, ..impact.surface };
            Impact { surface, ..impact }.solve().unwrap()
        };
        let (below, above) = (at(share * critical), at(critical * 1.001));
        prop_assume!(below.regime != Regime::EnergyLimited);
        prop_assume!(above.regime != Regime::EnergyLimited);
        prop_assert_eq!(below.regime, Regime::Sliding);
        prop_assert!(above.regime != Regime::Sliding, "{:?}", above);
        let ratio = above.impulse_tangential_n_s.abs() / above.impulse_normal_n_s;
        prop_assert!((ratio - critical).abs() < 1e-9 * (1.0 + critical), "{ratio} {critical}");
    }

    #[test]
    fn the_mirror_image_has_the_mirrored_impulse(
        impact in impacts(FrictionModel::Limit),
    ) {
        let mirror = |body: ImpactBody| ImpactBody {
            heading_rad: -body.heading_rad,
            velocity_world_m_s: [body.velocity_world_m_s[0], -body.velocity_world_m_s[1]],
            yaw_rate_rad_s: -body.yaw_rate_rad_s,
            contact_arm_world_m: [body.contact_arm_world_m[0], -body.contact_arm_world_m[1]],
            ..body
        };
        let gamma = -impact.surface.normal_angle_world_rad;
        let image = Impact {
            struck: mirror(impact.struck),
            striking: mirror(impact.striking),
            surface: ContactSurface { normal_angle_world_rad: gamma, ..impact.surface },
        };
        let (one, other) = (impact.solve().unwrap(), image.solve().unwrap());
        let [px, py] = one.impulse_world_n_s;
        let [qx, qy] = other.impulse_world_n_s;
        let size = 1e-12 * px.hypot(py);
        prop_assert!((px - qx).abs() <= size && (py + qy).abs() <= size, "{one:?} {other:?}");
        prop_assert_eq!(one.regime, other.regime);
    }

    /// Which of two vehicles strikes and which is struck is a matter of telling.
    #[test]
    fn exchanged_vehicles_have_the_opposite_impulse(
        impact in impacts(FrictionModel::Limit),
    ) {
        let gamma = impact.surface.normal_angle_world_rad + std::f64::consts::PI;
        let exchanged = Impact {
            struck: impact.striking,
            striking: impact.struck,
            surface: ContactSurface { normal_angle_world_rad: gamma, ..impact.surface },
        };
        let (one, other) = (impact.solve().unwrap(), exchanged.solve().unwrap());
        let (momentum, _) = scales(&impact);
        for i in 0..2 {
            let off = (one.impulse_world_n_s[i] + other.impulse_world_n_s[i]).abs();
            prop_assert!(off < 1e-9 * momentum, "{one:?} {other:?}");
        }
        let loss_j = (one.dissipated_energy_j - other.dissipated_energy_j).abs();
        prop_assert!(loss_j <= 1e-6 * one.dissipated_energy_j.abs().max(1.0), "{one:?} {other:?}");
    }

    #[test]
    fn a_common_velocity_changes_nothing(
        impact in impacts(FrictionModel::Limit),
        common in [-40.0..40.0, -40.0..40.0],
    ) {
        let pushed = |body: ImpactBody| ImpactBody {
            velocity_world_m_s: [0, 1].map(|i| body.velocity_world_m_s[i] + common[i]),
            ..body
        };
        let moving = Impact {
            struck: pushed(impact.struck),
            striking: pushed(impact.striking),
            ..impact
        };
        let (one, other) = (impact.solve().unwrap(), moving.solve().unwrap());
        let (momentum, _) = scales(&moving);
        for i in 0..2 {
            let off = (one.impulse_world_n_s[i] - other.impulse_world_n_s[i]).abs();
            prop_assert!(off < 1e-9 * momentum, "{one:?} {other:?}");
        }
    }

    #[test]
    fn a_frictionless_perfect_rebound_keeps_the_energy(
        impact in impacts(FrictionModel::Limit),
    ) {
        let surface = ContactSurface { restitution: 1.0, friction_limit: 0.0, ..impact.surface };
        let solution = Impact { surface, ..impact }.solve().unwrap();
        let (_, energy) = scales(&impact);
        prop_assert!(solution.dissipated_energy_j.abs() < 1e-10 * energy, "{solution:?}");
    }

    #[test]
    fn the_derivative_is_exact(impact in impacts(FrictionModel::Limit)) {
        let at = |push: f64| {
            let mut impact = impact;
            impact.striking.velocity_world_m_s[0] += push;
            impact.solve().unwrap()
        };
        let step = 1e-5;
        let (low, middle, high) = (at(-step), at(0.0), at(step));
        prop_assume!(low.regime == high.regime && low.regime == middle.regime);
        prop_assume!(middle.regime != Regime::EnergyLimited);
        // The impulse has no derivative where the friction changes its sign between the two steps.
        prop_assume!(low.impulse_tangential_n_s * high.impulse_tangential_n_s >= 0.0);
        let exact = dual(&impact).solve_unchecked().unwrap();
        for i in 0..2 {
            let rate = (high.impulse_world_n_s[i] - low.impulse_world_n_s[i]) / (2.0 * step);
            let off = (exact.impulse_world_n_s[i].eps - rate).abs();
            prop_assert!(off < 1e-3 + 1e-6 * rate.abs(), "{} {rate}", exact.impulse_world_n_s[i].eps);
            prop_assert!((exact.impulse_world_n_s[i].re - middle.impulse_world_n_s[i]).abs() < 1e-6);
        }
    }

    #[test]
    fn a_known_impulse_gives_back_what_made_it(impact in impacts(FrictionModel::Limit)) {
        let solution = impact.solve().unwrap();
        if solution.closing_velocity_m_s[0] < 0.1 {
            return Ok(());
        }
        let implied = impact.implied_contact(solution.impulse_world_n_s).unwrap();
        prop_assert!((implied.restitution - impact.surface.restitution).abs() < 1e-8);
        let ratio = solution.impulse_tangential_n_s / solution.impulse_normal_n_s;
        prop_assert!((implied.impulse_ratio - ratio).abs() < 1e-8 * (1.0 + ratio.abs()));
    }
}

fn with_form(impact: Impact, restitution_form: RestitutionForm) -> Impact {
    Impact { surface: ContactSurface { restitution_form, ..impact.surface }, ..impact }
}

/// Kinetic energy of the relative motion of the contact points, ½ vᵀ K⁻¹ v, J.
fn common_velocity_work_j(impact: &Impact) -> f64 {
    let [[a, b], [_, d]] = impact.inverse_mass_1_kg();
    let [x, y] = impact.relative_velocity_m_s();
    (d * x * x - 2.0 * b * x * y + a * y * y) / (2.0 * (a * d - b * b))
}

/// The same impact in dual numbers, for the derivative with respect to the velocity of the striking
/// vehicle along X.
fn dual(impact: &Impact) -> Impact<Dual64> {
    let body = |body: &ImpactBody| ImpactBody {
        mass_kg: body.mass_kg.into(),
        yaw_inertia_kg_m2: body.yaw_inertia_kg_m2.into(),
        heading_rad: body.heading_rad,
        velocity_world_m_s: body.velocity_world_m_s.map(Dual64::from),
        yaw_rate_rad_s: body.yaw_rate_rad_s.into(),
        contact_arm_world_m: body.contact_arm_world_m.map(Dual64::from),
    };
    let mut striking = body(&impact.striking);
    striking.velocity_world_m_s[0] = striking.velocity_world_m_s[0].derivative();
    Impact {
        struck: body(&impact.struck),
        striking,
        surface: ContactSurface {
            normal_angle_world_rad: impact.surface.normal_angle_world_rad.into(),
            restitution: impact.surface.restitution.into(),
            restitution_form: impact.surface.restitution_form,
            friction_limit: impact.surface.friction_limit.into(),
            friction_model: impact.surface.friction_model,
        },
    }
}

/// A central impact (both CGs lie on the contact normal) of cars of 1000 kg and 3000 kg that
/// approach each other at 12 m/s.
fn central(restitution: f64) -> Impact {
    let car = |mass_kg: f64, speed: f64, arm: f64| ImpactBody {
        mass_kg,
        yaw_inertia_kg_m2: 1.8 * mass_kg,
        heading_rad: 0.0,
        velocity_world_m_s: [speed, 0.0],
        yaw_rate_rad_s: 0.0,
        contact_arm_world_m: [arm, 0.0],
    };
    Impact {
        struck: car(1000.0, 3.0, -2.5),
        striking: car(3000.0, 15.0, 2.2),
        surface: ContactSurface {
            normal_angle_world_rad: 0.0,
            restitution,
            restitution_form: RestitutionForm::Normal,
            friction_limit: 0.5,
            friction_model: FrictionModel::Limit,
        },
    }
}

#[test]
fn a_central_impact_loses_the_textbook_energy() {
    for e in [0.0, 0.1, 0.5, 1.0] {
        let solution = central(e).solve().unwrap();
        let m_eff = 1000.0 * 3000.0 / 4000.0;
        let lost = 0.5 * m_eff * 12.0_f64.powi(2) * (1.0 - e * e);
        assert!((solution.dissipated_energy_j - lost).abs() < 1e-8, "e = {e}: {solution:?}");
        let [dvx, dvy] = solution.struck.delta_v_world_m_s;
        assert!((dvx - (1.0 + e) * m_eff * 12.0 / 1000.0).abs() < 1e-12, "e = {e}: {solution:?}");
        assert!(dvy.abs() < 1e-12 && solution.struck.yaw_rate_rad_s == 0.0, "{solution:?}");
        let clocks = [solution.struck.pdof, solution.striking.pdof].map(|p| p.map(|p| p.clock()));
        assert_eq!(clocks, [Some(6), Some(12)], "e = {e}");
    }
}

/// The doc comment of the solution once called both forms by the name of one.
#[test]
fn with_restitution_and_without_sliding_the_forms_differ() {
    let mut impact = central(0.3);
    impact.striking.contact_arm_world_m = [2.2, 0.8];
    impact.striking.velocity_world_m_s[1] = 1.5;
    impact.surface.friction_limit = 2.0;
    let [normal, common] =
        RestitutionForm::ALL.map(|form| with_form(impact, form).solve().unwrap());
    assert_eq!((normal.regime, common.regime), (Regime::NoSlide, Regime::CommonVelocity));
    let after = |form, solution| closing_after(&with_form(impact, form), solution);
    let [normal_n, normal_t] = after(RestitutionForm::Normal, &normal);
    let [common_n, common_t] = after(RestitutionForm::CommonVelocity, &common);
    let [closing_n, closing_t] = normal.closing_velocity_m_s;
    for (got, expected) in [
        (normal_n, -0.3 * closing_n),
        (normal_t, 0.0),
        (common_n, -0.3 * closing_n),
        (common_t, -0.3 * closing_t),
    ] {
        assert!((got - expected).abs() < 1e-9, "{got} {expected}");
    }
    let apart = [0, 1].map(|i| normal.impulse_world_n_s[i] - common.impulse_world_n_s[i]);
    assert!(apart[0].hypot(apart[1]) > 10.0, "{normal:?} {common:?}");
}

#[test]
fn the_work_of_a_force_depends_on_its_impulse_alone() {
    let impact = central(0.3);
    let k = impact.inverse_mass_1_kg();
    let v0 = impact.relative_velocity_m_s();
    // The work of an asymmetric force history is integrated step by step and compared with the
    // closed form.
    let (n, mut impulse, mut work) = (20_000, [0.0; 2], 0.0);
    for i in 0..n {
        let u = (f64::from(i) + 0.5) / f64::from(n);
        let dp = [9000.0 * u * (1.0 - u), 2000.0 * (7.0 * u).sin()].map(|f| f / f64::from(n));
        for j in 0..2 {
            let lost: f64 = (0..2).map(|m| k[j][m] * (impulse[m] + dp[m] / 2.0)).sum();
            work += (v0[j] - lost) * dp[j];
        }
        impulse = [impulse[0] + dp[0], impulse[1] + dp[1]];
    }
    let closed = contact_work_j(v0, k, impulse);
    assert!((work - closed).abs() < 1e-6 * closed.abs(), "{work} {closed}");
}

/// With e = 1, long lever arms and slow sliding, restitution together with the condition of no
/// sliding would create kinetic energy (the paradox of Kane and Levinson).
#[test]
fn friction_is_held_where_it_would_create_energy() {
    let mut impact = central(1.0);
    impact.surface.friction_limit = 2.0;
    impact.striking.contact_arm_world_m = [2.2, 1.6];
    impact.striking.yaw_inertia_kg_m2 = 1000.0;
    let regimes = [-6.0, -3.0, -1.0, -0.3, 0.0, 0.3, 1.0, 3.0, 6.0].map(|slide| {
        impact.striking.velocity_world_m_s[1] = slide;
        let solution = impact.solve().unwrap();
        assert!(solution.dissipated_energy_j > -1e-9, "{slide}: {solution:?}");
        solution.regime
    });
    assert!(regimes.contains(&Regime::EnergyLimited), "{regimes:?}");
    assert!(regimes.contains(&Regime::NoSlide), "{regimes:?}");
}

/// In a case where friction below the limit suffices to stop the sliding, the paper's model applies
/// the whole friction and reverses the direction of sliding.
#[test]
fn the_papers_model_always_slides() {
    let mut impact = central(0.1);
    impact.striking.velocity_world_m_s[1] = 0.5;
    impact.surface.friction_limit = 0.9;
    assert_eq!(impact.solve().unwrap().regime, Regime::NoSlide);
    impact.surface.friction_model = FrictionModel::Paper;
    let solution = impact.solve().unwrap();
    assert_eq!(solution.regime, Regime::Sliding);
    let ratio = solution.impulse_tangential_n_s / solution.impulse_normal_n_s;
    assert!((ratio - 0.9).abs() < 1e-12, "{solution:?}");
    assert!(closing_after(&impact, &solution)[1] < -1.0, "{solution:?}");
}

#[test]
fn senseless_numbers_are_refused_by_name() {
    let refused = |change: fn(&mut Impact)| {
        let mut impact = central(0.1);
        change(&mut impact);
        impact.solve().unwrap_err().to_string()
    };
    assert_eq!(refused(|i| i.struck.mass_kg = 0.0), "target: mass_kg is 0, expected more than 0");
    assert_eq!(
        refused(|i| i.surface.restitution = 1.5),
        "contact: restitution is 1.5, expected 0 to 1"
    );
    assert_eq!(
        refused(|i| i.striking.velocity_world_m_s[1] = f64::NAN),
        "bullet: velocity_m_s[1] is NaN, expected a finite number"
    );
}
