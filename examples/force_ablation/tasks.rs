//! The tasks: from which cases a network learns and by which it is judged.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use impactlab_core::data::{Dataset, DatasetKind};
use impactlab_core::jobs::Progress;
use impactlab_core::numerics::sha256_hex;
use impactlab_networks::force::{
    ForceCase, ForceConfig, ForceModel, ForceTrainSettings, ForceTrainingSet, fit_physics,
    train_around,
};
use impactlab_networks::learning::{TrainSettings, TrainingReport, check_kind, folds};
use serde_json::json;

use crate::judged::{JudgedCase, N_DRAWS};
use crate::rows::Row;
use crate::store::{Part, Physics, Store, read_physics, write_physics};
use crate::{Answer, told};

/// Seed of what is kept apart of the first data set and of the folds, as of the training command.
const SPLIT_SEED: u64 = 0;
/// As many cases to learn from as there are.
pub const ALL: usize = usize::MAX;

/// All cases to learn from, and those held out.
pub struct Pool {
    train: Vec<ForceCase>,
    /// Empty for a cross-validation.
    held_out: Vec<ForceCase>,
    /// Cases that are kept apart and not used.
    n_apart: usize,
}

/// Cases to learn from, and cases to judge by.
type Sides<'a> = (Vec<&'a ForceCase>, Vec<&'a ForceCase>);

/// One choice of cases to learn from and of cases to judge by.
pub struct Task {
    /// How many cases were asked for, or [`ALL`].
    pub size: usize,
    pub seed: u64,
    /// Number of the fold; 0 for cases held out.
    fold: usize,
    set: ForceTrainingSet,
    test: Vec<ForceCase>,
}

/// The cases of data sets that can be learned from. Those left out are told.
fn load(roots: &[PathBuf]) -> Answer<Vec<Vec<ForceCase>>> {
    roots.iter().map(|root| load_one(root)).collect()
}

fn load_one(root: &Path) -> Answer<Vec<ForceCase>> {
    let go_on = &mut |_: Progress| ControlFlow::Continue(());
    let dataset = Dataset::load(root, go_on).map_err(told)?;
    let Some(dataset) = dataset.complete() else { return Ok(Vec::new()) };
    check_kind(&dataset, DatasetKind::Force).map_err(told)?;
    let (cases, problems) = ForceCase::from_dataset(&dataset);
    let (unread, unfit) = (dataset.problems.iter().map(told), problems.iter().map(told));
    for problem in unread.chain(unfit) {
        eprintln!("left out: {}: {problem}", root.display());
    }
    eprintln!("{}: {} cases", root.display(), cases.len());
    Ok(cases)
}

impl Pool {
    /// - `held_out`: data sets to judge by; none for a cross-validation.
    pub fn load(data: &[PathBuf], held_out: &[PathBuf], config: &ForceConfig) -> Answer<Self> {
        let mut sets = load(data)?.into_iter();
        let first = sets.next().unwrap_or_default();
        let share = config.training.test_share;
        let set = ForceTrainingSet::from_split("", &first, SPLIT_SEED, share);
        let set = set.with_extra(&sets.flatten().collect::<Vec<_>>());
        let held_out = load(held_out)?.concat();
        let is_held_out = |case: &ForceCase| held_out.iter().any(|held| held.digest == case.digest);
        let n_apart = set.test.len();
        let (twice, train): (Vec<_>, Vec<_>) = set.train.into_iter().partition(is_held_out);
        if !twice.is_empty() {
            eprintln!("{} cases are held out and not learned from", twice.len());
        }
        Ok(Self { train, held_out, n_apart })
    }

    /// How the rows are judged, in a sentence.
    pub fn describe(&self, n_folds: usize) -> String {
        let (n_train, n_apart) = (self.train.len(), self.n_apart);
        match self.held_out.len() {
            0 => format!(
                "\nCross-validation of {n_folds} folds over {n_train} cases; {n_apart} are kept apart."
            ),
            n => format!(
                "\nJudged on {n} cases held out, of {n_train} to learn from; {n_apart} are kept apart."
            ),
        }
    }

    /// The tasks of all sizes and seeds, the small ones first. A size for which there are too few cases is
    /// left out and told.
    pub fn tasks(&self, n_folds: usize, sizes: &[usize], seeds: &[u64]) -> Answer<Vec<Task>> {
        let parts: Vec<Sides<'_>> = match self.held_out.is_empty() {
            false => vec![(self.train.iter().collect(), self.held_out.iter().collect())],
            true => {
                let chosen = |indices: &[usize]| -> Vec<&ForceCase> {
                    indices.iter().filter_map(|&idx| self.train.get(idx)).collect()
                };
                let folds = folds(&self.train, n_folds, SPLIT_SEED);
                folds.iter().map(|fold| (chosen(&fold.train), chosen(&fold.test))).collect()
            }
        };
        let most = parts.iter().map(|(train, _)| train.len()).min().unwrap_or(0);
        let mut sizes = sizes.to_vec();
        sizes.sort_unstable();
        sizes.dedup();
        let mut tasks = Vec::new();
        for size in sizes {
            if size != ALL && size > most {
                eprintln!("left out: {size} cases to learn from, of which there are {most}");
                continue;
            }
            for &seed in seeds {
                let of_part =
                    |(fold, sides): (usize, &Sides<'_>)| Task::new(size, seed, fold, sides);
                tasks.extend(parts.iter().enumerate().map(of_part));
            }
        }
        match tasks.is_empty() {
            true => Err(format!("no size of at most {most} cases")),
            false => Ok(tasks),
        }
    }
}

