//! Files of measuring programs in binary: TDMS and MDF. The kept files were written by nptdms 1.13 and asammdf
//! 8.8.28; `interleaved` and `unsorted`, which neither writes, were made by hand. The numbers below are those
//! that these programs read in them.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use impactlab_core::data::{
    Channel, ColumnMap, DataError, Loaded, ReadSettings, Table, read_any_series,
};

fn kept(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus").join(name)
}

fn read(name: &str, map: &str) -> Result<Loaded, DataError> {
    let map: ColumnMap = map.parse().unwrap();
    read_any_series(&kept(name), Some(&map))
}

fn notes(loaded: &Loaded) -> String {
    loaded.notes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// All parts of a file, and the header of the one that a map chooses.
fn parts(name: &str, map: &str) -> (Vec<String>, Vec<String>) {
    let map: ColumnMap = map.parse().unwrap();
    let settings: &ReadSettings = &map.settings;
    let table = Table::read_as(&kept(name), settings).unwrap();
    (table.sheet().unwrap().all.clone(), table.header().to_vec())
}

#[test]
fn a_waveform_has_the_time_of_its_properties_and_its_scale() {
    let loaded = read("tdms/waveform.tdms", "").unwrap();
    let time_s = loaded.series.time_s();
    assert_eq!(time_s.len(), 6);
    assert!(time_s[0] == -0.001 && (time_s[5] - 0.004).abs() < 1e-12, "{time_s:?}");
    let fx = loaded.series.require(Channel::Fx).unwrap();
    assert_eq!(fx, [1500.0, -2000.0, 3000.0, 4000.0, 5000.0, 6250.0]);
    let fy = loaded.series.require(Channel::Fy).unwrap();
    assert_eq!(fy, [5.0, -25.0, 25.0, 35.0, 45.0, 55.0]);
    let (all, header) = parts("tdms/waveform.tdms", "sheet=2");
    assert_eq!(all, ["Log time 1", "Log time 2"]);
    assert_eq!(header, ["time [s]", "slow"]);
}

#[test]
fn stamps_count_from_the_first_one_and_texts_are_named() {
    let loaded = read("tdms/stamps.tdms", "").unwrap();
    assert_eq!(loaded.series.time_s(), [0.0, 0.25, 0.5]);
    assert_eq!(loaded.series.require(Channel::X).unwrap(), [0.0, 1.0, 2.5]);
    assert_eq!(loaded.series.require(Channel::Y).unwrap(), [0.0, -1.0, 2.0]);
    let notes = notes(&loaded);
    assert!(notes.contains("2026-11-25T10:00:00.000Z"), "{notes}");
    assert!(notes.contains("note (texts)"), "{notes}");
}

#[test]
fn interleaved_big_endian_and_incremental_segments_are_read() {
    let loaded = read("tdms/interleaved.tdms", "").unwrap();
    assert_eq!(loaded.series.time_s(), [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]);
    let fx = loaded.series.require(Channel::Fx).unwrap();
    assert_eq!(fx, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let fy = loaded.series.require(Channel::Fy).unwrap();
    assert_eq!(fy, [10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
    let notes = notes(&loaded);
    assert!(notes.contains("was not closed") && notes.contains("3 bytes"), "{notes}");
}

#[test]
fn daqmx_is_refused_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("d.tdms");
    let mut bytes = fs::read(kept("tdms/waveform.tdms")).unwrap();
    bytes[4] |= 1 << 7;
    fs::write(&path, bytes).unwrap();
    let error = read_any_series(&path, None).unwrap_err().to_string();
    assert!(error.contains("d.tdms: at byte 0: ") && error.contains("DAQmx"), "{error}");
}

#[test]
fn groups_of_mdf_are_parts_packed_or_not() {
    for name in ["mdf/plain.mf4", "mdf/packed.mf4"] {
        let loaded = read(name, "").unwrap();
        let time_s = loaded.series.time_s();
        assert_eq!(time_s, [0.0, 0.01, 0.02, 0.03, 0.04], "{name}");
        let fx = loaded.series.require(Channel::Fx).unwrap();
        assert_eq!(fx, [-1000.0, -500.0, 0.0, 500.0, 1500.0], "{name}");
        let fy = loaded.series.require(Channel::Fy).unwrap();
        assert_eq!(fy, [1.0, 2.0, 3.0, 4.0, 5.5], "{name}");
        let notes = notes(&loaded);
        assert!(
            notes.contains("version 4.10") && notes.contains("word (values of variable length)"),
            "{notes}"
        );
        let (all, header) = parts(name, "sheet=2");
        assert_eq!(all.len(), 2, "{all:?}");
        assert!(all[0].starts_with("group 1"), "{all:?}");
        assert_eq!(header, ["time [s]", "speed [km/h]"]);
    }
}

#[test]
fn samples_that_are_invalid_are_blank() {
    let loaded = read("mdf/invalid.mf4", "").unwrap();
    let notes = notes(&loaded);
    assert!(notes.contains("1 samples are marked as invalid"), "{notes}");
    let error = read("mdf/invalid.mf4", "fx=2:N,fy=4:N").unwrap_err().to_string();
    assert!(error.contains("cell D4") && error.contains("\"\""), "{error}");
}

#[test]
fn records_of_several_groups_are_told_apart() {
    let loaded = read("mdf/unsorted.mf4", "").unwrap();
    assert_eq!(loaded.series.time_s(), [0.0, 0.5, 1.0]);
    assert_eq!(loaded.series.require(Channel::X).unwrap(), [100.0, 101.0, 98.0]);
    assert_eq!(loaded.series.require(Channel::Y).unwrap(), [-1.0, -2.0, 3.0]);
    let table_of_second = parts("mdf/unsorted.mf4", "sheet=2").1;
    assert_eq!(table_of_second, ["time [s]", "speed [km/h]"]);
    let table = Table::read_as(
        &kept("mdf/unsorted.mf4"),
        &"sheet=2".parse::<ColumnMap>().unwrap().settings,
    );
    assert_eq!(table.unwrap().numbers(1, "").unwrap(), [50.0, 51.0]);
}

#[test]
fn other_versions_and_files_that_were_not_finished_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.mf4");
    let bytes = fs::read(kept("mdf/plain.mf4")).unwrap();
    let changed = |at: usize, with: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + with.len()].copy_from_slice(with);
        fs::write(&path, bytes).unwrap();
        read_any_series(&path, None).unwrap_err().to_string()
    };
    let old = changed(28, &330_u16.to_le_bytes());
    assert!(old.contains("of a version that is not read"), "{old}");
    let unfinished = changed(0, b"UnFinMF ");
    assert!(unfinished.contains("not finished"), "{unfinished}");
    // A chain of blocks that leads back to itself ends.
    let first = u64::from_le_bytes(bytes[64 + 24..64 + 32].try_into().unwrap());
    let circle = changed(usize::try_from(first).unwrap() + 24, &first.to_le_bytes());
    assert!(circle.contains("blocks DG follow each other"), "{circle}");
}
