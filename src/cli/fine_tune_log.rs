//! Logs of single impacts as data to fine-tune on: `impactlab fine-tune response --log`.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::quantity::{contact_point, time_s};
use crate::cli::vehicle_choice::vehicle;
use crate::data::{ColumnMap, DataError, ForceHistory, read_any_series};
use crate::response::{ForceOrigin, LogNoise, LogSettings, LoggedImpact, MotionLog};
use crate::vehicle::{ContactLoad, ContactPoint, VehicleParameters};

/// Where logs come from.
#[derive(Debug, Args)]
pub(super) struct LogArgs {
    /// A log of one impact instead of a data set: CSV with time, x, y, yaw, and perhaps yaw_rate, vx
    /// and vy, roll, steer; or a folder of such files. May be given several times
    #[arg(long, value_name = "LOG.csv|DIR", requires = "vehicle", conflicts_with_all = ["data", "trajectories", "test_share"])]
    pub(super) log: Vec<PathBuf>,
    /// The contact force of each log, in their order and on their clock; without it, estimated from
    /// the change of momentum
    #[arg(long, value_name = "F.csv", requires = "log")]
    force: Vec<PathBuf>,
    /// Which column of the logs is what: time=1:s,x=2:m,y=3:m,yaw=4:deg
    #[arg(long, value_name = "MAP", requires = "log")]
    map: Option<ColumnMap>,
    /// With --force: where the force acts, x, y from the CG in body axes, z above the ground, m;
    /// without it, the force file's own yaw moment
    #[arg(long, value_name = "X,Y,Z", value_parser = contact_point, allow_hyphen_values = true, requires = "force")]
    contact: Option<ContactPoint>,
    /// First contact on the logs' clock, s; from the force, or from the motion, if not given
    #[arg(long, value_name = "TIME", value_parser = time_s, requires = "log")]
    impact: Option<f64>,
    /// How much of a log from the first contact on is learned from, s
    #[arg(long, value_name = "TIME", value_parser = time_s, default_value = "4", requires = "log")]
    duration: f64,
}

/// What was made of a log.
#[derive(Debug, Serialize)]
pub(super) struct LogFacts {
    log: PathBuf,
    start_s: f64,
    contact_s: Option<[f64; 2]>,
    force: ForceOrigin,
    impulse_n_s: [f64; 2],
    n_samples: usize,
    noise: LogNoise,
}

impl LogArgs {
    /// The logs as trajectories.
    ///
    /// - `name`: of the vehicle.
    pub(super) fn read(&self, name: &str) -> Result<Vec<(LogFacts, LoggedImpact)>, CliError> {
        let vehicle = vehicle(name)?;
        let paths = self.paths()?;
        if !self.force.is_empty() && self.force.len() != paths.len() {
            let (n_forces, n_logs) = (self.force.len(), paths.len());
            return Err(CliError::ForcesOfLogs { n_forces, n_logs });
        }
        let settings = LogSettings { vehicle, impact_s: self.impact, duration_s: self.duration };
        let read = |(i, path): (usize, &PathBuf)| {
            let log = MotionLog::read(path, self.map.as_ref())?;
            let force = self.force.get(i);
            let load = force.map(|path| self.load(path, &settings.vehicle)).transpose()?;
            let found = LoggedImpact::of(&log, load, &settings)?;
            let facts = LogFacts {
                log: path.clone(),
                start_s: found.start_s,
                contact_s: found.contact_s,
                force: found.force,
                impulse_n_s: found.impulse_n_s,
                n_samples: found.case.states.len(),
                noise: found.noise,
            };
            Ok((facts, found))
        };
        paths.iter().enumerate().map(read).collect()
    }

    /// The files, those of a folder by name.
    fn paths(&self) -> Result<Vec<PathBuf>, CliError> {
        let mut paths = Vec::new();
        for path in &self.log {
            if !path.is_dir() {
                paths.push(path.clone());
                continue;
            }
            let to_error = |source| DataError::Io { path: path.clone(), source };
            let entries = fs::read_dir(path).map_err(to_error)?;
            let files = entries.map(|entry| entry.map(|entry| entry.path()));
            let mut files: Vec<PathBuf> = files.collect::<Result<_, _>>().map_err(to_error)?;
            files
                .retain(|file| file.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv")));
            if files.is_empty() {
                return Err(CliError::NoLogs { path: path.clone() });
            }
            files.sort();
            paths.extend(files);
        }
        Ok(paths)
    }

    fn load(&self, path: &Path, vehicle: &VehicleParameters) -> Result<ContactLoad, CliError> {
        let loaded = read_any_series(path, None)?;
        let in_file = |source| CliError::Series { path: path.to_owned(), source };
        let force =
            ForceHistory::from_series(&loaded.series, loaded.force_sampling()).map_err(in_file)?;
        if self.contact.is_none() && force.mz_n_m.is_none() {
            return Err(CliError::NoYawMoment { path: path.to_owned() });
        }
        let height_m = vehicle.geometry.cg_height_m;
        let at_cg = ContactPoint { x_m: 0.0, y_m: 0.0, height_m };
        let contact = self.contact.unwrap_or(at_cg);
        Ok(ContactLoad { force, contact, recorded_moment: self.contact.is_none() })
    }
}

impl LogFacts {
    /// What a person reads.
    pub(super) fn shown(&self) -> String {
        let Self { start_s, n_samples, noise, impulse_n_s: [px, py], .. } = self;
        let contact = match self.contact_s {
            Some([from_s, to_s]) => format!("contact {from_s:.2} s to {to_s:.2} s"),
            None => format!("no contact, from {start_s:.2} s"),
        };
        let force = match self.force {
            ForceOrigin::Recorded => format!("recorded impulse x {px:.1}, y {py:.1} N s"),
            ForceOrigin::Estimated => format!("estimated impulse x {px:.1}, y {py:.1} N s"),
            ForceOrigin::None => "no force".to_owned(),
        };
        let velocity = noise.velocity_m_s.map(|v| format!(", velocity {v:.3} m/s"));
        let rate = noise.yaw_rate_rad_s.map(|r| format!(", yaw rate {:.2} deg/s", r.to_degrees()));
        format!(
            "{}: {contact}, {force}, {n_samples} states; noise: position {:.3} m, yaw {:.2} deg{}{}",
            self.log.display(),
            noise.position_m,
            noise.yaw_rad.to_degrees(),
            velocity.unwrap_or_default(),
            rate.unwrap_or_default()
        )
    }
}
