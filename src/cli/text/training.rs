//! What was trained, as a person reads it.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;

use crate::cli::console::{print_caveats, print_facts, shown_path};
use impactlab_networks::force::LossTerms;
use impactlab_networks::response::{ForceOrigin, LATENT_NAMES};
use impactlab_study::{Answer, LogReport, ResponseTrainingReport, TrainForceReport};

/// A report of a training, and where its model was written.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct Trained<'a, R: Serialize> {
    /// The file.
    pub(in crate::cli) model: &'a Path,
    /// What was trained.
    #[serde(flatten)]
    pub(in crate::cli) report: &'a R,
}

/// Named losses in one line.
fn losses<'a>(named: impl IntoIterator<Item = (&'a str, f64)>) -> String {
    let shown = named.into_iter().map(|(name, value)| format!("{name} {value:.4}"));
    shown.collect::<Vec<_>>().join(", ")
}

/// Prints what came of a training of the force network.
pub(in crate::cli) fn print_force_training(
    out: &mut dyn Write,
    trained: &Trained<'_, Answer<TrainForceReport>>,
) -> io::Result<()> {
    let report = trained.report;
    let loss = |terms: Option<LossTerms>| terms.map_or(String::new(), |of| losses(of.named()));
    let cases = format!(
        "{} to learn, {} to validate, {} kept for the test",
        report.n_train, report.n_validation, report.n_test
    );
    let factors = &report.variance_factors;
    let factors = format!(
        "{:.2}, {:.2}, {:.2} (latent factors, single instants, duration)",
        factors.shared, factors.single, factors.duration
    );
    let facts = [
        ("model", shown_path(trained.model)),
        ("data", report.data.clone()),
        ("cases", cases),
        ("weights", report.n_parameters.to_string()),
        ("time", format!("{:.0} s", report.seconds)),
        ("best epoch", format!("{} of {}", report.best_epoch, report.epochs)),
        ("variance factors", factors),
        ("training", loss(report.train)),
        ("validation", loss(report.validation)),
    ];
    print_facts(out, &facts)?;
    print_left_out(out, &report.left_out)?;
    print_caveats(out, &report.caveats)
}

/// Prints what came of a training of the response network.
pub(in crate::cli) fn print_response_training(
    out: &mut dyn Write,
    trained: &Trained<'_, Answer<ResponseTrainingReport>>,
) -> io::Result<()> {
    let report = trained.report;
    let scale = |(name, scale): (&&str, f64)| format!("{name} {:.1} %", 100.0 * scale);
    let scales = LATENT_NAMES.iter().zip(report.latents.scales).map(scale);
    let scales = scales.collect::<Vec<_>>().join(", ");
    let calibrated = match report.latents.n_calibrated {
        0 if report.keeps_latents => "a guess: the model before, at least the usual".to_owned(),
        0 => "usual values".to_owned(),
        n => format!("from {n} trajectories, each unseen"),
    };
    let trajectories =
        format!("{} to learn from, {} kept for the test", report.train.len(), report.n_test);
    let facts = [
        ("model", shown_path(trained.model)),
        ("data", report.data.clone()),
        ("trajectories", trajectories),
        ("simulated motions", report.n_simulated.to_string()),
        ("weights", report.n_parameters.to_string()),
        ("time", format!("{:.0} s", report.seconds)),
        ("epochs", report.epochs.to_string()),
        ("uncertainty", format!("{scales} ({calibrated})")),
        ("loss", report.loss.map_or(String::new(), |loss| losses(loss.named()))),
    ];
    print_facts(out, &facts)?;
    for log in &report.logs {
        writeln!(out, "{}", log_line(log))?;
    }
    print_left_out(out, &report.left_out)?;
    print_caveats(out, &report.caveats)
}

fn print_left_out(out: &mut dyn Write, left_out: &[String]) -> io::Result<()> {
    for case in left_out {
        writeln!(out, "left out: {case}")?;
    }
    Ok(())
}

/// What was made of a log, in one line.
fn log_line(log: &LogReport) -> String {
    let LogReport { start_s, n_samples, noise, impulse_n_s: [px, py], .. } = log;
    let contact = match log.contact_s {
        Some([from_s, to_s]) => format!("contact {from_s:.2} s to {to_s:.2} s"),
        None => format!("no contact, from {start_s:.2} s"),
    };
    let force = match log.force {
        ForceOrigin::Recorded => format!("recorded impulse x {px:.1}, y {py:.1} N s"),
        ForceOrigin::Estimated => format!("estimated impulse x {px:.1}, y {py:.1} N s"),
        ForceOrigin::None => "no force".to_owned(),
    };
    let velocity = noise.velocity_m_s.map(|v| format!(", velocity {v:.3} m/s"));
    let rate = noise.yaw_rate_rad_s.map(|r| format!(", yaw rate {:.2} deg/s", r.to_degrees()));
    format!(
        "{}: {contact}, {force}, {n_samples} states; noise: position {:.3} m, yaw {:.2} deg{}{}",
        shown_path(&log.log),
        noise.position_m,
        noise.yaw_rad.to_degrees(),
        velocity.unwrap_or_default(),
        rate.unwrap_or_default()
    )
}
