//! The cost of one point of a curve.

use std::path::Path;
use std::process::{Command, Stdio};

use cpu_time::ProcessTime;
use impactlab_core::numerics::Summary;
use serde::{Deserialize, Serialize};

use crate::{Curve, Measured};

/// What one answer took.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Cost {
    /// Processor time of all threads, s.
    processor_s: f64,
    /// Largest memory of the process, MiB; not known everywhere.
    peak_mib: Option<f64>,
    /// Motions that were simulated, where the answer says it.
    motions: Option<u64>,
}

impl Cost {
    /// Asks in this process.
    pub fn here(curve: &Curve, size: u64, folder: &Path) -> Measured<Self> {
        let started = ProcessTime::try_now()?;
        let motions = (curve.ask)(size, folder)?;
        let processor_s = started.try_elapsed()?.as_secs_f64();
        Ok(Self { processor_s, peak_mib: peak_mib(), motions })
    }

    /// Asks in a process of its own, whose memory holds nothing else.
    pub fn in_child(curve: &Curve, size: u64, folder: &Path) -> Measured<Self> {
        let mut command = Command::new(std::env::current_exe()?);
        command.arg("--point").arg(curve.name).arg(size.to_string()).arg(folder);
        let output = command.stderr(Stdio::inherit()).output()?;
        if !output.status.success() {
            return Err(format!("{} {size}: {}", curve.name, output.status).into());
        }
        Ok(serde_json::from_slice(&output.stdout)?)
    }
}

/// The largest resident memory that this process had, as the system says it.
fn peak_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = peak.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}

/// A point of a curve: medians over its runs.
pub struct Point {
    /// What grows.
    pub size: u64,
    /// Processor time, s.
    pub processor_s: f64,
    /// Fastest and slowest run, s.
    range_s: [f64; 2],
    /// Largest memory, MiB.
    pub peak_mib: Option<f64>,
    /// Motions that were simulated.
    motions: Option<u64>,
}

impl Point {
    /// The columns of [`Point::csv`].
    pub const CSV_HEADER: &str = "curve,size,processor_s,fastest_s,slowest_s,peak_mib,motions";

    /// The medians of the runs of a point; `None` without a run.
    pub fn new(size: u64, runs: &[Cost]) -> Option<Self> {
        let time_s = Summary::from_values(runs.iter().map(|run| run.processor_s))?;
        let peak_mib = Summary::from_values(runs.iter().filter_map(|run| run.peak_mib));
        Some(Self {
            size,
            processor_s: time_s.median,
            range_s: [time_s.min, time_s.max],
            peak_mib: peak_mib.map(|peak_mib| peak_mib.median),
            motions: runs.first()?.motions,
        })
    }

    /// Processor time, s, of the answer or of each motion in it.
    pub fn cost_s(&self, is_per_motion: bool) -> f64 {
        match self.motions {
            Some(motions) if is_per_motion => self.processor_s / motions.max(1) as f64,
            _ => self.processor_s,
        }
    }

    /// Its line in a table.
    pub fn csv(&self, curve: &str) -> String {
        let Self { size, processor_s, range_s: [fastest_s, slowest_s], .. } = self;
        let peak = self.peak_mib.map(|mib| format!("{mib:.1}")).unwrap_or_default();
        let motions = self.motions.map(|motions| motions.to_string()).unwrap_or_default();
        format!("{curve},{size},{processor_s},{fastest_s},{slowest_s},{peak},{motions}\n")
    }
}
