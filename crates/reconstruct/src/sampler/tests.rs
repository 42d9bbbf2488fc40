//! The sampler against posteriors that are known, and against being stopped.

use std::ops::ControlFlow;

use rand::RngExt;

use super::test_targets::{Function, LinearGaussian, bimodal, discontinuous, normal};
use super::*;
use impactlab_core::numerics::{normal_cdf, random_stream};

fn run(target: &(impl Target + ?Sized), settings: SamplerSettings) -> Particles {
    sample(target, &settings, None, &mut |_| ControlFlow::Continue(())).unwrap()
}

fn seed(seed: u64) -> SamplerSettings {
    SamplerSettings { seed, ..SamplerSettings::default() }
}

fn mean(particles: &Particles, value: impl Fn(&[f64]) -> f64) -> f64 {
    particles.z.iter().map(|z| value(z)).sum::<f64>() / particles.z.len() as f64
}

/// A curved posterior with a mode that is hard to find: a car that is braked stops where one that rolls
/// out from a fifth of its speed does, in sixteen dimensions of which thirteen hardly matter. Reference:
/// draws from the prior, weighted.
#[test]
fn a_mode_in_a_corner_of_a_curved_posterior_is_not_lost() {
    let log_likelihood = |z: &[f64]| {
        let speed_m_s = 30.0 * normal_cdf(z[0] + 0.05 * z[3..].iter().sum::<f64>());
        let deceleration_m_s2 =
            if z[1] < 0.7 { 6.0 * (0.4 * z[2]).exp() } else { 0.25 * (0.4 * z[2]).exp() };
        normal(speed_m_s * speed_m_s / (2.0 * deceleration_m_s2), 30.0, 0.5)
    };
    let target = Function { dim: 16, log_likelihood };
    let share = |z: &[f64]| f64::from(u8::from(z[1] >= 0.7));
    let n = 400_000;
    let mut rng = random_stream(1, "reference", 0);
    let prior: Vec<Vec<f64>> = (0..n).map(|_| standard_normals(16, &mut rng)).collect();
    let weights: Vec<f64> = target.log_likelihoods(&prior).iter().map(|l| l.exp()).collect();
    let sum: f64 = weights.iter().sum();
    let expected = weights.iter().zip(&prior).map(|(w, z)| w * share(z)).sum::<f64>() / sum;
    let reference_ess = sum * sum / weights.iter().map(|w| w * w).sum::<f64>();
    for n in 1..=3 {
        let settings = SamplerSettings { n_particles: 500, max_evaluations: 60_000, ..seed(n) };
        let particles = run(&target, settings);
        let found = mean(&particles, share);
        let ess = particles.ess.min(500.0).min(reference_ess);
        let error = (2.0 * expected * (1.0 - expected) / ess).sqrt();
        assert!(
            (found - expected).abs() < 4.0 * error,
            "seed {n}: {found} for {expected} ± {error}"
        );
        let log_evidence = (sum / prior.len() as f64).ln();
        assert!((particles.log_evidence - log_evidence).abs() < 0.3, "{}", particles.log_evidence);
    }
}

/// Draws of a posterior by rejection, of 200 000 from the prior: `z ~ N(0, I)`, kept with the probability
/// `L(z) / L_max`. With the estimate of the log evidence, `ln L_max + ln (kept / drawn)`.
///
/// - `log_bound`: `ln L_max`, which no log likelihood exceeds.
fn rejected(target: &impl Target, log_bound: f64) -> (Vec<Vec<f64>>, f64) {
    let (n_batches, n) = (200_u32, 1000_u32);
    let mut rng = random_stream(1, "rejection", 0);
    let mut kept = Vec::new();
    for _ in 0..n_batches {
        let z: Vec<Vec<f64>> = (0..n).map(|_| standard_normals(target.dim(), &mut rng)).collect();
        for (value, z) in target.log_likelihoods(&z).into_iter().zip(z) {
            assert!(value <= log_bound, "a log likelihood of {value} is above {log_bound}");
            if rng.random::<f64>().ln() < value - log_bound {
                kept.push(z);
            }
        }
    }
    let share = kept.len() as f64 / f64::from(n_batches * n);
    (kept, log_bound + share.ln())
}

