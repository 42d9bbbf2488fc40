//! Pictures of reports.

use std::sync::Arc;

use egui::{Frame, Ui};

use crate::offscreen::shapes_offscreen;
use crate::report_vectors::vector_picture;
use crate::scene::{Camera, Follow, ScenePicture, scene_image};
use crate::{Canvas, draw_offscreen, figure_image, picture_ui};
use impactlab_core::error_chain;
use impactlab_document::figure::Figure;
use impactlab_document::report::{Drawn, Medium, PictureContent, Pixels};
use impactlab_document::scene::SceneStill;

/// Size of a picture in a report, pixels; its sides are as those of its place on the page.
const SIZE_PX: [u32; 2] = [1560, 593];
/// Pixels per point: letters are as large as those of the captions.
const SCALE: f32 = 2.25;

/// A picture that takes half of the width of a page, with the sides of its place; its letters are as large
/// as those of the captions.
const HALF: Canvas = Canvas { size_px: [1040, 603], scale: 3.0, dark: false };
/// Room around a plot, points.
const PLOT_MARGIN: f32 = 4.0;

/// Draws a picture of a report for a medium. On a page a plot consists of lines and letters.
///
/// # Errors
/// Why it cannot be drawn.
pub fn report_drawing(content: &PictureContent, medium: Medium) -> Result<Drawn, String> {
    match (content, medium) {
        (PictureContent::Figure(figure), Medium::Page) => plot_on_page(figure),
        _ => report_picture(content).map(Drawn::Pixels),
    }
}

/// A plot as lines and letters; as pixels if it holds an image.
fn plot_on_page(figure: &Figure) -> Result<Drawn, String> {
    let ui = |ui: &mut Ui| {
        Frame::new().inner_margin(PLOT_MARGIN).show(ui, |ui| picture_ui(ui, figure));
    };
    let shapes = shapes_offscreen(HALF, ui).map_err(|error| error_chain(&error))?;
    if let Some(vectors) = vector_picture(&shapes, HALF.size_points()) {
        return Ok(Drawn::Vectors(vectors));
    }
    let image = draw_offscreen(HALF, ui).map_err(|error| error_chain(&error))?;
    Ok(Drawn::Pixels(Pixels { size_px: [image.width(), image.height()], rgba: image.into_raw() }))
}

/// Draws a picture of a report as pixels.
///
/// # Errors
/// Why it cannot be drawn.
pub fn report_picture(content: &PictureContent) -> Result<Pixels, String> {
    let whole = Canvas { size_px: SIZE_PX, scale: SCALE, dark: false };
    let canvas = if content.is_half_wide() { HALF } else { whole };
    let image = match content {
        PictureContent::Figure(figure) => figure_image(figure, canvas),
        PictureContent::Scene(still) => scene_image(&ScenePicture::from(still), canvas),
    };
    let image = image.map_err(|error| error_chain(&error))?;
    Ok(Pixels { size_px: [image.width(), image.height()], rgba: image.into_raw() })
}

impl From<&SceneStill> for ScenePicture {
    fn from(still: &SceneStill) -> Self {
        Self {
            scene: Arc::clone(&still.scene),
            courses: Vec::new(),
            time_s: still.time_s,
            camera: Camera { kind: still.view, ..Camera::default() },
            is_placed: false,
            seen_aspect: None,
            distance_m: still.near_m,
            follow: still.near_m.map_or(Follow::Nothing, |_| Follow::Struck),
        }
    }
}
