//! `impactlab app`: opens the window.

use std::path::PathBuf;

use clap::Args;

use crate::app::RendererChoice;
use crate::cli::CliError;
use crate::cli::console::Verdict;
use crate::cli::options::{Words, one_of};

/// Open the window (the same as no command at all)
#[derive(Debug, Default, Args)]
#[command(after_help = "Example:\n  impactlab app datasets/trajectories-fea")]
pub(in crate::cli) struct AppArgs {
    /// Data sets, files and scenarios to open
    #[arg(value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// What draws the window
    #[arg(long, value_parser = one_of(RENDERERS), default_value = "auto")]
    renderer: RendererChoice,
}

/// What draws the window.
const RENDERERS: Words<RendererChoice> = &[
    (
        "auto",
        "The graphics processor if there is one, else OpenGL in software",
        RendererChoice::Automatic,
    ),
    (
        "wgpu",
        "wgpu (Vulkan, Metal, DirectX), also where it is emulated in software",
        RendererChoice::Wgpu,
    ),
    ("opengl", "OpenGL; try it where the window stays empty", RendererChoice::OpenGl),
];

/// Opens the window and waits until it is closed.
///
/// # Errors
/// [`CliError::NoDisplay`], or [`CliError::Window`] with the system's reason.
pub(in crate::cli) fn run(args: AppArgs) -> Result<Verdict, CliError> {
    if !has_display(|name| std::env::var_os(name)) {
        return Err(CliError::NoDisplay);
    }
    crate::app::run(args.paths, args.renderer)?;
    Ok(Verdict::Clean)
}

/// Whether a window can be shown: on Linux, whether a display server is named.
fn has_display(variable: impl Fn(&str) -> Option<std::ffi::OsString>) -> bool {
    let is_set = |name| variable(name).is_some_and(|value| !value.is_empty());
    !cfg!(target_os = "linux") || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn an_empty_variable_names_no_display() {
        assert!(!has_display(|_| None));
        assert!(!has_display(|_| Some("".into())));
        assert!(has_display(|name| (name == "WAYLAND_DISPLAY").then(|| "wayland-0".into())));
    }
}
