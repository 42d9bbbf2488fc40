//! A scene as a picture that stands by itself: below its title, above what restricts it.

use std::sync::Arc;

use image::RgbaImage;

use crate::film::FrameRenderer;
use crate::scene::{Camera, Follow};
use crate::{Canvas, RenderError};
use impactlab_document::scene::Scene;

/// A scene at a time, as it is seen.
#[derive(Debug, Clone)]
pub struct ScenePicture {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The time, s.
    pub time_s: f64,
    /// Kind and directions of the view. It is fitted to the scene.
    pub camera: Camera,
    /// Whether the camera is taken as it is and not fitted.
    pub is_placed: bool,
    /// Distance of the camera that replaces the fitted one, m.
    pub distance_m: Option<f64>,
    /// Which car is in the middle.
    pub follow: Follow,
}

impl ScenePicture {
    /// What the picture shows.
    pub fn title(&self) -> String {
        self.scene.heading(self.camera.kind.phrase(), self.time_s)
    }
}

/// Draws a picture off screen.
///
/// # Errors
/// [`RenderError::Size`] for a width or height outside the permitted range.
pub fn scene_image(picture: &ScenePicture, canvas: Canvas) -> Result<RgbaImage, RenderError> {
    let mut renderer = FrameRenderer::new(canvas)?;
    let image = renderer.draw(picture, 1.0);
    let [width, height] = canvas.size_px;
    Ok(RgbaImage::from_raw(width, height, image.as_raw().to_vec()).unwrap_or_default())
}
