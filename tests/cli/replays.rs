//! Cases of a trajectory data set whose drivers brake and steer, replayed from the command line.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;

use crate::program::{answer, program, text};

const SHIPPED: &str = "datasets/trajectories-fea";

/// The first case of a shipped data set with more columns.
struct OneCase {
    folder: TempDir,
    header: String,
    row: String,
    file: String,
}

impl OneCase {
    /// - `columns`: the headers of the columns that are added.
    fn with(columns: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let cases = fs::read_to_string(format!("{SHIPPED}/cases.csv")).unwrap();
        let mut lines = cases.lines().map(str::to_owned);
        let (header, row) = (lines.next().unwrap(), lines.next().unwrap());
        let file = format!("{}.csv", row.split(',').next().unwrap());
        let header = format!("{header},{columns}");
        let of = Self { folder, header, row, file };
        let files = of.data().join("trajectories");
        fs::create_dir_all(&files).unwrap();
        fs::copy(format!("{SHIPPED}/trajectories/{}", of.file), files.join(&of.file)).unwrap();
        fs::copy(format!("{SHIPPED}/vehicle.toml"), of.data().join("vehicle.toml")).unwrap();
        of
    }

    fn data(&self) -> PathBuf {
        self.folder.path().join("data")
    }

    fn write(&self, cells: &str) {
        let table = format!("{}\n{},{cells}\n", self.header, self.row);
        fs::write(self.data().join("cases.csv"), table).unwrap();
    }

    /// A column of the motion that is simulated with these cells; empty where the motion has none.
    fn replayed(&self, cells: &str, column: &str) -> Vec<f64> {
        self.write(cells);
        let out = self.folder.path().join("out");
        let data = self.data();
        let args = ["simulate", "--dataset", text(&data), "--out", text(&out), "--overwrite"];
        let _ = answer(&args);
        let motion = fs::read_to_string(out.join(&self.file)).unwrap();
        let mut rows = motion.lines();
        let at = rows.next().unwrap().split(',').position(|name| name == column);
        let value = |row: &str| Some(row.split(',').nth(at?)?.parse().unwrap());
        rows.filter_map(value).collect()
    }

    /// What is printed about cells that are refused.
    fn refused(&self, cells: &str) -> String {
        self.write(cells);
        let output =
            program().args(["simulate", "--dataset", text(&self.data())]).output().unwrap();
        assert!(!output.status.success(), "{cells}");
        String::from_utf8_lossy(&output.stdout).into_owned()
            + &String::from_utf8_lossy(&output.stderr)
    }
}

#[test]
fn a_data_set_with_brakes_is_replayed_with_them() {
    let case = OneCase::with("braking,braking_start_s,braking_torque_n_m");
    let vx_m_s = case.replayed("driver-brake,0.5,front 9000 rear 9000 a wheel", "vx_m_s");
    let end_m_s = *vx_m_s.last().unwrap();
    assert!(end_m_s.abs() < 0.5, "{end_m_s}");
    let printed = case.refused("driver-brake,0.5,plenty");
    assert!(printed.contains("\"braking_torque_n_m\" is \"plenty\""), "{printed}");
}

#[test]
fn a_data_set_with_steering_is_replayed_with_it() {
    let case = OneCase::with("steering,steering_start_s,steering_rad,steering_rate_rad_s");
    let held = case.replayed("held,0.5,-0.2,0.4", "steer_fl_rad");
    for (idx, expected) in [(50, 0.0), (75, -0.1), (100, -0.2), (300, -0.2)] {
        assert!((held[idx] - expected).abs() < 1e-9, "{idx}: {}", held[idx]);
    }
    assert!(case.replayed("none,,,", "steer_fl_rad").iter().all(|rad| *rad == 0.0));
    for (cells, expected) in [
        ("turned,0.5,-0.2,0.4", "\"steering\" is \"turned\", expected none or held"),
        ("held,0.5,-0.2,", "steering_rate_rad_s"),
        ("held,0.5,-2,0.4", "expected -0.9 to 0.9"),
    ] {
        let printed = case.refused(cells);
        assert!(printed.contains(expected), "{cells}: {printed}");
    }
}
