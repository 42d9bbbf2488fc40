use super::*;
use crate::evidence::examples::{SPIN, read};
use crate::evidence::{Mark, Measured, RestPose, Road, Weighing, YesNoUnknown};
use crate::sampler::Target;
use crate::{
    Discrepancy, EvidenceFit, MarkComparison, PriorComponent, PriorSource, ReconstructionTarget,
};
use impactlab_core::data::Channel;
use impactlab_core::numerics::wrap_angle_rad;
use impactlab_core::vehicle::{Integrator, Preset, TireMarkKind, Wheel};

/// What is found beside the rest pose: a locked wheel, marks and a change of velocity.
const FOUND: &str = r#"
delta_v_y_min_m_s = 1.0
delta_v_y_max_m_s = 1.5
sensor_y_m = 0.3
[[mark]]
wheel = "RR"
kind = "locked"
points_m = [[1.0, -0.7], [10, -0.8], [20, -1.5], [40, -5.5]]
[[mark]]
wheel = "FL"
points_m = [[8, 0.6], [20, -1.0], [30, -2.5]]
"#;

fn case() -> String {
    let (before, _) = SPIN.split_once("speed_before").unwrap();
    before.replace("blocked_wheels = []", "blocked_wheels = [\"RR\"]") + FOUND
}

fn evidence() -> Evidence {
    read(&case())
}

fn target(evidence: &Evidence) -> ReconstructionTarget {
    let model = ForwardModel::new(evidence, Cars::new(evidence, None, None));
    ReconstructionTarget::new(evidence.clone(), model, Discrepancy::default())
}

/// Particles that differ in every component.
fn particles(dim: usize) -> Vec<Vec<f64>> {
    let at = |i: usize, k: usize| 0.9 * (1.7 * i as f64 + 2.3 * k as f64 + 0.4).sin();
    (0..12)
        .map(|i| {
            let mut z: Vec<f64> = (0..dim).map(|k| at(i, k)).collect();
            z[0] = -0.5 + 0.05 * i as f64;
            z
        })
        .collect()
}

/// What was found is what the motion leaves: with its own marks it is explained to the last centimetre.
#[test]
fn a_motion_is_compared_with_marks_by_those_that_it_leaves() {
    let target = target(&evidence());
    let z = particles(target.dim()).remove(0);
    let [motion] = &target.model().motions(&[z], |motion| motion)[..] else { panic!("one") };
    let computed = motion.tire_marks();
    let blocked = computed.iter().filter(|mark| mark.wheel == Wheel::RearRight);
    let longest = blocked.max_by(|a, b| a.length_m().total_cmp(&b.length_m())).unwrap();
    assert_eq!(longest.kind(), TireMarkKind::Locked);
    let points_m: Vec<[f64; 2]> = longest.points.iter().map(|point| point.place_m).collect();
    let found = Mark { wheel: Wheel::RearRight, kind: None, points_m, sigma_m: None };
    let comparison = MarkComparison::all(&[found], &computed).remove(0);
    assert!(
        (comparison.found_length_m - comparison.computed_length_m).abs() < 1e-9,
        "{comparison:?}"
    );
    assert!(comparison.largest_distance_m.unwrap() < 1e-9, "{comparison:?}");
    assert!(comparison.found_length_m > 5.0, "{comparison:?}");
}

#[test]
fn a_particle_moves_as_the_simulation_of_its_car() {
    let target = target(&evidence());
    let mut z = particles(target.dim());
    z.truncate(4);
    for (i, motion) in target.model().motions(&z, |motion| motion).into_iter().enumerate() {
        let reference = motion.vehicle.simulate(&motion.manoeuvre, Integrator::Rk4).unwrap();
        let column = |channel| reference.series.require(channel).unwrap();
        let last = motion.path.points.last().unwrap();
        let idx = (last.time_s / 0.01).round() as usize;
        let idx = idx.min(reference.series.n_samples() - 1);
        let off_m = (last.x_m - column(Channel::X)[idx]).hypot(last.y_m - column(Channel::Y)[idx]);
        // The last step may end within an interval of 10 ms of the reference.
        let moved_m = 0.01 * last.vx_body_m_s.hypot(last.vy_body_m_s);
        assert!(off_m < 0.1 + moved_m, "particle {i}: {off_m} m off at {} s", last.time_s);
        let momentum = motion.impact.unwrap().solution.impulse_world_n_s[1];
        assert!(momentum >= 0.0, "particle {i}: pushed out of the struck side");
    }
}

