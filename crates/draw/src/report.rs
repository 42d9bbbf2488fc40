//! Pictures of reports.

use std::sync::Arc;

use crate::scene::{Camera, Follow, ScenePicture, scene_image};
use crate::{Canvas, figure_image};
use impactlab_core::error_chain;
use impactlab_document::report::{PictureContent, Pixels};
use impactlab_document::scene::SceneStill;

/// Size of a picture in a report, pixels; its sides are as those of its place on the page.
const SIZE_PX: [u32; 2] = [1560, 655];
/// Pixels per point: letters are as large as those of the captions.
const SCALE: f32 = 2.25;

/// Draws a picture of a report.
///
/// # Errors
/// Why it cannot be drawn.
pub fn report_picture(content: &PictureContent) -> Result<Pixels, String> {
    let canvas = Canvas { size_px: SIZE_PX, scale: SCALE, dark: false };
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
            distance_m: still.near_m,
            follow: still.near_m.map_or(Follow::Nothing, |_| Follow::Struck),
        }
    }
}
