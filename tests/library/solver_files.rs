//! Files of finite-element solvers that several tests read, and how they are read: one collision of two cars.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use impactlab_core::data::{Channel, ColumnMap, Loaded, read_any_series};
use tempfile::TempDir;

/// Instants of a collision, ms, and the force on the slave side along x, kN: units of kg, mm and ms.
pub(crate) const TIME_MS: [f64; 5] = [0.0, 20.0, 40.0, 60.0, 80.0];
pub(crate) const FORCE_KN: [f64; 5] = [0.0, 150.0, 90.0, 0.0, 0.0];

pub(crate) const DECK: &str = "deck=kg-mm-ms";

pub(crate) fn map(text: &str) -> ColumnMap {
    text.parse().unwrap()
}

pub(crate) fn read(path: &Path, text: &str) -> Loaded {
    read_any_series(path, Some(&map(text))).unwrap()
}

pub(crate) fn fx(loaded: &Loaded) -> Vec<f64> {
    loaded.series.require(Channel::Fx).unwrap().to_vec()
}

pub(crate) fn notes(loaded: &Loaded) -> String {
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    notes.join("\n")
}

pub(crate) fn doubts(loaded: &Loaded) -> String {
    let doubts = loaded.notes.iter().filter(|note| note.is_doubt());
    doubts.map(|note| note.to_string() + "\n").collect()
}

pub(crate) fn assert_close(values: &[f64], expected: &[f64]) {
    assert_eq!(values.len(), expected.len(), "{values:?}");
    for (value, expected) in values.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-6 * expected.abs().max(1.0), "{values:?}");
    }
}

pub(crate) fn file(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    path
}

/// A number as C writes it with `%E`.
pub(crate) fn e(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{mantissa}E{sign}{:02}", exponent.abs())
}

/// Contact 3 with the collision, and contact 8 with a tenth of it.
///
/// - `reaction`: the force on the master side over that on the slave side.
pub(crate) fn rcforc(reaction: f64) -> String {
    let mut text = " a run\n                         ls-dyna (version R12)     date 01/01/2026\n\
        {BEGIN LEGEND}\n Entity #        Title\n        3     bumper to door|\n{END LEGEND}\n\n"
        .to_owned();
    for (time, force) in TIME_MS.iter().zip(FORCE_KN) {
        for (id, share) in [(3, 1.0), (8, 0.1)] {
            for (side, sign) in [("master", reaction), ("slave ", 1.0)] {
                let [time, x, y, zero] =
                    [*time, share * sign * force, share * sign * force / 3.0, 0.0]
                        .map(|value| format!("{:>12}", e(value, 5)));
                text +=
                    &format!("  {side}{id:11} time{time}  x {x}  y {y}  z {zero} mass {zero}\n");
            }
        }
    }
    text
}

pub(crate) fn record(command: u8, body: &[u8]) -> Vec<u8> {
    let length = 9 + body.len() as u64;
    [&length.to_le_bytes()[..], &[command], body].concat()
}

fn array(name: &str, kind: u8, values: &[u8]) -> Vec<u8> {
    record(3, &[&[kind, name.len() as u8][..], name.as_bytes(), values].concat())
}

pub(crate) fn floats(name: &str, values: &[f64]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|value| (*value as f32).to_le_bytes()).collect();
    array(name, 9, &bytes)
}

pub(crate) fn ids(values: &[i32]) -> Vec<u8> {
    array("ids", 3, &values.iter().flat_map(|id| id.to_le_bytes()).collect::<Vec<u8>>())
}

pub(crate) const LSDA: [u8; 8] = [8, 8, 8, 1, 1, 1, 0, 0];

/// The forces of some states, by their indices.
pub(crate) fn binout_forces(states: &[usize]) -> Vec<u8> {
    let mut bytes = [
        LSDA.to_vec(),
        record(2, b"/rcforc/metadata"),
        ids(&[3, 3]),
        array("side", 3, &[0, 0, 0, 0, 1, 0, 0, 0]),
    ]
    .concat();
    for state in states {
        bytes.extend(record(2, format!("../d{:06}", state + 1).as_bytes()));
        bytes.extend(floats("time", &[TIME_MS[*state]]));
        for (name, share) in [("x_force", 1.0), ("y_force", 0.0), ("z_force", 0.0)] {
            let force = share * FORCE_KN[*state];
            bytes.extend(floats(name, &[force, -force]));
        }
    }
    bytes
}

/// The momenta of two cars of 1000 kg.
///
/// - `share`: what of the impulse the first one gains;
/// - `starts_m_s`: their speeds at the start.
pub(crate) fn binout_momenta(share: f64, starts_m_s: [f64; 2]) -> Vec<u8> {
    let [first_m_s, second_m_s] = starts_m_s;
    let mut bytes = [LSDA.to_vec(), record(2, b"/matsum/metadata"), ids(&[1, 2])].concat();
    let mut gained = 0.0;
    for (state, time_ms) in TIME_MS.into_iter().enumerate() {
        let before = state.checked_sub(1).map_or(0.0, |before| FORCE_KN[before]);
        gained += share * 10.0 * (FORCE_KN[state] + before);
        bytes.extend(record(2, format!("../d{:06}", state + 1).as_bytes()));
        bytes.extend(floats("time", &[time_ms]));
        let momenta = [1000.0 * first_m_s + gained, 1000.0 * second_m_s - gained];
        bytes.extend(floats("x_momentum", &momenta));
        bytes.extend(floats("y_momentum", &[0.0, 0.0]));
        bytes.extend(floats("x_rbvelocity", &momenta.map(|momentum| momentum / 1000.0)));
        bytes.extend(floats("y_rbvelocity", &[0.0, 0.0]));
    }
    bytes
}

/// A binout in three parts, of which the second repeats a state of the first.
pub(crate) fn binout(folder: &TempDir, share: f64) -> PathBuf {
    file(folder, "binout0000%001", binout_forces(&[2, 3, 4]));
    file(folder, "binout0001", binout_momenta(share, [0.0, 9.0]));
    file(folder, "binout0000", binout_forces(&[0, 1, 2]))
}
