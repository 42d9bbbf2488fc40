//! Cells of an atlas, and the rows that are computed for one of them alone.

use std::error::Error;
use std::path::Path;

use impactlab_core::jobs::ProgressCallback;
use impactlab_core::numerics::random_stream;
use impactlab_study::Library;
use impactlab_sweep::atlas::{Atlas, Axis, MIN_ROWS};
use impactlab_sweep::{Design, Distribution, Plan, Rows, read_chunk, run_chunks};
use rand::Rng as _;
use serde_json::Value;

type Checked<T> = Result<T, Box<dyn Error>>;

/// Rows of a file.
const CHUNK: u64 = 500;

/// The bin of every axis that is held.
pub type Place = Vec<Option<usize>>;

/// Reads the plan that an atlas is made of; the rows of any other one would say nothing of it.
pub fn plan_of(atlas: &Atlas, path: &Path, library: &Library) -> Checked<Plan> {
    let plan = Plan::read(path, library)?;
    if plan.networks != atlas.networks {
        return Err("the atlas was computed with other networks than those of this program".into());
    }
    let computed = Plan { program: atlas.program.clone(), ..plan.clone() };
    if computed.sha256() != atlas.plan_sha256 {
        return Err(format!("{}: is not the plan of the atlas", path.display()).into());
    }
    if plan.design != Design::Sobol {
        return Err(format!("{}: expected design = \"sobol\"", path.display()).into());
    }
    Ok(plan)
}

/// Random cells over some axes, among those with enough rows; as many as wanted, if there are.
pub fn drawn_cells(atlas: &Atlas, axes: &[String], n: usize, seed: u64) -> Checked<Vec<Place>> {
    let mut all: Vec<Place> = vec![vec![None; atlas.axes.len()]];
    for name in axes {
        let idx = atlas.axis(name).ok_or_else(|| format!("the atlas has no axis {name:?}"))?;
        if all.iter().any(|at| at.get(idx).copied().flatten().is_some()) {
            return Err(format!("axis {name:?} is there twice").into());
        }
        let n_bins = atlas.axes.get(idx).map_or(0, Axis::n_bins);
        let with_bin = |at: Place| {
            (0..n_bins).map(move |bin| {
                let mut at = at.clone();
                if let Some(slot) = at.get_mut(idx) {
                    *slot = Some(bin);
                }
                at
            })
        };
        all = all.into_iter().flat_map(with_bin).collect();
    }
    let mut rng = random_stream(seed, "cells of an atlas", 0);
    let mut order: Vec<(u64, Place)> = all.into_iter().map(|at| (rng.next_u64(), at)).collect();
    order.sort_unstable();
    let has_enough = |at: &Place| atlas.cell(at).n_rows() >= MIN_ROWS;
    Ok(order.into_iter().map(|(_, at)| at).filter(has_enough).take(n).collect())
}

/// Name of a cell, and of its folder: `speed-3-closing-0-esc-1`.
pub fn cell_name(atlas: &Atlas, at: &[Option<usize>]) -> String {
    let held = atlas.axes.iter().zip(at);
    let names = held.filter_map(|(axis, bin)| {
        let word: String = axis.word.chars().filter(char::is_ascii_alphanumeric).collect();
        Some(format!("{word}-{}", (*bin)?))
    });
    names.collect::<Vec<_>>().join("-")
}

/// The plan with what varies confined to a cell.
///
/// - `[n_rows, seed]`: its rows, and the seed that they follow from with the name of the cell.
pub fn confined(
    plan: &Plan,
    atlas: &Atlas,
    at: &[Option<usize>],
    [n_rows, seed]: [u64; 2],
) -> Checked<Plan> {
    let mut own = plan.clone();
    for (axis, bin) in atlas.axes.iter().zip(at) {
        let Some(bin) = *bin else { continue };
        let vary = own.vary.iter_mut().find(|vary| vary.name == axis.name);
        let vary = vary.ok_or_else(|| format!("{} does not vary in the plan", axis.name))?;
        vary.distribution = within(&vary.distribution, axis, bin)?;
    }
    let name = cell_name(atlas, at);
    own.seed = random_stream(seed, &name, 0).next_u64();
    own.name = name;
    (own.n, own.chunk) = (n_rows, CHUNK.min(n_rows));
    Ok(own)
}

/// A distribution given that the value lies in a bin.
fn within(distribution: &Distribution, axis: &Axis, bin: usize) -> Checked<Distribution> {
    let [from, to] = axis.ends(bin).ok_or_else(|| format!("{} has no bin {bin}", axis.name))?;
    let cut = |low: Option<f64>, high: Option<f64>| {
        let low = low.map_or(from, |low| low.max(from));
        (Some(low), Some(high.map_or(to, |high| high.min(to))))
    };
    Ok(match distribution {
        Distribution::Uniform { low, high } => {
            Distribution::Uniform { low: low.max(from), high: high.min(to) }
        }
        &Distribution::Normal { mean, sigma, low, high } => {
            let (low, high) = cut(low, high);
            Distribution::Normal { mean, sigma, low, high }
        }
        &Distribution::Lognormal { median, log_sigma, low, high } => {
            let (low, high) = cut(low, high);
            Distribution::Lognormal { median, log_sigma, low, high }
        }
        Distribution::Triangular { .. } => {
            let name = &axis.name;
            return Err(format!("{name} is triangular, of which a part is no distribution").into());
        }
        Distribution::List { values, weights } => {
            let is_here =
                |value: &&Value| value.as_f64().and_then(|it| axis.locate(it)) == Some(bin);
            let weights = values.iter().zip(weights).filter(|(value, _)| is_here(value));
            let weights = weights.map(|(_, weight)| *weight).collect();
            Distribution::List { values: values.iter().filter(is_here).cloned().collect(), weights }
        }
    })
}

/// Computes the rows of a plan in a folder, where those that are there are kept, and says how many were
/// computed.
pub fn direct_rows(
    plan: &Plan,
    folder: &Path,
    library: &Library,
    progress: &mut ProgressCallback<'_>,
) -> Checked<(Vec<Rows>, u64)> {
    plan.write(folder)?;
    let chunks: Vec<u64> = (0..plan.n_chunks()).collect();
    let run = run_chunks(folder, &chunks, library, progress)?;
    let rows = chunks.iter().map(|chunk| read_chunk(folder, plan, *chunk));
    Ok((rows.collect::<Result<Vec<_>, _>>()?, run.rows))
}