/// A speed from the distance of a slide with unknown friction, with a share of the courses that have
/// braked: curved, with two modes, in three dimensions.
#[test]
fn a_tiny_question_has_the_draws_of_rejection() {
    type Value<'a> = &'a dyn Fn(&[f64]) -> f64;
    let log_likelihood = |z: &[f64]| {
        let (speed, friction) = (20.0 + 4.0 * z[0], 0.7 * (0.2 * z[1]).exp());
        let braked = if z[2] > 0.8 { 1.0 } else { 0.4 };
        normal(speed * speed / (2.0 * 9.81 * friction * braked) / 60.0, 1.0, 0.1)
    };
    let target = Function { dim: 3, log_likelihood };
    let (reference, log_evidence) = rejected(&target, normal(1.0, 1.0, 0.1));
    let found = run(&target, seed(2));
    let moments = |z: &[Vec<f64>], value: Value<'_>| {
        let mean = z.iter().map(|z| value(z)).sum::<f64>() / z.len() as f64;
        let square = z.iter().map(|z| (value(z) - mean).powi(2)).sum::<f64>();
        (mean, (square / z.len() as f64).sqrt())
    };
    let values: [Value<'_>; 4] =
        [&|z| z[0], &|z| z[1], &|z| z[0] * z[1], &|z| f64::from(u8::from(z[2] > 0.8))];
    let n = found.ess.min(found.z.len() as f64);
    for (idx, value) in values.iter().enumerate() {
        let (expected, std) = moments(&reference, value);
        let (mean, found_std) = moments(&found.z, value);
        let error = 5.0 * std * (1.0 / n + 1.0 / reference.len() as f64).sqrt();
        assert!((mean - expected).abs() < error, "{idx}: {mean} for {expected} ± {error}");
        assert!((found_std / std - 1.0).abs() < 0.2, "{idx}: {found_std} for {std}");
    }
    let difference = found.log_evidence - log_evidence;
    assert!(difference.abs() < 0.15, "log evidence differs by {difference}");
}

/// Means, variances and evidence of measurements down to 0.004 of the prior's width, within five
/// standard errors at the effective sample size.
#[test]
fn a_narrow_correlated_posterior_is_that_of_the_closed_form() {
    let target = LinearGaussian::narrow();
    let (expected, covariance, log_evidence) = target.closed_form();
    let particles = run(&target, SamplerSettings { n_particles: 1000, ..seed(1) });
    assert!(particles.is_posterior() && particles.ess >= 400.0, "ESS {}", particles.ess);
    assert!(particles.n_evaluations <= 60_000, "{} evaluations", particles.n_evaluations);
    let n = particles.ess.min(particles.z.len() as f64);
    for j in 0..20 {
        let found = mean(&particles, |z| z[j]);
        let error = (covariance[(j, j)] / n).sqrt();
        assert!((found - expected[j]).abs() < 5.0 * error, "mean of {j}: {found}, {expected}");
        let variance = mean(&particles, |z| (z[j] - expected[j]).powi(2));
        let share = variance / covariance[(j, j)] - 1.0;
        assert!(share.abs() < 5.0 * (2.0 / n).sqrt(), "variance of {j}: {share:+}");
    }
    let error = particles.log_evidence - log_evidence;
    assert!(error.abs() < 0.4, "log evidence {} for {log_evidence}", particles.log_evidence);
}

#[test]
fn two_separate_modes_have_their_weights() {
    for n in 1..=3 {
        let particles = run(&bimodal(), seed(n));
        let upper = mean(&particles, |z| f64::from(u8::from(z[0] > 0.0)));
        // Standard deviation of this estimate over sixteen seeds: 0.01.
        assert!((upper - 0.8).abs() < 0.04, "seed {n}: {upper}");
    }
}

