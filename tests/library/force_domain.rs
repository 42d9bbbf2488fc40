//! Where the shipped force network applies, and what it says where it does not.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::collision::contact_work_j;
use impactlab_core::data::StruckSide;
use impactlab_core::numerics::NORMAL_QUANTILE_95;
use impactlab_core::uncertainty::CaveatKind;
use impactlab_networks::force::{ForceCase, ForceModel, ForcePrediction, ForceScenario};
use impactlab_networks::shipped::ModelSource;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Root mean square of the logarithm of the impulse, measured for the physics alone
/// (`examples/bare_force.rs`).
const IMPULSE_LOG_STD: f64 = 0.26;
/// Random collisions that are asked about.
const N_RANDOM: usize = 250;
/// Draws whose quantiles are taken.
const N_DRAWS: usize = 400;

fn model() -> ForceModel {
    ModelSource::Shipped.force_model().unwrap()
}

fn cases(name: &str) -> Vec<ForceCase> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets").join(name);
    ForceCase::load_all(&root, &mut |_| ControlFlow::Continue(())).unwrap().complete().unwrap()
}

/// Quantiles of the size of the impulse, N s.
fn impulse_quantiles(prediction: &ForcePrediction, levels: [f64; 3]) -> [f64; 3] {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let (_, drawn) = prediction.mixture.sample_quantities(N_DRAWS, &mut rng);
    let mut sizes = drawn.impulse_magnitude_n_s();
    sizes.sort_by(f64::total_cmp);
    levels.map(|level| sizes[(level * (N_DRAWS - 1) as f64).round() as usize])
}

/// In the domain an answer is that of the network alone, to the last bit: no component of the physics
/// stands beside those of the network.
#[test]
fn inside_of_the_training_the_network_alone_answers() {
    let model = model();
    let n_components = model.config().network.components;
    let mut n_inside = 0;
    for case in cases("fea").iter().chain(&cases("fea-wide")) {
        let predicted = model.predict(&case.scenario).unwrap();
        if predicted.applicability == 1.0 {
            n_inside += 1;
            assert_eq!(predicted.mixture.components().len(), n_components, "{}", case.name);
            assert!(
                predicted.hooking_probability.is_some()
                    && predicted.caveats.len() == predicted.outside.len()
            );
        } else {
            assert!(!predicted.caveats.is_empty(), "{}", case.name);
        }
    }
    assert!(n_inside >= 195, "{n_inside}");
    // c002 of fea, a test case, as the network was evaluated when it was trained.
    let predicted = model.predict(&cases("fea")[1].scenario).unwrap();
    let [px, py] = [0, 1].map(|axis| predicted.mixture.impulse(axis).mean());
    let expected = [580.115_635, 2_638.457_528];
    let off = [px / expected[0] - 1.0, py / expected[1] - 1.0];
    assert!(off.iter().all(|off| off.abs() < 1e-5), "{px:?} {py:?}");
}

/// A collision anywhere in the ranges: any side, any direction.
fn random_scenario(rng: &mut ChaCha8Rng) -> ForceScenario {
    let mut between = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
    let mass_kg = [between(700.0, 4000.0), between(700.0, 4000.0)];
    let theta_b_rad = between(-PI, PI);
    let (struck, striking) = (between(0.0, 70.0), between(0.0, 70.0));
    let (length, width) = (between(3.5, 5.5), between(1.6, 2.0));
    let along = between(-0.5, 0.5);
    // The struck side, the contact on it, and the normal into the struck vehicle.
    let (contact_m, normal_rad) = match between(0.0, 4.0) as usize {
        0 => ([along * length, -width / 2.0], FRAC_PI_2),
        1 => ([along * length, width / 2.0], -FRAC_PI_2),
        2 => ([-length / 2.0, along * width], 0.0),
        _ => ([length / 2.0, along * width], PI),
    };
    let (sin, cos) = theta_b_rad.sin_cos();
    ForceScenario {
        mass_kg,
        struck_velocity_m_s: [struck, 0.0],
        striking_velocity_m_s: [striking * cos, striking * sin],
        yaw_rate_rad_s: [between(-3.0, 3.0), between(-3.0, 3.0)],
        theta_b_rad,
        side: if contact_m[1] > 0.0 { StruckSide::Left } else { StruckSide::Right },
        contact_m: Some(contact_m),
        normal_rad: Some(normal_rad),
        striking_position_m: Some([contact_m[0] - 2.0 * cos, contact_m[1] - 2.0 * sin]),
        striking_body: None,
        struck_body: None,
        yaw_inertia_kg_m2: mass_kg.map(|mass_kg| Some(1.8 * mass_kg)),
        contact_law: None,
    }
}

