//! The files of `impactlab reconstruct`.

use std::path::Path;

use serde::Serialize;

use crate::cli::CliError;
use impactlab_core::data::{Existing, write_atomically, write_restricted_table};
use impactlab_reconstruct::ReconstructedQuantity;
use impactlab_study::ReconstructAnswer;

/// Writes the particles as CSV and the report as JSON into a folder that exists.
pub(in crate::cli) fn write_reconstruction(
    path: &Path,
    answer: &ReconstructAnswer,
    report: &impl Serialize,
) -> Result<(), CliError> {
    let restrictions = answer.report.caveats.text();
    let (posterior, particles) = (&answer.posterior, &answer.particles);
    let components = answer.target.model().prior().components();
    let quantities = ReconstructedQuantity::ALL;
    // A quantity that is asked for and open by itself stands there once.
    let open: Vec<_> = components
        .iter()
        .map(|component| component.latent)
        .filter(|latent| quantities.iter().all(|quantity| quantity.key() != latent.key()))
        .collect();
    let header: Vec<String> = (quantities.iter().map(|quantity| quantity.key()))
        .chain(open.iter().map(|latent| latent.key()))
        .chain(["log_likelihood"])
        .map(str::to_owned)
        .collect();
    let estimates: Vec<Vec<f64>> =
        quantities.iter().map(|quantity| posterior.values(*quantity)).collect();
    let rows = (0..posterior.values.len()).map(|idx| {
        let values = &posterior.values[idx];
        let estimates = estimates.iter().map(|column| column[idx]);
        let open = open.iter().map(|latent| values.get(*latent));
        estimates
            .chain(open)
            .chain([particles.log_likelihood[idx]])
            .map(|value| value.to_string())
            .collect()
    });
    let table = path.join("particles.csv");
    write_restricted_table(&table, Existing::Refuse, &header, rows, restrictions.as_deref())?;
    write_atomically(&path.join("reconstruction.json"), Existing::Refuse, |out| {
        serde_json::to_writer_pretty(&mut *out, report)?;
        writeln!(out)
    })?;
    Ok(())
}
