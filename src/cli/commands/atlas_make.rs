//! `impactlab atlas make`: an atlas of the rows of a sweep.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, shown_path};
use crate::cli::options::OverwriteArg;
use impactlab_core::data::write_bytes;
use impactlab_core::numerics::sha256_hex;
use impactlab_sweep::atlas::{AtlasBuilder, AtlasError, Axis};

/// From which rows an atlas is made.
#[derive(Debug, Args)]
pub(super) struct MakeArgs {
    /// Rows of one plan: chunks, or all of them merged
    #[arg(value_name = "ROWS.parquet", required = true)]
    rows: Vec<PathBuf>,
    /// Rows of a Saltelli design, for the Sobol indices
    #[arg(long, value_name = "ROWS.parquet")]
    saltelli: Option<PathBuf>,
    /// What the cells are laid out over; the axes of the shipped atlas if not given
    #[arg(long, value_name = "AXES.toml")]
    axes: Option<PathBuf>,
    /// The file of the atlas
    #[arg(long, value_name = "FILE.atlas")]
    out: PathBuf,
    #[command(flatten)]
    overwrite: OverwriteArg,
}

#[derive(Debug, Serialize)]
struct Made<'a> {
    out: &'a Path,
    bytes: usize,
    sha256: String,
    n_rows: u64,
    n_failed: u64,
    n_outside: u64,
    n_cells: usize,
    n_outcomes_with_indices: usize,
}

/// Makes the atlas and writes it.
pub(super) fn run(args: &MakeArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    console.check_target(Some(&args.out), args.overwrite.into())?;
    let inputs = args.rows.iter().chain(&args.saltelli).chain(&args.axes).cloned();
    console.reads(&inputs.collect::<Vec<_>>())?;
    let axes = match &args.axes {
        Some(path) => Axis::read_all(path)?,
        None => Axis::pit()?,
    };
    let mut builder = AtlasBuilder::new(axes)?;
    for path in &args.rows {
        builder.add_file(path)?;
    }
    if let Some(path) = &args.saltelli {
        builder.add_sensitivity_file(path)?;
    }
    let atlas = builder.finish()?;
    let bytes = atlas.to_bytes().map_err(|error| AtlasError::Encode(Box::new(error)))?;
    write_bytes(&args.out, args.overwrite.into(), &bytes)?;
    let made = Made {
        out: &args.out,
        bytes: bytes.len(),
        sha256: sha256_hex([bytes.as_slice()]),
        n_rows: atlas.n_rows,
        n_failed: atlas.n_failed,
        n_outside: atlas.n_outside,
        n_cells: atlas.n_cells(),
        n_outcomes_with_indices: atlas.sensitivity.len(),
    };
    console.print(&made, |out| {
        let path = shown_path(made.out);
        writeln!(out, "{path}: {} rows in {} cells", made.n_rows, made.n_cells)?;
        if made.n_failed + made.n_outside > 0 {
            let (failed, outside) = (made.n_failed, made.n_outside);
            writeln!(out, "{failed} rows have no answer, {outside} lie outside of the axes")?;
        }
        writeln!(out, "{} bytes, SHA-256 {}", made.bytes, made.sha256)
    })?;
    Ok(Verdict::Clean)
}