/// The smallest work of the contact over the means of the components, as a share of the largest, J.
fn least_work(scenario: &ForceScenario, predicted: &ForcePrediction) -> Option<f64> {
    let impact = scenario.likely_impact()?;
    let (v, k) = (impact.relative_velocity_m_s(), impact.inverse_mass_1_kg());
    let work = predicted.mixture.components().iter().map(|component| {
        let n = component.mean.len() / 2;
        let sum = |values: &[f64]| values.iter().sum::<f64>() * 1e-3;
        contact_work_j(v, k, [sum(&component.mean[..n]), sum(&component.mean[n..2 * n])])
    });
    let kinetic = 0.5 * scenario.mass_kg[1] * (v[0] * v[0] + v[1] * v[1]);
    Some(work.fold(f64::INFINITY, f64::min) / kinetic)
}

/// At 288 km/h, with a struck vehicle of 1200 kg, with a blow from behind the bands were as tight
/// as in the training.
#[test]
fn any_collision_is_finite_and_outside_of_the_training_as_uncertain_as_the_physics() {
    let (model, mut rng) = (model(), ChaCha8Rng::seed_from_u64(14));
    let (mut n_physics, mut n_apart) = (0, 0);
    for i in 0..N_RANDOM {
        let scenario = random_scenario(&mut rng);
        let predicted = model.predict(&scenario).unwrap_or_else(|error| panic!("{i}: {error}"));
        let values = predicted
            .mixture
            .mean()
            .to_values()
            .into_iter()
            .chain(predicted.mixture.std().to_values());
        assert!(
            values.chain(predicted.centre.to_values()).all(f64::is_finite),
            "{i}: {scenario:?}"
        );
        assert!((0.0..=1.0).contains(&predicted.applicability), "{i}");
        if predicted.applicability == 1.0 {
            continue;
        }
        let named: Vec<_> = predicted
            .caveats
            .iter()
            .filter(|caveat| caveat.kind == CaveatKind::OutsideDomain)
            .collect();
        assert!(!named.is_empty(), "{i}: {scenario:?}");
        assert!(
            named
                .iter()
                .all(|of| of.quantity.is_some() && of.value.is_some() && of.range.is_some())
        );
        if predicted.applicability > 0.0 {
            continue;
        }
        assert!(named.len() > 1, "{i}: no feature is named, {named:?}");
        if predicted.caveats.iter().any(|caveat| caveat.kind == CaveatKind::ImplausibleContact) {
            n_apart += 1;
            continue;
        }
        n_physics += 1;
        let [low, median, high] = impulse_quantiles(&predicted, [0.05, 0.5, 0.95]);
        let below = (median / low).ln();
        assert!(
            below > 0.9 * NORMAL_QUANTILE_95 * IMPULSE_LOG_STD,
            "{i}: {low} {median} {high}, {scenario:?}"
        );
        // Above, energy sets a limit as well.
        assert!(high > 1.1 * median, "{i}: {low} {median} {high}, {scenario:?}");
        if let Some(work) = least_work(&scenario, &predicted)
            .filter(|_| scenario.normal_rad.unwrap().abs() == FRAC_PI_2)
        {
            assert!(work > -1e-9, "{i}: a gain of {work}, {scenario:?}");
        }
    }
    assert!(n_physics > 50 && n_apart > 20, "{n_physics} {n_apart}");
}

/// Applicability falls steadily as a collision leaves the training, and the band grows.
#[test]
fn the_network_fades_as_the_struck_gets_lighter() {
    let (model, seen) = (model(), cases("fea-wide")[0].scenario.clone());
    let mut before = (1.0, 0.0);
    for mass_kg in [1300.0, 1200.0, 1100.0, 1000.0, 900.0, 800.0, 600.0] {
        let lighter = ForceScenario { mass_kg: [mass_kg, seen.mass_kg[1]], ..seen.clone() };
        let predicted = model.predict(&lighter).unwrap();
        let [low, _, high] = impulse_quantiles(&predicted, [0.05, 0.5, 0.95]);
        let width = (high / low).ln();
        assert!(
            predicted.applicability <= before.0,
            "{mass_kg}: {} {before:?}",
            predicted.applicability
        );
        // Where both have a share, the mixture is a little wider than either.
        assert!(width > 0.85 * before.1, "{mass_kg}: {width} {before:?}");
        before = (predicted.applicability, width);
    }
    assert_eq!(before.0, 0.0);
}
