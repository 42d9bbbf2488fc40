//! The contact law beside finite-element collisions: how far its impulse, its largest force and its
//! duration of the first contact are from those of the runs. Nothing of the law was fitted to them.
//!
//! ```text
//! cargo run --release --example contact_law -- datasets/fea
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::collision::contact::ContactPhase;
use impactlab_core::data::{Dataset, contact_interval};
use impactlab_core::numerics::Summary;
use impactlab_core::vehicle::{Ending, Integrator, Preset};
use impactlab_networks::force::ForceCase;
use impactlab_networks::learning::{TEST_SHARE, split};
use impactlab_study::analysis::{Analysis, ContactPair, Settings, analyse_case};

/// How long a collision is followed, s.
const DURATION_S: f64 = 0.4;

/// Errors of a case, as shares of the recorded values.
struct Errors {
    impulse: f64,
    peak: f64,
    duration: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("expected: a data set of forces")?;
    let mut go_on = |_| ControlFlow::Continue(());
    let dataset = Dataset::load(Path::new(&path), &mut go_on)?.complete().ok_or("cancelled")?;
    let (forces, _) = ForceCase::from_dataset(&dataset);
    let split = split(&forces, 0, TEST_SHARE);
    let settings = Settings {
        struck: Preset::Target.parameters(),
        striking: Preset::Bullet2000.parameters(),
        ending: Ending::default(),
        integrator: Integrator::Rk4,
        duration_s: DURATION_S,
        ends_at_rest: false,
        one_contact: true,
        friction_zones: Vec::new(),
    };
    let errors_of = |name: &str| -> Option<Errors> {
        let case = dataset.cases.iter().find(|case| case.name == name)?;
        errors(&analyse_case(case, &settings).ok()?, &settings)
    };
    println!("| cases | n | impulse [%] | largest force [%] | duration [%] |");
    println!("| --- | --- | --- | --- | --- |");
    for (name, indices) in [("training", &split.train), ("test", &split.test)] {
        let names = indices.iter().filter_map(|&idx| Some(forces.get(idx)?.name.as_str()));
        let found: Vec<Errors> = names.filter_map(errors_of).collect();
        let of = |value: fn(&Errors) -> f64| {
            let summary = Summary::from_values(found.iter().map(value));
            summary.map_or_else(String::new, |it| {
                format!("{:.1} ({:.1})", 100.0 * it.median, 100.0 * it.mean)
            })
        };
        let [impulse, peak, duration] =
            [of(|it| it.impulse), of(|it| it.peak), of(|it| it.duration)];
        println!("| {name} | {} | {impulse} | {peak} | {duration} |", found.len());
    }
    Ok(())
}

/// The first contact by the law beside the recorded one; `None` where there is none.
fn errors(analysis: &Analysis, settings: &Settings) -> Option<Errors> {
    let struck = analysis.struck.as_ref()?;
    let mut striking = analysis.striking.as_ref()?.start.clone();
    let force = analysis.force.as_ref()?;
    let pair = ContactPair::new([struck, &striking]).ok()?;
    // Onto the side that was struck.
    let normal_rad = -std::f64::consts::FRAC_PI_2.copysign(struck.contact.y_body_m);
    pair.close_gap(struck, &mut striking, struck.initial.yaw_rad + normal_rad);
    let moved = pair.simulate([struck, &striking], None, settings).ok()?;
    let (start_s, end_s) = contact_interval(force)?;
    // The runs end with the first separation.
    let first: &ContactPhase = moved.phases.first()?;
    let [px, py] = force.impulse_n_s();
    let [qx, qy] = first.impulse_world_n_s;
    let (peak_n, _) = force.peak()?;
    let duration_s = first.end_s.unwrap_or(settings.duration_s) - first.start_s;
    Some(Errors {
        impulse: (qx - px).hypot(qy - py) / px.hypot(py),
        peak: (first.peak_force_n / peak_n - 1.0).abs(),
        duration: (duration_s / (end_s - start_s) - 1.0).abs(),
    })
}
