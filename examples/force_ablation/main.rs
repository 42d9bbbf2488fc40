//! Measures what each optional part of the force network adds over the physics alone, and what more
//! collisions would bring.
//!
//! ```text
//! cargo run --release --example force_ablation -- datasets/fea datasets/fea-wide datasets/fea-road
//! cargo run --release --example force_ablation -- datasets/fea datasets/fea-wide datasets/fea-road \
//!     --held-out datasets/fea-road-held-out --rows shipped,physics --sizes 20,40,75,150,all --seeds 0,1,2
//! ```
//!
//! Every row is the network with one part changed, trained on several numbers of cases. It is judged by a
//! cross-validation over the training cases, or on cases held out. A share of the first data set
//! (`training.test_share`) is kept apart and not used, as by `impactlab train force`; cases that cannot be
//! learned from, such as blows against the front or the rear, are left out.
//!
//! It takes hours, and may be killed and run again, with other rows, sizes or seeds: what is done, and the
//! physics that several rows share, lies in the folder of `--out`. What another build of the program has
//! done is computed again.
//!
//! It prints Markdown: errors and scores of each row, what each adds over the physics alone and loses
//! against the network as shipped (differences on the same cases), and for rows of several sizes a
//! learning curve with its power law. The force network has no adaptive weights; those of the response
//! network are measured by the example `response_ablation`. How errors fall with the number of cars is
//! not measured here.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod curve;
mod judged;
mod rows;
mod store;
mod tables;
mod tasks;

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use clap::Parser;
use impactlab_core::error_chain;
use impactlab_networks::force::ForceConfig;

use crate::rows::Row;
use crate::store::Store;
use crate::tasks::Task;

/// What went wrong, for a person.
type Answer<T> = Result<T, String>;

/// An error with its causes, for a person.
fn told(error: impl std::error::Error) -> String {
    error_chain(&error)
}

/// Measures what each part of the force network adds, and what more collisions would bring.
#[derive(Parser)]
struct Arguments {
    /// Force data sets to learn from; a share of the first is kept apart
    #[arg(required = true, value_name = "DIR")]
    data: Vec<PathBuf>,
    /// A force data set to judge by, instead of a cross-validation; may be repeated
    #[arg(long, value_name = "DIR")]
    held_out: Vec<PathBuf>,
    /// Only these rows; a wrong name lists all of them
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    rows: Vec<String>,
    /// Numbers of cases to learn from; `all` for as many as there are
    #[arg(long, value_delimiter = ',', default_value = "75,150,300", value_parser = size)]
    sizes: Vec<usize>,
    /// Seeds of the choice of the cases and of the trainings
    #[arg(long, value_delimiter = ',', default_value = "0")]
    seeds: Vec<u64>,
    /// Folds of the cross-validation, 2 to 20
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u64).range(2..=20))]
    folds: u64,
    /// Settings (TOML) that the rows depart from
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Folder of what is done
    #[arg(long, value_name = "DIR", default_value = "target/force_ablation")]
    out: PathBuf,
    /// Trainings side by side; by default one for each core
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=256))]
    workers: Option<u64>,
    /// Takes over what other builds of the program have done
    #[arg(long)]
    other_builds: bool,
    /// Prints what is done, and computes nothing
    #[arg(long)]
    only_print: bool,
}

/// [`tasks::ALL`] for `all`.
fn size(text: &str) -> Answer<usize> {
    match text {
        "all" => Ok(tasks::ALL),
        text => text
            .parse::<usize>()
            .ok()
            .filter(|size| *size >= 8)
            .ok_or_else(|| "expected a number from 8 on, or all".to_owned()),
    }
}

/// Trains and judges all rows of all tasks that are not done yet, several tasks side by side.
fn compute(tasks: &[Task], rows: &[Row], store: &Mutex<Store>, n_workers: usize) -> Answer<()> {
    let next = AtomicUsize::new(0);
    let work = || -> Answer<()> {
        while let Some(task) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Err(problem) = task.run(rows, store) {
                // The others end with what they have begun.
                next.fetch_max(tasks.len(), Ordering::Relaxed);
                return Err(format!("{}: {problem}", task.label()));
            }
        }
        Ok(())
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..n_workers).map(|_| scope.spawn(work)).collect();
        let panicked = || Err("a training has panicked".to_owned());
        let ends: Vec<Answer<()>> = workers
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|_| panicked()))
            .collect();
        ends.into_iter().collect()
    })
}

fn run() -> Answer<()> {
    let arguments = Arguments::parse();
    let config = match &arguments.config {
        Some(path) => ForceConfig::load(path).map_err(told)?,
        None => ForceConfig::default(),
    };
    let rows = rows::chosen(&config, &arguments.rows)?;
    let pool = tasks::Pool::load(&arguments.data, &arguments.held_out, &config)?;
    let n_folds = usize::try_from(arguments.folds).map_err(told)?;
    let tasks = pool.tasks(n_folds, &arguments.sizes, &arguments.seeds)?;
    let store = Store::open(&arguments.out, arguments.other_builds)?;
    let store = Mutex::new(store);
    if !arguments.only_print {
        let n_cores = thread::available_parallelism().map_or(1, usize::from);
        let n_workers = arguments.workers.and_then(|n| usize::try_from(n).ok());
        let computed = compute(&tasks, &rows, &store, n_workers.unwrap_or(n_cores));
        if let Err(problem) = computed {
            eprintln!("what was done before stays in {}", arguments.out.display());
            return Err(problem);
        }
    }
    let store = store.into_inner().unwrap_or_else(PoisonError::into_inner);
    println!("{}", pool.describe(n_folds));
    tables::print(&tasks, &rows, &store);
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}
