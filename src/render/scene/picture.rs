//! A scene as a picture that stands by itself: below its title, above what restricts it.

use std::sync::Arc;

use image::RgbaImage;

use crate::render::scene::{Camera, Follow, SceneView, scene_view_ui};
use crate::render::trust::framed_ui;
use crate::render::{Canvas, RenderError, draw_offscreen};
use crate::scene::Scene;

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
    let mut view = SceneView::default();
    let mut camera = picture.camera;
    draw_offscreen(canvas, |ui| {
        egui::Frame::new().inner_margin(12.0).show(ui, |ui| {
            framed_ui(ui, (&picture.title(), &picture.scene.trust), |ui, height| {
                let height = height.unwrap_or_else(|| ui.available_height());
                view.place(picture);
                let shown = (&picture.scene, picture.time_s);
                scene_view_ui(ui, shown, &mut view, (&mut camera, picture.follow, height));
            });
        });
    })
}