impl Task {
    /// The first cases in an order by hash: those of a size are among those of every larger one, and the
    /// order of the files does not count.
    fn new(size: usize, seed: u64, fold: usize, (train, test): &Sides<'_>) -> Self {
        let mut train = train.clone();
        train.sort_by_cached_key(|case| {
            sha256_hex([&seed.to_le_bytes()[..], case.digest.as_bytes()])
        });
        let set = ForceTrainingSet {
            name: "ablation".to_owned(),
            train: train.into_iter().take(size).cloned().collect(),
            test: Vec::new(),
        };
        Self { size, seed, fold, set, test: test.iter().copied().cloned().collect() }
    }

    /// Cases that it learns from.
    pub fn n_train(&self) -> usize {
        self.set.train.len()
    }

    /// What it is called.
    pub fn label(&self) -> String {
        format!("{} cases, seed {}, fold {}", self.n_train(), self.seed, self.fold + 1)
    }

    /// The cases that a row learns from, as it knows them.
    fn set(&self, row: &Row) -> Cow<'_, ForceTrainingSet> {
        if !row.is_struck_body_withheld {
            return Cow::Borrowed(&self.set);
        }
        let mut set = self.set.clone();
        for case in &mut set.train {
            case.scenario.struck_body = None;
        }
        Cow::Owned(set)
    }

    fn settings(&self, row: &Row) -> ForceTrainSettings {
        TrainSettings::unsaved(row.config.clone(), self.seed)
    }

    /// SHA-256 of all that the row depends on but the build.
    pub fn identity(&self, row: &Row) -> String {
        let known = [row.is_theta_alone, row.is_struck_body_withheld];
        let settings = json!([row.config, known, self.seed, N_DRAWS]).to_string();
        let tests = sha256_hex(self.test.iter().map(|case| case.digest.as_bytes()));
        sha256_hex([settings.as_bytes(), self.set.digest().as_bytes(), tests.as_bytes()])
    }

    /// Trains and judges the rows that are not done yet. Rows with the same physics share its fit, and
    /// rows of one network that follow each other its training.
    pub fn run(&self, rows: &[Row], store: &Mutex<Store>) -> Answer<()> {
        let mut fitted: Vec<(String, Physics)> = Vec::new();
        let mut latest: Option<(&Row, ForceModel)> = None;
        for row in rows {
            let identity = self.identity(row);
            if held(store).find(&identity).is_some() {
                continue;
            }
            let started = Instant::now();
            let is_same = |other: &Row| {
                other.config == row.config
                    && other.is_struck_body_withheld == row.is_struck_body_withheld
            };
            let (_, model) = match latest.take().filter(|(other, _)| is_same(other)) {
                Some(known) => latest.insert(known),
                None => latest.insert((row, self.trained(row, &mut fitted, store)?)),
            };
            let judge = |(stream, case): (usize, &ForceCase)| {
                JudgedCase::new(model, case, row.is_theta_alone, stream as u64)
            };
            let cases = self.test.iter().enumerate().map(judge).collect::<Answer<Vec<_>>>()?;
            let seconds = started.elapsed().as_secs_f64();
            eprintln!("{}: {}: {seconds:.0} s", self.label(), row.name);
            held(store).add(Part {
                row: row.name.to_owned(),
                task: self.label(),
                identity,
                build: impactlab::VERSION.to_owned(),
                seconds,
                cases,
            })?;
        }
        Ok(())
    }

    /// The network of a row.
    ///
    /// - `fitted`: physics of rows before, to which its own is added.
    fn trained(
        &self,
        row: &Row,
        fitted: &mut Vec<(String, Physics)>,
        store: &Mutex<Store>,
    ) -> Answer<ForceModel> {
        let key = self.physics_identity(row);
        let known = fitted.iter().find(|(of, _)| *of == key).map(|(_, physics)| physics.clone());
        let physics = match known {
            Some(physics) => physics,
            None => {
                let physics = self.physics(row, &key, store)?;
                fitted.push((key, physics.clone()));
                physics
            }
        };
        let go_on = &mut |_: &TrainingReport| ControlFlow::Continue(());
        train_around(physics, &self.set(row), &self.settings(row), go_on).map_err(told)
    }

    fn physics_identity(&self, row: &Row) -> String {
        let (network, crush) = (&row.config.network, row.config.crush);
        let withheld = row.is_struck_body_withheld;
        let settings = json!([network.centre, crush, withheld, self.seed]).to_string();
        sha256_hex([settings.as_bytes(), self.set.digest().as_bytes()])
    }

    /// The physics of a row, from its file if it was fitted before.
    fn physics(&self, row: &Row, key: &str, store: &Mutex<Store>) -> Answer<Physics> {
        let path = held(store).physics_path(key);
        if let Some(physics) = read_physics(&path, self.n_train())? {
            return Ok(physics);
        }
        let mut told_of = String::new();
        let physics = fit_physics(&self.set(row), &self.settings(row), &mut |report| {
            if let TrainingReport::Fit(fit) = report
                && fit.what != told_of
            {
                eprintln!("{}: {}", self.label(), fit.what);
                told_of.clone_from(&fit.what);
            }
            ControlFlow::Continue(())
        });
        let physics = physics.map_err(told)?;
        write_physics(&path, &physics)?;
        Ok(physics)
    }
}

/// The store, also after another worker has panicked: what it holds is whole.
fn held(store: &Mutex<Store>) -> MutexGuard<'_, Store> {
    store.lock().unwrap_or_else(PoisonError::into_inner)
}
