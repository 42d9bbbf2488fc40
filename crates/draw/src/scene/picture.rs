//! A scene as a picture that stands by itself: below its title, above what restricts it.

use std::sync::Arc;

use egui::Vec2;
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
    /// Courses of events that stand side by side in place of the scene, which is of all of them; none if
    /// it stands alone.
    pub courses: Vec<SceneCourse>,
    /// The time, s.
    pub time_s: f64,
    /// Kind and directions of the view. It is fitted to the scene.
    pub camera: Camera,
    /// Whether the camera is taken as it is and not fitted.
    pub is_placed: bool,
    /// Width over height of the view in which the camera was placed. A picture that is less wide is seen
    /// from further back, so that nothing of the view is cut off; `None` leaves the camera where it is.
    pub seen_aspect: Option<f64>,
    /// Distance of the camera that replaces the fitted one, m.
    pub distance_m: Option<f64>,
    /// Which car is in the middle.
    pub follow: Follow,
}

/// One of several possible courses of events.
#[derive(Debug, Clone)]
pub struct SceneCourse {
    /// What happens, with its probability.
    pub name: String,
    /// Its scene.
    pub scene: Arc<Scene>,
}

impl ScenePicture {
    /// The scenes that are drawn: the courses of events, or the scene.
    pub(crate) fn drawn(&self) -> Vec<&Arc<Scene>> {
        match self.courses.as_slice() {
            [] => vec![&self.scene],
            courses => courses.iter().map(|course| &course.scene).collect(),
        }
    }

    /// The camera, from which all places of the scene are seen; that which was placed if there is one.
    ///
    /// - `size`: of the picture, or of one of its courses of events, in any unit.
    pub(crate) fn fitted_camera(&self, size: Vec2) -> Camera {
        if self.is_placed {
            return self.placed_camera(size);
        }
        let size = [size.x, size.y].map(f64::from);
        let fitted = self.camera.fitted(&self.scene.places_m(), size);
        Camera { distance_m: self.distance_m.unwrap_or(fitted.distance_m), ..fitted }
    }

    /// The camera that was placed, as far back that the picture holds the width of the view in which it was.
    ///
    /// - `size`: of the picture, or of one of its courses of events, in any unit.
    pub(crate) fn placed_camera(&self, size: Vec2) -> Camera {
        let aspect = f64::from(size.x / size.y.max(1.0));
        self.seen_aspect.map_or(self.camera, |seen| self.camera.holding_width(seen, aspect))
    }

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