#[test]
fn one_scale_that_weighed_both_cars_errs_for_both_alike() {
    let mut weighed = evidence();
    weighed.weighing = Some(Weighing { shared_scale_sigma: Some(0.01) });
    let target = target(&weighed);
    let prior = target.model().prior();
    let is_scale = |component: &PriorComponent| component.latent == Latent::MassScaleFactor;
    let scale = prior.components().iter().position(is_scale).unwrap();
    let mut z = particles(target.dim()).swap_remove(0);
    let masses = |z: &[f64]| {
        let values = prior.values(z);
        [Latent::StruckMass, Latent::StrikingMass].map(|mass| values.get(mass))
    };
    z[scale] = 0.0;
    let before = masses(&z);
    z[scale] = 2.0;
    for (after, before) in masses(&z).iter().zip(before) {
        assert!((after / before / 0.02_f64.exp() - 1.0).abs() < 1e-4, "{after} {before}");
    }
}

#[test]
fn every_distribution_says_who_gave_it() {
    let source_of = |evidence: &Evidence, vehicle: Option<&VehicleParameters>, latent: Latent| {
        let prior = Prior::new(evidence, &Cars::new(evidence, vehicle, vehicle));
        let of_latent = prior.components().iter().find(|component| component.latent == latent);
        of_latent.map(|component| component.source)
    };
    let found = evidence();
    let mut ranged = found.clone();
    ranged.prior.struck_speed_m_s = Some([10.0, 30.0].map(Some));
    ranged.prior.restitution = Some([0.1, 0.3].map(Some));
    ranged.weighing = Some(Weighing { shared_scale_sigma: Some(0.01) });
    let mut unknown = found.clone();
    (unknown.friction, unknown.struck_car.mass_kg) = (None, None);
    let mut dragged = found.clone();
    let drag_factor = Some(Measured { value: 0.66, sigma: 0.04 }.into());
    dragged.friction = Some(Road { drag_factor, ..Road::default() });
    let mut angled = found.clone();
    angled.damage.angle_rad = Some(Measured { value: 0.3, sigma: 0.1 }.into());
    let known = Preset::Reference.parameters();
    assert!(known.sheet.is_none(), "every parameter of it is known");
    let any = None;
    for (evidence, vehicle, latent, source) in [
        (&found, any, Latent::StruckSpeed, Some(PriorSource::Assumed)),
        (&ranged, any, Latent::StruckSpeed, Some(PriorSource::Given)),
        (&found, any, Latent::RestitutionShare, Some(PriorSource::Assumed)),
        (&ranged, any, Latent::RestitutionShare, Some(PriorSource::Given)),
        (&ranged, any, Latent::MassScaleFactor, Some(PriorSource::Given)),
        (&found, any, Latent::HeadingTowards, Some(PriorSource::Assumed)),
        (&angled, any, Latent::HeadingTowards, Some(PriorSource::Measured)),
        (&found, any, Latent::ContactAlong, Some(PriorSource::Measured)),
        (&found, any, Latent::RoadFriction, Some(PriorSource::Measured)),
        (&unknown, any, Latent::RoadFriction, Some(PriorSource::Assumed)),
        (&dragged, any, Latent::RoadFriction, Some(PriorSource::Estimated)),
        (&found, any, Latent::StruckMass, Some(PriorSource::Measured)),
        (&unknown, any, Latent::StruckMass, Some(PriorSource::Estimated)),
        (&unknown, Some(&known), Latent::StruckMass, Some(PriorSource::Given)),
        (&found, any, Latent::YawInertiaFactor, Some(PriorSource::Estimated)),
        // What is known is not in the prior.
        (&found, Some(&known), Latent::YawInertiaFactor, None),
        (&found, any, Latent::BrakeStart, Some(PriorSource::Assumed)),
    ] {
        assert_eq!(source_of(evidence, vehicle, latent), source, "{latent:?}");
    }
}

#[test]
fn a_mirror_scene_has_the_mirror_likelihood() {
    let (scene, mirror) = (target(&evidence()), target(&evidence().mirrored()));
    let z = particles(scene.dim());
    let steer = scene.model().prior().components();
    let steer = steer.iter().position(|component| component.latent == Latent::SteerAngle).unwrap();
    let mirrored: Vec<Vec<f64>> = z
        .iter()
        .map(|z| {
            let mut z = z.clone();
            z[steer] = -z[steer];
            z
        })
        .collect();
    let likelihoods = [scene.log_likelihoods(&z), mirror.log_likelihoods(&mirrored)];
    for (i, (a, b)) in likelihoods[0].iter().zip(&likelihoods[1]).enumerate() {
        assert!(a.is_finite() && (a - b).abs() < 1e-3 * a.abs().max(1.0), "particle {i}: {a} {b}");
    }
    assert!(likelihoods[0].iter().any(|a| (a - likelihoods[0][0]).abs() > 1.0));
}

