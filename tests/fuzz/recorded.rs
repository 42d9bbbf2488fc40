//! Files of recorders, crash tests and satellite receivers, and files of columns.

use std::fs;
use std::path::Path;

use impactlab_core::data::{
    Channel, ColumnMap, CrashTest, Existing, RecorderRecord, Table, TimeSeries, read_any_series,
    write_restricted_series_parquet,
};

use crate::harness::{Answer, Format, run};
use crate::mutation::Mutator;

/// What a file is read as, by itself and with a map for what its header leaves open.
fn series(path: &Path, map: &str) -> Answer {
    let map: ColumnMap = map.parse().expect("a map");
    let map = map.iter().next().map(|_| &map);
    match read_any_series(path, map) {
        Ok(loaded) => Answer::accepted(&(&loaded.series, &loaded.notes)),
        Err(error) => Answer::refused(&error),
    }
}

fn text_format(name: &'static str, file_name: &'static str, load: &dyn Fn(&Path) -> Answer) {
    let (seeds, mutate, n_inputs) = (Vec::new(), Mutator::text, 1_500);
    run(&Format { name, n_inputs, file_name, names_file: true, seeds, mutate, load });
}

#[test]
fn reports_of_recorders() {
    text_format("cdr", "report.csv", &|path| {
        let table = Table::read(path).map(|table| table.header().to_vec());
        let answer = match RecorderRecord::read(path, None) {
            Ok(record) => Answer::accepted(&record),
            Err(error) => Answer::refused(&error),
        };
        match table {
            Ok(header) => answer.and(&header),
            Err(_) => answer,
        }
    });
}

#[test]
fn crash_tests_of_the_database() {
    text_format("ev5", "v1.EV5", &|path| {
        let curve = path.with_file_name("v1.001");
        if !curve.exists() {
            fs::write(curve, "-0.001\t0\n0\t-10\n0.001\t-12\n0.002\t0\n").expect("a curve");
        }
        match CrashTest::read(path) {
            Ok(test) => series(path, "").and(&(&test.vehicles, &test.channels)),
            Err(error) => Answer::refused(&error),
        }
    });
}

#[test]
fn channels_of_iso_mme() {
    text_format("iso-mme", "a.001", &|path| series(path, "fx_body=2:N,fy_body=none"));
}

#[test]
fn logs_of_receivers() {
    text_format("positions", "log.txt", &|path| series(path, ""));
}

/// Another file of bytes: mostly of the same length.
fn bytes(mutator: &mut Mutator, input: &[u8], other: &[u8]) -> Vec<u8> {
    if input.is_empty() || mutator.once_in(5) {
        return mutator.text(input, other);
    }
    let mut changed = input.to_vec();
    for _ in 0..=mutator.below(4) {
        let (at, byte) = (mutator.below(changed.len()), mutator.below(256));
        changed[at] = u8::try_from(byte).expect("a byte");
    }
    changed
}

/// A binary format whose kept files are changed byte by byte.
fn binary_format(name: &'static str, file_name: &'static str, map: &'static str) {
    let load = |path: &Path| series(path, map);
    let (seeds, mutate, n_inputs) = (Vec::new(), bytes, 3_000);
    run(&Format { name, n_inputs, file_name, names_file: true, seeds, mutate, load: &load });
}

#[test]
fn logs_of_labview() {
    binary_format("tdms", "log.tdms", "");
}

#[test]
fn measurements_of_buses() {
    binary_format("mdf", "log.mf4", "fx=2:N,fy=3:N");
}

#[test]
fn files_of_columns() {
    let folder = tempfile::tempdir().expect("a folder");
    let seed = |name: &str, n: u32| {
        let time_s = (0..n).map(|i| f64::from(i) * 1e-3).collect();
        let mut series = TimeSeries::new(time_s).expect("a time that rises");
        for (channel, sign) in [(Channel::Fx, 1.0), (Channel::Fy, -1.0)] {
            let values = (0..n).map(|i| sign * f64::from(i % 7) * 1e3).collect();
            series.insert(channel, values).expect("a column");
        }
        let path = folder.path().join(name);
        write_restricted_series_parquet(&path, Existing::Refuse, &series, Some("made"))
            .expect("a file");
        fs::read(&path).expect("the file")
    };
    let seeds = vec![seed("a.parquet", 3), seed("b.parquet", 400)];
    let load = |path: &Path| {
        // Its pages may be packed; one of them and its dictionary are unpacked at a time.
        Answer { fixed_bytes: 192 << 20, ..series(path, "") }
    };
    let (n_inputs, file_name) = (1_500, "columns.parquet");
    let format = Format {
        name: "parquet",
        n_inputs,
        file_name,
        names_file: true,
        seeds,
        mutate: bytes,
        load: &load,
    };
    run(&format);
}
