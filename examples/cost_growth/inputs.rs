//! What is asked about, written before the cost is measured.

use std::fmt::Write as _;
use std::fs;
use std::io::{BufWriter, Write as _};
use std::path::Path;

use crate::Measured;

/// Name of the file of a table of forces.
pub const FORCE_FILE: &str = "force.csv";
/// Name of an evidence file.
pub const EVIDENCE_FILE: &str = "evidence.toml";
/// Name of the plan of a sweep.
pub const PLAN_FILE: &str = "rows.toml";

/// Samples of the force of a case, and the time between two of them, s.
const N_SAMPLES: u64 = 61;
const SAMPLE_S: f64 = 0.002;

const CASE_COLUMNS: &str = "case,m_t_kg,m_b_kg,v_tx_m_s,v_ty_m_s,v_bx_m_s,v_by_m_s,theta_b_rad,\
                            contact_x_m,contact_y_m";

/// Needs nothing.
pub fn nothing(_size: u64, _folder: &Path) -> Measured<()> {
    Ok(())
}

/// A force data set: blows against the right rear quarter, each a haversine of its own height.
pub fn cases(n: u64, folder: &Path) -> Measured<()> {
    let forces = folder.join("forces");
    fs::create_dir(&forces)?;
    let mut table = format!("{CASE_COLUMNS}\n");
    for case in 0..n {
        writeln!(table, "c{case},1500,1600,20,0,21,2,0.2,-1.5,-0.9")?;
        fs::write(forces.join(format!("c{case}.csv")), force(20e3 + 100.0 * (case % 500) as f64)?)?;
    }
    fs::write(folder.join("cases.csv"), table)?;
    Ok(())
}

/// - `peak_n`: largest force across the struck vehicle, N.
fn force(peak_n: f64) -> Measured<String> {
    let mut table = "time_s,fx_n,fy_n,mz_nm\n".to_owned();
    for sample in 0..N_SAMPLES {
        let share = sample as f64 / (N_SAMPLES - 1) as f64;
        let fy_n = peak_n * (std::f64::consts::PI * share).sin().powi(2);
        let (time_s, fx_n, mz_n_m) = (sample as f64 * SAMPLE_S, 0.3 * fy_n, -1.2 * fy_n);
        writeln!(table, "{time_s:.3},{fx_n:.1},{fy_n:.1},{mz_n_m:.1}")?;
    }
    Ok(table)
}

/// A table of a force, of 20 bytes a row, so that 10 million rows stay below the largest file that
/// is read.
pub fn rows(n: u64, folder: &Path) -> Measured<()> {
    let mut out = BufWriter::new(fs::File::create_new(folder.join(FORCE_FILE))?);
    writeln!(out, "time_s,fx_n,fy_n")?;
    for row in 0..n {
        let [fx_n, fy_n] = [row, 7 * row].map(|of| (of % 1000) as f64 / 10.0);
        writeln!(out, "{:.3},{fx_n:.1},{fy_n:.1}", row as f64 * 1e-3)?;
    }
    out.flush()?;
    Ok(())
}

/// Evidence of the example of a place alone with positions in a video. Each is known within 3 m
/// times the root of their number: together they say as much whatever their number is, so that the
/// sampler finds the same posterior.
pub fn evidence(n: u64, folder: &Path) -> Measured<()> {
    let mut text = include_str!("../../docs/guide/examples/position_alone.toml").to_owned();
    let sigma_m = 3.0 * (n as f64).sqrt();
    for item in 1..=n {
        let time_s = item as f64 / n as f64;
        let x_m = 8.0 * time_s;
        writeln!(text, "\n[[position]]\ntime_s = {time_s:.6}\nx_m = {x_m:.4}\ny_m = 0.0")?;
        writeln!(text, "sigma_m = {sigma_m:.4}")?;
    }
    fs::write(folder.join(EVIDENCE_FILE), text)?;
    Ok(())
}

/// A plan of the PIT manoeuvre over its speed.
pub fn plan(n: u64, folder: &Path) -> Measured<()> {
    let text = format!(
        "name = \"rows\"\nquestion = \"pit\"\nn = {n}\nchunk = 100\n\
         [pit]\nscenario = \"pit-right-rear\"\n\
         [vary.target_speed_m_s]\nuniform = [12.0, 20.0]\n"
    );
    fs::write(folder.join(PLAN_FILE), text)?;
    Ok(())
}
