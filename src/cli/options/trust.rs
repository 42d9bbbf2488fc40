//! Whether a case may do more than read files in its own folder.

use std::path::Path;

use clap::Args;

use crate::cli::CliError;
use impactlab_study::case_file::CaseFile;

/// Whether a case may do more than read files in its own folder.
#[derive(Debug, Clone, Copy, Args)]
pub(in crate::cli) struct TrustArg {
    /// Let the case read files outside of its folder, write files and train networks
    #[arg(long)]
    trust: bool,
}

impl TrustArg {
    /// Says what a case would do that is not allowed.
    ///
    /// - `path`: of the case's file.
    ///
    /// # Errors
    /// [`CliError::Untrusted`].
    pub(in crate::cli) fn check(self, case: &CaseFile, path: &Path) -> Result<(), CliError> {
        let reach = case.reach(path);
        if self.trust || reach.is_empty() {
            return Ok(());
        }
        Err(CliError::Untrusted { path: path.to_owned(), reach: Box::new(reach) })
    }
}
