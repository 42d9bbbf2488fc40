//! Measures how long data sets take to load: the shipped data sets with 100 force cases and 100
//! trajectories, and 10 000 force cases that are made from the shipped ones by scaling their forces
//! by up to 10 %.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use divan::Bencher;
use divan::counter::ItemsCount;
use impactlab_core::data::{
    Channel, Dataset, Existing, TimeSeries, check_case, read_force_file, write_series_csv,
};
use tempfile::TempDir;

/// Number of cases of the generated data set.
const N_GENERATED: usize = 10_000;

/// Folder of the generated data set. The first benchmark that needs it creates it, and `main`
/// removes it at the end.
static GENERATED: Mutex<Option<TempDir>> = Mutex::new(None);

fn main() {
    divan::main();
    if let Ok(mut folder) = GENERATED.lock() {
        folder.take();
    }
}

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets").join(name)
}

fn load(root: &Path) -> Dataset {
    let outcome = Dataset::load(root, &mut |_| ControlFlow::Continue(()));
    let dataset = outcome.expect("the data set is good").complete();
    dataset.expect("it was not cancelled")
}

/// Writes the generated data set, which repeats the shipped cases. The factor on the forces grows
/// from 1 to 1.1 over the cases.
fn generate(root: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let source = load(&shipped("fea"));
    let table = fs::read_to_string(shipped("fea").join("cases.csv"))?;
    let mut lines = table.lines();
    let mut rows = format!("{}\n", lines.next().unwrap_or_default());
    let lines: Vec<&str> = lines.collect();
    fs::create_dir(root.join("forces"))?;
    for (i, (case, line)) in source.cases.iter().zip(lines).cycle().take(N_GENERATED).enumerate() {
        let row = line.split_once(',').map_or("", |(_, row)| row);
        rows.push_str(&format!("g{i:05},{row}\n"));
        let series = stronger(&case.series, 1.0 + i as f64 * 1e-5)?;
        write_series_csv(
            &root.join("forces").join(format!("g{i:05}.csv")),
            Existing::Refuse,
            &series,
        )?;
    }
    fs::write(root.join("cases.csv"), rows)?;
    Ok(())
}

/// Multiplies forces and yaw moment of a series by a factor.
fn stronger(series: &TimeSeries, factor: f64) -> Result<TimeSeries, Box<dyn std::error::Error>> {
    let mut scaled = series.clone();
    for channel in [Channel::Fx, Channel::Fy, Channel::Mz] {
        let values = series.require(channel)?.iter();
        // The values are rounded to 0.01 N as in the shipped files, so that the files have about
        // the same size.
        let values = values.map(|value| (value * factor * 100.0).round() / 100.0);
        scaled.insert(channel, values.collect())?;
    }
    Ok(scaled)
}

#[divan::bench]
fn one_force_file(bencher: Bencher<'_, '_>) {
    let path = shipped("fea").join("forces").join("c001.csv");
    bencher.bench(|| read_force_file(&path, None));
}

#[divan::bench(args = ["fea", "trajectories-fea"], sample_count = 20)]
fn shipped_100_cases(bencher: Bencher<'_, '_>, name: &str) {
    let root = shipped(name);
    bencher.counter(ItemsCount::new(100_usize)).bench(|| load(&root));
}

#[divan::bench(sample_count = 20)]
fn check_100_cases(bencher: Bencher<'_, '_>) {
    let dataset = load(&shipped("fea"));
    let check = || dataset.cases.iter().flat_map(check_case).count();
    bencher.counter(ItemsCount::new(100_usize)).bench(check);
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn generated_10_000_cases(bencher: Bencher<'_, '_>) {
    let mut generated = GENERATED.lock().expect("no bench panicked");
    let folder = generated.get_or_insert_with(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        generate(folder.path()).expect("the data set can be written");
        folder
    });
    let load = || load(folder.path());
    bencher.counter(ItemsCount::new(N_GENERATED)).bench(load);
}