fn pose_of(evidence: &mut Evidence) -> &mut RestPose {
    evidence.rest.as_mut().unwrap()
}

#[test]
fn evidence_of_the_own_motion_is_explained_and_other_evidence_is_not() {
    let mut found = evidence();
    let before = target(&found);
    let z = vec![particles(before.dim())[3].clone()];
    let rest = before.model().motions(&z, |motion| *motion.path.points.last().unwrap());
    let pose = pose_of(&mut found);
    (pose.x_m, pose.y_m) = (Some(rest[0].x_m), Some(rest[0].y_m));
    pose.heading_rad.as_mut().unwrap().value = Some(wrap_angle_rad(rest[0].yaw_rad));
    found.marks.clear();
    found.edr = None;
    let fit = |found: &Evidence| {
        let target = target(found);
        EvidenceFit::from_particles(&target.model().motions(&z, |motion| target.terms(&motion)))
    };
    let own = fit(&found);
    let of_rest = |fit: &[EvidenceFit]| -> Vec<f64> {
        fit.iter().filter(|item| item.evidence.starts_with("rest")).map(|item| item.p).collect()
    };
    assert!(of_rest(&own).iter().all(|p| *p > 0.5), "{own:?}");
    pose_of(&mut found).y_m = Some(rest[0].y_m + 60.0);
    let other = fit(&found);
    assert!(
        other.iter().any(|item| item.evidence == "rest y" && item.is_unexplained()),
        "{other:?}"
    );
}

#[test]
fn the_quantities_of_the_prior_give_a_closed_collision_at_each_side() {
    for (side, place) in [
        ("left", "x_m = 0.5"),
        ("right", "x_m = 0.5"),
        ("front", "y_m = 0.2"),
        ("rear", "y_m = -0.3"),
    ] {
        let text =
            case().replace("side = \"right\"\nx_m = -1.7", &format!("side = \"{side}\"\n{place}"));
        let target = target(&read(&text));
        let prior = target.model().prior();
        let approach = particles(target.dim())
            .iter()
            .map(|z| target.model().impact(&prior.values(z)))
            .filter(|impact| impact.solution.impulse_normal_n_s > 0.0)
            .inspect(|impact| {
                assert!(impact.solution.dissipated_energy_j >= 0.0, "{side}: {impact:?}");
            })
            .count();
        assert!(approach > 0, "{side}: no particle touches");
    }
}

#[test]
fn cars_that_draw_apart_are_no_explanation_of_damage() {
    let target = target(&read(SPIN));
    let components = target.model().prior().components();
    let inwards = |it: &PriorComponent| it.latent == Latent::SideslipTowards;
    let idx = components.iter().position(inwards).unwrap();
    let mut z = vec![vec![0.0; components.len()]; 2];
    z[1][idx] = -3.0; // The striking car moves away from the struck side.
    let is_collision = target.model().motions(&z, |motion| motion.impact.unwrap().is_collision());
    assert_eq!(is_collision, [true, false]);
    let [of_hit, of_miss] = target.log_likelihoods(&z)[..] else { panic!("two motions") };
    assert!(of_hit.is_finite() && of_miss == f64::NEG_INFINITY, "{of_hit} {of_miss}");
}

#[test]
fn a_range_of_the_steering_wheel_says_whether_the_striking_driver_pushes() {
    let push = |range_deg: Option<&str>| {
        let range = range_deg.map(|range| format!("bullet_steering_wheel_deg = {range}\n"));
        let evidence = read(&format!("{SPIN}\n[prior]\n{}", range.unwrap_or_default()));
        let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
        let model = model.through_later_contacts(&evidence);
        let sources = [Latent::PushDecision, Latent::PushSteeringWheel].map(|latent| {
            let of_latent = |it: &&PriorComponent| it.latent == latent;
            model.prior().components().iter().find(of_latent).map(|it| it.source)
        });
        let z = vec![0.0; model.prior().components().len()];
        (sources, model.prior().values(&z).striking_pushes())
    };
    let [assumed, given] = [PriorSource::Assumed, PriorSource::Given].map(Some);
    assert_eq!(push(None).0, [assumed, assumed]);
    assert_eq!(push(Some("[90, 180]")), ([None, given], true));
    assert_eq!(push(Some("[0, 5]")), ([None, None], false));
}

