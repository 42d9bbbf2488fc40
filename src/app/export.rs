//! Writes figures, scenes and reports to files. It takes seconds, so that tasks do it.

use std::path::Path;
use std::sync::Arc;

use impactlab_core::data::{Existing, write_bytes};
use impactlab_core::error_chain;
use impactlab_core::site::MapFormat;
use impactlab_document::exchange::{DxfOptions, dxf, glb, map};
use impactlab_document::figure::{Figure, write_figure_csv};
use impactlab_document::report::{ReportDocument, ReportFormat};
use impactlab_document::scene::Scene;
use impactlab_draw::scene::{ScenePicture, scene_image};
use impactlab_draw::{Canvas, figure_image, report_drawing, save_png};

/// Writes a figure to a file: its numbers if the path ends in `.csv`, otherwise a PNG picture.
///
/// - `dark`: whether the picture has the dark theme.
///
/// # Errors
/// A message for the user.
pub fn write_figure(
    figure: &Figure,
    path: &Path,
    existing: Existing,
    dark: bool,
) -> Result<(), String> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        let text = numbers(figure)?;
        return write_bytes(path, existing, text.as_bytes()).map_err(|error| error_chain(&error));
    }
    let canvas = Canvas { dark, ..Canvas::default() };
    figure_image(figure, canvas)
        .and_then(|image| save_png(&image, path, existing))
        .map_err(|error| error_chain(&error))
}

/// Writes a scene to a PNG file.
///
/// # Errors
/// A message for the user.
pub fn write_scene(
    picture: &ScenePicture,
    path: &Path,
    existing: Existing,
    dark: bool,
) -> Result<(), String> {
    let usual = Canvas::default();
    let canvas = Canvas { scale: Canvas::scene_scale(usual.size_px), dark, ..usual };
    scene_image(picture, canvas)
        .and_then(|image| save_png(&image, path, existing))
        .map_err(|error| error_chain(&error))
}

/// Writes a report to a file, in the format of its ending.
///
/// # Errors
/// A message for the user.
pub fn write_report(
    document: &ReportDocument,
    path: &Path,
    existing: Existing,
) -> Result<(), String> {
    let format = ReportFormat::from_path(path).map_err(|error| error_chain(&error))?;
    let bytes = document.bytes(format, Some(&report_drawing));
    let bytes = bytes.map_err(|error| error_chain(&error))?;
    write_bytes(path, existing, &bytes).map_err(|error| error_chain(&error))
}

/// A scene for another program.
#[derive(Debug, Clone)]
pub struct SceneExport {
    /// The scene.
    pub scene: Arc<Scene>,
    /// What is written.
    pub format: SceneFormat,
    /// Instants at which a drawing shows the outlines of the cars, s.
    pub outlines_s: Vec<f64>,
}

/// A format for another program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SceneFormat {
    /// A drawing in metres.
    Dxf,
    /// Ground, paths and marks on a map.
    Kml,
    /// The scene with its animation in 3D.
    Glb,
}

impl SceneFormat {
    /// Ending of the file.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Dxf => "dxf",
            Self::Kml => "kml",
            Self::Glb => "glb",
        }
    }
}

/// Writes a scene for another program.
///
/// # Errors
/// A message for the user.
pub fn write_exchange(export: SceneExport, path: &Path, existing: Existing) -> Result<(), String> {
    let SceneExport { scene, format, outlines_s } = export;
    let mut bytes = Vec::new();
    match format {
        SceneFormat::Dxf => dxf(&scene, &DxfOptions { outlines_s }, &mut bytes),
        SceneFormat::Kml => map(&scene, MapFormat::Kml, &mut bytes),
        SceneFormat::Glb => glb(&scene, &mut bytes),
    }
    .map_err(|error| error_chain(&error))?;
    write_bytes(path, existing, &bytes).map_err(|error| error_chain(&error))
}

/// Returns the numbers of a figure as CSV text.
///
/// # Errors
/// A message for the user, if the text cannot be made.
pub fn numbers(figure: &Figure) -> Result<String, String> {
    let mut bytes = Vec::new();
    write_figure_csv(figure, &mut bytes).map_err(|error| error_chain(&error))?;
    String::from_utf8(bytes).map_err(|error| error_chain(&error))
}