#[test]
fn a_threshold_divides_the_posterior_as_the_evidence_says() {
    let density = |x: f64, variance: f64| (-x * x / (2.0 * variance)).exp();
    let evidence = |prior: f64, a: f64, b: f64| prior * density(a, 1.0025) * density(b, 1.0925);
    let locked = evidence(1.0 - normal_cdf(0.5), -1.2, -0.5);
    let free = evidence(normal_cdf(0.5), 0.3, 0.3);
    for n in 1..=3 {
        let particles = run(&discontinuous(), seed(n));
        let found = mean(&particles, |z| f64::from(u8::from(z[0] > 0.5)));
        let expected = locked / (locked + free);
        assert!((found - expected).abs() < 0.05, "seed {n}: {found} for {expected}");
        assert!(particles.z.iter().all(|z| z[6] <= 1.0));
    }
}

#[test]
fn a_mirrored_target_has_the_mirrored_posterior() {
    let skew = |sign: f64| {
        let log_likelihood = move |z: &[f64]| {
            normal((sign * z[0]).exp() + z[1], 3.0, 0.1) + normal(sign * z[0] * z[2], 0.5, 0.2)
        };
        run(&Function { dim: 4, log_likelihood }, seed(5))
    };
    let (plain, mirrored) = (skew(1.0), skew(-1.0));
    let [a, b] = [mean(&plain, |z| z[0]), mean(&mirrored, |z| z[0])];
    let spread = mean(&plain, |z| (z[0] - a).powi(2)).sqrt();
    let error = spread / plain.ess.min(mirrored.ess).min(2000.0).sqrt();
    assert!((a + b).abs() < 5.0 * error && a > 0.5, "{a} and {b}, error {error}");
    assert!((plain.log_evidence - mirrored.log_evidence).abs() < 0.3);
}

#[test]
fn the_same_seed_gives_the_same_particles_on_any_number_of_threads() {
    let small = SamplerSettings { n_particles: 200, max_evaluations: 4000, ..seed(3) };
    let on = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| run(&discontinuous(), small))
    };
    assert_eq!(on(1), on(2));
    assert_ne!(on(1), run(&discontinuous(), SamplerSettings { seed: 4, ..small }));
}

#[test]
fn evidence_that_is_impossible_everywhere_is_said() {
    for value in [f64::NEG_INFINITY, f64::NAN] {
        let target = Function { dim: 3, log_likelihood: move |_: &[f64]| value };
        let error = sample(&target, &seed(0), None, &mut |_| ControlFlow::Continue(()));
        let message = error.unwrap_err().to_string();
        assert!(
            message.starts_with("the evidence is impossible for each of 15000 draws"),
            "{message}"
        );
    }
    let infinite = Function { dim: 3, log_likelihood: |_: &[f64]| f64::INFINITY };
    let error = sample(&infinite, &seed(0), None, &mut |_| ControlFlow::Continue(()));
    assert!(matches!(error, Err(SamplerError::InfiniteLikelihood)));
}

#[test]
fn settings_out_of_range_are_refused_and_two_particles_are_enough() {
    let target = Function { dim: 2, log_likelihood: |z: &[f64]| normal(z[0], 1.0, 0.1) };
    for wrong in [
        SamplerSettings { n_particles: 1, ..seed(0) },
        SamplerSettings { least_ess: f64::NAN, ..seed(0) },
        SamplerSettings { max_evaluations: 10, ..seed(0) },
    ] {
        let error = sample(&target, &wrong, None, &mut |_| ControlFlow::Continue(()));
        assert!(matches!(error, Err(SamplerError::Setting { .. })), "{wrong:?}");
    }
    let two = SamplerSettings { n_particles: 2, max_evaluations: 500, ..seed(0) };
    let particles = run(&target, two);
    assert_eq!(particles.z.len(), 2);
    assert!(particles.z.iter().flatten().all(|z| z.is_finite()) && particles.ess >= 1.0);
}

#[test]
fn a_flat_likelihood_gives_back_the_prior() {
    let particles = run(&Function { dim: 3, log_likelihood: |_: &[f64]| -2.0 }, seed(2));
    assert!((particles.log_evidence + 2.0).abs() < 0.01, "{}", particles.log_evidence);
    for j in 0..3 {
        assert!(mean(&particles, |z| z[j]).abs() < 0.15);
        assert!((mean(&particles, |z| z[j] * z[j]) - 1.0).abs() < 0.2);
    }
}