#[test]
fn an_anti_lock_system_that_is_said_acts_on_the_brakes_of_its_car() {
    let mut evidence = read(SPIN);
    evidence.striking_rest =
        Some(RestPose { x_m: Some(40.0), y_m: Some(3.0), ..RestPose::default() });
    for after in [&mut evidence.after, &mut evidence.striking_after] {
        after.driver_braked = YesNoUnknown::Yes;
    }
    let has_abs = |evidence: &Evidence| {
        let model = ForwardModel::new(evidence, Cars::new(evidence, None, None));
        let z = vec![0.0; model.prior().components().len()];
        let [motion] = &model.motions(&[z], |motion| motion)[..] else { panic!("one") };
        let striking = &motion.striking.as_ref().unwrap().manoeuvre;
        [&motion.manoeuvre, striking].map(|manoeuvre| {
            let closed_loop = manoeuvre.controls.closed_loop.as_ref();
            closed_loop.is_some_and(|it| it.abs.is_some() && it.brake.is_some())
        })
    };
    assert_eq!(has_abs(&evidence), [false, false]);
    evidence.after.anti_lock = YesNoUnknown::Yes;
    assert_eq!(has_abs(&evidence), [true, false]);
    evidence.striking_after.anti_lock = YesNoUnknown::Yes;
    assert_eq!(has_abs(&evidence), [true, true]);
    evidence.after.anti_lock = YesNoUnknown::No;
    assert_eq!(has_abs(&evidence), [false, true]);
}

#[test]
fn the_wheels_stand_on_the_zones_of_the_ground() {
    let evidence = evidence();
    let cars = Cars::new(&evidence, None, None);
    let road = ForwardModel::new(&evidence, cars.clone());
    let border_m = vec![[10.0, -40.0], [200.0, -40.0], [200.0, 40.0], [10.0, 40.0]];
    let ice = FrictionZone { name: "ice".to_owned(), border_m, friction: 0.2 };
    let none = road.clone().on_zones(Vec::new());
    let icy = road.clone().on_zones(vec![ice]);
    let n = road.prior().components().len();
    assert_eq!(none.prior().components(), road.prior().components());
    assert_eq!(icy.prior().components().len(), n + 1);
    let travelled_m = |model: &ForwardModel, z: &[f64]| {
        let [motion] = &model.motions(&[z.to_vec()], |motion| motion)[..] else { panic!("one") };
        let pairs = motion.path.points.windows(2);
        let way = pairs.map(|p| (p[1].x_m - p[0].x_m).hypot(p[1].y_m - p[0].y_m)).sum::<f64>();
        (way, motion.manoeuvre.friction_zones.first().map(|zone| zone.friction))
    };
    // 20 m/s.
    let mut z = vec![0.0; n + 1];
    z[0] = -0.43;
    let (on_road, of_road) = travelled_m(&road, &z[..n]);
    let (on_ice, of_ice) = travelled_m(&icy, &z);
    assert_eq!(of_road, None);
    assert!((of_ice.unwrap() - 0.2 * 1.02).abs() < 1e-3, "tires are a little better: {of_ice:?}");
    assert!(on_ice > 1.5 * on_road, "{on_ice} m on ice, {on_road} m on the road");
    // A zone that is better than the site says stops the car earlier; the friction stays in its range.
    z[n] = 2.0;
    let (on_better, of_better) = travelled_m(&icy, &z);
    assert!(on_better < on_ice && of_better.unwrap() > 1.3 * of_ice.unwrap(), "{on_better}");
}

/// The yaw rate of the impulse alone was given for that after the contact, which the tires hold back.
#[test]
fn the_yaw_rate_after_the_impact_is_that_of_the_simulation_at_the_end_of_the_contact() {
    let target = target(&evidence());
    let model = target.model();
    let z = particles(target.dim());
    let values: Vec<LatentValues> = z.iter().map(|z| model.prior().values(z)).collect();
    let rates = model.yaw_rates_after_rad_s(&values);
    let motions = model.motions(&z, |motion| motion);
    for (rate, motion) in rates.iter().zip(&motions) {
        let simulated = motion.vehicle.simulate(&motion.manoeuvre, Integrator::Rk4).unwrap().series;
        let end_s = motion.values.get(Latent::PulseDuration);
        let yaw_rates = simulated.get(Channel::YawRate).unwrap();
        let expected = interpolate(simulated.time_s(), yaw_rates, end_s).unwrap();
        assert!((rate - expected).abs() < 0.01, "{rate} {expected}");
    }
    let of_impulse =
        motions.iter().map(|motion| motion.impact.unwrap().solution.struck.yaw_rate_rad_s);
    let changed = rates
        .iter()
        .zip(of_impulse)
        .filter(|(rate, free)| (*rate - free).abs() > 0.02 * free.abs());
    assert!(changed.count() > rates.len() / 2, "{rates:?}");
}
