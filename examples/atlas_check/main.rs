//! Checks cells of the atlas of the PIT against rows that are computed for each of them alone.
//!
//! ```text
//! cargo run --release --example atlas_check -- --out DIR
//! cargo run --release --example atlas_check -- --out DIR --axes overlap,friction --cells 5 --seed 2
//! ```
//!
//! Random cells over some axes of the atlas are drawn among those with enough rows; over its other axes they
//! are averaged. Each has a plan of its own: that of the atlas, with what varies confined to the cell and
//! another seed, so that the two share no row. Every outcome that happens or not is compared; of those of all
//! rows or of none in both, nothing is.
//!
//! What it takes are 31 rows a second and core: 108 minutes a core for ten cells of 20 000 rows each. Rows are
//! kept in DIR, 500 a file, as sweeps keep them. The same command goes on where one was ended, as long as it is
//! the same program; another one, or other cells of the same name, need another folder.
//!
//! ```text
//! z = (p_direct − p_atlas)/√(σ_direct² + σ_atlas²)        χ² = Σ z²/a,  a = Σ tr R²/Σ tr R
//! ```
//!
//! R are the correlations of the outcomes of a cell, which go together: χ² has (Σ tr R)²/Σ tr R² degrees of
//! freedom. Points of a Sobol sequence scatter less than the independent ones of which the errors are told, so
//! that fewer |z| than one in 22 may lie beyond 2: the check finds cells that are wrong and errors that are too
//! small, not ones that are too large.
//!
//! Source: Rao and Scott (1984), The Annals of Statistics 12, 46–60.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod cell;
mod compare;

use std::borrow::Cow;
use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Parser;
use impactlab_core::jobs::Progress;
use impactlab_core::units::UnitSystem;
use impactlab_study::Library;
use impactlab_sweep::atlas::Atlas;

use crate::cell::{cell_name, confined, direct_rows, drawn_cells, plan_of};
use crate::compare::{Agreement, CellComparison};

/// Time between two lines of progress.
const LINE_EVERY: Duration = Duration::from_secs(10);

#[derive(Parser)]
struct Arguments {
    /// Folder of the rows, one below it for each cell
    #[arg(long)]
    out: PathBuf,
    /// Another atlas than the one that comes with the program
    #[arg(long)]
    atlas: Option<PathBuf>,
    /// The plan that the atlas is made of
    #[arg(long, default_value = "assets/atlas/pit.toml")]
    plan: PathBuf,
    /// Axes over which the cells lie, by their words; the others are averaged over
    #[arg(long, value_delimiter = ',', default_value = "speed,closing,esc")]
    axes: Vec<String>,
    /// How many cells
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    cells: u64,
    /// Rows of each cell
    #[arg(
        long,
        default_value_t = 20_000,
        value_parser = clap::value_parser!(u64).range(100..=1_000_000),
    )]
    rows: u64,
    /// Seed of the choice of cells and of their rows
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    impactlab_core::program::set_version(impactlab::VERSION);
    let library = Library::default();
    let atlas = match &arguments.atlas {
        Some(path) => Cow::Owned(Atlas::read(path)?),
        None => Cow::Borrowed(Atlas::shipped().ok_or("no atlas comes with this program")?),
    };
    let plan = plan_of(&atlas, &arguments.plan, &library)?;
    let n_cells = usize::try_from(arguments.cells)?;
    let cells = drawn_cells(&atlas, &arguments.axes, n_cells, arguments.seed)?;
    if cells.len() < n_cells {
        eprintln!("only {} cells have enough rows", cells.len());
    }
    println!("atlas: {} rows, by {}, plan {}", atlas.n_rows, atlas.program, atlas.plan_sha256);
    println!(
        "direct: {} rows a cell, by {}, seed {}\n",
        arguments.rows, plan.program, arguments.seed
    );
    println!(
        "| cell | rows | outcome | atlas [%] | direct [%] | z |\n| --- | --- | --- | --- | --- | --- |"
    );
    let total = arguments.rows * cells.len() as u64;
    let mut shown = Shown { started: Instant::now(), line: None, begun: 0, kept: 0, total };
    let mut compared = Vec::with_capacity(cells.len());
    for (idx, at) in cells.iter().enumerate() {
        let own = confined(&plan, &atlas, at, [arguments.rows, arguments.seed])?;
        let folder = arguments.out.join(cell_name(&atlas, at));
        let of = format!("cell {} of {}", idx + 1, cells.len());
        let rows = direct_rows(&own, &folder, &library, &mut |progress: Progress| {
            shown.tell(&progress, &of);
            ControlFlow::Continue(())
        });
        let (rows, n_computed) = rows.map_err(|error| in_folder(&folder, error.as_ref()))?;
        shown.begun += arguments.rows;
        shown.kept += arguments.rows - n_computed;
        let cell = CellComparison::new(&atlas, at, &rows)?;
        print_cell(&cell, &place(&atlas, at));
        compared.push(cell);
    }
    print_agreement(&compared);
    Ok(())
}

fn in_folder(folder: &Path, error: &(dyn Error + 'static)) -> String {
    format!("{}: {}", folder.display(), impactlab_core::error_chain(error))
}

/// How far the rows of all cells are.
struct Shown {
    started: Instant,
    /// When the last line was written.
    line: Option<Instant>,
    /// Rows of the cells before, and how many of them were there already.
    begun: u64,
    kept: u64,
    total: u64,
}

impl Shown {
    /// Writes a line if one is due.
    fn tell(&mut self, of_cell: &Progress, cell: &str) {
        if self.line.is_some_and(|line| line.elapsed() < LINE_EVERY) {
            return;
        }
        self.line = Some(Instant::now());
        let all = Progress::new(self.begun + of_cell.done, self.total, cell)
            .going_on_from(self.kept + of_cell.done_before);
        let left = all.time_left(self.started.elapsed()).map_or(String::new(), |left| {
            format!(", {} left", humantime::format_duration(Duration::from_secs(left.as_secs())))
        });
        eprintln!("{}: {} of {} rows{left}", all.message, all.done, all.total);
    }
}

/// A cell for a person.
fn place(atlas: &Atlas, at: &[Option<usize>]) -> String {
    let units = UnitSystem::default();
    let held = atlas.axes.iter().zip(at);
    let texts = held.filter_map(|(axis, bin)| Some(axis.bin_text((*bin)?, units)));
    texts.collect::<Vec<_>>().join(", ")
}

fn print_cell(cell: &CellComparison, place: &str) {
    for of in &cell.outcomes {
        let [atlas, direct] = [of.atlas, of.direct]
            .map(|it| format!("{:.2} ± {:.2}", 100.0 * it.p, 100.0 * it.error));
        let (rows, outcome, z) = (cell.n_atlas_rows, of.outcome.name(), of.z());
        println!("| {place} | {rows} | {outcome} | {atlas} | {direct} | {z:.2} |");
    }
    if cell.n_failed > 0 {
        println!("\n{} of the rows of this cell have no answer\n", cell.n_failed);
    }
}

fn print_agreement(cells: &[CellComparison]) {
    let n_same: usize = cells.iter().map(|cell| cell.n_same).sum();
    let same = format!("{n_same} outcomes of a cell are those of all rows or of none in both");
    match Agreement::new(cells) {
        None => println!("\nnothing can be compared: {same}"),
        Some(Agreement { n, n_beyond, chi_square, freedom, p }) => println!(
            "\n{n_beyond} of {n} |z| > 2; χ² = {chi_square:.1} with {freedom:.1} degrees of freedom, \
             p = {p:.2e}; {same}"
        ),
    }
}
