//! Whether files that exist may be replaced.

use clap::Args;

use impactlab_core::data::Existing;

/// Whether files that exist may be replaced.
#[derive(Debug, Clone, Copy, Args)]
pub(in crate::cli) struct OverwriteArg {
    /// Replace files that exist already
    #[arg(long)]
    overwrite: bool,
}

impl OverwriteArg {
    /// Of a command that cannot take it as a flattened argument, because clap then takes the
    /// arguments of the command for absent.
    pub(in crate::cli) fn from_flag(overwrite: bool) -> Self {
        Self { overwrite }
    }

    /// Whether the option was given.
    pub(in crate::cli) fn is_given(self) -> bool {
        self.overwrite
    }
}

impl From<OverwriteArg> for Existing {
    fn from(arg: OverwriteArg) -> Self {
        if arg.overwrite { Self::Replace } else { Self::Refuse }
    }
}
