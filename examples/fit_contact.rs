//! Fits restitution and friction limit of the momentum solution to the impulses of a force data set.
//!
//! The normal lies across the target. The test cases of the data set (seed 0) are left out of every
//! fit, and cases in which the vehicles hook or stay together out of the fit alone. Minimised is the
//! mean of `|P̂ − P| / |P|` over the training cases; printed are its median and mean over training and
//! test cases, beside what the impulses of single cases imply.
//!
//! The argument is the data set:
//!
//! `cargo run --release --example fit_contact -- datasets/fea`

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::collision::{
    ContactDistribution, DEFAULT_FRICTION_LIMIT, DEFAULT_RESTITUTION, Impact, ImpliedContact,
    RestitutionForm,
};
use impactlab_core::data::Dataset;
use impactlab_core::numerics::Summary;
use impactlab_networks::force::{ContactLaw, ForceCase};
use impactlab_networks::learning::{TEST_SHARE, split};

/// Steps of the grid over e and over μ_c, each from 0 to 1.
const N_STEPS: usize = 100;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("expected: DATASET")?;
    let mut go_on = |_| ControlFlow::Continue(());
    let dataset = Dataset::load(Path::new(&path), &mut go_on)?.complete().ok_or("cancelled")?;
    let (cases, problems) = ForceCase::from_dataset(&dataset);
    if let Some(problem) = problems.into_iter().next() {
        return Err(problem.into());
    }
    let split = split(&cases, 0, TEST_SHARE);
    let of = |indices: &[usize]| -> Vec<&ForceCase> {
        indices.iter().filter_map(|&idx| cases.get(idx)).collect()
    };
    let (train, test) = (of(&split.train), of(&split.test));
    let clean: Vec<&ForceCase> = train.iter().copied().filter(|case| case.is_clean()).collect();
    println!(
        "{} training cases, {} without hooking, {} test cases",
        train.len(),
        clean.len(),
        test.len()
    );
    let closing =
        clean.iter().filter_map(|case| Some(case.scenario.likely_impact()?.closing_speed_m_s()));
    if let Some(of) = Summary::from_values(closing) {
        println!("closing speed {:.1} to {:.1} m/s", of.min, of.max);
    }
    for form in RestitutionForm::ALL {
        let mut best = (f64::INFINITY, [0.0; 2]);
        for i in 0..=N_STEPS {
            for j in 0..=N_STEPS {
                let surface = [i, j].map(|k| k as f64 / N_STEPS as f64);
                let errors = Summary::from_values(errors(&clean, surface, form));
                let error = errors.map_or(f64::INFINITY, |of| of.mean);
                if error < best.0 {
                    best = (error, surface);
                }
            }
        }
        println!("\nrestitution {}: e = {}, μ_c = {}", form.label(), best.1[0], best.1[1]);
        for (name, cases) in [("training", &clean), ("test", &test)] {
            let of_default = [DEFAULT_RESTITUTION, DEFAULT_FRICTION_LIMIT];
            for (what, surface) in [("fitted", best.1), ("default", of_default)] {
                let Some(of) = Summary::from_values(errors(cases, surface, form)) else { continue };
                let [median, mean] = [of.median, of.mean].map(|share| 100.0 * share);
                println!("  {what:8} {name:9} median {median:5.1} %, mean {mean:5.1} %");
            }
        }
    }
    let implied: Vec<ImpliedContact> = clean
        .iter()
        .filter_map(|case| impact(case, [0.0; 2])?.implied_contact(case.impulse_n_s))
        .collect();
    println!("\nimplied by single cases, 5 to 95 %: {:?}", ContactDistribution::fit(&implied));
    Ok(())
}

fn impact(case: &ForceCase, [restitution, friction_limit]: [f64; 2]) -> Option<Impact> {
    let slow = ContactLaw::at_closing_speed(0.0);
    case.scenario.impact(ContactLaw { restitution, friction_limit, ..slow })
}

/// `|P̂ − P| / |P|` of each case.
fn errors(cases: &[&ForceCase], surface: [f64; 2], form: RestitutionForm) -> Vec<f64> {
    let error = |case: &&ForceCase| {
        let mut impact = impact(case, surface)?;
        impact.surface.restitution_form = form;
        let ([px, py], [qx, qy]) = (impact.solve().ok()?.impulse_world_n_s, case.impulse_n_s);
        Some((px - qx).hypot(py - qy) / qx.hypot(qy))
    };
    cases.iter().filter_map(error).collect()
}
