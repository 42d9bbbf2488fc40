//! Pictures of reports.

use crate::figure::Figure;
use crate::render::{Canvas, figure_image};
use crate::report::Pixels;

/// Size of a picture in a report, pixels; its sides are as those of its place on the page.
const SIZE_PX: [u32; 2] = [1560, 905];
/// Pixels per point: letters are as large as those of the captions.
const SCALE: f32 = 2.25;

/// Draws a figure for a report.
///
/// # Errors
/// Why it cannot be drawn.
pub fn report_picture(figure: &Figure) -> Result<Pixels, String> {
    let canvas = Canvas { size_px: SIZE_PX, scale: SCALE, dark: false };
    let image = figure_image(figure, canvas).map_err(|error| crate::error_chain(&error))?;
    Ok(Pixels { size_px: [image.width(), image.height()], rgba: image.into_raw() })
}