#[test]
fn what_was_sampled_until_a_cancellation_is_kept_and_said_to_be_no_posterior() {
    let target = LinearGaussian::narrow();
    for stop_at in [1, 3, 20] {
        let mut n_reports = 0;
        let mut first = 0;
        let particles = sample(&target, &seed(1), None, &mut |report| {
            n_reports += 1;
            first = if n_reports == 1 { report.z.len() } else { first };
            if n_reports < stop_at { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        let particles = particles.unwrap();
        assert_eq!(
            (n_reports, first),
            (stop_at, 250),
            "an eighth of the particles is shown at once"
        );
        assert_eq!(particles.z.len(), 2000);
        assert!(!particles.is_posterior() && particles.temperature < 0.1);
    }
}

/// A target of which some particles at once take a third of a second.
struct Slow {
    is_possible: bool,
}

impl Target for Slow {
    fn dim(&self) -> usize {
        1
    }

    fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64> {
        std::thread::sleep(std::time::Duration::from_millis(300));
        let log = match self.is_possible {
            true => 0.0,
            false => f64::NEG_INFINITY,
        };
        z.iter().map(|z| log + normal(z[0], 1.0, 0.5)).collect()
    }
}

/// Motions through several contacts take so long that a batch of them went on for half a minute after a run
/// was cancelled.
#[test]
fn a_run_of_slow_motions_stops_within_a_batch() {
    let stop = &mut |_: SamplerReport<'_>| ControlFlow::Break(());
    let stopped = sample(&Slow { is_possible: true }, &seed(1), None, stop).unwrap();
    assert!(stopped.is_stopped && stopped.n_evaluations < 100, "{}", stopped.n_evaluations);
    assert_eq!(stopped.z.len(), 2000);
}

/// It went on to the end of the batch, and then the evidence was said to be impossible.
#[test]
fn a_run_that_is_stopped_before_a_motion_explains_the_evidence_stops_at_once() {
    let stop = &mut |_: SamplerReport<'_>| ControlFlow::Break(());
    let stopped = sample(&Slow { is_possible: false }, &seed(1), None, stop);
    let Err(SamplerError::Stopped { n_evaluations }) = stopped else { panic!("{stopped:?}") };
    assert!(n_evaluations < 100, "{n_evaluations}");
}

#[test]
fn a_posterior_of_which_there_is_hardly_a_draw_is_answered_as_that_of_noisier_measurements() {
    let settings = SamplerSettings { n_particles: 400, max_evaluations: 4500, ..seed(3) };
    let particles = run(&LinearGaussian::narrow(), settings);
    assert!(
        particles.is_weakened() && particles.posterior_ess < 100.0,
        "{}",
        particles.temperature
    );
    assert!((particles.ess - 200.0).abs() < 1.0, "{}", particles.ess);
    let noisier = LinearGaussian::narrow().with_noise_times(particles.sigma_factor());
    let (means, covariance, _) = noisier.closed_form();
    for j in 0..20 {
        let std = covariance[(j, j)].sqrt();
        let by_particles = mean(&particles, |z| z[j]);
        assert!((by_particles - means[j]).abs() < 0.35 * std, "{j}: {by_particles} {}", means[j]);
        let variance = mean(&particles, |z| (z[j] - by_particles).powi(2));
        assert!((0.6..1.5).contains(&(variance.sqrt() / std)), "{j}: {}", variance.sqrt() / std);
    }
}

#[test]
fn a_run_that_is_stopped_anywhere_goes_on_to_the_same_particles() {
    let folder = tempfile::tempdir().unwrap();
    let target = discontinuous();
    let settings = SamplerSettings { n_particles: 160, max_evaluations: 3000, ..seed(9) };
    let whole = run(&target, settings);
    let mut n_batches = 0;
    let count = &mut |_: SamplerReport<'_>| {
        n_batches += 1;
        ControlFlow::Continue(())
    };
    sample(&target, &settings, None, count).unwrap();
    for stop_at in (1..n_batches).step_by(5) {
        let path = folder.path().join("run.cbor");
        let _ = std::fs::remove_file(&path);
        let at = SamplerCheckpoint { path, digest: "of the evidence".to_owned(), resume: true };
        let mut n = 0;
        let cancel = &mut |_: SamplerReport<'_>| {
            n += 1;
            if n < stop_at { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        sample(&target, &settings, Some(&at), cancel).unwrap();
        let resumed = sample(&target, &settings, Some(&at), &mut |_| ControlFlow::Continue(()));
        assert_eq!(resumed.unwrap(), whole, "stopped at batch {stop_at} of {n_batches}");
    }
}

#[test]
fn a_checkpoint_of_another_question_or_of_nothing_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.cbor");
    let target = Function { dim: 2, log_likelihood: |z: &[f64]| normal(z[0], 1.0, 0.1) };
    let settings = SamplerSettings { n_particles: 50, max_evaluations: 1000, ..seed(0) };
    let resume = |digest: &str, settings: &SamplerSettings, dim: usize| {
        let at = SamplerCheckpoint { path: path.clone(), digest: digest.to_owned(), resume: true };
        let target = Function { dim, log_likelihood: &target.log_likelihood };
        let result = sample(&target, settings, Some(&at), &mut |_| ControlFlow::Continue(()));
        result.map_err(|error| error.to_string())
    };
    resume("a", &settings, 2).unwrap();
    let message = |error: Result<Particles, String>| error.unwrap_err();
    assert!(message(resume("b", &settings, 2)).ends_with("had another question"));
    let other = SamplerSettings { seed: 1, ..settings };
    assert!(message(resume("a", &other, 2)).ends_with("had another seed"));
    assert!(message(resume("a", &settings, 3)).contains("as many finite numbers"));
    // A bit that has turned over is found wherever it is, and nobody else writes the file meanwhile.
    let whole = std::fs::read(&path).unwrap();
    for at in (0..whole.len()).step_by(whole.len() / 50) {
        let mut flipped = whole.clone();
        flipped[at] ^= 1 << (at % 8);
        std::fs::write(&path, flipped).unwrap();
        let error = message(resume("a", &settings, 2));
        assert!(error.contains("checksum does not fit"), "byte {at}: {error}");
    }
    std::fs::write(&path, &whole).unwrap();
    let claim = impactlab_core::data::write::WriterLock::lock_file(&path).unwrap();
    assert!(message(resume("a", &settings, 2)).contains("process"));
    drop(claim);
    resume("a", &settings, 2).unwrap();
    std::fs::write(&path, b"no checkpoint").unwrap();
    assert!(message(resume("a", &settings, 2)).contains("cannot be read as the checkpoint"));
}

#[test]
fn a_start_elsewhere_changes_nothing_but_the_draws() {
    let before = Function { dim: 1, log_likelihood: |z: &[f64]| normal(z[0], -1.0, 0.2) };
    let target = Function {
        dim: 2,
        log_likelihood: |z: &[f64]| normal(z[0], 1.0, 0.1) + normal(z[1], 0.5, 0.1),
    };
    let settings = SamplerSettings { n_particles: 400, max_evaluations: 40_000, ..seed(4) };
    let start = run(&before, settings).start;
    let started =
        sample_from(Some(&start), &target, &settings, None, &mut |_| ControlFlow::Continue(()));
    let started = started.unwrap();
    assert!(started.is_posterior() && started.ess >= settings.least_ess, "{}", started.ess);
    // Product of two normals: mean y / (1 + σ²), variance σ² / (1 + σ²).
    for (axis, of_likelihood) in [1.0, 0.5].into_iter().enumerate() {
        let found = mean(&started, |z| z[axis]);
        assert!((found - of_likelihood / 1.01).abs() < 0.025, "{axis}: {found}");
    }
    let cold = run(&target, settings);
    assert!((started.log_evidence - cold.log_evidence).abs() < 0.25, "{}", started.log_evidence);
}
